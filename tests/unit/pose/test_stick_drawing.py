"""Stick figures are where their joints are, and what cannot be drawn is left out."""

import numpy as np

from courtside.pose import stick_drawing


def test_bones_and_joints_are_drawn_where_they_are():
    image = np.zeros((60, 80), np.uint8)
    stick_drawing.draw(image, np.array([[[10.0, 30.0], [70.0, 30.0]]]), [(0, 1)], 255, 1, 3)
    assert (image[30, 10:71] > 200).all()
    assert image[27, 10] and image[33, 70]  # the joints are wider than the bone
    assert not image[:26].any() and not image[35:].any() and not image[27, 30]


def test_what_is_missing_or_far_away_is_not_drawn():
    image = np.zeros((60, 80, 3), np.uint8)
    person = np.array([[10.0, 10.0], [np.nan, 30.0], [1e9, 10.0]])
    stick_drawing.draw(image, [person], [(0, 1), (0, 2)], (100, 150, 200), 1, 2)
    marked = np.argwhere(image.any(axis=2))
    assert np.abs(marked - 10).max() <= 3  # the known joint, and no bone to the others
    assert image[10, 10].tolist() == [100, 150, 200]
    assert stick_drawing.drawable(person).tolist() == [True, False, False]
