"""Quads and boxes: outward faces, upright textures."""

import numpy as np
import pytest

from virtualgym.hall import quads

GREY = np.full((2, 2, 3), 90, np.uint8)
EDGES = np.array([[1.0, 0.2, 0], [-0.4, 2.0, 0], [0.1, 0, 3.0]])


def test_a_box_is_closed_by_six_outward_faces():
    corner = np.array([5.0, -2.0, 0.5])
    faces = quads.box(corner, EDGES, GREY)
    middle = corner + EDGES.sum(axis=0) / 2
    flux, volume = np.zeros(3), 0.0
    for face in faces:
        outward = np.cross(face.v, face.u)
        centre = face.origin + (face.u + face.v) / 2
        assert outward @ (centre - middle) > 0
        flux += outward
        volume += outward @ centre / 3
    np.testing.assert_allclose(flux, 0, atol=1e-12)
    assert volume == pytest.approx(np.linalg.det(EDGES))  # by the divergence theorem


def test_upright_faces_have_their_first_row_on_top_and_are_not_mirrored():
    for face in quads.box([0, 0, 0], np.eye(3), GREY)[:4]:
        np.testing.assert_allclose(face.v, [0, 0, -1])
        outward = np.cross(face.v, face.u)
        # Who looks at the face, against its outward normal, has u to the right.
        np.testing.assert_allclose(np.cross(-outward, [0, 0, 1.0]), face.u)


def test_faces_differ_in_light_and_take_their_own_textures():
    own = [np.full((2, 2, 3), value, np.uint8) for value in range(6)]
    faces = quads.box([0, 0, 0], np.eye(3), own, light=0.5)
    assert [face.texture[0, 0, 0] for face in faces] == [0, 1, 2, 3, 4, 5]
    assert faces[4].light > faces[5].light
    twice = quads.box([0, 0, 0], np.eye(3), own, light=1.0)
    np.testing.assert_allclose([f.light * 2 for f in faces], [f.light for f in twice])


@pytest.mark.parametrize("texture", [np.zeros((2, 2, 3)), np.zeros((2, 2), np.uint8)])
def test_textures_are_bytes_of_three_colours(texture):
    with pytest.raises(ValueError, match="expected a texture"):
        quads.Quad([0, 0, 0], [1, 0, 0], [0, 1, 0], texture)
