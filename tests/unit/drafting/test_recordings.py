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
