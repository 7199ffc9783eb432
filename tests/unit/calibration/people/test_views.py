"""People as cameras see them: blocks, joined takes, and one line for each kind of bad input."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.calibration.people import views
from courtside.study.errors import InputError
from fixtures.cameras import corner_cameras, walkers

CAMERAS = corner_cameras.four_cameras()


def test_blocks_cut_each_track_into_equal_parts_of_its_time():
    seen = walkers.seen(CAMERAS, walkers.joints(12))
    both = views.joined([seen, seen.of(np.arange(6))])
    assert both.track.tolist() == [0] * 12 + [1] * 6
    assert both.blocks(3).tolist() == [0] * 4 + [1] * 4 + [2] * 4 + [3] * 2 + [4] * 2 + [5] * 2


def test_many_rows_are_thinned_evenly():
    seen = walkers.seen(CAMERAS, walkers.joints(views.MOST_ROWS * 3))
    thin = seen.thinned()
    assert thin.xy.shape[1] == len(thin.track) == thin.height_px.shape[1] == views.MOST_ROWS
    np.testing.assert_array_equal(thin.xy[:, [0, -1]], seen.xy[:, [0, -1]])


def test_rows_that_one_camera_sees_are_left_out():
    seen = walkers.seen(CAMERAS, walkers.joints(views.MOST_ROWS * 3))
    score = seen.score.copy()
    score[1:, views.MOST_ROWS :] = np.nan
    thin = replace(seen, score=score).thinned()
    np.testing.assert_array_equal(thin.time_s, seen.time_s[: views.MOST_ROWS])
    score[1:] = np.nan
    assert len(replace(seen, score=score).thinned().track) == views.MOST_ROWS


def test_somebody_who_walks_is_good_input():
    seen = walkers.seen(CAMERAS, walkers.joints(60))
    assert views.check(CAMERAS, seen, 0.05) is None
    assert views.longest_way(CAMERAS, seen, 0.05) == pytest.approx(2 * 1.6 * 2**0.5, rel=0.1)


def one_camera(seen):
    score = seen.score.copy()
    score[1:] = np.nan
    return CAMERAS, replace(seen, score=score)


def on_a_line(seen):
    moved = []
    for at, camera in enumerate(CAMERAS):
        pose = camera.cam_from_world.copy()
        pose[:, 3] = -pose[:, :3] @ [at, 2.0 * at, 1.5]
        moved.append(replace(camera, cam_from_world=pose))
    return moved, seen


@pytest.mark.parametrize(
    ("spoil", "line"),
    [
        (one_camera, r"two cameras or more, found them in c0; name"),
        (on_a_line, "three or more that do not stand on one line, found 4"),
        (lambda seen: (CAMERAS, seen.of(np.arange(20))), "40 frames or more .* found 20"),
        (
            lambda _: (CAMERAS, walkers.seen(CAMERAS, walkers.joints(60, still=True))),
            "somebody who moves by 0.25 m or more, found 0.0",
        ),
    ],
)
def test_bad_input_is_told_in_one_line(spoil, line):
    with pytest.raises(InputError, match=line) as error:
        views.check(*spoil(walkers.seen(CAMERAS, walkers.joints(60))), 0.05)
    assert "\n" not in str(error.value)
