"""Cameras as a network, and images of a network as cameras."""

from collections.abc import Mapping, Sequence

import numpy as np

from courtside.calibration.bundle import problem, selection
from courtside.calibration.bundle.problem import Network
from courtside.geometry.camera import Camera
from courtside.study.errors import InputError


def network_of(known: Sequence[Camera]) -> Network:
    """Return the network of cameras without points: the inverse of `cameras_of`."""
    lenses = []
    for camera in known:
        (fx, _, cx), (_, fy, cy), _ = camera.K
        lenses.append([fy, fx / fy, cx, cy, *camera.dist[:4]])
    return problem.without_points(
        np.array([camera.cam_from_world for camera in known]).reshape(-1, 3, 4),
        np.array(lenses).reshape(-1, len(problem.LENS)),
        [camera.size[1] for camera in known],
    )


def cameras_of(
    network: Network, names: Sequence[str], sizes: Sequence[tuple[int, int]]
) -> list[Camera]:
    """Return the first images of a network as cameras; `sizes` are (width, height), px.

    Raises `InputError` if the adjustment of a camera has diverged, so that it has no focal length.
    """
    found = []
    for v, (name, size) in enumerate(zip(names, sizes, strict=True)):
        f_px, aspect, cx_px, cy_px, *dist = network.lens[network.lens_of_image[v]]
        if not 0 < f_px < np.inf or not 0 < aspect < np.inf:
            raise InputError(
                f"camera {name}: expected an adjustment that converges, found a focal length of "
                f"{f_px:.0f} px; what its pictures show is too little or contradicts itself: add "
                "clicked points, or pictures of the walk, the board or the wand, and check them"
            )
        K = np.array([[f_px * aspect, 0, cx_px], [0, f_px, cy_px], [0, 0, 1]])
        found.append(Camera(name, size, K, np.array([*dist, 0.0]), network.cam_from_world[v]))
    return found


def fixed_cameras(
    network: Network, fixed: Mapping[str, int], sizes: Mapping[str, tuple[int, int]]
) -> list[Camera]:
    """Return the fixed cameras of a network, in its frame.

    `fixed` contains the index of each fixed camera's image, `sizes` the size of its pictures, px.
    """
    alone = selection.images_only(network, list(fixed.values()))
    return cameras_of(alone, list(fixed), [sizes[name] for name in fixed])
