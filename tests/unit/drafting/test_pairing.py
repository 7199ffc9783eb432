"""Which recordings of several cameras become one take."""

from courtside.drafting import pairing
from courtside.drafting.recordings import Guess, Recording


def paired(*films, of=("left", "right")):
    """Return the takes of videos in folders of cameras, by lengths in s, and what is not used.

    A video is its name and its length, which tells what belongs together: 20 and 20.5 s.
    """
    found = Guess()
    pairing.group(
        found,
        [
            (Recording(f"{camera}/{name}", (camera, name), "video", duration_s=length), camera, ())
            for camera, own in zip(of, films, strict=True)
            for name, length in own.items()
        ],
    )
    takes = [[r.duration_s for r in take.values()] for take in found.takes.values()]
    return takes, found


def placed(path, camera, *words):
    return Recording(path, (path.rpartition(".")[0],), "video", duration_s=20.0), camera, words


def test_equal_words_make_a_take():
    found = Guess()
    pairing.group(found, [placed("a.mp4", "left", "serve"), placed("b.mp4", "right", "serve")])
    assert {c: r.path for c, r in found.takes["serve"].items()} == {
        "left": "a.mp4",
        "right": "b.mp4",
    }
    assert found.by_order == []


def test_counters_pair_by_order_and_say_so():
    takes, found = paired({"C0001": 20.0, "C0002": 31.0}, {"C0007": 20.5, "C0008": 31.5})
    assert takes == [[20.0, 20.5], [31.0, 31.5]]
    assert found.by_order == list(found.takes) == ["take1", "take2"]


def test_a_counter_that_began_anew_goes_on():
    takes, found = paired(
        {"IMG_0998": 20.0, "IMG_0999": 31.0, "IMG_1000": 42.0},
        {"IMG_0001": 42.5, "IMG_9998": 20.5, "IMG_9999": 31.5},  # in the order of their names
    )
    assert takes == [[20.0, 20.5], [31.0, 31.5], [42.0, 42.5]]
    assert found.by_order == list(found.takes)


def test_equal_counters_of_cameras_with_unlike_many_recordings_make_no_take():
    """One camera was started again: its second recording is no take."""
    left = {"C0001": 20.0, "C0002": 24.0, "C0003": 28.0}
    takes, found = paired(left, {"C0001": 20.5, "C0002": 14.0, "C0003": 24.5, "C0004": 28.5})
    assert takes == []
    assert len(found.unused) == 7
    assert all("left 3, right 4): remove those of no take" in why for _, why in found.unused)


def test_counters_are_paired_among_recordings_of_their_words():
    """Of two more serves of the left and two more lobs of the right camera, none are one take."""
    films = [("left", "serve", 1), ("left", "serve", 2), ("left", "lob", 3)]
    films += [("right", "serve", 11), ("right", "lob", 12), ("right", "lob", 13)]
    found = Guess()
    pairing.group(
        found,
        [placed(f"{word}_C{number:04d}.mp4", camera, word) for camera, word, number in films],
    )
    assert found.takes == {}
    assert len(found.unused) == 6
    same = [
        placed(f"serve_C{n:04d}.mp4", c, "serve") for c, n in zip("aabb", (1, 2, 5, 6), strict=True)
    ]
    found = Guess()
    pairing.group(found, same)
    assert found.by_order == list(found.takes) == ["serve1", "serve2"]
