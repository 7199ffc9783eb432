"""Lift the 2D joints of a colour picture into 3D by the depth camera beside it."""

import itertools
from collections.abc import Iterable, Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from courtside.depth.surfaces import DepthRig, Sampler, Sampling
from courtside.geometry import camera, rotations
from courtside.geometry.camera import Camera
from courtside.records.devices.device_motion import DeviceMotion
from courtside.records.keypoints import missing_reason, skeleton
from courtside.records.keypoints.keypoints import Keypoints2D
from courtside.study.errors import InputError
from courtside.study.execution import log

# Depth of a joint behind the visible skin from any side, metres: the radius of the limb there.
# ASSUME: limbs are round: half of circumference / pi of adults' medians in ANSUR II (Gordon et al.
# 2014: wrist 0.17, elbow about 0.27, ankle 0.23, knee about 0.38 m), rounded to 5 mm; shoulder and
# hip about half the depth of the chest and pelvis there. Joints of the face lie on the skin.
# Measured values of a session should replace these.
SKIN_TO_JOINT_M = {
    "shoulder": 0.05,
    "elbow": 0.04,
    "wrist": 0.025,
    "hip": 0.09,
    "knee": 0.055,
    "ankle": 0.035,
    "heel": 0.03,
    "foot_index": 0.02,
    "big_toe": 0.02,
    "neck": 0.06,
    "head_top": 0.08,
    "mid_hip": 0.09,
}
OTHERS_M = 0.01  # ASSUME: what has no entry (fingers, small toe, ear) is thin, or on the skin
ON_SKIN = ("nose", "eye", "eye_inner", "eye_outer", "mouth")
# ASSUME: this block has no source but the development takes (CONTRIBUTING.md).
LEAST_RADIUS_M = 0.02  # of the limb at a joint, for the size of its window
# Of the longer interval of colour and depth: an older or newer depth picture shows another pose.
LAG = 0.75
SLOWER = 1.5  # times colour's interval: depth that comes less often is told
FIRST = 11  # depth pictures that tell their interval
BONE_TOLERANCE, BONE_TOLERANCE_M = 0.25, 0.06  # share of a bone's length, and least tolerance
FEWEST = 10  # frames that a bone's median length needs
FROM_BODY_M = {True: 0.4, False: 1.1}  # largest depth from the trunk: joints of the trunk, others
# Share of the joints seen that have depth, without a warning; the virtual depth camera lifts 98 %.
LEAST_LIFTED = 0.2
# ASSUME: median distance from shoulder to hip: adults have 0.45 to 0.55 m, children 0.3 m. A
# unit that is wrong by the factors of depth cameras (2, 2.5, 4, 8, 10) lies outside.
TRUNK_M = (0.3, 0.8)
COVERED_M = 0.05  # a limb covers a joint if the depths of both agree to this


def lift_take(
    source: str,
    view: Keypoints2D,
    depth_frames: Iterable[tuple[float, NDArray]],
    rig: DepthRig,
    *,
    bones: Sequence[tuple[str, str]],
    baseline_m: float,
    skin_m: Mapping[str, float] | None = None,
    beyond_m: Mapping[str, float] | None = None,
    sampling: Sampling | None = None,
) -> tuple[DeviceMotion, NDArray]:
    """Lift the joints of one person over a take to a motion named `source`.

    `view` has one person (P = 1), its times on the recording's clock, increasing. `depth_frames`
    are times and depth (h, w) uint16, in order of time; few are held at once. `bones` are pairs of
    joints whose distance is constant; `baseline_m`, between the imagers that depth comes from, is
    for the noise. `skin_m` is the depth of each joint behind the skin, by its name or its name
    without side, by default `SKIN_TO_JOINT_M`; `beyond_m` how far the network places a joint beyond
    the end of its limb, which is subtracted, by names without side, of `skeleton.PARENT`.

    The motion is in the colour camera's axes (x right, y down, z forward), metres. The reason is
    `NO_DEPTH` if there is no depth or another part of the body is in front, else that of the 2D
    joint. Beside it, the standard deviation (T, J) m of the depth along the camera's axis, by the
    noise of one pixel alone. An `InputError` if a joint is not in a given `skin_m`.

    Each joint has up to three candidate surfaces: the nearest one whose joint keeps the lengths of
    the bones (medians over the take) is used, from the trunk outwards. A joint without one is
    missing: only the surface that covers it is visible.
    """
    names = list(map(str, view.joints))
    sampling = sampling or Sampling()
    skin = by_joint(names, skin_m)
    is_trunk = np.isin(names, skeleton.TRUNK)
    radius_m = np.maximum(skin, LEAST_RADIUS_M)
    sampler = Sampler(rig, radius_m, is_trunk, baseline_m, sampling)
    xy = np.where((view.reason[0] == missing_reason.OK)[..., np.newaxis], view.xy[0], np.nan)
    z, z_body = _sampled(source, sampler, xy, view.time_s, depth_frames)
    joints_at = _behind_skin(rig.colour, xy, z, skin)
    chain = _chain(names, bones, is_trunk)
    radius_px_m = radius_m * rig.colour.K[0, 0]  # px at a depth of 1 m
    xyz, depth = _placed(joints_at, xy, z, z_body, radius_px_m, chain, is_trunk)
    xyz = _drawn_back(xyz, names, beyond_m or {})
    missing = np.isnan(xyz[..., 0]) & (view.reason[0] == missing_reason.OK)
    motion = DeviceMotion(
        source=source,
        kind="rgbd",
        joints=np.array(names),
        time_s=np.asarray(view.time_s, dtype=float),
        xyz=xyz,
        reason=np.where(missing, missing_reason.NO_DEPTH, view.reason[0]).astype(np.uint8),
        performed=np.ones(len(xy), dtype=bool),
    )
    return motion, sampler.sigma_z(depth)


def _placed(joints_at, xy, z, z_body, radius_px_m, chain, is_trunk) -> tuple[NDArray, NDArray]:
    """Return the joints (T, J, 3) on their surfaces, and the depths (T, J) of these."""
    lengths = _lengths(joints_at[:, :, 0], chain)
    xyz = np.full((*xy.shape[:2], 3), np.nan)
    depth = np.full(xy.shape[:2], np.nan)
    for t in range(len(xy)):
        chosen = _choose(joints_at[t], z[t], z_body[t], chain, lengths, is_trunk)
        _uncover(chosen, xy[t], z[t], radius_px_m, chain, is_trunk)
        for joint, surface in chosen.items():
            xyz[t, joint], depth[t, joint] = joints_at[t, joint, surface], z[t, joint, surface]
    return xyz, depth


def by_joint(names: Sequence[str], skin_m: Mapping[str, float] | None = None) -> NDArray:
    """Return the depth of each joint behind the skin (J,), metres.

    `skin_m` gives it by the joint's name or its name without side; without it, `SKIN_TO_JOINT_M`
    does, and `OTHERS_M`. Raise `InputError` if a joint is not in a given `skin_m`.
    """
    plain = [skeleton.without_side(name) for name in names]
    table = dict.fromkeys(ON_SKIN, 0.0) | dict(SKIN_TO_JOINT_M if skin_m is None else skin_m)
    missing = [n for n, p in zip(names, plain, strict=True) if n not in table and p not in table]
    if missing and skin_m is not None:
        raise InputError(
            f"lift_depth.skin_m: expected a depth behind the skin of every joint, found none of "
            f"{', '.join(missing)}; add them, or leave skin_m out"
        )
    values = [table.get(n, table.get(p, OTHERS_M)) for n, p in zip(names, plain, strict=True)]
    return np.array(values)


def nearest_frames(
    times_s: NDArray, frames: Iterable[tuple[float, NDArray]], most_s: float
) -> Iterator[NDArray | None]:
    """Yield for each increasing time the frame taken nearest to it.

    `frames` are (time, frame) in order of time. It is None if the nearest is farther off than
    `most_s`.
    """
    frames = iter(frames)
    before, after = None, next(frames, None)
    for time_s in times_s:
        while after is not None and after[0] <= time_s:
            before, after = after, next(frames, None)
        near = [frame for frame in (before, after) if frame is not None]
        best = min(near, key=lambda frame: abs(frame[0] - time_s), default=None)
        close = best is not None and abs(best[0] - time_s) <= most_s
        yield best[1] if best is not None and close else None


def _sampled(source, sampler, xy, times_s, depth_frames) -> tuple[NDArray, NDArray]:
    """Return the surfaces (T, J, 3) and the depth of the body (T,), metres."""
    z, z_body = np.full((*xy.shape[:2], 3), np.nan), np.full(len(xy), np.nan)
    depth_frames = iter(depth_frames)
    first = list(itertools.islice(depth_frames, FIRST))
    steps_s = [np.diff(times_s), np.diff([time_s for time_s, _ in first])]
    medians_s = [np.median(one) for one in steps_s if len(one)]
    if len(medians_s) == 2 and medians_s[1] > SLOWER * medians_s[0]:
        log.logger.warning(
            "%s: expected depth as often as colour, found it every %.0f ms and colour every %.0f: "
            "frames between take depth of another time, where fast joints are off by more than "
            "sigma says; record both at one rate",
            source,
            1000 * medians_s[1],
            1000 * medians_s[0],
        )
    frames = itertools.chain(first, depth_frames)
    for t, depth in enumerate(nearest_frames(times_s, frames, LAG * max(medians_s, default=1.0))):
        if depth is not None:
            z[t], z_body[t] = sampler.surfaces(xy[t], depth)
    return z, z_body


def _behind_skin(colour: Camera, xy: NDArray, z: NDArray, skin: NDArray) -> NDArray:
    """Return the joints (T, J, 3 surfaces, 3), behind the skin along the viewing ray."""
    plane = camera.undistort(colour, xy)
    ray = np.concatenate([plane, np.ones((*plane.shape[:2], 1))], axis=-1)
    along = z[..., np.newaxis] * ray[:, :, np.newaxis]
    unit = ray / np.linalg.norm(ray, axis=-1, keepdims=True)
    return along + (skin[:, np.newaxis] * unit)[:, :, np.newaxis]


def _drawn_back(xyz: NDArray, names: Sequence[str], beyond_m: Mapping[str, float]) -> NDArray:
    """Return joints (T, J, 3) moved towards their parents, where these are known."""
    moved = xyz.copy()
    for (joint, beyond), side in itertools.product(beyond_m.items(), ("left", "right")):
        ends = f"{side}_{skeleton.PARENT[joint]}", f"{side}_{joint}"
        if set(ends) <= set(names):
            start, stop = (names.index(end) for end in ends)
            back = beyond * rotations.unit(xyz[:, stop] - xyz[:, start])
            moved[:, stop] -= np.where(np.isfinite(back), back, 0.0)
    return moved


def _chain(names, bones, is_trunk) -> list[tuple[int, int | None]]:
    """Return (joint, parent or None) from the trunk outwards; every joint once."""
    neighbours: dict[int, list[int]] = {k: [] for k in range(len(names))}
    for a, b in bones:
        if a in names and b in names:
            neighbours[names.index(a)].append(names.index(b))
            neighbours[names.index(b)].append(names.index(a))
    parents: dict[int, int | None] = {}
    for starts in ([int(k) for k in np.flatnonzero(is_trunk)], *([k] for k in range(len(names)))):
        queue = [k for k in starts if k not in parents]
        parents |= dict.fromkeys(queue)
        while queue:
            joint = queue.pop(0)
            for other in neighbours[joint]:
                if other not in parents:
                    parents[other] = joint
                    queue.append(other)
    return list(parents.items())


def _lengths(xyz: NDArray, chain: list[tuple[int, int | None]]) -> dict[int, float]:
    """Return the median length of the bone from each joint to its parent, metres."""
    lengths = {}
    for joint, parent in chain:
        if parent is None:
            continue
        found = np.linalg.norm(xyz[:, joint] - xyz[:, parent], axis=-1)
        if np.count_nonzero(np.isfinite(found)) >= FEWEST:
            lengths[joint] = float(np.nanmedian(found))
    return lengths


def _choose(joints_at, z, z_body, chain, lengths, is_trunk) -> dict[int, int]:
    """Return the surface of each joint, by joint; none for joints without one."""
    chosen: dict[int, int] = {}
    for joint, parent in chain:
        surfaces = [k for k in range(z.shape[1]) if np.isfinite(joints_at[joint, k, 2])]
        limit = FROM_BODY_M[bool(is_trunk[joint])]
        surfaces = [k for k in surfaces if abs(z[joint, k] - z_body) <= limit]
        if is_trunk[joint]:  # the nearest surface may be in front of the trunk
            off_m = np.abs(z[joint] - z_body)
            surfaces.sort(key=off_m.__getitem__)
        if parent in chosen and joint in lengths:
            anchor, length = joints_at[parent, chosen[parent]], lengths[joint]
            slack = max(BONE_TOLERANCE * length, BONE_TOLERANCE_M)
            off = {k: abs(np.linalg.norm(joints_at[joint, k] - anchor) - length) for k in surfaces}
            surfaces = [k for k in surfaces if off[k] <= slack]
        if surfaces:
            chosen[joint] = surfaces[0]
    return chosen


def _uncover(chosen, xy, z, radius_px_m, chain, is_trunk) -> None:
    """Remove joints of the trunk that a limb covers in the picture at the depth seen there."""
    limbs = [
        (a, b) for a, b in chain if b in chosen and a in chosen and not (is_trunk[a] or is_trunk[b])
    ]
    for joint in [k for k in chosen if is_trunk[k]]:
        for a, b in limbs:
            along = xy[b] - xy[a]
            share = np.clip((xy[joint] - xy[a]) @ along / max(along @ along, 1e-9), 0, 1)
            z_limb = (1 - share) * z[a, chosen[a]] + share * z[b, chosen[b]]
            wide = (1 - share) * radius_px_m[a] + share * radius_px_m[b]
            over = np.linalg.norm(xy[a] + share * along - xy[joint]) <= wide / z_limb
            if over and abs(z_limb - z[joint, chosen[joint]]) <= COVERED_M:
                chosen.pop(joint)
                break


def _share_lifted(motion: DeviceMotion) -> float:
    """Return the share of the joints seen that have depth; NaN if none is seen."""
    seen = np.isin(motion.reason, (missing_reason.OK, missing_reason.NO_DEPTH))
    lifted = np.count_nonzero(motion.reason == missing_reason.OK)
    return lifted / int(seen.sum()) if seen.any() else np.nan


def doubt(motion: DeviceMotion) -> str | None:
    """Return a line if hardly any joint that is seen has depth."""
    lifted = _share_lifted(motion)
    if not lifted < LEAST_LIFTED:
        return None
    return (
        f"{motion.source}: expected depth at {LEAST_LIFTED:.0%} of the joints seen or more, found "
        f"it at {lifted:.1%}: look whether colour and depth are of one recording and one clock, "
        "and the person within the camera's range"
    )


def size_doubt(motion: DeviceMotion) -> str | None:
    """Return a line if the body is no person's size; None if its trunk is not seen."""
    if not set(skeleton.TRUNK) <= set(motion.joints.tolist()):
        return None
    trunk_m = [
        np.linalg.norm(motion.joint(f"{side}_shoulder") - motion.joint(f"{side}_hip"), axis=-1)
        for side in ("left", "right")
    ]
    known_m = np.concatenate(trunk_m)
    known_m = known_m[np.isfinite(known_m)]
    least_m, most_m = TRUNK_M
    if len(known_m) < FEWEST or least_m <= np.median(known_m) <= most_m:
        return None
    return (
        f"{motion.source}: expected {least_m:g} to {most_m:g} m from shoulder to hip, found "
        f"{np.median(known_m):.2f} m: look whether `depth_unit_m` is the step of its depth, and "
        "the lens that of its pictures"
    )


def summary(motion: DeviceMotion, sigma_m: NDArray) -> str:
    """Return a log line: the share of joints with depth, and its precision."""
    lifted = _share_lifted(motion)
    known = sigma_m[np.isfinite(sigma_m)]
    sigma_mm = 1000 * np.median(known) if len(known) else np.nan
    return f"{motion.source}: {lifted:.1%} of the joints seen have depth, noise {sigma_mm:.1f} mm"
