"""A badminton racket: oval head, shaft and grip, as a mesh."""

import numpy as np
from numpy.typing import NDArray

from virtualgym.body import rotations
from virtualgym.body.mesh import Mesh, join

LENGTH_M = 0.674  # the Laws of Badminton allow 680 mm
HEAD_LENGTH_M, HEAD_WIDTH_M = 0.285, 0.226  # outer; the Laws of Badminton allow 290 and 230 mm
# ASSUME: the other sizes are typical of rackets on sale; no source is recorded.
GRIP_LENGTH_M = 0.175
HELD_AT_M = 0.075  # from the butt to the middle of the hand
FRAME_RADIUS_M, SHAFT_RADIUS_M = 0.0055, 0.004
GRIP_RADII_M = 0.0155, 0.0125  # at the butt, and where the grip ends
BUTT_M, TOP_ANGLE = 0.02, np.radians(22)  # size of the coloured marks at both ends
AROUND, ALONG, N_STRINGS = 8, 48, 9
STRING_M = 0.0014
FRAME_BGR, SHAFT_BGR, GRIP_BGR = (40, 40, 200), (60, 60, 60), (235, 235, 235)
END_BGR, STRING_BGR = (40, 225, 250), (225, 235, 235)


def build() -> Mesh:
    """Return the racket: butt at the origin, y to the top, x across the head, z off the strings."""
    middle = LENGTH_M - HEAD_LENGTH_M / 2
    angle = np.linspace(0, 2 * np.pi, ALONG, endpoint=False) + np.pi / 2
    across, along = HEAD_WIDTH_M / 2 - FRAME_RADIUS_M, HEAD_LENGTH_M / 2 - FRAME_RADIUS_M
    oval = np.stack(
        [across * np.cos(angle), middle + along * np.sin(angle), np.zeros(ALONG)], axis=1
    )
    from_top = np.abs((angle + np.pi / ALONG - np.pi / 2 + np.pi) % (2 * np.pi) - np.pi)
    colours = np.where((from_top < TOP_ANGLE)[:, None], END_BGR, FRAME_BGR)
    neck = middle - along
    rods = [
        ([0, BUTT_M], GRIP_RADII_M[:1] * 2, END_BGR),
        ([BUTT_M, GRIP_LENGTH_M], GRIP_RADII_M, GRIP_BGR),
        ([GRIP_LENGTH_M, neck], (SHAFT_RADIUS_M, SHAFT_RADIUS_M), SHAFT_BGR),
    ]
    parts = [_tube(oval, np.full(ALONG, FRAME_RADIUS_M), colours, closed=True)]
    for heights, radii, colour in rods:
        line = np.array([[0, height, 0] for height in heights])
        parts.append(_tube(line, np.array(radii), np.array([colour]), closed=False))
    parts += _strings(middle, across, along)
    return join(parts)


def place(rest: Mesh, butt: NDArray, way: NDArray, face: NDArray) -> Mesh:
    """Put the racket into the world.

    Parameters
    ----------
    rest : Mesh
        From `build`.
    butt : (3,) float
        Metres.
    way : (3,) float
        Unit vector from butt to top.
    face : (3,) float
        Approximate normal of the strings; not along `way`.
    """
    normal = rotations.unit_vector(face - (face @ way) * way)
    rotation = np.stack([rotations.cross3(way, normal), way, normal], axis=1)
    return Mesh(rest.vertices @ rotation.T.astype(np.float32) + butt, rest.triangles, rest.colours)


def _tube(line: NDArray, radii: NDArray, colours: NDArray, *, closed: bool) -> Mesh:
    """Return a round tube along a line (n, 3) in the plane z = 0; open tubes get end caps."""
    n = len(line)
    ahead = np.roll(line, -1, axis=0) - np.roll(line, 1, axis=0) if closed else line[-1:] - line[:1]
    ahead = np.broadcast_to(ahead / np.linalg.norm(ahead, axis=1, keepdims=True), line.shape)
    out = np.stack([ahead[:, 1], -ahead[:, 0], ahead[:, 2]], axis=1)
    turn = 2 * np.pi * np.arange(AROUND) / AROUND
    circle = np.cos(turn)[:, None] * out[:, None] + np.sin(turn)[:, None] * np.array([0, 0, 1.0])
    vertices = (line[:, None] + radii[:, None, None] * circle).reshape(-1, 3)
    pieces = n if closed else n - 1
    here, side = np.divmod(np.arange(pieces * AROUND), AROUND)
    there, beside = (here + 1) % n, (side + 1) % AROUND
    corners = [
        AROUND * at + by
        for at, by in ((here, side), (here, beside), (there, beside), (there, side))
    ]
    first, second, third, fourth = corners
    triangles = np.concatenate(
        [np.stack([first, third, second], axis=1), np.stack([first, fourth, third], axis=1)]
    )
    colours = np.broadcast_to(colours, (pieces, 3))[np.tile(here, 2)]
    if not closed:
        fan = np.stack(
            [np.zeros(AROUND - 2, int), np.arange(1, AROUND - 1), np.arange(2, AROUND)], axis=1
        )
        triangles = np.concatenate([triangles, fan, (n - 1) * AROUND + fan[:, ::-1]])
        colours = np.concatenate([colours, np.repeat(colours[:1], 2 * len(fan), axis=0)])
    return Mesh(vertices, triangles, colours.astype(np.uint8))


def _strings(middle: float, across: float, along: float) -> list[Mesh]:
    """Return some strings as flat ribbons, seen from both sides."""
    ribbons = []
    for share in np.linspace(-0.8, 0.8, N_STRINGS):
        reach = np.sqrt(1 - share**2)
        for start, end, aside in (
            (
                [share * across, middle - reach * along, 0],
                [share * across, middle + reach * along, 0],
                0,
            ),
            (
                [-reach * across, middle + share * along, 0],
                [reach * across, middle + share * along, 0],
                1,
            ),
        ):
            half = np.zeros(3)
            half[aside] = STRING_M / 2
            vertices = np.array([start - half, start + half, end + half, end - half])
            triangles = np.array([[0, 1, 2], [0, 2, 3], [2, 1, 0], [3, 2, 0]])
            ribbons.append(Mesh(vertices, triangles, np.full((4, 3), STRING_BGR, dtype=np.uint8)))
    return ribbons
