"""A virtual sports hall round a court: walls, floor with painted lines, and what stands in it."""

from dataclasses import dataclass

import cv2
import numpy as np

from virtualgym.hall import furniture, painted_lines, textures
from virtualgym.hall import quads as surfaces

FLOOR_TEXEL_M = 0.008
WALL_TEXEL_M = 0.014
HEIGHT_M = 10.0
NEAREST_M = 21.0  # from the court's centre to cameras, at least; farther for larger courts
BEHIND_CAMERAS_M = 2.0
WHITE = (242, 245, 245)
OTHER_BGR = ((120, 205, 225), (150, 90, 60), (80, 60, 170))  # other sports' lines
COVER = 0.95


@dataclass(frozen=True, eq=False)
class Scene:
    """All that a picture of a hall may show.

    Attributes
    ----------
    quads : list of virtualgym.hall.quads.Quad
        The first is the floor, at z = 0.
    room_m : (2, 3) float
        Lowest and highest corner of the hall, world, metres.
    gloss : float
        Share of light that the floor reflects when seen from above.
    net : virtualgym.hall.painted_lines.Net or None
    court_xyz : (P, 3) float
        Where the court's points really are, in the court's order, metres.
    lines_m : (L, 4) float
        Where its lines really are: x0 y0 x1 y1.
    """

    quads: list
    room_m: np.ndarray
    gloss: float
    net: painted_lines.Net | None
    court_xyz: np.ndarray
    lines_m: np.ndarray


def build(preset, court, seed, *, floor_texel_m=FLOOR_TEXEL_M):
    """Build a hall.

    Parameters
    ----------
    preset : virtualgym.session.presets.Preset
    court : courtside.calibration.court.court.Court
    seed : int or numpy.random.SeedSequence
        The same seed gives the same hall, bit by bit.
    floor_texel_m : float
        A coarser floor is built faster.

    Returns
    -------
    scene : Scene
        The hall is a square about the court's centre, so large that cameras which see the whole court fit.
    """
    root = seed if isinstance(seed, np.random.SeedSequence) else np.random.SeedSequence(seed)
    state = np.random.SeedSequence(root.entropy, spawn_key=root.spawn_key)  # spawn leaves a trace
    paint, floor, shell, things = (np.random.default_rng(child) for child in state.spawn(4))
    painted = painted_lines.put_up(court, preset, paint)
    room_m = room(court)
    quads = [_floor(court, painted, room_m, preset, floor_texel_m, floor)]
    quads += _walls(room_m, preset, shell)
    quads += furniture.ceiling(room_m, preset, shell)
    for make in (furniture.posters, furniture.stands, furniture.stage):
        quads += make(room_m, preset, things)
    quads += furniture.gear(court, room_m, preset, things)
    if painted.net is not None:
        quads += furniture.net(painted.net)
    return Scene(quads, room_m, preset.gloss, painted.net, painted.court_xyz, painted.lines_m)


def room(court):
    """Return the lowest and the highest corner of the hall for a court, (2, 3) m."""
    short, long = sorted(court.size_m)
    half = max(NEAREST_M, short / 2 + long) + BEHIND_CAMERAS_M
    centre = court.size_m / 2
    return np.array([[*(centre - half), 0.0], [*(centre + half), HEIGHT_M]])


def _floor(court, painted, room_m, preset, texel_m, rng):
    low, high = room_m[:, :2]
    texture = textures.planks(high - low, texel_m, preset.contrast, preset.n_scuffs, rng)
    per_m = np.array(texture.shape[1::-1]) / (high - low)
    for lines_m, colour in _other_lines(court):
        # Weaker where textures are weak, but at full contrast these lines would be the plain hall's best.
        own = (
            np.array(textures.FLOOR_BGR) * (1 - preset.contrast)
            + np.array(colour) * preset.contrast
        )
        for line in lines_m:
            textures.paint(
                texture, (line.reshape(2, 2) - low).ravel() * np.tile(per_m, 2), own, cover=COVER
            )
    centre = tuple(np.rint((court.size_m / 2 - low) * per_m * 16).astype(int).tolist())
    radius = round(1.8 * per_m[0] * 16)
    mixed = (
        np.array(textures.FLOOR_BGR) * (1 - preset.contrast)
        + np.array(OTHER_BGR[2]) * preset.contrast
    )
    cv2.circle(
        texture, centre, radius, mixed.tolist(), round(0.05 * per_m[0]), cv2.LINE_AA, shift=4
    )
    for line in painted.lines_m:
        place = (line.reshape(2, 2) - low).ravel() * np.tile(per_m, 2)
        textures.paint(texture, place, WHITE, cover=COVER)
    size = high - low
    return surfaces.Quad(room_m[0], [size[0], 0, 0], [0, size[1], 0], texture)


def _other_lines(court):
    """Return other courts on the same floor: rectangles (n, 4) m and their colour, each."""
    beside = court.size_m[0] + 2.6
    shift = np.array([beside, 0, beside, 0])
    yield court.lines_m + shift, OTHER_BGR[0]
    yield court.lines_m - shift, OTHER_BGR[0]
    for grow, colour in (((1.6, 2.4), OTHER_BGR[1]), ((8.5, 6.5), OTHER_BGR[2])):
        low, high = -np.array(grow), court.size_m + grow
        yield _outline(low, high, 0.05), colour


def _outline(low, high, width):
    (x0, y0), (x1, y1) = low, high
    middle = (y0 + y1) / 2
    return np.array(
        [
            [x0, y0, x0 + width, y1],
            [x1 - width, y0, x1, y1],
            [x0, y0, x1, y0 + width],
            [x0, y1 - width, x1, y1],
            [x0, middle, x1, middle + width],
        ]
    )


def _walls(room_m, preset, rng):
    """Return four walls and the ceiling."""
    low, high = room_m
    wide, deep, tall = high - low
    corners = [
        ([low[0], low[1]], [0, 1], deep),
        ([low[0], high[1]], [1, 0], wide),
        ([high[0], high[1]], [0, -1], deep),
        ([high[0], low[1]], [-1, 0], wide),
    ]
    made = []
    for light, (corner, along, length) in zip((0.9, 1.0, 0.86, 0.95), corners, strict=True):
        texture = textures.wall(
            (length, tall), WALL_TEXEL_M, preset.contrast, preset.same_windows, rng
        )
        u = np.array([*along, 0.0]) * length
        made.append(surfaces.Quad([*corner, tall], u, [0, 0, -tall], texture, light))
    shape = round(deep / 0.04), round(wide / 0.04)
    top = 168 + (textures.blotches(shape, (9, 21, 60, 140), rng) * 22)[..., None] * np.ones(3)
    top[:: round(0.72 / 0.04)] -= 25
    top = textures.faded(textures.to_bytes(top), preset.contrast)
    made.append(surfaces.Quad([low[0], low[1], tall], [wide, 0, 0], [0, deep, 0], top, 0.72))
    return made
