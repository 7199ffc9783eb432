"""A small room with chessboards on its walls, of the simulation's quads, to test what pictures show."""

import numpy as np

from courtside.geometry.camera import Camera
from virtualgym.hall import quads as surfaces
from virtualgym.hall.hall import Scene

ROOM_M = np.array([[0.0, 0.0, 0.0], [8.0, 9.0, 3.0]])
SQUARE_M = 0.5
TEXEL_M = 0.01
DIST = (-0.12, 0.03, 1e-3, -2e-3, 0.004)


def chessboard(width_m, height_m, dark=60, bright=200):
    """Return a chessboard with squares of 0.5 m, first square dark, (h, w, 3) uint8."""
    side = round(SQUARE_M / TEXEL_M)
    rows, columns = (np.arange(round(length / TEXEL_M)) // side for length in (height_m, width_m))
    odd = (rows[:, None] + columns) % 2
    return np.repeat(np.where(odd, bright, dark)[..., None], 3, axis=2).astype(np.uint8)


def walls():
    """Return floor, four walls and ceiling: each an (origin, u, v) of (3,) float."""
    x, y, z = ROOM_M[1]
    return [
        ([0, 0, 0], [x, 0, 0], [0, y, 0]),
        ([0, 0, z], [0, y, 0], [0, 0, -z]),
        ([0, y, z], [x, 0, 0], [0, 0, -z]),
        ([x, y, z], [0, -y, 0], [0, 0, -z]),
        ([x, 0, z], [-x, 0, 0], [0, 0, -z]),
        ([0, 0, z], [x, 0, 0], [0, y, 0]),
    ]


def quads(texture=None):
    """Return the room's six quads, with chessboards or one texture."""
    made = []
    for origin, u, v in walls():
        size_m = (np.abs(edge).max() for edge in (u, v))
        made.append(
            surfaces.Quad(origin, u, v, chessboard(*size_m) if texture is None else texture)
        )
    return made


def scene(things=(), *, texture=None, gloss=0.0, net=None):
    """Return a `Scene` of the room with further quads."""
    nothing = np.zeros((0, 3))
    return Scene([*quads(texture), *things], ROOM_M, gloss, net, nothing, np.zeros((0, 4)))


def corners():
    """Return the inner corners of all chessboards, (N, 3) m."""
    found = []
    for origin, u, v in np.array(walls(), dtype=float):
        across, down = (round(np.linalg.norm(edge) / SQUARE_M) for edge in (u, v))
        for i in range(1, across):
            found += [origin + u * i / across + v * j / down for j in range(1, down)]
    return np.array(found)


def camera(place=(1.0, 1.2, 1.7), target=(6.5, 7.5, 1.0), size=(640, 360), dist=DIST, name="c"):
    """Return a camera in the room, 67 degrees across."""
    forward = np.subtract(target, place) / np.linalg.norm(np.subtract(target, place))
    right = np.cross(forward, [0, 0, 1.0])
    right /= np.linalg.norm(right)
    rotation = np.stack([right, np.cross(forward, right), forward])
    pose = np.column_stack([rotation, -rotation @ np.asarray(place, float)])
    focal = 0.75 * size[0]
    matrix = np.array([[focal, 0, size[0] / 2 + 3], [0, focal, size[1] / 2 - 5], [0, 0, 1]])
    return Camera(name, size, matrix, np.array(dist, float), pose)
