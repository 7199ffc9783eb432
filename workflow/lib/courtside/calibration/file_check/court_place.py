"""A check of cameras by the painted lines of a court, whose size is known.

Each static picture shows points of the court by itself (`calibration.court_lines`). With the lens
of the file, each camera alone says where the court is. The place on which most cameras agree is
taken as right; a camera that sees the court elsewhere was moved, turned or zoomed, and one that no
place fits has another lens.

A picture does not show which end is which where half a turn leaves the lines as they are: each
camera takes the end that fits. Nor does it show which of several courts side by side it is: a
camera that sees the court metres away is left out.

C cameras, P points of the court. Views are (C, P, 2) px, NaN where unseen.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
import scipy
from numpy.typing import NDArray

from courtside.calibration import robust_poses
from courtside.calibration.court.court import Court
from courtside.calibration.file_check import faults
from courtside.calibration.file_check.faults import Fault
from courtside.geometry import epipolar, rotations, similarity
from courtside.geometry.camera import Camera, project, undistort
from courtside.geometry.similarity import Sim3

FEWEST = 6  # points on the floor that place a court
NEAR = 0.01  # of the picture's longer side, as a limit of RANSAC: wide enough for a wrong lens
# ASSUME: of the longer side of the picture, per axis: a camera that disagrees by more is wrong.
LARGEST = 2e-3
MOST = 5.0  # of this limit: how much one camera counts against a place at most
SCALED = 0.5  # ASSUME: in the same unit: another size of the court must explain more than this
ELSEWHERE_M = 3.0  # ASSUME: a camera that sees the court farther away sees another court
# ASSUME: each fitted number must lower the logarithm of the spread by this; the farthest views may
# be of wrong lines, and below the floor a spread says nothing.
PRICE, NEARER, FLOOR_PX = 0.1, 0.8, 0.3
WAYS = (faults.FOCAL, faults.TURNED, faults.ZOOMED, faults.MOVED, faults.LENS)
# ASSUME: how far a right court may be from its file, as the cameras of a calibration file see it.
MOST_SCALE, MOST_TURN_DEG, MOST_AWAY_M = 0.01, 2.0, 0.3
ROWS = ("camera", "n", "x_px", "y_px", "off_px", "alone_px", "away_m")


@dataclass(frozen=True, eq=False)
class Place:
    """Where a court is, by all cameras, and what each of them sees of it."""

    court: Court
    world_from_court: Sim3
    xy: NDArray  # (C, P, 2) px: the views, with the end that fits
    either_end: bool
    off_px: NDArray  # (C,): median over points, per axis; NaN where a camera shows no court
    alone_px: NDArray  # (C,): the same of the place that fits this camera best
    away_m: NDArray  # (C,): between the court's middle as this camera alone and as all see it
    limit_px: NDArray  # (C,): more is too much

    def wrong(self) -> NDArray:
        """Return the indices of cameras that see the court elsewhere."""
        return np.flatnonzero(self.off_px > self.limit_px)

    def off_px_of(self, cameras: Sequence[Camera], at: int) -> float:
        """Return `off_px` of one camera with other numbers, by the end that fits these."""
        xyz = self.world_from_court.points(self.court.xyz)
        return min(_off_px(cameras[at], view, xyz) for view in self.ends(at))

    def ends(self, at: int) -> list[NDArray]:
        """Return the views (P, 2) px of a camera, and, of either end, as of the other one."""
        view = self.xy[at]
        return [view, self.court.turned(view)] if self.either_end else [view]

    def n_agreeing(self) -> int:
        """Return how many cameras see the court here."""
        return int((self.off_px <= self.limit_px).sum())


@dataclass(frozen=True, eq=False)
class Verdict:
    """What is wrong with each camera, the faults, and what all cameras share."""

    of_camera: dict[str, str]  # what is wrong, by the camera's name, in words that follow this name
    shared: list[str]  # warnings about all cameras together
    faults: list[Fault]  # each with the cameras without it and without those before
    place: Place | None  # None where fewer than two cameras show the court

    @property
    def warnings(self) -> list[str]:
        """One for each camera that is wrong, and what all cameras share."""
        each = [f"camera {name} of the file {words}" for name, words in self.of_camera.items()]
        return each + self.shared


def judge(cameras: Sequence[Camera], xy: NDArray, court: Court, *, either_end: bool) -> Verdict:
    """Judge cameras by views of a court's points.

    `either_end` states that each view may be of the court after half a turn.
    """
    place, mended = locate(cameras, xy, court, either_end=either_end), tuple(cameras)
    if place is None:
        return Verdict({}, [], [], None)
    if place.n_agreeing() < 2:
        is_one_court = (place.away_m[place.wrong()] <= ELSEWHERE_M).any()
        return Verdict({}, [_nobody_agrees(cameras, place)] * bool(is_one_court), [], place)
    of_camera, found = {}, []
    for at in place.wrong():
        if place.off_px_of(mended, at) <= place.limit_px[at]:  # exchanged with one before
            continue
        words, fault = _explained(mended, int(at), place)
        if words:
            of_camera[cameras[at].name] = words
        if fault:
            found.append(fault)
            mended = fault.cameras
    shared = _shared_fault(place)
    return Verdict(of_camera, [shared] if shared else [], found, place)


def locate(
    cameras: Sequence[Camera], xy: NDArray, court: Court, *, either_end: bool
) -> Place | None:
    """Find the place of a court on which most cameras agree; None if fewer than two show it."""
    xy = np.where(court.on_floor[:, None], xy, np.nan)
    limit_px = np.array([LARGEST * max(camera.size) for camera in cameras])
    shown = [at for at, view in enumerate(xy) if _is_enough(np.isfinite(view[:, 0]), court)]
    views = _Views([cameras[at] for at in shown], xy[shown], court, limit_px[shown])
    starts = [place for place in views.alone() if place]
    if len(starts) < 2:
        return None
    tried = []
    for start in starts:
        placed = views.with_ends(start) if either_end else views
        places = start, placed.refined(start, sized=False), placed.refined(start, sized=True)
        tried += [(place, placed) for place in places]
    common, views = min(tried, key=lambda one: one[1].against(one[0]))
    agree = np.flatnonzero(views.off_px(common) <= views.limit_px)
    if len(agree) >= 2:  # by those alone, so that wrong cameras do not pull
        common = views.of(agree).refined(common, sized=common.scale != 1)
    xy[shown] = views.xy
    middle = np.array([*court.size_m / 2, 0.0])
    off_px, alone_px, away_m = (np.full(len(cameras), np.nan) for _ in range(3))
    off_px[shown], alone_px[shown], away_m[shown] = views.off_px(common), np.inf, np.inf
    for k, (at, place) in enumerate(zip(shown, views.alone(), strict=True)):
        if place:
            alone_px[at] = _off_px(views.cameras[k], views.xy[k], place.points(court.xyz))
            away_m[at] = np.linalg.norm(place.points(middle) - common.points(middle))
    return Place(court, common, xy, either_end, off_px, alone_px, away_m, limit_px)


def by_camera(cameras: Sequence[Camera], place: Place) -> pd.DataFrame:
    """Return what each camera sees of the court, with the columns `ROWS`.

    `x_px`, `y_px`: the median from where the common court is expected to where this camera sees it;
    the others as in `Place`. NaN where a camera shows no court.
    """
    xyz, rows = place.world_from_court.points(place.court.xyz), []
    for at, camera in enumerate(cameras):
        view = place.xy[at]
        shift_px = (view - project(camera, xyz))[np.isfinite(view).all(axis=-1)]
        x_px, y_px = np.median(shift_px, axis=0) if len(shift_px) else (np.nan, np.nan)
        off = place.off_px[at], place.alone_px[at], place.away_m[at]
        rows.append((camera.name, len(shift_px), x_px, y_px, *off))
    return pd.DataFrame(rows, columns=ROWS)


@dataclass(frozen=True, eq=False)
class _Views:
    """Views of a court by cameras that each show enough of it."""

    cameras: list[Camera]
    xy: NDArray
    court: Court
    limit_px: NDArray

    def of(self, chosen: NDArray) -> "_Views":
        cameras = [self.cameras[at] for at in chosen]
        return _Views(cameras, self.xy[chosen], self.court, self.limit_px[chosen])

    def off_px(self, world_from_court: Sim3) -> NDArray:
        """Return how far each camera's views are from the court (C,)."""
        xyz = world_from_court.points(self.court.xyz)
        each = zip(self.cameras, self.xy, strict=True)
        return np.array([_off_px(camera, view, xyz) for camera, view in each])

    def alone(self) -> list[Sim3 | None]:
        """Return where each camera alone sees the court."""
        each = zip(self.cameras, self.xy, strict=True)
        return [_alone(camera, view, self.court) for camera, view in each]

    def against(self, world_from_court: Sim3) -> float:
        """Return how much speaks against a place: the less, the better."""
        off = np.minimum(self.off_px(world_from_court) / self.limit_px, MOST)
        return float(off.sum() + SCALED * (world_from_court.scale != 1))

    def with_ends(self, world_from_court: Sim3) -> "_Views":
        """Return the views with points named by the end that fits a place."""
        xyz = world_from_court.points(self.court.xyz)
        chosen = self.xy.copy()
        for at, (camera, view) in enumerate(zip(self.cameras, self.xy, strict=True)):
            turned = self.court.turned(view)
            if _off_px(camera, turned, xyz) < _off_px(camera, view, xyz):
                chosen[at] = turned
        return _Views(self.cameras, chosen, self.court, self.limit_px)

    def refined(self, start: Sim3, *, sized: bool) -> Sim3:
        """Fit a court's place, and its size where `sized`, to cameras of which some are wrong."""

        def moved(free: NDArray) -> Sim3:
            turn = rotations.rotation_from_rodrigues(free[:3])
            larger = float(np.exp(free[6])) if sized else 1.0
            shift = start.translation + free[3:6]
            return Sim3(larger * start.scale, turn @ start.rotation, shift)

        def residuals(free: NDArray) -> NDArray:
            xyz = moved(free).points(self.court.xyz)
            each = zip(self.cameras, self.xy, strict=True)
            away_px = [
                np.linalg.norm(project(camera, xyz) - view, axis=-1) for camera, view in each
            ]
            return np.nan_to_num(away_px / self.limit_px[:, None], nan=0.0).ravel()

        free = np.zeros(7 if sized else 6)
        return moved(scipy.optimize.least_squares(residuals, free, loss="cauchy", max_nfev=50).x)


def _alone(camera: Camera, view: NDArray, court: Court) -> Sim3 | None:
    """Return `world_from_court` as one camera alone sees it; None with too few points."""
    rays = undistort(camera, view)
    seen = np.isfinite(rays).all(axis=-1)
    if not _is_enough(seen, court):
        return None
    limit = NEAR * max(camera.size) / epipolar.focal_px(camera)
    found = robust_poses.resected(court.xyz[seen], rays[seen], limit, 1.0)
    if found is None:
        return None
    on_court = Camera(camera.name, camera.size, camera.K, camera.dist, found[1])
    cam_from_court = faults.fit(on_court, court.xyz[seen], view[seen], faults.MOVED).cam_from_world
    moved = rotations.composed(rotations.invert(camera.cam_from_world), cam_from_court)
    return Sim3(1.0, moved[:, :3], moved[:, 3])


def _is_enough(seen: NDArray, court: Court) -> bool:
    return seen.sum() >= FEWEST and not similarity.is_collinear(court.xyz[seen])


def _off_px(camera: Camera, view: NDArray, xyz: NDArray) -> float:
    """Return how far views (P, 2) are from points (P, 3), px per axis, the median over points."""
    away_px = _away_px(camera, view, xyz)
    return float(np.median(away_px)) if len(away_px) else np.inf


def _spread_px(camera: Camera, view: NDArray, xyz: NDArray) -> float:
    """Return the root mean square of the nearer views, px per axis."""
    away_px = np.sort(_away_px(camera, view, xyz))
    return float(np.sqrt(np.mean(away_px[: max(1, round(NEARER * len(away_px)))] ** 2)))


def _away_px(camera: Camera, view: NDArray, xyz: NDArray) -> NDArray:
    seen = np.isfinite(view).all(axis=-1)
    away_px = np.linalg.norm(project(camera, xyz[seen]) - view[seen], axis=-1) / np.sqrt(2)
    return np.nan_to_num(away_px, nan=np.inf)


def _explained(cameras: tuple[Camera, ...], at: int, place: Place) -> tuple[str, Fault | None]:
    """Return what is wrong with a camera, in words, and the fault; None if unknown.

    Nothing is said of a camera that sees a court metres away, unless a fault without free numbers
    brings it here.
    """
    ends, limit_px = place.ends(at), place.limit_px[at]
    xyz = place.world_from_court.points(place.court.xyz)
    words = (
        "does not see the court's lines where the others do: "
        f"{place.off_px[at]:.1f} px away, expected {limit_px:.1f} or less; "
    )

    def score(fault: Fault) -> float:
        spread_px = min(_spread_px(fault.cameras[at], one, xyz) for one in ends)
        return float(np.log(max(spread_px, FLOOR_PX)) + PRICE * fault.n_free)

    tried = [one for one in faults.simple(cameras) if one.cameras[at] is not cameras[at]]
    is_elsewhere = place.away_m[at] > ELSEWHERE_M
    if not is_elsewhere:
        tried += faults.fitted(cameras, at, xyz, place.xy[at], WAYS)
    best = min(tried, key=score)
    left_px = place.off_px_of(best.cameras, at)
    if left_px <= limit_px and (best.n_free == 0 or place.alone_px[at] <= limit_px):
        return words + f"probably {best.what} ({best.advice}); then {left_px:.1f} px are left", best
    if is_elsewhere:
        return "", None
    if place.alone_px[at] > limit_px:
        words += f"no place of this camera fits them better than to {place.alone_px[at]:.1f} px: "
        return words + "calibrate its lens again", None
    return words + "calibrate it again", None


def _nobody_agrees(cameras: Sequence[Camera], place: Place) -> str:
    far = ", ".join(
        f"{camera.name} {away_m:.2f} m"
        for camera, away_m in zip(cameras, place.away_m, strict=True)
        if np.isfinite(away_m)
    )
    return (
        f"the cameras of the file see the court's lines at different places: {far} from the place "
        "that fits best; too few agree to say which are wrong; check that each video is of its "
        "camera, or calibrate again"
    )


def _shared_fault(place: Place) -> str:
    """Return what is wrong with all cameras together, or nothing.

    Cameras of another unit or frame agree with one another. Figures draw the court in the frame of
    the file, so it must be the court's, but for a half turn that leaves its lines as they are.
    """
    court, world_from_court = place.court, place.world_from_court
    if abs(world_from_court.scale - 1) > MOST_SCALE:
        percent = 100 * (world_from_court.scale - 1)
        return (
            f"court {court.name} is {abs(percent):.1f} % too {'large' if percent > 0 else 'small'} "
            "as the cameras of the file see it; check the unit and scale of the calibration, and "
            "the size of the court"
        )
    middle = np.array([*court.size_m / 2, 0.0])
    away_m = np.linalg.norm(world_from_court.points(middle) - middle)
    turned = world_from_court.rotation
    period = 180 if place.either_end else 360
    about = np.degrees(np.arctan2(turned[1, 0], turned[0, 0])) % period
    about = min(about, period - about)
    tilt = np.degrees(np.arccos(np.clip(turned[2, 2], -1, 1)))
    if away_m <= MOST_AWAY_M and max(about, tilt) <= MOST_TURN_DEG:
        return ""
    return (
        f"the world frame of the file is not that of court {court.name}: its middle is "
        f"{away_m:.1f} m from where figures draw it, turned by {about:.0f} degrees and tilted by "
        f"{tilt:.0f}; move the world of the calibration to the court's outer corner, x along its "
        "short side, z up"
    )
