"""What one structure from motion says of the fixed cameras, or why it says nothing: npz."""

from dataclasses import dataclass

import numpy as np

from courtside.geometry import bundle, control_points, court_adjustment
from courtside.geometry.network import LENS, Network
from courtside.records import npz

FORM = "courtside ties 1"
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
}


@dataclass(frozen=True, eq=False)
class Record:
    """The fixed cameras of one structure from motion.

    Attributes
    ----------
    outcome : str
        Empty, or in one line which fixed camera was not placed, and what to film again.
    fault : str
        Empty, or in one line why the placed cameras could not be adjusted with the court points.
    sfm_cameras : list of Camera
        The fixed cameras that were registered, in the model's own frame and unit.
    n_points_seen : (C,) int
        Points of the model that each of them sees.
    ties : courtside.geometry.court_adjustment.Ties or None
        None where there is an outcome or a fault.
    images : (V,) str
        Names of the registered images.
    centres : (V, 3) float
        Where they were taken from: in the court's frame where there are ties, else in the model's.
    xyz : (N, 3) float
        Points that tie the images, in the same frame.
    residual_px : float
        Of the ties, robust standard deviation per axis; NaN without ties.
    """

    outcome: str
    fault: str
    sfm_cameras: list
    n_points_seen: np.ndarray
    ties: object
    images: np.ndarray
    centres: np.ndarray
    xyz: np.ndarray
    residual_px: float


def write(path, record):
    """Write a `Record` to an npz file."""
    sfm = [_lens(camera) for camera in record.sfm_cameras]
    reference = record.ties.knowledge.reference if record.ties else None
    knowledge = record.ties.knowledge if record.ties else None
    arrays = {
        "outcome": np.array(record.outcome),
        "fault": np.array(record.fault),
        "camera": np.array([camera.name for camera in record.sfm_cameras], dtype=str),
        "size": np.array([camera.size for camera in record.sfm_cameras], dtype=int).reshape(-1, 2),
        "n_points_seen": np.asarray(record.n_points_seen, dtype=int),
        "cam_from_sfm": _stack([c.cam_from_world for c in record.sfm_cameras], (3, 4)),
        "lens_sfm": _stack(sfm, (len(LENS),)),
        "cam_from_world": _stack(reference.cam_from_world if reference else [], (3, 4)),
        "lens": _stack(reference.lens if reference else [], (len(LENS),)),
        "information": knowledge.information if knowledge else np.zeros((0, 0)),
        "gradient": knowledge.gradient if knowledge else np.zeros(0),
        "image": np.asarray(record.images, dtype=str),
        "centre": _stack(record.centres, (3,)),
        "xyz": _stack(record.xyz, (3,)),
        "residual_px": np.array(float(record.residual_px)),
    }
    npz.write(path, FORM, SPEC, arrays)


def read(path):
    """Read a `Record`; an `InputError` says what is wrong with a file that is none."""
    found = npz.read(path, FORM, SPEC)
    sizes = [tuple(map(int, size)) for size in found["size"]]
    names = tuple(map(str, found["camera"]))
    sfm = control_points.cameras(
        bare(found["cam_from_sfm"], found["lens_sfm"], sizes), names, sizes
    )
    ties = None
    if len(found["information"]):
        reference = bare(found["cam_from_world"], found["lens"], sizes)
        knowledge = bundle.Quadratic(reference, found["information"], found["gradient"])
        ties = court_adjustment.Ties(names, tuple(sizes), knowledge)
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
    )


def bare(cam_from_world, lens, sizes):
    """Return a network of images with a lens each, without points.

    Parameters
    ----------
    cam_from_world : (C, 3, 4) float
    lens : (C, 8) float
        In the order of `courtside.geometry.network.LENS`.
    sizes : list of (int, int)
    """
    n_images, nothing = len(cam_from_world), np.zeros(0)
    return Network(
        cam_from_world=cam_from_world,
        flex=np.zeros((n_images, 5)),
        lens=lens,
        xyz=np.zeros((0, 3)),
        lens_of_image=np.arange(n_images),
        height_px=np.array([height for _, height in sizes], dtype=float),
        image_idx=nothing.astype(int),
        point_idx=nothing.astype(int),
        xy=np.zeros((0, 2)),
        sigma_px=nothing,
        loss_scale=nothing,
        flex_sigma=np.zeros((n_images, 5)),
        lens_mean=lens,
        lens_sigma=np.full(np.shape(lens), np.inf),
        xyz_mean=np.zeros((0, 3)),
        xyz_sigma=nothing,
    )


def _lens(camera):
    k1, k2, p1, p2, _ = camera.dist
    K = camera.K
    return [K[1, 1], K[0, 0] / K[1, 1], K[0, 2], K[1, 2], k1, k2, p1, p2]


def _stack(values, shape):
    return np.asarray(values, dtype=float).reshape(-1, *shape)
