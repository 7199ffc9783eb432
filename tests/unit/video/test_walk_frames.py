"""Frames of walks: which are taken from a video, photos in order and upright, bad photos named."""

import shutil

import cv2
import numpy as np
import pytest

from courtside.study.errors import InputError
from courtside.video import walk_frames
from fixtures.recordings import video_files
from fixtures.recordings.real_data import REAL, needs_real

SIZE = (160, 120)


@pytest.fixture(scope="module")
def clip(tmp_path_factory):
    path = tmp_path_factory.mktemp("walk") / "walk.mp4"
    video_files.write(str(path), n=20, rate=10)
    return path


def photo(folder, name, number, size=SIZE):
    path = folder / name
    assert cv2.imwrite(str(path), video_files.draw(number, size))
    return path


def numbers(found):
    return [video_files.number_in(image) for _, _, image in found]


@pytest.mark.parametrize(
    ("grid", "expected"),
    [
        ({"every_frame": 1}, list(range(20))),
        ({"every_frame": 6}, [0, 6, 12, 18]),
        ({"every_s": 0.5}, [0, 5, 10, 15]),
    ],
)
def test_a_video_gives_its_frames_on_the_grid(clip, grid, expected):
    found = list(walk_frames.frames(clip, **grid))
    assert [frame_idx for frame_idx, _, _ in found] == expected == numbers(found)
    np.testing.assert_allclose([time_s for _, time_s, _ in found], np.array(expected) / 10)


@pytest.mark.parametrize("grid", [{}, {"every_s": 1, "every_frame": 1}, {"every_frame": 0}])
def test_a_video_wants_one_grid(clip, grid):
    with pytest.raises(ValueError, match="one of every_s and every_frame"):
        list(walk_frames.frames(clip, **grid))


def test_photos_come_in_name_order_numbers_by_value(tmp_path):
    for name, number in [("p10.jpg", 3), ("p9.png", 2), ("p1.JPG", 1), ("q1.jpg", 4)]:
        photo(tmp_path, name, number)
    (tmp_path / "notes.txt").write_text("not a photo")
    (tmp_path / ".hidden.jpg").write_bytes(b"")
    found = list(walk_frames.frames(tmp_path, every_s=0.2))
    assert numbers(found) == [1, 2, 3, 4]
    assert [frame_idx for frame_idx, _, _ in found] == [0, 1, 2, 3]
    assert all(np.isnan(time_s) for _, time_s, _ in found)
    listed = [tmp_path / name for name in ("q1.jpg", "p1.JPG")]
    assert numbers(walk_frames.frames(listed)) == [1, 4]
    assert numbers(walk_frames.frames(str(tmp_path / "p9.png"))) == [2]


def test_a_list_of_one_is_that_one(clip, tmp_path):
    photo(tmp_path, "a.jpg", 7)
    assert numbers(walk_frames.frames([tmp_path])) == [7]
    assert numbers(walk_frames.frames([clip], every_frame=10)) == [0, 10]


def test_extracted_files_are_the_frames(clip, tmp_path):
    table, small = walk_frames.extract(walk_frames.frames(clip, every_frame=8), tmp_path)
    assert table["name"].tolist() == ["000000.png", "000008.png", "000016.png"]
    assert sorted(path.name for path in tmp_path.iterdir()) == table["name"].tolist()
    for name, (_, _, image) in zip(
        table["name"], walk_frames.frames(clip, every_frame=8), strict=True
    ):
        np.testing.assert_array_equal(cv2.imread(str(tmp_path / name)), image)
    assert [image.shape for image in small] == [(120, 160)] * 3
    assert (table["sharpness"] > 0).all() and (table["photo"] == "").all()


def test_extracted_photos_keep_their_own_names_in_the_table(tmp_path):
    for at, name in enumerate(("IMG_10.jpg", "IMG_9.jpg")):
        photo(tmp_path, name, at)
    paths = walk_frames.photo_paths(tmp_path)
    table, _ = walk_frames.extract(walk_frames.frames(tmp_path), tmp_path / "out", paths)
    assert table["name"].tolist() == ["000000.png", "000001.png"]
    assert table["photo"].tolist() == ["IMG_9.jpg", "IMG_10.jpg"]


def test_small_pictures_are_averages(tmp_path):
    image = np.random.default_rng(0).integers(0, 256, (360, 640), dtype=np.uint8)
    _, small = walk_frames.extract([(0, 0.0, np.dstack([image] * 3))], tmp_path)
    expected = image.reshape(180, 2, 320, 2).mean(axis=(1, 3))
    np.testing.assert_allclose(small[0], expected, atol=0.51)


@pytest.mark.parametrize(
    ("n", "expected"), [(5, [0, 5, 10, 14, 19]), (2, [0, 19]), (99, range(20))]
)
def test_static_pictures_are_spread_over_the_recording(clip, n, expected):
    found = [video_files.number_in(image) for image in walk_frames.spread(clip, n)]
    assert np.abs(np.array(found) - list(expected)).max() <= (1 if n == 5 else 0)
    assert (found[0], found[-1]) == (0, 19)


def test_only_frames_of_the_trimmed_part_are_looked_at(clip):
    found = [video_files.number_in(one) for one in walk_frames.spread(clip, 3, trim_s=(0.5, 1.0))]
    assert found == [5, 7, 9]
    with pytest.raises(InputError, match="expected frames from 3 s to before 4 s, found none"):
        walk_frames.spread(clip, 3, trim_s=(3, 4))


def test_a_file_that_is_cut_behind_the_trimmed_part_is_read(tmp_path):
    path = tmp_path / "long.mkv"
    video_files.write(str(path), n=120, rate=30)
    content = path.read_bytes()
    path.write_bytes(content[: int(len(content) * 0.8)])
    with pytest.raises(InputError, match="breaks off"):
        walk_frames.spread(path, 3)
    found = walk_frames.spread(path, 3, trim_s=(0, 1))
    assert [video_files.number_in(image) for image in found] == [0, 14, 29]


def test_static_photos_are_spread_too(tmp_path):
    for number in range(5):
        photo(tmp_path, f"{number}.png", number)
    assert [video_files.number_in(image) for image in walk_frames.spread(tmp_path, 3)] == [0, 2, 4]


def test_photos_of_two_sizes_name_the_file_and_both(tmp_path):
    photo(tmp_path, "a.jpg", 1)
    path = photo(tmp_path, "b.jpg", 2, (120, 160))
    message = f"{path}: expected 160x120 pixels as in a.jpg, found 120x160: take all photos"
    for read in (
        lambda: list(walk_frames.frames(tmp_path)),
        lambda: walk_frames.spread(tmp_path, 2),
    ):
        with pytest.raises(InputError) as caught:
            read()
        assert str(caught.value).startswith(message) and "\n" not in str(caught.value)


@pytest.mark.parametrize("suffix", [".jpg", ".png"])
@pytest.mark.parametrize("share", [0, 0.5, 0.99])
def test_photos_cut_short_are_named(tmp_path, suffix, share):
    path = photo(tmp_path, f"a{suffix}", 1, (640, 480))
    walk_frames.read_photo(path)
    data = path.read_bytes()
    path.write_bytes(data[: int(share * len(data))])
    with pytest.raises(
        InputError, match=r"a\.(jpg|png): expected a photo, found .*; copy it again"
    ):
        list(walk_frames.frames(tmp_path))


def test_an_end_inside_a_thumbnail_is_not_the_end(tmp_path):
    path = photo(tmp_path, "a.jpg", 1, (640, 480))
    data = path.read_bytes()
    extra = b"Exif\0\0" + data[:40] + b"\xff\xd9"
    with_thumbnail = data[:2] + b"\xff\xe1" + (len(extra) + 2).to_bytes(2, "big") + extra + data[2:]
    path.write_bytes(with_thumbnail)
    assert walk_frames.read_photo(path).shape == (480, 640, 3)
    path.write_bytes(with_thumbnail[:-100])
    with pytest.raises(InputError, match="cut short"):
        walk_frames.read_photo(path)


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("a.HEIC", r"a\.HEIC: .* convert all to \.jpg"),
        ("a.txt", "expected photos as .* found none"),
    ],
)
def test_folders_without_readable_photos_are_said(tmp_path, name, message):
    (tmp_path / name).write_bytes(b"x")
    with pytest.raises(InputError, match=message):
        list(walk_frames.frames(tmp_path))


def test_a_missing_photo_and_a_black_one_are_named(tmp_path):
    with pytest.raises(InputError, match=r"gone\.jpg: expected a photo, found no file"):
        list(walk_frames.frames([tmp_path / "gone.jpg", tmp_path / "gone2.jpg"]))
    cv2.imwrite(str(tmp_path / "dark.png"), np.full((60, 80, 3), 8, np.uint8))
    with pytest.raises(InputError, match=r"dark\.png: .* 100 % of it black"):
        list(walk_frames.frames(tmp_path))


@needs_real
def test_real_photos_stand_upright(tmp_path):
    source = REAL / "sfm-door" / "images"
    for name in ("DSC_0001.JPG", "DSC_0002.JPG"):
        shutil.copy(source / name, tmp_path / name)
    found = list(walk_frames.frames(tmp_path))
    assert [image.shape for _, _, image in found] == [(1936, 1296, 3)] * 2
