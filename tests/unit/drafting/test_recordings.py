"""What the name of a recording says."""

from courtside.drafting import recordings
from courtside.drafting.recordings import Recording


def test_words_leave_out_what_a_device_says():
    found = Recording("gym/left/Smash C0007.MP4", ("left", "Smash C0007"), "video")
    assert found.words == ("left", "smash")
    assert found.written == "left/Smash /"


def test_words_of_a_vocabulary_may_be_counted():
    walk = Recording("gym/walk02.mp4", ("walk02",), "video")
    assert recordings.is_called_walk(walk)
    assert recordings.called(walk, {"walk"})
    assert not recordings.is_called_walk(Recording("gym/catwalk.mp4", ("catwalk",), "video"))


def test_lengths_of_one_take_differ_by_seconds_or_a_fifth():
    def fit(*lengths_s):
        return recordings.lengths_fit(
            Recording(f"{k}.mp4", (str(k),), "video", duration_s=s) for k, s in enumerate(lengths_s)
        )

    assert fit(8.0, 12.0)
    assert fit(300.0, 350.0)
    assert not fit(300.0, 350.0, 400.0)
    assert not fit(14.0, 24.0)
    assert fit(None, 10.0)
    assert fit()
