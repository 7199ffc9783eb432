"""Mapping: from matches of a choice of images to a COLMAP model."""

import tempfile
from pathlib import Path

import pycolmap

from courtside.sfm import database


def map_images(matches_db, images, folder, *, mapper, seed, options=None):
    """Map images and write the largest model found.

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

    Returns
    -------
    summary : dict
        Of the model: pycolmap's version, n_models, n_images, n_registered, n_points3d, reprojection_px,
        track_length.
    """
    with database.working_copy(matches_db) as copy, tempfile.TemporaryDirectory() as temporary:
        arguments = (copy, temporary, temporary, _options(mapper, images, seed, options))
        run = {"global": pycolmap.global_mapping, "incremental": pycolmap.incremental_mapping}
        models = run[mapper](*arguments)
    best = max(models.values(), key=_size, default=pycolmap.Reconstruction())
    Path(folder).mkdir(parents=True, exist_ok=True)
    best.write_binary(str(folder))
    return {
        "mapper": mapper,
        "seed": seed,
        "pycolmap": pycolmap.__version__,
        "n_images": len(images),
        "n_models": len(models),
        "n_registered": best.num_reg_images(),
        "n_points3d": best.num_points3D(),
        "reprojection_px": best.compute_mean_reprojection_error(),
        "track_length": best.compute_mean_track_length(),
    }


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
    for name, value in (changes or {}).items():
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
