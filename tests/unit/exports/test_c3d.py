"""C3D read back by ezc3d and by the bytes of its header."""

import struct
from dataclasses import replace

import ezc3d
import numpy as np
import pytest

from courtside.exports import c3d
from courtside.records.keypoints.keypoints import unknown_errors
from courtside.study.errors import InputError
from fixtures.people import walker
from fixtures.study.small_disk import limited_to


@pytest.fixture
def written(tmp_path):
    record = walker.points()
    c3d.write(tmp_path / "walk.c3d", record, 0)
    return record, tmp_path / "walk.c3d"


def test_points_are_world_millimetres(written):
    record, path = written
    found = ezc3d.c3d(str(path))["data"]["points"][:3].transpose(2, 1, 0)
    np.testing.assert_allclose(found, 1000 * record.xyz[0], atol=1e-3)


def test_parameters_say_units_rate_and_labels(written):
    record, path = written
    point = ezc3d.c3d(str(path))["parameters"]["POINT"]
    assert point["UNITS"]["value"] == ["mm"]
    assert point["RATE"]["value"] == pytest.approx([50])
    assert point["LABELS"]["value"] == record.joints.tolist()
    assert (point["X_SCREEN"]["value"], point["Y_SCREEN"]["value"]) == (["+X"], ["+Z"])


def test_the_header_counts_from_one(written):
    _, path = written
    header = path.read_bytes()[:24]
    n_points, first, last = struct.unpack_from("<H", header, 2) + struct.unpack_from(
        "<HH", header, 6
    )
    assert (header[1], n_points, first, last) == (0x50, 33, 1, 20)


@pytest.mark.parametrize(
    ("start_s", "first"),
    [(60.0, 3001), (0.031, 3), (0.0, 1), (-0.412, 1), (1310.2, 65511), (1310.4, 1)],
)
def test_frames_have_the_numbers_of_their_times(tmp_path, start_s, first):
    record = walker.points(n_frames=25)
    record = replace(record, time_s=record.time_s - record.time_s[0] + start_s)
    c3d.write(tmp_path / "walk.c3d", record, 0)
    numbers = struct.unpack_from("<HH", (tmp_path / "walk.c3d").read_bytes(), 6)
    assert numbers == (first, first + 24)
    found = ezc3d.c3d(str(tmp_path / "walk.c3d"))
    header = found["header"]["points"]
    assert (header["first_frame"], header["last_frame"]) == (first - 1, first + 23)
    assert found["parameters"]["POINT"]["START_S"]["value"] == pytest.approx([start_s])
    assert found["data"]["points"].shape == (4, 33, 25)


def test_the_same_record_gives_the_same_bytes(written, tmp_path):
    record, path = written
    c3d.write(tmp_path / "again.c3d", record, 0)
    assert (tmp_path / "again.c3d").read_bytes() == path.read_bytes()


def fourth_words(path, n_points, n_frames):
    """Return (T, J, 4) as the bytes of a file with floating-point data have them."""
    content = path.read_bytes()
    block, scale = (
        struct.unpack_from("<H", content, 16)[0],
        struct.unpack_from("<f", content, 12)[0],
    )
    assert scale == -1  # floating-point data, residuals in POINT:UNITS
    count = n_points * n_frames * 4
    found = np.frombuffer(content, "<f4", count, (block - 1) * 512)
    return found.reshape(n_frames, n_points, 4)


def test_the_bytes_hold_the_points_frame_by_frame(written):
    record, path = written
    found = fourth_words(path, 33, 20)
    missing = np.isnan(record.xyz[0]).any(axis=-1)
    np.testing.assert_allclose(found[..., :3][~missing], 1000 * record.xyz[0][~missing], atol=1e-3)
    assert (found[..., 3][missing] == -1).all()
    assert (found[..., 3][~missing] >= 0).all()
    assert struct.unpack_from("<f", path.read_bytes(), 20)[0] == 50


def bytes_of(words):
    """Return residual and cameras of fourth words, as the format has them: an integer's bytes."""
    whole = words.astype(np.int16)
    assert (whole == words).all()
    return whole & 0xFF, whole >> 8


def test_residuals_are_deviations_and_minus_one_where_missing(written):
    _, path = written
    words = fourth_words(path, 33, 20)[..., 3]
    assert words[3, 4] == -1
    residual_mm, cameras = bytes_of(np.delete(words.ravel(), 3 * 33 + 4))
    # sqrt of the mean of 1, 4 and 9 square centimetres
    assert (residual_mm == round(10 * np.sqrt(14 / 3))).all()
    assert (cameras == 0).all()


@pytest.mark.parametrize(("sd_m", "residual_mm"), [(0.02, 20), (0.127, 127), (0.2, 127), (9, 127)])
def test_a_large_deviation_neither_wraps_nor_looks_missing(tmp_path, sd_m, residual_mm):
    record = walker.points()
    covariance = np.broadcast_to(np.eye(3) * sd_m**2, record.covariance_2d.shape)
    path = tmp_path / "f.c3d"
    c3d.write(path, replace(record, covariance_2d=covariance), 0)
    assert bytes_of(fourth_words(path, 33, 20)[0, 0, 3]) == (residual_mm, 0)


def test_an_unknown_deviation_is_zero(tmp_path):
    record = walker.points()
    unknown = np.full_like(record.covariance_2d, np.nan)
    c3d.write(tmp_path / "f.c3d", replace(record, covariance_2d=unknown), 0)
    found = fourth_words(tmp_path / "f.c3d", 33, 20)[..., 3]
    np.testing.assert_array_equal(found, np.where(np.isnan(record.xyz[0, ..., 0]), -1, 0))


def test_another_reader_finds_residuals_and_missing_points(written):
    peer = pytest.importorskip("c3d", reason="needs `pip install c3d`")
    record, path = written
    with path.open("rb") as stream:
        found = np.array([points for _, points, _ in peer.Reader(stream).read_frames()])
    missing = np.isnan(record.xyz[0]).any(axis=-1)
    assert (found[..., 3] == np.where(missing, -1, 22)).all()
    np.testing.assert_allclose(found[..., :3][~missing], 1000 * record.xyz[0][~missing], atol=1e-3)


def one_joint(n_frames):
    return replace(
        walker.points(),
        joints=np.array(["nose"]),
        time_s=np.arange(n_frames) / 50,
        xyz=np.zeros((1, n_frames, 1, 3)),
        **unknown_errors(np.zeros((1, n_frames, 1, 3))),
    )


def test_frames_that_the_header_counts_need_no_other_number(tmp_path):
    path = tmp_path / "long.c3d"
    c3d.write(path, one_joint(65535), 0)
    assert struct.unpack_from("<HH", path.read_bytes(), 6) == (1, 65535)
    found = ezc3d.c3d(str(path))
    assert found["data"]["points"].shape == (4, 1, 65535)
    assert "LONG_FRAMES" not in found["parameters"]["POINT"]


def test_more_frames_than_the_header_counts_are_written_with_their_number(tmp_path, caplog):
    path, record = tmp_path / "long.c3d", one_joint(70001)
    record.xyz[0, :, 0, 0] = np.arange(70001) / 1000
    c3d.write(path, record, 0)
    words = fourth_words(path, 1, 70001)
    np.testing.assert_array_equal(words[:, 0, 0], np.arange(70001))
    assert (words[..., 3] == 0).all()
    assert struct.unpack_from("<HH", path.read_bytes(), 6) == (1, 65535)
    point = ezc3d.c3d(str(path))["parameters"]["POINT"]
    assert point["LONG_FRAMES"]["value"] == 70001
    assert point["FRAMES"]["value"] == 65535
    assert "see the first 65535 alone: give them the TRC file" in caplog.text


def test_another_reader_finds_more_frames_than_the_header_counts(tmp_path):
    peer = pytest.importorskip("c3d", reason="needs `pip install c3d`")
    record = one_joint(70001)
    record.xyz[0, :, 0, 0] = np.arange(70001) / 1000
    c3d.write(tmp_path / "long.c3d", record, 0)
    with (tmp_path / "long.c3d").open("rb") as stream:
        found = [points[0, 0] for _, points, _ in peer.Reader(stream).read_frames()]
    assert found == list(range(70001))


@pytest.mark.parametrize(
    ("place_m", "error_mm"), [((8.0, 12.0), None), ((12e3, 16e3), None), ((691e3, 5336e3), 256)]
)
def test_places_that_the_format_rounds_by_over_a_millimetre_are_told(
    tmp_path, caplog, place_m, error_mm
):
    record = one_joint(300)
    record.xyz[0, :, 0, :2] = place_m + np.random.default_rng(0).random((300, 2))
    record.xyz[0, 7] = np.nan
    c3d.write(tmp_path / "far.c3d", record, 0)
    told = [line for line in caplog.messages if "mm off" in line]
    assert len(told) == (error_mm is not None)
    if error_mm:
        stated = int(told[0].split(" mm off")[0].rsplit(" ")[-1])
        assert 0.9 * error_mm < stated <= error_mm


def test_one_frame_has_no_rate(tmp_path):
    with pytest.raises(InputError, match=r"at least 2 .* found 1; change `trim_s`"):
        c3d.write(tmp_path / "f.c3d", one_joint(1), 0)
    assert list(tmp_path.iterdir()) == []


def test_every_joint_has_a_label_of_its_own(written):
    labels = ezc3d.c3d(str(written[1]))["parameters"]["POINT"]["LABELS"]["value"]
    assert len(set(labels)) == len(labels) == 33


@pytest.mark.parametrize("missing", [1, 200, 4000, 12799, None])
def test_a_file_that_the_disk_cuts_short_is_refused(written, tmp_path, missing):
    record, path = written
    whole = path.stat().st_size
    room = 0 if missing is None else whole - missing
    with limited_to(room), pytest.raises(InputError, match="a file that is not whole: free"):
        c3d.write(tmp_path / "cut.c3d", record, 0)
    assert [each.name for each in tmp_path.iterdir()] == ["walk.c3d"]
    with limited_to(whole):
        c3d.write(tmp_path / "fits.c3d", record, 0)
