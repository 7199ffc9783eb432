"""The camera that does not agree with the others about a wand is named, and what it lacks."""

import re
from dataclasses import replace

import numpy as np
import pytest

from courtside.calibration.wand import calibration
from courtside.study.errors import InputError
from fixtures.cameras.wands_made import LENSES, SIZES, WAND, seen, swung


def fault(found):
    with pytest.raises(InputError) as error:
        calibration.calibrate(WAND, found, SIZES, lenses=LENSES)
    assert "\n" not in str(error.value)
    return str(error.value)


def good(n_cameras=4, seed=3):
    found = seen(swung(seconds=40, seed=seed), misread=0.03)
    return replace(found, cameras=found.cameras[:n_cameras], xy=found.xy[:n_cameras])


def changed(found, at, change):
    xy = found.xy.copy()
    xy[at] = change(xy[at])
    return replace(found, xy=xy)


def from_the_bottom(xy):
    return xy * [1, -1] + [0, 1079]


def late(xy):
    return np.roll(xy, 2, axis=0)


def exchanged(xy):
    found = xy.copy()
    found[::2] = found[::2, ::-1]
    return found


@pytest.mark.parametrize("at", range(4))
@pytest.mark.parametrize(
    ("change", "mend"),
    [
        (from_the_bottom, r", and 3\d\d once mirrored; undo the flip of its video, or"),
        (late, "; check its clock, that no markers are exchanged, and that its video is not"),
        (exchanged, "; check its clock, that no markers are exchanged"),
        (lambda xy: xy / 2, r", and 3\d\d times 2: they are of a smaller copy of its picture, which"
         " has 1920 x 1080 px; multiply x_px and y_px by 2"),
    ],
)  # fmt: skip
def test_the_camera_without_which_the_others_agree_is_named(at, change, mend):
    line = fault(changed(good(), at, change))
    assert line.startswith(
        f"camera c{at}: expected most of its markers to agree with the other cameras, which agree "
        "with each other, found "
    )
    assert re.search(mend, line)


@pytest.mark.parametrize("at", range(3))
def test_of_three_cameras_the_length_of_the_wand_tells_it(at):
    for change in (from_the_bottom, late):
        assert fault(changed(good(3), at, change)).startswith(f"camera c{at}: expected most of its")


def test_cameras_that_cannot_be_told_apart_are_all_named():
    """Of two cameras neither is accused; of three no one, where each pair agrees as well."""
    line = fault(changed(good(3), 0, exchanged))
    assert line.startswith("camera c0 or others of c1, c2, which one is not clear: expected most ")
    line = fault(changed(good(2), 1, late))
    assert line.startswith("wand: expected two cameras whose rays")


def test_two_late_cameras_are_no_single_culprit():
    found = good()
    both = changed(changed(found, 1, late), 3, lambda xy: np.roll(xy, -3, axis=0))
    line = fault(both)
    assert "which agree with each other" not in line


def test_cameras_of_which_two_at_a_time_see_the_wand_are_not_accused():
    found = good()
    xy = found.xy.copy()
    for t in range(xy.shape[1]):
        xy[[(t // 6 + 2) % 4, (t // 6 + 3) % 4], t] = np.nan
    line = fault(replace(found, xy=xy))
    assert line.startswith("camera c") and "which one is not clear" not in line
    assert line.endswith(
        "; it sees the wand too seldom together with two of the others: move the wand where three "
        "cameras see it"
    )


@pytest.mark.parametrize("n_cameras", [3, 4])
def test_markers_of_smaller_pictures_are_told_of_all_cameras(n_cameras):
    found = good(n_cameras)
    line = fault(replace(found, xy=found.xy / 2))
    assert line == (
        "wand: expected markers in px of the cameras' pictures, found some of smaller copies: the "
        "cameras agree once all are multiplied; multiply x_px and y_px by 2"
    )
