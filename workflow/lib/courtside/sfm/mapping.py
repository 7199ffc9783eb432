"""Mapping: from matches of a choice of images to a COLMAP model."""

import tempfile
from pathlib import Path
from typing import NamedTuple

import pycolmap

from courtside.sfm import database
from courtside.study.errors import InputError

LEAST_POINTS = 6  # an image that sees fewer is nowhere: COLMAP calls it registered all the same
# A lens that one image alone knows, a fixed camera's, can run away in the mapper's own adjustment.
HELD = {"global": {"mapper.bundle_adjustment.refine_extra_params": False}}
HELD_FROM = 2  # attempts as usual before it is held
SOUND_PX = 2.0  # a model with a larger mean reprojection error has folded or lost its lenses


def map_images(matches_db, images, folder, *, mapper, seed, options=None, attempts=1):
    """Map images and write the best model found.

    Parameters
    ----------
    matches_db : str or Path
        As `matching.match` made it; it is read only.
    images : list of str
        Names of those to map; all others are as if they were not there.
    folder : str or Path
        Where the model's binary files are written; an empty model where nothing could be mapped.
    mapper : {"global", "incremental"}
    seed : int
    options : dict, optional
        Options of COLMAP's pipeline by dotted name, such as `mapper.ba_num_iterations`.
    attempts : int
        How often to try at most, each time with the next seed, as long as images are missing from the model,
        see next to nothing of it, or it does not fit: the global mapper starts from random places, and now
        and then its adjustment diverges. From the third on lenses stay without distortion there. The model
        with most images is kept, of equals that which fits best.

    Returns
    -------
    summary : dict
        Of the model: pycolmap's version, the seed that gave it, which of COLMAP's options were `held` against
        a lens that runs away, n_models, n_images, n_registered, n_points3d, reprojection_px, track_length.

    Raises
    ------
    InputError
        If the disk refuses the model.
    """
    best, options = None, options or {}
    for at in range(max(attempts, 1)):
        held = HELD.get(mapper, {}) if at >= HELD_FROM else {}
        held = {name: value for name, value in held.items() if name not in options}
        found = _map(matches_db, images, mapper, seed + at, options | held)._replace(held=held)
        if best is None or _rank(found) > _rank(best):
            best = found
        if _n_placed(best) == len(images) and _error_px(best) <= SOUND_PX:
            break
    Path(folder).mkdir(parents=True, exist_ok=True)
    best.model.write_binary(str(folder))
    _check_whole(best.model, Path(folder))
    return {
        "mapper": mapper,
        "seed": best.seed,
        "held": best.held,
        "pycolmap": pycolmap.__version__,
        "n_images": len(images),
        "n_models": best.n_models,
        "n_registered": best.model.num_reg_images(),
        "n_points3d": best.model.num_points3D(),
        "reprojection_px": _error_px(best),
        "track_length": best.model.compute_mean_track_length(),
    }


def _check_whole(model, folder):
    """Compare the sizes of the long files with what they must hold: COLMAP does not notice a full disk."""
    images = [model.images[image] for image in model.reg_image_ids()]
    n_bytes = {  # of COLMAP's documented format: identifiers, numbers, names, and what follows each
        "images.bin": 8
        + sum(73 + len(image.name.encode()) + 24 * len(image.points2D) for image in images),
        "points3D.bin": 8 + 51 * model.num_points3D() + 8 * model.compute_num_observations(),
    }
    for name, expected in n_bytes.items():
        found = (folder / name).stat().st_size
        if found != expected:
            raise InputError(
                f"{folder / name}: expected {expected} bytes, found {found}: free or allow the space"
            )


class _Attempt(NamedTuple):
    """The largest model of one run of a mapper."""

    model: pycolmap.Reconstruction
    n_models: int
    seed: int
    held: dict


def _map(matches_db, images, mapper, seed, options):
    with database.working_copy(matches_db) as copy, tempfile.TemporaryDirectory() as temporary:
        arguments = (copy, temporary, temporary, _options(mapper, images, seed, options))
        run = {"global": pycolmap.global_mapping, "incremental": pycolmap.incremental_mapping}
        models = run[mapper](*arguments)
    largest = max(models.values(), key=_size, default=pycolmap.Reconstruction())
    return _Attempt(largest, len(models), seed, {})


def _rank(attempt):
    return _n_placed(attempt), _error_px(attempt) <= SOUND_PX, -_error_px(attempt)


def _n_placed(attempt):
    images = attempt.model.images
    return sum(images[at].num_points3D >= LEAST_POINTS for at in attempt.model.reg_image_ids())


def _error_px(attempt):
    return attempt.model.compute_mean_reprojection_error()


def _size(model):
    return model.num_reg_images(), model.num_points3D()


def _options(mapper, images, seed, changes):
    pipeline = {
        "global": pycolmap.GlobalPipelineOptions,
        "incremental": pycolmap.IncrementalPipelineOptions,
    }[mapper]()
    pipeline.image_names = list(images)
    if mapper == "incremental":
        pipeline.extract_colors = False
        pipeline.min_model_size = 3
    _everywhere(pipeline, "random_seed", seed)
    _everywhere(pipeline, "num_threads", 1)  # with more, sums depend on who comes first
    for name, value in changes.items():
        *parents, last = name.split(".")
        owner = pipeline
        for parent in parents:
            owner = getattr(owner, parent)
        if not hasattr(owner, last):
            raise ValueError(f"COLMAP's {mapper} mapping has no option {name}")
        setattr(owner, last, value)
    return pipeline


def _everywhere(options, name, value):
    """Set an option wherever these options or the options inside them have it."""
    if hasattr(options, name):
        setattr(options, name, value)
    for key in options.todict(recursive=False):
        inner = getattr(options, key)
        if hasattr(inner, "todict"):
            _everywhere(inner, name, value)
