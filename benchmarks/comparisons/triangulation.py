"""Triangulation of 4 cameras x 26 joints, with outliers and gaps."""

import numpy as np

import machine
import peers
import rows
import scene

NAME = "triangulation"
LIMIT = "bytes of the keypoints read and the points written, over the memory's"
BOUNDS = (
    "passes of NumPy over arrays that hold every subset of views: each point is solved once for "
    "each view that may be wrong, so the machine's least is far away, and the time grows with "
    "points and subsets alone"
)
FRAMES = 250  # of the smallest scene
RANSAC_POINTS = 65  # of the smallest scene: 20 ms each


def compare(given):
    """Return the rows of this project, Pose2Sim, aniposelib and Caliscope."""
    found = []
    for times in rows.TIMES[: 2 if given.quick else None]:
        made = scene.spoiled(frames=times * FRAMES)
        measured = peers.measured(_runs(made, times, given), made, given.environments)
        ours = measured[rows.OURS][1]
        found += [_row(made, times, ours, method, *one) for method, one in measured.items()]
    return found


def _runs(made, times, given):
    """Return which program runs which script with which arguments."""
    joints, repeats = str(scene.JOINTS), str(given.repeats)
    plain = str(made["xy"].shape[1])
    anipose = (repeats, joints, str(times * RANSAC_POINTS), "0")
    ours = (None, "triangulate_courtside.py", (repeats,))
    return [
        ours,
        ("pose2sim", "triangulate_pose2sim.py", ("1", plain)),
        ("aniposelib", "triangulate_aniposelib.py", anipose),
        ("caliscope", "triangulate_caliscope.py", (repeats, joints)),
        ours,
    ]


def _row(made, times, ours, method, cpu_s, xyz):
    least_bytes = made["xy"].nbytes + made["score"].nbytes + made["xyz"].nbytes
    share = len(xyz) / len(ours)
    away = [1000 * np.linalg.norm(each[: len(xyz)] - made["xyz"][: len(xyz)], axis=-1)
            for each in (xyz, ours)]  # fmt: skip
    known = np.isfinite(away[0]) & np.isfinite(away[1])
    return rows.Row(
        comparison=NAME, method=method, ours=xyz is ours, unit="point", work=len(xyz), times=times,
        cpu_s=cpu_s, limit_s=share * least_bytes / machine.measured().bytes_s,
        error_median=np.median(away[0][known]), error_p95=np.percentile(away[0][known], 95),
        error_ours_p95=np.percentile(away[1][known], 95), error_unit="mm",
    )  # fmt: skip
