"""A whole virtual session: its files, and that the pictures show what the truth says."""

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from courtside.calibration.court import court as court_files
from courtside.geometry import camera as projection
from courtside.geometry.camera import Camera
from courtside.records.cameras import clicks
from courtside.records.truth import session_truth
from courtside.study.configuration import yaml_files
from courtside.video import reader
from fixtures.cameras import scene
from fixtures.recordings import coarse_halls
from virtualgym import worlds
from virtualgym.cameras import layouts, row_warp
from virtualgym.session import click_model, session

CONFIG = Path(__file__).parents[4] / "config"
COURT = court_files.read(CONFIG / "courts" / "badminton.yaml")
SETTINGS = session.Settings(
    preset="rich", layout="a", seed=3, size_px=[480, 270], walk_frames=4, static_frames=3,
    boards=True, people=2, stabiliser=True,
)  # fmt: skip


@pytest.fixture(scope="module", autouse=True)
def halls():
    """Build each hall once: it takes most of the time."""
    built, build = {}, session.hall.build

    def build_once(preset, court, seed, **more):
        key = (preset.name, court.name, seed.entropy, seed.spawn_key, str(more))
        if key not in built:
            built[key] = build(preset, court, seed, **more)
        return built[key]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(session.hall, "build", build_once)
        yield built


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    made = tmp_path_factory.mktemp("one")
    session.simulate(SETTINGS, COURT, made)
    return made


@pytest.fixture(scope="module")
def known(folder):
    return session_truth.read(folder / "truth.npz")


def files(folder):
    return {str(p.relative_to(folder)): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def walked(known, at):
    """Return the walked camera at one frame, from the truth."""
    walk = known.walks["walk"]
    matrix = walk.K.copy()
    matrix[:2, 2] = walk.principal_point_px[at]
    return Camera("walk", (480, 270), matrix, walk.dist, walk.cam_from_world[at])


def line_contrast(image, camera):
    """Return how much brighter the outer lines along y are than the floor 15 cm beside them."""
    grey = cv2.cvtColor(image, cv2.COLOR_BGR2GRAY).astype(np.float32)
    middles = np.array([[x, y, 0] for x in (0.02, 6.08) for y in np.linspace(0.3, 4.5, 60)])
    level = {}
    for aside_m in (-0.15, 0.0, 0.15):
        xy = scene.opencv_projection(camera, middles + np.array([aside_m, 0, 0])).astype(np.float32)
        level[aside_m] = cv2.remap(grey, xy[:, 0], xy[:, 1], cv2.INTER_LINEAR).mean()
    return level[0.0] - max(level[-0.15], level[0.15])


def test_a_session_has_its_files_and_no_others(folder):
    names = {"side.mp4", "back.mp4", "walk.mp4", "court_points.csv", "truth.npz"}
    boards = {f"boards/{c}/{k:06d}.png" for c in ("side", "back") for k in range(12)}
    assert set(files(folder)) == names | boards


def test_without_static_frames_the_empty_hall_is_not_filmed(tmp_path):
    bare = replace(SETTINGS, walk_frames=0, static_frames=0, boards=False)
    session.simulate(bare, COURT, tmp_path)
    assert set(files(tmp_path)) == {"court_points.csv", "truth.npz"}


def test_videos_have_the_size_frames_and_times_that_were_asked(folder, known):
    for name in ("side", "back"):
        info = reader.probe(folder / f"{name}.mp4")
        assert (info.size, info.n_frames) == ((480, 270), 3)
    times_s = reader.frame_times(folder / "walk.mp4")
    np.testing.assert_allclose(times_s, known.walks["walk"].time_s, rtol=1e-6, atol=1e-9)
    expected_s = (21 * np.pi / 2 - 1.6) / (2 / 3.6)
    assert times_s[-1] == pytest.approx(expected_s, rel=0.02)


def test_the_fixed_cameras_see_the_court_where_the_truth_says(folder, known):
    camera = known.cameras[1]
    assert camera.name == "back"
    frames = [image for _, image in reader.frames(folder / "back.mp4")]
    assert line_contrast(np.median(frames, axis=0).astype(np.uint8), camera) > 15
    beside = replace(camera, K=camera.K + np.outer([4, 0, 0], [0, 0, 1]))
    assert line_contrast(frames[0], beside) < 5, "four pixels beside, there are no lines"
    assert (frames[0] != frames[1]).mean() > 0.2, "noise"


def test_the_walk_sees_the_court_where_the_truth_says(folder, known):
    frames = [image for _, image in reader.frames(folder / "walk.mp4")]
    assert len(frames) == 4
    # At its end, beside `back`, the walk looks along lines.
    assert line_contrast(frames[3], walked(known, 3)) > 10
    assert line_contrast(frames[3], walked(known, 2)) < 5


def test_clicks_are_where_the_points_are_to_their_error(folder, known):
    found = clicks.read(folder / "court_points.csv", ["side", "back"], COURT.points)
    assert known.court_points.tolist() == list(COURT.points)
    errors = np.concatenate(
        [found[c.name] - scene.opencv_projection(c, known.court_xyz) for c in known.cameras]
    )
    assert np.isfinite(errors).all()
    preset = session.presets.PRESETS[SETTINGS.preset]
    model = [
        click_model.covariance(c, known.court_xyz, COURT, preset) for c in known.cameras
    ]  # with the person's own factor and bias: not far from the model's average
    expected = np.sqrt(np.mean(np.trace(np.concatenate(model), axis1=1, axis2=2)) / 2)
    assert 0.4 * expected < errors.std() < 2.0 * expected
    off_m = np.linalg.norm(known.court_xyz - COURT.xyz, axis=1)
    assert 0 < off_m.max() < 0.05, "painted lines are millimetres off"


def test_the_files_do_not_depend_on_the_number_of_processes(tmp_path):
    with coarse_halls.built():
        for threads in (1, 2):
            session.simulate(SETTINGS, COURT, tmp_path / str(threads), threads=threads)
    one, two = files(tmp_path / "1"), files(tmp_path / "2")
    assert one.keys() == two.keys()
    assert [name for name in one if one[name] != two[name]] == []


def test_another_walk_leaves_hall_and_fixed_cameras_as_they_are(folder, known, halls, tmp_path):
    other = replace(SETTINGS, walk_seed=1, walk_frames=2, people=0)
    session.simulate(other, COURT, tmp_path)
    assert len(halls) == 1
    one, two = files(folder), files(tmp_path)
    same = {name for name in one if one[name] == two[name]}
    assert same == one.keys() - {"walk.mp4", "truth.npz"}
    moved = session_truth.read(tmp_path / "truth.npz").walks["walk"]
    assert np.abs(moved.cam_from_world[0] - known.walks["walk"].cam_from_world[0]).max() > 1e-3
    assert (moved.K != known.walks["walk"].K).any()


def test_settings_that_differ_in_one_thing_share_the_rest():
    fixed, walk = session.plan(SETTINGS, COURT)
    fast_fixed, fast = session.plan(replace(SETTINGS, speed_kmh=6.0), COURT)
    assert (fast.K == walk.K).all() and fast.duration_s == pytest.approx(walk.duration_s / 3)
    narrow, _ = session.plan(replace(SETTINGS, baseline_deg=30.0), COURT)
    large, _ = session.plan(replace(SETTINGS, size_px=(960, 540)), COURT)
    for group in (fast_fixed, narrow, large):
        for a, b in zip(fixed, group, strict=True):
            assert a.K[0, 0] / a.size[0] == pytest.approx(b.K[0, 0] / b.size[0], rel=1e-12)
    assert (narrow[1].cam_from_world == fixed[1].cam_from_world).all()
    assert [c.name for c in session.plan(replace(SETTINGS, layout="b-mirror"), COURT)[0]] == [
        *layouts.LAYOUTS["b-mirror"]
    ]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"preset": "grand"}, "a preset of"),
        ({"walk_frames": 1}, "walk_frames 0 or >= 2"),
        ({"static_frames": 0}, "static_frames >= 1"),
        ({"static_frames": -1, "walk_frames": 0}, "static_frames >= 1"),
    ],
)
def test_impossible_settings_are_refused(change, message):
    with pytest.raises(ValueError, match=message):
        replace(SETTINGS, **change)


def test_an_error_of_a_rendering_process_is_passed_on(tmp_path):
    odd = replace(SETTINGS, layout="c")
    with pytest.raises(ValueError, match="expected a layout"):
        session.simulate(odd, COURT, tmp_path, threads=2)
    assert list(tmp_path.iterdir()) == []


ALL = dict.fromkeys(worlds.EFFECTS, 1.0)


def shown(camera, walk, at, xyz):
    """Return where a frame of the walk shows points (N, 3) at its middle row, (N, 2) px."""
    lens_px = projection.project(camera, xyz)
    xy = lens_px
    for _ in range(20):  # a pixel of the frame shows what the lens showed a shift further on
        xy = lens_px - row_warp.shifts(walk.row_warp_px[at], xy[:, 1], camera.size[1]).T
    return xy


def test_a_world_of_no_strength_changes_no_byte(tmp_path, folder):
    session.simulate(replace(SETTINGS, world=dict.fromkeys(worlds.EFFECTS, 0)), COURT, tmp_path)
    assert files(tmp_path) == files(folder)


def test_each_effect_changes_what_it_should_and_nothing_else():
    usual_fixed, usual_walk = session.plan(SETTINGS, COURT)
    for effect in worlds.EFFECTS:
        fixed, walk = session.plan(replace(SETTINGS, world={effect: 1}), COURT)
        for camera, usual in zip(fixed, usual_fixed, strict=True):
            assert len(camera.dist) == (9 if effect == "lens" else 5)
            np.testing.assert_array_equal(camera.dist[:4], usual.dist[:4])
            np.testing.assert_array_equal(camera.K, usual.K)
        times_s = walk.grid(200)
        assert (walk.row_warp_px(0.0) is not None) == (effect == "stabiliser")
        scale = np.array([walk.focal_scale(time_s) for time_s in times_s])
        assert np.std(scale) == pytest.approx(1e-3 if effect == "breathing" else 0, rel=0.3)
        np.testing.assert_array_equal(walk.pose(3.0), usual_walk.pose(3.0))


def test_a_stabiliser_that_is_off_bends_no_rows():
    off = replace(SETTINGS, world={"stabiliser": 1}, stabiliser=False)
    assert session.plan(off, COURT)[1].row_warp_px(1.0) is None


def test_rows_are_bent_by_the_stated_amount():
    walk = session.plan(replace(SETTINGS, world={"stabiliser": 2}), COURT)[1]
    warps = np.array([walk.row_warp_px(time_s) for time_s in np.linspace(0, 3000, 6000)])
    expected_px = 2 * row_warp.WARP_PX * 480 / 1280
    np.testing.assert_allclose(warps.std(axis=0), expected_px, rtol=0.05)


def test_pictures_show_what_the_truth_of_a_wrong_world_says(tmp_path):
    """Corners of the net's tape and posts would be few: lines, by their brightness, at 640 px."""
    settings = replace(SETTINGS, size_px=(640, 360), people=0, boards=False, world=ALL)
    session.simulate(settings, COURT, tmp_path)
    known = session_truth.read(tmp_path / "truth.npz")
    own_s = [settings.readout_s(at) for at in (0, 1)]
    np.testing.assert_array_equal(known.readout_s, own_s)
    assert own_s[0] != own_s[1]
    assert known.walks["walk"].readout_s == settings.readout_s(None)
    still = [image for _, image in reader.frames(tmp_path / "back.mp4")]
    assert contrast(still[0], lambda xyz: projection.project(known.cameras[1], xyz)) > 15
    walk = known.walks["walk"]
    frames = [image for _, image in reader.frames(tmp_path / "walk.mp4")]
    matrix = walk.K.copy()
    matrix[[0, 1], [0, 1]] *= walk.focal_scale[3]
    matrix[:2, 2] = walk.principal_point_px[3]
    camera = Camera("walk", (640, 360), matrix, walk.dist, walk.cam_from_world[3])
    assert contrast(frames[3], lambda xyz: shown(camera, walk, 3, xyz)) > 10


def contrast(image, project):
    grey = cv2.cvtColor(image, cv2.COLOR_BGR2GRAY).astype(np.float32)
    middles = np.array([[x, y, 0] for x in (0.02, 6.08) for y in np.linspace(0.3, 4.5, 60)])
    level = {}
    for aside_m in (-0.15, 0.0, 0.15):
        xy = project(middles + np.array([aside_m, 0, 0])).astype(np.float32)
        level[aside_m] = cv2.remap(grey, xy[:, 0], xy[:, 1], cv2.INTER_LINEAR).mean()
    return level[0.0] - max(level[-0.15], level[0.15])


def test_repeated_takes_of_several_players_do_not_share_random_numbers():
    """Players of one seed move alike, and 15 repeats would be worth five."""
    takes = yaml_files.read(CONFIG / "sessions" / "repeats.yaml")["takes"].values()
    seeds = [take["virtual"]["seed"] for take in takes]
    assert len(seeds) == len(set(seeds)) == 15


@pytest.mark.parametrize("path", sorted((CONFIG / "sessions").glob("*.yaml")), ids=lambda p: p.stem)
def test_no_take_has_bystanders_and_devices_which_share_random_numbers(path):
    takes = yaml_files.read(path).get("takes") or {}
    virtual = [take.get("virtual") or {} for take in takes.values()]
    assert not [one for one in virtual if one.get("bystanders") and one.get("devices")]
