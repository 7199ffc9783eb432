"""An empty hall as one fixed camera sees it: its picture, and how far away what stands in it is."""

from dataclasses import dataclass, replace

import numpy as np

from courtside.geometry import cameras
from courtside.virtual import exposure, rays, sampling

BAND_RAYS = 1 << 16  # at a time: what fits the processor's cache
NOTHING = np.float16(np.inf)


@dataclass(frozen=True, eq=False)
class Backdrop:
    """What a fixed camera sees without athletes.

    Attributes
    ----------
    camera : courtside.geometry.cameras.Camera
        Of this picture, which may be `margin_px` wider than the films on each side.
    margin_px : int
    picture : (H, W, 3) uint8
        BGR, without noise.
    solid_m : (H, W) float16
        How far in front of the camera (along its axis) what stands in the hall is; inf where floor.
    net_m : (H, W) float16
        The same of the net's mesh; inf where there is none.
    floor : (H, W) bool
        Where the floor is seen.
    """

    camera: cameras.Camera
    margin_px: int
    picture: np.ndarray
    solid_m: np.ndarray
    net_m: np.ndarray
    floor: np.ndarray

    @property
    def filmed(self):
        """The camera of the films: this one without the margin."""
        return widened(self.camera, -self.margin_px)


def widened(camera, margin_px):
    """Return the camera of a picture that shows more (or less) on each side, by whole px."""
    middle = np.zeros((3, 3))
    middle[:2, 2] = margin_px
    size = tuple(length + 2 * margin_px for length in camera.size)
    return replace(camera, size=size, K=camera.K + middle)


def look(renderer, camera, margin_px=0):
    """Take a picture of an empty hall, and measure it.

    Parameters
    ----------
    renderer : courtside.virtual.renderer.Renderer
    camera : courtside.geometry.cameras.Camera
        Of the films.
    margin_px : int
        How much more is needed on each side, for a camera that shakes.

    Returns
    -------
    backdrop : Backdrop
    """
    wide = widened(camera, margin_px) if margin_px else camera
    picture = renderer.render(wide)
    scene, surfaces = renderer.scene, renderer.surfaces
    seen = rays.of_camera(wide, rays.grid(wide), None, 0.0)
    view = sampling.View(surfaces, seen.eye, seen.steps)
    height, width = picture.shape[:2]
    solid, net = (np.full(height * width, NOTHING) for _ in range(2))
    floor = np.zeros(height * width, bool)
    rows = max(1, BAND_RAYS // width)
    for start in range(0, height, rows):
        direction, _ = seen.of_band(start, min(start + rows, height))
        part = slice(start * width, start * width + direction.shape[1])
        origin = seen.eye.astype(np.float32)
        quad = surfaces.hit(origin, np.ascontiguousarray(direction.T))
        floor[part] = quad == exposure.FLOOR
        away = view.distance(quad, direction, None)
        solid[part] = np.where(quad > exposure.FLOOR, away, np.inf)
        if scene.net is not None:
            crossed, away = exposure.cross(scene.net, origin, direction)
            net[part][crossed] = away
    shape = (height, width)
    return Backdrop(
        wide, margin_px, picture, solid.reshape(shape), net.reshape(shape), floor.reshape(shape)
    )
