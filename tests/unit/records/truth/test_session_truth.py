"""The truth file: what was written comes back; anything else is refused in one line."""

import numpy as np
import pytest

from courtside.records.truth import session_truth
from courtside.study.errors import InputError
from fixtures.cameras import scene

POINTS = ["p01", "p02"]
XYZ = np.array([[0.001, 0.002, 0], [6.1, 0, 0]])


def walk(n_frames, seed=0):
    rng = np.random.default_rng(seed)
    poses = np.array([camera.cam_from_world for camera in scene.ring(n_frames)])
    matrix = np.array([[1000.0, 0, 640], [0, 1000, 360], [0, 0, 1]])
    points = matrix[:2, 2] + rng.normal(0, 3, (n_frames, 2))
    return session_truth.Walk(
        np.arange(n_frames) / 3, matrix, rng.normal(0, 0.01, 5), poses, points
    )


def test_what_was_written_comes_back(tmp_path):
    cameras = scene.ring(3, dist=(-0.1, 0.02, 1e-3, 1e-4, 0))
    walks = {"walk1": walk(4), "walk2": walk(7, seed=1)}
    session_truth.write(tmp_path / "truth.npz", cameras, walks, POINTS, XYZ)
    found = session_truth.read(tmp_path / "truth.npz")
    for camera, same in zip(cameras, found.cameras, strict=True):
        assert (camera.name, camera.size) == (same.name, same.size)
        for field in ("K", "dist", "cam_from_world"):
            np.testing.assert_array_equal(getattr(camera, field), getattr(same, field))
    assert list(found.walks) == ["walk1", "walk2"]
    for name, known in walks.items():
        for field, value in vars(known).items():
            np.testing.assert_array_equal(value, getattr(found.walks[name], field))
    assert found.court_points.tolist() == POINTS
    np.testing.assert_array_equal(found.court_xyz, XYZ)


def test_the_keys_are_those_of_the_contract(tmp_path):
    session_truth.write(tmp_path / "truth.npz", scene.ring(2), {"w": walk(5)}, POINTS, XYZ)
    with np.load(tmp_path / "truth.npz", allow_pickle=False) as stored:
        shapes = {key: stored[key].shape for key in stored.files}
    assert shapes == {
        "format": (),
        "camera": (2,),
        "size": (2, 2),
        "K": (2, 3, 3),
        "dist": (2, 5),
        "cam_from_world": (2, 3, 4),
        "court_points": (2,),
        "court_xyz": (2, 3),
        "w/time_s": (5,),
        "w/K": (3, 3),
        "w/dist": (5,),
        "w/cam_from_world": (5, 3, 4),
        "w/principal_point_px": (5, 2),
    }


def test_arrays_that_disagree_are_refused(tmp_path):
    broken = walk(5)
    broken = session_truth.Walk(broken.time_s[:4], *list(vars(broken).values())[1:])
    with pytest.raises(ValueError, match=r"w/cam_from_world: expected shape"):
        session_truth.write(tmp_path / "truth.npz", scene.ring(2), {"w": broken}, POINTS, XYZ)
    with pytest.raises(ValueError, match="court_xyz: expected shape"):
        session_truth.write(tmp_path / "truth.npz", scene.ring(2), {}, POINTS, XYZ[:1])
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("content", [b"", b"no archive", None])
def test_other_files_are_refused_in_one_line(tmp_path, content):
    path = tmp_path / "truth.npz"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(InputError, match="expected an npz file") as caught:
        session_truth.read(path)
    assert "\n" not in str(caught.value) and str(path) in str(caught.value)


def test_another_npz_file_is_refused(tmp_path):
    np.savez(tmp_path / "a.npz", format=np.array("courtside keypoints2d 1"), **{"w/x": np.zeros(3)})
    with pytest.raises(InputError, match="expected format 'courtside truth 1'"):
        session_truth.read(tmp_path / "a.npz")
