"""TRC written here, read by pandas and by ourselves; a TRC of another program read the same."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from courtside.exports import trc
from courtside.study.errors import InputError
from fixtures.people import walker
from fixtures.recordings.real_data import REAL, needs_real


def by_pandas(path):
    """Return (T, J, 3) as the file has them, by an independent reader."""
    table = pd.read_csv(path, sep="\t", skiprows=5, header=None).dropna(axis=1, how="all")
    return table.to_numpy()


@pytest.fixture
def written(tmp_path):
    record = walker.points()
    trc.write(tmp_path / "walk.trc", record, 0)
    return record, tmp_path / "walk.trc"


def test_axes_are_the_worlds_y_z_x(written):
    record, path = written
    found = by_pandas(path)[:, 2:].reshape(20, -1, 3)
    np.testing.assert_allclose(found, record.xyz[0][..., [1, 2, 0]], atol=1e-6)


def test_the_axis_map_stays_right_handed():
    assert np.linalg.det(np.eye(3)[trc.WORLD_AXES]) == pytest.approx(1)
    assert np.array(trc.WORLD_AXES)[trc.TRC_AXES].tolist() == [0, 1, 2]


def test_header_is_the_one_other_programs_expect(written):
    _, path = written
    lines = path.read_text().split("\n")
    assert lines[0] == "PathFileType\t4\t(X/Y/Z)\twalk.trc"
    names, values = lines[1].split("\t"), lines[2].split("\t")
    header = dict(zip(names, values, strict=True))
    assert header["DataRate"] == "50"
    assert (header["NumFrames"], header["NumMarkers"], header["Units"]) == ("20", "33", "m")
    assert lines[3].startswith("Frame#\tTime\tnose\t\t\tleft_eye_inner\t\t\t")
    assert lines[4].startswith("\t\tX1\tY1\tZ1\tX2")
    assert lines[5] == ""
    assert lines[6].startswith("1\t0.000000\t")


def test_missing_values_are_blank(written):
    _, path = written
    cells = path.read_text().split("\n")[6 + 3].split("\t")
    assert cells[2 + 3 * 4 : 5 + 3 * 4] == ["", "", ""]
    assert all(cells[: 2 + 3 * 4])


def test_no_line_ends_in_a_blank_which_opensim_refuses(tmp_path):
    record = walker.points()
    record.xyz[0, 4] = np.nan  # a frame without any marker, and one without the last
    record.xyz[0, 7, -1] = np.nan
    trc.write(tmp_path / "walk.trc", record, 0)
    rows = (tmp_path / "walk.trc").read_text().splitlines()[6:]
    assert {len(row.rstrip("\t").split("\t")) for row in rows} == {2 + 3 * 33}
    np.testing.assert_allclose(trc.read(tmp_path / "walk.trc")[3], record.xyz[0], atol=1e-6)
    np.testing.assert_array_equal(np.isnan(by_pandas(tmp_path / "walk.trc")[4, 2:]), True)


def test_the_round_trip_keeps_micrometres(written):
    record, path = written
    joints, rate_hz, time_s, xyz = trc.read(path)
    assert joints == record.joints.tolist()
    assert rate_hz == 50
    np.testing.assert_allclose(time_s, record.time_s, atol=1e-6)
    np.testing.assert_allclose(xyz, record.xyz[0], atol=1e-6)


@needs_real
def test_another_programs_file_reads_as_pandas_reads_it():
    path = REAL / "walk-4cams" / "trc" / "Balancing_for_IK.trc"
    joints, rate_hz, _, xyz = trc.read(path)
    assert (len(joints), rate_hz, xyz.shape) == (21, 60, (100, 21, 3))
    np.testing.assert_allclose(xyz[..., [1, 2, 0]].reshape(100, -1), by_pandas(path)[:, 2:65])


def test_millimetres_become_metres(written, tmp_path):
    _, path = written
    other = tmp_path / "mm.trc"
    other.write_text(path.read_text().replace("\tm\t", "\tmm\t"))
    np.testing.assert_allclose(trc.read(other)[3], trc.read(path)[3] / 1000)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("\tm\t", "\tinch\t", "Units"),
        ("DataRate", "Rate", "expected a TRC file"),
        ("1\t0.000000\t", "1\t0.000000\tx", "line 7: expected numbers"),
        ("\n1\t0.000000\t", "\n1\t0.000000\t1\t2\t3\t", "line 7: expected 101 values"),
        (
            "\n2\t0.020000\t",
            "\n2\t\t",
            r"frames 0.02 s apart, .* found 0 and nan s from frame 1 on",
        ),
        ("\n3\t0.040000\t", "\n3\t0.020000\t", "found 0.02 and 0.02 s from frame 2 on"),
        ("\n3\t0.040000\t", "\n3\t0.010000\t", "found 0.02 and 0.01 s from frame 2 on"),
        ("\n3\t0.040000\t", "\n3\t0.055000\t", "found 0.02 and 0.055 s from frame 2 on"),
        ("\n50\t", "\n101\t", r"as DataRate \(101\) says"),
        ("\n50\t", "\n0\t", "found: a DataRate of 0"),
    ],
)
def test_a_damaged_file_is_one_line(written, tmp_path, old, new, message):
    _, path = written
    text = path.read_text()
    assert old in text
    bad = tmp_path / "bad.trc"
    bad.write_text(text.replace(old, new, 1))
    with pytest.raises(InputError, match=message) as caught:
        trc.read(bad)
    assert "\n" not in str(caught.value)


def test_a_known_point_stands_where_it_should(tmp_path):
    record = walker.points()
    xyz = record.xyz.copy()
    xyz[0, 0, 0] = (1.0, 2.0, 3.0)  # x, y and height in the world
    trc.write(tmp_path / "f.trc", replace(record, xyz=xyz), 0)
    assert by_pandas(tmp_path / "f.trc")[0, 2:5].tolist() == [2.0, 3.0, 1.0]
    assert by_pandas(tmp_path / "f.trc")[:, 0].tolist() == list(range(1, 21))


@needs_real
def test_the_header_is_laid_out_as_in_another_programs_file(written):
    _, path = written
    theirs = (REAL / "walk-4cams" / "trc" / "Balancing_for_IK.trc").read_text().splitlines()
    ours = path.read_text().splitlines()
    assert ours[0].split("\t")[:3] == theirs[0].split("\t")[:3]
    assert ours[1].split("\t") == theirs[1].split("\t")
    assert len(ours[2].split("\t")) == len(theirs[2].split("\t"))
    for lines, n_markers in ((ours, 33), (theirs, 21)):
        names = lines[3].rstrip("\t").split("\t")
        assert names[:2] == ["Frame#", "Time"]
        assert [bool(name) for name in names[2:]] == ([True, False, False] * n_markers)[:-2]
        axes = lines[4].rstrip("\t").split("\t")
        assert axes == ["", "", *(f"{a}{n + 1}" for n in range(n_markers) for a in "XYZ")]


@pytest.mark.parametrize("share", [0.0, 0.02, 0.1, 0.5, 0.9])
def test_a_cut_off_file_is_one_line(written, tmp_path, share):
    text = written[1].read_text()
    (tmp_path / "cut.trc").write_text(text[: int(share * len(text))])
    with pytest.raises(InputError, match=r"cut\.trc") as caught:
        trc.read(tmp_path / "cut.trc")
    assert "\n" not in str(caught.value)


def test_a_missing_or_binary_file_is_one_line(tmp_path):
    (tmp_path / "b.trc").write_bytes(bytes(range(256)))
    for name in ("none.trc", "b.trc"):
        with pytest.raises(InputError, match="expected a TRC file") as caught:
            trc.read(tmp_path / name)
        assert "\n" not in str(caught.value)


def test_one_frame_has_no_rate(tmp_path):
    record = walker.points()
    one = replace(record, time_s=record.time_s[:1], xyz=record.xyz[:, :1])
    with pytest.raises(InputError, match=r"at least 2 frames .* found 1; change `trim_s`"):
        trc.write(tmp_path / "f.trc", one, 0)
    assert list(tmp_path.iterdir()) == []
