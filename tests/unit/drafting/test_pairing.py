"""Which recordings of several cameras become one take."""

from courtside.drafting import pairing
from courtside.drafting.recordings import Guess, Recording


def placed(path, camera, *words):
    return Recording(path, (path.rpartition(".")[0],), "video", duration_s=20.0), camera, words


def test_equal_words_make_a_take():
    found = Guess()
    pairing.group(found, [placed("a.mp4", "left", "serve"), placed("b.mp4", "right", "serve")])
    assert {c: r.path for c, r in found.takes["serve"].items()} == {
        "left": "a.mp4",
        "right": "b.mp4",
    }
