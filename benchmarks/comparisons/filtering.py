"""Zero-lag Butterworth filter of 26 joints at 60 Hz: 6 Hz, order 4, with gaps."""

import numpy as np

import machine
import peers
import rows
import scene

NAME = "filtering"
LIMIT = "bytes of the coordinates read and written, over the memory's"
BOUNDS = (
    "the recursion of the filter, one number after another in each coordinate, which SciPy does "
    "in C for all joints at once; Pose2Sim calls it once for each of 78 columns, and its outlier "
    "filter once for each frame of each"
)
FRAMES = 1000
SETTINGS = {"rate_hz": scene.RATE_HZ, "cutoff_hz": 6.0, "order": 4}
NOISE_M, GAPS, GAP_FRAMES = 0.015, 3, 20  # per axis; of each take, in all joints


def compare(given):
    """Return the rows of this project and Pose2Sim."""
    found = []
    for times in rows.TIMES[: 2 if given.quick else None]:
        rng = np.random.default_rng(0)
        true = scene.body(times * FRAMES, rng).reshape(-1, scene.JOINTS, 3)
        noisy = true + rng.normal(0, NOISE_M, true.shape)
        for start in rng.integers(0, len(true) - GAP_FRAMES, GAPS * times):
            noisy[start : start + GAP_FRAMES] = np.nan
        arrays = {"xyz": noisy, **SETTINGS}
        measured = peers.measured(_runs(given), arrays, given.environments)
        ours = measured[rows.OURS][1]
        found += [_row(true, times, ours, method, *one) for method, one in measured.items()]
    return found


def _runs(given):
    """Return which program runs which script with which arguments."""
    ours = (None, "filter_courtside.py", (str(given.repeats),))
    return [ours, ("pose2sim", "filter_pose2sim.py", (str(given.repeats),)), ours]


def _row(true, times, ours, method, cpu_s, xyz):
    away = [1000 * np.linalg.norm(each - true, axis=-1) for each in (xyz, ours)]
    known = np.isfinite(away[0]) & np.isfinite(away[1])
    return rows.Row(
        comparison=NAME, method=method, ours=xyz is ours, unit="frame", work=len(true), times=times,
        cpu_s=cpu_s, limit_s=2 * true.nbytes / machine.measured().bytes_s,
        error_median=np.median(away[0][known]), error_p95=np.percentile(away[0][known], 95),
        error_ours_p95=np.percentile(away[1][known], 95), error_unit="mm",
    )  # fmt: skip
