"""Mapping: from matches of some images to a COLMAP model."""

import contextlib
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pycolmap
from numpy.typing import NDArray

from courtside.calibration.records.support import Support
from courtside.geometry import similarity
from courtside.sfm import database, model, two_views
from courtside.study.errors import InputError, StrPath

# An image with fewer points has no reliable pose (6 unknowns), but COLMAP calls it registered.
LEAST_POINTS = 6
# The lens of a single image, a fixed camera's, can diverge in the mapper's own adjustment.
HELD = {"global": {"mapper.bundle_adjustment.refine_extra_params": False}}
HELD_FROM = 2  # ASSUME: attempts as usual before its distortion is held
SOUND_PX = 2.0  # ASSUME: a model with a larger mean reprojection error has folded or wrong lenses
# With known lenses from the start and throughout: see `two_views.with_known_lenses`.
KNOWN = {
    "global": {
        "mapper.bundle_adjustment.refine_focal_length": False,
        "mapper.bundle_adjustment.refine_extra_params": False,
    },
    "incremental": {"ba_refine_focal_length": False, "ba_refine_extra_params": False},
}
# Mappers that map again in turn, while the best model explains less than this of any image's
# verified matches. Chosen on small halls with ten images (docs/measured/running.md): a wrong map
# had 0.66.
AGAIN = {"global": {"global": 0.75, "incremental": 0.65}}
# Of all verified matches: of two halls whose lone model explained 0.01 and 0.10 more than two that
# agreed, the first lone model was wrong and the second right.
LONE_GAIN = 0.05
# Of the extent of the images, root mean square: models of good sessions differ by 0 to 0.5 % from
# seed to seed, one whose focal lengths have diverged to two thirds or to twice by more.
AGREE = 0.01
# ASSUME: of the extent, the largest distance of an image in models that agree: among many images of
# a walk one fixed camera hardly changes the mean. Good ones of seven sessions differed by 0.6 % at
# most.
AGREE_EACH = 0.02
# ASSUME: of the images of a map that lacks some: another that places so many of them confirms it.
NEARLY = 0.9


class _Attempt(NamedTuple):
    """The largest model of one run of a mapper."""

    model: pycolmap.Reconstruction
    n_models: int
    mapper: str
    seed: int
    held: Mapping[str, Any]


class _Found(NamedTuple):
    """A model with what it explains, and how many models agree with it."""

    best: _Attempt
    support: Support
    n_agreeing: int
    n_attempts: int
    joined: tuple[str, ...]  # images that verified matches join

    def is_doubtful(self, least_share: float) -> bool:
        return self.support.image_share < least_share or self.n_agreeing == 1 < self.n_attempts


def map_images(
    matches_db: StrPath,
    images: Sequence[str],
    folder: StrPath,
    *,
    mapper: str,
    seed: int,
    options: Mapping[str, Any] | None = None,
    attempts: int = 1,
) -> dict[str, Any]:
    """Map images and write the best model found.

    Raises `InputError` if the disk refuses the model.

    A model is whole if each image sees enough points and its reprojection error is small. Images
    that no verified matches join with the others, of another place, are not missed. The
    global mapper starts from random places: sometimes its adjustment diverges or ends in a worse
    minimum. From the third attempt on its lenses stay without distortion as long as no model was
    whole. The model with most images is kept; of those, one that fits, then one that most others
    confirm, then the one with most observations.

    Maps can agree on a wrong shape: the global mapper starts from two-view geometries of unknown
    lenses, which pictures of mostly one plane do not determine, and its focal lengths run away.
    Where no whole models agree, or the model explains too little of any image's verified matches,
    all is mapped again with the first guess of every lens, at last by the incremental mapper. The
    model whose worst image is explained best is kept. The adjustment that follows frees the lenses.

    Parameters
    ----------
    matches_db : as `matching.match` made it; it is read only
    images : names of those to map; all others are as if they were not there
    folder : where the model's binary files are written; an empty model where nothing could be
        mapped
    mapper : "global" or "incremental"
    options : options of COLMAP's pipeline by dotted name, such as `mapper.ba_num_iterations`
    attempts : how often to map at most, each time with the next seed, until two whole models agree

    Returns
    -------
    summary : of the model: pycolmap's version, the mapper and the seed that gave it, which of
        COLMAP's options were `held` against a diverging lens, n_models, n_images, n_registered,
        n_points3d, reprojection_px, track_length; `explained`, how much of the verified matches it
        explains, as a `Support`; `unregistered`, the images that it lacks, and `unmatched`, those
        that no verified matches join with the most others; n_attempts, and n_agreeing, the number
        of sound models that agree with it, itself included
    """
    best, support, n_agreeing, n_attempts, joined = _explaining(
        matches_db, images, mapper, seed, dict(options or {}), attempts
    )
    Path(folder).mkdir(parents=True, exist_ok=True)
    best.model.write_binary(str(folder))
    _check_whole(best.model, Path(folder))
    registered = {best.model.images[at].name for at in best.model.reg_image_ids()}
    return {
        "mapper": best.mapper,
        "seed": best.seed,
        "held": best.held,
        "pycolmap": pycolmap.__version__,
        "n_images": len(images),
        "n_models": best.n_models,
        "n_registered": best.model.num_reg_images(),
        "n_points3d": best.model.num_points3D(),
        "reprojection_px": _error_px(best),
        "track_length": best.model.compute_mean_track_length(),
        "explained": support._asdict(),
        "unregistered": [name for name in images if name not in registered],
        "unmatched": [name for name in images if name not in joined],
        "n_attempts": n_attempts,
        "n_agreeing": n_agreeing,
    }


def _explaining(matches_db, images, mapper, seed, options, attempts) -> _Found:
    """Map, and again with known lenses while the best model is doubtful; return the best."""
    verified = two_views.read(matches_db, images)
    joined = two_views.joined(verified)

    def mapped(database, mapper, options) -> _Found:
        best, n_agreeing, n_tried = _agreed(
            database, images, joined, mapper, seed, options, attempts
        )
        support = two_views.explained(verified, model.views(best.model))
        return _Found(best, support, n_agreeing, n_tried, joined)

    found, copy = mapped(matches_db, mapper, options), None
    with contextlib.ExitStack() as open_copy:
        for other, least_share in AGAIN.get(mapper, {}).items():
            if not (found.is_doubtful(least_share) and _is_whole(found.best, joined)):
                break
            copy = copy or open_copy.enter_context(
                two_views.with_known_lenses(matches_db, images, seed=seed)
            )
            known = {name: on for name, on in KNOWN[other].items() if name not in options}
            # Options of one mapper are unknown to another.
            again = mapped(copy, other, (options if other == mapper else {}) | known)
            again = again._replace(best=again.best._replace(held=known | dict(again.best.held)))
            tried = found.n_attempts + again.n_attempts
            found = (again if _is_better(again, found) else found)._replace(n_attempts=tried)
    return found


def _is_better(again: _Found, found: _Found) -> bool:
    """Return whether a model has as many images and explains the worst of them better.

    One that no other confirms must explain much more of all matches than one that is confirmed.
    """
    is_lone = again.n_agreeing == 1 < found.n_agreeing
    if is_lone and again.support.share < found.support.share + LONE_GAIN:
        return False
    ranks = [
        (len(_places(one.best)), _error_px(one.best) <= SOUND_PX, one.support.image_share)
        for one in (again, found)
    ]
    return ranks[0] > ranks[1]


def _agreed(
    matches_db, images, joined, mapper, seed, options, attempts
) -> tuple[_Attempt, int, int]:
    """Map until two whole models agree; return the best, how many agree with it, how many tried."""
    tried: list[_Attempt] = []
    for at in range(max(attempts, 1)):
        held = _held(tried, joined, mapper, options)
        found = _map(matches_db, images, mapper, seed + at, options | held)._replace(held=held)
        confirmed = any(_confirms(each, found, joined) for each in tried)
        tried.append(found)
        if confirmed and _is_whole(found, joined):
            break
    agreeing = [1 + sum(_confirms(each, found, joined) for each in tried) for found in tried]
    ranks = [_rank(*each) for each in zip(tried, agreeing, strict=True)]
    chosen = ranks.index(max(ranks))  # the first of equals
    return tried[chosen], agreeing[chosen], len(tried)


def _held(tried, joined, mapper, options) -> dict[str, Any]:
    """Return options that hold distortion, once `HELD_FROM` attempts gave no whole model."""
    if len(tried) < HELD_FROM or any(_is_whole(each, joined) for each in tried):
        return {}
    return {name: on for name, on in HELD.get(mapper, {}).items() if name not in options}


def _check_whole(model: pycolmap.Reconstruction, folder: Path) -> None:
    """Compare the long files' sizes with their content: COLMAP does not notice a full disk."""
    images = [model.images[image] for image in model.reg_image_ids()]
    of_images = [73 + len(image.name.encode()) + 24 * len(image.points2D) for image in images]
    n_bytes = {  # of COLMAP's documented format: identifiers, numbers, names, and what follows each
        "images.bin": 8 + sum(of_images),
        "points3D.bin": 8 + 51 * model.num_points3D() + 8 * model.compute_num_observations(),
    }
    for name, expected in n_bytes.items():
        found = (folder / name).stat().st_size
        if found != expected:
            raise InputError(
                f"{folder / name}: expected {expected} bytes, found {found}: free or allow the "
                "space"
            )


def _map(matches_db, images, mapper, seed, options) -> _Attempt:
    with (
        database.working_copy(matches_db) as copy,
        # Windows does not delete what pycolmap may still hold open.
        tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as temporary,
    ):
        arguments = (copy, temporary, temporary, _options(mapper, images, seed, options))
        is_global = mapper == "global"
        run = pycolmap.global_mapping if is_global else pycolmap.incremental_mapping
        models = run(*arguments)
    largest = max(models.values(), key=_size, default=pycolmap.Reconstruction())
    return _Attempt(largest, len(models), mapper, seed, {})


def _rank(attempt: _Attempt, n_agreeing: int) -> tuple[int, bool, int, float]:
    fits = _error_px(attempt) <= SOUND_PX
    last = attempt.model.compute_num_observations() if fits else -_error_px(attempt)
    return len(_places(attempt)), fits, n_agreeing, last


def _is_whole(attempt: _Attempt, joined: Sequence[str]) -> bool:
    return _places(attempt).keys() >= set(joined) and _error_px(attempt) <= SOUND_PX


def _places(attempt: _Attempt) -> dict[str, NDArray]:
    """Return the projection centres, by name, of the images that see enough points of a model."""
    images = [attempt.model.images[at] for at in attempt.model.reg_image_ids()]
    return {i.name: i.projection_center() for i in images if i.num_points3D >= LEAST_POINTS}


def _confirms(attempt: _Attempt, other: _Attempt, joined: Sequence[str]) -> bool:
    """Return whether a sound model places the images as another one does, up to a similarity.

    It has all images that the other one has, or nearly all if that lacks some.
    """
    if attempt is other or _error_px(attempt) > SOUND_PX:
        return False
    places = _places(attempt), _places(other)
    common = sorted(places[0].keys() & places[1].keys())
    least = (1.0 if places[1].keys() >= set(joined) else NEARLY) * len(places[1])
    if len(common) < least:
        return False
    ours, theirs = (np.array([found[name] for name in common]) for found in places)
    if len(common) < 3 or similarity.is_collinear(ours) or similarity.is_collinear(theirs):
        return False
    off = np.linalg.norm(similarity.umeyama(ours, theirs).points(ours) - theirs, axis=1)
    span = np.linalg.norm(np.ptp(theirs, axis=0))
    return bool(np.sqrt(np.mean(off**2)) <= AGREE * span and off.max() <= AGREE_EACH * span)


def _error_px(attempt: _Attempt) -> float:
    return attempt.model.compute_mean_reprojection_error()


def _size(model: pycolmap.Reconstruction) -> tuple[int, int]:
    return model.num_reg_images(), model.num_points3D()


def _options(mapper: str, images: Sequence[str], seed: int, changes: Mapping[str, Any]) -> Any:
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
            owner = getattr(owner, parent, None)
        if not hasattr(owner, last):
            raise InputError(
                f"map_images.colmap.{mapper}: expected options of COLMAP's {mapper} mapping, such "
                f"as mapper.{sorted(pipeline.mapper.todict(recursive=False))[0]}, found {name!r}; "
                "correct the name"
            )
        setattr(owner, last, value)
    return pipeline


def _everywhere(options: Any, name: str, value: int) -> None:
    """Set an option wherever these options or the options inside them have it."""
    if hasattr(options, name):
        setattr(options, name, value)
    for key in options.todict(recursive=False):
        inner = getattr(options, key)
        if hasattr(inner, "todict"):
            _everywhere(inner, name, value)
