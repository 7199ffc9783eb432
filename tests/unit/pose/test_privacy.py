"""A face is gone after blurring, and nothing else has changed; nobody else can be recognised."""

import numpy as np
import pytest

from courtside.pose import privacy
from courtside.pose.privacy import Body
from fixtures.people import walker

FACE = np.array([[150.0, 100.0], [170.0, 100.0], [160.0, 115.0], [np.nan, np.nan]])


def noise():
    return np.random.default_rng(0).integers(0, 255, (240, 320, 3), dtype=np.uint8)


def of_face(*face):
    return Body((), face, ())


def hide_face(image, xy):
    return privacy.hide_faces(image, [xy], of_face(*range(len(xy))))


def detail(image):
    """Return the mean difference of neighbouring pixels."""
    return np.abs(np.diff(image.astype(float), axis=1)).mean()


def test_detail_is_gone_inside_and_kept_outside():
    image = noise()
    before = image.copy()
    blurred = hide_face(image, FACE)
    np.testing.assert_array_equal(image, before)
    assert detail(blurred[101:114, 154:167]) < 0.25 * detail(before)
    changed = (blurred != before).any(axis=2)
    rows, columns = np.nonzero(changed)
    assert np.hypot(rows - 107.5, columns - 160).max() < 40
    for x, y in FACE[:3].astype(int):
        assert changed[y - 2 : y + 3, x - 2 : x + 3].all()


@pytest.mark.parametrize("place", [(0, 0), (319, 239), (-500, -500), (160, -3)])
def test_faces_at_and_beyond_the_border_raise_nothing(place):
    image = noise()
    blurred = hide_face(image, np.array([place, np.add(place, 9)], float))
    assert blurred.shape == image.shape
    assert (blurred != image).any() == (place != (-500, -500))


def test_one_point_is_enough_and_none_changes_nothing():
    image = noise()
    assert (hide_face(image, np.array([[100.0, 100.0]])) != image).any()
    np.testing.assert_array_equal(hide_face(image, np.full((3, 2), np.nan)), image)


def test_faces_are_hidden_where_they_are():
    image = np.random.default_rng(0).integers(0, 255, (200, 300, 3)).astype(np.uint8)
    person = np.array([[100.0, 100.0], [110.0, 104.0], [100.0, 190.0]])
    people = np.stack([person, np.full((3, 2), np.nan)])
    hidden = privacy.hide_faces(image, people, of_face(0, 1))
    assert (hidden[98:106, 98:106] != image[98:106, 98:106]).any()
    np.testing.assert_array_equal(hidden[:60], image[:60])


@pytest.mark.parametrize("height_px", [100, 400])
def test_one_joint_hides_a_whole_face(height_px):
    """A nose alone, as of networks that see no ears: a head is as large as the body says."""
    image = np.random.default_rng(0).integers(0, 255, (480, 640, 3), dtype=np.uint8)
    nose, neck, ankle = [320.0, 40.0], [320.0, 40 + 0.1 * height_px], [320.0, 40 + height_px]
    person = np.array([nose, neck, ankle])
    body = Body(((0, 1), (1, 2)), (0,), ())
    sharp = privacy.only_persons(image, person[None], body)
    hidden = privacy.hide(image, person[None], person[None], body)
    rows, columns = np.mgrid[:480, :640]
    apart = np.hypot(columns - 320, rows - 40)
    head = apart <= 0.09 * height_px
    assert (hidden[head] != image[head]).any(axis=1).mean() > 0.95
    away = apart > 0.09 * height_px + 2
    np.testing.assert_array_equal(hidden[away], sharp[away])


def test_without_a_person_all_is_coarse():
    rng = np.random.default_rng(0)
    noise = rng.integers(0, 255, (240, 320, 3), dtype=np.uint8)
    for persons in (np.empty((0, 3, 2)), np.full((2, 3, 2), np.nan)):
        found = privacy.only_persons(noise, persons, Body(((0, 1),), (), ()))
        assert detail(found) < 0.35 * detail(noise)


def test_a_person_stays_sharp_without_a_face():
    image = noise()
    person = np.concatenate([FACE, [[160.0, 100.0], [160.0, 200.0]]])[None]
    hidden = privacy.hide(image, person, person, Body(((4, 5),), (0, 1, 2, 3), ()))
    np.testing.assert_array_equal(hidden[150:190, 158:163], image[150:190, 158:163])
    assert detail(hidden[101:114, 154:167]) < 0.25 * detail(image)
    assert detail(hidden[:, 220:]) < 0.35 * detail(image)


@pytest.mark.parametrize("height", [60, 240, 500, 1080])
def test_a_mosaic_is_of_8_cells_across_at_most(height, monkeypatch):
    cells = []
    resize = privacy.cv2.resize

    def counted(image, size, **options):
        cells.extend(size)
        return resize(image, size, **options)

    monkeypatch.setattr(privacy.cv2, "resize", counted)
    image = np.zeros((height, height, 3), np.uint8)
    hide_face(image, np.array([[height / 2, height / 2]]))
    assert max(cells[:2]) <= privacy.GRAIN


BODY = Body.of(walker.SKELETON)
METRE_PX = 200
HEAD_PX = (300, 230)  # its middle
AT_M = {"shoulder": (0.18, 0.25), "hip": (0.12, 0.78), "elbow": (0.22, 0.55), "wrist": (0.25, 0.8)}


def person(face_at=HEAD_PX, lean_deg=0.0, trunk=1.0):
    """Return joints (J, 2) of an upper body, whose face lies at a place in the picture.

    It leans about its head; `trunk` is how long shoulders to hips look, of their length.
    """
    xy = np.full((walker.N_JOINTS, 2), np.nan)
    for at in BODY.face:
        xy[at] = np.array(face_at) + np.random.default_rng(at).uniform(-12, 12, 2)
    lean = np.radians(lean_deg)
    turn = np.array([[np.cos(lean), -np.sin(lean)], [np.sin(lean), np.cos(lean)]])
    for limb, (right, down) in AT_M.items():
        down = 0.25 + trunk * (down - 0.25)
        for side, sign in (("left", 1), ("right", -1)):
            joint = walker.SKELETON.index(f"{side}_{limb}")
            xy[joint] = HEAD_PX + turn @ np.array([sign * right, down]) * METRE_PX
    return xy


def head(image, reach_m=0.12):
    """Return the picture of the head."""
    (x, y), reach = HEAD_PX, round(reach_m * METRE_PX)
    return image[y - reach : y + reach, x - reach : x + reach]


@pytest.mark.parametrize("lean_deg", [0, 30, -45, 100, 180])
@pytest.mark.parametrize("beside_m", [-0.25, 0.25, 2.0, np.nan])
def test_a_face_that_the_network_places_beside_it_is_hidden(beside_m, lean_deg):
    """Half hidden by a board, it is placed on the board; the shoulders say where the head is."""
    image = np.random.default_rng(0).integers(0, 255, (480, 640, 3), dtype=np.uint8)
    xy = person((HEAD_PX[0] + beside_m * METRE_PX, HEAD_PX[1]), lean_deg)
    hidden = privacy.hide(image, xy[None], xy[None], BODY)
    assert detail(head(hidden)) < 0.25 * detail(image)
    kept = privacy.hide_faces(image, xy[None], BODY)  # with surroundings
    assert detail(head(kept)) < 0.25 * detail(image)
    hips = xy[[walker.SKELETON.index(f"{side}_hip") for side in ("left", "right")]].mean(axis=0)
    x, y = hips.astype(int)
    np.testing.assert_array_equal(hidden[y - 4 : y, x], image[y - 4 : y, x])  # the rest is sharp


@pytest.mark.parametrize("unknown", ["left_shoulder", "left_hip", "right_hip", "hips"])
def test_a_face_placed_wrongly_is_hidden_without_all_joints_of_the_trunk(unknown):
    image = np.random.default_rng(0).integers(0, 255, (480, 640, 3), dtype=np.uint8)
    xy = person((500, 230))
    for joint in ("left_hip", "right_hip") if unknown == "hips" else (unknown,):
        xy[walker.SKELETON.index(joint)] = np.nan
    hidden = privacy.hide_faces(image, xy[None], BODY)
    assert detail(head(hidden)) < 0.25 * detail(image)


def test_of_a_trunk_towards_the_camera_all_round_the_shoulders_is_hidden():
    image = np.random.default_rng(0).integers(0, 255, (480, 640, 3), dtype=np.uint8)
    xy = person((500, 230), trunk=0.1)
    hidden = privacy.hide_faces(image, xy[None], BODY)
    shoulder = xy[walker.SKELETON.index("left_shoulder"), 1]
    below = round(shoulder + 0.2 * METRE_PX)
    assert detail(hidden[below - 10 : below + 10, 280:320]) < 0.25 * detail(image)


def test_faces_of_frames_close_by_are_hidden_as_well():
    """Where a network errs for a frame, the frames before and after it know better."""
    time_s = np.arange(30) / 30
    xy = np.zeros((2, 30, 5, 2)) + np.arange(30)[:, None, None]
    assert sorted(set(privacy.around(time_s, xy, 10)[:, 0, 0])) == [7, 10, 13]
    assert sorted(set(privacy.around(time_s, xy, 0)[:, 0, 0])) == [0, 3]
    assert sorted(set(privacy.around(time_s[::10], xy[:, ::10], 1)[:, 0, 0])) == [0, 10, 20]
    assert privacy.around(time_s[:1], xy[:, :1], 0).shape == (2, 5, 2)


def test_a_joint_far_beside_the_picture_does_not_hide_all_of_it():
    image = noise()
    xy = person()
    xy[BODY.face[0]] = [-30_000, 100]
    xy[walker.SKELETON.index("left_shoulder")] = [-17_000, 900]
    hidden = privacy.hide_faces(image, xy[None], BODY)
    assert (hidden == image).all(axis=2).mean() > 0.5


def test_several_methods_show_one_face():
    """One method knows the body, another one the face."""
    n_joints = walker.N_JOINTS
    both = Body.of(walker.SKELETON, 2)
    assert both.face == BODY.face + tuple(at + n_joints for at in BODY.face)
    assert len(both.trunks) == 2 and both.trunks[0] == BODY.trunks[0]
    assert max(map(max, both.bones)) < 2 * n_joints
