"""The grid of walks: what is matched with what, and which frames are chosen."""

from itertools import pairwise

import pandas as pd
import pytest

from courtside.records.cameras import frame_table
from courtside.sfm import grid
from courtside.study.errors import InputError


def table(path, count, dropped=(), photos=False):
    rows = pd.DataFrame(
        {
            "frame_idx": range(0, 5 * count, 5),
            "time_s": [at / 6 for at in range(count)],
            "name": [f"{at:06d}.png" for at in range(count)],
            "sharpness": [100.0 + at for at in range(count)],
            "kept": [at not in dropped for at in range(count)],
            "reason": ["blurred" if at in dropped else "" for at in range(count)],
            "photo": [f"IMG_{at}.jpg" if photos else "" for at in range(count)],
        }
    )
    frame_table.write(path, rows)
    return path


def one_walk(tmp_path, count=40, dropped=()):
    return grid.read({"walk": table(tmp_path / "walk.csv", count, dropped)})


def test_walks_follow_each_other_in_the_order_given(tmp_path):
    tables = {"zig": table(tmp_path / "z.csv", 3, [1]), "ant": table(tmp_path / "a.csv", 2)}
    found = grid.read(tables)
    zig = [f"frames/zig/{at:06d}.png" for at in range(3)]
    ant = [f"frames/ant/{at:06d}.png" for at in range(2)]
    assert found.names.tolist() == zig + ant
    assert found.walks.tolist() == ["zig"] * 3 + ["ant"] * 2
    assert found.kept.tolist() == [True, False, True, True, True]
    assert found.sharpness.tolist() == [100, 101, 102, 100, 101]
    assert found.of_walk("zig") == (zig[0], zig[2]) and found.of_walk("ant") == tuple(ant)


def test_too_few_usable_photos_are_named_with_the_reason(tmp_path):
    photos = grid.read({"walk": table(tmp_path / "walk.csv", 9, [1, 2, 3, 4], photos=True)})
    blurred = "is far less sharp than the photos around it (blurred, or of another place)"
    with pytest.raises(InputError) as caught:
        photos.choose(9, 0, "even")
    assert str(caught.value).startswith(
        "walk: expected at least 9 usable photos, found 5 of 9 (" + f"IMG_1.jpg {blurred}, "
        f"IMG_2.jpg {blurred}, IMG_3.jpg {blurred} and 1 more): take more, sharp and"
    )
    assert "n_images: [5]" in str(caught.value) and "film" not in str(caught.value)
    with pytest.raises(InputError, match=r"found 9 of 9: take more"):
        grid.read({"walk": table(tmp_path / "walk.csv", 9, photos=True)}).choose(10, 0, "even")
    tables = {"a": table(tmp_path / "a.csv", 3, photos=True), "b": table(tmp_path / "b.csv", 3)}
    with pytest.raises(InputError, match=r"a, b: expected at least 9 usable frames, .*: film lo"):
        grid.read(tables).choose(9, 0, "even")


def test_photos_are_called_by_their_own_names(tmp_path):
    tables = {"a": table(tmp_path / "a.csv", 2, photos=True), "b": table(tmp_path / "b.csv", 2)}
    found = grid.read(tables)
    assert found.called("frames/a/000001.png") == "IMG_1.jpg (frames/a/000001.png)"
    assert found.called("frames/b/000001.png") == "frames/b/000001.png"
    assert found.called("static/left.png") == "static/left.png"
    assert list(found.own_names().values()) == ["IMG_0.jpg", "IMG_1.jpg"]


def test_fixed_cameras_are_matched_with_all_and_dropped_frames_with_none(tmp_path):
    dropped = (3, 4, 17)
    found = one_walk(tmp_path, dropped=dropped).pairs(["side.png", "back.png"])
    usable = [f"frames/walk/{at:06d}.png" for at in range(40) if at not in dropped]
    assert len({frozenset(pair) for pair in found}) == len(found)
    assert ("side.png", "back.png") in found
    for fixed in ("side.png", "back.png"):
        assert [b for a, b in found if a == fixed and b in usable] == usable
    assert {name for pair in found for name in pair} == {*usable, "side.png", "back.png"}


def test_neighbours_are_matched(tmp_path):
    found = set(one_walk(tmp_path).pairs([]))
    names = [f"frames/walk/{at:06d}.png" for at in range(40)]
    for stride in range(1, 9):
        assert found.issuperset(zip(names[:-stride], names[stride:], strict=True))
    assert (names[1], names[11]) not in found
    assert all(a < b for a, b in found)


def test_chosen_frames_are_usable_even_and_in_order(tmp_path):
    dropped = (0, 13, 20)
    found = one_walk(tmp_path, dropped=dropped).choose(10, 0, "even")
    places = [int(name[-10:-4]) for name in found]
    assert len(places) == 10 and not set(places) & set(dropped)
    assert all(2 <= b - a <= 7 for a, b in pairwise(places))
    assert places[0] <= 4 and places[-1] >= 35


def test_the_published_rule_takes_every_so_many_usable_frames(tmp_path):
    found = one_walk(tmp_path, dropped=(1, 3)).choose(12, 0, "interval")
    usable = [at for at in range(40) if at not in (1, 3)]
    assert found == [f"frames/walk/{at:06d}.png" for at in usable[: 12 * 3 : 3]]


def test_too_few_frames_name_the_walks(tmp_path):
    tables = {"one": table(tmp_path / "1.csv", 3), "two": table(tmp_path / "2.csv", 3, [0])}
    found = grid.read(tables)
    with pytest.raises(
        InputError, match=r"^one, two: expected at least 8 usable frames, found 5 of 6"
    ):
        found.choose(8, 0, "even")


def test_without_walks_only_the_fixed_cameras_are_matched():
    found = grid.read({})
    assert found.pairs(["a.png", "b.png", "c.png"]) == [
        ("a.png", "b.png"),
        ("a.png", "c.png"),
        ("b.png", "c.png"),
    ]


def test_a_missing_or_broken_table_is_named(tmp_path):
    path = tmp_path / "walk.csv"
    for content in (None, "name,kept\na.png,1\n"):
        if content:
            path.write_text(content)
        with pytest.raises(InputError, match=r"walk\.csv: expected a frame table"):
            grid.read({"walk": path})


@pytest.mark.parametrize("walk", ["walk", "3", "null"])
def test_fixed_images_are_those_of_no_walk_whatever_its_name(tmp_path, walk):
    path = tmp_path / "features.csv"
    path.write_text(f"source,name,n_features\n1,static/1.png,5\n{walk},frames/0.png,5\n")
    assert grid.fixed(path, [walk]) == ["static/1.png"]


def test_a_table_of_features_without_names_is_refused(tmp_path):
    path = tmp_path / "features.csv"
    path.write_text("source\n1\n")
    with pytest.raises(InputError, match="expected a table of features, found no column name"):
        grid.fixed(path, [])
