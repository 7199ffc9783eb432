"""Painted courts: points are where the lines are, lines meet, errors have their size."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from courtside.calibration.court import court as court_files
from virtualgym.hall import painted_lines
from virtualgym.presets import PLAIN

COURTS = Path(__file__).parents[4] / "config" / "courts"
BADMINTON = court_files.read(COURTS / "badminton.yaml")
EXACT = dataclasses.replace(PLAIN, line_sigma_m=0.0, post_foot_sigma_m=0.0, post_tip_sigma_m=0.0)
ROUGH = dataclasses.replace(PLAIN, line_sigma_m=0.002)


def paint_court(preset=ROUGH, seed=0, court=BADMINTON):
    return painted_lines.paint_court(court, preset, np.random.default_rng(seed))


@pytest.mark.parametrize("path", sorted(COURTS.glob("*.yaml")), ids=lambda path: path.stem)
def test_without_errors_everything_is_in_its_place(path):
    court = court_files.read(path)
    made = paint_court(EXACT, court=court)
    np.testing.assert_allclose(made.court_xyz, court.xyz, atol=1e-12)
    x0, y0, x1, y1 = court.lines_m.T
    ordered = np.column_stack(
        [np.minimum(x0, x1), np.minimum(y0, y1), np.maximum(x0, x1), np.maximum(y0, y1)]
    )
    np.testing.assert_allclose(made.lines_m, ordered, atol=1e-12)
    assert (made.net is None) == (court.net is None)


def test_a_place_without_lines_keeps_its_points():
    bare = dataclasses.replace(BADMINTON, lines_m=np.zeros((0, 4)), net=None)
    made = paint_court(court=bare)
    assert made.lines_m.shape == (0, 4)
    np.testing.assert_array_equal(made.court_xyz, bare.xyz)


def test_points_are_on_the_edges_that_they_name():
    made = paint_court()
    lines = made.lines_m
    at = dict(zip(BADMINTON.points, made.court_xyz, strict=True))
    # Lines in the order of the file: 0 1 outer side lines, 4 5 back boundaries, 6 7 long service,
    # 8 9 short service, 10 11 centre lines.
    expected = {
        "p01": (lines[0, 0], lines[4, 1]),
        "p02": (lines[1, 2], lines[4, 1]),
        "p03": (lines[0, 0], lines[5, 3]),
        "p16": (lines[1, 2], lines[5, 3]),
        "p04": (lines[0, 0], lines[8, 3]),
        "p07": (lines[1, 2], lines[9, 1]),
        "p08": (lines[10, [0, 2]].mean(), lines[8, 3]),
        "p09": (lines[11, [0, 2]].mean(), lines[9, 1]),
        "p13": (lines[11, [0, 2]].mean(), lines[5, 3]),
        "p14": (lines[10, [0, 2]].mean(), lines[6, 1]),
        "p15": (lines[11, [0, 2]].mean(), lines[7, 3]),
    }
    for name, place in expected.items():
        np.testing.assert_allclose(at[name][:2], place, atol=1e-12, err_msg=name)
        assert at[name][2] == 0
    assert 1e-4 < np.abs(made.court_xyz - BADMINTON.xyz)[BADMINTON.xyz[:, 2] == 0].max() < 0.015


def test_lines_keep_their_width_and_still_meet_at_corners():
    lines = paint_court().lines_m
    sizes = np.abs(lines[:, 2:] - lines[:, :2])
    np.testing.assert_allclose(sizes.min(axis=1), 0.04, atol=1e-12)
    for side in (0, 1):  # the side lines end at the outer edges of the back boundary lines
        assert lines[side, 1] == pytest.approx(lines[4, 1], abs=1e-12)
        assert lines[side, 3] == pytest.approx(lines[5, 3], abs=1e-12)
    for back in (4, 5):
        assert lines[back, 0] == pytest.approx(lines[0, 0], abs=1e-12)
        assert lines[back, 2] == pytest.approx(lines[1, 2], abs=1e-12)


def test_posts_carry_their_points_and_errors_have_their_size():
    errors, tips = [], []
    for seed in range(200):
        made = paint_court(seed=seed)
        at = dict(zip(BADMINTON.points, made.court_xyz, strict=True))
        np.testing.assert_array_equal([at["p10"], at["p11"]], made.net.feet)
        np.testing.assert_array_equal([at["p17"], at["p18"]], made.net.tips)
        tips.append(made.net.tips - made.net.feet - [0, 0, 1.55])
        errors.append(made.lines_m[0, 0])
    assert np.std(tips) == pytest.approx(ROUGH.post_tip_sigma_m, rel=0.1)
    assert np.std(errors) == pytest.approx(ROUGH.line_sigma_m, rel=0.2)


def test_the_tape_hangs_from_both_tips():
    net = paint_court(EXACT).net
    np.testing.assert_allclose(net.tape([0, 1]), net.tips)
    np.testing.assert_allclose(net.tape([0.5]), [[3.05, 6.7, 1.524]])


def test_lines_and_posts_stand_off_the_file_by_three_to_ten_millimetres():
    for strength in (1.0, 2.0):
        lines_m, posts_m = painted_lines.misplacement(BADMINTON, strength, np.random.default_rng(4))
        assert len(lines_m) == len(BADMINTON.lines_m) and posts_m.shape == (2, 2)
        for off_m in (np.abs(lines_m) / strength, np.abs(posts_m) / strength):
            assert off_m.min() >= 0.003 and off_m.max() <= 0.010
        assert {-1, 1} == set(np.sign(lines_m))
        rng = np.random.default_rng(0)
        made = painted_lines.paint_court(BADMINTON, EXACT, rng, (lines_m, posts_m))
        at = dict(zip(BADMINTON.points, made.court_xyz - BADMINTON.xyz, strict=True))
        # p01 lies on the lines 0 (along y) and 4 (along x).
        np.testing.assert_allclose(at["p01"], [lines_m[0], lines_m[4], 0], atol=1e-12)
        feet = [[x, BADMINTON.net["y_m"]] for x in BADMINTON.net["x_m"]]
        np.testing.assert_allclose(made.net.feet[:, :2] - feet, posts_m, atol=1e-12)
    assert painted_lines.misplacement(BADMINTON, 0.0, np.random.default_rng(4)) is None
