"""Extract features of all images of a session once, into a COLMAP database with stable ids."""

from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pycolmap

from courtside.sfm import database
from courtside.study.errors import InputError, StrPath

MODEL = "OPENCV"  # fx fy cx cy k1 k2 p1 p2


@dataclass(frozen=True)
class Group:
    """Images of one physical camera: they share a lens."""

    name: str  # of the camera or the walk
    images: tuple[str, ...]  # paths from the image root, in the order of their names


def extract(
    path: StrPath,
    image_root: StrPath,
    groups: Sequence[Group],
    *,
    max_features: int,
    first_octave: int,
    focal_factor: float,
    threads: int = 1,
) -> tuple[dict[str, int], list[str]]:
    """Extract SIFT features and write them to a new COLMAP database.

    Return the number of features by image, and the groups whose images do not state a focal length.
    Raises `InputError` if an image cannot be read, or has another size than the others of its
    camera, `ValueError` if a group has no images.

    Parameters
    ----------
    groups : camera k of the database is group k - 1, image ids count through the groups in order,
        within one in the order of the names (COLMAP sorts them): both are the same whatever the
        number of threads
    max_features : per image
    first_octave : 0: the picture as it is; -1: doubled first, which finds finer features at four
        times the cost
    focal_factor : focal length to start from, as a share of the longer side, of images without EXIF
        data: those of a study have none
    """
    empty = [group.name for group in groups if not group.images]
    if empty:
        raise ValueError(f"groups without images: {empty}")  # COLMAP would take all there are
    reader = pycolmap.ImageReaderOptions(camera_model=MODEL)
    reader.default_focal_length_factor = focal_factor
    extraction = pycolmap.FeatureExtractionOptions(num_threads=threads, use_gpu=False)
    extraction.sift.max_num_features = max_features
    extraction.sift.first_octave = first_octave
    with database.new(path) as temporary:
        for group in groups:
            # Extraction alone would number the images in the order in which its threads end.
            options: dict[str, Any] = {
                "camera_mode": pycolmap.CameraMode.SINGLE,
                "image_names": group.images,
            }
            pycolmap.import_images(temporary, image_root, options=reader, **options)
            _check_imported(temporary, image_root, group)
            pycolmap.extract_features(
                temporary,
                image_root,
                reader_options=reader,
                extraction_options=extraction,
                device=pycolmap.Device.cpu,
                **options,
            )
        return _content(temporary, groups)


def _check_imported(path: Path, image_root: StrPath, group: Group) -> None:
    there = database.image_ids(path)
    missing = [name for name in group.images if name not in there]
    if missing:
        raise InputError(
            f"{image_root}/{missing[0]}: expected a picture of the size of the others of "
            f"{group.name}, found {len(missing)} of {len(group.images)} that differ or cannot be "
            "read; film or export them again, or declare pictures of another size as a walk of "
            "their own"
        )


def _content(path: Path, groups: Sequence[Group]) -> tuple[dict[str, int], list[str]]:
    with closing(pycolmap.Database.open(path)) as opened:
        images = sorted(opened.read_all_images(), key=lambda image: image.image_id)
        counts = {i.name: opened.num_keypoints_for_image(i.image_id) for i in images}
        lens_known = {c.camera_id: c.has_prior_focal_length for c in opened.read_all_cameras()}
    known = {image.name: lens_known[image.camera_id] for image in images}
    return counts, [group.name for group in groups if not known[group.images[0]]]
