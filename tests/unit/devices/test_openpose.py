"""OpenPose's 2D keypoints (JSON) against another program's result, every fault, people's tracks."""

import json
import runpy
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from courtside.calibration import file_formats
from courtside.devices import openpose
from courtside.exports import markers, trc
from courtside.geometry.camera import Camera, project, write_toml
from courtside.reconstruction.association import everybody
from courtside.records.cameras.footage import Footage
from courtside.records.devices.clocks import Clock
from courtside.records.keypoints import keypoints as keypoint_files
from courtside.records.keypoints import missing_reason, skeleton
from courtside.study.errors import InputError
from courtside.video import writer
from courtside.video.packets import list_packets
from fixtures.cameras import scene
from fixtures.people import walker
from fixtures.recordings import video_files
from fixtures.recordings.real_data import REAL, needs_real

SKELETONS = Path(__file__).parents[3] / "config" / "skeletons"
COCO = skeleton.read(SKELETONS / "coco17.yaml")


def keypoints(x=100.0):
    points = np.column_stack([x + 10 * np.arange(17), 50 + 20.0 * np.arange(17), np.full(17, 0.8)])
    return points.ravel().tolist()


def write(folder, name, *people):
    folder.mkdir(exist_ok=True)
    content = {"version": 1.3, "people": [{"pose_keypoints_2d": person} for person in people]}
    (folder / name).write_text(json.dumps(content))


def read(folder, joints=COCO, *, n_frames=4, **options):
    options = {"size": (640, 480), "time_s": np.arange(n_frames) / 30} | options
    return openpose.read(folder, joints, camera="left", model="theirs", **options)


def test_a_small_folder_is_read_frame_by_frame(tmp_path):
    moved = keypoints(101.0)
    moved[3:6] = [0, 0, 0]  # OpenPose's way to say unseen
    moved[6:9] = [-40, 50, 0.9]
    write(tmp_path / "j", "cam1_000000000007_keypoints.json", keypoints())
    write(tmp_path / "j", "cam1_000000000008_keypoints.json", moved)
    write(tmp_path / "j", "cam1_000000000010_keypoints.json")
    found = read(tmp_path / "j")
    assert (found.camera, found.model, found.xy.shape) == ("left", "theirs", (1, 4, 17, 2))
    assert found.joints.tolist() == list(COCO.joints)
    assert found.time_s == pytest.approx(np.arange(4) / 30)
    assert found.xy[0, 0, 2] == pytest.approx([120, 90])
    assert found.score[0, 0] == pytest.approx([0.8] * 17)
    assert found.reason[0, 1, :3].tolist() == [
        missing_reason.OK,
        missing_reason.UNSEEN,
        missing_reason.OUT_OF_IMAGE,
    ]
    assert np.isnan(found.xy[0, 1, 1:3]).all()
    assert (found.reason[0, 2:] == missing_reason.UNSEEN).all()
    assert np.isnan(found.xyz_in_body).all()


def test_frames_take_the_videos_times_and_trim(tmp_path):
    for at in range(5):
        write(tmp_path / "j", f"{at}.json", keypoints(100.0 + at))
    time_s = np.array([0, 0.03, 0.07, 0.1, 0.13, 0.17, 0.2])
    found = read(tmp_path / "j", time_s=time_s)
    assert np.array_equal(found.time_s, time_s)
    assert (found.reason[0, 5:] == missing_reason.UNSEEN).all()
    found = read(tmp_path / "j", time_s=time_s, trim_s=(0.03, 0.1))
    assert found.time_s.tolist() == [0.03, 0.07]
    assert found.xy[0, :, 0, 0].tolist() == [101, 102]
    with pytest.raises(InputError, match=r"at most 3 frames.* found 5 files numbered 0 to 4;"):
        read(tmp_path / "j", time_s=time_s[:3])
    with pytest.raises(InputError, match=r"from 3 s to before 4 s \(trim_s.* from 0 to 0.20 s;"):
        read(tmp_path / "j", time_s=time_s, trim_s=(3.0, 4.0))


def write_numbers(folder, numbers):
    """Write a file for each number; the first point lies at that many px beyond 100."""
    for number in numbers:
        write(folder, f"take_{number:012d}_keypoints.json", keypoints(100.0 + number))


def test_numbers_within_the_video_are_those_of_its_frames(tmp_path, caplog):
    write_numbers(tmp_path / "later", range(5, 40))
    found = read(tmp_path / "later", n_frames=40)
    assert np.isnan(found.xy[0, :5]).all()
    assert found.xy[0, 5:, 0, 0] == pytest.approx(np.arange(105, 140))
    assert "35 files for 40 frames; taken as frames 5 to 39" in caplog.text
    write_numbers(tmp_path / "second", range(0, 40, 2))
    found = read(tmp_path / "second", n_frames=40)
    assert found.xy[0, ::2, 0, 0] == pytest.approx(np.arange(100, 140, 2))
    assert np.isnan(found.xy[0, 1::2]).all()
    assert "20 files for 40 frames; taken as frames 0 to 38" in caplog.text


def test_numbers_that_reach_over_the_whole_video_may_begin_anywhere(tmp_path):
    write_numbers(tmp_path / "j", range(5, 45))
    found = read(tmp_path / "j", n_frames=40)
    assert found.xy[0, :, 0, 0] == pytest.approx(np.arange(105, 145))


@pytest.mark.parametrize(
    ("numbers", "message"),
    [
        (range(20), "20 numbered 0 to 19, as of every second frame; number the files"),
        (range(1, 15), "14 numbered 1 to 14, as of every third frame; number the files"),
        (range(50, 70), "0 to 39 or a file for each, found 20 files numbered 50 to 69;"),
        (range(42), "at most 40 frames.* found 42 files numbered 0 to 41;"),
    ],
)
def test_numbers_that_do_not_say_the_frame_are_refused(tmp_path, numbers, message):
    write_numbers(tmp_path / "j", numbers)
    with pytest.raises(InputError, match=message):
        read(tmp_path / "j", n_frames=40)


def test_the_script_counts_the_frames_of_the_whole_video(tmp_path):
    """With trim_s the files still count from the video's first frame."""
    writer.write_video(tmp_path / "v.mp4", [np.zeros((480, 640, 3), np.uint8)] * 12, 10.0, crf=30)
    write_numbers(tmp_path / "j", range(12))
    script = runpy.run_path(str(SKELETONS.parents[1] / "workflow/scripts/import_pose2d.py"))
    paths = SimpleNamespace(
        folder=tmp_path / "j", video=tmp_path / "v.mp4", skeleton=SKELETONS / "coco17.yaml"
    )
    out, trim_s = tmp_path / "p.npz", (0.3, 0.6)
    script["main"](paths, out, camera="left", model="theirs", trim_s=trim_s)
    found = keypoint_files.read_2d(out)
    assert found.time_s == pytest.approx([0.3, 0.4, 0.5])
    assert found.size.tolist() == [640, 480]
    alone = SimpleNamespace(**vars(paths) | {"video": [], "cameras": tmp_path / "cameras.toml"})
    camera = Camera("left", (640, 480), np.diag([500.0, 500, 1]), np.zeros(5), np.eye(3, 4))
    write_toml(alone.cameras, [camera], source="test")
    given = {"folders": {"left": tmp_path / "j"}, "rate_hz": 10.0, "trim_s": trim_s}
    script["main"](alone, out, camera="left", model="theirs", **given)
    unfilmed = keypoint_files.read_2d(out)
    assert unfilmed.time_s == pytest.approx(found.time_s)
    assert unfilmed.size.tolist() == [640, 480]
    assert np.array_equal(unfilmed.xy, found.xy)
    pictures = [np.zeros((96, 128, 3), np.uint8)] * 12
    writer.write_video(tmp_path / "small.mp4", pictures, 10.0, crf=30)
    small = SimpleNamespace(**vars(paths) | {"video": tmp_path / "small.mp4"})
    with pytest.raises(
        InputError, match=r"within the 128x96 px of .*small\.mp4, found 84% outside"
    ):
        script["main"](small, out, camera="left", model="theirs", trim_s=trim_s)
    with pytest.raises(InputError, match="correct trim_s"):
        script["main"](paths, out, camera="left", model="theirs", trim_s=(2.0, 3.0))


def test_the_script_takes_a_video_that_was_cut_after_the_trimmed_part(tmp_path):
    fast = {"movflags": "faststart"}  # the index stands before the pictures
    how = {"n": 40, "rate": 10, "size": (640, 480), "container": fast}
    whole = video_files.write(tmp_path / "whole.mp4", **how)
    video = tmp_path / "v.mp4"
    video.write_bytes(whole.read_bytes()[: int(0.8 * whole.stat().st_size)])
    n_frames = len(list_packets(video, stop_s=1.0).pts)
    assert 10 < n_frames < 40
    write_numbers(tmp_path / "j", range(n_frames))
    script = runpy.run_path(str(SKELETONS.parents[1] / "workflow/scripts/import_pose2d.py"))
    paths = SimpleNamespace(folder=tmp_path / "j", video=video, skeleton=SKELETONS / "coco17.yaml")
    how, out = {"camera": "left", "model": "theirs"}, tmp_path / "p.npz"
    script["main"](paths, out, trim_s=(0.3, 0.6), **how)
    assert keypoint_files.read_2d(out).time_s == pytest.approx([0.3, 0.4, 0.5])
    with pytest.raises(InputError, match="trim the take"):
        script["main"](paths, out, trim_s=None, **how)


def test_one_file_more_than_frames_is_left_out(tmp_path, caplog):
    write_numbers(tmp_path / "j", range(41))
    found = read(tmp_path / "j", n_frames=40)
    assert found.xy[0, :, 0, 0] == pytest.approx(np.arange(100, 140))
    assert "41 files for 40 frames; taken in their order, the last one, number 40" in caplog.text


def test_without_a_video_frames_are_counted_from_the_first_number(tmp_path):
    write_numbers(tmp_path / "j", range(7, 10))
    found = read(tmp_path / "j", n_frames=5, first=6)
    assert np.isfinite(found.score[0, :, 0]).tolist() == [False, True, True, True, False]
    assert found.xy[0, 1:4, 0, 0].tolist() == [107, 108, 109]
    with pytest.raises(InputError, match=r"within the 120x480 px that .* found 88% outside, up to"):
        read(tmp_path / "j", n_frames=5, first=6, size=(120, 480))


def test_points_of_larger_pictures_than_the_videos_are_refused(tmp_path):
    write_numbers(tmp_path / "j", range(4))
    says = r"/j: expected points within the 130x180 px of hall/cam1.mp4, found 8\d% outside, up to"
    with pytest.raises(InputError, match=says):
        read(tmp_path / "j", size=(130, 180), video="hall/cam1.mp4")


@pytest.mark.parametrize(
    ("name", "count"), [("coco17", 17), ("halpe26", 26), ("coco133", 133), ("body25", 25)]
)
def test_skeletons_are_found_by_their_points(tmp_path, name, count):
    write(tmp_path / "j", "0.json")
    write(tmp_path / "j", "1.json", np.tile([5.0, 9.0, 0.8], count).tolist())
    n_points, names = openpose.skeletons(tmp_path / "j")
    assert (n_points, name in names, len(names)) == (count, True, 1 + (count == 25))


def test_a_sample_shows_points_of_the_named_skeleton(tmp_path):
    for at in range(100):
        write(tmp_path / "j", f"{at}.json", keypoints(100.0 + at))
    found = openpose.sample(tmp_path / "j", COCO)
    assert found.shape == (34, 17, 3)
    assert found[:, 0, 0].tolist() == list(range(100, 200, 3))
    halpe = skeleton.read(SKELETONS / "halpe26.yaml")
    with pytest.raises(InputError, match="expected 26 points of skeleton halpe26, found 17;"):
        openpose.sample(tmp_path / "j", halpe)
    body25 = np.zeros((25, 3))
    body25[[8, 9, 12]] = [[50, 50, 0.9], [45, 50, 0.9], [55, 50, 0.9]]
    body25[0] = [50, 0, 0.9]
    write(tmp_path / "k", "0.json", body25.ravel().tolist())
    assert len(openpose.sample(tmp_path / "k", skeleton.read(SKELETONS / "body25.yaml"))) == 1
    with pytest.raises(InputError, match="expected the points of body25b, found what looks like"):
        openpose.sample(tmp_path / "k", skeleton.read(SKELETONS / "body25b.yaml"))


@pytest.mark.parametrize(("size", "least"), [((640, 480), "0.1"), ((320, 240), "-0.7")])
def test_points_as_shares_of_the_picture_are_refused(tmp_path, size, least):
    """OpenPose writes them from 0 to 1 and from -1 to 1 with `keypoint_scale` 3 and 4."""
    shares = np.array(keypoints()).reshape(-1, 3) / [*size, 1] - [*([size == (320, 240)] * 2), 0]
    for at in range(4):
        write(tmp_path / "j", f"{at}.json", shares.ravel().tolist())
    for look in (read, openpose.sample):
        with pytest.raises(InputError, match=rf"/j: expected points in px, found all from {least}"):
            look(tmp_path / "j", COCO)


def test_points_of_no_skeleton_are_named(tmp_path):
    write(tmp_path / "j", "0.json", [1.0] * 21)
    with pytest.raises(InputError, match="expected people with 17, 25, 26, 133 points, found 7;"):
        openpose.skeletons(tmp_path / "j")
    write(tmp_path / "k", "0.json")
    with pytest.raises(InputError, match="points, found nobody;"):
        openpose.skeletons(tmp_path / "k")
    assert openpose.is_one(tmp_path / "k" / "0.json")
    for text in ("{", "[1]", '{"people": 1}'):
        (tmp_path / "k" / "1.json").write_text(text)
        assert not openpose.is_one(tmp_path / "k" / "1.json")


@pytest.mark.parametrize(("count", "known"), [(17, True), (26, True), (133, True), (18, False)])
def test_points_of_alphapose_are_read_if_all_are_there(tmp_path, count, known):
    """`AlphaPose_to_OpenPose` copies those of the network; `--format open` always writes 18."""
    person = np.random.default_rng(0).uniform(1, 400, (count, 3)) * [1, 1, 1 / 400]
    for at in range(3):
        write(tmp_path / "j", f"{at:05d}.json", person.ravel().tolist())
    if known:
        assert openpose.skeletons(tmp_path / "j")[0] == count
    else:
        with pytest.raises(InputError, match=r"found 18; see config/README.md, Keypoints of other"):
            openpose.skeletons(tmp_path / "j")


def test_unlimited_scores_keep_their_ratios(tmp_path, caplog):
    """RTMW's scores reach 5 and more (Tau-J/rtmlib#42); cut at 1, most joints would be certain."""
    caplog.set_level("INFO")
    person = np.reshape(keypoints(), (17, 3))
    person[:, 2] = np.linspace(0.4, 5.0, 17)
    for name in ("0.json", "1.json"):
        write(tmp_path / "j", name, person.ravel().tolist())
    score = read(tmp_path / "j").score[0, 0]
    assert np.allclose(score[:15] / score[0], person[:15, 2] / 0.4)
    assert score.max() == 1 and score[14] < 1
    assert "scores are not limited to 1" in caplog.text


def test_scores_above_one_are_one(tmp_path):
    high = keypoints()
    high[2] = 1.7
    write(tmp_path / "j", "0.json", high)
    assert read(tmp_path / "j").score[0, 0, 0] == 1


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{", "expected OpenPose's JSON"),
        ("[]", "expected OpenPose's JSON"),
        ('{"people": [{}]}', "pose_keypoints_2d"),
        ('{"people": [{"pose_keypoints_2d": ["a"]}]}', "expected OpenPose's JSON"),
        (
            '{"people": [{"pose_keypoints_2d": [1, 2, 3]}]}',
            "17 points of skeleton coco17, found 1;",
        ),
        ('{"people": [{"pose_keypoints_2d": [[1, 2, 3]]}]}', "17 points of skeleton coco17"),
    ],
)
def test_a_damaged_file_is_named(tmp_path, text, message):
    write(tmp_path / "j", "0.json", keypoints())
    (tmp_path / "j" / "1.json").write_text(text)
    with pytest.raises(InputError, match=message) as caught:
        read(tmp_path / "j")
    assert str(caught.value).startswith(f"{tmp_path}/j/1.json: ")
    assert "\n" not in str(caught.value)


def test_other_folders_are_refused(tmp_path):
    with pytest.raises(InputError, match="found none; correct the path"):
        read(tmp_path / "nowhere")
    (tmp_path / "j").mkdir()
    with pytest.raises(InputError, match="give the folder of one camera"):
        read(tmp_path / "j")
    write(tmp_path / "j", "a_1.json", keypoints())
    write(tmp_path / "j", "b_1.json", keypoints())
    with pytest.raises(InputError, match=r"one file for frame 1, found a_1\.json as well"):
        read(tmp_path / "j")
    write(tmp_path / "k", "frame.json", keypoints())
    with pytest.raises(InputError, match="frame's number"):
        read(tmp_path / "k")


@pytest.mark.parametrize("name", ["body25", "body25b"])
def test_25_points_in_the_other_order_are_recognised(tmp_path, name):
    """A standing person's points by name, written in each order."""
    heights = {"eye": 40, "ear": 42, "nose": 50, "head_top": 0, "neck": 90, "shoulder": 95}
    heights |= {"elbow": 150, "wrist": 200, "hip": 205, "mid_hip": 205, "knee": 300, "ankle": 390}
    heights |= {"heel": 400, "big_toe": 402, "small_toe": 401}
    joints = skeleton.read(SKELETONS / f"{name}.yaml")
    row = []
    for joint in joints.joints:
        side, _, part = joint.partition("_")
        sign = {"left": 1, "right": -1}.get(side, 0)
        row += [300 + 30.0 * sign, 20.0 + heights[part if sign else joint], 0.9]
    write(tmp_path / "j", "0.json", row)
    assert read(tmp_path / "j", joints, n_frames=1).xy.shape == (1, 1, 25, 2)
    assert openpose.skeletons(tmp_path / "j")[1][0] == name
    other = {"body25": "body25b", "body25b": "body25"}[name]
    with pytest.raises(InputError, match=f"points of {other}, found what looks like {name},"):
        read(tmp_path / "j", skeleton.read(SKELETONS / f"{other}.yaml"))


@needs_real
@pytest.mark.parametrize("number", [1, 2, 3, 4])
def test_real_keypoints_lie_where_another_program_puts_the_joints(number):
    """Pose2Sim's TRC markers, projected into the picture, are near the person's keypoints."""
    real = REAL / "walk-4cams"
    joints = skeleton.read(SKELETONS / "body25b.yaml")
    folder = real / "openpose_body25b" / f"cam{number}_json"
    found = read(folder, joints, size=(1088, 1920), n_frames=100)
    assert found.xy.shape[1:] == (100, 25, 2)
    names, _, _, xyz = trc.read(real / "trc" / "Balancing_for_IK.trc")
    camera = {c.name: c for c in file_formats.read(real / "calibration" / "Calib.qca.txt")}
    places = markers.joints_of(names, joints.joints)
    assert sum(place is not None for place in places) == 21
    off = {
        joint: np.linalg.norm(
            found.xy[0, :, at] - project(camera[f"cam0{number}"], xyz[:, place]), axis=-1
        )
        for at, (joint, place) in enumerate(zip(joints.joints, places, strict=True))
        if place is not None
    }
    assert np.nanmedian(list(off.values())) < 22  # px; the person is 750 px tall
    assert max(np.nanmedian(error) for error in off.values()) < 60
    with pytest.raises(InputError, match="looks like body25b"):
        read(folder, replace(joints, name="body25"), size=(1088, 1920), n_frames=100)


def person(x, y=100.0, seen=6):
    """Return six points of a person 200 px tall, the first `seen` of them seen."""
    found = np.column_stack([x + 20.0 * np.arange(6), y + 40.0 * np.arange(6), np.full(6, 0.9)])
    found[seen:] = np.nan
    return found


def stack(*persons):
    return np.array(persons).reshape(-1, 6, 3)


def test_persons_are_followed_whatever_their_order():
    rng = np.random.default_rng(0)
    left, right = 100 + 3.0 * np.arange(40), 900 - 4.0 * np.arange(40)
    people = []
    for a, b in zip(left, right, strict=True):
        both = [person(a), person(b, 120)]
        people.append(stack(*(both if rng.random() < 0.5 else both[::-1])))
    first = people[0][0, 0, 0]
    tracks = openpose.link(people)
    assert tracks.shape == (2, 40, 6, 3)
    order = (left, right) if first == left[0] else (right, left)
    for track, x in zip(tracks, order, strict=True):
        assert np.array_equal(track[:, 0, 0], x)


def test_a_gap_is_bridged_but_not_for_ever():
    people = [stack(person(100.0 + at)) for at in range(20)]
    people[5:9] = [stack()] * 4
    tracks = openpose.link(people)
    assert len(tracks) == 1
    assert np.isnan(tracks[0, 5:9]).all()
    assert np.isfinite(tracks[0, 9:, 0, 0]).all()
    people[9:] = [stack(person(900.0))] * 11
    assert len(openpose.link(people)) == 2  # somebody else, for the row is not yet free
    people[5:16] = [stack()] * 11
    track = openpose.link(people)[0]  # whoever comes after a long gap begins a tracklet in a row
    assert track[16:, 0, 0].tolist() == [900.0] * 4


def test_rows_are_as_many_as_people_at_once_however_long_the_take():
    """A row for each tracklet: an hour with 150 of them would need 40 GB."""
    people = []
    for visit in range(40):  # one stays; another one comes and goes, to a place of its own
        both = [person(100.0), person(500.0 + 100 * (visit % 3))]
        people += [stack(*both)] * 30 + [stack(both[0])] * (openpose.LONGEST_GAP + 1)
    rows = openpose.link(people)
    assert len(rows) == 2
    assert np.isfinite(rows[:, :, 0, 0]).sum(axis=1).tolist() == [len(people), 40 * 30]
    seen = rows[1, ::41, 0, 0]
    assert seen.tolist() == [500.0 + 100 * (visit % 3) for visit in range(40)]


def test_persons_of_very_few_frames_are_left_out_of_a_long_take(caplog):
    """Each track fills an array over the whole take: false detections filled the memory."""
    caplog.set_level("INFO", logger="courtside")
    people = [stack(person(100.0 + 0.1 * at)) for at in range(600)]
    for start, n_frames in ((100, 4), (200, 1), (300, 5)):
        for at in range(start, start + n_frames):
            people[at] = stack(people[at][0], person(900.0))
    tracks = openpose.link(people)
    assert np.isfinite(tracks[:, :, 0, 0]).sum(axis=1).tolist() == [600, 5]
    assert np.array_equal(tracks[0, :, 0, 0], 100.0 + 0.1 * np.arange(600))
    assert caplog.messages == ["2 persons seen in fewer than 5 frames are left out"]
    assert len(openpose.link(people[190:210])) == 2  # a short take: one frame is much of it


def test_somebody_elsewhere_is_somebody_else():
    people = [stack(person(100.0)), stack(person(170.0 + 200))]
    tracks = openpose.link(people)
    assert len(tracks) == 2
    assert np.isfinite(tracks[:, :, 0, 0]).tolist() == [[True, False], [False, True]]


def test_the_nearest_pairing_wins_over_the_first():
    """Taken one after the other, the first person would take the track that the second needs."""
    people = [stack(person(100.0), person(150.0)), stack(person(140.0), person(95.0))]
    tracks = openpose.link(people)
    assert tracks[:, 1, 0, 0].tolist() == [95.0, 140.0]


def test_points_that_only_one_frame_has_do_not_count():
    other = person(100.0)
    other[:3] = np.nan
    tracks = openpose.link([stack(person(100.0, seen=4)), stack(other)])
    assert len(tracks) == 1  # the fourth point tells
    other[3] = np.nan
    assert len(openpose.link([stack(person(100.0, seen=4)), stack(other)])) == 2


def test_frames_without_people_give_one_track_without_points():
    tracks = openpose.link([stack(), stack()])
    assert tracks.shape == (1, 2, 6, 3)
    assert np.isnan(tracks).all()


def test_a_folder_in_which_nobody_is_seen_takes_part_in_a_take(tmp_path):
    record, cameras = walker.points(n_frames=40), scene.ring(3)
    for at in range(40):
        write(tmp_path / "c2", f"{at}.json")
    views = walker.views(record, cameras)
    empty = openpose.read(
        tmp_path / "c2",
        walker.SKELETON,
        camera="c2",
        model=record.model,
        size=cameras[2].size,
        time_s=record.time_s,
    )
    footage = [
        Footage(camera, view, Clock())
        for camera, view in zip(cameras, (*views[:2], empty), strict=True)
    ]
    found, _ = everybody.find(footage, walker.SKELETON, None)
    shown = replace(footage[2], people=found).view
    assert shown.xy.shape == (1, 40, walker.N_JOINTS, 2)
    assert np.isnan(shown.xy).all()
