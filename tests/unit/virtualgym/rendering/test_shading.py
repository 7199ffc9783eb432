"""One picture: what hides what, what the floor mirrors, the net, smooth edges."""

import numpy as np
import pytest

from fixtures.cameras import scene as projection
from fixtures.cameras import small_hall
from virtualgym.hall import quads
from virtualgym.hall.painted_lines import NET_DEPTH_M, TAPE_M, Net
from virtualgym.rendering import rays, shading, textured_quads

DARK, GREY, BRIGHT = (np.full((4, 4, 3), value, np.uint8) for value in (40, 100, 200))
CAMERA = small_hall.camera(place=(4, 0.5, 1.5), target=(4, 9, 1.0))
NET = Net(np.array([[1.0, 5, 0], [7, 5.2, 0]]), np.array([[1.0, 5, 1.5], [7, 5.2, 1.5]]), 0.0)


def take(scene, extra=(), camera=CAMERA, twist=None, readout_s=0.0):
    parts = [
        textured_quads.Surfaces(scene.quads),
        *([textured_quads.Surfaces(extra)] if extra else []),
    ]
    seen = rays.of_camera(camera, rays.grid(camera), twist, readout_s)
    return shading.Exposure(scene, parts, seen).picture()


def looked_at(picture, xyz, camera=CAMERA):
    """Return the colours where points (N, 3) are projected."""
    column, row = np.rint(projection.opencv_projection(camera, np.array(xyz, float))).astype(int).T
    return picture[row, column, 0]


def upright(y, value, z=(0.5, 1.0), x=(3.0, 5.0)):
    return quads.Quad([x[0], y, z[1]], [x[1] - x[0], 0, 0], [0, 0, z[0] - z[1]], value)


@pytest.mark.parametrize("twist", [None, (np.array([0.1, 0.05, 0]), np.array([0.2, 0.1, 0]))])
def test_the_nearest_of_all_parts_is_seen(twist):
    shape = {"twist": twist, "readout_s": 0.02}
    scene = small_hall.scene([upright(5, GREY)], texture=DARK)
    cases = {
        "before": ([upright(4, BRIGHT)], 200),
        "behind": ([upright(6, BRIGHT, z=(0.55, 0.9))], 100),
        "nothing": ([], 100),
    }
    for extra, value in cases.values():
        picture = take(scene, extra, **shape)
        assert looked_at(picture, [[4, 5, 0.75]])[0] == pytest.approx(value, abs=0.5)
    both = take(small_hall.scene([upright(5, GREY), upright(4, BRIGHT)], texture=DARK), **shape)
    np.testing.assert_array_equal(take(scene, [upright(4, BRIGHT)], **shape), both)


def test_edges_are_smooth():
    scene = small_hall.scene([upright(5, BRIGHT)], texture=DARK)
    slanted = quads.Quad([3, 4.9, 1.9], [2, 0, 0.15], [0, 0, -0.3], BRIGHT)
    values = np.unique(np.rint(take(scene, [slanted])[..., 0]))
    assert len(values) >= 5  # four rays at each edge: quarters between dark and bright
    assert values.min() >= 39
    assert values.max() <= 201


def test_a_glossy_floor_mirrors_and_a_dull_one_does_not():
    plate = upright(6, BRIGHT, z=(0.6, 1.2))
    mirror_image = [[4, 6, -0.9]]  # of the plate's middle, behind the floor
    aside = [[1.2, 6, -0.9]]
    light = {
        gloss: take(small_hall.scene([plate], texture=DARK, gloss=gloss))
        for gloss in (0.0, 0.1, 0.2)
    }
    np.testing.assert_allclose(looked_at(light[0.0], mirror_image), 40, atol=0.5)
    for gloss in (0.1, 0.2):
        at = np.array(mirror_image[0]) - CAMERA.centre_in_world
        share = gloss * (1 + shading.GRAZING * (1 + at[2] / np.linalg.norm(at)) ** 5)
        expected = 40 + share * 160
        assert looked_at(light[gloss], mirror_image)[0] == pytest.approx(expected, abs=1)
        assert looked_at(light[gloss], aside)[0] == pytest.approx(40, abs=0.5)
    # Only the floor mirrors.
    above = [[4, 6, 0.9], [4, 9, 2.0]]
    np.testing.assert_allclose(looked_at(light[0.2], above), [200, 40], atol=0.5)


def test_the_floor_mirrors_surfaces_of_one_picture_only():
    scene = small_hall.scene(texture=DARK, gloss=0.2)
    with_plate = take(scene, [upright(6, BRIGHT, z=(0.6, 1.2))])
    assert looked_at(with_plate, [[4, 6, -0.9]])[0] > looked_at(take(scene), [[4, 6, -0.9]])[0] + 20


def test_the_mesh_darkens_what_is_behind_it_only():
    scene = small_hall.scene([upright(4, BRIGHT, x=(2, 3))], texture=BRIGHT, net=NET)
    picture = take(scene)
    middle = 5.1, 1.5 - (TAPE_M + NET_DEPTH_M) / 2
    through = 200 * (1 - shading.NET_COVER) + shading.NET_COVER * shading.NET_BGR[0]
    before_net = np.array([2.5, 4, 0.75])
    points = {
        (4, *middle): through,
        (4, 5.1, 1.5 - NET_DEPTH_M - 0.05): 200,
        (4, 5.1, 1.5 - TAPE_M / 2): 200,
        (0.9, 5.0, middle[1]): 200,
        tuple(before_net): 200,
    }
    for point, value in points.items():
        assert looked_at(picture, [point])[0] == pytest.approx(value, abs=0.5), point
    beyond = small_hall.camera(place=(4, 8, 1.5), target=(4, 0, 1.0))
    seen = looked_at(take(scene, camera=beyond), [(4, *middle)], beyond)
    assert seen[0] == pytest.approx(through, abs=0.5)


def test_pictures_of_odd_sizes_have_gloss_up_to_their_borders():
    camera = small_hall.camera(size=(321, 181), target=(6.5, 7.5, -0.5))
    picture = take(small_hall.scene(texture=GREY, gloss=0.3), camera=camera)
    assert picture.shape == (181, 321, 3)
    np.testing.assert_allclose(picture, 100, atol=0.6)  # grey mirrored in grey
