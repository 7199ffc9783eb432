"""C3D read back by ezc3d and by the bytes of its header."""

import struct
from dataclasses import replace

import ezc3d
import numpy as np
import pytest

import walker
from courtside.exports import c3d
from courtside.study.errors import InputError


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


def test_residuals_are_deviations_and_minus_one_where_missing(written):
    _, path = written
    residual = ezc3d.c3d(str(path))["data"]["meta_points"]["residuals"][0].T
    assert residual[3, 4] == -1
    present = np.delete(residual.ravel(), 3 * 33 + 4)
    # sqrt of the mean of 1, 4 and 9 square centimetres
    np.testing.assert_allclose(present, 10 * np.sqrt(14 / 3), rtol=0.05)


def test_the_header_counts_from_one(written):
    _, path = written
    header = path.read_bytes()[:24]
    n_points, first, last = struct.unpack_from("<H", header, 2) + struct.unpack_from(
        "<HH", header, 6
    )
    assert (header[1], n_points, first, last) == (0x50, 33, 1, 20)


def test_the_same_record_gives_the_same_bytes(written, tmp_path):
    record, path = written
    c3d.write(tmp_path / "again.c3d", record, 0)
    assert (tmp_path / "again.c3d").read_bytes() == path.read_bytes()


def test_a_take_too_long_for_the_format_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(c3d, "MOST_FRAMES", 19)
    with pytest.raises(InputError, match="at most 19 frames"):
        c3d.write(tmp_path / "long.c3d", replace(walker.points()), 0)
    assert list(tmp_path.iterdir()) == []
