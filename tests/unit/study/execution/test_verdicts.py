"""Verdicts at the end of a run: counted, failed takes last, with their file."""

import pytest

from courtside.study.errors import InputError
from courtside.study.execution import verdicts

HEAD = ",".join([*verdicts.WAY, *verdicts.COLUMNS])


def written(folder, take, *found):
    path = folder / "results" / "hall" / "takes" / take / "quality.csv"
    path.parent.mkdir(parents=True)
    rows = [
        f"{way},all-robust,net,all,all,whole,,,,{word},clock,Camera c1 is {word}."
        for way, word in found
    ]
    camera = "file,all-robust,net,c1,all,whole,,,,failed,clock,Camera c1 failed."
    path.write_text("\n".join([HEAD, *rows, camera]) + "\n", encoding="utf-8")
    return str(path)


def test_takes_are_counted_by_their_worst_way_and_failed_ones_come_last(tmp_path):
    files = [
        written(tmp_path, "a", ("file", "good")),
        written(tmp_path, "b", ("file", "good"), ("sfm-n40", "failed")),
        written(tmp_path, "c", ("file", "doubtful")),
    ]
    lines, n_failed = verdicts.summary(files)
    assert n_failed == 1
    assert lines[0] == "Verdicts on takes: 1 good, 1 doubtful, 1 failed."
    assert lines[1].startswith("  doubtful: hall/c (file all-robust net): Camera c1 is doubtful.")
    assert lines[2].startswith("  failed: hall/b (sfm-n40 all-robust net)") and files[1] in lines[2]
    assert len(lines) == 3
    assert [verdicts.failed(path) for path in files] == [False, True, False]


def test_nothing_is_said_of_no_take(tmp_path):
    assert verdicts.summary([]) == ([], 0)
    assert not verdicts.failed(tmp_path / "none.csv")


@pytest.mark.parametrize("content", ["", "a,b\n1,2\n", HEAD + "\n" + "x," * 9 + "superb,,\n"])
def test_another_file_is_refused_and_made_again(tmp_path, content):
    path = tmp_path / "quality.csv"
    path.write_text(content, encoding="utf-8")
    with pytest.raises(InputError, match="table of verdicts"):
        verdicts.read(path)
    assert verdicts.failed(path)
