"""Cameras of a file against a court's lines: planted faults are named, right cameras are not."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.calibration.file_check import court_place, faults
from courtside.geometry import camera as cameras
from courtside.geometry import rotations
from fixtures.cameras.court_cameras import COURT, MIDDLE, right_cameras, views


def spoilt(seen_by, at, change):
    return [*seen_by[:at], change(seen_by[at]), *seen_by[at + 1 :]]


def zoomed(camera, by):
    matrix = camera.K.copy()
    matrix[[0, 1], [0, 1]] *= by
    return replace(camera, K=matrix)


def moved(camera, by_m):
    pose = camera.cam_from_world.copy()
    pose[:, 3] -= pose[:, :3] @ np.asarray(by_m)
    return replace(camera, cam_from_world=pose)


def other_lens(camera):
    return replace(zoomed(camera, 1.04), dist=np.array([0.08, 0.0, 0, 0, 0]))


@pytest.mark.parametrize("n", [2, 3, 4])
@pytest.mark.parametrize("seed", range(3))
def test_right_cameras_are_not_warned_of(n, seed):
    seen_by = right_cameras(n)
    judged = court_place.judge(seen_by, views(seen_by, seed=seed), COURT, either_end=True)
    assert judged.warnings == [] and judged.faults == []
    assert judged.place.n_agreeing() == n and (judged.place.away_m < 0.05).all()


@pytest.mark.parametrize("turned_by", [(0, 0, 0.027), (0.01, 0, 0)])
def test_a_turned_camera_is_named(turned_by):
    true = right_cameras()
    file = spoilt(true, 1, lambda c: cameras.turned(c, turned_by))
    judged = court_place.judge(file, views(true), COURT, either_end=True)
    assert [one.what for one in judged.faults] == [
        "the direction or principal point of camera c1 is wrong"
    ]
    assert len(judged.warnings) == 1 and "\n" not in judged.warnings[0]
    said = "camera c1 of the file does not see the court's lines where the others do"
    assert said in judged.warnings[0]


@pytest.mark.parametrize(
    ("change", "what"),
    [
        (lambda c: zoomed(c, 1.03), "the focal length of camera c2 is 3."),
        (
            lambda c: cameras.turned(zoomed(c, 0.966), (0, 0, 0.027)),
            "the direction and focal length of camera c2 are wrong",
        ),
        (
            lambda c: moved(cameras.turned(c, (0.01, 0.01, 0)), (0.4, 0.2, 0.1)),
            "the place and direction of camera c2 are wrong",
        ),
        (other_lens, "the focal length and distortion of camera c2 are wrong"),
    ],
)
def test_what_changed_is_named_and_mended(change, what):
    true = right_cameras()
    judged = court_place.judge(spoilt(true, 2, change), views(true), COURT, either_end=True)
    assert len(judged.faults) == 1 and what in judged.faults[0].what
    grid = MIDDLE + np.random.default_rng(0).uniform([-2, -5, 0], [2, 5, 1], (50, 3))
    off_px = cameras.project(judged.faults[0].cameras[2], grid) - cameras.project(true[2], grid)
    assert np.median(np.abs(off_px)) < 4


def test_two_wrong_cameras_of_four_are_both_named():
    true = right_cameras()
    file = spoilt(true, 0, lambda c: cameras.turned(c, (0, 0.02, 0)))
    file = spoilt(file, 3, lambda c: zoomed(c, 1.05))
    judged = court_place.judge(file, views(true), COURT, either_end=True)
    assert [one.what.split("camera ")[1][:2] for one in judged.faults] == ["c0", "c3"]


def test_ends_that_pictures_do_not_show_are_found():
    true = right_cameras()
    xy = views(true)
    other = COURT.other_end()
    np.testing.assert_allclose(
        COURT.xyz[other][:, :2], 2 * MIDDLE[:2] - COURT.xyz[:, :2], atol=0.01
    )
    mixed = np.stack([xy[0], xy[1][other], xy[2], xy[3][other]])
    assert court_place.judge(true, mixed, COURT, either_end=True).warnings == []
    stated = court_place.judge(true, mixed, COURT, either_end=False)
    assert stated.place.n_agreeing() < 4


def test_a_camera_that_sees_a_court_beside_is_left_out():
    true = right_cameras()
    beside = replace(COURT, xyz=COURT.xyz + np.array([7.0, 0, 0]))
    xy = views(true)
    wide = zoomed(true[3], 0.6)
    xy[3] = views([wide], court=beside)[0]
    judged = court_place.judge([*true[:3], wide], xy, COURT, either_end=True)
    assert judged.warnings == [] and judged.faults == []
    assert judged.place.away_m[3] > 6


def test_of_two_cameras_that_disagree_none_is_named():
    true = right_cameras(2)
    file = spoilt(true, 1, lambda c: cameras.turned(c, (0, 0, 0.03)))
    judged = court_place.judge(file, views(true), COURT, either_end=True)
    assert len(judged.warnings) == 1 and judged.faults == []
    assert "too few agree to say which are wrong" in judged.warnings[0]


def test_two_cameras_may_see_two_courts():
    true = right_cameras(2)
    wide = zoomed(true[1], 0.6)
    beside = views([wide], court=replace(COURT, xyz=COURT.xyz + np.array([7.0, 0, 0])))
    xy = np.stack([views(true)[0], beside[0]])
    judged = court_place.judge([true[0], wide], xy, COURT, either_end=True)
    assert judged.place.n_agreeing() == 1 and judged.warnings == []


def test_a_file_in_another_unit_is_named():
    true = right_cameras()
    file = [replace(c, cam_from_world=c.cam_from_world * [1, 1, 1, 1.03]) for c in true]
    judged = court_place.judge(file, views(true), COURT, either_end=True)
    assert judged.faults == [] and len(judged.warnings) == 1
    assert "court badminton is 3." in judged.warnings[0]


def test_a_file_in_another_frame_is_named():
    true = right_cameras()
    turn = rotations.rotation_from_rodrigues([0, 0, np.pi / 2])
    file = []
    for one in true:
        pose = one.cam_from_world.copy()
        pose[:, 3] += pose[:, :3] @ MIDDLE  # origin in the middle
        file.append(replace(one, cam_from_world=np.column_stack([pose[:, :3] @ turn, pose[:, 3]])))
    judged = court_place.judge(file, views(true), COURT, either_end=True)
    assert len(judged.warnings) == 1
    assert "is not that of court badminton: its middle is 7.4 m" in judged.warnings[0]
    assert "turned by 90 degrees and tilted by 0" in judged.warnings[0]


def test_half_a_turn_is_told_only_where_lines_show_it():
    true, turn, file = right_cameras(), np.diag([-1.0, -1.0, 1.0]), []
    for one in true:
        pose = one.cam_from_world @ np.vstack([
            np.column_stack([turn, 2 * MIDDLE * [1, 1, 0]]), [0, 0, 0, 1]
        ])  # fmt: skip
        file.append(replace(one, cam_from_world=pose))
    assert court_place.judge(file, views(true), COURT, either_end=True).warnings == []
    (line,) = court_place.judge(file, views(true), COURT, either_end=False).warnings
    assert "its middle is 0.0 m from where figures draw it, turned by 180 degrees" in line


def test_one_camera_or_few_points_say_nothing():
    true = right_cameras()
    xy = views(true)
    xy[1:] = np.nan
    assert court_place.judge(true, xy, COURT, either_end=True).place is None
    few = views(true)
    few[:, 5:] = np.nan
    assert court_place.judge(true, few, COURT, either_end=True).place is None


def test_residuals_by_camera_say_where_the_lines_are_seen():
    true = right_cameras()
    xy = views(true, noise_px=0.0)
    xy[2] += (9.0, -4.0)
    rows = court_place.by_camera(true, court_place.locate(true, xy, COURT, either_end=True))
    assert rows.camera.tolist() == ["c0", "c1", "c2", "c3"]
    assert rows.loc[2, ["x_px", "y_px"]].tolist() == pytest.approx([9, -4], abs=0.7)
    on_floor = COURT.xyz[:, 2] == 0
    assert rows.n.tolist() == np.isfinite(xy[:, on_floor, 0]).sum(axis=1).tolist()
    assert rows.off_px[2] == pytest.approx(np.hypot(9, 4) / np.sqrt(2), abs=0.7)
    assert (rows.off_px.drop(2) < 0.7).all()


@pytest.mark.parametrize(
    ("change", "what"),
    [
        (
            lambda c: faults.mirrored_point(c, 0),
            "the principal point of camera c1 is mirrored in x",
        ),
        (lambda c: faults.turned_picture(c, 2), "picture of camera c1 is turned by 180 degrees"),
        (lambda c: faults.scaled_picture(c, 1.5), "camera c1 was calibrated at 1.5 times"),
    ],
)
def test_faults_without_free_numbers_are_named(change, what):
    true = right_cameras()
    matrix = true[1].K.copy()
    matrix[:2, 2] += (14.0, -11.0)  # off the middle, so that mirrored differs
    true[1] = replace(true[1], K=matrix)
    judged = court_place.judge(spoilt(true, 1, change), views(true), COURT, either_end=True)
    assert len(judged.warnings) == 1 and [what in one.what for one in judged.faults] == [True]


def test_exchanged_cameras_are_named():
    true = right_cameras()
    file = [true[0], replace(true[2], name="c1"), replace(true[1], name="c2"), true[3]]
    judged = court_place.judge(file, views(true), COURT, either_end=True)
    assert [one.what for one in judged.faults] == ["cameras c1 and c2 are exchanged"]
    assert len(judged.warnings) == 1
