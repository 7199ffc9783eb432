"""Hips, knees and elbows where anatomy has them: MakeHuman's rig turns limbs about other points.

The rig's points are chosen for the look of a bent limb. Its knees lie 1 to 2 cm in front of the
line between the epicondyles and its elbows up to 2 cm behind it, so that straight limbs count as
bent; the hips of its men are 4 cm too far apart. The centres here are those of marker systems: the
midpoint of the epicondyles, and the hip from the trochanters.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from virtualgym.body import rotations
from virtualgym.body.makehuman import Figure

# Hinge: bones that begin at the joints above it, at it and below it; radius of the limb there, m.
HINGES = {
    "knee": ("upperleg01", "lowerleg01", "foot", 0.11),
    "elbow": ("upperarm01", "lowerarm01", "wrist", 0.075),
}
HIP = "upperleg01"
LEVELS_M = np.linspace(-0.016, 0.016, 9)  # sections along the limb, from the rig's joint
BROAD_M = 0.003  # the skin over an epicondyle: so near to the widest point of a section
TOO_FAR_M = 0.0076  # a quarter of the distance, against hips found by their motion
TROCHANTERS_M = 0.02  # half the height of the band in which they are the widest points
BODY_SHARE = 0.15  # of the height: farther from the middle of the body there are hands


def anatomical(figure: Figure) -> Figure:
    """Return the figure with its hips, knees and elbows at anatomical joint centres.

    A knee or an elbow is the midpoint of its epicondyles (Cappozzo et al. 1995; Wu et al. 2005),
    over which the skin is widest along the axis of the joint. A hip lies a quarter of the distance
    between the trochanters away from its own one, less what this is too far from it
    [Weinhandl2010], at the rig's height and depth.
    """
    heads = figure.heads.copy()
    for suffix, side in ((".L", 1), (".R", -1)):
        for above, at, below, radius_m in HINGES.values():
            first, joint, last = (figure.head(bone + suffix) for bone in (above, at, below))
            found = _epicondyles(figure, first, joint, last, radius_m)
            heads[figure.bones.index(at + suffix)] = found
        hip = figure.bones.index(HIP + suffix)
        heads[hip, 0] = side * (_trochanter_m(figure, heads[hip]) / 2 + TOO_FAR_M)
    return replace(figure, heads=heads)


def _epicondyles(
    figure: Figure, above: NDArray, centre: NDArray, below: NDArray, radius_m: float
) -> NDArray:
    """Return the midpoint of the epicondyles, at the level of the rig's joint."""
    along = rotations.unit_vector(below - above)
    axis = rotations.unit_vector(np.cross(centre - above, below - centre))
    found = []
    for level in LEVELS_M:
        points = _section(figure, centre + level * along, along)
        points = points[np.linalg.norm(points - centre, axis=1) < radius_m] - centre
        points = points - np.outer(points @ along, along)
        for way in (axis, -axis):
            reach = points @ way
            found.append(points[reach > reach.max() - BROAD_M].mean(axis=0))
    return centre + np.mean(found, axis=0)


def _section(figure: Figure, place: NDArray, normal: NDArray) -> NDArray:
    """Return the points (N, 3) where edges of the skin cross a plane."""
    height = (figure.vertices - place) @ normal
    edges = figure.skin[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    first, second = edges[(height[edges] > 0).sum(axis=1) == 1].T
    share = height[first] / (height[first] - height[second])
    return figure.vertices[first] + share[:, None] * (
        figure.vertices[second] - figure.vertices[first]
    )


def _trochanter_m(figure: Figure, hip: NDArray) -> float:
    """Return how far the skin over a trochanter is from the body's plane of symmetry."""
    skin = figure.vertices[np.unique(figure.skin)]
    off = np.abs(skin[:, 0])
    band = np.abs(skin[:, 1] - hip[1]) < TROCHANTERS_M
    return float(off[band & (off < BODY_SHARE * figure.height_m)].max())
