"""Models that COLMAP wrote are complete; cut, longer or miscounted ones are refused."""

import struct

import pytest

from courtside.sfm import model, model_files
from courtside.study.errors import InputError
from fixtures.cameras import sfm_made

NAMES = [f"{name}.bin" for name in model_files.RECORDS]


@pytest.fixture
def folder(tmp_path):
    made = sfm_made.synthetic(tmp_path / "m.db", n_points=15, n_images=3)
    (tmp_path / "model").mkdir()
    made.write_binary(str(tmp_path / "model"))
    return tmp_path / "model"


def test_what_colmap_wrote_is_whole(folder):
    assert {path.name for path in folder.iterdir()} == set(NAMES)
    model_files.check(folder)


@pytest.mark.parametrize("name", NAMES)
def test_a_cut_or_longer_file_is_refused(folder, name):
    whole = (folder / name).read_bytes()
    for cut in (*range(0, len(whole), max(len(whole) // 40, 1)), len(whole) - 1):
        (folder / name).write_bytes(whole[:cut])
        with pytest.raises((ValueError, OSError), match=name):
            model_files.check(folder)
    (folder / name).write_bytes(whole + b"\0")
    with pytest.raises(ValueError, match=f"{name} of {len(whole) + 1} bytes, not {len(whole)}"):
        model_files.check(folder)


@pytest.mark.parametrize("name", NAMES)
def test_a_count_beyond_the_end_is_refused_at_once(folder, name):
    whole = (folder / name).read_bytes()
    (folder / name).write_bytes(struct.pack("<Q", 1 << 62) + whole[8:])
    with pytest.raises(
        InputError, match=rf"model: expected a COLMAP model, found: {name} that ends"
    ):
        model.read(folder)


def test_a_missing_file_and_another_lens_are_refused(folder):
    content = bytearray((folder / "cameras.bin").read_bytes())
    content[12:16] = struct.pack("<i", 2)
    (folder / "cameras.bin").write_bytes(content)
    with pytest.raises(InputError, match="another lens than OPENCV"):
        model.read(folder)
    (folder / "rigs.bin").unlink()
    (folder / "cameras.bin").unlink()
    with pytest.raises(InputError, match=r"cameras\.bin"):
        model.read(folder)
