"""The world of cameras that people alone place: its unit from their height, its floor from feet.

The origin lies on the floor below the middle of people's ways, z is up, and x runs along the floor
as the line from the first camera to the second.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from courtside.calibration import point_covariance
from courtside.calibration.bundle import selection
from courtside.geometry import rotations
from courtside.geometry.camera import Camera
from courtside.geometry.similarity import Sim3
from courtside.records.keypoints import skeleton
from courtside.study.errors import InputError

# ASSUME: leg and trunk as BlazePose heavy sees them, share of the height: 0.722 +- 0.006 of the
# four persons of players-dev; BlazePose full sees 0.715. Anatomical ones are longer (0.78, Winter
# 2009, fig. 4.1).
OF_HEIGHT = 0.722
OF_HEIGHT_SIGMA = 0.01  # ASSUME: between persons, share of the length
NETWORK_SIGMA = 0.01  # ASSUME: what is alike for all persons: networks differ by as much
STATED_SIGMA_M = 0.01  # of a height to the centimetre, in shoes or not
ANKLE = 0.055  # ASSUME: of the height: an ankle above the floor while its foot stands (players-dev)
STANDING = 0.1  # the quantile of ankles' heights that is one of feet that stand
TILT_M = 0.5  # ASSUME: feet spread less than this tell less of the floor's tilt than bodies do
ROUNDS = 30  # of new weights
EPSILON_M = 1e-3  # nearer to the floor all weights are alike
TINY_STEP = 1e-6  # of a similarity, to differentiate by
LEAST_FRAMES = 20  # ASSUME: that the length of a body needs


def length(xyz: NDArray) -> float:
    """Return the length of leg and trunk of a person by joints (T, J, 3), NaN where unknown.

    The sum of the medians of its parts over frames: no posture shortens it. Joints are those of
    `skeleton.JOINTS`.
    """
    place = {name: xyz[:, at] for at, name in enumerate(skeleton.JOINTS)}
    middle = {part: _middle(place, part) for part in ("shoulder", "hip")}
    pairs = [[(place[f"{side}_{a}"], place[f"{side}_{b}"]) for side in ("left", "right")]
             for a, b in (("hip", "knee"), ("knee", "ankle"))]  # fmt: skip
    total = 0.0
    for part in [*pairs, [(middle["hip"], middle["shoulder"])]]:
        apart = np.concatenate([np.linalg.norm(a - b, axis=1) for a, b in part])
        known = apart[np.isfinite(apart)]
        total += float(np.median(known)) if len(known) >= LEAST_FRAMES else np.nan
    return total


def _middle(place: dict[str, NDArray], part: str) -> NDArray:
    return (place[f"left_{part}"] + place[f"right_{part}"]) / 2


def metres(
    lengths: Sequence[Sequence[float]], heights_m: Sequence[Sequence[float | None]]
) -> tuple[float, float]:
    """Return metres per unit of length, and the standard deviation of that as a share of it.

    Both arguments are by take: `lengths` of the persons found, those seen most first, `heights_m`
    of those stated to be in it. Of several persons the tallest is taken for the longest. Takes of
    persons with unknown heights tell nothing. `InputError` if no take does.
    """
    ratios, known = list[float](), set[float]()
    for found, stated in zip(lengths, heights_m, strict=True):
        heights = [one for one in stated if one]
        longest = sorted([one for one in found if np.isfinite(one)][: len(stated)])
        if len(heights) == len(stated) == len(longest):
            known |= set(heights)
            ratios += [
                OF_HEIGHT * height / own
                for height, own in zip(sorted(heights), longest, strict=True)
            ]
    if not ratios:
        raise InputError(
            "people: expected `height_m` of every subject of a take whose legs and trunk are seen, "
            f"found heights {[list(one) for one in heights_m]} of {[len(one) for one in lengths]} "
            "persons; state them: nothing else tells the unit of length"
        )
    of_height = np.hypot(OF_HEIGHT_SIGMA, STATED_SIGMA_M / min(known)) / np.sqrt(len(known))
    return float(np.exp(np.mean(np.log(ratios)))), float(np.hypot(of_height, NETWORK_SIGMA))


def floor(xyz: NDArray, cameras: Sequence[Camera]) -> Sim3:
    """Return `world_from_cameras` for joints (T, J, 3) m of all persons, NaN where unknown.

    The lowest places of ankles lie in one plane. Where people stay in one place, it is
    perpendicular to the mean line from ankles to shoulders.
    """
    place = {name: xyz[:, at] for at, name in enumerate(skeleton.JOINTS)}
    upward = rotations.unit(_middle(place, "shoulder") - _middle(place, "ankle"))
    up = rotations.unit(np.nanmedian(upward, axis=0))
    ankles = np.concatenate([place["left_ankle"], place["right_ankle"]])
    ankles = ankles[np.isfinite(ankles).all(axis=1)]
    middle = np.median(ankles, axis=0)
    centres = [camera.centre_in_world for camera in cameras]
    turn = axes(up, centres[1] - centres[0])
    slopes, offset = _lowest_plane((ankles - middle) @ turn.T)
    normal = np.array([*-slopes, 1.0])
    turn = axes(rotations.unit(turn.T @ normal), centres[1] - centres[0])
    sole = offset / np.linalg.norm(normal) - ANKLE * length(xyz) / OF_HEIGHT
    return Sim3(1.0, turn, -turn @ middle - [0, 0, sole])


def axes(up: NDArray, along: NDArray) -> NDArray:
    """Return the rotation (3, 3) to axes with z up and x along a direction."""
    x = rotations.unit(along - (along @ up) * up)
    return np.stack([x, np.cross(up, x), up])


def _lowest_plane(xyz: NDArray) -> tuple[NDArray, float]:
    """Return slopes (2,) and offset of z over x and y: the plane of a low quantile of points.

    Quantile regression (Koenker & Bassett 1978) by weighted least squares; slopes are held to 0.
    """
    design = np.column_stack([xyz[:, :2], np.ones(len(xyz))])
    found = np.array([0.0, 0.0, np.quantile(xyz[:, 2], STANDING)])
    for _ in range(ROUNDS):
        off = xyz[:, 2] - design @ found
        weight = np.where(off > 0, STANDING, 1 - STANDING) / np.maximum(np.abs(off), EPSILON_M)
        held = np.diag([1.0, 1.0, 0.0]) * weight.sum() * TILT_M**2
        found = np.linalg.solve(design.T * weight @ design + held, design.T @ (weight * xyz[:, 2]))
    return found[:2], float(found[2])


def of_shape(
    cameras: Sequence[Camera],
    covariance: NDArray,
    xyz: NDArray,
    scale_sigma: float | None,
) -> NDArray:
    """Return the covariance (K, K) of cameras in the world that people's joints define.

    `covariance` is that of a network's columns, with little known of place, direction and scale of
    the whole. Errors of these three are taken out: the world moves with joints `xyz` (N, 3) m (an
    S-transformation, Baarda 1973). `scale_sigma`, a share, is then added about their middle; None
    of cameras whose scale the covariance knows, which stays as it is.
    """
    network, middle = selection.of_cameras(cameras), xyz.mean(axis=0)
    moved = [
        _about(middle, 1.0, rotations.rotation_from_rodrigues(e)) for e in TINY_STEP * np.eye(3)
    ]
    moved += [Sim3(1.0, np.eye(3), e) for e in TINY_STEP * np.eye(3)]
    if scale_sigma is not None:
        moved.append(_about(middle, 1 + TINY_STEP, np.eye(3)))
    of_cameras = np.stack([
        selection.of_cameras([one.camera(camera) for camera in cameras]).difference(network)
        for one in moved
    ], axis=1) / TINY_STEP  # fmt: skip
    of_points = np.stack([(one.points(xyz) - xyz).ravel() for one in moved], axis=1) / TINY_STEP
    by_column = point_covariance.sensitivity(network, xyz).reshape(xyz.size, -1)
    keep = np.eye(len(covariance)) - of_cameras @ (np.linalg.pinv(of_points) @ by_column)
    scale = of_cameras[:, -1:] * (scale_sigma or 0.0)
    return keep @ covariance @ keep.T + scale @ scale.T


def _about(middle: NDArray, scale: float, rotation: NDArray) -> Sim3:
    """Return a similarity that leaves a point where it is."""
    return Sim3(scale, rotation, middle - scale * rotation @ middle)
