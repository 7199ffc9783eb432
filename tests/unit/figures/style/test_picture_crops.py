"""Parts of pictures hold the persons, and pixels are drawn where they lie."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.figure import Figure

from courtside.figures.style import picture_crops
from fixtures.people import takes_made, walker


@pytest.mark.parametrize("aspect", [0.5, 1.0, 3.0])
def test_a_box_has_its_aspect_and_holds_every_point(aspect):
    xy = np.array([[100.0, 200.0], [160.0, 420.0], [np.nan, np.nan]])
    part = picture_crops.box(xy, (1920, 1080), aspect)
    assert part.width / part.height == pytest.approx(aspect)
    assert (part.x, part.y) == (130, 310)
    assert part.height >= 220 * picture_crops.MARGIN - 1e-9
    assert part.width >= 60 * picture_crops.MARGIN - 1e-9


def test_boxes_of_one_point_and_of_none():
    assert picture_crops.box([[50.0, 60.0]], (640, 480)).width == picture_crops.LEAST_PX
    whole = picture_crops.box(np.full((3, 2), np.nan), (640, 480), 640 / 480)
    assert (whole.x, whole.y) == pytest.approx((320, 240))
    assert (whole.width, whole.height) == pytest.approx((640, 480))


@pytest.mark.parametrize("middle", [(200, 150), (5, 5), (395, 295), (-900, 5)])
def test_pictures_keep_their_coordinates(middle):
    image = np.zeros((300, 400, 3), np.uint8)
    image[..., 0] = np.arange(400) % 256  # blue tells the column
    axis = Figure().subplots()
    picture_crops.show(axis, image, picture_crops.Box(*middle, 80, 60))
    assert axis.get_xlim() == (middle[0] - 40, middle[0] + 40)
    assert axis.get_ylim() == (middle[1] + 30, middle[1] - 30)
    for shown in axis.images:
        left, right, bottom, top = shown.get_extent()
        data = shown.get_array()
        assert (right - left, bottom - top) == (data.shape[1], data.shape[0])
        assert data[0, 0, 2] == int(left + 0.5) % 256
    assert bool(axis.images) == (middle[0] > 0)


def test_lines_without_both_ends_are_left_out():
    axis = Figure().subplots()
    xy = np.array([[[0, 0], [1, 1], [np.nan, np.nan]], [[5, 5], [6, 6], [7, 8.0]]])
    picture_crops.sticks(axis, xy, [(0, 1), (1, 2)], "red", outline=0, dots=False)
    drawn = [line.get_xydata().tolist() for line in axis.lines]
    assert drawn == [[[0, 0], [1, 1]], [[5, 5], [6, 6]], [[6, 6], [7, 8]]]


def test_rings_are_where_the_points_are():
    axis = Figure().subplots()
    picture_crops.rings(axis, [[3.0, 4.0], [5.0, 6.0]])
    np.testing.assert_array_equal(axis.lines[0].get_xydata(), [[3, 4], [5, 6]])


@pytest.fixture
def filmed(monkeypatch):
    """Return the only picture of every video, and the joints of a person in it."""
    image = np.arange(1080 * 1920 * 3, dtype=np.uint32).reshape(1080, 1920, 3).astype(np.uint8)
    monkeypatch.setattr(picture_crops.reader, "read_frame", lambda video, time_s: (0, image))
    return image, np.tile(np.linspace([150.0, 60.0], [250.0, 260.0], walker.N_JOINTS), (1, 1, 1))


def pixel(xy):
    return tuple(np.round(xy[::-1]).astype(int))


def test_faces_of_all_methods_are_hidden_on_request(filmed):
    image, xy = filmed
    unseen = np.full_like(xy, np.nan)
    shown = picture_crops.read("film.mp4", 0, [xy], walker.SKELETON, others=(), hidden=False)
    np.testing.assert_array_equal(shown, image)
    nose, knee = (pixel(xy[0, walker.SKELETON.index(name)]) for name in ("nose", "left_knee"))
    for persons in ([xy, unseen], [unseen, xy]):
        found = picture_crops.read("film.mp4", 0, persons, walker.SKELETON, others=(), hidden=True)
        assert (found[nose] != image[nose]).any()
        np.testing.assert_array_equal(found[knee], image[knee])


def test_the_face_of_a_bystander_before_a_person_is_hidden(filmed):
    image, frame = filmed[0], 9
    record, (one, *_) = takes_made.take(n_persons=2)
    joint = walker.SKELETON.index
    face = [joint(name) for name in walker.SKELETON.groups["face"]]
    xy = one.tracklets.xy.copy()
    knee = pixel(xy[0, frame, joint("left_knee")])
    first = SimpleNamespace(assigned=lambda view: replace(view, xy=view.xy[:1]))
    record = replace(record, xyz=record.xyz[:1])
    for place, sharp in ((1.0, True), (xy[0, frame, joint("left_knee")], False)):
        xy[1, frame, face] = place
        seen = replace(one, tracklets=replace(one.tracklets, xy=xy), people=first)
        found, detected, _ = picture_crops.at_frame(
            seen, record, frame, walker.SKELETON, hidden=True
        )
        assert len(detected) == 1
        assert (found[knee] == image[knee]).all() == sharp
