"""Whether structure from motion placed the fixed cameras, and what to film again if not."""

from collections.abc import Callable, Container, Mapping, Sequence

import numpy as np

from courtside.calibration.bundle.problem import Network
from courtside.study.errors import few

N_NAMED = 5  # images in a line


def outcome(
    network: Network,
    images: Sequence[str],
    fixed: Mapping[str, str],
    *,
    min_points: int,
    n_models: int = 1,
    matched: Container[str] | None = None,
) -> str:
    """Return in one line why a model does not place the fixed cameras; empty if it places all.

    Parameters
    ----------
    network : as `model.read` gives it
    images : names of the registered images
    fixed : image of each fixed camera, by camera
    min_points : fewest points that a placed camera sees: COLMAP calls an image registered that sees
        none
    n_models : separate models that the images fell into
    matched : images with verified matches; None: not known. Where nothing could be mapped, cameras
        without any are the fault if others have some
    """
    alone = [camera for camera in fixed if matched is not None and fixed[camera] not in matched]
    if not images and not 0 < len(alone) < len(fixed):
        return (
            "walk: expected images that overlap, found no two that could be mapped together; take "
            "more bridging images, or film slower, with posters, bags and gear in view"
        )
    seen = {camera: n_seen(network, images, image) for camera, image in fixed.items()}
    lost = [camera for camera in fixed if seen[camera] < min_points] if images else alone
    if not lost:
        return ""
    one, where_not = len(lost) == 1, "it unregistered" if images else "no match with any image"
    found = [
        (f"{seen[camera]} points" if fixed[camera] in images else where_not)
        + ("" if one else f" ({camera})")
        for camera in lost
    ]
    apart = f"; the images fall into {n_models} separate models" if n_models > 1 else ""
    names = f"camera{'' if one else 's'} {', '.join(lost)}"
    return (
        f"{names}: expected {min_points} points or more in common with the walk, found "
        f"{', '.join(found)}{apart}; film the walk from close beside each such camera, slowly, "
        "aimed as it is, or take more bridging images; if a static picture shows another place, "
        "give the right one"
    )


def lost(
    unregistered: Sequence[str], unmatched: Container[str], called: Callable[[str], str]
) -> list[str]:
    """Return in lines which images a model lacks, those that match no others first.

    `called` gives the name to call an image by.
    """
    alone = [name for name in unregistered if name in unmatched]
    others = [name for name in unregistered if name not in unmatched]
    told = (
        (alone, "no match joins it with the others; leave it out if it shows another place, or"),
        (others, "too few of its matches agree with the model;"),
    )
    found = []
    for names, why in told:
        if names:
            listed = few([called(name) for name in names], N_NAMED)
            found.append(f"not in the model: {listed}: {why} add pictures in between")
    return found


def n_seen(network: Network, images: Sequence[str], image: str) -> int:
    """Return how many points of a model an image sees, 0 if it is not among its `images`."""
    if image not in images:
        return 0
    return int(np.count_nonzero(network.image_idx == images.index(image)))
