"""Everybody in the footage of a take, with paths, rows on each camera's frames, and a line."""

import numpy as np

from courtside.reconstruction.association import everybody
from courtside.records.cameras.footage import Footage
from courtside.records.devices.clocks import Clock
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
