"""A virtual sports hall round a court: walls, floor with painted lines, and furniture."""

from collections.abc import Iterator
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from courtside.calibration.court.court import Court
from virtualgym.hall import furniture, painted_lines, textures
from virtualgym.hall.look import USUAL, Look
from virtualgym.hall.quads import Quad
from virtualgym.presets import Preset

# ASSUME: sizes and colours of a large school hall, chosen by eye; no source is recorded.
FLOOR_TEXEL_M = 0.008
WALL_TEXEL_M = 0.014
HEIGHT_M = 10.0
NEAREST_M = 21.0  # court's centre to cameras, as `layouts.SQUARE_ON_M`; more for larger courts
BEHIND_CAMERAS_M = 2.0
WHITE = (242, 245, 245)
OTHER_BGR = ((120, 205, 225), (150, 90, 60), (80, 60, 170))  # lines of other sports
COVER = 0.95  # opacity of line paint


@dataclass(frozen=True, eq=False)
class Scene:
    """Everything that a picture of a hall may show.

    Attributes
    ----------
    quads : list of virtualgym.hall.quads.Quad
        The first is the floor, at z = 0.
    room_m : (2, 3) float
        Lowest and highest corner of the hall, world, metres.
    gloss : float
        Fraction of light that the floor reflects when seen from above.
    net : virtualgym.hall.painted_lines.Net or None
    court_xyz : (P, 3) float
        True places of the court's points, in the court's order, metres.
    lines_m : (L, 4) float
        True places of its lines: x0 y0 x1 y1.
    """

    quads: list[Quad]
    room_m: np.ndarray
    gloss: float
    net: painted_lines.Net | None
    court_xyz: np.ndarray
    lines_m: np.ndarray


def build(
    preset: Preset,
    court: Court,
    seed: int | np.random.SeedSequence,
    *,
    floor_texel_m: float = FLOOR_TEXEL_M,
    look: Look = USUAL,
    off_m: tuple[NDArray, NDArray] | None = None,
) -> Scene:
    """Build a hall.

    Parameters
    ----------
    seed : int or numpy.random.SeedSequence
        The same seed gives the same hall, bit by bit.
    floor_texel_m : float
        A coarser floor is built faster.
    look : Look
        Size, colours and patterns.
    off_m : tuple or None
        How far lines and posts stand off the court's file, from `painted_lines.misplacement`.

    Returns
    -------
    scene : Scene
        The usual hall is a square about the court's centre, large enough for cameras that see the
        whole court.
    """
    root = seed if isinstance(seed, np.random.SeedSequence) else np.random.SeedSequence(seed)
    state = np.random.SeedSequence(root.entropy, spawn_key=root.spawn_key)  # spawn leaves a trace
    paint, floor, shell, things = (np.random.default_rng(child) for child in state.spawn(4))
    painted = painted_lines.paint_court(court, preset, paint, off_m)
    room_m = room(court, look)
    quads = [_floor(court, painted, room_m, preset, floor_texel_m, floor, look)]
    quads += _walls(room_m, preset, shell, look)
    quads += furniture.ceiling(room_m, preset, shell)
    for make in (furniture.posters, furniture.stands, furniture.stage):
        quads += make(room_m, preset, things)
    quads += furniture.gear(court, room_m, preset, things)
    if painted.net is not None:
        quads += furniture.net(painted.net)
    return Scene(quads, room_m, preset.gloss, painted.net, painted.court_xyz, painted.lines_m)


def room(court: Court, look: Look = USUAL) -> NDArray:
    """Return the lowest and the highest corner of a court's hall, (2, 3) m."""
    short, long = sorted(court.size_m)
    half = (max(NEAREST_M, short / 2 + long) + BEHIND_CAMERAS_M) * np.array(look.room[:2])
    centre = court.size_m / 2
    return np.array([[*(centre - half), 0.0], [*(centre + half), HEIGHT_M * look.room[2]]])


def _floor(
    court: Court,
    painted: painted_lines.PaintedCourt,
    room_m: NDArray,
    preset: Preset,
    texel_m: float,
    rng: np.random.Generator,
    look: Look,
) -> Quad:
    low, high = room_m[:, :2]
    texture = textures.planks(high - low, texel_m, preset.contrast, preset.n_scuffs, rng, look)
    base = np.array(textures.FLOOR_BGR) + look.floor
    per_m = np.array(texture.shape[1::-1]) / (high - low)
    for lines_m, colour in _other_lines(court):
        # As weak as the other textures: at full contrast these lines would be the plain hall's best
        # features.
        own = base * (1 - preset.contrast) + np.array(colour) * preset.contrast
        for line in lines_m:
            textures.paint(
                texture, (line.reshape(2, 2) - low).ravel() * np.tile(per_m, 2), own, cover=COVER
            )
    centre = tuple(np.rint((court.size_m / 2 - low) * per_m * 16).astype(int).tolist())
    radius = round(1.8 * per_m[0] * 16)
    mixed = base * (1 - preset.contrast) + np.array(OTHER_BGR[2]) * preset.contrast
    cv2.circle(
        texture, centre, radius, mixed.tolist(), round(0.05 * per_m[0]), cv2.LINE_AA, shift=4
    )
    for line in painted.lines_m:
        place = (line.reshape(2, 2) - low).ravel() * np.tile(per_m, 2)
        textures.paint(texture, place, WHITE, cover=COVER)
    size = high - low
    return Quad(room_m[0], np.array([size[0], 0, 0]), np.array([0, size[1], 0]), texture)


def _other_lines(court: Court) -> Iterator[tuple[NDArray, tuple[int, int, int]]]:
    """Yield the rectangles (n, 4) m and the colour of each other court on the same floor."""
    beside = court.size_m[0] + 2.6
    shift = np.array([beside, 0, beside, 0])
    yield court.lines_m + shift, OTHER_BGR[0]
    yield court.lines_m - shift, OTHER_BGR[0]
    for grow, colour in (((1.6, 2.4), OTHER_BGR[1]), ((8.5, 6.5), OTHER_BGR[2])):
        low, high = -np.array(grow), court.size_m + grow
        yield _outline(low, high, 0.05), colour


def _outline(low: NDArray, high: NDArray, width: float) -> NDArray:
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


def _walls(room_m: NDArray, preset: Preset, rng: np.random.Generator, look: Look) -> list[Quad]:
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
            (length, tall), WALL_TEXEL_M, preset.contrast, preset.same_windows, rng, look
        )
        u = np.array([*along, 0.0]) * length
        made.append(Quad(np.array([*corner, tall]), u, np.array([0, 0, -tall]), texture, light))
    shape = round(deep / 0.04), round(wide / 0.04)
    noise = textures.multiscale_noise(shape, (9, 21, 60, 140), rng) * 22
    top = 168 + noise[..., None] * np.ones(3)
    top[:: round(0.72 / 0.04)] -= 25
    top = textures.scale_contrast(textures.to_bytes(top), preset.contrast)
    u, v = np.array([[wide, 0, 0], [0, deep, 0]])
    made.append(Quad(np.array([low[0], low[1], tall]), u, v, top, 0.72))
    return made
