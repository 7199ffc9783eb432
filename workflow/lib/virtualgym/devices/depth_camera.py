"""A colour and depth camera: true depth of bodies and hall, and what the sensor makes of it."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from courtside.geometry import rotations
from courtside.geometry.camera import Camera, look_at
from virtualgym.body.athlete import Athlete
from virtualgym.devices import depth_noise
from virtualgym.rendering import (
    background,
    coverage,
    player_renderer,
    rays,
    rolling_shutter,
    shading,
    textured_quads,
)
from virtualgym.rendering.hall_renderer import Renderer
from virtualgym.rendering.rolling_shutter import Box, HasMesh, Screen

# ASSUME: rotation of the depth sensor's axes in the colour sensor's, of the size of assembly
# tolerances.
TURN_DEG = (0.15, -0.2, 0.1)
GRAIN, NOISE = range(2)  # independent streams of random numbers
FIELD, FRAMES = range(2)  # of each


@dataclass(frozen=True)
class DepthCamera:
    """Settings of a colour and depth camera; defaults: Intel's D415, data sheet [Homma2023, B1].

    Attributes
    ----------
    distance_m : float
        Horizontal distance from the player.
    height_m : float
        Above the floor.
    azimuth_deg : float
        Round the player, from their first heading to their left.
    aim_m : float
        Height on the player's axis at which it is aimed.
    size_px, depth_size_px : (int, int)
        Width and height of the colour and of the depth frames; the second as the first if None.
    rate_hz : float
        Frames per second by its own clock; colour and depth are taken together.
    fov_deg : (float, float)
        Field of view across and down, of both sensors.
    baseline_m : float
        Between the two imagers that are matched; depth is that of the left one.
    subpixel_px : float
        Standard deviation s of a disparity: depth z scatters by z^2 s / (f b).
    correlation_px : float
        Standard deviation of the window over which depth errors are correlated, as by block
        matching.
    depth_unit_m : float
        One step of depth.
    range_m : (float, float)
        There are holes outside of it.
    edge_px : float
        Distance from a depth edge within which matches may fail.
    edge_holes, holes : float
        Fraction of pixels without depth there, and elsewhere; new in each frame.
    colour_from_depth_m : (3,) float
        Depth sensor's centre in the colour sensor's axes.
    readout_s, exposure_s : float
        Of both rolling shutters, as in `player_renderer.Film`.
    noise_sigma : float
        Of the colour sensor, 8-bit levels.
    subject : str or None
        The person it is aimed at; None: the first player.
    """

    distance_m: float = 3.0
    height_m: float = 1.0
    azimuth_deg: float = 0.0
    aim_m: float = 1.0
    size_px: tuple[int, int] = (640, 360)
    depth_size_px: tuple[int, int] | None = None
    rate_hz: float = 30.0
    fov_deg: tuple[float, float] = (69.4, 42.5)
    baseline_m: float = 0.055
    subpixel_px: float = 0.08
    correlation_px: float = 1.5
    depth_unit_m: float = 0.001
    range_m: tuple[float, float] = (0.3, 10.0)
    edge_px: float = 1.5
    edge_holes: float = 0.5
    holes: float = 0.003
    colour_from_depth_m: tuple[float, float, float] = (0.015, 0.0, 0.0)
    readout_s: float = 0.016
    exposure_s: float = 0.006
    noise_sigma: float = 2.0
    subject: str | None = None

    def __post_init__(self) -> None:
        for name in ("size_px", "fov_deg", "range_m", "colour_from_depth_m"):
            object.__setattr__(self, name, tuple(getattr(self, name)))
        object.__setattr__(self, "depth_size_px", tuple(self.depth_size_px or self.size_px))
        for name in ("distance_m", "rate_hz", "baseline_m", "depth_unit_m"):
            if not getattr(self, name) > 0:
                raise ValueError(f"expected {name} above 0, found {getattr(self, name)}")
        if not 0 < self.range_m[0] < self.range_m[1]:
            raise ValueError(f"expected range_m as [near, far], found {list(self.range_m)}")

    @property
    def colour_from_depth(self) -> NDArray:
        """From the depth sensor's axes to the colour sensor's, (3, 4), metres."""
        turn = rotations.rotation_from_rodrigues(np.radians(TURN_DEG))
        return np.column_stack([turn, self.colour_from_depth_m])

    def errors(self) -> depth_noise.DepthErrors:
        """Return the error model of its depth."""
        focal_px = self._focal_px(self.depth_size_px or self.size_px)[0]
        return depth_noise.DepthErrors(
            focal_baseline=focal_px * self.baseline_m,
            subpixel_px=self.subpixel_px,
            correlation_px=self.correlation_px,
            unit_m=self.depth_unit_m,
            range_m=self.range_m,
            edge_px=self.edge_px,
            edge_holes=self.edge_holes,
            holes=self.holes,
        )

    def place(self, name: str, player: Athlete) -> tuple[Camera, Camera]:
        """Set it up before a player's place at the start of their motion.

        Returns
        -------
        colour, depth : Camera
            In the world.
        """
        start = player.motion.stance(0.0)
        middle, ahead = start.pelvis[:2], start.world_from_pelvis[:2, 2]
        angle = np.arctan2(ahead[1], ahead[0]) + np.radians(self.azimuth_deg)
        away = self.distance_m * np.array([np.cos(angle), np.sin(angle)])
        pose = look_at([*(middle + away), self.height_m], [*middle, self.aim_m])
        depth = self._camera(f"{name}-depth", self.depth_size_px or self.size_px, pose)
        turn, shift = self.colour_from_depth[:, :3], self.colour_from_depth[:, 3]
        moved = np.column_stack([turn @ pose[:, :3], turn @ pose[:, 3] + shift])
        return self._camera(name, self.size_px, moved), depth

    def _focal_px(self, size_px: tuple[int, int]) -> NDArray:
        return np.array(size_px) / 2 / np.tan(np.radians(self.fov_deg) / 2)

    def _camera(self, name: str, size_px: tuple[int, int], pose: NDArray) -> Camera:
        across, down = self._focal_px(size_px)
        width, height = size_px
        matrix = np.array([[across, 0, (width - 1) / 2], [0, down, (height - 1) / 2], [0, 0, 1]])
        return Camera(name, size_px, matrix, np.zeros(5), pose)


class Recorder:
    """A depth camera in a hall, ready to film athletes.

    Parameters
    ----------
    settings : DepthCamera
    colour, depth : Camera
        From `DepthCamera.place`.
    renderer : Renderer
        Of the hall.
    athletes : list of Athlete
    seed : numpy.random.SeedSequence
        Of noise and holes.
    """

    def __init__(
        self,
        settings: DepthCamera,
        colour: Camera,
        depth: Camera,
        renderer: Renderer,
        athletes: Sequence[HasMesh],
        seed: np.random.SeedSequence,
    ) -> None:
        self.settings, self.athletes, self._seed = settings, athletes, seed
        hall = background.look(renderer, colour)
        self._film = player_renderer.Film(hall, settings.readout_s, settings.exposure_s)
        self._depth, self._hall_m = depth, of_hall(renderer, depth)
        self._grain = player_renderer.Grain(
            colour.size, settings.noise_sigma, self._rng(GRAIN, FIELD)
        )
        self._sensor = depth_noise.Sensor(settings.errors(), depth.size, self._rng(NOISE, FIELD))

    def frame(self, index: int, time_s: float) -> tuple[NDArray, NDArray]:
        """Take a frame.

        Parameters
        ----------
        index : int
            Its number, which selects the noise.
        time_s : float
            Mid-exposure of the middle row, on the athletes' clock.

        Returns
        -------
        bgr : (H, W, 3) uint8
        depth : (h, w) uint16
        """
        picture = self._film.picture(self.athletes, time_s)
        bgr = self._grain.added(picture, self._rng(GRAIN, FRAMES, index))
        rng = self._rng(NOISE, FRAMES, index)
        return bgr, self._sensor.measured(self.true_depth_m(time_s), rng)

    def true_depth_m(self, time_s: float) -> NDArray:
        """Return the true depth from the depth sensor, (h, w) float32; inf: nothing."""
        readout_s = self.settings.readout_s
        bodies = of_athletes(self.athletes, self._depth, time_s, readout_s)
        return np.minimum(bodies, self._hall_m)

    def _rng(self, *key: int) -> np.random.Generator:
        seed = np.random.SeedSequence(self._seed.entropy, spawn_key=(*self._seed.spawn_key, *key))
        return np.random.default_rng(seed)


NEAREST_M = 0.1  # nearer surfaces are left out
FAR = 1 / NEAREST_M  # upper limit of inverse depth


def of_hall(renderer: Renderer, camera: Camera) -> NDArray:
    """Measure an empty hall.

    Returns
    -------
    depth_m : (H, W) float32
        Along the camera's axis; inf where nothing is. The net's mesh is too thin to be measured.
    """
    seen = rays.of_camera(camera, rays.grid(camera), None, 0.0)
    view = textured_quads.View(renderer.surfaces, seen.eye, seen.steps)
    width, height = camera.size
    depth_m = np.empty(height * width, np.float32)
    for part, direction in seen.bands():
        quad = renderer.surfaces.hit(seen.eye.astype(np.float32), np.ascontiguousarray(direction.T))
        away = view.distance(quad, direction, None)
        depth_m[part] = np.where(quad >= shading.FLOOR, away, np.inf)
    return depth_m.reshape(height, width)


def of_athletes(
    athletes: Sequence[HasMesh], camera: Camera, time_s: float, readout_s: float
) -> NDArray:
    """Measure moving surfaces, each row of the picture at its own time (as in `Screen`).

    Returns
    -------
    depth_m : (H, W) float32
        Along the camera's axis; inf where no surface is.

    Notes
    -----
    Rays are cast in picture coordinates: rolling shutter and lens are exact at every vertex, and
    inverse depth is linear on every triangle, so that depth is exact between vertices, too.
    """
    width, height = camera.size
    depth_m = np.full((height, width), np.inf, np.float32)
    shutter = time_s, readout_s, 0.0
    screens = [
        rolling_shutter.Screen(rolling_shutter.follow(each, camera, *shutter), camera, *shutter)
        for each in athletes
    ]
    for box, group in player_renderer.grouped(screens):
        part = slice(box[1], box[3]), slice(box[0], box[2])
        depth_m[part] = _cast(group, box)
    return depth_m


def _cast(screens: Sequence[Screen], box: Box) -> NDArray:
    """Return the depth in a box of the picture, (h, w)."""
    parts: list[NDArray] = []
    faces: list[NDArray] = []
    corner = np.array([*box[:2], 0.0])[:, np.newaxis]
    for screen in screens:
        vertices, triangles = screen.at(0.0).T - corner, screen.moving.triangles
        triangles = triangles[_shown(vertices, triangles)] + sum(part.shape[1] for part in parts)
        vertices[2] = FAR - 1 / np.maximum(vertices[2], NEAREST_M)
        parts.append(vertices)
        faces.append(triangles.T)
    vertices, corners = np.hstack(parts).astype(np.float32), np.hstack(faces)
    first, last = coverage.spans(vertices, corners)
    corners = corners[:, _met(first, last)]
    shape = box[3] - box[1], box[2] - box[0]
    row, column = np.indices(shape, np.float32).reshape(2, -1)
    start = np.stack([column, row, np.zeros_like(row)], axis=1)
    along = np.zeros_like(start)
    along[:, 2] = 1
    found = coverage.scene(vertices, corners).run(start, along, query="DISTANCE")
    with np.errstate(divide="ignore"):
        depth = np.where(found < FAR, 1 / np.maximum(FAR - found, 1e-9), np.inf)
    return depth.astype(np.float32).reshape(shape)


def _shown(vertices: NDArray, triangles: NDArray) -> NDArray:
    """Return which triangles are wholly in front of the camera and face it, (F,) bool."""
    (x, y, depth), (a, b, c) = vertices, triangles.T
    with np.errstate(invalid="ignore"):
        seen = np.isfinite(x) & np.isfinite(y) & np.isfinite(depth) & (depth > NEAREST_M)
        # Counter-clockwise seen from outside; negative, as pixel rows count downwards.
        area = (x[b] - x[a]) * (y[c] - y[a]) - (x[c] - x[a]) * (y[b] - y[a])
    return (area < 0) & seen[a] & seen[b] & seen[c]


def _met(first: NDArray, last: NDArray) -> NDArray:
    """Return which triangles with these spans (2, F) may hit a pixel's ray; many do not."""
    low, high = np.ceil(first - coverage.NEAR_PX), np.floor(last + coverage.NEAR_PX)
    return np.all(low <= high, axis=0)
