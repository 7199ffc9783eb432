"""OpenCap's pickles: read as data, never run."""

import pickle
import shutil

import numpy as np
import pytest

from courtside.calibration import file_formats
from courtside.geometry import camera as cameras
from courtside.study.errors import InputError
from fixtures.cameras import foreign_files as theirs


class Bad:
    """An object whose pickle writes a file when it is loaded as usual."""

    def __init__(self, path):
        self.path = path

    def __reduce__(self):
        return (open, (str(self.path), "w"))


def test_a_folder_of_pickles_or_opencaps_own_folders_give_the_cameras(tmp_path):
    theirs.opencap(tmp_path / "cam00.pickle")
    folders = tmp_path / "Videos"
    for name in ("Cam0", "Cam1"):
        (folders / name).mkdir(parents=True)
        shutil.copy(tmp_path / "cam00.pickle", folders / name / "cameraIntrinsicsExtrinsics.pickle")
    (one,) = file_formats.read(tmp_path)
    assert [camera.name for camera in file_formats.read(folders)] == ["Cam0", "Cam1"]
    assert (one.name, one.size) == ("cam00", theirs.SIZE)
    pose = np.column_stack([theirs.ROTATION, theirs.TRANSLATION])
    same = cameras.Camera("same", theirs.SIZE, theirs.K, theirs.DIST, pose)
    xy = cameras.project(file_formats.read(tmp_path / "cam00.pickle")[0], theirs.POINTS)
    np.testing.assert_allclose(xy, cameras.project(same, theirs.POINTS), atol=1e-6)


@pytest.mark.parametrize("protocol", [2, 3, 5])
def test_pickles_of_other_ages_are_the_same_or_refused(tmp_path, protocol):
    theirs.opencap(tmp_path / "a.pickle")
    content = pickle.loads((tmp_path / "a.pickle").read_bytes())
    (tmp_path / "b.pickle").write_bytes(pickle.dumps(content, protocol=protocol))
    one = file_formats.read(tmp_path / "a.pickle")[0]
    if protocol == 5:
        with pytest.raises(InputError, match=r"uses BYTEARRAY8; give the pickle that"):
            file_formats.read(tmp_path / "b.pickle")
    else:
        other = file_formats.read(tmp_path / "b.pickle")[0]
        np.testing.assert_array_equal(one.cam_from_world, other.cam_from_world)


@pytest.mark.parametrize("protocol", [0, 2, 4])
def test_a_pickle_that_would_run_something_does_not(tmp_path, protocol):
    made = tmp_path / "made"
    (tmp_path / "bad.pickle").write_bytes(pickle.dumps({"rotation": Bad(made)}, protocol=protocol))
    with pytest.raises(InputError, match=r"bad\.pickle: expected a calibration of OpenCap") as one:
        file_formats.read(tmp_path / "bad.pickle")
    assert "\n" not in str(one.value)
    assert not made.exists()


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ([1, 2], "list in place of imageSize"),
        ({"rotation": 1}, r"\['rotation'\] in place of imageSize"),
        (dict.fromkeys(("imageSize", "intrinsicMat", "distortion", "rotation", "translation"), 1.0),
         "camera bad: expected imageSize"),
    ],
)  # fmt: skip
def test_other_contents_are_one_line(tmp_path, content, message):
    (tmp_path / "bad.pickle").write_bytes(pickle.dumps(content, protocol=4))
    with pytest.raises(InputError, match=message) as caught:
        file_formats.read(tmp_path / "bad.pickle")
    assert "\n" not in str(caught.value)
