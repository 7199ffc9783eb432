"""One camera from known points: exact truth, OpenCV, Monte Carlo, and every refusal."""

from pathlib import Path

import cv2
import numpy as np
import pytest

from courtside.calibration.court import court, line_edges, resection
from courtside.geometry import camera as cameras
from courtside.geometry import triangulation
from courtside.study.errors import InputError
from fixtures.cameras.scene import look_at, opencv_projection

COURT = court.read(Path(__file__).parents[4] / "config" / "courts" / "badminton.yaml")
SIZE = (1280, 720)
CENTRES = {"side": (-18, 6.7, 1.9), "back": (3.05, -14.3, 2.1), "oblique": (-17, -11.3, 1.9)}
SIGMA_PX = 0.23  # of a click, 0.7 px in a picture 3840 px wide
VOLUME = np.stack(np.meshgrid([0, 3, 6.1], [0, 6.7, 13.4], [0, 1.5, 3]), axis=-1).reshape(-1, 3)


def camera(place="oblique", k1=-0.045, centre=None):
    matrix = np.array([[1120.0, 0, 639.5], [0, 1120, 359.5], [0, 0, 1]])
    pose = look_at(centre or CENTRES[place], (3.05, 6.7, 1.3))
    return cameras.Camera(place, SIZE, matrix, [k1, 0, 0, 0, 0], pose)


def clicked(true, xyz=COURT.xyz, sigma_px=0.0, seed=0):
    noise = np.random.default_rng(seed).normal(0, 1, (len(xyz), 2))
    return opencv_projection(true, xyz) + sigma_px * noise


def angle_deg(found, true):
    relative = found.cam_from_world[:, :3] @ true.cam_from_world[:, :3].T
    return np.degrees(np.linalg.norm(cv2.Rodrigues(relative)[0]))


def assert_same(found, true, tolerance=1.0):
    np.testing.assert_allclose(found.K, true.K, rtol=1e-6 * tolerance, atol=1e-4 * tolerance)
    np.testing.assert_allclose(found.centre_in_world, true.centre_in_world, atol=1e-6 * tolerance)
    assert angle_deg(found, true) < 1e-5 * tolerance


# ---- least squares


@pytest.mark.parametrize("place", CENTRES)
@pytest.mark.parametrize("which", ["all", "eight"])
def test_exact_clicks_give_the_camera_without_a_start(place, which):
    true, at = camera(place), COURT.indices(which)
    found = resection.nonlinear(COURT.xyz[at], clicked(true)[at], SIZE, name=place)
    assert_same(found.camera, true)
    assert found.camera.dist[0] == pytest.approx(-0.045, abs=1e-5)
    assert found.accepted.all() and found.rms_px < 1e-6 and found.camera.name == place


@pytest.mark.parametrize("focal_px", [700.0, 2400.0])
def test_wide_and_long_lenses_are_found(focal_px):
    matrix = np.array([[focal_px, 0, 639.5], [0, focal_px, 359.5], [0, 0, 1]])
    pose = look_at((-9, -7, 6), (3.05, 6.7, 0))
    true = cameras.Camera("x", SIZE, matrix, [-0.1, 0, 0, 0, 0], pose)
    found = resection.nonlinear(COURT.xyz, clicked(true), SIZE)
    assert_same(found.camera, true)


def test_a_known_lens_leaves_the_pose_to_four_points():
    true = camera()
    dist = np.array([-0.2, 0.05, 1e-3, -2e-3, 0.01])
    true = cameras.Camera(
        "x", SIZE, true.K + np.array([[0, 0, 9], [0, 3, -7], [0, 0, 0]]), dist, true.cam_from_world
    )
    at = COURT.indices(["p02", "p03", "p09", "p17"])
    xy = np.full((18, 2), np.nan)
    xy[at] = clicked(true)[at]
    found = resection.nonlinear(COURT.xyz, xy, SIZE, K=true.K, dist=dist)
    assert_same(found.camera, true)
    assert np.flatnonzero(found.accepted).tolist() == sorted(at)
    assert np.isnan(found.error_px).sum() == 14
    assert found.parameters == ("rx_rad", "ry_rad", "rz_rad", "tx_m", "ty_m", "tz_m")


def test_the_fit_is_opencvs():
    true = camera()
    xy = clicked(true, sigma_px=SIGMA_PX, seed=3)
    found = resection.nonlinear(COURT.xyz, xy, SIZE, sigma_px=SIGMA_PX)
    flags = cv2.CALIB_USE_INTRINSIC_GUESS | cv2.CALIB_FIX_ASPECT_RATIO | cv2.CALIB_ZERO_TANGENT_DIST
    flags |= cv2.CALIB_FIX_K2 | cv2.CALIB_FIX_K3 | cv2.CALIB_FIX_PRINCIPAL_POINT
    _, matrix, dist, _, shifts = cv2.calibrateCamera(
        [COURT.xyz.astype(np.float32)],
        [xy.astype(np.float32)],
        SIZE,
        true.K.copy(),
        np.zeros(5),
        flags=flags,
        criteria=(3, 200, 1e-14),
    )
    assert found.accepted.all()
    assert found.camera.K[0, 0] == pytest.approx(matrix[0, 0], rel=2e-5)  # its pixels are float32
    assert found.camera.dist[0] == pytest.approx(dist.ravel()[0], abs=2e-4)
    np.testing.assert_allclose(found.camera.cam_from_world[:, 3], shifts[0].ravel(), atol=2e-3)


def test_a_pose_is_opencvs():
    true = camera()
    xy = clicked(true, sigma_px=SIGMA_PX, seed=4)
    found = resection.nonlinear(COURT.xyz, xy, SIZE, K=true.K, dist=true.dist, sigma_px=SIGMA_PX)
    turn, _ = cv2.Rodrigues(true.cam_from_world[:, :3])
    turn, shift = cv2.solvePnPRefineLM(
        COURT.xyz, xy, true.K, true.dist, turn, true.cam_from_world[:, 3:].copy(), (3, 200, 1e-15)
    )
    assert found.accepted.all()
    np.testing.assert_allclose(found.camera.cam_from_world[:, 3], shift.ravel(), atol=1e-5)
    np.testing.assert_allclose(
        found.camera.cam_from_world[:, :3], cv2.Rodrigues(turn)[0], atol=1e-6
    )


@pytest.mark.parametrize("known_lens", [False, True])
@pytest.mark.parametrize("court_sigma", [0.0, 1.0])
def test_the_covariance_is_that_of_repeated_clicks(known_lens, court_sigma):
    true, n_draws = camera(), 150
    lens = {"K": true.K, "dist": true.dist} if known_lens else {}
    rng = np.random.default_rng(5)
    spread = COURT.sigma_m * court_sigma
    steps = []
    for draw in range(n_draws):
        moved = COURT.xyz + spread[:, None] * rng.normal(0, 1, (18, 3))
        xy = clicked(true, moved, SIGMA_PX, seed=100 + draw)
        found = resection.nonlinear(
            COURT.xyz,
            xy,
            SIZE,
            sigma_px=SIGMA_PX,
            xyz_sigma=spread if court_sigma else None,
            **lens,
        )
        steps.append(step_between(true, found.camera)[: len(found.parameters)])
    steps = np.array(steps)
    expected = resection.nonlinear(
        COURT.xyz,
        clicked(true),
        SIZE,
        sigma_px=SIGMA_PX,
        xyz_sigma=spread if court_sigma else None,
        **lens,
    ).covariance
    # All directions at once, and each alone: 150 draws know a standard deviation to 6 %.
    mahalanobis = np.einsum("ni,ij,nj->n", steps, np.linalg.inv(expected), steps)
    assert mahalanobis.mean() / len(expected) == pytest.approx(1, abs=0.12)
    ratio = np.sqrt((steps**2).mean(axis=0) / np.diag(expected))
    np.testing.assert_allclose(ratio, 1, atol=0.18)


def test_clicks_along_flat_edges_weigh_less():
    """Drawn as two edges meet: errors are smaller than by equal weights, and as large as stated."""
    true, n_draws = camera("side"), 60
    edges = line_edges.on_lines(COURT)
    shape = line_edges.click_covariances(true, COURT.xyz, edges)
    root, rng = np.linalg.cholesky(shape), np.random.default_rng(7)
    alike, weighed = [], []
    for _ in range(n_draws):
        noise = SIGMA_PX * (root @ rng.normal(size=(18, 2, 1)))[..., 0]
        given = COURT.xyz, clicked(true) + noise, SIZE
        known = {"K": true.K, "dist": true.dist, "sigma_px": SIGMA_PX}
        alike.append(step_between(true, resection.nonlinear(*given, **known).camera)[:6])
        found = resection.nonlinear(*given, **known, edges=edges)
        weighed.append(step_between(true, found.camera)[:6])
    errors = [
        np.median(np.linalg.norm(np.array(steps)[:, 3:], axis=1)) for steps in (alike, weighed)
    ]
    assert errors[1] < 0.8 * errors[0]
    stated = resection.nonlinear(COURT.xyz, clicked(true), SIZE, **known, edges=edges).covariance
    square = np.einsum("ni,ij,nj->n", weighed, np.linalg.inv(stated), weighed)
    assert square.mean() / 6 == pytest.approx(1, abs=0.25)


def step_between(true, found):
    """Return the step of pose, f and k1 from the true camera, by the definition of `Fitted`."""
    turn = found.cam_from_world[:, :3] @ true.cam_from_world[:, :3].T
    shift = found.cam_from_world[:, 3] - turn @ true.cam_from_world[:, 3]
    lens = found.K[0, 0] - true.K[0, 0], found.dist[0] - true.dist[0]
    return np.concatenate([cv2.Rodrigues(turn)[0].ravel(), shift, lens])


def test_wrong_clicks_are_left_out_and_named():
    true = camera()
    xy = clicked(true, sigma_px=SIGMA_PX)
    xy[3] += (40, -25)
    xy[[8, 11]] = xy[[11, 8]]
    found = resection.nonlinear(COURT.xyz, xy, SIZE, sigma_px=SIGMA_PX)
    assert np.flatnonzero(~found.accepted).tolist() == [3, 8, 11]
    assert found.error_px[3] == pytest.approx(np.hypot(40, 25), abs=2)
    kept = [at for at in range(18) if at not in (3, 8, 11)]
    without = resection.nonlinear(COURT.xyz[kept], xy[kept], SIZE, sigma_px=SIGMA_PX)
    assert_same(found.camera, without.camera)


ON_ONE_LINE = COURT.indices(["p01", "p04", "p06", "p03", "p10", "p01", "p04", "p06", "p03"])
SHUFFLED = np.random.default_rng(1).permutation(18)


@pytest.mark.parametrize(
    ("points", "clicks", "lens", "named"),
    [
        (range(7), range(7), {}, ["8 clicked", "found 7;", "click more"]),
        (range(3), range(3), {"K": np.diag([1120.0, 1120, 1])}, ["4 clicked", "found 3;"]),
        (ON_ONE_LINE, ON_ONE_LINE, {}, ["found 9 on one line"]),
        (range(18), SHUFFLED, {}, ["check the names"]),
    ],
    ids=["seven", "three", "line", "shuffled"],
)
def test_a_hopeless_set_is_refused_in_one_line(points, clicks, lens, named):
    xy = clicked(camera())[list(clicks)]
    with pytest.raises(InputError) as caught:
        resection.nonlinear(COURT.xyz[list(points)], xy, SIZE, name="left", **lens)
    message = str(caught.value)
    assert "\n" not in message and message.startswith("camera left: expected")
    assert [word for word in named if word not in message] == []


def test_two_names_of_four_exchanged_are_refused():
    at = COURT.indices(["p02", "p03", "p09", "p17"])
    true = camera()
    xy = clicked(true)[at][[1, 0, 2, 3]]
    with pytest.raises(InputError, match=r"camera left: expected .* check the names"):
        resection.nonlinear(COURT.xyz[at], xy, SIZE, K=true.K, dist=true.dist, name="left")


def test_a_camera_whose_best_fit_is_out_of_reach_is_refused():
    """As clicks of the mirror image: they fit best without perspective."""
    pose = look_at((-2000, -1500, 400), (3.05, 6.7, 1.3))
    far = cameras.Camera(
        "x", SIZE, [[90000.0, 0, 639.5], [0, 90000, 359.5], [0, 0, 1]], [0] * 5, pose
    )
    with pytest.raises(InputError, match=r"camera left: .* from more than 1340 m away; check the"):
        resection.nonlinear(COURT.xyz, clicked(far), SIZE, sigma_px=SIGMA_PX, name="left")


@pytest.mark.parametrize("seed", range(28, 36))
def test_wrong_names_never_end_in_a_fault_of_arithmetic(seed):
    at = COURT.indices("eight")
    xy = clicked(camera("side"))[np.random.default_rng(seed).permutation(at)]
    known = {"sigma_px": 0.25, "xyz_sigma": COURT.sigma_m[at]}
    with pytest.raises(InputError, match="camera left: expected"):
        resection.nonlinear(COURT.xyz[at], xy, SIZE, name="left", **known)


def test_clicks_in_one_place_are_refused():
    xy = np.full((len(COURT.xyz), 2), 300.0)
    with pytest.raises(InputError, match="camera left: expected clicks that fit a camera, found"):
        resection.nonlinear(COURT.xyz, xy, SIZE, name="left")


def test_a_floor_seen_square_on_does_not_show_the_focal_length():
    overhead = np.column_stack([np.diag([1.0, -1, -1]), [-3.05, 6.7, 20]])
    true = cameras.Camera("top", SIZE, camera().K, np.zeros(5), overhead)
    floor = COURT.xyz[COURT.xyz[:, 2] == 0]
    with pytest.raises(
        InputError, match=r"camera top: .* cannot be separated; click points above the floor"
    ):
        resection.nonlinear(floor, clicked(true, floor), SIZE, name="top")


def test_shapes_and_a_distortion_without_its_lens_are_programming_faults():
    with pytest.raises(ValueError, match=r"xyz \(P, 3\)"):
        resection.nonlinear(np.zeros((5, 3)), np.zeros((4, 2)), SIZE)
    with pytest.raises(ValueError, match="together with K"):
        resection.nonlinear(COURT.xyz, clicked(camera()), SIZE, dist=np.zeros(5))


# ---- DLT


@pytest.mark.parametrize("place", ["back", "oblique"])
def test_dlt_of_exact_clicks_is_the_camera(place):
    true = camera(place, k1=0.0)
    found = resection.dlt(COURT.xyz, clicked(true), size=SIZE, name=place)
    assert_same(found.camera, true, tolerance=100)
    assert found.reason == "" and found.rms_px < 1e-6
    homogeneous = np.column_stack([VOLUME, np.ones(len(VOLUME))]) @ found.matrix.T
    depth = (VOLUME @ true.cam_from_world[2, :3]) + true.cam_from_world[2, 3]
    np.testing.assert_allclose(homogeneous[:, 2], depth, rtol=1e-6)
    xy = homogeneous[:, :2] / homogeneous[:, 2:]
    np.testing.assert_allclose(xy, opencv_projection(true, VOLUME), atol=1e-5)


def test_two_dlt_matrices_triangulate_pixels():
    pair = [camera("back", 0.0), camera("oblique", 0.0)]
    matrices = [resection.dlt(COURT.xyz, clicked(true)).matrix for true in pair]
    xy = np.stack([opencv_projection(true, VOLUME) for true in pair])
    xyz = triangulation.triangulate(xy, np.ones(xy.shape[:2]), np.stack(matrices))
    np.testing.assert_allclose(xyz, VOLUME, atol=1e-6)


@pytest.mark.parametrize("place", ["back", "oblique"])
def test_the_magnification_is_that_of_repeated_clicks(place):
    true = camera(place, k1=0.0)
    low, high = COURT.xyz.min(axis=0), COURT.xyz.max(axis=0)
    high[2] = 3.05
    corners = np.stack(np.meshgrid(*zip(low, high, strict=True)), axis=-1).reshape(-1, 3)
    homogeneous = np.column_stack([corners, np.ones(8)])
    errors, magnification = [], []
    for seed in range(300):
        found = resection.dlt(COURT.xyz, clicked(true, sigma_px=SIGMA_PX, seed=seed))
        seen = homogeneous @ found.matrix.T
        errors.append(seen[:, :2] / seen[:, 2:] - opencv_projection(true, corners))
        magnification.append(found.magnification)
    measured = np.sqrt(np.mean(np.square(errors), axis=(0, 2))).max() / SIGMA_PX
    assert np.median(magnification) == pytest.approx(measured, rel=0.25)


@pytest.mark.parametrize("which", ["all", "eight"])
@pytest.mark.parametrize("sigma_px", [0.0, SIGMA_PX])
def test_a_camera_in_the_plane_of_the_net_is_degenerate(which, sigma_px):
    at = COURT.indices(which)
    for beside_m in (0.0, 1.0, 2.0):
        true = camera("side", centre=(-18, 6.7 + beside_m, 1.9))
        found = resection.dlt(
            COURT.xyz[at], clicked(true, sigma_px=sigma_px)[at], size=SIZE, name="side"
        )
        assert found.rms_px < 3 * SIGMA_PX  # the residuals do not show it
        assert found.reason.startswith("camera side: ") and "plane" in found.reason
    for place in ("back", "oblique"):
        found = resection.dlt(
            COURT.xyz[at], clicked(camera(place), sigma_px=sigma_px)[at], size=SIZE
        )
        assert not found.reason


def test_the_degenerate_dlt_is_wrong_above_the_floor_and_least_squares_is_not():
    true = camera("side")
    truth = opencv_projection(true, VOLUME)
    linear, fitted = [], []
    for seed in range(20):
        xy = clicked(true, sigma_px=SIGMA_PX, seed=seed)
        seen = (
            np.column_stack([VOLUME, np.ones(len(VOLUME))]) @ resection.dlt(COURT.xyz, xy).matrix.T
        )
        linear.append(np.abs(seen[:, :2] / seen[:, 2:] - truth).max())
        found = resection.nonlinear(COURT.xyz, xy, SIZE, sigma_px=SIGMA_PX)
        fitted.append(np.abs(cameras.project(found.camera, VOLUME) - truth).max())
    assert np.median(linear) > 10 and np.max(fitted) < 2


def test_points_in_one_plane_are_degenerate_and_few_are_refused():
    true, floor = camera(), COURT.xyz[:, 2] == 0
    found = resection.dlt(COURT.xyz[floor], clicked(true)[floor], size=SIZE, name="left")
    assert "one plane" in found.reason and found.magnification == np.inf
    with pytest.raises(
        InputError, match=r"camera left: expected 6 clicked points .* found 5; click more"
    ):
        resection.dlt(COURT.xyz[:5], clicked(true)[:5], name="left")
