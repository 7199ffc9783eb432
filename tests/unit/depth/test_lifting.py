from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from courtside.depth import lifting
from courtside.depth.surfaces import Sampling
from courtside.geometry import camera
from courtside.records.keypoints import missing_reason, skeleton
from courtside.study.errors import InputError
from fixtures.people import keypoints_made
from fixtures.recordings import depth_scenes
from fixtures.recordings.depth_scenes import BONES, RADIUS_M, STANDING

RIG = depth_scenes.rig()
NAMES = list(STANDING)
N = 12
SKELETONS = sorted((Path(__file__).parents[3] / "config/skeletons").glob("*.yaml"))


def view(xyz):
    """Return the keypoints of joints (T, J, 3) as the colour camera sees them."""
    xy = camera.project(RIG.colour, xyz)[np.newaxis]
    return keypoints_made.view(RIG.colour, NAMES, 5 + np.arange(len(xyz)) / 30, xy)


def joints(**moved):
    return np.array([moved.get(name, STANDING[name]) for name in NAMES])


def seen(places):
    shapes = depth_scenes.capsules(dict(zip(NAMES, places, strict=True)))
    return depth_scenes.depth_of(RIG.depth, shapes, RIG.colour_from_depth, n_balls=20)


def lift(keypoints, pictures, **options):
    taken = [(t, depth_scenes.steps(z)) for t, z in zip(keypoints.time_s, pictures, strict=True)]
    settings = {"bones": BONES, "baseline_m": 0.055, "skin_m": RADIUS_M} | options
    return lifting.lift_take("cam-depth", keypoints, taken, RIG, **settings)


@pytest.fixture(scope="module")
def still():
    """Return the joints, the depth picture, and both repeated over a take."""
    places = joints()
    depth_m = seen(places)
    return np.repeat(places[np.newaxis], N, axis=0), [depth_m] * N


def test_joints_lie_where_the_limbs_are(still):
    xyz, pictures = still
    motion, sigma_m = lift(view(xyz), pictures)
    error = np.linalg.norm(motion.xyz - xyz, axis=-1)
    assert np.median(error) < 0.005
    assert error.max() < 0.015
    assert (motion.source, motion.kind) == ("cam-depth", "rgbd")
    assert motion.time_s.tolist() == view(xyz).time_s.tolist()
    assert (motion.reason == missing_reason.OK).all()
    skin = motion.xyz[..., 2] - 0.05
    assert np.allclose(sigma_m, skin**2 * 0.1 / (RIG.depth.K[0, 0] * 0.055), rtol=0.06)


def test_noise_holes_and_misplaced_joints(still):
    xyz, pictures = still
    rng = np.random.default_rng(1)
    noisy = []
    for depth_m in pictures:
        z = depth_m + rng.normal(0, 1, depth_m.shape) * depth_m**2 * 0.1 / (
            RIG.depth.K[0, 0] * 0.055
        )
        z[rng.random(z.shape) < 0.15] = 0
        noisy.append(z)
    keypoints = view(xyz)
    moved = replace(keypoints, xy=keypoints.xy + rng.normal(0, 2, keypoints.xy.shape))
    motion, _ = lift(moved, noisy)
    error = np.linalg.norm(motion.xyz - xyz, axis=-1)
    assert np.isfinite(error).mean() > 0.97
    assert np.nanmedian(error) < 0.02
    assert np.nanpercentile(error, 95) < 0.05


def test_a_hole_over_a_limb_is_no_depth(still):
    xyz, pictures = still
    wrist = NAMES.index("left_wrist")
    at = RIG.colour_from_depth[:, :3].T @ (xyz[0, wrist] - RIG.colour_from_depth[:, 3])
    u, v = np.rint(camera.project(RIG.depth, at)).astype(int)
    holed = [depth_m.copy() for depth_m in pictures]
    holed[3][v - 12 : v + 13, u - 12 : u + 13] = 0
    motion, sigma_m = lift(view(xyz), holed)
    assert motion.reason[3, wrist] == missing_reason.NO_DEPTH
    assert np.isnan(motion.xyz[3, wrist]).all()
    assert np.isnan(sigma_m[3, wrist])
    assert np.count_nonzero(motion.reason) == 1


@pytest.mark.parametrize("beside", [True, False], ids=["trunk-beside-hand", "hand-only"])
def test_a_hand_before_the_trunk_is_not_the_hip(still, beside):
    """The hand before the hip: the hip is read beside it, or missing; the wrist keeps its depth."""
    xyz, pictures = still
    hip, wrist, elbow = (NAMES.index(n) for n in ("right_hip", "right_wrist", "right_elbow"))
    shown = xyz[0, hip] * (2.36 / xyz[0, hip, 2])  # on the ray of the hip, nearer
    crossed = joints(right_wrist=tuple(shown), right_elbow=(-0.144, -0.181, 2.426))
    several = np.concatenate([xyz[:-1], crossed[np.newaxis]])
    last = seen(crossed)
    if not beside:
        u, v = np.rint(camera.project(RIG.depth, xyz[0, hip])).astype(int)
        around = last[v - 25 : v + 25, u - 25 : u + 25]
        around[around > 2.38] = 0
    exact = Sampling(disparity_px=0.02)
    motion, _ = lift(view(several), [*pictures[:-1], last], sampling=exact)
    assert np.linalg.norm(motion.xyz[-1, wrist] - shown) < 0.03
    assert np.linalg.norm(motion.xyz[-1, elbow] - crossed[elbow]) < 0.05
    if beside:
        assert np.linalg.norm(motion.xyz[-1, hip] - xyz[0, hip]) < 0.05
    else:
        assert motion.reason[-1, hip] == missing_reason.NO_DEPTH


def test_a_joint_that_another_limb_hides_is_missing(still):
    """The left forearm is stretched out to the camera before the right wrist, 40 cm behind it."""
    xyz, pictures = still
    wrist = NAMES.index("right_wrist")
    ray = xyz[0, wrist] / xyz[0, wrist, 2]
    front = {"left_elbow": tuple(ray * 1.95 + [0, 0.25, 0]), "left_wrist": tuple(ray * 1.95)}
    crossed = joints(**front)
    several = np.concatenate([xyz[:-1], crossed[np.newaxis]])
    motion, _ = lift(view(several), [*pictures[:-1], seen(crossed)])
    assert motion.reason[-1, wrist] == missing_reason.NO_DEPTH
    assert (motion.reason[:-1] == missing_reason.OK).all()


def test_joints_placed_beyond_their_limbs_are_drawn_back(still):
    """Elbows 3 cm too far out, wrists 2 cm short of their place; one without its parent stays."""
    xyz, pictures = still
    beyond_m = {"elbow": 0.03, "wrist": -0.02}
    placed = xyz.copy()
    for (joint, beyond), side in product(beyond_m.items(), ("left", "right")):
        ends = f"{side}_{skeleton.PARENT[joint]}", f"{side}_{joint}"
        start, stop = (NAMES.index(end) for end in ends)
        along = xyz[0, stop] - xyz[0, start]
        placed[:, stop] += beyond * along / np.linalg.norm(along)
    keypoints = view(placed)
    elbow, wrist = NAMES.index("left_elbow"), NAMES.index("left_wrist")
    keypoints.reason[0, 3, elbow] = missing_reason.OUT_OF_IMAGE
    as_placed, _ = lift(keypoints, pictures)
    motion, _ = lift(keypoints, pictures, beyond_m=beyond_m)
    arms = [NAMES.index(f"{side}_{joint}") for side in ("left", "right") for joint in beyond_m]
    error = np.linalg.norm(motion.xyz - xyz, axis=-1)
    error[3, [elbow, wrist]] = 0.0
    assert error.max() < 0.015
    assert np.nanmin(np.linalg.norm(as_placed.xyz - xyz, axis=-1)[:, arms]) > 0.015
    assert motion.xyz[3, wrist].tolist() == as_placed.xyz[3, wrist].tolist()


def test_reasons_of_the_picture_stay(still):
    xyz, pictures = still
    keypoints = view(xyz)
    keypoints.reason[0, 2, 4] = missing_reason.OUT_OF_IMAGE
    motion, _ = lift(keypoints, pictures)
    assert motion.reason[2, 4] == missing_reason.OUT_OF_IMAGE
    assert np.isnan(motion.xyz[2, 4]).all()


def test_a_lost_depth_picture_is_no_depth(still, caplog):
    xyz, pictures = still
    keypoints = view(xyz)
    taken = [(t, depth_scenes.steps(z)) for t, z in zip(keypoints.time_s, pictures, strict=True)]
    del taken[5]
    motion, _ = lifting.lift_take(
        "d", keypoints, taken, RIG, bones=BONES, baseline_m=0.055, skin_m=RADIUS_M
    )
    assert (motion.reason[5] == missing_reason.NO_DEPTH).all()
    assert np.count_nonzero(motion.reason) == len(NAMES)
    assert "91.7%" in lifting.summary(motion, np.ones(3))
    assert not caplog.messages
    assert lifting.doubt(motion) is None


def test_hardly_any_depth_is_doubted(still):
    xyz, pictures = still
    keypoints = view(xyz)
    holes = [
        (t, depth_scenes.steps(z) * 0) for t, z in zip(keypoints.time_s, pictures, strict=True)
    ]
    motion, _ = lifting.lift_take(
        "d", keypoints, holes, RIG, bones=BONES, baseline_m=0.055, skin_m=RADIUS_M
    )
    assert "d: expected depth at 20% of the joints seen or more, found it at 0.0%" in lifting.doubt(
        motion
    )


@pytest.mark.parametrize("factor", [1.0, 2.5, 4.0, 0.1])
def test_a_body_of_another_size_is_told(still, factor):
    """As with depth whose steps are not those that are stated."""
    xyz, pictures = still
    motion, _ = lift(view(xyz), pictures)
    said = lifting.size_doubt(replace(motion, xyz=factor * motion.xyz))
    if factor == 1:
        assert said is None
    else:
        assert said.startswith("cam-depth: expected 0.3 to 0.8 m from shoulder to hip, found ")
        assert "depth_unit_m" in said


def test_a_slower_depth_stream_serves_every_colour_frame_and_is_told(still, caplog):
    """Colour at 60 frames a second, depth at 30; then one picture of depth is lost."""
    xyz, pictures = still
    keypoints = replace(view(xyz), time_s=5 + np.arange(N) / 60)
    times = keypoints.time_s[::2]
    taken = [(t, depth_scenes.steps(z)) for t, z in zip(times, pictures, strict=False)]
    settings = {"bones": BONES, "baseline_m": 0.055, "skin_m": RADIUS_M}
    motion, _ = lifting.lift_take("d", keypoints, taken, RIG, **settings)
    assert (motion.reason == missing_reason.OK).all()
    (said,) = caplog.messages
    assert said.startswith("d: expected depth as often as colour, found it every 33 ms and colour ")
    del taken[3]
    motion, _ = lifting.lift_take("d", keypoints, taken, RIG, **settings)
    lost = (motion.reason == missing_reason.NO_DEPTH).all(axis=1)
    assert np.flatnonzero(lost).tolist() == [6]


def test_frames_are_taken_at_the_nearest_time():
    frames = [(0.0, "a"), (0.1, "b"), (0.3, "c")]
    times = [-0.2, 0.04, 0.06, 0.19, 0.29, 0.5]
    found = list(lifting.nearest_frames(times, iter(frames), 0.06))
    assert found == [None, "a", "b", None, "c", None]
    assert list(lifting.nearest_frames([1.0], [], 9)) == [None]


def test_the_skin_of_each_joint_by_its_name():
    found = lifting.by_joint(
        ["left_wrist", "nose", "right_wrist"], {"wrist": 0.03, "right_wrist": 0.02}
    )
    assert found.tolist() == [0.03, 0.0, 0.02]
    with pytest.raises(InputError, match=r"lift_depth\.skin_m: .*found none of tail;"):
        lifting.by_joint(["tail"], {})


@pytest.mark.parametrize("path", SKELETONS, ids=lambda path: path.stem)
def test_every_skeleton_can_be_lifted(path):
    names = skeleton.read(path).joints
    skin = dict(zip(names, lifting.by_joint(names), strict=True))
    assert all(0 <= depth_m <= 0.09 for depth_m in skin.values())
    assert skin.get("mid_hip", 0.09) == lifting.SKIN_TO_JOINT_M["hip"]
    assert skin.get("left_big_toe", 0.02) == lifting.SKIN_TO_JOINT_M["foot_index"]
    assert skin.get("left_jaw_1", 0.01) == lifting.OTHERS_M
