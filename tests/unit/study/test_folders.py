"""Folders appear whole or not at all."""

import pytest

from courtside.study.folders import atomic_folder


def names(path):
    return sorted(p.name for p in path.iterdir())


def test_a_folder_appears_when_the_block_ends(tmp_path):
    path = tmp_path / "new" / "frames"
    with atomic_folder(path) as beside:
        (beside / "a.png").write_text("a")
        assert not path.exists() and beside.parent == path.parent
    assert names(path) == ["a.png"] and names(tmp_path / "new") == ["frames"]


@pytest.mark.parametrize("content", [[], ["old.png"]])
def test_an_older_folder_is_replaced(tmp_path, content):
    path = tmp_path / "frames"
    path.mkdir()
    for name in content:
        (path / name).write_text("old")
    with atomic_folder(path) as beside:
        (beside / "a.png").write_text("a")
        assert names(path) == content
    assert names(path) == ["a.png"] and names(tmp_path) == ["frames"]


def test_a_failing_block_leaves_the_older_one(tmp_path):
    path = tmp_path / "frames"
    path.mkdir()
    (path / "old.png").write_text("old")
    with pytest.raises(RuntimeError, match="disk"), atomic_folder(path) as beside:
        (beside / "half.png").write_text("half")
        raise RuntimeError("disk")
    assert names(path) == ["old.png"] and names(tmp_path) == ["frames"]
