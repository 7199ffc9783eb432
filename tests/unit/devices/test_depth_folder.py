import shutil

import cv2
import numpy as np
import pytest

from courtside.devices import depth_folder
from courtside.geometry import camera
from courtside.study.errors import InputError
from courtside.video import writer
from fixtures.recordings.depth_recordings_made import PLACED

RNG = np.random.default_rng(2)
N = 5
DEPTHS = RNG.integers(0, 65536, (N, 24, 32), dtype=np.uint16)
GREYS = (40, 80, 120, 160, 200)
IN_DEVICE = np.column_stack([np.eye(3), [0.3, -0.2, 0.1]])  # both cameras, in some common frame


def write(folder):
    depth = camera.Camera(
        "depth", (32, 24), [[25, 0, 15], [0, 25, 11], [0, 0, 1]], np.zeros(5), IN_DEVICE
    )
    placed = np.column_stack([PLACED[:, :3], PLACED[:, :3] @ IN_DEVICE[:, 3] + PLACED[:, 3]])
    colour = camera.Camera(
        "colour", (48, 32), [[40, 0, 23], [0, 41, 15], [0, 0, 1]], [0.1, 0, 0, 0, 0], placed
    )
    camera.write_toml(folder / "cameras.toml", [colour, depth], source="test")
    with (folder / "cameras.toml").open("a") as stream:
        stream.write("depth_unit_m = 0.0005\nbaseline_m = 0.05\n")
    pictures = [np.full((32, 48, 3), grey, np.uint8) for grey in GREYS]
    writer.write_video(folder / "colour.mp4", pictures, 30, crf=10)
    (folder / "depth").mkdir()
    for k, steps in enumerate(DEPTHS):
        cv2.imwrite(str(folder / "depth" / f"{k:04}.png"), steps)


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("made")
    write(folder)
    return folder


@pytest.fixture
def folder(made, tmp_path):
    return shutil.copytree(made, tmp_path / "recording")


def test_a_folder_is_read(folder):
    found = depth_folder.read(folder, "cam")
    assert (found.depth_unit_m, found.baseline_m, found.remarks) == (0.0005, 0.05, ())
    assert np.allclose(found.colour_from_depth, PLACED)
    assert found.colour.dist[0] == 0.1
    depth, colour = list(found.depth_frames()), list(found.colour_frames())
    assert np.array_equal([steps for _, steps in depth], DEPTHS)
    assert np.allclose([time_s for time_s, _ in depth], np.arange(N) / 30, atol=1e-4)
    assert [time_s for time_s, _ in colour] == [time_s for time_s, _ in depth]
    assert (
        np.abs([image.mean() - grey for (_, image), grey in zip(colour, GREYS, strict=True)]).max()
        < 3
    )
    assert (np.diff(found.colour_index().number) == 1).all()


def test_files_that_macos_adds_are_no_pictures(folder):
    (folder / "depth" / "._0000.png").write_bytes(b"\x00\x05")
    assert len(list(depth_folder.read(folder).depth_frames())) == N


def test_depth_pictures_are_ordered_by_the_value_of_their_numbers(folder):
    for k, name in enumerate(("0", "2", "9", "10", "11")):
        (folder / "depth" / f"{k:04}.png").rename(folder / "depth" / f"{name}.png")
    found = [steps for _, steps in depth_folder.read(folder).depth_frames()]
    assert np.array_equal(found, DEPTHS)


def named(folder, names):
    for k, name in enumerate(names):
        (folder / "depth" / f"{k:04}.png").rename(folder / "depth" / f"{name}.png")
    return depth_folder.read(folder)


@pytest.mark.parametrize("last", ["18.0", "18"])
def test_times_as_names_without_zeros_at_the_end_are_told(folder, last):
    """As `f"{time.time()}.png"` writes them: pictures of another time would be taken."""
    with pytest.raises(InputError) as raised:
        named(folder, ("17.4666667", "17.5", "17.5333333", "17.5666667", last))
    assert "depth: expected names whose order is clear" in str(raised.value)
    assert "17.5.png and 17.4666667.png; number the pictures" in str(raised.value)


@pytest.mark.parametrize(
    "names",
    [
        ("17.466667", "17.500000", "17.533333", "17.566667", "18.000000"),
        ("rec1.8", "rec1.9", "rec1.10", "rec1.11", "rec1.12"),
        ("10.15.59.900", "10.15.59.933", "10.15.59.967", "10.16.00.000", "10.16.00.033"),
    ],
    ids=["all digits", "numbers of one take", "times of day"],
)
def test_names_with_a_point_whose_order_is_clear_are_read(folder, names):
    found = [steps for _, steps in named(folder, names).depth_frames()]
    assert np.array_equal(found, DEPTHS)


def test_frame_times_come_from_the_tables(folder):
    (folder / "colour.csv").write_text("number,time_s\n7,1.0\n8,1.1\n9,1.2\n11,1.4\n12,1.5\n")
    (folder / "depth.csv").write_text("number,time_s\n7,1.01\n8,1.11\n10,1.31\n11,1.41\n")
    (folder / "depth" / "0004.png").unlink()
    found = depth_folder.read(folder)
    assert [time_s for time_s, _ in found.depth_frames()] == [1.01, 1.11, 1.31, 1.41]
    assert [time_s for time_s, _ in found.colour_frames()] == [1.0, 1.1, 1.2, 1.4, 1.5]
    assert found.colour_index().number.tolist() == [7, 8, 9, 11, 12]


def test_the_default_unit_is_remarked(folder):
    toml = folder / "cameras.toml"
    toml.write_text(toml.read_text().replace("depth_unit_m = 0.0005\n", ""))
    found = depth_folder.read(folder)
    assert found.depth_unit_m == 0.001
    assert "0.001 m assumed" in found.remarks[0]


def test_a_folder_is_known_by_its_names_also_if_it_is_not_complete(folder, tmp_path):
    assert depth_folder.is_one(folder)
    (folder / "cameras.toml").rename(tmp_path / "cameras.toml")
    assert depth_folder.is_one(folder) and not depth_folder.is_one(tmp_path / "none")
    (folder / "colour.mp4").unlink()
    assert not depth_folder.is_one(folder)
    (tmp_path / "cameras.toml").rename(folder / "cameras.toml")
    assert depth_folder.is_one(folder)
    (folder / "cameras.toml").write_text("[left]\nname = 'left'\n")
    assert not depth_folder.is_one(folder)
    (folder / "cameras.toml").write_bytes(b"\xff\xfe")
    assert not depth_folder.is_one(folder)


def unlink(name):
    return lambda folder: (folder / name).unlink()


def text(name, old, new):
    def change(folder):
        path = folder / name
        path.write_text(path.read_text().replace(old, new))

    return change


def table(name, content):
    def change(folder):
        for other in ("colour.csv", "depth.csv"):
            rows = "".join(f"{k},{k / 10}\n" for k in range(N))
            (folder / other).write_text(f"number,time_s\n{rows}")
        (folder / name).write_text(content)

    return change


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (unlink("cameras.toml"), "expected cameras.toml"),
        (unlink("colour.mp4"), "expected one video"),
        (unlink("depth/0002.png"), "as many depth pictures"),
        (lambda folder: shutil.rmtree(folder / "depth"), "expected 16-bit PNG"),
        (text("cameras.toml", '"depth"', '"ir"'), "named colour and depth"),
        (text("cameras.toml", "0.0005", "5"), r"depth unit of .* units in \[meta"),
        (text("cameras.toml", "0.0005", '"mm"'), "depth_unit_m as"),
        (text("cameras.toml", "48", "64"), "expected 64x32 px"),
        (lambda folder: (folder / "colour.csv").write_text("number,time_s\n"), "found one"),
        (table("depth.csv", "number,time_s\n0,0\n1,1\n"), "expected 5 rows"),
        (table("depth.csv", "number,time_s\n0,0\n1,1\n2,2\n3,2\n4,4\n"), "rising"),
        (table("depth.csv", "number\n0\n"), "expected columns number"),
        (table("depth.csv", "number,time_s\n0,a\n1,1\n2,2\n3,3\n4,4\n"), "expected columns number"),
    ],
)
def test_what_is_missing_is_named_in_one_line(folder, change, says):
    change(folder)
    with pytest.raises(InputError, match=says) as raised:
        depth_folder.read(folder)
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize(
    ("picture", "says"),
    [
        (
            np.zeros((24, 32), np.uint8),
            r"0003\.png: .* 16-bit .* one channel, found uint8, channels: 1",
        ),
        (np.zeros((24, 32, 3), np.uint16), r"0003\.png: .* found uint16, channels: 3; export"),
        (np.zeros((24, 30), np.uint16), r"0003\.png: expected 32x24 px, .* found 30x24; correct"),
        (None, r"0003\.png: expected a 16-bit picture"),
    ],
)
def test_a_picture_that_is_no_depth_is_named(folder, picture, says):
    path = folder / "depth" / "0003.png"
    if picture is None:
        path.write_bytes(b"no picture")
    else:
        cv2.imwrite(str(path), picture)
    with pytest.raises(InputError, match=says):
        list(depth_folder.read(folder).depth_frames())


def test_times_in_milliseconds_are_told(folder):
    rows = "".join(f"{k},{33.3 * k}\n" for k in range(N))
    for name in ("colour.csv", "depth.csv"):
        (folder / name).write_text(f"number,time_s\n{rows}")
    with pytest.raises(InputError, match=r"colour\.csv: .* every 33\.3 s; write time_s in seconds"):
        depth_folder.read(folder)


def test_cameras_in_another_unit_are_told(folder):
    toml = folder / "cameras.toml"
    toml.write_text(toml.read_text().replace("    0.3185", "    318.5"))
    with pytest.raises(InputError, match=r"cameras\.toml: .* at most 1 m apart, found 318 m"):
        depth_folder.read(folder)


def test_metadata_that_are_no_table_are_named(folder):
    toml = folder / "cameras.toml"
    head, _, _ = toml.read_text().partition("[metadata]")
    toml.write_text('metadata = "m"\n' + head)
    with pytest.raises(InputError, match=r"cameras\.toml: expected a table \[metadata\], found m"):
        depth_folder.read(folder)
