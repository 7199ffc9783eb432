import dataclasses

import numpy as np
import pytest

from courtside.devices import open_depth
from courtside.study.errors import InputError
from fixtures.recordings.depth_recordings_made import BASELINE_M, write_bag


def test_a_file_is_a_recording_of_the_camera_s_program(tmp_path):
    found = open_depth.read(write_bag(tmp_path / "a.bag"), "cam")
    assert found.name == "cam"
    assert open_depth.baseline(found, 0.1) == pytest.approx(BASELINE_M)
    unknown = dataclasses.replace(found, baseline_m=np.nan)
    assert open_depth.baseline(unknown, 0.1) == 0.1


def test_a_folder_is_read_as_plain_files(tmp_path):
    with pytest.raises(InputError, match=r"cameras\.toml"):
        open_depth.read(tmp_path, "cam")


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(InputError, match=r"none\.bag"):
        open_depth.read(tmp_path / "none.bag", "cam")
