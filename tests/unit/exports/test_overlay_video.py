"""A video with skeletons burnt in: long, fast, large as its source, colours at joints, no faces."""

import runpy
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from courtside.exports import overlay_video
from courtside.figures.style import style
from courtside.reconstruction import camera_shake
from courtside.records.cameras.footage import Footage
from courtside.records.devices.clocks import Clock
from courtside.records.keypoints import keypoints, skeleton
from courtside.study.errors import InputError
from courtside.video import reader, writer
from fixtures.cameras import scene, shaken
from fixtures.people import walker

COLOURS = style.DETECTED_BGR, style.REPROJECTED_BGR, style.REJECTED_BGR
ROOT = Path(__file__).parents[3]
FILES = ("cameras", "pose2d", "people", "sync", "shake", "pose3d", "skeleton")
N = 12
FACE = [walker.SKELETON.index(joint) for joint in walker.SKELETON.groups["face"]]
WRIST = walker.SKELETON.index("left_wrist")


@pytest.fixture(scope="module")
def take():
    """Return camera, 2D, 3D of a walker whom each camera sees 20 px to the right of her place."""
    points = walker.points(n_frames=N)
    camera = scene.ring(3)[1]
    view = walker.views(points, [camera], offset_px=(20.0, 0.0))[0]
    return camera, view, points


def tracked(take, clock=None, **changes):
    camera, view, points = take
    view = replace(view, **changes)
    return overlay_video.track(Footage(camera, view, clock or Clock()), points, walker.SKELETON)


def grey_frames(camera, times_s, size=None):
    width, height = size or camera.size
    return [(float(time), np.full((height, width, 3), 90, np.uint8)) for time in times_s]


def drawn(take, track, hide_faces=False, frames=None):
    frames = frames or grey_frames(take[0], track.own_s)
    return list(overlay_video.pictures(frames, track, colours=COLOURS, hide_faces=hide_faces))


def test_colours_stand_at_the_joints(take):
    camera, view, points = take
    image = drawn(take, tracked(take))[7]
    true = scene.opencv_projection(camera, points.xyz[0, 7, [WRIST]])[0]
    for xy, colour in ((view.xy[0, 7, WRIST], COLOURS[0]), (true, COLOURS[1])):
        x, y = np.round(xy).astype(int)
        assert image[y, x].tolist() == list(colour)


def test_in_shaken_pictures_the_skeleton_lies_on_the_person(take):
    camera, view, points = take
    vectors = shaken.knock(camera, N, 5, 14.0, tremor_px=2)
    moved = shaken.view(replace(view, xy=view.xy - [20.0, 0.0]), camera, vectors)
    track = overlay_video.track(
        Footage(camera, moved, Clock(), turns=vectors), points, walker.SKELETON
    )
    assert np.nanmax(np.abs(track.reprojected - moved.xy)) < 0.01
    still = overlay_video.track(Footage(camera, moved, Clock()), points, walker.SKELETON)
    assert np.nanmin(np.abs(still.reprojected - moved.xy)[:, 5:, :, 0]) > 5


def test_a_view_that_was_not_used_is_joined_by_a_red_line(take):
    camera, view, points = take
    images = drawn(take, tracked(take))
    true = scene.opencv_projection(camera, points.xyz[0, 5, [7]])[0]
    x, y = np.round((true + view.xy[0, 5, 7]) / 2).astype(int)
    assert images[5][y, x].tolist() == list(
        COLOURS[2]
    )  # c1 is rejected for joint 7 in frame 5 only
    assert images[7][y, x].tolist() != list(COLOURS[2])


def test_a_joint_that_projects_far_away_is_not_joined_by_a_line(take):
    track = tracked(take)
    near = track.reprojected.copy()
    near[0, 5, 7] = np.nan
    far = track.reprojected.copy()
    far[0, 5, 7] = [3e12, -4e12]  # OpenCV takes no such coordinates
    images = [drawn(take, replace(track, reprojected=xy))[5] for xy in (near, far)]
    np.testing.assert_array_equal(*images)


def test_the_skeleton_follows_the_clock(take):
    camera, view, points = take
    clock = Clock(offset_s=0.5, drift_ppm=100.0)
    own_s = clock.from_reference(points.time_s[:-1] + 0.01)  # half a frame late
    per_frame = ("xy", "score", "reason", "xyz_in_body", "clothing")
    kept = {key: getattr(view, key)[:, :-1] for key in per_frame}
    track = tracked(take, clock, time_s=own_s, **kept)
    np.testing.assert_allclose(track.reference_s, points.time_s[:-1] + 0.01)
    middle = (points.xyz[0, 8, [WRIST]] + points.xyz[0, 9, [WRIST]]) / 2
    expected = scene.opencv_projection(camera, middle)[0]
    np.testing.assert_allclose(track.reprojected[0, 8, WRIST], expected, atol=1e-6)


def test_nothing_is_drawn_before_and_after_the_3d(take):
    _, _, points = take
    wanted = np.array([-0.5, points.time_s[0], points.time_s[-1], points.time_s[-1] + 0.5])
    found = overlay_video.between(points.time_s, points.xyz, wanted)
    assert np.isnan(found[:, [0, 3]]).all()
    np.testing.assert_allclose(found[:, 1:3], points.xyz[:, [0, -1]])


def test_faces_are_hidden_also_while_nobody_sees_them(take):
    camera, view, points = take
    xy = view.xy.copy()
    xy[:, 4:8] = np.nan
    lost = replace(points, xyz=np.full_like(points.xyz, np.nan))
    track = tracked((camera, view, lost), xy=xy)
    rng = np.random.default_rng(0)
    noise = rng.integers(0, 255, (camera.size[1], camera.size[0], 3), dtype=np.uint8)
    frames = [(float(time), noise) for time in view.time_s]
    hidden = drawn(take, track, True, frames)
    shown = drawn(take, track, False, frames)
    for at in range(N):
        x, y = np.round(view.xy[0, at, FACE].mean(axis=0)).astype(int)
        part = (slice(y - 3, y + 4), slice(x - 3, x + 4))
        assert detail(hidden[at][part]) < 0.5 * detail(noise[part]) or at not in range(4, 8)
        if at in range(4, 8):  # without hiding nothing at all is drawn there then
            np.testing.assert_array_equal(shown[at][part], noise[part])


def test_a_face_that_jumps_away_for_a_frame_stays_hidden(take):
    camera, view, points = take
    xy = view.xy.copy()
    others = [at for at in range(walker.N_JOINTS) if at not in FACE]
    xy[:, :, others] = np.nan
    xy[:, 6, FACE] += [400.0, 0.0]
    lost = replace(points, xyz=np.full_like(points.xyz, np.nan))
    track = tracked((camera, view, lost), xy=xy)
    rng = np.random.default_rng(0)
    noise = rng.integers(0, 255, (camera.size[1], camera.size[0], 3), dtype=np.uint8)
    frames = [(float(view.time_s[6]), noise)]
    pictures = overlay_video.pictures(
        frames, track, colours=COLOURS, hide_faces=True, keep_background=True
    )
    x, y = np.round(view.xy[0, 6, FACE].mean(axis=0)).astype(int)
    part = (slice(y - 20, y + 20), slice(x - 20, x + 20))
    assert detail(next(pictures)[part]) < 0.5 * detail(noise[part])


def detail(image):
    return np.abs(np.diff(image.astype(float), axis=1)).mean()


def test_nobody_in_the_background_can_be_recognised(take):
    track = tracked(take)
    rng = np.random.default_rng(0)
    noise = rng.integers(0, 255, (1080, 1920, 3), dtype=np.uint8)
    frames = [(float(track.own_s[0]), noise)]
    hidden = drawn(take, track, True, frames)[0]
    x, y = np.round(track.detected[0, 0, walker.SKELETON.index("left_ankle")]).astype(int)
    away = np.ones((1080, 1920), dtype=bool)
    for at in np.concatenate([track.detected[0, 0], track.reprojected[0, 0]])[::4]:
        away &= np.hypot(np.arange(1920) - at[0], np.arange(1080)[:, None] - at[1]) > 250
    away[:150] = False  # the caption
    assert away.mean() > 0.3
    across = np.abs(np.diff(hidden.astype(float), axis=1)).mean(axis=-1)
    assert across[away[:, 1:]].max() < 12  # of noise, whose neighbours differ by 85 on average
    beside = (slice(y - 20, y - 12), slice(x - 10, x + 10))
    assert (hidden[beside] == noise[beside]).mean() > 0.5  # sharp at the person, but for lines
    kept = overlay_video.pictures(
        frames, track, colours=COLOURS, hide_faces=True, keep_background=True
    )
    np.testing.assert_array_equal(next(kept)[away], noise[away])


def test_gaps_in_a_face_are_bridged_for_a_second():
    time_s = np.arange(40) / 10
    xy = np.stack([time_s, 2 * time_s], axis=-1)[:, None]
    seen = xy.copy()
    seen[5:12], seen[33:] = np.nan, np.nan
    seen[15:38] = np.nan
    found = overlay_video.bridged(time_s, seen)
    np.testing.assert_allclose(found[:15], xy[:15])
    np.testing.assert_allclose(found[38 - 13 : 38 - 10, 0], [[np.nan, np.nan]] * 3)
    assert np.isfinite(found[15:24]).all()
    assert np.isnan(overlay_video.bridged(time_s, np.full((40, 1, 2), np.nan))).all()


def test_the_file_is_like_its_source(take, tmp_path):
    camera, _, points = take
    source, result = tmp_path / "source.mp4", tmp_path / "overlay.mp4"
    width, height = camera.size
    frames = grey_frames(camera, points.time_s, (width // 2 * 2, height // 2 * 2))
    writer.write_video(source, (image for _, image in frames), 50, crf=18)
    pictures = overlay_video.pictures(
        reader.frames(source), tracked(take), colours=COLOURS, hide_faces=True
    )
    writer.write_video(result, pictures, reader.probe(source).rate_hz, crf=18)
    before, after = reader.probe(source), reader.probe(result)
    assert (after.n_frames, after.size, after.rate_hz) == (N, before.size, pytest.approx(50))
    np.testing.assert_allclose(reader.frame_times(result), reader.frame_times(source), atol=1e-6)
    image = reader.read_frame(result, points.time_s[7])[1].astype(float)
    x, y = np.round(take[1].xy[0, 7, WRIST]).astype(int)
    assert np.abs(image[y, x] - COLOURS[0]).max() < 60  # H.264 keeps half the colour's resolution
    assert np.abs(image[20, -20] - 90).max() < 6  # grey stays grey


@pytest.mark.parametrize("first", [0, 3])
def test_the_overlay_of_an_uneven_video_shows_each_frame_at_its_time(
    take, tmp_path, monkeypatch, first
):
    """As that of a phone which films at half its rate in the dark; also where a take is trimmed."""
    camera, view, points = take
    times_s = np.cumsum(np.r_[0, np.full(5, 0.02), np.full(6, 0.04)])
    source, result = tmp_path / "source.mp4", tmp_path / "overlay.mp4"
    pictures = (image for _, image in grey_frames(camera, times_s))
    writer.write_video(source, pictures, 33, crf=30, effort="ultrafast", times_s=times_s)
    seen = replace(view, time_s=times_s[first:], xy=view.xy[:, first:], score=view.score[:, first:])
    monkeypatch.setattr(camera_shake, "read_as_filmed", lambda *_: [Footage(camera, seen, Clock())])
    monkeypatch.setattr(keypoints, "read_3d", lambda _: points)
    monkeypatch.setattr(skeleton, "read", lambda _: walker.SKELETON)
    script = runpy.run_path(str(ROOT / "workflow" / "scripts" / "export_overlay_video.py"))
    script["main"](
        SimpleNamespace(video=source, **dict.fromkeys(FILES)),
        result,
        camera=camera.name,
        blur_faces=False,
        trim_s=[0.05, 9.0] if first else None,
        crf=30,
        effort="ultrafast",
        keep_background=True,
    )
    np.testing.assert_allclose(
        reader.frame_times(result), times_s[first:] - times_s[first], atol=1 / 90_000
    )


def test_an_odd_picture_grows_by_a_pixel(take):
    track = tracked(take)
    frames = grey_frames(take[0], track.own_s[:1], (641, 361))
    assert drawn(take, track, False, frames)[0].shape == (362, 642, 3)


def test_pictures_come_one_by_one(take):
    taken = []

    def source():
        for frame in grey_frames(take[0], take[1].time_s):
            taken.append(frame[0])
            yield frame

    made = overlay_video.pictures(source(), tracked(take), colours=COLOURS, hide_faces=False)
    next(made)
    assert len(taken) == 1


def test_a_frame_without_keypoints_stops_the_video(take):
    with pytest.raises(InputError, match=r"camera c1.*detect the pose"):
        drawn(take, tracked(take), False, grey_frames(take[0], [0.03]))


def test_persons_and_cameras_must_fit(take):
    camera, view, points = take
    with pytest.raises(ValueError, match="persons"):
        tracked((camera, replace(view, xy=view.xy[:0]), points))
    with pytest.raises(ValueError, match="cameras"):
        overlay_video.track(
            Footage(replace(camera, name="z"), view, Clock()), points, walker.SKELETON
        )
