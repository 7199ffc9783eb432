"""Bodies of impossible size are told: cameras agree although the distance between them is wrong."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.calibration.people import metric_scale
from courtside.quality import body_sizes, verdict
from courtside.quality.calibration_doubts import Doubts
from courtside.study.execution.verdicts import ALL, CALIBRATION, DOUBTFUL, GOOD, WHOLE
from fixtures.people import judged

# The bodies of `judged`: thigh and shank 0.4 m each, 0.5 m from the hips to the shoulders.
HEIGHT_M = 1.3 / metric_scale.SEEN.mean
NOBODY = {"p1": None, "p2": None}


def beside(along_m):
    """Return two cameras, the second calibrated so much farther from the first one."""
    one, other = judged.footage(n_cameras=2, sides_deg=(0.0, 60.0))
    centres = one.camera.centre_in_world, other.camera.centre_in_world
    way = (centres[1] - centres[0]) / np.linalg.norm(centres[1] - centres[0])
    pose = other.camera.cam_from_world.copy()
    pose[:, 3] -= pose[:, :3] @ (along_m * way)
    return [one, replace(other, camera=replace(other.camera, cam_from_world=pose))]


def whole(cameras, stated_m):
    points = judged.fused(cameras)
    said = Doubts(shared=tuple(filter(None, [body_sizes.doubt(points, stated_m)])))
    table = verdict.judge(judged.gathered(cameras), said)
    rows = table[(table["measure"] == WHOLE) & (table["camera"] == ALL) & (table["person"] == ALL)]
    return rows.iloc[0]


def test_the_height_is_that_of_the_body():
    found = body_sizes.measured_m(judged.fused(judged.footage()))
    assert found == {"p1": pytest.approx(HEIGHT_M, 0.02), "p2": pytest.approx(HEIGHT_M, 0.02)}


@pytest.mark.parametrize("along_m", [8.1, 3.0])
def test_a_camera_that_is_clicked_on_the_court_beside_is_told_where_both_agree(along_m):
    assert whole(beside(0.0), NOBODY).verdict == GOOD
    row = whole(beside(along_m), NOBODY)
    assert (row.verdict, row.cause) == (DOUBTFUL, CALIBRATION)
    height_m = HEIGHT_M * (8 + along_m) / 8
    stated = float(row.sentence.split("found p1 ")[1].split(" m tall")[0])
    assert stated == pytest.approx(height_m, rel=0.05)
    assert "(usual: 1.0 to 2.3 m)" in row.sentence and "two courts" in row.sentence


@pytest.mark.parametrize(("stated_m", "told"), [(HEIGHT_M, False), (1.45, True), (2.1, True)])
def test_stated_heights_are_the_closer_limit(stated_m, told):
    points = judged.fused(judged.footage())
    line = body_sizes.doubt(points, dict.fromkeys(NOBODY, stated_m))
    assert (f"(stated: {stated_m:.2f} m)" in line) is told and "\n" not in line
    assert body_sizes.doubt(points, {"p1": HEIGHT_M, "p2": stated_m}) == ""  # p1 is right


def test_nothing_is_said_of_few_joints():
    points = judged.fused(judged.footage(n_frames=metric_scale.LEAST_FRAMES // 2 - 1))
    assert body_sizes.measured_m(points) == {} and body_sizes.doubt(points, NOBODY) == ""
    assert body_sizes.doubt(points.some_joints([0, 1]), {"p1": 1.0}) == ""
