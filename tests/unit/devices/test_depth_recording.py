import numpy as np
import pytest

from courtside.devices.depth_recording import DepthRecording
from courtside.records.cameras.frame_times import FrameTimes
from fixtures.recordings.depth_recordings_made import COLOUR, DEPTH, PLACED


def recording(**changed):
    index = FrameTimes(np.array([0.0]), np.array([1]))
    values = {"colour_from_depth": PLACED, "depth_unit_m": 0.001} | changed
    return DepthRecording(
        name="d",
        colour=COLOUR,
        depth=DEPTH,
        colour_frames=lambda: iter([]),
        depth_frames=lambda: iter([]),
        colour_index=lambda: index,
        **values,
    )


@pytest.mark.parametrize(
    "changed",
    [
        {"depth_unit_m": 0.0},
        {"depth_unit_m": np.nan},
        {"colour_from_depth": np.eye(3)},
        {"colour_from_depth": np.full((3, 4), np.nan)},
        {"colour_from_depth": 2 * np.eye(3, 4)},
        {"colour_from_depth": np.diag([1, 1, -1, 1])[:3]},
    ],
)
def test_impossible_recordings_are_refused(changed):
    with pytest.raises(ValueError, match="expected"):
        recording(**changed)
