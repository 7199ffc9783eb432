"""Whether structure from motion placed the fixed cameras, and what to film again where it did not."""

import numpy as np


def outcome(network, images, fixed, *, min_points, n_models=1):
    """Say in one line what keeps a model from placing the fixed cameras.

    Parameters
    ----------
    network : courtside.calibration.bundle.problem.Network
        As `model.read` gives it.
    images : list of str
        Names of the registered images.
    fixed : dict of str to str
        Image of each fixed camera, by camera.
    min_points : int
        Fewest points that a placed camera sees: COLMAP calls an image registered that sees none.
    n_models : int
        Separate models that the images fell into.

    Returns
    -------
    outcome : str
        Empty if all are placed.
    """
    if not images:
        return (
            "walk: expected images that overlap, found no two that could be mapped together; take more "
            "bridging images, or film slower, with posters, bags and gear in view"
        )
    seen = {camera: n_seen(network, images, image) for camera, image in fixed.items()}
    lost = [camera for camera in fixed if seen[camera] < min_points]
    if not lost:
        return ""
    one = len(lost) == 1
    found = [
        (f"{seen[camera]} points" if fixed[camera] in images else "it unregistered")
        + ("" if one else f" ({camera})")
        for camera in lost
    ]
    apart = f"; the images fall into {n_models} separate models" if n_models > 1 else ""
    names = f"camera{'' if one else 's'} {', '.join(lost)}"
    return (
        f"{names}: expected {min_points} points or more in common with the walk, found {', '.join(found)}"
        f"{apart}; film the walk from close beside each such camera, slowly, aimed as it is, or take more "
        "bridging images"
    )


def n_seen(network, images, image):
    """Return how many points of a model an image sees, 0 if it is not in it.

    Parameters
    ----------
    network : courtside.calibration.bundle.problem.Network
    images : list of str
        Names of its images.
    image : str
    """
    if image not in images:
        return 0
    return int(np.count_nonzero(network.image_idx == images.index(image)))
