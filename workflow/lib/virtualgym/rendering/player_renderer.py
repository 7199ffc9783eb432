"""Pictures of athletes in a hall, as one fixed camera takes them."""

import cv2
import numpy as np

from courtside.geometry import camera, rotations
from virtualgym.cameras import camera_shake
from virtualgym.rendering import coverage, rays, rolling_shutter, sensor, shadows

PAD_PX = 3  # round an athlete: what the lens's blur reaches
GRAIN_PX = 256  # by how much the field of noise is larger than the picture


class Film:
    """A fixed camera, ready to film athletes.

    Parameters
    ----------
    backdrop : virtualgym.rendering.background.Backdrop
    readout_s : float
        Row v is exposed at ((v + 0.5) / H - 0.5) * readout_s.
    exposure_s : float
        Of each row.
    """

    def __init__(self, backdrop, readout_s, exposure_s):
        self.backdrop, self.readout_s, self.exposure_s = backdrop, readout_s, exposure_s
        self.camera = backdrop.filmed
        self.xy = rays.grid(self.camera)
        wide = rays.grid(backdrop.camera) if backdrop.margin_px else self.xy
        self.corner = float((wide[0] ** 2 + wide[1] ** 2).max())
        self.warp = camera_shake.Warp(self.camera, backdrop.camera)

    def picture(self, athletes, time_s, still_from_shaken=None):
        """Take a picture.

        Parameters
        ----------
        athletes : sequence
            As `rolling_shutter.Moving` takes them.
        time_s : float
            Mid-exposure of the middle row, on the athletes' clock.
        still_from_shaken : (3, 3) float or None
            How the camera has turned, where it has.

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
    """One picture in the making."""

    def __init__(self, film, still_from_shaken):
        self.film, backdrop = film, film.backdrop
        self.camera, self.places = film.camera, None
        if still_from_shaken is None:
            self.picture = backdrop.picture[_inside(backdrop.margin_px)].copy()
            return
        self.camera = camera_shake.turned(film.camera, still_from_shaken)
        self.places = film.warp.places(still_from_shaken)
        self.picture = cv2.remap(
            backdrop.picture, *self.places, cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE
        )

    def darken(self, shadow):
        """Let a shadow fall on the floor."""
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

    def add(self, box, screens):
        """Put athletes into a part of the picture."""
        part = _part(box)
        layer = coverage.cover(screens, box, self._hall("solid_m", box), self._hall("net_m", box))
        layer = cv2.GaussianBlur(layer, (5, 5), sensor.OPTICS_PX, borderType=cv2.BORDER_REPLICATE)
        x, y = self.film.xy[:, *part]
        vignette = 1 - np.float32(sensor.VIGNETTE / self.film.corner) * (x**2 + y**2)
        light = self.picture[part] * (1 - layer[..., 3:])
        light += layer[..., :3] * vignette[..., None]
        self.picture[part] = np.clip(np.rint(light), 0, 255).astype(np.uint8)

    def _hall(self, name, box):
        """Return a map of the backdrop in a box of the picture."""
        values = getattr(self.film.backdrop, name)
        if self.places is None:
            return values[_inside(self.film.backdrop.margin_px)][_part(box)]
        x, y = np.rint(self.places[:, *_part(box)]).astype(int)
        height, width = values.shape
        return values[np.clip(y, 0, height - 1), np.clip(x, 0, width - 1)]


class Grain:
    """Noise of a sensor: each picture takes another window of one large field.

    Parameters
    ----------
    size : (int, int)
        Width and height of the pictures.
    sigma : float
        Standard deviation, 8-bit levels.
    rng : numpy.random.Generator
    """

    def __init__(self, size, sigma, rng):
        shape = size[1] + GRAIN_PX, size[0] + GRAIN_PX, 3
        field = rng.standard_normal(shape, dtype=np.float32)
        field *= np.float32(sigma)
        # What is lighter and what is darker: of bytes, the sum takes a third of the time.
        self._fields = [cv2.multiply(field, sign, dtype=cv2.CV_8U) for sign in (1, -1)]

    def added(self, picture, rng):
        """Return a picture with noise, (H, W, 3) uint8."""
        top, left = rng.integers(0, GRAIN_PX + 1, 2)
        height, width = picture.shape[:2]
        lighter, darker = (field[top : top + height, left : left + width] for field in self._fields)
        noisy = cv2.add(picture, lighter)
        return cv2.subtract(noisy, darker, dst=noisy)


def grouped(screens):
    """Return boxes and the surfaces in them: those whose boxes overlap have one together.

    Parameters
    ----------
    screens : list of onscreen.Screen

    Returns
    -------
    groups : list of ((int, int, int, int), list of onscreen.Screen)
        Surfaces outside of the picture are left out.
    """
    groups = []
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


def _overlap(a, b):
    return all(a[i] < b[i + 2] and b[i] < a[i + 2] for i in (0, 1))


def _union(a, b):
    return (*map(min, a[:2], b[:2]), *map(max, a[2:], b[2:]))


def _part(box):
    return slice(box[1], box[3]), slice(box[0], box[2])


def _shape(box):
    return box[3] - box[1], box[2] - box[0]


def _inside(margin_px):
    inner = slice(margin_px, -margin_px or None)
    return inner, inner
