"""Joint centres where anatomy has them: MakeHuman's rig turns limbs about other points.

The rig's points are chosen for the look of a bent limb. Its knees lie 1 to 2 cm in front of the
line between the epicondyles and its elbows up to 2 cm behind it, so that straight limbs count as
bent; the hips of its men are 4 cm too far apart and 4 cm too far back; its shoulders lie deep below
the skin. The centres here are those of marker systems: the midpoint of the epicondyles, the hip
from the trochanters and the depth of the body, and the shoulder from the skin above it.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from virtualgym.body import rotations
from virtualgym.body.makehuman import Figure

# Hinge: bones that begin at the joints above it, at it and below it; radius of the limb there, m.
HINGES = {
    "knee": ("upperleg01", "lowerleg01", "foot", 0.11),
    "elbow": ("upperarm01", "lowerarm01", "wrist", 0.075),
}
HIP = "upperleg01"
ARM = ("upperarm01", "lowerarm01")
LEVELS_M = np.linspace(-0.016, 0.016, 9)  # sections along the limb, from the rig's joint
BROAD_M = 0.003  # the skin over an epicondyle: so near to the widest point of a section
TOO_FAR_M = 0.0076  # a quarter of the distance, against hips found by their motion
TROCHANTERS_M = 0.02  # half the height of the band in which they are the widest points
# ASSUME: share of the height between a shoulder's centre and the skin above it: 48 mm of a body of
# 1.75 m. Published centres lie about 34 mm (a tenth of the upper arm, de Leva 1996) to 66 mm (17 %
# of the distance between the acromia, Rab et al. 2002) below the acromion.
SHOULDER_DEPTH = 0.0275
ALONG_M = 0.08  # a shoulder's centre lies so near to the rig's one, along the upper arm
# ASSUME: a hip is so far behind the front of the body, as a share of the body's depth at the hip.
# The line between the trochanters, on which [Weinhandl2010] puts it, is at 0.33 to 0.46 in the
# bodies of the gym; the rig's hips are at 0.60 (men) and 0.48 (women).
HIP_DEPTH = 0.4
BESIDE_HIP_M = 0.015  # the depth is that of the skin so near to the hip, to the side
BODY_SHARE = 0.15  # of the height: farther from the middle of the body there are hands


def anatomical(figure: Figure) -> Figure:
    """Return the figure with its shoulders, elbows, hips and knees at anatomical joint centres.

    A knee or an elbow is the midpoint of its epicondyles (Cappozzo et al. 1995; Wu et al. 2005),
    over which the skin is widest along the axis of the joint. A hip lies a quarter of the distance
    between the trochanters away from its own one, less what this is too far from it
    [Weinhandl2010], at the rig's height and at `HIP_DEPTH`. A shoulder stays on the line of the
    upper arm, at `SHOULDER_DEPTH` below the skin.
    """
    heads = figure.heads.copy()
    for suffix, side in ((".L", 1), (".R", -1)):
        for above, at, below, radius_m in HINGES.values():
            first, joint, last = (figure.head(bone + suffix) for bone in (above, at, below))
            found = _epicondyles(figure, first, joint, last, radius_m)
            heads[figure.bones.index(at + suffix)] = found
        hip = figure.bones.index(HIP + suffix)
        heads[hip, 0] = side * (_trochanter_m(figure, heads[hip]) / 2 + TOO_FAR_M)
        heads[hip, 2] = _hip_depth_m(figure, heads[hip])
        shoulder, elbow = (figure.bones.index(bone + suffix) for bone in ARM)
        heads[shoulder] = _shoulder(figure, heads[shoulder], heads[elbow])
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
    above, skin = height > 0, figure.skin
    first, second = skin.ravel(), np.roll(skin, -1, axis=1).ravel()
    crossed = above[first] != above[second]
    first, second = first[crossed], second[crossed]
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


def _hip_depth_m(figure: Figure, hip: NDArray) -> float:
    """Return z of a hip between front and back of the body at its height."""
    points = _section(figure, hip, np.array([0.0, 1, 0]))
    depths = points[np.abs(points[:, 0] - hip[0]) < BESIDE_HIP_M, 2]
    return float(depths.max() - HIP_DEPTH * np.ptp(depths))


def _shoulder(figure: Figure, rig: NDArray, elbow: NDArray) -> NDArray:
    """Return the point on the line of the upper arm that is so deep below the skin."""
    up = rotations.unit_vector(rig - elbow)
    skin = figure.vertices[figure.skin]
    near = skin[(np.abs(skin - rig).max(axis=(1, 2)) < 3 * ALONG_M)]

    def too_deep_m(along: float) -> float:
        place = rig + along * up
        return _top_m(near, place) - place[1] - SHOULDER_DEPTH * figure.height_m

    return rig + brentq(too_deep_m, -ALONG_M / 2, ALONG_M, xtol=1e-5) * up


def _top_m(triangles: NDArray, place: NDArray) -> float:
    """Return the height of the highest of the triangles (F, 3, 3) above or below a point."""
    first, second, third = np.moveaxis(triangles[:, :, [0, 2]] - place[[0, 2]], 1, 0)
    sides = [_cross(second, third), _cross(third, first), _cross(first, second)]
    shares = np.stack(sides, axis=-1)
    area = shares.sum(axis=-1)
    met = (np.abs(area) > 0) & ((shares * area[:, None]) >= 0).all(axis=-1)
    return float(((shares[met] / area[met, None]) * triangles[met, :, 1]).sum(axis=-1).max())


def _cross(first: NDArray, second: NDArray) -> NDArray:
    return first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
