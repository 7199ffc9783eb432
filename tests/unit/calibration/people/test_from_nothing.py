"""Cameras from made people: the true ones after one rigid motion; bad input is one line."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.calibration import point_covariance
from courtside.calibration.bundle import conversion
from courtside.calibration.people import from_nothing, metric_scale
from courtside.calibration.people.held_out import Score
from courtside.calibration.people.views import Limits, Seen, joined
from courtside.geometry import camera as cameras
from courtside.geometry import similarity
from courtside.geometry.triangulation import triangulate_all
from courtside.study.errors import InputError
from fixtures.cameras import corner_cameras
from fixtures.people import remembered, tracks_made

TRUE = corner_cameras.four_cameras()[:3]
NAMES, SIZES = [one.name for one in TRUE], {one.name: one.size for one in TRUE}
LIMITS = Limits(score=0.05, limit=0.05, fade=0.067)
WALK = tracks_made.persons(40)
LENSES = {camera.name: camera for camera in TRUE}
HEIGHTS = {
    "walk": {
        f"p{at}": metric_scale.length(xyz) / metric_scale.SEEN.mean for at, xyz in enumerate(WALK)
    }
}


@pytest.fixture(scope="module", autouse=True)
def _remembered():
    with remembered.relative():
        yield


def guessed(take, heights=HEIGHTS, lenses=None):
    return from_nothing.guess(NAMES, SIZES, lenses or {}, [take], heights)


def seen(take, tracks):
    """Return the tracks as the adjustment sees them; pictures of persons are 400 px high."""
    xy = [from_nothing.track_xy([take], track) for track in tracks]
    number = np.repeat(np.arange(len(xy)), xy[0].shape[1])
    xy = np.concatenate(xy, axis=1)
    score = np.where(np.isfinite(xy[..., 0]), 0.9, np.nan)
    return Seen(xy, score, np.full(score.shape[:2], 400.0), number, np.arange(len(number)) / 10)


def test_cameras_with_unknown_lenses_are_found_from_two_persons_and_their_heights():
    take = tracks_made.take(TRUE, WALK)
    start = guessed(take)
    people = seen(take, start.tracks), lambda _, limbs: limbs
    found = from_nothing.adjust(start.cameras, {}, *people, start.tracks, HEIGHTS, LIMITS)
    xyz = WALK[:, ::4].reshape(-1, 3)
    placed = triangulate_all(found.cameras, np.stack([cameras.project(c, xyz) for c in TRUE]))
    assert similarity.umeyama(placed, xyz).scale == pytest.approx(1, abs=0.01)
    rigid = similarity.rigid(placed, xyz)
    off = rigid.points(placed) - xyz
    assert np.median(np.linalg.norm(off, axis=1)) < 0.02
    spread = point_covariance.point_covariance(
        conversion.network_of(found.cameras), found.covariance.of_columns(), placed
    )
    spread = rigid.rotation @ spread @ rigid.rotation.T
    square = np.einsum("ni,nij,nj->n", off, np.linalg.inv(spread), off)
    assert 0.2 < square.mean() < 9  # 3 over many draws; all joints here err together
    assert np.abs(placed[:, 2] - xyz[:, 2]).max() < 0.06
    summary = from_nothing.summary(found, ["walk"])
    assert min(summary["accepted_percent"].values()) > 95
    assert summary["line"].startswith("people alone: views of held-out joints disagree by ")
    (remark,) = found.remarks
    assert remark.startswith(f"lenses of {', '.join(NAMES)} are estimated from people; this ")
    told = replace(found, remarks=[metric_scale.ONE_HEIGHT], warnings=["floor: it differs"])
    summary = from_nothing.summary(told, ["walk"])
    assert (summary["remarks"], summary["warnings"]) == (
        [metric_scale.ONE_HEIGHT],
        ["floor: it differs"],
    )


def test_every_track_of_many_takes_has_enough_frames_to_be_measured():
    """30 tracks share what the adjustment takes: 16 frames each, fewer than a body needs."""
    take = tracks_made.take(TRUE, WALK)
    start = guessed(take, lenses=LENSES)
    everything, n_takes = seen(take, start.tracks), 15
    every = joined([everything] * n_takes), lambda _, limbs: limbs
    tracks = [(number, rows) for number in range(n_takes) for _, rows in start.tracks]
    heights = {f"walk {number}": HEIGHTS["walk"] for number in range(n_takes)}
    found = from_nothing.adjust(start.cameras, LENSES, *every, tracks, heights, LIMITS)
    xyz = WALK[:, ::4].reshape(-1, 3)
    placed = triangulate_all(found.cameras, np.stack([cameras.project(c, xyz) for c in TRUE]))
    assert similarity.umeyama(placed, xyz).scale == pytest.approx(1, abs=0.01)


def test_a_short_take_of_known_heights_beside_long_ones_gives_the_scale():
    """By its share of the time it has 8 frames of each person, fewer than a body needs."""
    short = tracks_made.take(TRUE, WALK)
    tracks = guessed(short, lenses=LENSES).tracks
    long, n_long = tracks_made.take(TRUE, tracks_made.persons(400), seed=1), 3
    every = joined([seen(short, tracks), *[seen(long, tracks)] * n_long]), lambda _, limbs: limbs
    rows = [(number, rows) for number in range(1 + n_long) for _, rows in tracks]
    heights = HEIGHTS | {f"match {at}": {"p0": None, "p1": None} for at in range(n_long)}
    found = from_nothing.adjust(TRUE, LENSES, *every, rows, heights, LIMITS)
    xyz = WALK[:, ::4].reshape(-1, 3)
    placed = triangulate_all(found.cameras, np.stack([cameras.project(c, xyz) for c in TRUE]))
    assert similarity.umeyama(placed, xyz).scale == pytest.approx(1, abs=0.01)


def test_a_lens_of_a_board_is_not_guessed():
    take = tracks_made.take(TRUE, WALK)
    start = guessed(take, lenses=LENSES)
    assert [camera.K[0, 0] for camera in start.cameras] == [1400.0] * 3


def test_a_person_whom_one_camera_does_not_see_is_not_given_up():
    take = tracks_made.take(TRUE, WALK)
    take.xy[2][0] = np.nan
    start = guessed(take, lenses=LENSES)
    assert sorted(start.tracks) == [(0, ((0,), (1,), ())), (0, ((1,), (0,), (1,)))]


def test_a_person_who_stands_still_tells_nothing():
    take = tracks_made.take(TRUE, tracks_made.persons(still=True)[:1])
    with pytest.raises(InputError, match="expected a person who moves by"):
        guessed(take, {"walk": {"p1": 1.7}})


def test_cameras_that_agree_on_no_joint_are_told():
    with pytest.raises(InputError, match="expected joints on whose places two cameras agree"):
        from_nothing._places(np.full((5, 12, 3), np.nan))


def test_without_a_height_there_is_no_unit():
    with pytest.raises(InputError, match="found take walk without the height of p2; state"):
        guessed(tracks_made.take(TRUE, WALK), {"walk": {"p1": 1.7, "p2": None}}, LENSES)


def test_a_camera_that_contradicts_the_others_is_named():
    accepted = np.array([[1.0, 1, 1, np.nan], [1, 1, 0, 1], [0, 0, 1, np.nan]])
    with pytest.raises(InputError, match=r"camera c2: expected 50 % or more of its views .* 33 %"):
        from_nothing.check(TRUE, Score(accepted=[accepted]))
    from_nothing.check(TRUE[:2], Score(accepted=[accepted[:2]]))
