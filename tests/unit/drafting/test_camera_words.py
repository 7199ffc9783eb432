"""Which words of file names are taken for cameras."""

from courtside.drafting import camera_words


def test_a_camera_of_more_words_goes_first():
    cameras = {"left": ("left",), "far_left": ("far", "left")}
    assert camera_words.told(("far", "left", "serve"), cameras) == ("far_left", ("serve",))
    assert camera_words.told(("serve", "left"), cameras) == ("left", ("serve",))
    assert camera_words.told(("serve",), cameras) == (None, ("serve",))
