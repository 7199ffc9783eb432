"""Everybody in the footage of a take, with paths, rows on each camera's frames, and a line."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.reconstruction.association import associate, everybody
from courtside.records.cameras.footage import Footage
from courtside.records.devices.clocks import Clock
from courtside.study.errors import InputError
from fixtures.cameras import scene
from fixtures.people import walker

CAMERAS = scene.ring(3)


def test_a_walker_is_one_person_in_all_cameras():
    record = walker.points(n_frames=40)
    views = walker.views(record, CAMERAS)
    seen = [Footage(c, v, Clock()) for c, v in zip(CAMERAS, views, strict=True)]
    found, line = everybody.find(seen, walker.SKELETON, None)
    assert found.person_id.tolist() == ["person-1"] and line.startswith("1 people found")
    assert all((rows[0] == 0).mean() > 0.9 for rows in found.index.values())
    middle = np.nanmedian(found.path[0], axis=0)
    assert np.linalg.norm(middle[:2] - np.nanmedian(record.xyz[0], axis=(0, 1))[:2]) < 0.2


def test_rows_of_slow_cameras_are_described_by_their_own_frames(monkeypatch):
    """The first camera films three times as fast as the others, whose frames count."""
    views = walker.views(walker.points(n_frames=40), CAMERAS)
    fields = ("xy", "score", "reason", "xyz_in_body", "clothing")
    slow = [
        replace(
            view, time_s=view.time_s[::3], **{key: getattr(view, key)[:, ::3] for key in fields}
        )
        for view in views[1:]
    ]
    strides, describe = [], associate.describe
    monkeypatch.setattr(
        associate,
        "describe",
        lambda xy, trunk, stride: strides.append(stride) or describe(xy, trunk, stride),
    )
    seen = [Footage(c, v, Clock()) for c, v in zip(CAMERAS, [views[0], *slow], strict=True)]
    found, _ = everybody.find(seen, walker.SKELETON, None)
    assert strides == [1, 3, 3]
    assert len(found.person_id) == 1


@pytest.mark.parametrize(("score", "hidden"), [(0.3, True), (0.9, False)])
def test_where_nobody_is_placed_the_line_tells_whether_bodies_are_hidden(score, hidden):
    """Two rows in each camera, which no other camera agrees with."""
    random = np.random.default_rng(0)
    views = walker.views(walker.points(n_frames=40), CAMERAS)
    wrong = []
    for view in views:
        xy = random.uniform(0, view.size, (2, *view.xy.shape[1:]))
        more = {
            key: np.repeat(getattr(view, key), 2, axis=0)
            for key in ("reason", "xyz_in_body", "clothing")
            if getattr(view, key, None) is not None
        }
        wrong.append(replace(view, xy=xy, score=np.full(xy.shape[:3], score), **more))
    seen = [Footage(c, v, Clock()) for c, v in zip(CAMERAS, wrong, strict=True)]
    with pytest.raises(InputError, match="expected people whom two views see") as caught:
        everybody.find(seen, walker.SKELETON, None, "board")
    assert "; the cameras stand up to " in str(caught.value)
    assert str(caught.value).endswith(" m apart: if that is wrong, correct `square_m` of the board")
    assert ("0% in c0" in str(caught.value)) == hidden
    assert ("film whole bodies" in str(caught.value)) == hidden


def test_cameras_that_share_no_time_by_their_clocks_are_told_so():
    views = walker.views(walker.points(n_frames=40), CAMERAS[:2])
    seen = [
        Footage(camera, view, Clock(offset_s=offset_s))
        for camera, view, offset_s in zip(CAMERAS, views, (0.0, 100.0), strict=False)
    ]
    with pytest.raises(InputError, match="c0, c1: expected cameras that film at one time"):
        everybody.find(seen, walker.SKELETON, None)
