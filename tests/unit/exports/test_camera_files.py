"""Cameras for other programs: our own readers, held against those programs elsewhere, read them."""

import numpy as np

from courtside.calibration import file_formats
from courtside.exports import camera_files
from courtside.geometry import camera as cameras
from fixtures.cameras import foreign_files as theirs


def test_each_form_holds_the_same_cameras(tmp_path):
    pose = np.column_stack([theirs.ROTATION, theirs.TRANSLATION])
    ours = [
        cameras.Camera("left-1", theirs.SIZE, theirs.K, theirs.DIST, pose),
        cameras.Camera("right", (1280, 720), theirs.K, [-0.1, 0, 0, 0, 0], np.eye(3, 4)),
    ]
    for _ in range(2):  # the second replaces the first
        camera_files.write(tmp_path / "out", ours)
    for program in camera_files.FORMS:
        unit = "m" if program == "colmap" else None
        for one, other in zip(
            file_formats.read(tmp_path / "out" / program, unit), ours, strict=True
        ):
            assert (one.name, one.size) == (other.name, other.size)
            xy = cameras.project(other, theirs.POINTS)
            np.testing.assert_allclose(cameras.project(one, theirs.POINTS), xy, atol=1e-6)
