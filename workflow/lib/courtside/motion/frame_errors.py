"""How far the body frame that a source's T-pose gives is from the true one of the same definition."""

import json
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from courtside.geometry.similarity import Sim3
from courtside.study.errors import reading

REMAKE = "make it anew with the rule align_bodies"


def read(path):
    """Return the `body_from_device` (Sim3) in the JSON of a body frame; raise `InputError` if it is none."""
    with reading(path, "a body frame", REMAKE):
        found = json.loads(Path(path).read_text(encoding="utf-8"))
        rotation, translation = (
            np.array(found[key], dtype=float).reshape(shape)
            for key, shape in (("rotation", (3, 3)), ("translation", (3,)))
        )
        return Sim3(float(found["scale_per_m"]), rotation, translation)


def against(body_from_device, device_from_world, body_from_world):
    """Return how far a frame is from the true one.

    Parameters
    ----------
    body_from_device : Sim3
        By the source.
    device_from_world : (3, 4) float
        True pose of the source's own axes, metres.
    body_from_world : Sim3
        True frame, by the same definition.

    Returns
    -------
    errors : dict of str to float
        angle_deg: of the rotation between the axes. unit_percent: how much longer the unit is. origin_mm:
        distance of the origins; it says nothing of a source without a place in the world.
    """
    rotation = body_from_device.rotation @ device_from_world[:, :3] @ body_from_world.rotation.T
    world_from_device = Sim3(1.0, device_from_world[:, :3], device_from_world[:, 3]).inverse()
    origin = world_from_device.points(body_from_device.inverse().translation)
    true = body_from_world.inverse().translation
    return {
        "angle_deg": float(np.degrees(Rotation.from_matrix(rotation).magnitude())),
        "unit_percent": float(100 * (body_from_world.scale / body_from_device.scale - 1)),
        "origin_mm": float(1000 * np.linalg.norm(origin - true)),
    }
