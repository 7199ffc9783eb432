import dataclasses

import numpy as np
import pytest

from courtside.devices import open_depth
from courtside.study.errors import InputError
from fixtures.recordings.depth_recordings_made import BASELINE_M, UNIT_M, frames, write_bag


def test_a_file_is_a_recording_of_the_camera_s_program(tmp_path):
    found = open_depth.read(write_bag(tmp_path / "a.bag"), "cam")
    assert found.name == "cam"
    assert open_depth.baseline(found, 0.1) == pytest.approx(BASELINE_M)
    unknown = dataclasses.replace(found, baseline_m=np.nan)
    assert open_depth.baseline(unknown, 0.1) == 0.1


def test_a_folder_is_read_as_plain_files(tmp_path):
    with pytest.raises(InputError, match=r"cameras\.toml"):
        open_depth.read(tmp_path, "cam")


def test_empty_first_pictures_are_passed_over(tmp_path):
    made = [(t, colour, depth * (k > 1)) for k, (t, colour, depth) in enumerate(frames())]
    assert open_depth.read(write_bag(tmp_path / "a.bag", made), "cam").depth_unit_m == UNIT_M
    wrong = [
        (t, colour, (depth > 0) * np.uint16(k > 1)) for k, (t, colour, depth) in enumerate(made)
    ]
    with pytest.raises(InputError, match=r"b\.bag: .* found a median of 0\.00025 m"):
        open_depth.read(write_bag(tmp_path / "b.bag", wrong), "cam")


def test_a_recording_of_one_picture_is_told(tmp_path):
    path = write_bag(tmp_path / "a.bag", frames(1))
    with pytest.raises(InputError, match=r"a\.bag: expected 2 colour .* found 1; record longer"):
        open_depth.colour_times(path, open_depth.read(path, "cam"))
    two = write_bag(tmp_path / "b.bag", frames(2))
    assert len(open_depth.colour_times(two, open_depth.read(two, "cam")).time_s) == 2


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(InputError, match=r"none\.bag"):
        open_depth.read(tmp_path / "none.bag", "cam")
