"""Quality of cameras from a wand: numbers and warnings."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.calibration.wand import calibration, quality
from courtside.calibration.wand.calibration import Floor
from fixtures.cameras.wands_made import LENSES, SIZES, THREE, WAND, floor_points, seen, swung
from virtualgym.devices import wand as simulated


def summary(found, lenses=LENSES, wand=WAND, **more):
    solved = calibration.calibrate(wand, found, SIZES, lenses=lenses, **more)
    return quality.summary(solved, wand, found, set(lenses))


def test_numbers_by_camera():
    report = summary(seen(swung(), misread=0.05))
    assert report["sigma_px"] == pytest.approx(0.5, rel=0.1)
    assert set(report["n_frames"]) == set(LENSES)
    assert "f_px" not in report
    for key, value, near in (("rms_px", 0.4, 0.15), ("wrong_percent", 5.0, 3.0)):
        assert np.mean(list(report[key].values())) == pytest.approx(value, abs=near)
    assert max(report["place_sigma_mm"].values()) < 5
    assert report["length_mm"]["n"] > 100
    assert abs(report["length_mm"]["median"]) < 0.3
    assert report["warnings"] == []
    (world,) = report["remarks"]
    assert world.startswith("wand: the origin is the middle of the wand's path")
    assert f"within {report['vertical_sigma_deg']:.0f} degrees" in world


def test_where_pictures_do_not_tell_what_is_up_there_is_a_warning():
    found = seen(swung())
    solved = calibration.calibrate(WAND, found, SIZES, lenses=LENSES)
    same = solved.cameras[0].cam_from_world[:, :3]  # in parallel, whatever their markers say
    alike = [
        replace(one, cam_from_world=np.column_stack([same, one.cam_from_world[:, 3]]))
        for one in solved.cameras
    ]
    report = quality.summary(replace(solved, cameras=alike), WAND, found, set(LENSES))
    assert report["remarks"] == []
    assert any("the pictures do not tell what is up" in line for line in report["warnings"])


def test_wrong_markers_that_two_cameras_see_are_counted():
    """In two frames of three, two of four cameras see the wand: no wrong marker can be placed."""
    found = seen(swung(seconds=60))
    order = np.random.default_rng(3).random(found.xy.shape[:2]).argsort(axis=0)
    order[:, ::3] = 4
    found.xy[order < 2] = np.nan
    pairs = np.flatnonzero((order < 2).any(axis=0))[::5]
    one = order[:, pairs].argmax(axis=0)
    found.xy[one, pairs, 0, 1] += 150
    percent = summary(found)["wrong_percent"]
    n_views = np.isfinite(found.xy[..., 0]).sum(axis=(1, 2))
    wrong = sum(percent[name] * n / 100 for name, n in zip(found.cameras, n_views, strict=True))
    assert wrong == pytest.approx(len(pairs), rel=0.05)


def test_a_delayed_camera_has_a_warning():
    xyz = swung(seconds=60)
    later = 0.93 * xyz[:-1] + 0.07 * xyz[1:]  # 0.014 s
    found, late = seen(xyz[:-1], seed=1), seen(later, seed=2)
    found.xy[2] = late.xy[2]
    warnings = summary(found)["warnings"]
    (line,) = [line for line in warnings if line.startswith("camera c2")]
    assert "frames or more late by the movement of the markers" in line


@pytest.mark.parametrize(("seed", "late", "told"), [(3, 1, True), (7, 1, True), (3, 0, False)])
def test_a_delay_of_a_frame_of_the_video_is_told_if_only_every_twelfth_is_in_the_file(
    seed, late, told
):
    """At 60 Hz, digitised by hand: 1/60 s moves cameras by 65 to 85 mm, at stated 3 mm."""
    rng = np.random.default_rng(seed)
    low, high = (-2, -2, 0.2), (2, 2, 2.2)
    every = simulated.swing(WAND.along_m, low, high, seconds=30, rate_hz=60.0, rng=rng)
    found = seen(every[6:-12:12], sigma_px=0.3)
    found.xy[1] = seen(every[6 + late : -12 + late : 12], sigma_px=0.3, seed=2).xy[1]
    report = summary(found)
    lines = [line for line in report["warnings"] if "markers are not where the other" in line]
    assert bool(lines) == told == bool([one for one in report["warnings"] if "c1: films" in one])
    for line in lines:
        assert line.startswith(f"cameras c1 ({report['wrong_percent']['c1']:.0f} %), c3 (")
    if not told:
        assert report["warnings"] == []


def test_lenses_that_are_wrong_at_the_edges_are_named_as_a_cause():
    xyz = swung(seconds=60, low=(-3, -3, 0.2), high=(3, 3, 2.2))
    more = np.array([0.07, 0, 0, 0, 0])
    wrong = {name: replace(lens, dist=lens.dist + more) for name, lens in LENSES.items()}
    warnings = summary(seen(xyz, sigma_px=0.1), wrong)["warnings"]
    (line,) = [line for line in warnings if "are correlated" in line]
    assert "that the lenses are right: given ones up to the edges of the pictures" in line


def test_a_wand_of_another_length_has_a_warning_by_clicked_points():
    shorter = replace(WAND, along_m=0.98 * WAND.along_m, sigma_m=1e-3)
    warnings = summary(seen(swung()), wand=shorter, clicks=floor_points())["warnings"]
    assert any("by the clicked points; measure it" in line for line in warnings)


@pytest.mark.parametrize("lenses", [LENSES, {}])
@pytest.mark.parametrize(
    ("middle_m", "length_m", "told"),
    [(0.2, 0.6, None), (0.2, 0.605, "33.06"), (0.2055, 0.6, "34.25"), (0.2, 0.601, None)],
)
def test_the_middle_of_three_markers_shows_a_wrong_length(lenses, middle_m, length_m, told):
    """The true wand has its markers at 0, 0.2 and 0.6 m."""
    stated = replace(THREE, along_m=np.array([0.0, middle_m, length_m]), sigma_m=5e-4)
    found = summary(seen(swung(THREE.along_m), sigma_px=0.3), lenses, stated)
    lines = [line for line in found["warnings"] if "the middle marker" in line]
    assert len(lines) == (told is not None)
    for line in lines:
        assert line.startswith(f"wand: expected the middle marker at {told} % of the length from")
        assert "found it at 33.3" in line and "`length_m` or `middle_m` is wrong" in line


def test_markers_that_scatter_by_several_px_have_a_warning():
    warnings = summary(seen(swung(), sigma_px=3.3))["warnings"]
    (line,) = [line for line in warnings if "sigma" in line]
    assert line.startswith("wand: expected markers with a sigma below 3 px, found 3.")


def test_a_path_in_the_middle_of_the_picture_has_a_warning_if_the_lens_is_unknown():
    xyz = swung(low=(-0.7, -0.7, 0.6), high=(0.7, 0.7, 1.7))
    xyz[3] = [[0.3, 0, 0], [0.3, 0.5, 0]]
    xyz[4] = [[0, 0, 0], [0.5, 0, 0]]
    lenses = {name: lens for name, lens in LENSES.items() if name != "c2"}
    warnings = summary(seen(xyz, sigma_px=0.2), lenses, floor=Floor((3.0, 4.0)))["warnings"]
    assert warnings
    assert all(line.startswith("camera c2: the wand's path extends over") for line in warnings)


@pytest.mark.parametrize(("flipped", "floor"), [(True, True), (False, True), (True, False)])
def test_y_from_the_bottom_has_a_warning_by_a_floor_that_turns_the_cameras_over(flipped, floor):
    xyz = swung()
    xyz[10] = [[1.0, 0.5, 0.0], [1.0, 1.0, 0.0]]
    xyz[20] = [[-0.5, 0.0, 0.0], [-1.0, 0.0, 0.0]]
    found, lenses = seen(xyz, sigma_px=0.2), LENSES
    if flipped:
        found.xy[..., 1] = SIZES["c0"][1] - 1 - found.xy[..., 1]
        lenses = {}
    more = {"floor": Floor((10.0, 20.0))} if floor else {}
    warnings = summary(found, lenses, **more)["warnings"]
    lines = [line for line in warnings if "upside down" in line]
    assert len(lines) == (flipped and floor)
    for line in lines:
        assert line.startswith(f"cameras {', '.join(LENSES)}: expected them upright above the flo")
        assert "correct `wand.program`, or subtract y_px from the picture's height" in line


def test_the_error_of_the_vertical_is_told_unless_points_define_it():
    xyz = swung()
    xyz[10] = [[1.0, 0.5, 0.0], [1.0, 1.0, 0.0]]
    xyz[20] = [[-0.5, 0.0, 0.0], [-1.0, 0.0, 0.0]]
    found = seen(xyz, sigma_px=0.5)
    near = summary(found, floor=Floor((10.0, 20.0)))
    assert near["remarks"] == []
    assert 0.05 < near["vertical_sigma_deg"] < 0.5
    assert summary(found)["vertical_sigma_deg"] > 1
    assert "vertical_sigma_deg" not in summary(found, clicks=floor_points())


def test_markers_in_the_upper_left_quarter_may_be_of_a_smaller_copy():
    found = seen(swung())
    found = replace(found, cameras=found.cameras[:2], xy=found.xy[:2] / 2)
    warnings = summary(found)["warnings"]
    for name in ("c0", "c1"):
        assert any(
            line.startswith(f"camera {name}: its markers lie in the upper left quarter of the pict")
            and "of 1920x1080 px): right if" in line
            for line in warnings
        )
