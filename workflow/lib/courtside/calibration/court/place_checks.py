"""The clicked points of a session, and checks of their places: shifts, the unit, mirrored places.

All points of a camera may be wrong by one shift. The picture of this camera cannot show this,
because shifted points only shift the camera. Points of other cameras at the same places show it.
Points in one plane, such as a floor, fit their mirror image too: cameras below the floor show it.
Points that are mirrored twice, themselves and in their pictures, fit any camera: it hangs upside
down.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.court import court as court_files
from courtside.calibration.court.court import RAISED_M, ClickedPoints, Court
from courtside.geometry.camera import Camera
from courtside.geometry.camera_fields import METRES
from courtside.records.cameras import clicks, placed_points
from courtside.records.cameras.placed_points import PlacedPoints
from courtside.study.errors import InputError, StrPath

NEAR_M = 0.1  # ASSUME: places meant to be one differ by less, rounding of one of them included
MOVED = 0.8  # ASSUME: of a camera's points: so many must meet others once they are moved
LEFT = 1 / 3  # ASSUME: and no more than so many as they are
FEWEST = 4  # ASSUME: points that meet others after one shift; fewer may do so by chance
# ASSUME: points that one camera sees are nearer to each other, even in a stadium; those of most
# fields of play, at most a football pitch, are within `PITCH_M`.
LARGEST_M, PITCH_M = 500.0, 130.0
# ASSUME: extents by which a unit is guessed: from that of a corner of a room to that of a hall with
# three courts.
USUAL_M = (2.0, 60.0)
IN_WORDS = {"in": "inches", "ft": "feet"}  # units whose short name is another word
# ASSUME: cameras that film people stand higher above the floor, and lower than roofs of halls and
# stands of stadiums.
LOWEST_M, HIGHEST_M = 0.3, 60.0
UPRIGHT = 0.5  # ASSUME: up in pictures that are tilted and rolled by less than 60 degrees, along z
# What to do about mirrored places or clicks.
LEFT_HANDED = (
    "x_m, y_m and z_m must be right-handed with z up: change the sign of y_m in all rows, or undo "
    "the flip of the videos"
)
OTHER_SIDE = (
    "exchange the names of the left and right points in all cameras, or undo the flip of the videos"
)
FROM_BELOW = "y_px must be counted from the top: subtract it from the picture's height minus 1"
RENAME = "exchange the names of these two columns"


def mirrored(towards_z: float, placed: bool) -> str:
    """Return what to do about points that fit a camera once mirrored, which is so far `up` then.

    Mirrored places or videos leave the camera upright; pictures or heights turned over do not.
    """
    side = LEFT_HANDED if placed else OTHER_SIDE
    if towards_z > -UPRIGHT:
        return f": the points are mirrored; {side}"
    heights = ", or, if z_m points down, change its sign in all rows" if placed else ""
    return (
        f", but the camera hangs upside down: {FROM_BELOW}{heights}; only if it is mounted so, the "
        f"points are mirrored: {side}"
    )


@dataclass(frozen=True, eq=False)
class Shift:
    """What must be added to all places of one camera's points."""

    camera: str
    by_m: NDArray  # (3,)
    n_points: int
    n_met: int  # of them, once moved
    n_before: int  # of them, as they are

    def __str__(self) -> str:
        small = [
            f"{key} is {abs(by):.2f} m too {'small' if by > 0 else 'large'}"
            for key, by in zip(("x_m", "y_m", "z_m"), self.by_m, strict=True)
            if abs(by) >= NEAR_M / 2
        ]
        return (
            f"camera {self.camera}: expected its {self.n_points} points at places that points of "
            f"other cameras have, found {self.n_before} there, and {self.n_met} once all are "
            f"moved by one shift: of this camera's points {', '.join(small)}; correct them"
        )


def shifts(placed: PlacedPoints) -> list[Shift]:
    """Return the shifts of cameras whose points meet those of other cameras only after one.

    Only shifts of less than half the usual distance between neighbouring points are found: a longer
    one may lead from one line of a court to the next. Of two cameras alone, both are found.
    """
    found = []
    for camera in placed.clicks:
        others = [name for name in placed.clicks if name != camera]
        seen = [placed.of(name) for name in others]
        there = np.unique(np.concatenate(seen)) if seen else np.zeros(0, dtype=int)
        own = placed.xyz[placed.of(camera)]
        if len(own) >= FEWEST and len(there) >= FEWEST:
            shift = _shift(camera, own, placed.xyz[there])
            found += [shift] if shift else []
    return found


def _shift(camera: str, own: NDArray, others: NDArray) -> Shift | None:
    before = _met(own, others).sum()
    if before > LEFT * len(own):
        return None
    steps = (others[:, None] - own).reshape(-1, 3)
    steps = steps[np.linalg.norm(steps, axis=1) < _spacing(others) / 2]
    counts = [_met(own + step, others).sum() for step in steps]
    if not counts or max(counts) < max(FEWEST, MOVED * len(own)):
        return None
    step = steps[int(np.argmax(counts))]
    met = _met(own + step, others)
    apart = np.linalg.norm(others[:, None] - (own + step)[met], axis=-1)
    by_m = np.median(others[apart.argmin(axis=0)] - own[met], axis=0)
    return Shift(camera, by_m, len(own), int(met.sum()), int(before))


def _met(own: NDArray, others: NDArray) -> NDArray:
    """Say which of some places (N, 3) have another one near, (N,) bool."""
    return np.linalg.norm(own[:, None] - others, axis=-1).min(axis=1) < NEAR_M


def _spacing(xyz: NDArray) -> float:
    """Return the median distance of places (N, 3) to the nearest that is not the same, m."""
    apart = np.linalg.norm(xyz[:, None] - xyz, axis=-1)
    return float(np.median(np.where(apart < NEAR_M, np.inf, apart).min(axis=1)))


def read(
    clicks_csv: StrPath, court_yaml: StrPath, cameras: Sequence[str], placed: bool
) -> tuple[Court, ClickedPoints]:
    """Return the court and the clicks of a session; `placed` points are returned as a court.

    Raises `InputError` if a file is invalid, if all points of a camera are shifted, or if places
    cannot be in metres.
    """
    if not placed:
        court = court_files.read(court_yaml)
        return court, clicks.read(clicks_csv, cameras, list(court.points))
    return as_court(clicks_csv, placed_points.read(clicks_csv, cameras))


def as_court(path: StrPath, points: PlacedPoints) -> tuple[Court, ClickedPoints]:
    """Do as `read` with points that were read from a file with places of their own."""
    if wrong := [*_in_other_units(points)] or shifts(points):
        raise InputError(*(f"{path}: {one}" for one in wrong))
    return court_files.of_places("points", points.points, points.xyz), points.clicks


def _in_other_units(placed: PlacedPoints) -> Iterator[str]:
    """Yield whether the points of a camera are too far apart for metres: those farthest apart."""
    camera, extent = _widest(placed.xyz, placed.clicks)
    if extent > LARGEST_M:
        yield (
            f"camera {camera}: expected points in m, less than {LARGEST_M:.0f} m apart, found "
            f"{extent:.0f} m between them; {_conversion(extent)}"
        )


def unit_doubt(xyz: NDArray, clicks: ClickedPoints) -> Iterator[str]:
    """Yield whether points at places (P, 3) of a camera are farther apart than a pitch is long."""
    camera, extent = _widest(xyz, clicks)
    if PITCH_M < extent <= LARGEST_M:
        yield (
            f"camera {camera}: its points are {extent:.0f} m apart: right on a field of that size; "
            f"if not, {_conversion(extent)}"
        )


def _widest(xyz: NDArray, clicks: ClickedPoints) -> tuple[str, float]:
    """Return the camera that sees the points farthest apart, and their extent; 0 without any."""
    extent = {
        name: float(np.linalg.norm(np.ptp(xyz[seen], axis=0)))
        for name, xy in clicks.items()
        if (seen := np.isfinite(xy).all(axis=1)).any()
    }
    return max(extent.items(), key=lambda one: one[1], default=("", 0.0))


def _conversion(extent: float) -> str:
    """Return in which units such an extent is a usual one, and how places become m."""
    fits = [
        f"{IN_WORDS.get(unit, unit)} ({extent * metres:.3g} m apart: multiply them by {metres:g})"
        for unit, metres in METRES.items()
        if USUAL_M[0] <= extent * metres <= USUAL_M[1]
    ]
    if not fits:
        return "give x_m, y_m and z_m in m"
    return f"x_m, y_m and z_m are likely in {' or '.join(fits)}"


def check_cameras(court: Court, cameras: Sequence[Camera], clicked: ClickedPoints) -> list[str]:
    """Check that cameras can stand where their points put them; return warnings, one line each.

    Raises `InputError` if cameras lie below the floor points that they see: their places or clicks
    are mirrored. Points at one height above the floor, of a gallery or a ceiling, can be seen from
    below; points at several heights fit no mirror image.
    """
    high, below, level = {}, {}, {}
    hanging: list[str] = []
    for camera in cameras:
        z = court.xyz[np.isfinite(clicked[camera.name]).all(axis=1), 2]
        if not len(z):
            continue
        above_m = float(camera.centre_in_world[2] - np.median(z))
        hanging += [camera.name] * (up(camera) < -UPRIGHT)
        if above_m > HIGHEST_M:
            high[camera.name] = above_m
        elif above_m < -LOWEST_M:
            on_floor, flat = np.median(np.abs(z)) <= RAISED_M, np.ptp(z) <= RAISED_M
            if on_floor or (flat and camera.name in hanging):
                below[camera.name] = -above_m
            elif flat:
                level[camera.name] = -above_m
    if below:
        towards_z = float(np.mean([up(camera) for camera in cameras if camera.name in below]))
        raise InputError(
            f"cameras {', '.join(below)}: expected them above the floor points that they see, "
            f"found them {_range(below)} m below: points or clicks are mirrored; "
            f"{_mend(towards_z, court.placed)}"
        )
    unit = [*unit_doubt(court.xyz, clicked)] if court.placed else []
    return [*_level(level), *_too_high(high), *unit, *_hanging(hanging, court.placed)]


def _level(below_m: Mapping[str, float]) -> Iterator[str]:
    """Yield a warning of cameras below points that are all at one height, by camera."""
    if below_m:
        yield (
            f"cameras {', '.join(below_m)}: {_range(below_m)} m below all of their points, which "
            "are at one height: right if these are on a gallery or a ceiling; if not, "
            f"{LEFT_HANDED}; points at several heights decide it"
        )


def _too_high(above_m: Mapping[str, float]) -> Iterator[str]:
    """Yield a warning of cameras too high above their points, by camera."""
    if above_m:
        yield (
            f"cameras {', '.join(above_m)}: expected them at most {HIGHEST_M:.0f} m above their "
            f"points, found {_range(above_m)} m; check the unit of the places, which is m"
        )


def _hanging(names: Sequence[str], placed: bool) -> Iterator[str]:
    """Yield a warning of cameras that hang upside down: whether they do, nothing else tells."""
    if names:
        yield (
            f"cameras {', '.join(names)}: expected them upright, found them upside down: right if "
            f"they are mounted so; if not, {FROM_BELOW}, and the points are mirrored too: "
            f"{LEFT_HANDED if placed else OTHER_SIDE}"
        )


def up(camera: Camera) -> float:
    """Return how far the upward direction of a picture is along z, -1 to 1."""
    return -float(camera.cam_from_world[1, 2])


def _mend(towards_z: float, placed: bool) -> str:
    """Return what to do about points that cameras see from below, by their mean `up`."""
    if towards_z > UPRIGHT:
        return FROM_BELOW
    if towards_z > -UPRIGHT:
        return f"x_px and y_px seem to be exchanged: {RENAME}"
    return LEFT_HANDED if placed else OTHER_SIDE


def _range(lengths_m: Mapping[str, float]) -> str:
    low, high = (f"{value:.1f}" for value in (min(lengths_m.values()), max(lengths_m.values())))
    return low if low == high else f"{low} to {high}"
