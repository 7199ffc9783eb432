"""Alignment of a reconstruction with the court: exact truth, the paper's frame, wrong courts."""

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.calibration.court import court, sfm_alignment
from courtside.calibration.planning import cameras as planned
from courtside.geometry import camera as cameras
from courtside.geometry import similarity
from courtside.study.errors import InputError
from fixtures.cameras.scene import look_at, opencv_projection

FOLDER = Path(__file__).parents[4] / "config" / "courts"
COURT = court.read(FOLDER / "badminton.yaml")
SFM_FROM_WORLD = similarity.Sim3(
    0.31, Rotation.from_rotvec([1.0, 0.4, -0.7]).as_matrix(), np.array([0.2, -3, 5])
)
IN_SFM = SFM_FROM_WORLD.points(COURT.xyz)


def fixed_cameras():
    matrix = np.array([[1120.0, 0, 639.5], [0, 1120, 359.5], [0, 0, 1]])
    places = {"side": (-18, 6.7, 1.9), "back": (3.05, -14.3, 2.1)}
    return [
        cameras.Camera(
            name, (1280, 720), matrix, [-0.05, 0.01, 0, 0, 0], look_at(at, (3.05, 6.7, 1))
        )
        for name, at in places.items()
    ]


def clicks_of(fixed):
    return {camera.name: opencv_projection(camera, COURT.xyz) for camera in fixed}


def noisy(xyz, sigma, seed=0):
    return xyz + sigma * np.random.default_rng(seed).normal(size=xyz.shape)


def assert_inverse(world_from_sfm, tolerance=1e-9):
    np.testing.assert_allclose(world_from_sfm.points(IN_SFM), COURT.xyz, atol=tolerance)


def test_clicks_are_reconstructed_in_the_cameras_frame():
    fixed = fixed_cameras()
    clicks = clicks_of(fixed)
    clicks["side"][4] = np.nan
    in_sfm = [SFM_FROM_WORLD.camera(camera) for camera in fixed]
    xyz = sfm_alignment.reconstruct(in_sfm, clicks)
    assert np.flatnonzero(np.isnan(xyz).any(axis=1)).tolist() == [4]
    known = np.isfinite(xyz).all(axis=1)
    np.testing.assert_allclose(xyz[known], IN_SFM[known], atol=1e-7)
    world_from_sfm, accepted = sfm_alignment.align(COURT, xyz)
    assert_inverse(world_from_sfm, 1e-6)
    assert accepted.sum() == 17
    for camera, known in zip(in_sfm, fixed, strict=True):
        centre = world_from_sfm.camera(camera).centre_in_world
        np.testing.assert_allclose(centre, known.centre_in_world, atol=1e-6)


def test_points_above_the_floor_lie_in_the_cameras_frame_too():
    xyz = COURT.xyz + np.linspace(0, 3, len(COURT.xyz))[:, None] * [0, 0, 1]
    seen = {camera.name: opencv_projection(camera, xyz) for camera in fixed_cameras()}
    in_sfm = [SFM_FROM_WORLD.camera(camera) for camera in fixed_cameras()]
    found = sfm_alignment.reconstruct(in_sfm, seen)
    np.testing.assert_allclose(found, SFM_FROM_WORLD.points(xyz), atol=1e-7)


def test_clicks_in_a_camera_that_is_not_there_take_no_part():
    fixed = fixed_cameras()
    clicks = clicks_of(fixed)
    found = sfm_alignment.reconstruct(fixed, clicks | {"third": clicks["back"] + 50})
    np.testing.assert_allclose(found, COURT.xyz, atol=1e-7)


def test_the_papers_frame_of_exact_points_is_the_world():
    frame, skew_deg = sfm_alignment.paper_frame(COURT, IN_SFM)
    assert_inverse(frame)
    assert skew_deg == pytest.approx(0, abs=1e-9)


def test_the_papers_frame_shares_the_skew_of_the_sides_between_them():
    x_in_sfm = IN_SFM.copy()
    at = COURT.indices("three")
    angle = np.radians(2.0)  # the end of x, turned about the origin within the floor
    x_in_sfm[at[1]] = SFM_FROM_WORLD.points(6.1 * np.array([np.cos(angle), np.sin(angle), 0]))
    frame, skew_deg = sfm_alignment.paper_frame(COURT, x_in_sfm)
    assert skew_deg == pytest.approx(2.0)
    placed = frame.points(x_in_sfm[at])
    turned = [
        np.degrees(np.arctan2(placed[1, 1], placed[1, 0])),
        np.degrees(np.arctan2(placed[2, 0], placed[2, 1])),
    ]
    np.testing.assert_allclose(turned, [1, 1], atol=1e-6)
    np.testing.assert_allclose(frame.rotation @ frame.rotation.T, np.eye(3), atol=1e-12)


def test_the_papers_scale_is_that_of_both_sides_together():
    x_in_sfm = IN_SFM.copy()
    at = COURT.indices("three")
    x_in_sfm[at[1]] = SFM_FROM_WORLD.points(np.array([6.2, 0, 0]))
    frame, _ = sfm_alignment.paper_frame(COURT, x_in_sfm)
    lengths = np.linalg.norm(frame.points(x_in_sfm[at[1:]]) - frame.points(x_in_sfm[at[0]]), axis=1)
    assert lengths.sum() == pytest.approx(19.5)
    assert lengths[0] / lengths[1] == pytest.approx(6.2 / 13.4)


def test_the_papers_frame_begins_where_the_court_has_its_first_point():
    """The first corner of the basketball court is 5 cm inside of the court's frame."""
    basketball = court.read(FOLDER / "basketball.yaml")
    x_in_sfm = SFM_FROM_WORLD.points(basketball.xyz)
    frame, _ = sfm_alignment.paper_frame(basketball, x_in_sfm)
    assert np.abs(basketball.xyz[basketball.indices("three")][0]).max() > 0.01
    np.testing.assert_allclose(frame.points(x_in_sfm), basketball.xyz, atol=1e-9)


@pytest.mark.parametrize("seed", [0, 33, 37, 38, 57])
def test_one_point_beside_a_line_of_others_aligns_them_or_is_missed(seed):
    """A side line and a post, clicked 3 px off by two cameras behind the line's end."""
    use = np.isin(COURT.points, ["p01", "p04", "p10", "p06", "p03", "p17"])
    fixed = [
        planned.camera(name, at, (1, 8, 0), (1920, 1080), fov_deg=65)
        for name, at in (("left", (-3, -4, 3)), ("right", (8, -4, 3)))
    ]
    rng = np.random.default_rng(seed)
    clicks = {camera.name: opencv_projection(camera, COURT.xyz) for camera in fixed}
    for name, xy in clicks.items():
        clicks[name] = np.where(use[:, None], xy + 3 * rng.normal(size=xy.shape), np.nan)
    xyz = sfm_alignment.reconstruct(fixed, clicks)
    try:
        found, accepted = sfm_alignment.align(COURT, xyz)
    except InputError as error:
        assert "found 6 of which those that agree are on one line" in str(error)
        return
    assert not similarity.is_collinear(COURT.xyz[accepted])
    assert np.nanmedian(np.linalg.norm(found.points(xyz) - COURT.xyz, axis=1)) < 0.5


def test_the_papers_frame_needs_its_three_points():
    x_in_sfm = IN_SFM.copy()
    x_in_sfm[COURT.indices(["p02"])] = np.nan
    with pytest.raises(InputError, match=r"expected p01, p02, p03 .* no place for p02"):
        sfm_alignment.paper_frame(COURT, x_in_sfm)


def test_a_good_court_passes_without_a_word():
    for seed in range(10):
        xyz = noisy(IN_SFM, 0.31 * 0.01, seed)
        in_sfm = [SFM_FROM_WORLD.camera(camera) for camera in fixed_cameras()]
        assert sfm_alignment.check(COURT, xyz, in_sfm) == []


@pytest.mark.parametrize(
    ("known", "words"),
    [
        ([at for at in range(18) if COURT.xyz[at, 2] == 0], ["all lie on the floor", "net posts"]),
        (COURT.indices(["p01", "p02", "p17"]), ["3 are seen", "click six or more"]),
        (COURT.indices(["p01", "p02", "p03", "p04", "p17"]), ["5 are seen", "click six or more"]),
    ],
    ids=["floor", "three", "five"],
)
def test_weak_points_are_said(known, words):
    xyz = np.full_like(IN_SFM, np.nan)
    xyz[known] = IN_SFM[known]
    (warning,) = sfm_alignment.check(COURT, xyz)
    assert "\n" not in warning
    assert [word for word in words if word not in warning] == []


def exchanged():
    """Left and right points exchanged: the court mirrored, with the net posts still upright."""
    mirrored = COURT.xyz.copy()
    mirrored[:, 0] = 6.1 - mirrored[:, 0]
    return SFM_FROM_WORLD.points(mirrored)


def shuffled():
    return IN_SFM[np.random.default_rng(0).permutation(18)]


def on_one_line():
    xyz = np.full_like(IN_SFM, np.nan)
    at = COURT.indices(["p01", "p04", "p10", "p06", "p03"])
    xyz[at] = IN_SFM[at]
    return xyz


def singles_court():
    return SFM_FROM_WORLD.points(noisy(COURT.xyz * [5.18 / 6.1, 1, 1], 0.005))


@pytest.mark.parametrize(
    ("xyz", "words"),
    [
        (exchanged(), ["right-handed", "exchange the names"]),
        (on_one_line(), ["on one line"]),
        (singles_court(), ["6.1 m by 13.4 m", "5.18 m by 13.4 m", "right court file"]),
    ],
    ids=["mirrored", "line", "singles"],
)
def test_an_impossible_court_is_refused_in_one_line(xyz, words):
    with pytest.raises(InputError) as caught:
        sfm_alignment.check(COURT, xyz)
    message = str(caught.value)
    assert "\n" not in message and message.startswith("court points: expected")
    assert [word for word in words if word not in message] == []


def test_points_under_each_others_names_are_refused():
    with pytest.raises(InputError, match="court points: expected"):
        sfm_alignment.check(COURT, shuffled())


def test_another_court_with_points_of_the_same_names_is_refused():
    tennis = court.read(FOLDER / "tennis.yaml")
    with pytest.raises(InputError, match="court points: expected"):
        sfm_alignment.check(tennis, IN_SFM)
    assert sfm_alignment.check(tennis, SFM_FROM_WORLD.points(tennis.xyz)) == []


def test_a_mirrored_floor_puts_the_cameras_below_it():
    floor = COURT.xyz[:, 2] == 0
    xyz = exchanged()
    xyz[~floor] = np.nan
    in_sfm = [SFM_FROM_WORLD.camera(camera) for camera in fixed_cameras()]
    with pytest.raises(
        InputError, match=r"above the floor, found side, back below it: the points are mirrored"
    ):
        sfm_alignment.check(COURT, xyz, in_sfm)


def test_the_stretch_is_the_ratio_of_the_sides_and_its_sigma_is_honest():
    found = [
        sfm_alignment.stretch(
            COURT, SFM_FROM_WORLD.points(noisy(COURT.xyz * [1.02, 1, 1], 0.005, seed))
        )
        for seed in range(200)
    ]
    ratio, sigma = np.array(found).T
    assert np.median(ratio) == pytest.approx(1.02, abs=3e-4)
    assert 0.7 < np.std(np.log(ratio)) / np.median(sigma) < 1.5
    assert sfm_alignment.stretch(COURT, np.full_like(IN_SFM, np.nan))[1] == np.inf


def test_the_stretch_by_bent_cameras_is_in_its_sigma():
    """A common error stretches all points alike: their scatter cannot show it."""
    rng, exact = np.random.default_rng(3), noisy(COURT.xyz, 0.003)
    along_x = np.stack([0.01 * COURT.xyz * axis for axis in np.eye(3)], axis=-1)  # 1 % each
    found = []
    for _ in range(200):
        bent = exact + along_x @ rng.normal(size=3)
        found.append(sfm_alignment.stretch(COURT, bent, along_x))
    ratio, sigma = np.array(found).T
    assert 0.85 < np.std(np.log(ratio)) / np.median(sigma) < 1.15
    assert np.median(sigma) == pytest.approx(0.01 * np.sqrt(2), rel=0.05)
    without = [sfm_alignment.stretch(COURT, exact)[1]]
    assert np.median(without) < 0.002


def test_sides_are_judged_by_the_stated_errors_of_the_cameras():
    stretched, in_sfm = COURT.xyz * [1.013, 1, 1], fixed_cameras()
    causes = 0.004 * COURT.xyz[..., None] * np.eye(3)[0][:, None]
    assert sfm_alignment.check(COURT, stretched, in_sfm, causes) == []
    for wrong in (stretched, COURT.xyz * [1.05, 1, 1]):
        with pytest.raises(InputError, match="expected the sides of badminton"):
            sfm_alignment.check(COURT, wrong, in_sfm, 0 * causes if wrong is stretched else causes)
