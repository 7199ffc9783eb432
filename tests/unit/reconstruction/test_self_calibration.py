"""Takes for the calibration from people: common times, sure joints, cameras that do not film."""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

sys.path.append(str(Path(__file__).parents[3] / "benchmarks"))  # last: both have a `scene`
import people_alone
from courtside.calibration import point_covariance
from courtside.calibration.bundle import conversion
from courtside.calibration.people import metric_scale
from courtside.calibration.people.from_nothing import Guess
from courtside.calibration.people.views import Limits
from courtside.geometry import camera as camera_models
from courtside.geometry import similarity, triangulation
from courtside.reconstruction import joint_correction, self_calibration
from courtside.reconstruction.association import rows
from courtside.records.devices.clocks import Clock
from courtside.records.keypoints import skeleton
from courtside.study.errors import InputError
from fixtures.cameras import corner_cameras
from fixtures.people import keypoints_made, remembered, tracks_made, view_offsets

CAMERAS = corner_cameras.four_cameras()[:3]
NAMES = [camera.name for camera in CAMERAS]
HEIGHTS = {"walk": {"p1": 1.6, "p2": 1.8}}
WALK = tracks_made.persons(40)
TIME_S = np.arange(40) / 10
JOINTS = ["nose", *skeleton.JOINTS]
LATE_S = 0.2
CLOCKS = {NAMES[0]: Clock(status="reference"), NAMES[1]: Clock(offset_s=LATE_S)}


@pytest.fixture(scope="module", autouse=True)
def _remembered():
    with remembered.relative():
        yield


def filmed():
    """Return a take of the first two cameras; of the first person a joint is unsure for a while."""
    xy = tracks_made.take(CAMERAS, WALK, noise_px=0).xy
    found = []
    for number, camera in enumerate(CAMERAS[:2]):
        score = np.full((2, 40, 13), 0.9)
        score[0, 10:20, 3] = 0.2
        own_s = TIME_S + LATE_S * number
        whole = np.pad(xy[number], ((0, 0), (0, 0), (1, 0), (0, 0)))
        found.append(keypoints_made.view(camera, JOINTS, own_s, whole, score=score))
    return "walk", found, CLOCKS


def test_tracks_are_at_common_times_without_unsure_joints():
    take = self_calibration.tracks(*filmed(), NAMES, is_cut=False)
    exact = tracks_made.take(CAMERAS, WALK, noise_px=0).xy
    unsure = np.isnan(take.xy[0][..., 0])
    assert unsure.sum() == 10
    assert unsure[0, 10:20, 2].all()
    for own, true in zip(take.xy[:2], exact[:2], strict=True):
        np.testing.assert_allclose(own[1], true[1], atol=1e-6)
    assert take.xy[2].shape == (0, 40, 12, 2)


def test_persons_are_seen_through_their_tracks():
    first = Guess(CAMERAS, [(0, ((0,), (1,), ())), (0, ((1,), (0,), ()))])
    seen = self_calibration.seen(first, [filmed()], is_cut=False)
    assert seen.xy.shape == (3, 80, 13, 2)
    assert np.bincount(seen.track).tolist() == [40, 40]
    assert np.isnan(seen.xy[2]).all()
    exact = tracks_made.take(CAMERAS, WALK, noise_px=0).xy
    np.testing.assert_allclose(seen.xy[0, 40:, 1:], exact[0][1], atol=1e-6)
    np.testing.assert_allclose(seen.xy[1, :40, 1:], exact[1][1], atol=1e-6)
    depth_m = np.linalg.norm(CAMERAS[0].centre_in_world - WALK[0, 5, 0])
    assert 0.7 < seen.height_px[0, 5] / (1.7 * 1400 / depth_m) < 1.4


def test_cameras_are_guessed_from_a_take():
    take = "walk", views_of(WALK), dict.fromkeys(NAMES, Clock())
    lenses = {camera.name: camera for camera in CAMERAS}
    found, is_cut = self_calibration.guess(NAMES, lenses, [take], HEIGHTS)
    assert not is_cut
    assert [camera.name for camera in found.cameras] == NAMES
    assert len(found.tracks) == 2
    with pytest.raises(InputError, match="camera c2: expected a take with its video, found none"):
        self_calibration.guess(NAMES, lenses, [filmed()], HEIGHTS)


def views_of(xyz):
    """Return the keypoints of joints (P, T, 12, 3) by each camera."""
    each = zip(CAMERAS, tracks_made.take(CAMERAS, xyz).xy, strict=True)
    return [keypoints_made.view(camera, skeleton.JOINTS, TIME_S, own) for camera, own in each]


@pytest.fixture
def calibrated():
    """Return a function: calibrate by one take, its clocks from one time to the next."""
    views = views_of(WALK)
    lenses, limits = {one.name: one for one in CAMERAS}, Limits(score=0.05, limit=0.05, fade=0.067)

    def calibrate(*clocks, heights_m=(1.6, 1.8), known=()):
        """Clocks are those of camera c1: without cameras, by those guessed, and so on."""
        each = iter(clocks)
        return self_calibration.calibrate(
            NAMES,
            lenses,
            lambda _: [("walk", views, dict.fromkeys(NAMES, Clock()) | {"c1": next(each)})],
            {"walk": dict(zip(("p1", "p2"), heights_m, strict=True))},
            limits,
            known,
        )

    return calibrate


def test_a_known_length_stands_for_heights(calibrated):
    ends = np.array([[-1.0, 1.0, 0.0], [1.0, 1.0, 0.0]])
    xy = np.stack([camera_models.project(camera, ends) for camera in CAMERAS])
    known = metric_scale.KnownLength("line", 2.0, xy, click_sigma_px=1.0, on_floor=True)
    found = calibrated(*[Clock()] * 3, heights_m=(None, None), known=[known])
    placed = triangulation.triangulate_all(found.cameras, xy)
    assert np.linalg.norm(placed[1] - placed[0]) == pytest.approx(2.0, rel=1e-3)
    assert placed[:, 2].mean() == pytest.approx(0, abs=1e-6)
    assert found.scale.by == "line"


def test_another_unit_is_that_of_a_calibration_with_this_length(calibrated):
    """It gives the cameras, and the errors of points, of the calibration by the length."""
    ends = np.array([[-1.0, 1.0, 0.0], [1.0, 1.0, 0.0]])
    xy = np.stack([camera_models.project(camera, ends) for camera in CAMERAS])
    known = metric_scale.KnownLength("line", 2.0, xy, click_sigma_px=1.0)
    wanted = calibrated(*[Clock()] * 3, heights_m=(None, None), known=[known])
    tall = calibrated(*[Clock()] * 3, heights_m=(1.76, 1.98))
    (own,), _ = metric_scale.by_lengths(tall.cameras, [known])
    assert abs(own.metres - 1) > 0.05
    found = people_alone.rescaled(tall, replace(wanted.scale, metres=own.metres))
    for one, other in zip(found.cameras, wanted.cameras, strict=True):
        np.testing.assert_allclose(one.centre_in_world, other.centre_in_world, atol=0.02)
    spread = [
        point_covariance.point_covariance(
            conversion.network_of(one.cameras), one.covariance.of_columns(), one.places[::20]
        )
        for one in (found, wanted)
    ]
    sigma = np.sqrt(np.trace(np.stack(spread), axis1=2, axis2=3))
    np.testing.assert_allclose(sigma[0], sigma[1], rtol=0.1)


def lowered(xyz):
    """Return joints whose shoulders are too low, and the table of offsets that puts them right."""
    names, share = list(skeleton.JOINTS), 0.1
    place = {
        part: xyz[:, :, [names.index(f"{side}_{part}") for side in ("left", "right")]]
        for part in ("shoulder", "hip")
    }
    trunk = place["shoulder"].mean(axis=2) - place["hip"].mean(axis=2)
    seen = xyz.copy()
    for side in ("left", "right"):
        seen[:, :, names.index(f"{side}_shoulder")] -= share * trunk
    shares = dict.fromkeys(skeleton.LIMBS, 0.0)
    shares["shoulder"] = -share / (1 - share)  # of the trunk as seen
    rows = [(joint, "up", own, 0.01, 100) for joint, own in shares.items()]
    return seen, pd.DataFrame(rows, columns=joint_correction.COLUMNS)


def test_heights_give_metres_by_bodies_without_the_offsets_of_a_network():
    """The shoulders as seen would make the scale too large by 3 %, beside another share."""
    seen, table = lowered(WALK)
    of_height = {
        share: {"walk": {f"p{at}": metric_scale.length(xyz) / share.mean for at, xyz in each}}
        for share in (metric_scale.SEEN, metric_scale.CORRECTED)
        for each in [list(enumerate(WALK))]
    }
    lenses, limits = {one.name: one for one in CAMERAS}, Limits(score=0.05, limit=0.05, fade=0.067)

    def metres(share, offsets):
        found = self_calibration.calibrate(
            NAMES,
            lenses,
            lambda _: [("walk", views_of(seen), dict.fromkeys(NAMES, Clock()))],
            of_height[share],
            limits,
            offsets=offsets,
        )
        centres = [
            np.stack([camera.centre_in_world for camera in cameras])
            for cameras in (found.cameras, CAMERAS)
        ]
        return 1 / similarity.umeyama(*centres).scale

    assert metres(metric_scale.CORRECTED, table) == pytest.approx(1, abs=0.005)
    assert metres(metric_scale.SEEN, None) > 1.025


def test_offsets_that_differ_between_cameras_do_not_bend_them():
    """Joints off by some centimetres, by each camera in its own way, and their table."""
    views = views_of(WALK)
    for view, (first, second) in zip(views, view_offsets.seen(CAMERAS, WALK), strict=True):
        view.xy[:] = [second, first] if view.camera == "c1" else [first, second]
    lenses, limits = {one.name: one for one in CAMERAS}, Limits(score=0.05, limit=0.05, fade=0.067)
    xyz = WALK[:, ::4].reshape(-1, 3)
    exact, off_m = np.stack([camera_models.project(camera, xyz) for camera in CAMERAS]), []
    for offsets in (None, view_offsets.table()):
        found = self_calibration.calibrate(
            NAMES,
            lenses,
            lambda _: [("walk", views, dict.fromkeys(NAMES, Clock()))],
            HEIGHTS,
            limits,
            offsets=offsets,
        )
        placed = triangulation.triangulate_all(found.cameras, exact)
        shape = similarity.umeyama(placed, xyz).points(placed) - xyz
        off_m.append(np.median(np.linalg.norm(shape, axis=1)))
    assert off_m[0] > 0.004
    assert off_m[1] < 0.25 * off_m[0]


def test_people_whom_a_tracker_exchanges_calibrate_cameras_as_well_as_others():
    """They walk side by side; one camera loses both for half a second, and exchanges them."""
    xyz = tracks_made.persons(120) + np.array([[[[-2.0, 0, 0]]], [[[2.0, 0, 0]]]])
    time_s, xy = np.arange(120) / 10, tracks_made.take(CAMERAS, xyz, noise_px=0.5).xy
    xy[2][:, 60:] = xy[2][::-1, 60:]
    xy[2][:, 60:65] = np.nan
    each = zip(CAMERAS, xy, strict=True)
    nobody = np.full((1, 120, 12, 2), np.nan)  # rows without a piece hide no cut
    views = [
        keypoints_made.view(camera, skeleton.JOINTS, time_s, np.concatenate([own, *[nobody] * 4]))
        for camera, own in each
    ]
    assert len(rows.separate(views[2])) >= 4
    take, lenses = ("walk", views, dict.fromkeys(NAMES, Clock())), {c.name: c for c in CAMERAS}
    _, is_cut = self_calibration.guess(NAMES, lenses, [take], HEIGHTS)
    assert is_cut
    found = self_calibration.calibrate(
        NAMES, lenses, lambda _: [take], HEIGHTS, Limits(score=0.05, limit=0.05, fade=0.067)
    )
    points = xyz[:, ::6].reshape(-1, 3)
    exact = np.stack([camera_models.project(camera, points) for camera in CAMERAS])
    placed = triangulation.triangulate_all(found.cameras, exact)
    off = similarity.umeyama(placed, points).points(placed) - points
    assert np.median(np.linalg.norm(off, axis=1)) < 0.003
    assert found.score.accepted_percent().min() > 99


def test_clocks_that_are_not_sure_are_refused(calibrated):
    with pytest.raises(InputError, match="take walk: camera c1: expected a clock that the rec"):
        calibrated(Clock(), Clock(status="ambiguous"))


def test_cameras_are_adjusted_again_if_they_change_clocks(calibrated):
    late, right = Clock(0.05), Clock(0.0004)
    once = calibrated(late, right, right)
    twice = calibrated(late, late, right)
    assert min(twice.score.accepted_percent()) > 95
    assert twice.score.typical() == pytest.approx(once.score.typical(), rel=0.1)
    assert once.score.typical() < 0.8 * calibrated(late, late, late).score.typical()


def test_a_camera_that_filmed_in_two_sizes_is_named_with_the_take():
    walk, views, clocks = filmed()
    half = replace(views[1], size=np.array([960, 540]))
    takes = [(walk, views, clocks), ("later", [views[0], half], clocks)]
    message = r"take later: camera c1: expected pictures of .* as in .* found 960 x 540 px; name"
    with pytest.raises(InputError, match=message):
        self_calibration.guess(NAMES, {}, takes, HEIGHTS)
