"""Names of images: what extraction writes is what the models are asked for."""

from courtside.records.cameras import image_names


def test_static_pictures_are_told_from_frames_of_any_walk():
    names = [image_names.static("side"), image_names.frame("static", "000001.png")]
    assert names == ["static/side.png", "frames/static/000001.png"]
    assert image_names.are_static(names).tolist() == [True, False]
    assert image_names.are_static([]).tolist() == []
