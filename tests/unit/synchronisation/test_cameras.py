"""Clocks of simulated and of real cameras over whole takes, and their stated intervals."""

import json
import runpy
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from courtside.calibration import file_formats
from courtside.geometry import camera as camera_models
from courtside.records.devices import clocks as sync
from courtside.records.devices.clocks import Clock
from courtside.records.keypoints import keypoints
from courtside.study.errors import InputError
from courtside.synchronisation import cameras as camera_sync
from fixtures.cameras import scene, sync_takes
from fixtures.people import keypoints_made
from fixtures.recordings.real_data import REAL, needs_real

SCRIPT = Path(__file__).parents[3] / "workflow" / "scripts" / "synchronise_cameras.py"
CAMERAS = sync_takes.rig(3)
CLOCKS = [Clock(), Clock(2.31, -120.0), Clock(-3.07, 90.0)]
FOLDER = REAL / "walk-4cams"
FIRST = 5  # of BODY_25B's joints, left and right shoulder to ankle follow one another


def take(seed, *, seconds=20.0, rate_hz=30, n_people=1, people=None, clocks=CLOCKS, **errors):
    """Return the views of cameras whose clocks differ, each with its own tracklets."""
    rng = np.random.default_rng(seed)
    people = people or [sync_takes.athlete(rng, seconds) for _ in range(n_people)]
    own_s = np.arange(round(seconds * rate_hz)) / rate_hz
    views = []
    for at, (camera, clock) in enumerate(zip(CAMERAS, clocks, strict=True)):
        shown = people[: max(1, len(people) - at)][::-1]  # fewer people, and in another order
        views.append(sync_takes.seen(rng, camera, shown, own_s, clock, **errors))
    return views


def errors_s(found, truth, seconds):
    """Return by how much a clock is wrong at the start and at the end of the take."""
    ends = np.array([0.0, seconds])
    return found.from_reference(ends) - truth.from_reference(ends)


@pytest.mark.parametrize("rate_hz", [30, 60])
@pytest.mark.parametrize("known", [True, False], ids=["calibrated", "uncalibrated"])
def test_shifted_cameras_are_found_within_8_ms(known, rate_hz):
    views = take(0, rate_hz=rate_hz)
    found = camera_sync.synchronise(views, CAMERAS if known else None)
    assert list(found) == ["c0", "c1", "c2"]
    assert found["c0"].status == "reference"
    for camera, truth in zip(("c1", "c2"), CLOCKS[1:], strict=True):
        assert found[camera].status == "found"
        assert np.abs(errors_s(found[camera], truth, 20.0)).max() <= 0.008
    assert all(clock.usable for clock in found.values())


@pytest.mark.parametrize("offset_s", [0.433, 0.37, 0.38])
def test_cameras_that_face_each_other_are_found_wherever_the_scan_ends(offset_s):
    """A calm person whose arm alone is fast: if a clock is wrong by a frame, it looks wrong."""
    rng, own_s = np.random.default_rng(1), np.arange(600) / 30
    calm = sync_takes.athlete(rng, 20.0, liveliness=0.1, reach_m=0.5)
    fast = sync_takes.athlete(rng, 20.0, reach_m=0.0)
    arm = [sync_takes.JOINTS.index(f"right_{part}") for part in ("elbow", "wrist")]

    def person(time_s):
        joints = calm(time_s)
        joints[:, arm] += (fast(time_s) - sync_takes.BODY)[:, arm] - [*sync_takes.CENTRE, 0]
        return joints

    rig, views = [], []
    for camera, y_m, shift_s in zip(CAMERAS, (-10, 23), (0.0, offset_s), strict=False):
        facing = scene.look_at((3.05, y_m, 3), (*sync_takes.CENTRE, 1))
        rig.append(replace(camera, cam_from_world=facing))
        errors = {"noise_px": 1.0, "bias_px": 1.0}
        views.append(sync_takes.seen(rng, rig[-1], [person], own_s, Clock(shift_s), **errors))
    found = camera_sync.synchronise(views, rig, max_offset_s=2.0)["c1"]
    assert found.status == "found"
    assert found.from_reference(10.0) - 10.0 == pytest.approx(offset_s, abs=0.003)


@pytest.mark.parametrize("trim_s", [(0.0, 6.0), None])
def test_a_part_from_zero_of_which_cameras_share_little_is_told(tmp_path, capsys, trim_s):
    """The cameras start up to 5 s apart; whole videos are none of `trim_s`."""
    paths = []
    for view in take(0, seconds=6.0):
        paths.append(tmp_path / f"{view.camera}.npz")
        keypoints.write_2d(paths[-1], view)
    stated = {"c1": {"offset_s": 2.0}, "c2": {"offset_s": -3.0}}
    main = runpy.run_path(str(SCRIPT))["main"]
    how = {"synchronised": False, "stated": stated, "trim_s": trim_s}
    main(None, paths, tmp_path / "clocks.json", **how)
    told = "trim_s: all cameras share 0.97 of 5.97 s" in capsys.readouterr().err
    assert told == (trim_s is not None)


def test_clocks_of_a_take_are_one_or_found_or_stated():
    views = take(0)
    known = {camera.name: camera for camera in CAMERAS}
    together = camera_sync.of_take(views, known, synchronised=True, stated={})
    assert [clock.offset_s for clock in together.values()] == [0, 0, 0]
    offsets = {"c2": {"offset_s": -3.0}}
    found = camera_sync.of_take(views, known, synchronised=False, stated=offsets, min_score=0.3)
    assert found["c1"].offset_s == pytest.approx(CLOCKS[1].offset_s, abs=0.008)
    assert found["c2"] == Clock(-3.0, note="stated by the session")


def displaced(camera, by_m, degrees):
    """Return a camera whose calibration is displaced and turned."""
    turned = camera_models.turned(camera, np.deg2rad(degrees) * np.array([0.0, 1, 0]))
    pose = turned.cam_from_world.copy()
    pose[:, 3] -= pose[:, :3] @ by_m
    return replace(turned, cam_from_world=pose)


@pytest.mark.parametrize(("by_m", "degrees"), [((8.1, 0, 0), 0), ((0, 0, 0), 20), ((0, 0, 0), 60)])
def test_a_camera_that_was_moved_since_its_calibration_is_not_told_to_be_started_late(
    by_m, degrees
):
    """No offset fits its pose, but the rhythm of the motion alone tells its clock."""
    known = {camera.name: camera for camera in CAMERAS}
    known["c2"] = displaced(known["c2"], by_m, degrees)
    found = camera_sync.of_take(take(0), known, synchronised=False, stated={})
    assert (found["c1"].status, found["c2"].status) == ("found", "unknown")
    line = sync.fault_line("take", found)
    stated = float(line.split("its offset_s is ")[1].split(",")[0])
    assert stated == pytest.approx(CLOCKS[2].offset_s, abs=0.02)
    assert "contradicts its calibration" in line and "was moved since" in line
    assert "max_offset_s" not in line and "possible offsets" not in line and "\n" not in line


@pytest.mark.parametrize("calibrated", [True, False])
def test_a_clock_that_nothing_tells_may_be_a_calibration_that_is_off(calibrated):
    clocks = [Clock(), Clock(14.0), Clock(0.5)]
    known = {camera.name: camera for camera in CAMERAS} if calibrated else None
    views = take(0, seconds=30.0, clocks=clocks)
    options = {"synchronised": False, "stated": {}, "max_offset_s": 8.0}
    line = sync.fault_line("take", camera_sync.of_take(views, known, **options))
    assert "raise `synchronise_cameras: max_offset_s`" in line
    assert ("else its calibration may be off" in line) is calibrated
    assert "contradicts" not in line


@pytest.mark.parametrize("known", [True, False], ids=["calibrated", "uncalibrated"])
def test_a_stated_clock_helps_to_find_one_that_is_not_found_without(known):
    """The third camera starts near the second one, long after the first one."""
    clocks = [Clock(), Clock(-21.0, 80.0), Clock(-24.0)]
    views = take(2, seconds=50.0, rate_hz=15, clocks=clocks)
    rig = {camera.name: camera for camera in CAMERAS} if known else None

    def of_take(**stated):
        return camera_sync.of_take(views, rig, synchronised=False, stated=stated)

    assert of_take()["c2"].status == "unknown"
    told = {"offset_s": -21.0, "drift_ppm": 80.0}
    found = of_take(c1=told)
    assert found["c1"] == Clock(**told, note="stated by the session")
    assert found["c2"].status == "found"
    common = np.array([24.0, 50.0])
    wrong_s = found["c2"].from_reference(common) - clocks[2].from_reference(common)
    assert np.abs(wrong_s).max() < 0.008
    doubtful = of_take(c1=told | {"uncertainty_s": 0.05})["c2"]
    assert doubtful.status == "unknown" and doubtful.uncertainty_s > 0.05


def test_a_wrong_stated_clock_changes_none_that_is_found_without():
    views = take(0)
    known = {camera.name: camera for camera in CAMERAS}
    stated = {"c2": {"offset_s": CLOCKS[2].offset_s + 0.1}}
    found = camera_sync.of_take(views, known, synchronised=False, stated=stated)
    assert found["c1"] == camera_sync.synchronise(views, CAMERAS)["c1"]


def test_stated_clocks_of_all_cameras_need_no_motion():
    views = take(0, seconds=0.5)  # too short to be synchronised by
    known = {camera.name: camera for camera in CAMERAS}
    offsets = {"c1": {"offset_s": 0.2}, "c2": {"offset_s": -3.0}}
    found = camera_sync.of_take(views, known, synchronised=False, stated=offsets)
    assert [found[name].offset_s for name in ("c0", "c1", "c2")] == [0.0, 0.2, -3.0]
    assert found["c0"].status == "reference"


def test_several_people_of_whom_cameras_see_some():
    found = camera_sync.synchronise(take(1, n_people=3, seconds=15.0), CAMERAS)
    for camera, truth in zip(("c1", "c2"), CLOCKS[1:], strict=True):
        assert found[camera].status == "found"
        assert np.abs(errors_s(found[camera], truth, 15.0)).max() <= 0.008


def test_the_stated_interval_covers_the_truth(monkeypatch):
    monkeypatch.setattr(camera_sync, "NETWORK_S", 0.0)  # these keypoints are of no network
    inside, large = [], []
    for seed in range(24):
        rng = np.random.default_rng(100 + seed)
        clocks = [Clock()] + [
            Clock(rng.uniform(-3, 3), float(np.clip(rng.normal(0, 80), -200, 200))) for _ in "ab"
        ]
        found = camera_sync.synchronise(take(seed, seconds=12.0, clocks=clocks), CAMERAS)
        for camera, truth in zip(("c1", "c2"), clocks[1:], strict=True):
            if found[camera].usable:
                error = np.abs(errors_s(found[camera], truth, 12.0))
                inside += list(error <= 1.645 * found[camera].uncertainty_s)
                large += list(error > 0.008)
    assert len(inside) >= 80
    # 48 clocks, two by two from one take: three standard deviations about 90 % are 77 to 100 %.
    assert 0.77 <= np.mean(inside) <= 0.99
    assert np.mean(large) <= 0.02


def test_a_long_take_does_not_average_a_networks_delay_away():
    """A network that errs with the motion, here by 4 ms in one camera, shifts its clock by them."""
    clocks = [Clock(), Clock(0.5), Clock(-0.2)]
    late = [clocks[0], replace(clocks[1], offset_s=clocks[1].offset_s + 0.004), clocks[2]]
    found = camera_sync.synchronise(take(2, seconds=90.0, clocks=late), CAMERAS)
    for camera, truth in zip(("c1", "c2"), clocks[1:], strict=True):
        error_s = np.abs(errors_s(found[camera], truth, 90.0)).max()
        assert error_s <= 1.645 * found[camera].uncertainty_s < 0.008
    assert np.abs(errors_s(found["c1"], clocks[1], 90.0)).min() > 0.003


def test_a_minute_tells_the_drift():
    clocks = [Clock(), Clock(0.5, 160.0), Clock(-0.2, -140.0)]
    found = camera_sync.synchronise(take(2, seconds=90.0, clocks=clocks), CAMERAS)
    for camera, truth in zip(("c1", "c2"), clocks[1:], strict=True):
        assert found[camera].drift_uncertainty_ppm < 50
        assert abs(found[camera].drift_ppm - truth.drift_ppm) < 80


@pytest.mark.parametrize("sees_s", [0.8, 5.0])
def test_a_camera_that_sees_little_leaves_the_others_their_drift(sees_s):
    """A drift of 160 ppm taken for none is 10 ms off at each end of two minutes."""
    clocks = [Clock(), Clock(0.5, 160.0), Clock(-0.2, -140.0)]
    views = take(2, seconds=120.0, rate_hz=15, clocks=clocks)
    beside = np.abs(views[2].time_s - 60.0) > sees_s / 2
    views[2].xy[:, beside] = np.nan
    found = camera_sync.synchronise(views, CAMERAS)
    assert np.abs(errors_s(found["c1"], clocks[1], 120.0)).max() < 0.002
    assert found["c1"].drift_uncertainty_ppm < 50
    assert found["c2"].usable == (sees_s > 1)
    assert "inf" not in found["c2"].note


def test_a_camera_that_sees_seconds_of_a_long_take_is_placed_by_them():
    """A scan over the whole take would compare it at three times."""
    clocks = [Clock(), Clock(0.5, 160.0), Clock(-0.2)]
    views = take(2, seconds=240.0, rate_hz=15, clocks=clocks)
    views[2].xy[:, np.abs(views[2].time_s - 120.0) > 3.0] = np.nan
    found = camera_sync.synchronise(views, CAMERAS)
    assert found["c2"].usable
    assert np.abs(errors_s(found["c2"], clocks[2], 240.0)).max() < 0.008


def test_rows_that_show_one_person_after_another_tell_as_much_as_rows_of_their_own():
    """Over a whole take, no row of a camera shows the same person as a row of another one."""
    rng = np.random.default_rng(5)
    people = [sync_takes.athlete(rng, 240.0) for _ in range(2)]
    own_s = np.arange(240 * 15) / 15
    views = [
        sync_takes.seen(rng, camera, people, own_s, clock)
        for camera, clock in zip(CAMERAS, CLOCKS, strict=True)
    ]
    own = camera_sync.synchronise(views, CAMERAS)
    for view, every_s in zip(views, (31.0, 43.0, 59.0), strict=True):
        turn = (view.time_s // every_s).astype(int)
        view.xy[:, turn % 2 == 1] = view.xy[::-1, turn % 2 == 1]
        view.xy[:, view.time_s % every_s < 0.5] = np.nan
    found = camera_sync.synchronise(views, CAMERAS)
    for camera, truth in zip(("c1", "c2"), CLOCKS[1:], strict=True):
        assert np.abs(errors_s(found[camera], truth, 240.0)).max() < 0.004
        assert found[camera].uncertainty_s < 1.5 * own[camera].uncertainty_s


def test_the_uncertainty_is_that_of_the_times_that_a_camera_films():
    """Drifts of 100 ppm that are not known are 20 ms after 200 s, 2 ms within a video of 30 s."""
    views = take(2, seconds=240.0, rate_hz=10, clocks=[Clock(), Clock(0.5), Clock(-0.2, -140.0)])
    short = {key: getattr(views[2], key)[:, :300] for key in ("xy", "score", "reason")}
    views[2] = replace(views[2], time_s=views[2].time_s[:300], **short)
    found = camera_sync.synchronise(views, CAMERAS)["c2"]
    assert found.usable
    assert found.uncertainty_s < 0.006
    assert np.abs(errors_s(found, Clock(-0.2, -140.0), 30.0)).max() < 0.006


def test_a_short_take_leaves_the_drift_to_what_is_known_of_clocks():
    found = camera_sync.synchronise(take(3, seconds=8.0), CAMERAS)
    assert found["c1"].drift_uncertainty_ppm == pytest.approx(100, abs=15)
    assert abs(found["c1"].drift_ppm) < 50


@pytest.mark.parametrize("known", [True, False], ids=["calibrated", "uncalibrated"])
def test_a_periodic_person_is_ambiguous_by_whole_periods(known):
    views = take(4, people=[sync_takes.jumper], clocks=[Clock(), Clock(0.4), Clock(-0.7)])
    found = camera_sync.synchronise(views, CAMERAS if known else None, max_offset_s=2.0)
    for camera, truth_s in (("c1", 0.4), ("c2", -0.7)):
        assert found[camera].status in ("ambiguous", "unknown")
        offsets_s = np.array([found[camera].offset_s, *found[camera].candidates_s])
        periods = offsets_s - truth_s
        assert np.abs(periods - np.rint(periods)).max() < 0.1
        assert len(offsets_s) >= 3
    assert not all(clock.usable for clock in found.values())
    assert sync.fault_line("take jump", found).startswith("take jump: camera c1: expected")


@pytest.mark.parametrize("known", [True, False], ids=["calibrated", "uncalibrated"])
def test_a_person_who_stands_still_tells_nothing(known):
    def still(time_s):
        return sync_takes.jumper(np.zeros(len(time_s)))

    views = take(5, people=[still])
    found = camera_sync.synchronise(views, CAMERAS if known else None)
    assert {found["c1"].status, found["c2"].status} <= {"ambiguous", "unknown"}


def test_a_camera_started_too_late_is_told_how_far_was_searched():
    """Its true offset is not among those tried, so others are not worth a look."""
    clocks = [Clock(), Clock(14.0), Clock(0.5)]
    found = camera_sync.synchronise(take(0, seconds=30.0, clocks=clocks), CAMERAS, max_offset_s=8.0)
    assert (found["c1"].status, found["c2"].status) == ("unknown", "found")
    line = sync.fault_line("take", found)
    assert "those of up to 8 s" in line and "`synchronise_cameras: max_offset_s`" in line
    assert "possible offsets" not in line


@pytest.mark.parametrize("n_tracklets", [0, 1])
def test_a_camera_that_sees_nobody_is_unknown_and_the_others_are_found(n_tracklets):
    views = take(6)
    empty = np.full_like(views[1].xy, np.nan)[:n_tracklets]
    views[1] = replace(views[1], xy=empty, score=empty[..., 0])
    found = camera_sync.synchronise(views, CAMERAS)
    assert found["c1"].status == "unknown"
    assert np.isnan(found["c1"].uncertainty_s)
    assert found["c2"].status == "found"
    assert np.abs(errors_s(found["c2"], CLOCKS[2], 20.0)).max() <= 0.008


def test_dropped_frames_do_not_matter():
    views = take(7)
    kept = np.delete(np.arange(600), np.r_[100:104, 250, 251, 400:430])
    parts = {key: getattr(views[1], key)[:, kept] for key in ("xy", "score", "reason")}
    views[1] = replace(views[1], time_s=views[1].time_s[kept], **parts)
    found = camera_sync.synchronise(views, CAMERAS)
    assert np.abs(errors_s(found["c1"], CLOCKS[1], 20.0)).max() <= 0.008


def test_hardly_any_frames_are_refused():
    with pytest.raises(InputError, match="camera c0: expected 30 frames"):
        camera_sync.synchronise(take(0, seconds=0.5), CAMERAS)


def openpose(camera):
    """Return the keypoints of the person with the highest scores in each frame of a real video."""
    files = sorted((FOLDER / "openpose_body25b" / f"cam{camera.name[-1]}_json").glob("*.json"))
    rows = np.full((1, len(files), 12, 3), np.nan)
    for at, file in enumerate(files):
        people = [
            np.reshape(person["pose_keypoints_2d"], (-1, 3))
            for person in json.loads(file.read_text())["people"]
        ]
        if people:
            best = max(people, key=lambda person: person[:, 2].sum())
            rows[0, at] = best[FIRST : FIRST + 12]
    rows = np.where(rows[..., 2:] > 0, rows, np.nan)
    return keypoints_of(camera, np.arange(len(files)) / 60, rows)


def keypoints_of(camera, time_s, rows):
    xy, score = rows[..., :2], rows[..., 2]
    return keypoints_made.view(camera, sync_takes.JOINTS, time_s, xy, score=score)


def later(view, n_frames):
    """Return a view whose clock shows some frames more, on whole frames of its own."""
    rows = np.concatenate([view.xy, view.score[..., None]], axis=-1)
    source = view.time_s - n_frames / 60
    moved = np.full_like(rows, np.nan)
    for joint, part in np.ndindex(12, 3):
        moved[0, :, joint, part] = np.interp(
            source, view.time_s, rows[0, :, joint, part], left=np.nan, right=np.nan
        )
    return replace(view, xy=moved[..., :2], score=moved[..., 2])


@pytest.fixture(scope="module")
def walk():
    """Return cameras and views of the real walk: 100 frames of four cameras at 60 Hz."""
    known = file_formats.read(FOLDER / "calibration" / "Calib.qca.txt")
    cut = (0, 0, 1080, 1920)
    known = [camera_models.crop(c, cut) if c.name in ("cam01", "cam02") else c for c in known]
    return known, [openpose(camera) for camera in known]


@needs_real
def test_real_synchronised_cameras_have_no_offset(walk):
    found = camera_sync.synchronise(walk[1], walk[0])
    for camera in ("cam02", "cam03", "cam04"):
        assert found[camera].status == "found"
        assert abs(found[camera].offset_s) * 60 <= 0.5
        assert found[camera].uncertainty_s * 60 <= 0.5
        assert not found[camera].doubt


@needs_real
@pytest.mark.parametrize("at", [1, 2, 3])
def test_a_real_camera_that_is_shifted_is_found_within_a_quarter_frame(walk, at):
    known, views = walk
    views = [later(view, 3.4) if camera == at else view for camera, view in enumerate(views)]
    found = camera_sync.synchronise(views, known)
    for camera, view in enumerate(views[1:], start=1):
        truth = 3.4 if camera == at else 0.0
        assert abs(found[view.camera].offset_s * 60 - truth) <= 0.25
        assert not found[view.camera].doubt


@needs_real
def test_real_steps_alone_are_ambiguous_by_a_step(walk):
    found = camera_sync.synchronise(walk[1])
    for camera in ("cam02", "cam03", "cam04"):
        assert found[camera].status == "ambiguous"
        offsets = 60 * np.array([found[camera].offset_s, *found[camera].candidates_s])
        assert np.abs(offsets).min() <= 2  # the truth is among them
    assert not all(clock.usable for clock in found.values())


def test_the_made_up_cameras_are_those_of_the_scene():
    # The rig's pictures are taken by OpenCV's projection; the person must be in them.
    xyz = sync_takes.athlete(np.random.default_rng(0), 5.0)(np.arange(5.0))
    for camera in CAMERAS:
        xy = scene.opencv_projection(camera, xyz.reshape(-1, 3))
        assert (xy > 0).all()
        assert (xy < camera.size).all()


STEP_S = 0.1


def curves(true_s, depth, rng, count=100, also_s=(), asked=None):
    """Return a function that makes the loss of a camera at each offset, lowest at its true one.

    It adds the pairs of cameras that it is called with to the list `asked`.
    """

    def scan(a, b, lags_s):
        if asked is not None:
            asked.append((a, b))
        loss = 1 + 0.3 * rng.normal(0, 1, (count, len(lags_s)))
        for at in (true_s[b] - true_s[a], *(np.add(also_s, true_s[b] - true_s[a]))):
            loss -= depth[b] * np.exp(-0.5 * ((lags_s - at) / 0.1) ** 2)
        return loss

    return scan


def test_all_cameras_are_placed_surest_first():
    true_s, depth = [0.0, 1.3, -2.4, 0.8], [0, 0.3, 0.9, 0.6]
    asked = []
    scan = curves(true_s, depth, np.random.default_rng(0), asked=asked)
    placed = camera_sync.place(scan, 4, 4.0, STEP_S)
    assert list(placed)[:3] == [0, 2, 3]
    for camera, at in placed.items():
        assert abs(at.offset_s - true_s[camera]) <= STEP_S
        assert at.candidates_s == ()
    assert [a for a, b in asked if b == 1] == [0, 2, 3]


def test_two_equal_minima_are_both_told():
    scan = curves([0.0, 0.5], [0, 0.9], np.random.default_rng(1), also_s=(2.0,))
    at = camera_sync.place(scan, 2, 4.0, STEP_S)[1]
    found = sorted([at.offset_s, *at.candidates_s])
    np.testing.assert_allclose(found, [0.5, 2.5], atol=STEP_S)


def test_a_doubtful_camera_places_no_other():
    true_s, depth = [0.0, 1.0, 2.0], [0, 0.0, 0.8]
    asked = []
    scan = curves(true_s, depth, np.random.default_rng(2), asked=asked)
    placed = camera_sync.place(scan, 3, 4.0, STEP_S)
    assert len(placed[1].candidates_s) == camera_sync.MOST_CANDIDATES
    assert [a for a, b in asked if b == 2] == [0]


def test_what_does_not_overlap_is_not_placed():
    def scan(a, b, lags_s):
        return np.full((50, len(lags_s)), np.nan)

    assert list(camera_sync.place(scan, 2, 1.0, STEP_S)) == [0]


def test_a_little_overlap_does_not_win_by_chance():
    rng = np.random.default_rng(3)
    loss = 1 + 0.3 * rng.normal(0, 1, (100, 81))
    loss[:, 40] -= 0.5
    loss[20:, 0] = np.nan
    loss[:20, 0] = 0.45  # lower than the mean at 40, over a fifth of the times
    found = camera_sync.choose(np.arange(-40, 41) * STEP_S, {0: loss})
    assert found.offset_s == 0.0


def test_minima_keep_their_distance():
    curve = np.array([3, 1, 2, 0, 4, 5, 2, 6.0])
    assert camera_sync.minima(curve, 1) == [3, 1, 6]
    assert camera_sync.minima(curve, 2) == [3, 6]
