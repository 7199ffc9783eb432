"""Read a COLMAP model as a network of images, lenses and points."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pycolmap
from numpy.typing import NDArray

from courtside.calibration.bundle import problem
from courtside.calibration.bundle.problem import LENS, Network
from courtside.geometry.camera import Camera
from courtside.sfm import model_files
from courtside.study.errors import StrPath, reading

HALF_PIXEL = 0.5  # COLMAP has the first pixel's corner at (0, 0), the project its centre
# ASSUME: unknown focal length, square pixels within 0.1 %, a principal point within 2 % of the
# picture's longer side of the centre (cx, cy are shares of it), and the mild distortion of a camera
# that is not a fisheye.
LENS_SIGMA = (np.inf, 1e-3, 0.02, 0.02, 0.2, 0.2, 2e-3, 2e-3)


def read(folder: StrPath) -> tuple[Network, list[str], list[tuple[int, int]]]:
    """Read the network of a model from COLMAP's binary files, names of images, and sizes, px.

    The network is in the model's own frame and unit, of registered images only, in the order of
    their ids; all observations have a sigma of 1 px and no loss. Lenses, and the sizes (width,
    height) of their pictures, are in the order of the model's camera ids. Raises `InputError` if
    the files are damaged or do not belong together.
    """
    with reading(folder, "a COLMAP model", "delete it and run the study again"):
        model_files.check(folder)
        return _network(pycolmap.Reconstruction(str(folder)))


def _network(found: pycolmap.Reconstruction) -> tuple[Network, list[str], list[tuple[int, int]]]:
    images = [found.images[i] for i in sorted(found.reg_image_ids())]
    camera_ids = sorted({image.camera_id for image in images})
    cameras = [found.cameras[i] for i in camera_ids]
    order = {image.image_id: at for at, image in enumerate(images)}
    tracks = [found.points3D[i] for i in sorted(found.points3D)]
    views = [(k, view) for k, each in enumerate(tracks) for view in each.track.elements]
    seen = [(order[view.image_id], k, view.point2D_idx) for k, view in views]
    places = [image.points2D for image in images]
    image_idx, point_idx, _ = np.array(seen, dtype=int).reshape(-1, 3).T
    xy = np.array([places[v][at].xy for v, _, at in seen]).reshape(-1, 2) - HALF_PIXEL
    sizes = [(camera.width, camera.height) for camera in cameras]
    mean, sigma = lens_prior(sizes)
    poses = np.array([image.cam_from_world().matrix() for image in images]).reshape(-1, 3, 4)
    lenses = np.array([_lens(camera) for camera in cameras]).reshape(-1, len(LENS))
    heights_px = [found.cameras[image.camera_id].height for image in images]
    of_image = [camera_ids.index(image.camera_id) for image in images]
    network = problem.without_points(poses, lenses, heights_px, of_image)
    network = replace(network, lens_mean=mean, lens_sigma=sigma)
    xyz = np.array([track.xyz for track in tracks]).reshape(-1, 3)
    network = problem.with_points(network, xyz, image_idx, point_idx, xy)
    return network, [image.name for image in images], sizes


def views(found: pycolmap.Reconstruction) -> list[Camera]:
    """Return the registered images of a model as cameras, with the images' names, in its frame."""
    images = [found.images[at] for at in sorted(found.reg_image_ids())]
    return [_view(image, found.cameras[image.camera_id]) for image in images]


def _view(image: pycolmap.Image, camera: pycolmap.Camera) -> Camera:
    fx, fy, cx, cy, *dist = camera.params
    K = np.array([[fx, 0, cx - HALF_PIXEL], [0, fy, cy - HALF_PIXEL], [0, 0, 1]])
    size, pose = (camera.width, camera.height), image.cam_from_world().matrix()
    return Camera(image.name, size, K, np.array([*dist, 0.0]), pose)


def lens_prior(sizes: Sequence[tuple[int, int]]) -> tuple[NDArray, NDArray]:
    """Return mean and sigma of lenses, (L, 8) each, that are known by their picture's size only."""
    width, height = np.array(sizes, dtype=float).reshape(-1, 2).T
    mean = np.zeros((len(width), len(LENS)))
    mean[:, 0], mean[:, 1] = width, 1.0
    mean[:, 2], mean[:, 3] = (width - 1) / 2, (height - 1) / 2
    sigma = np.tile(np.array(LENS_SIGMA), (len(width), 1))
    sigma[:, 2:4] *= np.maximum(width, height)[:, None]
    return mean, sigma


def _lens(camera: pycolmap.Camera) -> list[float]:
    fx, fy, cx, cy, *dist = camera.params
    return [fy, fx / fy, cx - HALF_PIXEL, cy - HALF_PIXEL, *dist]
