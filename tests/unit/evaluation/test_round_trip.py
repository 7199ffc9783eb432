"""Table 1: the identity, rounding against its variance, known errors."""

import runpy
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from courtside.evaluation import round_trip
from courtside.geometry import camera as camera_models
from courtside.geometry.camera import Camera
from courtside.records.keypoints import keypoints, people
from courtside.study.errors import InputError
from fixtures.cameras import scene
from fixtures.people import found, keypoints_made, walker

ROOT = Path(__file__).parents[3]
PUBLISHED = ROOT / "config" / "published" / "badminton_tab01.csv"
DIST = (-0.12, 0.05, 0.001, -0.0005, 0.0)


def symmetric_pair(distance_m=12.0, focal_px=1500.0):
    """Return two cameras at right angles that look at the origin."""
    matrix = np.array([[focal_px, 0, 960.0], [0, focal_px, 540.0], [0, 0, 1]])
    centres = [(distance_m, 0, 0), (0, distance_m, 0)]
    return [
        Camera(f"c{at}", (1920, 1080), matrix, np.zeros(5), scene.look_at(centre, (0, 0, 0)))
        for at, centre in enumerate(centres)
    ]


@pytest.mark.parametrize("count", [2, 3, 4])
def test_the_exact_round_trip_is_an_identity_whatever_the_cameras(count):
    cameras = scene.ring(count, dist=DIST)[:count]
    moved = [
        Camera(c.name, c.size, c.K, c.dist * at, c.cam_from_world) for at, c in enumerate(cameras)
    ]
    for used in (cameras, moved):
        distance = round_trip.distance_after(used, scene.points(500))
        assert np.isfinite(distance).all()
        assert distance.max() < 1e-6
        assert round_trip.round_trips(used, scene.points(50), 3840)["exact"][1].max() < 1e-6


def test_a_round_trip_that_moves_points_is_refused(monkeypatch):
    cameras = scene.ring(3)
    there = round_trip.camera_models.project
    monkeypatch.setattr(round_trip.camera_models, "project", lambda c, x: there(c, x) + 1e-3)
    with pytest.raises(ValueError, match=r"cameras c0\+c1\+c2: expected .* inverse"):
        round_trip.round_trips(cameras, scene.points(5), 3840)


@pytest.mark.parametrize(("step_px", "share"), [(1.0, 1.0), (0.5, 0.5)])
def test_rounding_moves_points_by_the_variance_of_a_rounded_number(step_px, share):
    """At right angles one view gives x, one y, and the mean of both z: variance 2.5 / 12 px2.

    The cube is large enough for the two views to round a point's height independently.
    """
    distance_m, focal_px = 12.0, 1500.0
    rng = np.random.default_rng(0)
    xyz = rng.uniform(-0.6, 0.6, (40000, 3))
    cameras = symmetric_pair(distance_m, focal_px)
    moved = round_trip.distance_after(cameras, xyz, [step_px, step_px])
    expected_mm = 1000 * share * distance_m / focal_px * np.sqrt(2.5 / 12)
    assert np.sqrt(np.mean(moved**2)) == pytest.approx(expected_mm, rel=0.015)


def test_the_grid_of_twice_the_width_has_two_cells_in_each_pixel():
    xy = np.array([[0.1, 0.3], [7.24, -0.3], [7.6, 100.9]])
    np.testing.assert_allclose(round_trip.round_to_grid(xy, 1.0), np.rint(xy))
    np.testing.assert_allclose(
        round_trip.round_to_grid(xy, 0.5), [[0.25, 0.25], [7.25, -0.25], [7.75, 100.75]]
    )


def test_the_published_table_has_its_stated_means():
    published = pd.read_csv(PUBLISHED)
    assert len(published) == 14
    assert published["joint"].is_unique
    assert published["mean_mm"].mean() == pytest.approx(2.72, abs=0.005)
    assert published["sd_mm"].mean() == pytest.approx(0.81, abs=0.005)


def make(n_frames=40):
    """Return a take of two persons on a ring of three cameras."""
    points = walker.points(n_persons=2, n_frames=n_frames)
    return points, scene.ring(4)


def test_the_frames_are_in_the_middle_or_where_asked():
    points, _ = make()
    chosen = round_trip.span(points, 17)
    assert (chosen.frames.start, chosen.frames.stop) == (11, 28)
    assert round_trip.span(points, None).frames == slice(0, 40)
    start = round_trip.span(points, 5, points.time_s[8]).frames
    assert (start.start, start.stop) == (8, 13)
    stated = "draw_stroke.takes.hall/shot"
    with pytest.raises(InputError, match=f"^{stated}: expected 5 frames from .*, found 2 up to"):
        round_trip.span(points, 5, points.time_s[-2], stated)


def truth_of(points, shift_m):
    """Return a truth at 100 Hz, `shift_m` away from the points, moving at constant speed."""
    time_s = np.arange(points.time_s[0] - 0.1, points.time_s[-1] + 0.1, 0.01)
    speed = np.array([0.5, -0.2, 0.1])
    base = np.arange(len(points.joints))[:, None] * [0.01, 0.02, 0.03]
    real = base + speed * time_s[:, None, None]
    at_points = base + speed * points.time_s[:, None, None] + shift_m
    return (
        SimpleNamespace(
            joints=points.joints[::-1],
            person_id=points.person_id[::-1],
            time_s=time_s,
            xyz=np.stack([real[:, ::-1] + 7.0, real[:, ::-1]]),
        ),
        at_points,
    )


def test_rows_state_mean_deviation_count_and_population():
    points, cameras = make()
    real, moving = truth_of(points, [0.03, 0.0, 0.04])
    points.xyz[0] = moving
    points.xyz[0, 20, 3] = np.nan
    joints = [points.joints[3], points.joints[5], "no_such_joint"]
    rows = round_trip.table(
        points, cameras, joints, round_trip.span(points, 17), truth=real, published_width=3840
    )
    first = rows[rows["person"] == points.person_id[0]].set_index(["row", "joint"])
    true = first.loc[("truth", joints[1])]
    np.testing.assert_allclose([true["mean"], true["sd"]], [50.0, 0.0], atol=1e-9)
    assert (true["n"], true["unit"]) == (17, "mm")
    assert first.loc[("truth", joints[0]), "n"] == 16
    assert first.loc[("exact", joints[1]), "mean"] < 1e-6
    seen = first.loc[("reprojection", joints[1])]
    error = points.reproj_error_px[0, 11:28, 5]
    np.testing.assert_allclose([seen["mean"], seen["sd"]], [error.mean(), error.std(ddof=1)])
    assert seen["n"] == 17 * 3
    assert seen["over"].startswith("17 frames from")
    assert seen["over"].endswith("x 3 cameras")
    of_all = first.loc[("rounded", "all")]
    assert of_all["n"] == 2
    assert of_all["mean"] == pytest.approx(first.loc["rounded"]["mean"].iloc[:2].mean())
    assert set(rows["n_cameras"]) == {3}


def test_a_truth_of_other_persons_and_a_camera_without_calibration_are_refused():
    points, cameras = make()
    real, _ = truth_of(points, 0.0)
    real.person_id = np.array(["x", "y"])
    chosen = round_trip.span(points, 5)
    with pytest.raises(InputError, match=r"found \['x', 'y'\]"):
        round_trip.table(
            points, cameras, points.joints[:2], chosen, truth=real, published_width=3840
        )
    with pytest.raises(InputError, match="camera c2: expected one of"):
        round_trip.table(points, cameras[:2], points.joints[:2], chosen, published_width=3840)


def test_a_bystander_is_not_taken_for_the_person_whom_a_left_out_view_misses(tmp_path):
    """The person is seen 3 px off in three frames of four; another one stands 3 m aside."""
    points, cameras = walker.points(n_frames=40), scene.ring(4)
    places = points.xyz[0], points.xyz[0] + [0.0, 3.0, 0.0]
    xy = np.stack([camera_models.project(cameras[3], place) for place in places])
    xy[0] += [0.0, 3.0]
    xy[0, ::4] = np.nan
    rows = np.where(np.arange(40) % 4, 0, -1)[None]
    view = keypoints_made.view(cameras[3], points.joints, points.time_s, xy)
    paths = {name: tmp_path / name for name in ("p3.npz", "p2.npz", "who.npz", "c.toml", "o.csv")}
    keypoints.write_3d(paths["p3.npz"], points)
    keypoints.write_2d(paths["p2.npz"], view)
    people.write(paths["who.npz"], found.people({"c3": rows}, ["p1"]))
    camera_models.write_toml(paths["c.toml"], cameras, source="test")
    script = runpy.run_path(str(ROOT / "workflow" / "scripts" / "evaluate_round_trip.py"))
    script["main"](
        pose3d_npz=[paths["p3.npz"]],
        cameras_toml=paths["c.toml"],
        people_npz=paths["who.npz"],
        skeleton_yaml=ROOT / "config" / "skeletons" / "blazepose33.yaml",
        derived_yaml=ROOT / "config" / "derived_joints.yaml",
        rows_csv=paths["o.csv"],
        pose2d_npz=[paths["p2.npz"]],
        session="hall",
        take="shot",
        joints=["left_wrist"],
        derived_joints=[],
        n_frames=None,
        start_s=None,
        published_width=3840,
    )
    rows = pd.read_csv(paths["o.csv"])
    (wrist,) = rows[(rows["row"] == "left_out") & (rows["joint"] == "left_wrist")].itertuples()
    assert wrist.n == 30
    assert wrist.mean == pytest.approx(3.0, abs=1e-6)
