"""Shading of one picture: what rays hit, reflections in a glossy floor, and the net."""

from collections.abc import Callable, Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from virtualgym.hall import painted_lines
from virtualgym.hall.hall import Scene
from virtualgym.rendering import textured_quads
from virtualgym.rendering.rays import BAND_RAYS, Rays

# Rotated grid supersampling: four rays with distinct rows and columns.
SUBPIXELS = np.array([[-0.375, -0.125], [0.125, -0.375], [0.375, 0.125], [-0.125, 0.375]])
# ASSUME: gloss of a varnished wooden floor and cover of a net, chosen by eye; they change pictures
# only.
ROUGHNESS = 2.0  # texture levels by which the floor blurs reflections
SMEAR = (3, 7)  # blur of reflected edges, px at half the picture's size, right and down
GRAZING = 3.5  # added reflectance at grazing angles, relative to that from above (Schlick's form)
MOST = 0.6  # greatest fraction of reflected light
LIFT_M = 1e-3  # reflected rays start this far above the floor
NET_BGR = np.array([35, 40, 45], np.float32)
NET_COVER = 0.28  # fraction of the view that the threads hide
FLOOR = 0  # index of the floor, the first quad of a scene
DOWN = np.array([1.0, 1.0, -1.0])  # reflection at the floor


class Exposure:
    """One picture while it is shaded.

    Parameters
    ----------
    scene : Scene
    parts : list of Surfaces
        The scene's own, then those of this picture only.
    seen : Rays
    """

    def __init__(self, scene: Scene, parts: Sequence[textured_quads.Surfaces], seen: Rays) -> None:
        self.scene = scene
        self.rays = seen
        self.eye = _Eye(parts, seen.eye, seen.steps, seen.velocity)
        self.parts = parts
        self.height, self.width = seen.xy.shape[1:]

    def picture(self) -> NDArray:
        """Return the picture (H, W, 3) float32, BGR, 0..255 or slightly more."""
        ids = np.empty((self.height, self.width), np.intp)
        hidden = np.empty((self.height, self.width), bool)
        colour = np.empty((self.height, self.width, 3), np.float32)
        shares = np.zeros((self.height, self.width), np.float32)
        rows = max(1, BAND_RAYS // self.width)
        for start in range(0, self.height, rows):
            part = slice(start, min(start + rows, self.height))
            direction, time_s = self.rays.of_band(part.start, part.stop)
            index, band, behind_net = self._sample(direction, time_s)
            shape = (-1, self.width)
            ids[part], hidden[part] = index.reshape(shape), behind_net.reshape(shape)
            colour[part] = band.reshape(*shape, 3)
            if self.scene.gloss > 0:
                shares[part] = self._share(index, direction).reshape(shape)
        flat = colour.reshape(-1, 3)
        mirrored = self._mirrored(ids) if self.scene.gloss > 0 else None
        if mirrored is not None:
            _mix(colour, mirrored.reshape(colour.shape), shares)
        edges = _edges(ids, hidden)
        flat[edges] = self._supersampled(edges, mirrored)
        return colour

    def _supersampled(self, pixel: NDArray, mirrored: NDArray | None) -> NDArray:
        """Return the mean colour (n, 3) of some pixels over SUBPIXELS."""
        total = np.zeros((len(pixel), 3), np.float32)
        directions, time_s = self.rays.near(pixel, SUBPIXELS)
        for direction in directions:
            index, colour, _ = self._sample(direction, time_s)
            if mirrored is not None:
                _mix(colour, mirrored[pixel], self._share(index, direction))
            total += colour
        return total / len(SUBPIXELS)

    def _sample(
        self, direction: NDArray, time_s: NDArray | None
    ) -> tuple[NDArray, NDArray, NDArray]:
        """Return hit quads (n,), colours (n, 3) without gloss, whether the net is in front (n,)."""
        origin = self.rays.origins(time_s)
        index = self.eye.trace(origin, direction, time_s)
        colour = self.eye.colour(index, direction, time_s)
        hidden = np.zeros(len(index), bool)
        if self.scene.net is not None:
            crossed, share = cross(self.scene.net, origin, direction)
            far = self.eye.distance(
                index[crossed], direction[:, crossed], None if time_s is None else time_s[crossed]
            )
            crossed = crossed[share < far]
            hidden[crossed] = True
            colour[crossed] *= 1 - NET_COVER
            colour[crossed] += NET_COVER * NET_BGR
        return index, colour, hidden

    def _mirrored(self, ids: NDArray) -> NDArray:
        """Return the floor's reflection in each pixel on and next to it, (H * W, 3) float32."""
        # ASSUME: half the resolution is enough, as the floor blurs its reflections.
        half = self.rays.halved()
        height, width = half.xy.shape[1:]
        floor = (ids[: 2 * height, : 2 * width] == FLOOR).astype(np.uint8)
        floor = np.maximum(floor[::2], floor[1::2])
        floor = np.maximum(floor[:, ::2], floor[:, 1::2])
        pixel = np.flatnonzero(cv2.dilate(floor, np.ones((3, 3), np.uint8)))
        (direction,), time_s = half.near(pixel)
        below = np.flatnonzero(direction[2] < -textured_quads.TINY)
        pixel, direction = pixel[below], direction[:, below]
        time_s = None if time_s is None else time_s[below]
        start = np.broadcast_to(half.origins(time_s), direction.T.shape)
        start = start - direction.T * (start[:, 2] / direction[2])[:, None]
        start[:, 2] = LIFT_M
        direction[2] *= -1
        velocity = None if half.velocity is None else half.velocity * DOWN
        image = _Eye(self.parts, half.eye * DOWN, half.steps * DOWN, velocity)
        index = image.trace(start, direction, time_s)
        light = np.zeros((height * width, 4), np.float32)
        light[pixel, :3] = image.colour(index, direction, time_s, coarser=ROUGHNESS, taps=2)
        light[pixel, 3] = 1
        light = cv2.blur(light.reshape(height, width, 4), SMEAR)
        light = light[..., :3] / np.maximum(light[..., 3:], textured_quads.TINY)
        light = cv2.resize(light, (2 * width, 2 * height), interpolation=cv2.INTER_LINEAR)
        odd = self.height - 2 * height, self.width - 2 * width
        if any(odd):
            light = cv2.copyMakeBorder(light, 0, odd[0], 0, odd[1], cv2.BORDER_REPLICATE)
        return light.reshape(-1, 3)

    def _share(self, index: NDArray, direction: NDArray) -> NDArray:
        """Return the fraction (n,) float32 of reflected light in each ray; 0 off the floor."""
        upright = np.abs(direction[2]) / np.sqrt(np.einsum("in,in->n", direction, direction))
        share = np.float32(self.scene.gloss) * (1 + np.float32(GRAZING) * (1 - upright) ** 5)
        return np.minimum(share, np.float32(MOST)) * (index == FLOOR)


class _Eye:
    """Several sets of surfaces seen from one point, with consecutive indices."""

    def __init__(
        self,
        parts: Sequence[textured_quads.Surfaces],
        eye: NDArray,
        steps: NDArray,
        velocity: NDArray | None,
    ) -> None:
        self.parts = parts
        self.views = [textured_quads.View(part, eye, steps, velocity) for part in parts]
        self.first = np.cumsum([0] + [len(part.quads) for part in parts])

    def trace(self, origin: NDArray, direction: NDArray, time_s: NDArray | None) -> NDArray:
        """Return the nearest quad of all parts that each ray (3, n) hits, (n,) intp."""
        rays = np.ascontiguousarray(direction.T)
        index = self.parts[0].hit(origin, rays)
        for missed in np.flatnonzero(index < 0):  # rare: between quads that only touch
            index[missed] = index[missed - 1]
        for part, first in zip(self.parts[1:], self.first[1:], strict=False):
            other = part.hit(origin, rays)
            found = np.flatnonzero(other >= 0)
            at = direction[:, found], None if time_s is None else time_s[found]
            other = other[found] + first
            nearer = self.distance(other, *at) < self.distance(index[found], *at)
            index[found[nearer]] = other[nearer]
        return index

    def distance(self, index: NDArray, direction: NDArray, time_s: NDArray | None) -> NDArray:
        """Return the distance to each ray's quad, (n,) float32, in units of its direction."""
        return self._each(textured_quads.View.distance, (), index, direction, time_s)

    def colour(
        self, index: NDArray, direction: NDArray, time_s: NDArray | None, **detail: float
    ) -> NDArray:
        """Return the colours (n, 3) float32 that rays see on their quads."""
        return self._each(textured_quads.shade, (3,), index, direction, time_s, **detail)

    def _each(
        self,
        function: Callable[..., NDArray],
        shape: tuple[int, ...],
        index: NDArray,
        direction: NDArray,
        time_s: NDArray | None,
        **detail: float,
    ) -> NDArray:
        last = self.first[1]
        if len(self.parts) == 1 or not len(index) or index.max() < last:
            return function(self.views[0], index, direction, time_s, **detail)
        result = np.empty((len(index), *shape), np.float32)
        for view, first, end in zip(self.views, self.first, self.first[1:], strict=False):
            mine = np.flatnonzero((index >= first) & (index < end))
            times = None if time_s is None else time_s[mine]
            local = index[mine] - first
            result[mine] = function(view, local, direction[:, mine], times, **detail)
        return result


def cross(net: painted_lines.Net, origin: NDArray, direction: NDArray) -> tuple[NDArray, NDArray]:
    """Return the rays that cross the net's mesh, and their distances to it, each (m,).

    Distances are in units of the rays' directions.

    Parameters
    ----------
    net : Net
    origin, direction : (..., 3) float, (3, n) float
        Of the rays, metres; one origin may serve all.
    """
    start, end = net.feet
    along = end - start
    normal = np.array([along[1], -along[0], 0.0])
    # `@` takes five times as long for rows of three.
    away = sum((start[axis] - origin[..., axis]) * normal[axis] for axis in (0, 1))
    speed = direction[0] * np.float32(normal[0]) + direction[1] * np.float32(normal[1])
    with np.errstate(divide="ignore", invalid="ignore"):
        share = (away / speed).astype(np.float32)
    height = origin[..., 2] + share * direction[2]
    ahead = np.flatnonzero((share > 0) & (height > 0) & (height < net.tips[:, 2].max()))
    share = share[ahead]
    origin = np.broadcast_to(origin, direction.T.shape)[ahead]
    place = origin + (direction[:, ahead] * share).T
    way = (place - start) @ along / (along @ along)
    top = net.tape(way)[:, 2]
    inside = (way > 0) & (way < 1) & (place[:, 2] < top - painted_lines.TAPE_M)
    inside &= place[:, 2] > top - painted_lines.NET_DEPTH_M
    return ahead[inside], share[inside]


def _mix(colour: NDArray, other: NDArray, share: NDArray) -> None:
    """Blend colours (..., 3) in place; one channel at a time takes a third of the time."""
    for channel in range(3):
        own = colour[..., channel]
        own += share * (other[..., channel] - own)


def _edges(*maps: NDArray) -> NDArray:
    """Return the pixels that differ from a neighbour in any of the maps (H, W), (n,) intp."""
    edge = np.zeros(maps[0].shape, bool)
    for values in maps:
        across, down = values[:, 1:] != values[:, :-1], values[1:] != values[:-1]
        edge[:, 1:] |= across
        edge[:, :-1] |= across
        edge[1:] |= down
        edge[:-1] |= down
    return np.flatnonzero(edge)
