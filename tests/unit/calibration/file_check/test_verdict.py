"""Verdicts: planted faults are named, good cameras are not, and a real file's fault is found."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from courtside.calibration import file_formats
from courtside.calibration.file_check import faults, residuals, verdict
from courtside.geometry import camera as cameras
from courtside.records.cameras import clicks
from courtside.study.configuration import yaml_files
from fixtures.cameras import corner_cameras as hall
from fixtures.recordings.real_data import REAL, needs_real

CONFIG = Path(__file__).parents[4] / "config"
POINTS_CSV = CONFIG / "static_points" / "walk-4cams.csv"
SESSION = yaml_files.read(CONFIG / "sessions" / "walk-4cams.yaml")
TURNS = [(0.02, 0, 0), (0, 0.03, 0), (0, -0.02, 0.01), (-0.02, 0.02, 0)]


def seen(seen_by, seed=0, noise_px=0.8):
    """Return static points and joints with outliers, as true cameras see them."""
    static = hall.seen_points(seen_by, 8, noise_px, seed)
    people = hall.seen_points(seen_by, 120, 3.0, seed + 1, spread_m=0.6)
    people[seed % len(seen_by), ::6] += 80.0
    return static, people


@pytest.mark.parametrize("seed", range(3))
def test_good_cameras_are_good(seed):
    seen_by = hall.four_cameras()
    static, people = seen(seen_by, seed)
    for data in ((static, None), (None, people), (static, people)):
        message = verdict.judge(seen_by, verdict.Seen(*data), person_px=300.0)
        assert message.warnings == [] and message.faults == []
        assert all(px < 4 for px in message.px.values())


def scaled_focal(camera, factor=1.12):
    matrix = camera.K.copy()
    matrix[[0, 1], [0, 1]] *= factor
    return replace(camera, K=matrix)


def turned_zoomed(camera):
    return cameras.turned(scaled_focal(camera, 1.05), [0.02, 0.01, 0])


@pytest.mark.parametrize(
    ("spoil", "what"),
    [
        (lambda c: faults.mirrored_point(c, 0), "principal point of camera c1 is mirrored in x"),
        (lambda c: faults.mirrored_point(c, 1), "principal point of camera c1 is mirrored in y"),
        (scaled_focal, "% too long"),
        (lambda c: cameras.turned(c, [0.02, 0.01, 0]), "of camera c1 is wrong"),
        (lambda c: faults.scaled_picture(c, 2 / 3), "camera c1 was calibrated at 0.667 times"),
        (lambda c: faults.turned_picture(c, 2), "picture of camera c1 is turned by 180 degrees"),
    ],
)
@pytest.mark.parametrize("by", ["static", "people"])
def test_a_spoilt_camera_and_what_is_wrong_are_named(spoil, what, by):
    true = hall.four_cameras()
    static, people = seen(true)
    data = verdict.Seen(static, None) if by == "static" else verdict.Seen(None, people)
    message = verdict.judge([true[0], spoil(true[1]), *true[2:]], data, person_px=300.0)
    assert len(message.warnings) == 1 and "\n" not in message.warnings[0]
    assert what in message.warnings[0]
    assert message.warnings[0].endswith(verdict.TO_BE_SURE) == (by == "people")
    assert len(message.faults) == 1
    assert message.mended_px[by] < 0.7 * message.px[by]


def test_a_turned_and_zoomed_camera_is_named_by_points_over_its_picture():
    """People stay near its middle, where a focal length changes little."""
    true = hall.four_cameras()
    static, _ = seen(true)
    wrong = [true[0], turned_zoomed(true[1]), *true[2:]]
    message = verdict.judge(wrong, verdict.Seen(static, None), person_px=300.0)
    assert "direction and focal length of camera c1 are wrong" in message.warnings[0]


def test_exchanged_cameras_are_named():
    true = hall.four_cameras()
    exchanged = [true[0], replace(true[2], name="c1"), replace(true[1], name="c2"), true[3]]
    message = verdict.judge(exchanged, verdict.Seen(*seen(true)))
    assert [one.what for one in message.faults] == ["cameras c1 and c2 are exchanged"]


def test_several_mirrored_points_are_found_together():
    true = hall.four_cameras()
    spoilt = [
        faults.mirrored_point(one, axis) for one, axis in zip(true, (0, 1, 1, 1), strict=True)
    ]
    message = verdict.judge(spoilt, verdict.Seen(*seen(true)))
    assert [one.what[-22:] for one in message.faults] == [
        f"camera c{at} is mirrored in {letter}"[-22:] for at, letter in enumerate("xyyy")
    ]


def test_what_no_single_fault_explains_is_said_with_the_worst_camera():
    true = hall.four_cameras()
    spoilt = [cameras.turned(c, v) for c, v in zip(true, TURNS, strict=True)]
    message = verdict.judge(spoilt, verdict.Seen(seen(true)[0], None))
    assert message.faults == []
    assert "no single fault of it explains this, most of all camera c" in message.warnings[0]


def test_without_views_nothing_is_said():
    few = hall.seen_points(hall.four_cameras(), 3, 0.5, seed=0)
    message = verdict.judge(hall.four_cameras(), verdict.Seen(few, few))
    assert message == verdict.Verdict([], [], {}, {})


def test_two_cameras_are_judged_by_what_they_share():
    true = hall.four_cameras()[:2]
    static, people = seen(true)
    assert verdict.judge(true, verdict.Seen(static, people), 300.0).warnings == []
    turned = [true[0], faults.turned_picture(true[1], 2)]
    assert verdict.judge(turned, verdict.Seen(static, people), 300.0).warnings != []


def test_residuals_by_camera_have_a_sum():
    true = hall.four_cameras()
    static, people = seen(true)
    rows = verdict.by_camera(true, verdict.Seen(static, people))
    assert rows.camera.tolist() == ["c0", "c1", "c2", "c3", "all"] * 2
    of_all = rows[(rows.what == "static") & (rows.camera == "all")].off_px.item()
    exact = residuals.rms_px(residuals.Rays(static).residuals(true))
    assert of_all == pytest.approx(exact)
    assert rows[rows.camera == "all"].n.tolist() == [32, 480]


def walk_cameras(principal_point_px):
    found = file_formats.read(REAL / "walk-4cams" / "calibration" / "Calib.qca.txt")
    return file_formats.with_principal_points(found, principal_point_px)


@needs_real
def test_the_mirrored_points_of_a_real_file_are_found_by_points_at_rest():
    as_is, mended = walk_cameras({}), walk_cameras(SESSION["calibration"]["principal_point_px"])
    _, static = clicks.read_static(POINTS_CSV, [camera.name for camera in as_is])
    message = verdict.judge(as_is, verdict.Seen(static, None))
    assert [one.what for one in message.faults] == [
        "the principal point of camera cam01 is mirrored in x",
        "the principal point of camera cam02 is mirrored in y",
        "the principal point of camera cam03 is mirrored in y",
        "the principal point of camera cam04 is mirrored in y",
    ]
    assert message.px["static"] > 7
    good = verdict.judge(mended, verdict.Seen(static, None))
    assert good.warnings == [] and good.px["static"] <= 2.2
    assert good.px["static"] == pytest.approx(message.mended_px["static"], abs=0.01)


@needs_real
def test_points_of_another_hand_agree():
    """`static_points.csv` beside the recording: the same bolts and marks, measured separately."""
    table = REAL / "walk-4cams" / "static_points.csv"
    rows = [line.split(",") for line in table.read_text().splitlines()[1:]]
    points = sorted({row[0] for row in rows})
    names = ["cam01", "cam02", "cam03", "cam04"]
    xy = np.full((4, len(points), 2), np.nan)
    for point, camera, x, y in rows:
        xy[names.index(camera), points.index(point)] = float(x), float(y)
    mended = walk_cameras(SESSION["calibration"]["principal_point_px"])
    assert residuals.rms_px(residuals.Rays(xy).residuals(walk_cameras({}))) > 7
    assert residuals.rms_px(residuals.Rays(xy).residuals(mended)) < 2.2
