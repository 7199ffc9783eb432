"""npz files that hold what they say, or are refused."""

import numpy as np
import pytest

from courtside.records import npz
from courtside.study.errors import InputError

SPEC = {
    "name": ("str", ()),
    "x": ("float", ("T", "2")),
    "ok": ("bool", ("T",)),
    "n": ("int", ("T",)),
}
GOOD = {"name": "a", "x": np.zeros((3, 2)), "ok": np.ones(3, bool), "n": np.arange(3)}


@pytest.fixture
def path(tmp_path):
    npz.write(tmp_path / "f.npz", "test 1", SPEC, GOOD)
    return tmp_path / "f.npz"


def test_the_round_trip_keeps_everything(path):
    found = npz.read(path, "test 1", SPEC)
    assert set(found) == set(GOOD)
    for key, value in GOOD.items():
        np.testing.assert_array_equal(found[key], value)


def test_the_same_arrays_give_the_same_bytes(path, tmp_path):
    npz.write(tmp_path / "g.npz", "test 1", SPEC, GOOD)
    assert (tmp_path / "g.npz").read_bytes() == path.read_bytes()


@pytest.mark.parametrize(
    "change",
    [
        {"x": np.zeros((3, 3))},
        {"x": np.zeros((4, 2))},
        {"x": np.zeros(3)},
        {"x": np.zeros((3, 2), int)},
        {"extra": np.zeros(1)},
        {"n": np.array([None, None, None])},
    ],
)
def test_other_arrays_are_not_written(tmp_path, change):
    with pytest.raises(ValueError, match="expected"):
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
