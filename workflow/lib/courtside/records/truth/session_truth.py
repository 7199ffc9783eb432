"""The truth of a virtual session: where its cameras, its walks and its court points really are.

Only what evaluates a result may read it.
"""

import zipfile
from dataclasses import dataclass

import numpy as np

from courtside.geometry.camera import Camera
from courtside.records import npz
from courtside.study.errors import DAMAGED, reading

FORM = "courtside truth 1"
SPEC = {
    "camera": ("str", ("C",)),
    "size": ("int", ("C", "2")),
    "K": ("float", ("C", "3", "3")),
    "dist": ("float", ("C", "5")),
    "cam_from_world": ("float", ("C", "3", "4")),
    "court_points": ("str", ("P",)),
    "court_xyz": ("float", ("P", "3")),
}
WALK = {  # each walk has its own number of frames G
    "time_s": ("float", ("{}",)),
    "K": ("float", ("3", "3")),
    "dist": ("float", ("5",)),
    "cam_from_world": ("float", ("{}", "3", "4")),
    "principal_point_px": ("float", ("{}", "2")),
}


@dataclass(frozen=True, eq=False)
class Walk:
    """The walked camera at its frames.

    Attributes
    ----------
    time_s : (G,) float
        Time of each frame since the first: mid-exposure of the middle row.
    K, dist : (3, 3) float, (5,) float
        The lens without the stabiliser's doing, px.
    cam_from_world : (G, 3, 4) float
        Pose at `time_s`, metres.
    principal_point_px : (G, 2) float
        Principal point of each frame, which a stabiliser moves; equal to that of `K` without one.
    """

    time_s: np.ndarray
    K: np.ndarray
    dist: np.ndarray
    cam_from_world: np.ndarray
    principal_point_px: np.ndarray


@dataclass(frozen=True, eq=False)
class Truth:
    """What a virtual session really is.

    Attributes
    ----------
    cameras : list of Camera
        The fixed cameras.
    walks : dict of str to Walk
    court_points : (P,) str
        Names of the court's points.
    court_xyz : (P, 3) float
        Where they really are, metres: painted lines lie millimetres off.
    """

    cameras: list
    walks: dict
    court_points: np.ndarray
    court_xyz: np.ndarray


def write(path, cameras, walks, court_points, court_xyz):
    """Write the truth of a session to an npz file.

    Parameters
    ----------
    path : str or Path
    cameras : list of Camera
        The fixed cameras, at least one.
    walks : dict of str to Walk
    court_points : sequence of str
    court_xyz : (P, 3) float
        Metres.
    """
    arrays = {
        "camera": [camera.name for camera in cameras],
        "size": [camera.size for camera in cameras],
        "K": [camera.K for camera in cameras],
        "dist": [camera.dist for camera in cameras],
        "cam_from_world": [camera.cam_from_world for camera in cameras],
        "court_points": np.array(court_points, dtype=str),
        "court_xyz": np.asarray(court_xyz, dtype=float),
    }
    for name, walk in walks.items():
        arrays |= {f"{name}/{key}": getattr(walk, key) for key in WALK}
    npz.write(path, FORM, _spec(walks), arrays)


def read(path):
    """Read the truth of a session.

    Parameters
    ----------
    path : str or Path
        As `write` wrote it.

    Returns
    -------
    truth : Truth

    Raises
    ------
    InputError
        If the file is none of this form.
    """
    names = _walk_names(path)
    arrays = npz.read(path, FORM, _spec(names))
    rows = zip(
        *(arrays[key] for key in ("camera", "size", "K", "dist", "cam_from_world")), strict=True
    )
    with reading(path, "cameras that can be"):
        cameras = [
            Camera(str(name), tuple(size.tolist()), matrix, dist, pose)
            for name, size, matrix, dist, pose in rows
        ]
    walks = {name: Walk(**{key: arrays[f"{name}/{key}"] for key in WALK}) for name in names}
    return Truth(cameras, walks, arrays["court_points"], arrays["court_xyz"])


def _spec(walks):
    spec = dict(SPEC)
    for name in walks:
        for key, (kind, dimensions) in WALK.items():
            spec[f"{name}/{key}"] = (
                kind,
                tuple(part.format(f"G of {name}") for part in dimensions),
            )
    return spec


def _walk_names(path):
    """Return the walks that a file tells of; none of a file that `npz.read` will refuse."""
    try:
        with zipfile.ZipFile(path) as stored:
            names = [name.rpartition("/")[0] for name in stored.namelist()]
    except DAMAGED:
        return []
    return list(dict.fromkeys(name for name in names if name))
