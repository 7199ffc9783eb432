"""Calibration from known points by name: points, method, and the true camera."""

from pathlib import Path

import numpy as np
import pytest

from courtside.calibration.court import court, known_points, resection
from courtside.geometry import camera as camera_models
from courtside.study.errors import InputError
from fixtures.cameras.scene import look_at, opencv_projection
from virtualgym.session import clicks as clicking

COURT = court.read(Path(__file__).parents[4] / "config" / "courts" / "badminton.yaml")
SIZE = (1280, 720)
MATRIX = np.array([[1120.0, 0, 639.5], [0, 1120, 359.5], [0, 0, 1]])
K1 = -0.04


def fixed(dist=(K1, 0, 0, 0, 0)):
    # Not in the net's plane, where a linear calibration is degenerate.
    places = {"corner": (-11, -8, 5.0), "back": (3.05, -14.3, 2.1)}
    return [
        camera_models.Camera(name, SIZE, MATRIX, dist, look_at(at, (3.05, 6.7, 1)))
        for name, at in places.items()
    ]


def clicks_of(made):
    return {camera.name: opencv_projection(camera, COURT.xyz) for camera in made}


def calibrate(name, made, clicks=None, lenses=None):
    way = known_points.method(name, COURT)
    sizes = {camera.name: camera.size for camera in made}
    clicks = clicks or clicks_of(made)
    return known_points.calibrate(way, COURT, clicks, sizes, lenses or {}, click_sigma_px=0.9)


@pytest.mark.parametrize(
    ("name", "linear", "board", "points"),
    [
        ("known18", False, False, COURT.points),
        ("known8", False, False, ("p01", "p02", "p03", "p10", "p11", "p16", "p17", "p18")),
        ("known8-board", False, True, ("p01", "p02", "p03", "p10", "p11", "p16", "p17", "p18")),
        ("dlt18", True, False, COURT.points),
    ],
)
def test_a_name_says_method_and_points(name, linear, board, points):
    found = known_points.method(name, COURT)
    assert (found.linear, found.board) == (linear, board)
    assert {COURT.points[at] for at in found.points} == set(points)


def test_a_number_that_no_set_has_is_a_fault_in_one_line():
    with pytest.raises(
        InputError, match="calibration known7: expected a set of 7 points"
    ) as caught:
        known_points.method("known7", COURT)
    assert "'eight': 8" in str(caught.value) and "\n" not in str(caught.value)


@pytest.mark.parametrize("name", ["known18", "known8"])
def test_exact_clicks_give_the_camera_and_its_lens(name):
    made = fixed()
    found = known_points.cameras(calibrate(name, made))
    assert [camera.name for camera in found] == ["corner", "back"]
    for camera, known in zip(found, made, strict=True):
        np.testing.assert_allclose(camera.centre_in_world, known.centre_in_world, atol=1e-3)
        assert camera.K[1, 1] == pytest.approx(1120, abs=0.1)
        assert camera.dist[0] == pytest.approx(K1, abs=1e-4)


def test_a_lens_from_a_board_is_kept_as_it_is():
    made = fixed((K1, 0.01, 1e-3, -1e-3, 0))
    lenses = {c.name: c for c in made}
    found = known_points.cameras(calibrate("known8-board", made, lenses=lenses))
    for camera, known in zip(found, made, strict=True):
        np.testing.assert_array_equal(camera.K, known.K)
        np.testing.assert_array_equal(camera.dist, known.dist)
        np.testing.assert_allclose(camera.centre_in_world, known.centre_in_world, atol=1e-5)


def test_a_linear_calibration_of_a_pinhole_gives_its_projection():
    made = fixed(np.zeros(5))
    found = calibrate("dlt18", made)
    xyz = np.column_stack([np.random.default_rng(0).uniform(0, 6, (20, 2)), np.linspace(0, 3, 20)])
    for camera in made:
        seen = np.column_stack([xyz, np.ones(20)]) @ found[camera.name].matrix.T
        np.testing.assert_allclose(
            seen[:, :2] / seen[:, 2:], opencv_projection(camera, xyz), atol=1e-4
        )
    assert [c.name for c in known_points.cameras(found)] == ["corner", "back"]


def test_points_that_are_not_in_the_set_do_not_count():
    made = fixed()
    clicks = clicks_of(made)
    outside = np.setdiff1d(np.arange(18), COURT.indices("eight"))
    for xy in clicks.values():
        xy[outside] += 300
    found = known_points.cameras(calibrate("known8", made, clicks))
    np.testing.assert_allclose(found[1].centre_in_world, made[1].centre_in_world, atol=1e-3)


@pytest.mark.parametrize(
    ("reason", "start"),
    [
        (
            "camera back: the points lie in one plane; click more",
            "camera back: the points lie in one plane",
        ),
        (
            "",
            "camera back: expected a valid camera from DLT, found none; click",
        ),
    ],
)
def test_a_matrix_that_is_no_camera_is_named_in_one_line(reason, start):
    none = resection.Linear(np.eye(3, 4), None, 1.0, 10.0, reason)
    with pytest.raises(InputError) as caught:
        known_points.cameras({"back": none})
    message = str(caught.value)
    assert message.startswith(start) and "\n" not in message and ". ;" not in message
    assert message.count("camera back") == 1


def test_clicks_of_another_court_are_said_with_how_far_they_are_off():
    tennis = court.read(Path(__file__).parents[4] / "config" / "courts" / "tennis.yaml")
    made = fixed()
    way = known_points.method("known18", tennis)
    with pytest.raises(InputError) as caught:
        known_points.calibrate(way, tennis, clicks_of(made), {"back": SIZE}, {}, click_sigma_px=0.9)
    message = str(caught.value)
    assert message.startswith("camera back: expected 8 clicks or more that fit one camera, found")
    assert (
        "check the names of the points, their places (the court)" in message and "\n" not in message
    )


def test_mirrored_points_are_named_or_put_the_camera_below_the_floor():
    """Where no camera fits the mirrored points, the message says so; else the height tells."""
    mirror = COURT.xyz * [-1, 1, 1] + [6.1, 0, 0]
    other = [np.linalg.norm(COURT.xyz - place, axis=1).argmin() for place in mirror]
    size = (480, 270)
    pose = look_at((-17.95, 6.7, 1.9), (3.05, 6.7, 1.0))
    camera = camera_models.Camera(
        "side", size, [[421, 0, 240], [0, 421, 135], [0, 0, 1]], [0] * 5, pose
    )
    drawn = {"n_draws": 60, "seed": 1, "preset": "plain", "session": "mirrored"}
    way, n_named = known_points.method("known18", COURT), 0
    for marked in clicking.clicks_of_persons([camera], COURT, COURT.xyz, **drawn):
        clicks = {"side": marked["side"][other]}
        try:
            found = known_points.calibrate(
                way, COURT, clicks, {"side": size}, {}, click_sigma_px=1.75
            )
        except InputError as error:
            assert "camera side: " in str(error)
            assert "the points are mirrored; exchange the names of the left" in str(error)
            n_named += 1
        else:
            assert found["side"].camera.centre_in_world[2] < 0
    assert n_named > 0


@pytest.mark.parametrize(("place", "f_px"), [((-17.7, 6.7, 1.9), 414), ((3.0, -14.9, 2.2), 435)])
def test_mirrored_points_are_named_where_the_best_fit_is_at_infinity(place, f_px):
    mirror = COURT.xyz * [-1, 1, 1] + [6.1, 0, 0]
    other = [np.linalg.norm(COURT.xyz - at, axis=1).argmin() for at in mirror]
    size, matrix = (480, 270), [[f_px, 0, 239.5], [0, f_px, 134.5], [0, 0, 1]]
    camera = camera_models.Camera("one", size, matrix, [0] * 5, look_at(place, (3.05, 6.7, 1.0)))
    drawn = {"n_draws": 20, "seed": 2, "preset": "plain", "session": "mirrored"}
    way = known_points.method("known18", COURT)
    for marked in clicking.clicks_of_persons([camera], COURT, COURT.xyz, **drawn):
        for clicks, message in (marked["one"], ""), (marked["one"][other], "points are mirrored"):
            try:
                known_points.calibrate(
                    way, COURT, {"one": clicks}, {"one": size}, {}, click_sigma_px=1.75
                )
            except InputError as error:
                assert message and message in str(error)
            else:
                assert not message


HALLS = {
    "side": ((-18, 6.7, 1.9), 1120),
    "back": ((3.05, -14.3, 2.1), 1120),
    "oblique": ((-17, -11.3, 1.9), 1120),
}


def of_eight(change=None, n_draws=15):
    """Yield eight clicks of persons in each place, changed, with the camera and its `Fitted`."""
    rng, way = np.random.default_rng(4), known_points.method("known8", COURT)
    for place, (at, f_px) in HALLS.items():
        matrix = [[f_px, 0, 639.5], [0, f_px, 359.5], [0, 0, 1]]
        camera = camera_models.Camera(place, SIZE, matrix, [0] * 5, look_at(at, (3.05, 6.7, 1)))
        drawn = {"n_draws": n_draws, "seed": 3, "preset": "rich", "session": place}
        for marked in clicking.clicks_of_persons([camera], COURT, COURT.xyz, **drawn):
            wrong = change(marked[place], rng) if change else []
            try:
                found = known_points.calibrate(
                    way, COURT, marked, {place: SIZE}, {}, click_sigma_px=1.75
                )[place]
            except InputError as error:
                assert "check the names" in str(error) or "the points are mirrored" in str(error)
                found = None
            yield camera, found, np.isin(way.points, wrong)


def test_eight_good_clicks_are_not_refused():
    """One may be left out: their scatter differs, and eight residuals are smaller than errors."""
    found = [fitted for _, fitted, _ in of_eight()]
    assert None not in found
    assert min(fitted.accepted.sum() for fitted in found) == 7


def one_wrong(xy, rng):
    at = rng.choice(COURT.indices("eight"))
    xy[at] += rng.choice([-1, 1], 2) * rng.uniform(20, 60, 2)
    return [at]


def two_exchanged(xy, rng):
    pair = rng.choice(COURT.indices("eight"), 2, replace=False)
    xy[pair] = xy[pair[::-1]]
    return pair


@pytest.mark.parametrize("change", [one_wrong, two_exchanged])
def test_a_wrong_one_of_eight_is_left_out_or_refused(change):
    """But for a few: a corner of the court that alone tells the lens takes the lens with it."""
    kept = [
        found is not None and bool((found.accepted & wrong).any())
        for _, found, wrong in of_eight(change)
    ]
    assert np.mean(kept) <= 0.1
