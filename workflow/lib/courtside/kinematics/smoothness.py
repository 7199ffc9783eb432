"""How smooth a movement is: the arc length of its speed's spectrum (SPARC)."""

import numpy as np

CUTOFF_HZ = 10.0
THRESHOLD = 0.05
PADDING = 4  # powers of two by which the spectrum is made finer


def sparc(speed, rate_hz, *, cutoff_hz=CUTOFF_HZ, threshold=THRESHOLD):
    """Return the spectral arc length of a speed profile.

    Parameters
    ----------
    speed : (T,) float
        Of one movement, from rest to rest; any unit.
    rate_hz : float
        Values per second.
    cutoff_hz : float
        Frequencies beyond do not count.
    threshold : float
        Share of the spectrum at 0 Hz: frequencies beyond the last that reaches it do not count either.

    Returns
    -------
    sparc : float
        Without unit; nearer to 0 is smoother: -1.41 for a single minimum-jerk reach. Neither amplitude nor
        duration changes it, as long as the cut-off is not met.

    Raises
    ------
    ValueError
        If a value is missing, or nothing moves.

    Notes
    -----
    Balasubramanian, Melendez-Calderon & Burdet 2012; with the adaptive limit of Balasubramanian,
    Melendez-Calderon, Roby-Brami & Burdet 2015. Noise counts as unsmooth: compare sources at one rate.
    """
    speed = np.asarray(speed, dtype=float)
    if speed.ndim != 1 or len(speed) < 4 or not np.isfinite(speed).all() or not speed.any():
        raise ValueError("expected four or more finite speeds that are not all zero")
    count = 2 ** (int(np.ceil(np.log2(len(speed)))) + PADDING)
    hz = np.fft.rfftfreq(count, 1 / rate_hz)
    spectrum = np.abs(np.fft.rfft(speed, count))
    spectrum = spectrum[hz <= cutoff_hz] / spectrum[0]
    used = np.flatnonzero(spectrum >= threshold)
    part = spectrum[used[0] : used[-1] + 1]
    if len(part) < 2:
        raise ValueError("expected a spectrum wider than one line, found a steady speed")
    return float(-np.hypot(1 / (len(part) - 1), np.diff(part)).sum())


def of_path(time_s, xyz, rate_hz, *, start_s, stop_s):
    """Return the SPARC of a point's speed between two times.

    Parameters
    ----------
    time_s : (T,) float
    xyz : (T, 3) float
        Any unit; values that are missing are bridged by straight lines.
    rate_hz : float
        All sources are compared at this rate.
    start_s, stop_s : float

    Returns
    -------
    sparc : float
        NaN where fewer than half of the values in between are known.
    """
    grid = np.arange(start_s, stop_s, 1 / rate_hz)
    known = np.isfinite(xyz).all(axis=1)
    inside = (time_s >= start_s) & (time_s <= stop_s)
    if len(grid) < 5 or known[inside].sum() < max(2, 0.5 * inside.sum()):
        return np.nan
    path = np.column_stack([np.interp(grid, time_s[known], line[known]) for line in xyz.T])
    speed = np.linalg.norm(np.diff(path, axis=0), axis=1) * rate_hz
    return sparc(speed, rate_hz)


def of_arcs(body, arcs, rate_hz):
    """Return the SPARC of the wrists on their arcs from T-pose to clap.

    Parameters
    ----------
    body : courtside.records.keypoints.body_motion.BodyMotion
    arcs : list of courtside.kinematics.wrist_arcs.Arc
        Of that body.
    rate_hz : float

    Returns
    -------
    sparc : list of float
        One for each arc.
    """
    return [
        of_path(
            body.time_s,
            body.joint(f"{arc.side}_wrist"),
            rate_hz,
            start_s=arc.time_s[0],
            stop_s=arc.time_s[-1],
        )
        for arc in arcs
    ]
