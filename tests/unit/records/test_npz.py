"""npz files that hold what they say, or are refused."""

import zipfile
from dataclasses import dataclass
from typing import Annotated

import numpy as np
import pytest
from numpy.typing import NDArray

from courtside.records import npz
from courtside.study.errors import InputError

SPEC = {
    "name": ("str", ()),
    "x": ("float", ("T", "2")),
    "ok": ("bool", ("T",)),
    "n": ("int", ("T",)),
}
GOOD = {"name": "a", "x": np.zeros((3, 2)), "ok": np.ones(3, bool), "n": np.arange(3)}


@dataclass
class Kept:
    name: str
    x: Annotated[NDArray, "float T 2"]
    ok: Annotated[NDArray, "bool T"]
    n: Annotated[NDArray, "int T"]


@pytest.fixture
def path(tmp_path):
    npz.write(tmp_path / "f.npz", "test 1", SPEC, GOOD)
    return tmp_path / "f.npz"


def test_the_round_trip_keeps_everything(path):
    found = npz.read(path, "test 1", SPEC)
    assert set(found) == set(GOOD)
    for key, value in GOOD.items():
        np.testing.assert_array_equal(found[key], value)


def test_a_record_states_its_own_spec(path):
    assert npz.spec_of(Kept) == SPEC
    found = npz.read_record(path, "test 1", Kept)
    assert found.name == "a" and type(found.name) is str
    np.testing.assert_array_equal(found.n, GOOD["n"])


def test_a_record_is_checked_when_written(path):
    npz.write_record(path, "test 1", Kept(**GOOD))
    with pytest.raises(ValueError, match=r"n: expected int, found float"):
        npz.write_record(path, "test 1", Kept(**GOOD | {"n": np.zeros(3)}))


def test_the_same_arrays_give_the_same_bytes(path, tmp_path):
    npz.write(tmp_path / "g.npz", "test 1", SPEC, GOOD)
    assert (tmp_path / "g.npz").read_bytes() == path.read_bytes()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"x": np.zeros((3, 3))}, r"x: expected shape .* found \(3, 3\)"),
        ({"x": np.zeros((4, 2))}, r"ok: expected shape .* found \(3,\)"),  # x says that T is 4
        ({"x": np.zeros(3)}, r"x: expected shape .* found \(3,\)"),
        ({"x": np.zeros((3, 2), int)}, "x: expected float, found int"),
        ({"extra": np.zeros(1)}, "expected keys .* found .*extra"),
        ({"n": np.array([None, None, None])}, "n: expected int, found object"),
    ],
)
def test_other_arrays_are_not_written(tmp_path, change, message):
    with pytest.raises(ValueError, match=message):
        npz.write(tmp_path / "f.npz", "test 1", SPEC, GOOD | change)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("share", [0.0, 0.2, 0.7, 0.99])
def test_a_cut_off_file_is_one_line(path, share):
    content = path.read_bytes()
    path.write_bytes(content[: int(share * len(content))])
    with pytest.raises(InputError, match=r"f\.npz: expected an npz file") as caught:
        npz.read(path, "test 1", SPEC)
    assert "\n" not in str(caught.value)


def test_another_format_is_named(path):
    with pytest.raises(InputError, match="expected format 'test 2', found 'test 1'"):
        npz.read(path, "test 2", SPEC)


def test_other_keys_are_named(path):
    with pytest.raises(InputError, match="make it again"):
        npz.read(path, "test 1", {**SPEC, "y": ("float", ("T",))})


def test_pickled_objects_are_refused(tmp_path):
    np.savez(tmp_path / "f.npz", format=np.array("test 1"), x=np.array([{"a": 1}], dtype=object))
    with pytest.raises(InputError, match="expected an npz file"):
        npz.read(tmp_path / "f.npz", "test 1", SPEC)


def test_any_changed_byte_is_refused_or_changes_nothing(path):
    content = path.read_bytes()
    n_refused = 0
    for at in range(len(content)):
        path.write_bytes(content[:at] + bytes([content[at] ^ 0xFF]) + content[at + 1 :])
        try:
            found = npz.read(path, "test 1", SPEC)
        except InputError as error:
            n_refused += 1
            assert "\n" not in str(error)
            continue
        for key, value in GOOD.items():
            np.testing.assert_array_equal(found[key], value)
    assert n_refused > len(content) / 2


def test_files_of_other_kinds_are_refused(tmp_path):
    np.save(tmp_path / "array.npy", np.zeros(3))
    (tmp_path / "text.npz").write_text("no arrays")
    with zipfile.ZipFile(tmp_path / "zip.npz", "w") as archive:
        archive.writestr("x.txt", "no array")
    for name in ("array.npy", "text.npz", "zip.npz", "none.npz"):
        with pytest.raises(InputError, match=name) as caught:
            npz.read(tmp_path / name, "test 1", SPEC)
        assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("key", "rule"), [("x", ("int", ("T", "2"))), ("x", ("float", ("T", "3"))), ("n", ("int", ()))]
)
def test_arrays_that_are_not_as_stated_are_not_read(path, key, rule):
    with pytest.raises(InputError, match=rf"f\.npz: {key}: expected .*; make it again"):
        npz.read(path, "test 1", SPEC | {key: rule})


def test_a_failed_write_leaves_the_old_file(path, monkeypatch):
    def half(stream, **_):
        stream.write(b"half")
        raise OSError("disk full")

    before = path.read_bytes()
    monkeypatch.setattr(np, "savez_compressed", half)
    with pytest.raises(OSError, match="disk full"):
        npz.write(path, "test 1", SPEC, GOOD)
    assert path.read_bytes() == before
    assert list(path.parent.iterdir()) == [path]


def test_no_date_enters_the_file(path):
    with zipfile.ZipFile(path) as archive:
        assert {info.date_time for info in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}


def test_numpy_alone_reads_the_file(path):
    with np.load(path, allow_pickle=False) as found:
        assert str(found["format"]) == "test 1"
        np.testing.assert_array_equal(found["n"], GOOD["n"])


def test_a_member_that_is_no_array_is_named(tmp_path, path):
    with zipfile.ZipFile(path, "a") as archive:
        archive.writestr("n.txt", "3")
    with pytest.raises(InputError, match=r"\.npz: expected keys .*n\.txt"):
        npz.read(path, "test 1", SPEC)
    with zipfile.ZipFile(tmp_path / "b.npz", "w") as archive:
        for name in ("format", *SPEC):
            archive.writestr(f"{name}.npy", "no array")
    with pytest.raises(InputError, match=r"b\.npz: expected format"):
        npz.read(tmp_path / "b.npz", "test 1", SPEC)


@pytest.mark.parametrize("times", [[0.0, 0.0], [1.0, 0.5], [0.0, np.nan]])
def test_times_that_do_not_increase_are_refused(tmp_path, times):
    spec = {"time_s": ("float", ("T",))}
    with pytest.raises(ValueError, match="time_s: expected times that increase"):
        npz.write(tmp_path / "a.npz", "test 1", spec, {"time_s": times})
    np.savez(tmp_path / "b.npz", format="test 1", time_s=times)
    with pytest.raises(InputError, match="time_s: expected times that increase"):
        npz.read(tmp_path / "b.npz", "test 1", spec)
