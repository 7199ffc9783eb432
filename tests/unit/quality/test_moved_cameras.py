"""A camera that stands elsewhere is found by the people in its pictures, whoever is followed."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.geometry import camera as camera_models
from courtside.quality import causes, moved_cameras, verdict
from courtside.study.execution.verdicts import ALL, FAILED, GOOD, WHOLE
from fixtures.people import judged

SAME = dict.fromkeys(("c0", "c1", "c2", "c3"), (0, 1))
# Metres and degrees by which the calibration is off: on the courts beside, and moved on its stand.
PLACES = [((8.1, 0, 0), 0), ((0, -8.1, 0), 0), ((0, 2, 0), 0), ((0, 0, 0), 40), ((-3, 4, 0.5), 60)]


def displaced(cameras, at, by_m, degrees):
    """Return the cameras with one whose calibration is displaced and turned."""
    wrong = camera_models.turned(cameras[at].camera, np.deg2rad(degrees) * np.array([0.0, 1, 0]))
    pose = wrong.cam_from_world.copy()
    pose[:, 3] -= pose[:, :3] @ by_m
    wrong = replace(wrong, cam_from_world=pose)
    return [replace(one, camera=wrong) if k == at else one for k, one in enumerate(cameras)]


@pytest.mark.parametrize("rows", [(0, 1), (-1, -1)])
@pytest.mark.parametrize(("by_m", "degrees"), PLACES)
def test_a_camera_that_stands_elsewhere_is_named_with_the_way(by_m, degrees, rows):
    """It was said that nobody found there is the person, or that nobody is followed."""
    cameras = judged.followed(judged.footage(), SAME | {"c2": rows})
    table = verdict.judge(judged.gathered(displaced(cameras, 2, by_m, degrees)))
    wholes = {row.camera: row for row in table[table["measure"] == WHOLE].itertuples()
              if row.person == ALL}  # fmt: skip
    assert (wholes["c2"].verdict, wholes["c2"].cause) == (FAILED, causes.CALIBRATION)
    said = wholes["c2"].sentence
    true = dict(zip("xyz", -np.array(by_m, float) + 0.0, strict=True))
    way = ", ".join(f"{axis} {by:+.1f}" for axis, by in true.items())
    assert f"it stands {np.linalg.norm(by_m):.1f} m (+-" in said
    assert f"from the calibrated place ({way} m), turned by {degrees} degrees; it was" in said
    assert {wholes[name].verdict for name in ("c0", "c1", "c3")} == {GOOD}


@pytest.mark.parametrize("rows", [(0, 1), (-1, -1)])
def test_a_camera_that_was_moved_is_not_told_to_be_turned_alone(rows):
    """A rotation leaves 0.07 to 0.11 of a height, which passed for a turned camera."""
    names = ("c0", "c1", "c2")
    cameras = judged.followed(
        judged.footage(n_cameras=3), dict.fromkeys(names, (0, 1)) | {"c2": rows}
    )
    seen = judged.gathered(displaced(cameras, 2, (1.5, -1, 0), 0))
    cause = causes.find(seen, 2, found_limit=0.9)
    assert cause.name == causes.CALIBRATION
    assert "stands 1.8 m (+-0.1) from the calibrated place (x -1.5, y +1.0" in cause.sentence


def test_the_place_lies_within_its_uncertainty_and_is_not_told_if_that_is_large():
    found = {}
    for n_frames in (12, 150):
        cameras = judged.followed(judged.footage(n_frames), dict.fromkeys(SAME, (0,)))
        rng = np.random.default_rng(1)
        cameras[2].tracklets.xy[...] += 8 * rng.normal(size=(2, 1, 33, 2))  # as a network errs
        moved = moved_cameras.find(judged.gathered(displaced(cameras, 2, (8.1, 0, 0), 0)), 2)
        off_m = np.linalg.norm(moved.after.centre_in_world - cameras[2].camera.centre_in_world)
        assert off_m < 3 * moved.sigma_m
        found[n_frames] = moved
    assert found[12].sigma_m > moved_cameras.TOLD_M > found[150].sigma_m
    assert "elsewhere or is turned; how far, they move too little to tell" in str(found[12])
    assert "m (+-" in str(found[150]) and "elsewhere" not in str(found[150])


def test_a_camera_whose_pose_is_right_is_not_moved():
    for share in (0.0, 0.3):
        seen = judged.gathered(judged.footage(hidden={2: share}))
        assert moved_cameras.find(seen, 2) is None


@pytest.mark.parametrize("people", ["others", "none", "poor"])
def test_people_who_are_not_those_of_the_other_cameras_move_no_camera(people):
    cameras = judged.footage(hidden={2: 1.0} if people == "none" else ())
    view, rng = cameras[2].tracklets, np.random.default_rng(0)
    if people == "others":
        view.xy[...] = view.xy[:1, :1] + np.array([300.0, 0.0])  # stands still
    if people == "poor":
        view.xy[...] += rng.normal(0, 25, view.xy.shape)
    assert moved_cameras.find(judged.gathered(displaced(cameras, 2, (0, 0, 0), 0)), 2) is None


@pytest.mark.parametrize("n_cameras", [2, 4])
def test_nothing_is_said_where_the_others_place_nobody(n_cameras):
    hidden = {0: 1.0, 1: 1.0, 3: 1.0} if n_cameras == 4 else {}
    cameras = judged.footage(n_cameras=n_cameras, hidden=hidden)
    seen = judged.gathered(displaced(cameras, 1, (8.1, 0, 0), 0))
    assert moved_cameras.find(seen, 1) is None


def test_nor_by_others_that_stand_too_near_each_other_to_place_people():
    cameras = judged.footage(n_cameras=3, sides_deg=(0.0, 1.0, 90.0))
    assert moved_cameras.find(judged.gathered(displaced(cameras, 2, (8.1, 0, 0), 0)), 2) is None
