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
    ("changed", "message"),
    [
        ({"depth_unit_m": 0.0}, "expected a depth unit"),
        ({"depth_unit_m": np.nan}, "expected a depth unit"),
        ({"colour_from_depth": np.eye(3)}, "expected colour_from_depth as"),
        ({"colour_from_depth": np.full((3, 4), np.nan)}, "expected colour_from_depth as"),
        ({"colour_from_depth": 2 * np.eye(3, 4)}, "expected .* a right-handed rotation"),
        ({"colour_from_depth": np.diag([1, 1, -1, 1])[:3]}, "expected .* a right-handed rotation"),
    ],
)
def test_impossible_recordings_are_refused(changed, message):
    with pytest.raises(ValueError, match=message):
        recording(**changed)
