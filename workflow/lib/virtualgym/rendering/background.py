"""An empty hall as one fixed camera sees it: its picture, and how far away what stands in it is."""

from dataclasses import dataclass, replace

import numpy as np

from courtside.geometry import camera as cameras
from courtside.geometry import camera_fields
from courtside.records import npz
from courtside.study.errors import InputError
from virtualgym.rendering import rays, shading, textured_quads

FORM = "courtside backdrops 1"
SPEC = {
    "camera": ("str", ("C",)),
    "picture": ("int", ("C", "H", "W", "3")),
    "solid_m": ("float", ("C", "H", "W")),
    "net_m": ("float", ("C", "H", "W")),
    "floor": ("bool", ("C", "H", "W")),
}
BAND_RAYS = 1 << 16  # at a time: what fits the processor's cache
NOTHING = np.float16(np.inf)


@dataclass(frozen=True, eq=False)
class Backdrop:
    """What a fixed camera sees without athletes.

    Attributes
    ----------
    camera : courtside.geometry.camera.Camera
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
    renderer : virtualgym.rendering.hall_renderer.Renderer
    camera : courtside.geometry.camera.Camera
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
    view = textured_quads.View(surfaces, seen.eye, seen.steps)
    height, width = picture.shape[:2]
    solid, net = (np.full(height * width, NOTHING) for _ in range(2))
    floor = np.zeros(height * width, bool)
    rows = max(1, BAND_RAYS // width)
    for start in range(0, height, rows):
        direction, _ = seen.of_band(start, min(start + rows, height))
        part = slice(start * width, start * width + direction.shape[1])
        origin = seen.eye.astype(np.float32)
        quad = surfaces.hit(origin, np.ascontiguousarray(direction.T))
        floor[part] = quad == shading.FLOOR
        away = view.distance(quad, direction, None)
        solid[part] = np.where(quad > shading.FLOOR, away, np.inf)
        if scene.net is not None:
            crossed, away = shading.cross(scene.net, origin, direction)
            net[part][crossed] = away
    shape = (height, width)
    return Backdrop(
        wide, margin_px, picture, solid.reshape(shape), net.reshape(shape), floor.reshape(shape)
    )


def write(path, backdrops):
    """Keep what cameras of one size see of an empty hall, for all takes in it.

    Parameters
    ----------
    path : str or Path
        An npz file, of the form SPEC.
    backdrops : list of Backdrop
        Without a margin.
    """
    arrays = {
        name: [getattr(each, name) for each in backdrops] for name in SPEC if name != "camera"
    }
    npz.write(path, FORM, SPEC, {"camera": [each.camera.name for each in backdrops], **arrays})


def read(path, filming):
    """Return the `Backdrop` of each camera, a list, as `write` kept it.

    Parameters
    ----------
    path : str or Path
    filming : list of courtside.geometry.camera.Camera

    Raises
    ------
    InputError
        If the file is not such a file, or not of these cameras.
    """
    kept = npz.read(path, FORM, SPEC)
    found = {name: at for at, name in enumerate(kept.pop("camera").tolist())}
    size = kept["picture"].shape[2:0:-1]
    for camera in filming:
        if camera.name not in found or tuple(camera.size) != size:
            raise InputError(
                f"{path}: expected camera {camera.name} with {camera_fields.times(camera.size)} px, found "
                f"{sorted(found)} with {camera_fields.times(size)}; make it again"
            )
    return [
        Backdrop(camera, 0, **{name: part[found[camera.name]] for name, part in kept.items()})
        for camera in filming
    ]
