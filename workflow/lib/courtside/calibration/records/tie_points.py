"""npz: tie-point constraints on the fixed cameras of a session, or why there are none."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.calibration.bundle import conversion, problem, solver
from courtside.calibration.bundle.problem import LENS
from courtside.calibration.court import joint_adjustment
from courtside.calibration.records.support import Support
from courtside.geometry.camera import Camera
from courtside.records import npz
from courtside.study.errors import StrPath, reading

FORM = "courtside ties 4"
SPEC = {
    "outcome": ("str", ()),
    "fault": ("str", ()),
    "camera": ("str", ("C",)),
    "size": ("int", ("C", "2")),
    "n_points_seen": ("int", ("C",)),
    "cam_from_sfm": ("float", ("C", "3", "4")),
    "lens_sfm": ("float", ("C", "8")),
    "cam_from_world": ("float", ("A", "3", "4")),
    "lens": ("float", ("A", "8")),
    "information": ("float", ("K", "K")),
    "gradient": ("float", ("K",)),
    "image": ("str", ("V",)),
    "centre": ("float", ("V", "3")),
    "xyz": ("float", ("N", "3")),
    "residual_px": ("float", ()),
    "strain": ("float", ()),
    "n_maps": ("int", ("2",)),
    "explained": ("float", ("3",)),
    "doubted": ("str", ("3",)),
}


@dataclass(frozen=True, eq=False)
class Record:
    """The fixed cameras of one structure from motion."""

    outcome: str  # empty, or in one line which fixed camera was not placed, and what to film again
    fault: str  # empty, or why the placed cameras could not be adjusted with the court points
    sfm_cameras: list[Camera]  # the registered fixed cameras, in the model's own frame and unit
    n_points_seen: NDArray  # (C,) int: points of the model that each of them sees
    ties: joint_adjustment.Ties | None  # None where there is an outcome or a fault
    images: NDArray  # (V,) str: names of the registered images
    # (V, 3): their projection centres: in the court's frame where there are ties, else the model's.
    centres: NDArray
    xyz: NDArray  # (N, 3): tie points, in the same frame
    residual_px: float  # of the ties, robust standard deviation per axis; NaN without ties
    # Number of maps of the same matches that place the images as this one does, itself included,
    # and number of all maps made.
    n_maps: tuple[int, int]
    support: Support  # as mapped or as adjusted with the clicks, whichever is better
    strain: float = np.nan  # of the ties by the clicks (`joint_adjustment.strain`); NaN without


def write(path: StrPath, record: Record) -> None:
    """Write a `Record` to an npz file."""
    sfm = conversion.network_of(record.sfm_cameras)
    reference = record.ties.knowledge.reference if record.ties else None
    knowledge, support = record.ties.knowledge if record.ties else None, record.support
    arrays = {
        "outcome": np.array(record.outcome),
        "fault": np.array(record.fault),
        "camera": np.array([camera.name for camera in record.sfm_cameras], dtype=str),
        "size": np.array([camera.size for camera in record.sfm_cameras], dtype=int).reshape(-1, 2),
        "n_points_seen": np.asarray(record.n_points_seen, dtype=int),
        "cam_from_sfm": sfm.cam_from_world,
        "lens_sfm": sfm.lens,
        "cam_from_world": _stack(reference.cam_from_world if reference else [], (3, 4)),
        "lens": _stack(reference.lens if reference else [], (len(LENS),)),
        "information": knowledge.information if knowledge else np.zeros((0, 0)),
        "gradient": knowledge.gradient if knowledge else np.zeros(0),
        "image": np.asarray(record.images, dtype=str),
        "centre": _stack(record.centres, (3,)),
        "xyz": _stack(record.xyz, (3,)),
        "residual_px": np.array(float(record.residual_px)),
        "strain": np.array(float(record.strain)),
        "n_maps": np.array(record.n_maps, dtype=int),
        "explained": np.array([support.share, support.image_share, support.pair_share]),
        "doubted": np.array([support.image, *support.pair], dtype=str),
    }
    npz.write(path, FORM, SPEC, arrays)


def read(path: StrPath) -> Record:
    """Read a `Record`; an `InputError` says what is wrong with the file."""
    found = npz.read(path, FORM, SPEC)
    with reading(path, "cameras and ties that fit one another"):
        return _record(found)


def _record(found: Mapping[str, NDArray]) -> Record:
    sizes = [(int(width), int(height)) for width, height in found["size"]]
    names, heights_px = tuple(map(str, found["camera"])), found["size"][:, 1]
    sfm = conversion.cameras_of(
        problem.without_points(found["cam_from_sfm"], found["lens_sfm"], heights_px), names, sizes
    )
    ties = None
    if len(found["information"]):
        reference = problem.without_points(found["cam_from_world"], found["lens"], heights_px)
        knowledge = solver.Quadratic(reference, found["information"], found["gradient"])
        ties = joint_adjustment.Ties(names, tuple(sizes), knowledge)
    return Record(
        str(found["outcome"]),
        str(found["fault"]),
        sfm,
        found["n_points_seen"],
        ties,
        found["image"],
        found["centre"],
        found["xyz"],
        float(found["residual_px"]),
        (int(found["n_maps"][0]), int(found["n_maps"][1])),
        _support(found["explained"], found["doubted"]),
        float(found["strain"]),
    )


def _support(shares: NDArray, names: NDArray) -> Support:
    (share, image_share, pair_share), (image, one, other) = map(float, shares), map(str, names)
    return Support(share, image, image_share, (one, other), pair_share)


def _stack(values: ArrayLike, shape: tuple[int, ...]) -> NDArray:
    return np.asarray(values, dtype=float).reshape(-1, *shape)
