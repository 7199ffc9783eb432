"""An empty hall as one fixed camera sees it: picture and depth."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from courtside.geometry import camera_fields
from courtside.geometry.camera import Camera
from courtside.records import npz
from courtside.study.errors import InputError
from virtualgym.rendering import rays, shading, textured_quads
from virtualgym.rendering.hall_renderer import Renderer

FORM = "courtside backdrops 1"
SPEC = {
    "camera": ("str", ("C",)),
    "picture": ("int", ("C", "H", "W", "3")),
    "solid_m": ("float", ("C", "H", "W")),
    "net_m": ("float", ("C", "H", "W")),
    "floor": ("bool", ("C", "H", "W")),
}
NOTHING = np.float16(np.inf)


@dataclass(frozen=True, eq=False)
class Backdrop:
    """What a fixed camera sees without athletes.

    Attributes
    ----------
    camera : Camera
        Of this picture, which may be `margin_px` wider than the films on each side.
    margin_px : int
    picture : (H, W, 3) uint8
        BGR, without noise.
    solid_m : (H, W) float16
        Depth along the camera's axis of walls and furniture; inf where the floor is seen.
    net_m : (H, W) float16
        Depth of the net's mesh; inf where there is none.
    floor : (H, W) bool
        Where the floor is seen.
    """

    camera: Camera
    margin_px: int
    picture: np.ndarray
    solid_m: np.ndarray
    net_m: np.ndarray
    floor: np.ndarray

    @property
    def filmed(self) -> Camera:
        """The camera of the films: this one without the margin."""
        return widened(self.camera, -self.margin_px)


def widened(camera: Camera, margin_px: int) -> Camera:
    """Return the camera of a picture that is larger (or smaller) on each side by whole px."""
    middle = np.zeros((3, 3))
    middle[:2, 2] = margin_px
    size = (camera.size[0] + 2 * margin_px, camera.size[1] + 2 * margin_px)
    return replace(camera, size=size, K=camera.K + middle)


def look(renderer: "Renderer", camera: Camera, margin_px: int = 0) -> Backdrop:
    """Render picture and depth of an empty hall for the films' camera.

    A camera that shakes needs `margin_px` more on each side.
    """
    wide = widened(camera, margin_px) if margin_px else camera
    picture = renderer.render(wide)
    scene, surfaces = renderer.scene, renderer.surfaces
    seen = rays.of_camera(wide, rays.grid(wide), None, 0.0)
    view = textured_quads.View(surfaces, seen.eye, seen.steps)
    height, width = picture.shape[:2]
    solid, net = (np.full(height * width, NOTHING) for _ in range(2))
    floor = np.zeros(height * width, bool)
    origin = seen.eye.astype(np.float32)
    for part, direction in seen.bands():
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


def write(path: str | Path, backdrops: Sequence[Backdrop]) -> None:
    """Write backdrops of cameras of one size, without margins, for all takes of a session."""
    arrays = {
        name: [getattr(each, name) for each in backdrops] for name in SPEC if name != "camera"
    }
    npz.write(path, FORM, SPEC, {"camera": [each.camera.name for each in backdrops], **arrays})


def read(path: str | Path, filming: Iterable[Camera]) -> list[Backdrop]:
    """Return the backdrop of each camera, in order, from a file by `write`.

    Raises
    ------
    InputError
        If the file is damaged, or lacks one of these cameras at this size.
    """
    kept = npz.read(path, FORM, SPEC)
    found = {name: at for at, name in enumerate(kept.pop("camera").tolist())}
    size = kept["picture"].shape[2:0:-1]
    for camera in filming:
        if camera.name not in found or tuple(camera.size) != size:
            raise InputError(
                f"{path}: expected camera {camera.name} "
                f"with {camera_fields.times(camera.size)} px, "
                f"found {sorted(found)} with {camera_fields.times(size)}; make it again"
            )
    return [
        Backdrop(camera, 0, **{name: part[found[camera.name]] for name, part in kept.items()})
        for camera in filming
    ]
