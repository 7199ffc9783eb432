"""The table of who is which tracklet: round trip, and keypoints by person."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.records.keypoints import missing_reason, people
from courtside.records.keypoints.keypoints import Keypoints2D
from courtside.study.errors import InputError
from fixtures.people import found as found_people


def view(rows=3, frames=5, joints=2):
    at = np.arange(rows * frames * joints, dtype=float).reshape(rows, frames, joints)
    return Keypoints2D(
        camera="left",
        model="m",
        joints=np.array(["a", "b"]),
        size=np.array([64, 48]),
        time_s=np.arange(frames) / 30,
        xy=np.stack([at, -at], axis=-1),
        score=at / 100,
        reason=np.full((rows, frames, joints), missing_reason.OUT_OF_IMAGE, np.uint8),
        xyz_in_body=np.stack([at, at, at], axis=-1),
        clothing=np.stack([at[..., :2]] * 3, axis=-1),
    )


def table():
    index = {"left": np.array([[0, 0, 2, 2, -1], [1, -1, 0, 0, 0]]), "right": np.zeros((2, 3), int)}
    doubts = np.array([[0.0, 0.2, 0.6, 1, 0.8]])
    return found_people.people(index, placed=np.array([0.9, 0.5]), doubts=doubts)


def test_cameras_with_different_numbers_of_frames_come_back(tmp_path):
    people.write(tmp_path / "people.npz", table())
    found = people.read(tmp_path / "people.npz")
    assert found.model == "m"
    assert found.person_id.tolist() == ["p1", "p2"]
    assert found.placed.tolist() == [0.9, 0.5]
    assert list(found.index) == ["left", "right"]
    for key in people.PLAIN:
        np.testing.assert_array_equal(getattr(found, key), getattr(table(), key))
    assert found.shares()["left"].tolist() == [0.8, 0.8]
    for camera, index in table().index.items():
        np.testing.assert_array_equal(found.index[camera], index)


@pytest.mark.parametrize(
    ("kept", "shown"),
    [
        ([0.8, 0.995, 0.7, 0.95], [0.8, 0.7]),  # the others are sure together
        ([0.96, 0.93, 0.95, 0.92, 0.97], [0.93, 0.95, 0.92]),  # each is sure, together they are not
        ([0.8, 0.7, 0.6, 0.5, 0.95], [0.8, 0.7, 0.6, 0.5]),
        ([0.96, 0.97], []),
        ([], []),
    ],
)
def test_of_a_doubtful_person_the_least_certain_times_are_to_be_checked(kept, shown):
    rows = [[0.0, at, at + 0.5, 1, one] for at, one in enumerate(kept)]
    doubts = np.array([*rows, [1.0, 0.0, 0.5, 0, 0.3]])
    assert replace(table(), doubts=doubts).to_check(0)[:, 4].tolist() == shown


def test_a_table_that_was_cut_is_refused(tmp_path):
    path = tmp_path / "people.npz"
    people.write(path, table())
    with np.load(path) as stored:
        arrays = dict(stored)
    np.savez(path, **{**arrays, "index": arrays["index"][:, :-1]})
    with pytest.raises(InputError, match=r"people\.npz: index: expected 8 frames .* found 7"):
        people.read(path)


def test_each_person_gets_the_row_of_each_frame():
    found = table().assigned(view())
    np.testing.assert_array_equal(found.xy[0, :2], view().xy[0, :2])
    np.testing.assert_array_equal(found.xy[0, 2:4], view().xy[2, 2:4])
    np.testing.assert_array_equal(found.xyz_in_body[1, 2:], view().xyz_in_body[0, 2:])
    np.testing.assert_array_equal(found.clothing[1, 2:], view().clothing[0, 2:])
    assert found.reason.dtype == np.uint8
    for person, frame in ((0, 4), (1, 1)):
        assert np.isnan(found.xy[person, frame]).all()
        assert np.isnan(found.score[person, frame]).all()
        assert (found.reason[person, frame] == missing_reason.UNSEEN).all()
    assert (found.reason[0, :4] == missing_reason.OUT_OF_IMAGE).all()


def test_row_0_throughout_changes_nothing():
    one = view(rows=1)
    found = replace(table(), index={"left": np.zeros((1, 5), int)}).assigned(one)
    for name in ("xy", "score", "reason", "xyz_in_body", "clothing"):
        np.testing.assert_array_equal(getattr(found, name), getattr(one, name))


@pytest.mark.parametrize("index", [np.zeros((1, 4), int), np.full((1, 5), 3)])
def test_a_table_of_other_keypoints_is_refused(index):
    with pytest.raises(InputError, match="left: expected people in 5 frames of 3 tracklets"):
        replace(table(), index={"left": index}).assigned(view())


def test_a_camera_without_people_is_named():
    with pytest.raises(InputError, match="other: expected people of the cameras left, right"):
        table().assigned(Keypoints2D(**{**vars(view()), "camera": "other"}))
