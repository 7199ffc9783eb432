"""Pictures of athletes in a hall, as a fixed camera takes them."""

from collections.abc import Iterable, Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from courtside.geometry import camera, rotations
from virtualgym.cameras import camera_shake
from virtualgym.rendering import coverage, rays, rolling_shutter, sensor, shadows
from virtualgym.rendering.background import Backdrop
from virtualgym.rendering.rolling_shutter import Box, HasMesh, Screen

PAD_PX = 3  # round an athlete: reach of the lens's blur
GRAIN_PX = 256  # size of the noise field beyond the picture's


class Film:
    """A fixed camera, ready to film athletes.

    Parameters
    ----------
    backdrop : Backdrop
    readout_s : float
        Row v is exposed at ((v + 0.5) / H - 0.5) * readout_s.
    exposure_s : float
        Of each row.
    """

    def __init__(self, backdrop: Backdrop, readout_s: float, exposure_s: float) -> None:
        self.backdrop, self.readout_s, self.exposure_s = backdrop, readout_s, exposure_s
        self.camera = backdrop.filmed
        self.xy = rays.grid(self.camera)
        wide = rays.grid(backdrop.camera) if backdrop.margin_px else self.xy
        self.corner = float((wide[0] ** 2 + wide[1] ** 2).max())
        self.warp = camera_shake.Warp(self.camera, backdrop.camera)

    def picture(
        self, athletes: Sequence[HasMesh], time_s: float, still_from_shaken: NDArray | None = None
    ) -> NDArray:
        """Render a picture.

        Parameters
        ----------
        athletes : sequence of HasMesh
        time_s : float
            Mid-exposure of the middle row, on the athletes' clock.
        still_from_shaken : (3, 3) float or None
            Rotation of the camera, if it shakes.

        Returns
        -------
        picture : (H, W, 3) uint8
            BGR, without noise.
        """
        shot = _Shot(self, still_from_shaken)
        shutter = time_s, self.readout_s, self.exposure_s
        moving = [rolling_shutter.follow(athlete, shot.camera, *shutter) for athlete in athletes]
        for each in moving:
            shot.darken(shadows.cast(each.vertices, each.triangles))
        screens = [rolling_shutter.Screen(each, shot.camera, *shutter) for each in moving]
        for box, group in grouped(screens):
            shot.add(box, group)
        return shot.picture


class _Shot:
    """One picture while it is rendered."""

    def __init__(self, film: Film, still_from_shaken: NDArray | None) -> None:
        self.film, backdrop = film, film.backdrop
        self.camera, self.places = film.camera, None
        if still_from_shaken is None:
            self.picture = backdrop.picture[_inside(backdrop.margin_px)].copy()
            return
        self.camera = camera_shake.turned(film.camera, still_from_shaken)
        self.places = film.warp.places(still_from_shaken)
        x, y = self.places
        self.picture = cv2.remap(
            backdrop.picture, x, y, cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE
        )

    def darken(self, shadow: shadows.Shadow) -> None:
        """Darken the floor by a shadow."""
        corners = camera.project(self.camera, shadow.outline())
        box = rolling_shutter.bounds(corners, self.camera.size, PAD_PX)
        if box is None:
            return
        part = _part(box)
        pose = self.camera.cam_from_world
        direction = np.tensordot(
            pose[:, :3].T.astype(np.float32),
            np.concatenate([self.film.xy[:, *part], np.ones((1, *_shape(box)), np.float32)]),
            axes=1,
        )
        light = shadow.seen(rotations.invert(pose)[:, 3], direction)
        light[~self._hall("floor", box).astype(bool)] = 1
        self.picture[part] = np.rint(self.picture[part] * light[..., None]).astype(np.uint8)

    def add(self, box: Box, screens: Sequence[Screen]) -> None:
        """Draw athletes into a part of the picture."""
        part = _part(box)
        layer = coverage.cover(screens, box, self._hall("solid_m", box), self._hall("net_m", box))
        layer = cv2.GaussianBlur(layer, (5, 5), sensor.OPTICS_PX, borderType=cv2.BORDER_REPLICATE)
        x, y = self.film.xy[:, *part]
        vignette = 1 - np.float32(sensor.VIGNETTE / self.film.corner) * (x**2 + y**2)
        light = self.picture[part] * (1 - layer[..., 3:])
        light += layer[..., :3] * vignette[..., None]
        self.picture[part] = np.clip(np.rint(light), 0, 255).astype(np.uint8)

    def _hall(self, name: str, box: Box) -> NDArray:
        """Return one of the backdrop's maps in a box of the picture."""
        values = getattr(self.film.backdrop, name)
        if self.places is None:
            return values[_inside(self.film.backdrop.margin_px)][_part(box)]
        x, y = np.rint(self.places[:, *_part(box)]).astype(int)
        height, width = values.shape
        return values[np.clip(y, 0, height - 1), np.clip(x, 0, width - 1)]


class Grain:
    """Sensor noise: each picture gets a random window of one large field.

    Parameters
    ----------
    size : (int, int)
        Width and height of the pictures.
    sigma : float
        Standard deviation, 8-bit levels.
    rng : numpy.random.Generator
    """

    def __init__(self, size: tuple[int, int], sigma: float, rng: np.random.Generator) -> None:
        shape = size[1] + GRAIN_PX, size[0] + GRAIN_PX, 3
        field = rng.standard_normal(shape, dtype=np.float32)
        field *= np.float32(sigma)
        # Positive and negative parts as bytes: adding them takes a third of the time.
        self._fields = [cv2.multiply(field, sign, dtype=cv2.CV_8U) for sign in (1, -1)]

    def added(self, picture: NDArray, rng: np.random.Generator) -> NDArray:
        """Return a picture with noise, (H, W, 3) uint8."""
        top, left = rng.integers(0, GRAIN_PX + 1, 2)
        height, width = picture.shape[:2]
        lighter, darker = (field[top : top + height, left : left + width] for field in self._fields)
        noisy = cv2.add(picture, lighter)
        return cv2.subtract(noisy, darker, dst=noisy)


def grouped(screens: Iterable[Screen]) -> list[tuple[Box, list[Screen]]]:
    """Return boxes and the surfaces in them; surfaces whose boxes overlap share one.

    Surfaces outside of the picture are left out.
    """
    groups: list[tuple[Box, list[Screen]]] = []
    for screen in screens:
        box, members = screen.box(PAD_PX), [screen]
        while box is not None:
            others = [group for group in groups if _overlap(box, group[0])]
            if not others:
                groups.append((box, members))
                break
            for other in others:
                groups.remove(other)
                box = _union(box, other[0])
                members = other[1] + members
    return groups


def _overlap(a: Box, b: Box) -> bool:
    return all(a[i] < b[i + 2] and b[i] < a[i + 2] for i in (0, 1))


def _union(a: Box, b: Box) -> Box:
    return min(a[0], b[0]), min(a[1], b[1]), max(a[2], b[2]), max(a[3], b[3])


def _part(box: Box) -> tuple[slice, slice]:
    return slice(box[1], box[3]), slice(box[0], box[2])


def _shape(box: Box) -> tuple[int, int]:
    return box[3] - box[1], box[2] - box[0]


def _inside(margin_px: int) -> tuple[slice, slice]:
    inner = slice(margin_px, -margin_px or None)
    return inner, inner
