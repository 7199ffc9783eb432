"""Correction of a network's joints: joint offsets, and limbs of nearly constant length."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise, product

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from courtside.geometry import camera as camera_models
from courtside.geometry.camera import Camera
from courtside.kinematics import skeleton_filter
from courtside.reconstruction import offset_vectors
from courtside.records.keypoints import keypoints, skeleton
from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.study.errors import InputError, StrPath, reading

# Ridge, share of the vectors' mean square: undetermined shares stay near zero. Another weight did
# not help (docs/measured/joints.md).
RIDGE = 1e-3
OUTLIER = 1.5  # ASSUME: times the median error: beyond it a frame loses weight (Huber)
ROUNDS = 15  # of reweighting
NORMAL_MEDIAN = 1.5382  # median length of a vector of three standard normal numbers
# ASSUME: skeletons below this frequency tell from where joints are seen. On `players-dev`, errors
# of position and speed are the same with 3 Hz as without this filter; with 2 Hz they are larger.
VIEW_HZ = 3.0
# ASSUME: where trunks lean further than in the fit, offsets are off by this more (standard
# deviation per axis): with it, 90 % ellipsoids of two rendered bodies in a handstand, a cartwheel,
# lying and in push-ups hold 86 to 99 %.
LEANING_M = 0.02
SIDES = ("left", "right")
COLUMNS = ["joint", "vector", "share", "sigma_m", "n"]
REMAKE = "make it again with the rule evaluate_joint_offsets"


@dataclass(frozen=True)
class Clip:
    """Skeletons of one person whose true joints are known.

    `xyz` (T, J, 3) m are the estimated skeletons, `true` (T, K, 3) m the true ones, NaN where
    either is missing; `sex` is "m", "f" or None; `accepted` (T, J, C) tells which views of the C
    `cameras` were used. Without cameras, offsets do not depend on the view.
    """

    xyz: NDArray
    true: NDArray
    sex: str | None = None
    cameras: Sequence[Camera] = ()
    accepted: NDArray | None = None


def estimate(
    clips: Sequence[Clip], joints: Sequence[str], true_joints: Sequence[str]
) -> pd.DataFrame:
    """Fit the offsets on skeletons whose true joints are known.

    `joints` and `true_joints` name the J and the K joints of the clips. The table has `COLUMNS`:
    the share of each joint (both sides together) and vector; `sigma_m`, the residual per axis; `n`,
    the number of joints used. A `ValueError` if a joint is never seen. Bodies are those of adults.
    """
    joints, true_joints, rows = list(joints), list(true_joints), []
    for joint in skeleton.LIMBS:
        columns_of, offset_of = [], []
        for clip, side in product(clips, SIDES):
            name, person = f"{side}_{joint}", (clip.xyz, joints, side, joint)
            basis = offset_vectors.every(*person, clip.sex, clip.cameras, clip.accepted)
            columns = np.stack(list(basis.values()), axis=-1)
            difference = clip.xyz[:, joints.index(name)] - clip.true[:, true_joints.index(name)]
            known = np.isfinite(difference).all(axis=-1) & np.isfinite(columns).all(axis=(-2, -1))
            columns_of.append(columns[known])
            offset_of.append(difference[known])
        design, offset = np.concatenate(columns_of), np.concatenate(offset_of)
        if not len(offset):
            raise ValueError(f"expected {joint} in a clip, found it in none of {len(clips)}")
        shares, sigma_m = _fit(design, offset)
        rows += [
            (joint, vector, share, sigma_m, len(offset))
            for vector, share in zip(basis, shares, strict=True)
        ]
    return pd.DataFrame(rows, columns=COLUMNS)


def correct(
    points: Keypoints3D,
    table: pd.DataFrame,
    sex_of: Mapping[str, str | None] | None = None,
    cameras: Sequence[Camera] = (),
) -> Keypoints3D:
    """Subtract the offsets of `estimate` from the limb joints of a record.

    `cameras` are those of the record, needed for offsets that depend on the view. `sex_of` gives
    "m", "f" or None for persons; for others the mean of both is used. Joints without a row stay. A
    joint's offset needs shoulders, hips and the joint's own limb; if one of them is missing the
    joint keeps its place and its offset. `covariance_network` contains the square of `sigma_m`,
    times the person's size, or less where it is smaller itself: this part is moved to the
    `covariance_2d` of all these joints, moved or not, because `keep` must not take a joint that
    could not be corrected for the more certain one. Where `covariance_network` is not stated, it is
    added in full. Where the trunk leans further than in the fit, `LEANING_M` is added to
    `covariance_2d`.
    """
    return _corrected(points, table, offsets(points, table, sex_of, cameras), _sizes(points))


def _sizes(points: Keypoints3D) -> NDArray:
    """Return the size (P,) of each person over that of adults."""
    return np.array([offset_vectors.size_of(xyz, points.joints.tolist()) for xyz in points.xyz])


def _corrected(
    points: Keypoints3D, table: pd.DataFrame, moved: NDArray, sizes: NDArray
) -> Keypoints3D:
    """Subtract offsets (P, T, J, 3) m of a table, and add their scatter to the covariance.

    `sizes` (P,) are those of the persons.
    """
    covariance, network = points.covariance_2d.copy(), points.covariance_network.copy()
    tilt_deg = np.nan_to_num(offset_vectors.tilt_deg(points.xyz, points.joints.tolist()))
    leaning_m = LEANING_M * sizes[:, None] * np.interp(tilt_deg, offset_vectors.LEANING_DEG, (0, 1))
    leaning = np.square(leaning_m)[..., None, None]
    for joint, side in product(table["joint"].unique(), SIDES):
        at = list(points.joints).index(f"{side}_{joint}")
        sigma_m = table.loc[table["joint"] == joint, "sigma_m"].iloc[0]
        scatter = np.square(sigma_m * sizes)[:, None, None, None]
        variance = np.trace(network[:, :, at], axis1=-2, axis2=-1)[..., None, None] / 3
        contained = np.fmin(scatter, variance)  # in what is stated; all, where nothing is
        covariance[:, :, at] += (contained + leaning) * np.eye(3)
        network[:, :, at] = (variance - contained) * np.eye(3)
    return replace(
        points,
        xyz=points.xyz - np.nan_to_num(moved),
        covariance_2d=covariance,
        covariance_network=network,
        offset=np.where(np.isfinite(moved), 0.0, points.offset),
    )


def offsets(
    points: Keypoints3D,
    table: pd.DataFrame,
    sex_of: Mapping[str, str | None] | None = None,
    cameras: Sequence[Camera] = (),
) -> NDArray:
    """Return the offsets (P, T, J, 3) m of `correct`, NaN where unknown.

    A `ValueError` if the table has offsets that depend on the view, and a camera is missing.
    """
    joints, found = list(points.joints), np.full(points.xyz.shape, np.nan)
    sizes = _sizes(points)
    sexes = [(sex_of or {}).get(str(person)) for person in points.person_id]
    by_view = table["vector"].str.startswith(offset_vectors.SEEN).any()
    used = _in_order(cameras, points.cameras) if by_view else []
    for at, (person, sex) in product(keypoints.blocks(len(points.time_s)), enumerate(sexes)):
        xyz, accepted = points.xyz[person, at], points.accepted[person, at]
        found[person, at] = of_person(xyz, accepted, joints, table, used, sizes[person], sex)
    return found


def of_person(
    xyz: NDArray,
    accepted: NDArray,
    joints: list[str],
    table: pd.DataFrame,
    cameras: Sequence[Camera],
    size: float,
    sex: str | None = None,
) -> NDArray:
    """Return the offsets (T, J, 3) m of one person's joints `xyz` (T, J, 3), NaN where unknown.

    `accepted` (T, J, C) tells which views of the C `cameras` were used, `size` is that of the whole
    take (`offset_vectors.size_of`). Of a person whose sex is not known the offsets are the mean of
    both.
    """
    found = np.full(xyz.shape, np.nan)
    for (joint, rows), side in product(table.groupby("joint"), SIDES):
        basis = offset_vectors.every(xyz, joints, side, joint, sex, cameras, accepted, size)
        offset = sum(basis[row.vector] * row.share for row in rows.itertuples())
        found[:, joints.index(f"{side}_{joint}")] = size * offset
    return found


def in_pictures(
    cameras: Sequence[Camera],
    xy: NDArray,
    xyz: NDArray,
    joints: Sequence[str],
    table: pd.DataFrame,
) -> NDArray:
    """Return keypoints (C, T, J, 2) px without the offsets with which each camera sees its joints.

    `xy` are distorted px, `xyz` (T, J, 3) m the named joints triangulated from them, of one person
    whose sex is not known. Keypoints whose offset is not known stay.
    """
    found = xy.copy()
    moved = _of_each_camera(xyz, list(joints), table, cameras)
    for camera, own, off in zip(cameras, found, moved, strict=True):
        without = camera_models.project(camera, xyz - off)
        own += np.nan_to_num(without - camera_models.project(camera, xyz))
    return found


def _of_each_camera(
    xyz: NDArray, joints: list[str], table: pd.DataFrame, cameras: Sequence[Camera]
) -> NDArray:
    """Return the offsets (C, T, J, 3) m with which each camera sees joints, NaN where unknown."""
    found, size = np.full((len(cameras), *xyz.shape), np.nan), offset_vectors.size_of(xyz, joints)
    for (joint, rows), side in product(table.groupby("joint"), SIDES):
        at = joints.index(f"{side}_{joint}")
        ways, _ = offset_vectors.directions(cameras, xyz[:, at])
        basis = offset_vectors.of_body(xyz / size, joints, side, joint)
        basis |= offset_vectors.of_each_view(xyz, joints, side, joint, ways)
        found[:, :, at] = size * sum(basis[row.vector] * row.share for row in rows.itertuples())
    return found


def _in_order(cameras: Sequence[Camera], names: NDArray) -> list[Camera]:
    by_name = {camera.name: camera for camera in cameras}
    missing = [str(name) for name in names if name not in by_name]
    if missing:
        raise ValueError(
            f"expected the cameras of the skeletons, missing {missing}, found {sorted(by_name)}: "
            "the skeletons are of another calibration; make them again"
        )
    return [by_name[str(name)] for name in names]


def correct_then_filter(
    raw: Keypoints3D,
    filtered: Keypoints3D,
    table: pd.DataFrame,
    sex_of: Mapping[str, str | None],
    cutoff_hz: ArrayLike,
    order: int,
    cameras: Sequence[Camera] = (),
) -> Keypoints3D:
    """Return skeletons that are corrected (`correct`, `keep`) and then filtered, once.

    `raw` is of `skeleton_filter.prepare`, `filtered` the same after `skeleton_filter.smooth` with
    this `cutoff_hz` (J,) and `order`. The filter comes last because the adjustment to constant limb
    lengths adds movements faster than its cut-off. With the correction after the filter, the neck
    of two development players had three times the error of acceleration, and a quarter more error
    of speed. The offsets themselves are those of filtered skeletons (`_steady_offsets`).

    The covariance is that of `filtered` plus the scatter of the offsets. This scatter is slow, so
    the filter does not reduce it.
    """
    slow_xyz = skeleton_filter.smooth_xyz(raw, np.minimum(cutoff_hz, VIEW_HZ), order)
    moved = _steady_offsets(filtered, replace(raw, xyz=slow_xyz), table, sex_of, cameras)
    joints = raw.joints.tolist()
    limbs_m = [lengths(one, joints) for one in raw.xyz - np.nan_to_num(moved)]
    sizes = _sizes(filtered)
    kept = [
        keep(_corrected(raw.frames(at), table, moved[:, at], sizes), limbs_m).xyz
        for at in keypoints.blocks(len(raw.time_s))
    ]
    raw = replace(raw, xyz=np.concatenate(kept, axis=1))
    xyz = skeleton_filter.smooth_xyz(raw, cutoff_hz, order)
    del raw, kept  # for the memory of what follows
    return replace(_corrected(filtered, table, moved, sizes), xyz=xyz)


def _steady_offsets(
    filtered: Keypoints3D,
    slow: Keypoints3D,
    table: pd.DataFrame,
    sex_of: Mapping[str, str | None],
    cameras: Sequence[Camera],
) -> NDArray:
    """Return the offsets (P, T, J, 3) m without the noise of the joints that they are made from.

    Offsets of the body are those of the `filtered` skeletons. Offsets that depend on the view are
    those of the `slow` ones: two cameras that nearly face each other multiply noise in them.
    """
    by_view = table["vector"].str.startswith(offset_vectors.SEEN)
    moved = offsets(filtered, table[~by_view], sex_of)
    return moved + offsets(slow, table[by_view], sex_of, cameras) if by_view.any() else moved


def read(path: StrPath) -> pd.DataFrame:
    """Read a CSV table of offsets with `COLUMNS`; raise `InputError` if it is not one."""
    with reading(path, "a table of joint offsets", REMAKE):
        table = pd.read_csv(path, comment="#")
        found = list(table.columns)
        known = {
            (joint, vector) for joint in skeleton.LIMBS for vector in offset_vectors.names(joint)
        }
        rows = table.reindex(columns=COLUMNS)
        pairs = set(zip(rows["joint"], rows["vector"], strict=True))
        numbers = rows[["share", "sigma_m"]].to_numpy(dtype=float)
        table = table.assign(share=numbers[:, 0], sigma_m=numbers[:, 1])
    if found != COLUMNS or not pairs <= known or not np.isfinite(numbers).all():
        joints = sorted({str(joint) for joint, _ in pairs})
        raise InputError(
            f"{path}: expected columns {COLUMNS} with joints of {skeleton.LIMBS} and numbers, "
            f"found columns {found} and joints {joints}; {REMAKE}"
        )
    return table


def _fit(design: NDArray, offset: NDArray) -> tuple[NDArray, float]:
    """Return shares (V,) of vectors (N, 3, V) that fit offsets (N, 3), and the residual."""
    weight = np.ones(len(offset))
    for _ in range(ROUNDS):
        weighted = design * weight[:, None, None]
        normal = np.einsum("nav,naw->vw", weighted, design)
        normal[np.diag_indices_from(normal)] += RIDGE * np.trace(normal) / len(normal)
        shares = np.linalg.solve(normal, np.einsum("nav,na->v", weighted, offset))
        error = np.linalg.norm(offset - design @ shares, axis=1)
        limit = OUTLIER * max(np.median(error), np.finfo(float).tiny)
        weight = np.minimum(1.0, limit / np.maximum(error, limit))
    return shares, float(np.median(error) / NORMAL_MEDIAN)


LEAST = 10  # ASSUME: frames of both sides that a median length needs
# ASSUME: a take's own median length is wrong by 5 % (one standard deviation): on the development
# bodies the ratio to the true length, after correction, has mean 0.98 and standard deviation 0.04.
LENGTH_SIGMA = 0.05
UNKNOWN_M = 0.03  # ASSUME: standard deviation per axis of a joint without a stated one
LIMB_ROUNDS = 8  # Gauss-Newton steps


def lengths(xyz: NDArray, joints: Sequence[str]) -> dict[tuple[str, str], float]:
    """Return the length of each limb segment of one person over a take, metres.

    `xyz` (T, J, 3) m is NaN where missing. Segments are named without side, `("shoulder",
    "elbow")`. The length is the median over the frames of both sides, absent if these are fewer
    than `LEAST`.
    """
    place = dict(zip(joints, np.moveaxis(xyz, 1, 0), strict=True))
    found = {}
    for start, stop in (pair for chain in skeleton.CHAINS for pair in pairwise(chain)):
        ends = [(f"{side}_{start}", f"{side}_{stop}") for side in SIDES]
        apart = [place[b] - place[a] for a, b in ends if a in place and b in place]
        apart = np.linalg.norm(np.concatenate(apart or [np.zeros((0, 3))]), axis=1)
        known = apart[np.isfinite(apart)]
        if len(known) >= LEAST:
            found[start, stop] = float(np.median(known))
    return found


def keep(points: Keypoints3D, limbs_m: Sequence[Mapping[tuple[str, str], float]]) -> Keypoints3D:
    """Move joints, as far as their uncertainty allows, so that limbs keep their length.

    `xyz` of shoulders, elbows, wrists, hips, knees and ankles changes; missing joints and limbs
    without a length stay. `limbs_m` are the `lengths` of each person. In each frame the result is
    the most probable position of a chain's three joints given their measured positions, their
    covariance (of keypoints and cameras) and the lengths: Gauss-Newton on the squared Mahalanobis
    distances and the squared relative errors of length over `LENGTH_SIGMA`. The covariance stays as
    an upper bound: the lengths come from the same joints, so wrong joints give wrong lengths.
    """
    joints, xyz = list(points.joints), points.xyz.copy()
    covariance = points.covariance_2d + np.nan_to_num(points.covariance_camera)
    for person, (side, chain) in product(range(len(xyz)), product(SIDES, skeleton.CHAINS)):
        known = limbs_m[person]
        names = [f"{side}_{joint}" for joint in chain]
        wanted = [known.get(pair) for pair in pairwise(chain)]
        if set(names) <= set(joints) and any(wanted):
            at = [joints.index(name) for name in names]
            xyz[person][:, at] = _chain(xyz[person][:, at], covariance[person][:, at], wanted)
    return replace(points, xyz=xyz)


def _chain(xyz: NDArray, covariance: NDArray, wanted: Sequence[float | None]) -> NDArray:
    """Return places (T, 3, 3) of a chain's joints, measured at `xyz`, at the wanted distances."""
    known = np.isfinite(xyz).all(axis=2)
    stated = np.isfinite(covariance).all(axis=(2, 3))[..., None, None]
    information = np.linalg.inv(np.where(stated, covariance, UNKNOWN_M**2 * np.eye(3)))
    information[~known] = np.eye(3)  # any: nothing ties a missing joint to the others
    measured = np.where(known[..., None], xyz, 0.0).reshape(-1, 9)
    prior = np.zeros((len(xyz), 9, 9))
    for at in range(3):
        prior[:, 3 * at : 3 * at + 3, 3 * at : 3 * at + 3] = information[:, at]
    place = measured
    for _ in range(LIMB_ROUNDS):
        normal, right = prior.copy(), np.einsum("nij,nj->ni", prior, measured - place)
        for at, length in enumerate(wanted):
            if length:
                rows, error = _length_rows(place, at, length, known[:, at] & known[:, at + 1])
                normal += rows[:, :, None] * rows[:, None]
                right += rows * error[:, None]
        place = place + np.linalg.solve(normal, right[..., None])[..., 0]
    return np.where(known[..., None], place.reshape(-1, 3, 3), np.nan)


def _length_rows(place: NDArray, at: int, length: float, both: NDArray) -> tuple[NDArray, NDArray]:
    """Return rows (T, 9) and right sides (T,) of one segment's length, in standard deviations."""
    first, second = slice(3 * at, 3 * at + 3), slice(3 * at + 3, 3 * at + 6)
    line = place[:, second] - place[:, first]
    size = np.maximum(np.linalg.norm(line, axis=1), np.finfo(float).tiny)
    sigma = LENGTH_SIGMA * length
    way = np.where(both, 1 / sigma, 0.0)[:, None] * line / size[:, None]
    rows = np.zeros_like(place)
    rows[:, first], rows[:, second] = -way, way
    return rows, np.where(both, (length - size) / sigma, 0.0)
