"""Mapping: from matches of a choice of images to a COLMAP model."""

import tempfile
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pycolmap

from courtside.geometry import similarity
from courtside.sfm import database
from courtside.study.errors import InputError

LEAST_POINTS = 6  # an image that sees fewer is nowhere: COLMAP calls it registered all the same
# A lens that one image alone knows, a fixed camera's, can run away in the mapper's own adjustment.
HELD = {"global": {"mapper.bundle_adjustment.refine_extra_params": False}}
HELD_FROM = 2  # attempts as usual before it is held
SOUND_PX = 2.0  # a model with a larger mean reprojection error has folded or lost its lenses
# Of the extent of the images, root mean square: models of good sessions differ by 0 to 0.5 % from seed to
# seed, one whose lenses have run to two thirds or to twice their focal length by more.
AGREE = 0.01


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
        How often to map at most, each time with the next seed, until two models agree in which no image is
        missing or sees next to nothing and which fit: the global mapper starts from random places, and now
        and then its adjustment diverges or ends beside the best. From the third attempt on lenses stay
        without distortion there as long as no model was whole. The model with most images is kept, of those
        that fit one that another confirms, of those the one with most observations.

    Returns
    -------
    summary : dict
        Of the model: pycolmap's version, the seed that gave it, which of COLMAP's options were `held` against
        a lens that runs away, n_models, n_images, n_registered, n_points3d, reprojection_px, track_length;
        n_attempts, and n_agreeing, the number of whole models that agree with it, itself included.

    Raises
    ------
    InputError
        If the disk refuses the model.
    """
    tried, options = [], options or {}
    for at in range(max(attempts, 1)):
        lost = at >= HELD_FROM and not any(_is_whole(each, images) for each in tried)
        held = HELD.get(mapper, {}) if lost else {}
        held = {name: value for name, value in held.items() if name not in options}
        found = _map(matches_db, images, mapper, seed + at, options | held)._replace(held=held)
        confirmed = any(_confirms(each, found, images) for each in tried)
        tried.append(found)
        if confirmed and _is_whole(found, images):
            break
    agreeing = [1 + sum(_confirms(each, found, images) for each in tried) for found in tried]
    # The first of equals.
    best = max(range(len(tried)), key=lambda at: _rank(tried[at], agreeing[at]))
    n_agreeing, best = agreeing[best], tried[best]
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
        "n_attempts": len(tried),
        "n_agreeing": n_agreeing,
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


def _rank(attempt, n_agreeing):
    fits = _error_px(attempt) <= SOUND_PX
    last = attempt.model.compute_num_observations() if fits else -_error_px(attempt)
    return len(_places(attempt)), fits, n_agreeing, last


def _is_whole(attempt, images):
    return len(_places(attempt)) == len(images) and _error_px(attempt) <= SOUND_PX


def _places(attempt):
    """Return where the images were taken that see enough of a model, by name."""
    images = [attempt.model.images[at] for at in attempt.model.reg_image_ids()]
    return {i.name: i.projection_center() for i in images if i.num_points3D >= LEAST_POINTS}


def _confirms(attempt, other, images):
    """Say whether a whole model places the images as another one does, but for frame and scale."""
    if attempt is other or not _is_whole(attempt, images):
        return False
    ours, theirs = _places(attempt), _places(other)
    common = sorted(ours.keys() & theirs.keys())
    ours, theirs = (np.array([found[name] for name in common]) for found in (ours, theirs))
    if len(common) < 3 or similarity.is_collinear(ours) or similarity.is_collinear(theirs):
        return False
    off = similarity.umeyama(ours, theirs).points(ours) - theirs
    span = np.linalg.norm(np.ptp(theirs, axis=0))
    return bool(np.sqrt(np.mean(np.sum(off**2, axis=1))) <= AGREE * span)


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
