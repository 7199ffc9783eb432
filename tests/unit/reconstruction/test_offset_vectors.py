"""Vectors of offsets: how views move a triangulated joint, how turning and mirroring act."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.geometry import triangulation
from courtside.geometry.camera import Camera
from courtside.reconstruction import offset_vectors
from courtside.records.keypoints import skeleton
from fixtures.cameras import scene
from fixtures.people import walker

JOINTS = list(walker.SKELETON.joints)
MIRROR = np.diag([1.0, -1.0, 1.0])
OTHER = {"left": "right", "right": "left"}


def persons(n=6, seed=0):
    """Return (n, J, 3) m: joints around a standing body, each moved at random."""
    rng = np.random.default_rng(seed)
    return walker.body(n) + rng.normal(0, 0.05, (n, len(JOINTS), 3))


def every(xyz, joint, side, cameras, sex="m"):
    """Return all vectors of a joint, all views accepted."""
    accepted = np.ones((*xyz.shape[:2], len(cameras)), dtype=bool)
    return offset_vectors.every(xyz, JOINTS, side, joint, sex, cameras, accepted)


def test_a_joint_moves_by_what_the_triangulation_makes_of_one_ray():
    """Truth from the triangulation itself: one camera's picture of the points is moved by 1 mm."""
    cameras, xyz = scene.ring(3), scene.points(40)
    accepted = np.ones((len(xyz), 3), dtype=bool)
    seen, step = offset_vectors.views(cameras, xyz, accepted), np.array([0.6e-3, -0.5e-3, 0.6e-3])
    for at, camera in enumerate(cameras):
        pictures = scene.views(cameras, xyz)
        pictures[at] = scene.opencv_projection(camera, xyz + step)
        limits = {"max_error_px": 50.0, "fade_px": 1e6}
        found = triangulation.triangulate_robust(
            cameras, pictures, np.ones(accepted.T.shape), **limits
        )
        moved = found.xyz - xyz
        assert np.linalg.norm(seen.gains[at] @ step - moved, axis=1).max() < 2e-5


def test_what_all_rays_do_the_joint_does():
    cameras, xyz = scene.ring(4), scene.points(10)
    seen = offset_vectors.views(cameras, xyz, np.ones((10, 4), dtype=bool))
    np.testing.assert_allclose(
        seen.gains.sum(axis=0), np.broadcast_to(np.eye(3), (10, 3, 3)), atol=1e-9
    )


def test_views_that_were_not_accepted_do_not_count_unless_none_was():
    cameras, xyz = scene.ring(4), scene.points(10)
    all_four = offset_vectors.views(cameras, xyz, np.ones((10, 4), dtype=bool))
    none = offset_vectors.views(cameras, xyz, np.zeros((10, 4), dtype=bool))
    np.testing.assert_allclose(none.gains, all_four.gains, atol=1e-9)
    first = np.tile([True, True, False, False], (10, 1))
    two = offset_vectors.views(cameras[:2], xyz, first[:, :2])
    seen = offset_vectors.views(cameras, xyz, first)
    np.testing.assert_allclose(seen.gains[:2], two.gains, atol=0.02)
    assert np.abs(seen.gains[2:]).max() < 0.02


@pytest.mark.parametrize("joint", skeleton.LIMBS)
def test_a_vector_of_views_is_what_triangulation_makes_of_those_of_each_camera(joint):
    """Truth from the triangulation: each camera's picture of a joint is moved by its own vector."""
    cameras, xyz, share = scene.ring(3), persons(), 1e-3
    at = JOINTS.index(f"left_{joint}")
    ways, _ = offset_vectors.directions(cameras, xyz[:, at])
    each = offset_vectors.of_each_view(xyz, JOINTS, "left", joint, ways)
    together = every(xyz, joint, "left", cameras)
    assert set(each) == {name for name in together if name.startswith(offset_vectors.SEEN)}
    for name, vectors in each.items():
        pictures = np.stack([
            scene.opencv_projection(camera, xyz[:, at] + share * own)
            for camera, own in zip(cameras, vectors, strict=True)
        ])  # fmt: skip
        limits = {"max_error_px": 50.0, "fade_px": 1e6}
        found = triangulation.triangulate_robust(
            cameras, pictures, np.ones(pictures.shape[:2]), **limits
        )
        moved = (found.xyz - xyz[:, at]) / share
        np.testing.assert_allclose(moved, together[name], atol=0.01, err_msg=name)


def test_between_two_cameras_that_face_each_other_no_ray_moves_a_joint_far():
    """On their line the rays cross nowhere: triangulation would multiply an offset without end."""
    cameras = scene.ring(2, radius_m=10.0, height_m=1.0)
    along = cameras[1].centre_in_world - cameras[0].centre_in_world
    along /= np.linalg.norm(along)
    aside = np.cross(along, [0.0, 0.0, 1.0])
    xyz = np.array([0.0, 0.0, 1.0]) + np.array([0.0, 0.001, 0.1, 1.0, 6.0])[:, None] * aside
    seen = offset_vectors.views(cameras, xyz, np.ones((len(xyz), 2), dtype=bool))
    assert np.linalg.norm(seen.gains, axis=(-2, -1), ord=2).max() < 2.3
    assert np.linalg.norm(seen.gains[:, 0] @ along, axis=-1).max() < 1e-9
    np.testing.assert_allclose(seen.gains[:, -1].sum(axis=0), np.eye(3), atol=1e-9)


@pytest.mark.parametrize("joint", skeleton.LIMBS)
def test_names_are_those_of_the_vectors(joint):
    found = every(persons(), joint, "left", scene.ring(3))
    assert set(found) == set(offset_vectors.names(joint))
    assert all(np.isfinite(vector).all() for vector in found.values())
    seen = [name for name in found if name.startswith(offset_vectors.SEEN)]
    assert len(seen) >= 9 + 15 + 6 * 2


@pytest.mark.parametrize("joint", skeleton.LIMBS)
def test_vectors_turn_with_body_and_cameras(joint):
    turn = Rotation.from_rotvec([0, 0, 0.7]).as_matrix()  # about the world's z, as `upright`
    cameras, xyz = scene.ring(3), persons()
    turned = [
        Camera(
            one.name, one.size, one.K, one.dist,
            np.column_stack([one.cam_from_world[:, :3] @ turn.T, one.cam_from_world[:, 3]]),
        )
        for one in cameras
    ]  # fmt: skip
    before, after = every(xyz, joint, "left", cameras), every(xyz @ turn.T, joint, "left", turned)
    for name, vector in before.items():
        np.testing.assert_allclose(after[name], vector @ turn.T, atol=1e-9, err_msg=name)


@pytest.mark.parametrize(
    ("tilt_deg", "off_deg"), [(0, 0), (29, 29), (45, 15), (61, 0), (120, 0), (180, 0)]
)
def test_upright_turns_with_who_leans_further_than_the_fit(tilt_deg, off_deg):
    xyz = walker.body(1)[0]
    shoulders, hips = (
        sum(xyz[JOINTS.index(f"{side}_{part}")] for side in ("left", "right"))
        for part in ("shoulder", "hip")
    )
    trunk, _ = Rotation.align_vectors([[0, 0, 1.0]], [shoulders - hips])
    turn = Rotation.from_euler("x", tilt_deg, degrees=True) * trunk
    found = offset_vectors.of_body(turn.apply(xyz)[None], JOINTS, "left", "hip")
    upright, up = (found[name][0] / np.linalg.norm(found[name][0]) for name in ("upright", "up"))
    assert np.linalg.norm(found["upright"][0]) == pytest.approx(offset_vectors.LENGTH_M)
    assert np.degrees(np.arccos(min(1.0, upright @ up))) == pytest.approx(off_deg, abs=0.01)
    assert (upright[2] > 1 - 1e-9) == (tilt_deg <= 30)


@pytest.mark.parametrize("joint", skeleton.LIMBS)
def test_vectors_of_the_right_side_are_mirror_images_of_those_of_the_left(joint):
    """One share serves both sides: a mirrored body before mirrored cameras has mirrored vectors."""
    xyz = persons()
    order = [JOINTS.index(_other(name)) for name in JOINTS]
    cameras = scene.ring(3)
    mirrored = [
        Camera(one.name, one.size, one.K, one.dist, scene.look_at(MIRROR @ place, (0, 0, 1.0)))
        for one in cameras
        for place in [one.centre_in_world]
    ]
    left = every(xyz, joint, "left", cameras)
    right = every((xyz @ MIRROR)[:, order], joint, "right", mirrored)
    for name, vector in left.items():
        np.testing.assert_allclose(right[name], vector @ MIRROR, atol=1e-9, err_msg=name)


def _other(name):
    side, _, rest = name.partition("_")
    return f"{OTHER[side]}_{rest}" if side in OTHER else name
