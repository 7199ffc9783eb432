"""Cameras of a COLMAP model: `cameras` and `images`, each .txt or .bin, both ways as text.

The forms are those of COLMAP's page "Output Format": a pose from the world to the camera as a
quaternion whose first number is real; the first pixel's centre is (0.5, 0.5). One picture of each
camera is expected, whose name, without its ending, is the camera's. The scale and frame of a model
are arbitrary unless somebody set them, so the session has to state the unit.
"""

import struct
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.geometry import camera as camera_files
from courtside.geometry import camera_fields
from courtside.geometry.camera import Camera
from courtside.study.errors import InputError, reading

STEMS = ("cameras", "images")
SUFFIXES = (".bin", ".txt")
NAMES = {stem + suffix for stem in STEMS for suffix in SUFFIXES}
HALF_PX = 0.5  # from the first pixel's corner, COLMAP's origin, to its centre, ours
# Names of models in the order of their numbers, and the numbers of their parameters.
MODELS = {
    "SIMPLE_PINHOLE": 3,
    "PINHOLE": 4,
    "SIMPLE_RADIAL": 4,
    "RADIAL": 5,
    "OPENCV": 8,
    "OPENCV_FISHEYE": 8,
    "FULL_OPENCV": 12,
    "FOV": 5,
    "SIMPLE_RADIAL_FISHEYE": 4,
    "RADIAL_FISHEYE": 5,
    "THIN_PRISM_FISHEYE": 12,
}
ONE_FOCAL = ("SIMPLE_PINHOLE", "SIMPLE_RADIAL", "RADIAL")
FISHEYE = "OPENCV_FISHEYE"
READ = (*ONE_FOCAL, "PINHOLE", "OPENCV", "FULL_OPENCV", FISHEYE)
Lens = tuple[str, tuple[float, float], list[float]]  # model, size px, parameters
Image = tuple[str, int, list[float]]  # name, number of the camera, quaternion and translation


def files(folder: Path) -> tuple[Path, Path] | None:
    """Return the files of a model in a folder, None if there is none."""
    for suffix in SUFFIXES:
        cameras, images = (folder / f"{stem}{suffix}" for stem in STEMS)
        if cameras.is_file() and images.is_file():
            return cameras, images
    return None


def read(folder: Path, contents: Sequence[bytes], *, binary: bool) -> list[Camera]:
    """Return the cameras of a model from the `contents` of both files, lengths as stated."""
    with reading(folder, "a COLMAP model", "export it from COLMAP again"):
        if binary:
            lenses = dict(_binary_lenses(contents[0]))
            images = list(_binary_images(contents[1]))
        else:
            lenses = dict(_text_lenses(contents[0].decode()))
            images = list(_text_images(contents[1].decode()))
    return [_camera(folder, image, lenses) for image in images]


def _text_lenses(text: str) -> Iterator[tuple[int, Lens]]:
    for line in text.splitlines():
        if line.strip() and not line.startswith("#"):
            number, model, *values = line.split()
            width, height, *parameters = map(float, values)
            yield int(number), (model, (width, height), parameters)


def _text_images(text: str) -> Iterator[Image]:
    """Yield the images: every second line, which may be empty, has the points of the one above.

    Raises `ValueError` if it is no list of points (x, y and a number each) but another image.
    """
    lines = iter(text.splitlines())
    for line in lines:
        if line.strip() and not line.startswith("#"):
            fields = line.split(maxsplit=9)
            yield fields[9].strip(), int(fields[8]), [float(value) for value in fields[1:8]]
            points = next(lines, "").split()
            if points and (len(points) % 3 or not points[-1].lstrip("-").isdigit()):
                raise ValueError(
                    f"no line, empty or of points, behind {fields[9].strip()} in images.txt"
                )


def _binary_lenses(data: bytes) -> Iterator[tuple[int, Lens]]:
    at = 8
    for _ in range(_count(data, 24)):
        number, model, width, height = struct.unpack_from("<IiQQ", data, at)
        name = list(MODELS)[model]
        yield (
            number,
            (name, (width, height), list(struct.unpack_from(f"<{MODELS[name]}d", data, at + 24))),
        )
        at += 24 + 8 * MODELS[name]


def _binary_images(data: bytes) -> Iterator[Image]:
    at = 8
    for _ in range(_count(data, 73)):
        pose = struct.unpack_from("<7d", data, at + 4)
        (camera,) = struct.unpack_from("<I", data, at + 60)
        end = data.index(b"\0", at + 64)
        (points,) = struct.unpack_from("<Q", data, end + 1)
        yield data[at + 64 : end].decode(), camera, list(pose)
        at = end + 9 + 24 * points


def _count(data: bytes, least: int) -> int:
    """Return the number of entries, which have `least` bytes each, that a file begins with."""
    (count,) = struct.unpack_from("<Q", data)
    if count * least > len(data):
        raise ValueError(f"{count} entries in {len(data)} bytes")
    return int(count)


def _camera(folder: Path, image: Image, lenses: dict[int, Lens]) -> Camera:
    file, number, values = image
    name = file.rpartition(".")[0] or file
    where = f"{folder}: camera {name}"
    if number not in lenses:
        raise InputError(
            f"{where}: expected its lens as camera {number} of the model, found "
            f"{', '.join(map(str, lenses)) or 'none'}; export it from COLMAP again"
        )
    model, size, given = lenses[number]
    if model not in READ or len(given) != MODELS[model]:
        raise InputError(
            f"{where}: expected a lens of {', '.join(READ)}, found {camera_fields.short(model)} "
            f"with {len(given)} parameters; adjust the model with OPENCV"
        )
    quaternion = camera_fields.numbers(where, "quaternion", values[:4], (4,))
    if not np.linalg.norm(quaternion) > 0:
        raise InputError(f"{where}: expected a quaternion, found zeros; export the model again")
    parameters = camera_fields.numbers(where, "lens", given, (MODELS[model],))
    table = _lens_table(model, parameters) | {
        "size": size,
        "rotation": scipy.spatial.transform.Rotation.from_quat(
            quaternion, scalar_first=True
        ).as_matrix(),
        "translation": values[4:],
    }
    return camera_files.build(where, name, table, 1.0)


def _lens_table(model: str, parameters: NDArray) -> dict[str, Any]:
    """Return matrix and distortions of a lens by its model's parameters."""
    focal = parameters[[0, 0]] if model in ONE_FOCAL else parameters[:2]
    centre_x, centre_y, *radial = parameters[1 if model in ONE_FOCAL else 2 :]
    return {
        "matrix": [[focal[0], 0, centre_x - HALF_PX], [0, focal[1], centre_y - HALF_PX], [0, 0, 1]],
        "distortions": np.array([*radial, *([0.0] * max(0, 4 - len(radial)))]),
        "fisheye": model == FISHEYE,
    }


def texts(cameras: Sequence[Camera]) -> dict[str, str]:
    """Return the texts of a model without points, by name: pictures `<camera>.png`, metres.

    Lenses are FULL_OPENCV where k3 is used, else OPENCV.
    """
    lenses, images = ["# CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]"], ["# IMAGE_ID QW QX QY QZ ..."]
    for number, camera in enumerate(cameras, start=1):
        focal, centre = np.diag(camera.K)[:2], camera.K[:2, 2] + HALF_PX
        model = "FULL_OPENCV" if camera.dist[4] else "OPENCV"
        more = [camera.dist[4], 0.0, 0.0, 0.0] if camera.dist[4] else []
        values = [*focal, *centre, *camera.dist[:4], *more]
        width, height = camera.size
        lenses.append(f"{number} {model} {width} {height} {_numbers(values)}")
        turned = scipy.spatial.transform.Rotation.from_matrix(camera.cam_from_world[:, :3]).as_quat(
            scalar_first=True
        )
        pose = _numbers([*turned, *camera.cam_from_world[:, 3]])
        images += [f"{number} {pose} {number} {camera.name}.png", ""]
    return {
        "cameras.txt": "\n".join([*lenses, ""]),
        "images.txt": "\n".join([*images, ""]),
        "points3D.txt": "# no points\n",
    }


def _numbers(values: Sequence[float]) -> str:
    return " ".join(repr(float(value)) for value in values)
