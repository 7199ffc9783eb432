"""Take a fixed camera's shake out of its keypoints: as if it had stood as in its static picture."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
from scipy.spatial.transform import Rotation

from courtside.geometry import camera as cameras
from courtside.study import log
from courtside.study.errors import InputError

LONGEST_GAP_S = 0.2  # frames without a measurement that are bridged by a line
SAME_FRAME = 0.25  # of a frame: a time that agrees with a row of the table
PROBE_PX = 20.0  # how far from the centre the turn of the content is read
N_STEPS = 6
DONE_RAD = 1e-10


def turns(camera, table):
    """Return how the camera had turned in each frame.

    Parameters
    ----------
    camera : courtside.geometry.camera.Camera
        As calibrated, standing as in its static picture.
    table : DataFrame
        Of `courtside.records.shake_table`.

    Returns
    -------
    shaken_from_still : (T, 3) float
        Rotation vector, radians, from the axes of the camera as calibrated to those it has in the frame; NaN
        where the shake is unknown.

    Notes
    -----
    A fixed camera turns about itself: when its picture moves by ten pixels, its centre moves by about
    a millimetre. The rotation is the one that moves the picture's centre, and turns the content there, as
    measured (Newton's method through the lens). Zoom is left out: an angle of view does not shake.
    """
    measured = np.column_stack(
        [table.shift_x_px, table.shift_y_px, np.radians(table.rotation_deg)]
    ).astype(float)
    found = np.full(measured.shape, np.nan)
    known = np.isfinite(measured).all(axis=1)
    if known.any():
        found[known] = _solve(camera, measured[known])
    return found


def steady(view, camera, table):
    """Move keypoints from the shaken pictures of a camera to where its static picture has them.

    Parameters
    ----------
    view : courtside.records.keypoints.Keypoints2D
    camera : courtside.geometry.camera.Camera
        As calibrated.
    table : DataFrame
        Of `courtside.records.shake_table`, with a row for each frame of the view.

    Returns
    -------
    steadied : courtside.records.keypoints.Keypoints2D
        With `xy` and `xyz_in_body` turned back. Frames whose shake is unknown for longer than 0.2 s are left
        as they are, which the log says. Keypoints that the lens model cannot have seen stay, too.

    Raises
    ------
    InputError
        If the camera was calibrated at another size, or a frame is not in the table.

    Notes
    -----
    The measured shake is used as it is, not smoothed: its noise is far below a keypoint's, and smoothing
    would take more from the tremor than from the noise.
    """
    cameras.check_size(camera, view.size, f"keypoints of camera {view.camera}")
    turned = _bridged(table.time_s.to_numpy(float), turns(camera, table))
    turned = turned[_rows(view, table)]
    unknown = np.isnan(turned).any(axis=1)
    if unknown.any():
        log.logger.warning(
            "camera %s: shake unknown in %d of %d frames, keypoints left as they are there",
            view.camera,
            unknown.sum(),
            len(unknown),
        )
    still_from_shaken = Rotation.from_rotvec(np.where(unknown[:, None], 0.0, -turned)).as_matrix()
    xy = _project(camera, _directions(camera, view.xy) @ still_from_shaken.mT)
    kept = unknown[:, None, None] | np.isnan(xy)
    return replace(
        view,
        xy=np.where(kept, view.xy, xy),
        xyz_in_body=view.xyz_in_body @ still_from_shaken.mT,
    )


def _solve(camera, measured):
    """Return the rotation vectors (T, 3) that move the picture's centre, and turn it there, as measured."""
    centre = (np.array(camera.size) - 1) / 2
    arms = PROBE_PX * np.array([[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1]])
    directions = _directions(camera, centre + arms)
    f = np.diag(camera.K)[:2]
    x, y, turn = measured.T
    # Near the axis: what a small turn about the axes right, down and forward moves.
    vectors = np.column_stack([-y / f[1], x / f[0], turn])
    for _ in range(N_STEPS):
        moved = _project(camera, directions @ Rotation.from_rotvec(vectors).as_matrix().mT)
        shift = moved[:, 0] - centre
        across, down = moved[:, 1] - moved[:, 2], moved[:, 3] - moved[:, 4]
        curl = np.arctan2(across[:, 1] - down[:, 0], across[:, 0] + down[:, 1])
        off = measured - np.column_stack([shift, curl])
        step = np.column_stack([-off[:, 1] / f[1], off[:, 0] / f[0], off[:, 2]])
        vectors = vectors + step
        if np.abs(step).max() < DONE_RAD:
            break
    return vectors


def _bridged(time_s, vectors):
    """Fill short gaps of (T, 3) with lines, not before the first and after the last value."""
    known = np.flatnonzero(np.isfinite(vectors).all(axis=1))
    filled = vectors.copy()
    for last, following in pairwise(known):
        gap = slice(last + 1, following)
        ends_s = time_s[[last, following]]
        if following > last + 1 and ends_s[1] - ends_s[0] <= LONGEST_GAP_S:
            share = ((time_s[gap] - ends_s[0]) / (ends_s[1] - ends_s[0]))[:, None]
            filled[gap] = (1 - share) * vectors[last] + share * vectors[following]
    return filled


def _rows(view, table):
    """Return the row of the table of each frame of a view, (T,) int."""
    time_s = table.time_s.to_numpy(float)
    wanted = np.asarray(view.time_s, float)
    rows = np.searchsorted((time_s[:-1] + time_s[1:]) / 2, wanted)
    step_s = np.median(np.diff(time_s)) if len(time_s) > 1 else 0.01
    off_s = np.abs(time_s[rows] - wanted)
    if len(wanted) and off_s.max() > SAME_FRAME * step_s:
        at = wanted[off_s.argmax()]
        raise InputError(
            f"camera {view.camera}: expected the shake of every frame, found none at {at:.3f} s: "
            "measure the shake of the same recording, trimmed alike"
        )
    return rows


def _directions(camera, xy):
    """Return where pixels look, (..., 3), in the camera's axes, z = 1."""
    seen = cameras.undistort(camera, xy)
    return np.concatenate([seen, np.ones((*seen.shape[:-1], 1))], axis=-1)


def _project(camera, xyz_in_cam):
    """Project points that are given in the camera's axes."""
    return cameras.project(replace(camera, cam_from_world=np.eye(3, 4)), xyz_in_cam)
