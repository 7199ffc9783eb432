"""Furniture of a virtual hall: gear, posters, stands, stage, ceiling beams and lamps, net."""

import itertools
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.court.court import Court
from virtualgym.hall import painted_lines, quads, textures
from virtualgym.presets import Preset

# ASSUME: sizes, places and colours chosen to look like a sports hall; they change pictures only.
BOX_TEXEL_M = 0.012
POSTER_TEXEL_M = 0.006
POSTER_OFF_M = 0.02  # from the wall
LOW_M = 0.55  # greatest height of gear round the court
# Nearest and lowest camera that must see the court over the gear: distance from it, height.
VIEW_M = (12.0, 1.9)
CLEAR_M = 1.2  # free floor round the court, for the players
RING_M = 7.0  # greatest distance of gear from the court
TALL_WITHIN_M = 0.8  # of a wall, gear may be as high as a person
STAND_M = 2.6
CURTAIN_BGR = (60, 44, 120)
SEAT_BGR = (150, 90, 50)
STEEL_BGR = (150, 156, 160)
TAPE_SEGMENTS = 12


def sizes_px(edges: Sequence[float], texel_m: float = BOX_TEXEL_M) -> tuple[int, int]:
    """Return (height, width) px of a texture for a face of width and height `edges`, m."""
    width, height = (int(np.clip(round(length / texel_m), 4, 1200)) for length in edges)
    return height, width


def crate(
    centre_xy: NDArray,
    half_m: NDArray,
    floor_m: float,
    height_m: float,
    yaw: float,
    preset: Preset,
    rng: np.random.Generator,
) -> list[quads.Quad]:
    """Return the faces of a crate.

    Parameters
    ----------
    centre_xy : (2,) float
        Metres.
    half_m : (2,) float
        Half its width and depth.
    floor_m, height_m : float
        Height of its bottom above the floor, and of the crate.
    yaw : float
        About the vertical axis, radians.
    """
    cos, sin = np.cos(yaw), np.sin(yaw)
    edges = np.diag([2 * half_m[0], 2 * half_m[1], height_m])
    edges[:2, :2] = edges[:2, :2] @ [[cos, sin], [-sin, cos]]
    corner = np.array([*centre_xy, floor_m]) - (edges[0] + edges[1]) / 2
    faces = [
        textures.scale_contrast(textures.crate(sizes_px((2 * half, other)), rng), preset.contrast)
        for half, other in (
            (half_m[0], height_m),
            (half_m[1], height_m),
            (half_m[0], 2 * half_m[1]),
        )
    ]
    return quads.box(corner, edges, [faces[0], faces[1], faces[0], faces[1], faces[2], faces[2]])


def gear(
    court: Court, room_m: NDArray, preset: Preset, rng: np.random.Generator
) -> list[quads.Quad]:
    """Return crates, bags and mats on the floor: low round the court, higher along the walls.

    None is on the court, where people walk with a camera, or between camera and court.

    Parameters
    ----------
    room_m : (2, 3) float
        Lowest and highest corner of the hall.
    """
    made = []
    for _ in range(preset.n_gear):
        ring = rng.uniform() < 0.7
        low, high = room_m[0, :2] + 0.6, room_m[1, :2] - 0.6
        if ring:
            low, high = -np.full(2, RING_M), court.size_m + RING_M
        place, half, yaw = rng.uniform(low, high), rng.uniform(0.12, 0.5, 2), rng.uniform(0, np.pi)
        share, reach = rng.uniform((0.4, 0.1), (0.75, 0.25)), np.hypot(*half)
        if ring:
            outside = np.maximum(np.maximum(-place, place - court.size_m), 0)
            away = np.hypot(*outside) - reach
            free, height = away > CLEAR_M, min(LOW_M, VIEW_M[1] * away / (VIEW_M[0] + away))
        else:  # against the walls without stage and stands
            axis = int(rng.integers(2))
            place[axis] = room_m[0, axis] + reach
            free, height = 2 * reach < TALL_WITHIN_M, 2.0
        if not free:
            continue
        made += crate(place, half, 0.0, height * share[0], yaw, preset, rng)
        if rng.uniform() < 0.35:
            floor_m, height_m = height * share
            made += crate(place, half * 0.5, floor_m, height_m, yaw + 0.5, preset, rng)
    return made


def posters(room_m: NDArray, preset: Preset, rng: np.random.Generator) -> list[quads.Quad]:
    """Return posters on the four walls; `room_m` as in `gear`."""
    made = []
    centre = room_m.mean(axis=0)
    for wall in range(4):
        axis, side = wall % 2, wall // 2
        along, inward = np.eye(3)[axis], np.eye(3)[1 - axis] * (1 - 2 * side)
        right = along if np.cross(along, [0, 0, 1.0]) @ inward > 0 else -along
        length = room_m[1, axis] - room_m[0, axis]
        for number in range(rng.poisson(preset.posters_per_m * length)):
            width, height = rng.uniform((0.6, 0.5), (1.8, 1.4))
            offset = rng.uniform(-length / 2 + 1, length / 2 - 1 - width)
            bottom = rng.uniform(0.9, 3.6)
            image = textures.poster(sizes_px((width, height), POSTER_TEXEL_M), rng)
            off_m = POSTER_OFF_M + 0.004 * number  # so that no two are in one plane
            at = centre + right * offset
            at[1 - axis] = room_m[side, 1 - axis] + inward[1 - axis] * off_m
            at[2] = bottom + height
            image = textures.scale_contrast(image, preset.contrast)
            made.append(quads.Quad(at, right * width, np.array([0, 0, -height]), image))
    return made


def stands(room_m: NDArray, preset: Preset, rng: np.random.Generator) -> list[quads.Quad]:
    """Return rows of seats along the wall at the highest x; `room_m` as in `gear`."""
    made, rows = [], 5
    south, north = room_m[0, 1] + 9, room_m[1, 1] - 7
    for row in range(rows):
        deep, high = STAND_M / rows, 0.42 * (row + 1)
        corner = np.array([room_m[1, 0] - STAND_M + row * deep, south, 0.0])
        edges = np.diag([deep, north - south, high])
        front = textures.cloth(sizes_px((north - south, high), 0.02), SEAT_BGR, rng, folds=60)
        top = textures.cloth(sizes_px((deep, north - south), 0.03), SEAT_BGR, rng, folds=6)
        end = textures.cloth(sizes_px((deep, high), 0.02), SEAT_BGR, rng)
        faces = [
            textures.scale_contrast(face, preset.contrast)
            for face in (end, front, end, front, top, top)
        ]
        made += quads.box(corner, edges, faces)
    return made


def stage(room_m: NDArray, preset: Preset, rng: np.random.Generator) -> list[quads.Quad]:
    """Return a stage with curtains along the wall at the highest y; `room_m` as in `gear`."""
    centre_x, wall_y = room_m[:, 0].mean(), room_m[1, 1]
    made = []
    for corner, size, colour in (
        ((centre_x - 9, wall_y - STAND_M, 0), (18, STAND_M - 0.1, 1.1), textures.PANEL_BGR),
        ((centre_x - 8.5, wall_y - 1.2, 1.1), (3.2, 0.5, 5.0), CURTAIN_BGR),
        ((centre_x + 5.3, wall_y - 1.2, 1.1), (3.2, 0.5, 5.0), CURTAIN_BGR),
    ):
        front = textures.scale_contrast(
            textures.cloth(sizes_px((size[0], size[2]), 0.015), colour, rng), preset.contrast
        )
        made += quads.box(np.array(corner, dtype=float), np.diag(size).astype(float), front)
    return made


def ceiling(room_m: NDArray, preset: Preset, rng: np.random.Generator) -> list[quads.Quad]:
    """Return ceiling beams and lamps; `room_m` as in `gear`."""
    low, high = room_m
    steel = textures.scale_contrast(
        textures.cloth((64, 512), STEEL_BGR, rng, folds=30), preset.contrast
    )
    lamp = np.full((8, 32, 3), 250, np.uint8)
    made = []
    for y in np.arange(low[1] + 3, high[1], 5.0):
        corner, size = [low[0], y - 0.15, high[2] - 1.1], [high[0] - low[0], 0.3, 0.5]
        made += quads.box(np.array(corner), np.diag(size), steel)
    for x in np.arange(low[0] + 4, high[0], 7.0):
        corner, size = [x - 0.1, low[1], high[2] - 0.95], [0.2, high[1] - low[1], 0.2]
        made += quads.box(np.array(corner), np.diag(size), steel)
        for y in np.arange(low[1] + 5.5, high[1] - 2, 5.0):
            corner, size = [x + 2.4, y - 0.2, high[2] - 1.4], [1.2, 0.4, 0.15]
            made += quads.box(np.array(corner), np.diag(size), lamp, light=1.25)
    return made


def net(fabric: painted_lines.Net) -> list[quads.Quad]:
    """Return two posts and the net's white tape; the renderer adds the mesh."""
    half = painted_lines.POST_M / 2
    steel, white = np.full((64, 4, 3), (70, 76, 82), np.uint8), np.full((4, 16, 3), 236, np.uint8)
    made = []
    for foot, tip in zip(fabric.feet, fabric.tips, strict=True):
        edges = np.array([[2 * half, 0, 0], [0, 2 * half, 0], tip - foot])
        made += quads.box(foot - [half, half, 0], edges, steel)
    edge = fabric.tape(np.linspace(0, 1, TAPE_SEGMENTS + 1))
    down = np.array([0, 0, -painted_lines.TAPE_M])
    for start, end in itertools.pairwise(edge):
        made.append(quads.Quad(start, end - start, down, white))
    return made
