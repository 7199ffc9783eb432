"""Tables of checksums: what two machines made is compared without either machine's files."""

import pytest

from courtside.study.errors import InputError
from courtside.study.provenance import stage_checksums

FILES = {
    "virtual/gym/walk.mp4": b"film",
    "gym/sfm/features.db": b"features",
    "gym/sfm/global-n12-o0/points3D.bin": b"model",
    "gym/sfm/global-n12-o0/ties.npz": b"ties",
    "gym/calibration/sfm-n12/cameras.toml": b"cameras",
}


def results(folder, **changed):
    for name, content in {**FILES, **changed}.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(content)
    return stage_checksums.measure(folder)


def test_a_table_reads_as_it_was_written_in_the_order_of_the_stages(tmp_path):
    rows = results(tmp_path / "results")
    stage_checksums.write(tmp_path / "table.csv", rows)
    assert stage_checksums.read(tmp_path / "table.csv") == rows
    written = (tmp_path / "table.csv").read_text().splitlines()[1:]
    assert [line.split(",")[1] for line in written] == [
        "virtual/gym/walk.mp4",
        "gym/sfm/features.db",
        "gym/sfm/global-n12-o0/points3D.bin",
        "gym/sfm/global-n12-o0/ties.npz",
        "gym/calibration/sfm-n12/cameras.toml",
    ]


def test_the_first_stage_whose_bytes_differ_is_named(tmp_path):
    here = results(tmp_path / "here")
    changed = {"gym/sfm/features.db": b"other", "gym/calibration/sfm-n12/cameras.toml": b"others"}
    there = results(tmp_path / "there", **changed)
    lines, n_different = stage_checksums.table(here, there)
    assert n_different == 2
    assert lines[-1] == "first stage with other bytes: features"
    assert stage_checksums.table(here, here)[0][-1] == "first stage with other bytes: none"


def test_a_file_that_one_side_lacks_counts_as_different(tmp_path):
    here, there = results(tmp_path / "here"), results(tmp_path / "there")
    del there["virtual/gym/walk.mp4"]
    lines, n_different = stage_checksums.table(here, there)
    assert n_different == 1
    assert ["films", "0", "0", "1", "0"] in [line.split() for line in lines]


def test_another_table_is_refused_in_one_line(tmp_path):
    (tmp_path / "other.csv").write_text("camera,error_cm\nleft,1.0\n")
    with pytest.raises(
        InputError, match="expected columns stage, name, bytes, sha256, found camera"
    ):
        stage_checksums.read(tmp_path / "other.csv")


@pytest.mark.parametrize(
    "content", [None, b"stage,name,bytes,sha256\nfilms,a.mp4,many,00\n", b"\xff\xfe\x00"]
)
def test_a_damaged_table_is_one_line(tmp_path, content):
    path = tmp_path / "table.csv"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(InputError, match=r"expected a table of checksums, .*--write-checksums"):
        stage_checksums.read(path)
