"""Heel and toe between frames."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.footwork import tracks
from fixtures.people import walking_feet


@pytest.fixture(scope="module")
def points():
    return walking_feet.record(walking_feet.gait(), 5.0, sigma_m=0.002)[0]


def test_heights_are_those_above_the_flat_foot_wherever_the_floor_is(points):
    found, floor = tracks.tracks(points, 0, "left", walking_feet.CUTOFFS)
    lifted = replace(points, xyz=points.xyz + np.array([0, 0, 0.03]))
    again, higher = tracks.tracks(lifted, 0, "left", walking_feet.CUTOFFS)
    np.testing.assert_allclose(higher - floor, 0.03, atol=1e-9)
    np.testing.assert_allclose(again[0].height, found[0].height, atol=1e-9)
    stands = found[0].time_s < 0.4
    assert abs(found[0].height[stands]).max() < 0.012


def test_the_floor_of_a_foot_that_is_mostly_in_the_air_is_where_it_stands(points):
    xyz = points.xyz.copy()
    xyz[0, 18:, points.joints.tolist().index("left_heel"), 2] += 0.4
    xyz[0, 18:, points.joints.tolist().index("left_foot_index"), 2] += 0.4
    floors = [
        tracks.tracks(one, 0, "left", walking_feet.CUTOFFS)[1]
        for one in (points, replace(points, xyz=xyz))
    ]
    np.testing.assert_allclose(*floors, atol=0.02)


def test_velocities_are_those_of_the_path(points):
    (track,), _ = tracks.tracks(points, 0, "right", walking_feet.CUTOFFS)
    step_s = track.time_s[1] - track.time_s[0]
    slope = np.gradient(track.place, step_s, axis=0)
    np.testing.assert_allclose(slope[2:-2], track.velocity[2:-2], atol=0.3)
    assert step_s == pytest.approx(1 / 120)
    np.testing.assert_array_equal(track.time_s[:: track.step], points.time_s[track.frames])


def test_a_gap_parts_the_track_and_skeletons_without_heels_have_none(points):
    xyz = points.xyz.copy()
    xyz[0, 60:75, points.joints.tolist().index("left_heel")] = np.nan
    found, _ = tracks.tracks(replace(points, xyz=xyz), 0, "left", walking_feet.CUTOFFS)
    assert [one.frames for one in found] == [slice(0, 60), slice(75, 150)]
    named = [name.replace("heel", "sole") for name in points.joints.tolist()]
    found, floor = tracks.tracks(replace(points, joints=np.array(named)), 0, "left", [8.0] * 33)
    assert found == []
    assert np.isnan(floor).all()
