"""A project folder for Pose2Sim: cameras, 2D and 3D keypoints, settings; and its TRC files back.

Pose2Sim sorts the folders of 2D keypoints by the last number in their names and takes the cameras
of the calibration in the file's order, so the names carry that order. Its filter replaces what
follows the last `_` in the name of a TRC file, so that is the frames. Its frames are the uniform
times of the 3D keypoints: the clocks of the cameras are already taken into account.
"""

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w
from numpy.typing import NDArray

from courtside.exports import markers, opensim, trc
from courtside.geometry import camera as camera_models
from courtside.geometry.camera import Camera
from courtside.records.keypoints import missing_reason
from courtside.records.keypoints.keypoints import Keypoints3D, unknown_errors
from courtside.records.keypoints.skeleton import Skeleton
from courtside.study.errors import InputError, StrPath
from courtside.study.execution import log
from courtside.study.execution.files import atomic_folder

# Skeletons with a name of their own in Pose2Sim, points in the same order.
MODELS = {
    "blazepose33": "BLAZEPOSE",
    "body25": "BODY_25",
    "body25b": "BODY_25B",
    "halpe26": "HALPE_26",
    "coco17": "COCO_17",
}
OWN = "COURTSIDE"
SOURCE = "Courtside"
# ASSUME: diagonal of the box around all joints of a person, median of a take.
LARGE_M = (0.1, 4.0)
# ASSUME: of trunks and legs of persons who stand, median of a take: share of their length along the
# vertical. Laboratories have the floor at zero; joints of who lies are between two heights over it.
UPRIGHT, FLOOR_M, LYING_M = 0.8, 0.5, (-0.1, 1.0)
HEIGHTS = [(f"left_{joint}", f"right_{joint}") for joint in ("ankle", "hip", "shoulder")]
LEAST_VIEWS = 2  # of a point in a file that does not say: triangulation needs two


def write_project(
    folder: StrPath,
    cameras: Sequence[Camera],
    views: Mapping[str, tuple[NDArray, NDArray]],
    points: Keypoints3D,
    *,
    skeleton: str,
) -> None:
    """Write a project of one take.

    The folder, whose name begins the names of Pose2Sim's own results, is replaced as a whole.
    `views` are px (P, T, J, 2) and scores (P, T, J) by camera, at the times and with the persons of
    `points`; `skeleton` is the name of the joints' skeleton. Raises `ValueError` if a camera has no
    view, or a view other frames, persons or joints than the points.
    """
    shape = points.xyz.shape[:3]
    for camera in cameras:
        if camera.name not in views or views[camera.name][0].shape != (*shape, 2):
            raise ValueError(f"expected keypoints {shape} of camera {camera.name}")
    named = replace(points, joints=np.array(markers.names(list(points.joints))))
    with atomic_folder(folder) as made:
        camera_models.write_toml(made / "calibration" / "Calib.toml", cameras, source=SOURCE)
        for number, camera in enumerate(cameras, start=1):
            _write_2d(made / "pose", f"{camera.name}_{number:02d}", *views[camera.name])
        for person, name in enumerate(points.person_id):
            file = f"{Path(folder).name}_{name}_1-{len(points.time_s)}.trc"
            trc.write(made / "pose-3d" / file, named, person)
        opensim.write_markers(made / "kinematics" / f"Markers_{OWN}.xml", list(points.joints))
        with (made / "Config.toml").open("wb") as stream:
            tomli_w.dump(_settings(points, skeleton), stream)


def _write_2d(folder: Path, name: str, xy: NDArray, score: NDArray) -> None:
    folder = folder / f"{name}_json"
    folder.mkdir(parents=True)
    seen = np.isfinite(xy).all(axis=-1) & np.isfinite(score)
    table = np.concatenate([xy, score[..., None]], axis=-1)
    table = np.where(seen[..., None], table, 0.0).round(4)
    for frame in range(xy.shape[1]):
        people = [
            {"person_id": [person], "pose_keypoints_2d": table[person, frame].ravel().tolist()}
            for person in range(len(xy))
        ]
        text = json.dumps({"version": 1.3, "people": people})
        (folder / f"{name}_{frame:06d}.json").write_text(text, encoding="utf-8", newline="\n")


def _settings(points: Keypoints3D, skeleton: str) -> dict[str, Any]:
    """Return the settings by which Pose2Sim triangulates and filters these keypoints."""
    rate = points.rate_hz
    pose: dict[str, Any] = {"pose_model": MODELS.get(skeleton, OWN)}
    if skeleton not in MODELS:
        children = [
            {"name": n, "id": at} for at, n in enumerate(markers.names(list(points.joints)))
        ]
        pose[OWN] = {"name": "Root", "id": "None", "children": children}
    return {
        "project": {
            "multi_person": len(points.person_id) > 1,
            "frame_rate": round(rate) if np.isclose(rate, round(rate), atol=1e-3) else rate,
            "frame_range": "all",
        },
        "pose": pose,
        # The numbers are Pose2Sim's own defaults, as in the Config.toml of its demonstration.
        "triangulation": {
            "reproj_error_threshold_triangulation": 15,
            "likelihood_threshold_triangulation": 0.3,
            "min_cameras_for_triangulation": 2,
            "interp_if_gap_smaller_than": 20,
            "interpolation": "linear",
            "fill_large_gaps_with": "nan",
            "show_interp_indices": False,
            "handle_LR_swap": False,
            "undistort_points": True,  # our cameras have lenses
            "make_c3d": False,
        },
        "filtering": {"type": "butterworth", "display_figures": False, "make_c3d": False},
    }


def read_takes(files: Mapping[str, StrPath], skeleton: Skeleton, *, model: str) -> Keypoints3D:
    """Read 3D keypoints of another program, one TRC file for each person.

    They stay in the file's frame with z up, without views or known covariances, and get the name
    `model`. The skeleton's joints are looked for among the markers, under Pose2Sim's names or their
    own. Raises `InputError` if a file is no TRC file, has none of the joints, lengths of no person,
    another axis up than Y, or other times than the first one.
    """
    found: list[list[NDArray]] = []
    for path in files.values():
        names, _, time_s, xyz = trc.read(path)
        places = markers.joints_of(names, skeleton.joints)
        if not any(place is not None for place in places):
            raise InputError(
                f"{path}: expected markers of skeleton {skeleton.name} such as "
                f"{markers.name(skeleton.joints[0])}, found {', '.join(names[:5])}; name their "
                "skeleton"
            )
        if not found:
            times, first = time_s, path
        if len(time_s) != len(times) or not np.allclose(time_s, times, atol=1e-4):
            raise InputError(f"{path}: expected the times of {first}, found others; cut both alike")
        _check_size(path, xyz[:, [k for k in places if k is not None]])
        found.append([np.full((len(xyz), 3), np.nan) if k is None else xyz[:, k] for k in places])
        _check_axes(path, skeleton.joints, np.array(found[-1]))
    xyz = np.array(found).swapaxes(1, 2)
    there = np.isfinite(xyz).all(axis=-1)
    return Keypoints3D(
        cameras=np.array([], dtype=str),
        model=model,
        joints=np.array(skeleton.joints),
        person_id=np.array(list(files)),
        time_s=times,
        xyz=np.where(there[..., None], xyz, np.nan),
        **unknown_errors(xyz),
        n_views=np.where(there, LEAST_VIEWS, 0),
        reproj_error_px=np.empty((*there.shape, 0)),
        accepted=np.empty((*there.shape, 0), dtype=bool),
        swapped=np.empty((*there.shape, 0), dtype=bool),
        reason=np.where(there, missing_reason.OK, missing_reason.UNSEEN).astype(np.uint8),
    )


def _check_size(path: StrPath, xyz: NDArray) -> None:
    """Raise `InputError` if joints (T, J, 3) m are too near or too far for those of a person."""
    extent = np.linalg.norm(np.fmax.reduce(xyz, axis=1) - np.fmin.reduce(xyz, axis=1), axis=1)
    seen = extent[extent > 0]  # several joints
    if len(seen) and not LARGE_M[0] <= np.median(seen) <= LARGE_M[1]:
        raise InputError(
            f"{path}: expected joints of a person over {LARGE_M[0]:g} to {LARGE_M[1]:g} m, found "
            f"them over {np.median(seen):.3g} m; correct `Units` in its header, or export it again"
        )


def _check_axes(path: StrPath, joints: Sequence[str], xyz: NDArray) -> None:
    """Raise `InputError` if a person (J, T, 3) stands on the floor along the file's X or Z.

    Who lies straight, feet near zero, looks alike: at a height of one who lies, it is a warning.
    """
    if not all(joint in joints for pair in HEIGHTS for joint in pair):
        return
    low, hips, high = (xyz[[joints.index(one) for one in pair]].mean(axis=0) for pair in HEIGHTS)
    known = np.isfinite(low + hips + high).all(axis=1)
    if not known.any():
        return
    parts = [part[known] for part in (hips - low, high - hips)]
    shares = [part / np.linalg.norm(part, axis=1, keepdims=True) for part in parts]
    along = np.median(shares, axis=1).min(axis=0)
    axis = int(np.argmax(along))
    lowest, highest = (
        np.median(of.reduce(xyz[:, known], axis=0), axis=0) for of in (np.fmin, np.fmax)
    )
    if axis == 2 or along[axis] < UPRIGHT or abs(lowest[axis]) > FLOOR_M:
        return
    name = "XYZ"[trc.WORLD_AXES.index(axis)]
    line = f"expected Y up, found the trunk along {name}; export it with Y up"
    if not (LYING_M[0] < lowest[2] and highest[2] < LYING_M[1]):
        raise InputError(f"{path}: {line}")
    log.tell(f"{line}, unless the person lies", path)
