"""Places of fixed cameras, against the layouts' definitions and OpenCV's projection."""

from pathlib import Path

import numpy as np
import pytest

from courtside.calibration.court import court as court_files
from fixtures.cameras import scene
from virtualgym import presets
from virtualgym.cameras import layouts

FOLDER = Path(__file__).parents[4] / "config" / "courts"
COURT = court_files.read(FOLDER / "badminton.yaml")
CENTRE = np.array([3.05, 6.7, 0.0])
PLAIN = presets.PRESETS["plain"]
# Layouts aimed at players, not at the whole court; heights of their cameras, m.
OF_PLAYERS = {"stands": (5.5, 8.0), "near": (1.1, 3.2)}


def cameras(layout="a", court=COURT, size=(1280, 720), seed=0, preset=PLAIN, **options):
    rng = np.random.default_rng(seed)
    return layouts.fixed_cameras(layout, court, size, preset, rng, **options)


def by_name(layout, **options):
    return {camera.name: camera for camera in cameras(layout, **options)}


def axis(camera):
    return camera.cam_from_world[2, :3]


def test_layout_a_looks_along_the_worlds_axes():
    side, back = cameras("a")
    assert (side.name, back.name) == ("side", "back")
    np.testing.assert_allclose(side.centre_in_world, CENTRE + np.array([-21, 0, 1.9]), atol=1e-9)
    np.testing.assert_allclose(back.centre_in_world, CENTRE + np.array([0, -21, 2.1]), atol=1e-9)
    down_side, down_back = 0.6 / np.hypot(21, 0.6), 0.8 / np.hypot(21, 0.8)
    np.testing.assert_allclose(axis(side), [np.sqrt(1 - down_side**2), 0, -down_side], atol=1e-9)
    np.testing.assert_allclose(axis(back), [0, np.sqrt(1 - down_back**2), -down_back], atol=1e-9)


@pytest.mark.parametrize("angle_deg", [20, 45, 90, 120])
def test_the_baseline_is_the_angle_at_the_courts_centre(angle_deg):
    side, back = (camera.centre_in_world[:2] for camera in cameras(baseline_deg=angle_deg))
    a, b = side - CENTRE[:2], back - CENTRE[:2]
    assert np.degrees(np.arccos(a @ b / np.hypot(*a) / np.hypot(*b))) == pytest.approx(angle_deg)
    np.testing.assert_allclose(b, [0, -21], atol=1e-9)
    assert side[0] < CENTRE[0]


def test_layout_b_stands_on_one_line_and_has_a_mirror_image():
    found = {name: c.centre_in_world - CENTRE for name, c in by_name("b-mirror-front").items()}
    assert list(found) == ["oblique", "back", "mirror", "front"]
    assert found["oblique"][1] == pytest.approx(found["back"][1])
    assert found["mirror"][1] == pytest.approx(found["back"][1])
    assert found["back"][0] == pytest.approx(0) and found["front"][0] == pytest.approx(0)
    assert found["back"][0] - found["oblique"][0] == pytest.approx(20)
    assert found["mirror"][0] == pytest.approx(-found["oblique"][0])
    assert found["front"][1] > 6.7 and found["back"][1] < -6.7
    assert list(by_name("b")) == ["oblique", "back"]
    assert list(by_name("b-mirror")) == ["oblique", "back", "mirror"]


def test_four_corners_are_two_and_their_images_behind_the_other_half():
    found = {name: c.centre_in_world - CENTRE for name, c in by_name("four-corners").items()}
    assert list(found) == ["left", "right", "far-right", "far-left"]
    for near, far in (("left", "far-left"), ("right", "far-right")):
        np.testing.assert_allclose(found[near][:2] * [1, -1], found[far][:2])
    assert list(by_name("corners")) == ["left", "right"]


@pytest.mark.parametrize("court", ["badminton", "tennis", "rectangle-10x5"])
@pytest.mark.parametrize("layout", [name for name in layouts.LAYOUTS if name not in OF_PLAYERS])
@pytest.mark.parametrize("size", [(480, 270), (3840, 2160)])
def test_every_camera_sees_the_whole_court(layout, court, size):
    known = court_files.read(FOLDER / f"{court}.yaml")
    for seed in range(3):
        for camera in cameras(layout, known, size, seed):
            xy = scene.opencv_projection(camera, known.xyz)
            assert (xy > 0.02 * np.array(size)).all(), camera.name
            assert (xy < 0.98 * np.array(size)).all(), camera.name


@pytest.mark.parametrize(("layout", "height_m"), OF_PLAYERS.items())
def test_cameras_on_stands_and_near_see_the_middle_of_the_near_half(layout, height_m):
    known = court_files.read(FOLDER / "badminton.yaml")
    beside = np.array(np.meshgrid([-1.0, 1.0], [-1.0, 1.0], [0.0, 2.1])).reshape(3, -1).T
    place = [known.size_m[0] / 2, known.size_m[1] / 4, 0]
    for camera in cameras(layout, known, (1920, 1080), 0):
        assert height_m[0] <= camera.centre_in_world[2].round(9) <= height_m[1]
        xy = scene.opencv_projection(camera, place + beside)
        assert (xy > 0).all() and (xy < [1920, 1080]).all(), camera.name


def test_lenses_differ_from_unit_to_unit_as_the_preset_says():
    drawn = [layouts.lens((1280, 720), PLAIN, np.random.default_rng(k)) for k in range(400)]
    matrices, dists = (np.array(part) for part in zip(*drawn, strict=True))
    assert matrices[:, 0, 0].mean() == pytest.approx(0.875 * 1280, rel=0.002)
    assert matrices[:, 0, 0].std() == pytest.approx(1120 * PLAIN.focal_spread, rel=0.15)
    np.testing.assert_allclose(matrices[:, :2, 2].mean(0), [639.5, 359.5], atol=1.5)
    np.testing.assert_allclose(matrices[:, :2, 2].std(0), PLAIN.principal_point_px, rtol=0.15)
    np.testing.assert_allclose(dists[:, :2].mean(0), [-0.045, 0.011], atol=1e-3)
    spreads = [PLAIN.k1_spread, PLAIN.k2_spread, PLAIN.p_spread, PLAIN.p_spread, 0]
    np.testing.assert_allclose(dists.std(0), spreads, rtol=0.15, atol=1e-12)


def test_a_lens_scales_with_the_picture():
    small = layouts.lens((480, 270), PLAIN, np.random.default_rng(3))
    large = layouts.lens((3840, 2160), PLAIN, np.random.default_rng(3))
    np.testing.assert_array_equal(small[1], large[1])
    assert large[0][0, 0] == pytest.approx(8 * small[0][0, 0])
    assert large[0][0, 2] + 0.5 == pytest.approx(8 * (small[0][0, 2] + 0.5))


def test_the_same_generator_gives_the_same_cameras():
    one, two, other = cameras(seed=1), cameras(seed=1), cameras(seed=2)
    assert all((a.K == b.K).all() for a, b in zip(one, two, strict=True))
    assert not any((a.K == b.K).all() for a, b in zip(one, other, strict=True))


def test_unknown_layouts_and_impossible_baselines_are_refused():
    with pytest.raises(ValueError, match="expected a layout of"):
        cameras("c")
    with pytest.raises(ValueError, match="baseline_deg"):
        cameras("b", baseline_deg=30)
    with pytest.raises(ValueError, match="baseline_deg"):
        cameras("a", baseline_deg=0)


def test_zoom_enlarges_the_picture_about_its_middle_and_moves_no_camera():
    for wide, near in zip(cameras("b"), cameras("b", zoom=1.7), strict=True):
        np.testing.assert_array_equal(near.cam_from_world, wide.cam_from_world)
        np.testing.assert_allclose(near.K[[0, 1], [0, 1]], 1.7 * wide.K[[0, 1], [0, 1]])
        np.testing.assert_array_equal(near.K[:2, 2], wide.K[:2, 2])
