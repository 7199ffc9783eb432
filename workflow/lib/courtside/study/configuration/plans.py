"""A planned session, as `config/plans/<plan>.yaml` states it."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from courtside.study.configuration import schemas
from courtside.study.errors import InputError, StrPath

HEIGHT_M = 1.6  # at which people hold a camera
WAY = ("from_m", "via_m", "to_m")  # keys of a walk
TEXTURE = "plain"  # a plan without a word on texture expects few tie points


@dataclass(frozen=True)
class PlannedCamera:
    """A fixed camera."""

    place_m: tuple  # where it stands
    aim_m: tuple  # what it looks at
    size_px: tuple  # width and height
    focal_px: float | None = None  # this or `fov_deg`
    fov_deg: float | None = None  # across the width


@dataclass(frozen=True)
class PlannedWalk:
    """The walk of the mobile camera; its other fields are as of `PlannedCamera`."""

    way_m: tuple  # places on the floor that it passes, first and last included
    aim_m: tuple
    size_px: tuple
    height_m: float = HEIGHT_M
    focal_px: float | None = None
    fov_deg: float | None = None


@dataclass(frozen=True)
class Plan:
    """A session that is only planned."""

    description: str
    court: str
    hall_m: tuple  # two opposite corners
    cameras: dict
    walk: PlannedWalk | None  # None: points are clicked, and nobody walks
    n_images: tuple  # numbers of bridging images, increasing
    texture: str = TEXTURE  # a key of `courtside.calibration.planning.tie_points.TEXTURES`
    # Scatter of a click per axis at a longer side of 3840 px, where it is not the study's
    click_sigma_px: float | None = None
    target_cm: float | None = None  # error that is wanted


def read(path: StrPath) -> Plan:
    """Read a plan; an `InputError` has every fault of the file, one line each."""
    content = schemas.read(path, "plan")
    if faults := list(_faults(path, content)):
        raise InputError(*faults)
    plan = _frozen(content)
    walk, cameras = plan.pop("walk", None), plan.pop("cameras")
    plan["n_images"] = tuple(sorted(plan.get("n_images", (0,))))
    fixed = {name: PlannedCamera(**camera) for name, camera in cameras.items()}
    return Plan(**plan, cameras=fixed, walk=_walk(walk) if walk else None)


def _walk(content: dict[str, Any]) -> PlannedWalk:
    rest = {key: value for key, value in content.items() if key not in WAY}
    return PlannedWalk(**rest, way_m=tuple(_way_m(content)))


def _way_m(walk: dict[str, Any]) -> list:
    """Return the places on the floor that a walk passes; none without one."""
    return [walk["from_m"], *walk.get("via_m", ()), walk["to_m"]] if walk else []


def _faults(path: StrPath, content: dict[str, Any]) -> Iterator[str]:
    walk = content.get("walk")
    wanted = content.get("n_images", [0])
    if walk is None and any(wanted):
        yield (
            f"{path}: n_images: expected [0] without a walk, found {wanted}; add `walk`, or leave "
            "`n_images` out"
        )
    if walk is not None and "n_images" not in content:
        yield (
            f"{path}: n_images: expected the numbers of bridging images to compare, found none; "
            "state them, such as [20, 40], or remove `walk`"
        )
    low, high = (
        [pick(pair) for pair in zip(*content["hall_m"], strict=True)] for pick in (min, max)
    )
    if any(b - a < 1 for a, b in zip(low, high, strict=True)):
        yield (
            f"{path}: hall_m: expected corners 1 m or more apart along each axis, found {low}, "
            f"{high}"
        )
    walk = walk or {}
    height_m, way_m = walk.get("height_m", HEIGHT_M), _way_m(walk)
    places = {f"cameras.{name}.place_m": at["place_m"] for name, at in content["cameras"].items()}
    places |= {f"walk: place {at}": [*spot, height_m] for at, spot in enumerate(way_m)}
    for where, place in places.items():
        if not all(a <= x <= b for a, x, b in zip(low, place, high, strict=True)):
            yield (
                f"{path}: {where}: expected a place within hall_m, found {place}; correct one of "
                "them"
            )
    for one, other in pairwise(way_m):
        if one == other:
            yield (
                f"{path}: walk: expected places that differ, found {one} twice in a row; leave "
                "one out"
            )


def _frozen(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _frozen(part) for key, part in value.items()}
    return tuple(_frozen(part) for part in value) if isinstance(value, list) else value
