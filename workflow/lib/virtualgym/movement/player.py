"""A virtual player's motion: route, feet and poses, combined into a stance at any time."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline, CubicSpline
from scipy.ndimage import convolve1d, minimum_filter1d

from courtside.calibration.court.court import Court
from virtualgym.body import stance
from virtualgym.body.stance import SIDES, Stance
from virtualgym.movement import easing, two_bone_ik
from virtualgym.movement.footwork import Foot, Lap, Route
from virtualgym.movement.tpose_clap import Arms
from virtualgym.movement.upper_body import Course, Moment

# ASSUME: coupling of arms, trunk and pelvis to the steps, chosen to look natural; no source is
# recorded.
MOST_REACH = 0.994  # of a leg's length, so that no knee is ever locked
STANDING_REACH = 0.999
SOFT_S, GRID_S = 0.12, 0.02  # smoothing and sampling of the pelvis's height
SWING = 0.85  # radians of an arm per leg length between the feet, forward
COUNTER = 0.22  # radians of the pelvis per leg length between the feet; the thorax turns against it
PELVIS_SHARE = 0.35  # pelvis's share of the thorax's lean and twist
DROP = 0.35  # radians of roll of the pelvis per metre of a foot's lift
SWAY = 0.18  # shift of the pelvis over the standing foot per lift of the other
# Of a hop: the body sinks before it leaves the floor, flies freely, and gives way as it lands.
SINK_S, SINK_M = (0.22, 0.10), 0.03
GIVE_S, GIVE_M = (0.10, 0.35), 0.04
NARROWEST = 0.35  # of a leg's length: least height of a hip over its ankle


@dataclass(frozen=True, eq=False)
class _Body:
    """Feet (ankle, direction, lift), stride, upright body axes, pelvis axes, pelvis place (2,)."""

    feet: dict[str, tuple[NDArray, NDArray, float]]
    stride: float
    upright: np.ndarray
    pelvis: np.ndarray
    place: np.ndarray


@dataclass(frozen=True, eq=False)
class Motion:
    """One performance.

    Attributes
    ----------
    seconds : float
    events : dict of str to float
        True times of events, s.
    proportions : Proportions
        Of the body for which the feet were planted.
    route : Route or Lap
    feet : dict of str to Foot
    course : Course
    arms : tpose_clap.Arms or None
        Controls both arms during claps.
    racket : bool
    reach : float
        Greatest distance from hip to ankle, in leg lengths.
    frame : (3, 3) float, (3,) float
        The player's half of the court in the world: origin on the floor below the middle of the
        net, y towards the net.
    left_handed : bool
        Mirrored at the court's long centre line.
    hops : tuple of (float, float)
        When the last foot leaves the floor and when the first lands, s; a second or more apart.
    """

    seconds: float
    events: dict[str, float]
    proportions: stance.Proportions
    route: Route | Lap
    feet: dict[str, Foot]
    course: Course
    arms: Arms | None = None
    racket: bool = True
    reach: float = MOST_REACH
    frame: tuple[NDArray, NDArray] = (np.eye(3), np.zeros(3))
    left_handed: bool = False
    hops: tuple[tuple[float, float], ...] = ()
    _height: CubicSpline = field(init=False, repr=False)
    _hopped: CubicHermiteSpline | None = field(init=False, repr=False)

    def __post_init__(self) -> None:
        # The minimum over SOFT_S before and after, averaged over the same window: smooth, never too
        # high.
        times = np.arange(-2 * SOFT_S, self.seconds + 2 * SOFT_S, GRID_S)
        highest = [self._highest(time_s) for time_s in times]
        lowest = minimum_filter1d(highest, 2 * round(SOFT_S / GRID_S) + 1)
        kernel = np.hanning(2 * round(SOFT_S / GRID_S) + 1)
        smooth = convolve1d(lowest, kernel / kernel.sum())
        object.__setattr__(self, "_height", CubicSpline(times, smooth))
        object.__setattr__(self, "_hopped", hop_rise(self.hops) if self.hops else None)

    def stance(self, time_s: float) -> Stance:
        """Return the stance at a time, clipped to the motion's duration."""
        time_s = float(np.clip(time_s, 0.0, self.seconds))
        local = self._local(time_s)
        if self.left_handed:
            local = stance.mirrored(local, np.zeros(3), np.array([1.0, 0.0, 0.0]))
        return stance.moved(local, *self.frame)

    def planted(self, side: str) -> NDArray:
        """Return the intervals (n, 2) s in which a foot stands flat and still."""
        own = stance.OTHER[side] if self.left_handed else side
        return self.feet[own].standing()

    def _body(self, moment: Moment, time_s: float) -> _Body:
        """Return the state of legs and trunk, without the pelvis's height."""
        place, heading = self.route.at(time_s)
        feet = {side: self.feet[side].at(time_s) for side in SIDES}
        stride = self._stride(feet, heading)
        upright = two_bone_ik.facing(heading)
        # Over the standing foot, and down on the other side.
        drop = feet["right"][2] - feet["left"][2]
        turned = PELVIS_SHARE * moment.twist - COUNTER * stride
        pelvis = two_bone_ik.turn(turned, PELVIS_SHARE * moment.lean, DROP * drop)
        return _Body(feet, stride, upright, upright @ pelvis, place + SWAY * drop * upright[:2, 0])

    def _local(self, time_s: float) -> Stance:
        moment = self.course.at(time_s)
        body = self._body(moment, time_s)
        thorax = two_bone_ik.turn(
            moment.twist + 0.6 * COUNTER * body.stride, moment.lean, moment.roll
        )
        thorax = body.upright @ thorax
        head = body.upright @ two_bone_ik.turn(moment.look[0], moment.look[1], 0.0)
        height = float(self._height(time_s))
        if self._hopped is not None:
            height += float(self._hopped(np.clip(time_s, *self._hopped.x[[0, -1]])))
        middle = np.append(body.place, height)
        directions = self._legs(middle, body)
        arms, palms, racket = self._arms(moment, body.stride, time_s)
        directions |= {name: thorax @ way for name, way in arms.items()}
        return Stance(
            pelvis=middle,
            world_from_pelvis=body.pelvis,
            world_from_thorax=thorax,
            world_from_head=head,
            directions=directions,
            palms={side: thorax @ palm for side, palm in palms.items()},
            racket=thorax @ racket if self.racket else None,
        )

    def _stride(self, feet: dict[str, tuple[NDArray, NDArray, float]], heading: float) -> float:
        """Return the right foot's lead over the left in leg lengths, limited to +-1."""
        forward = np.array([-np.sin(heading), np.cos(heading)])
        ahead = (feet["right"][0] - feet["left"][0])[:2] @ forward
        return np.tanh(ahead / self._leg())

    def _leg(self) -> float:
        return self.proportions.thigh + self.proportions.shank

    def _hips(self, pelvis: NDArray) -> dict[str, NDArray]:
        half = self.proportions.hip_width / 2
        return {side: sign * half * pelvis[:, 0] for side, sign in (("left", 1), ("right", -1))}

    def _highest(self, time_s: float) -> float:
        """Return the pelvis's height, m: that of the pose, or less to keep both feet in reach."""
        moment = self.course.at(time_s)
        body = self._body(moment, time_s)
        leg, lowest = self._leg(), self.proportions.ankle_height
        heights = [lowest + leg * moment.height]
        for side, hip in self._hips(body.pelvis).items():
            ankle = body.feet[side][0]
            away = np.sum((body.place + hip[:2] - ankle[:2]) ** 2)
            rise = np.sqrt(max((self.reach * leg) ** 2 - away, (NARROWEST * leg) ** 2))
            heights.append(ankle[2] + rise - hip[2])
        return min(heights)

    def _legs(self, middle: NDArray, body: _Body) -> dict[str, NDArray]:
        directions: dict[str, NDArray] = {}
        lengths = self.proportions.thigh, self.proportions.shank
        for side, hip in self._hips(body.pelvis).items():
            ankle, foot, _ = body.feet[side]
            toes = np.append(two_bone_ik.unit(foot[:2]), 0.0)
            pole = 0.6 * toes + 0.4 * body.upright[:, 2]
            thigh, shank = two_bone_ik.bend(middle + hip, ankle, lengths, pole)
            directions |= {f"{side}_thigh": thigh, f"{side}_shank": shank, f"{side}_foot": foot}
        return directions

    def _arms(
        self, moment: Moment, stride: float, time_s: float
    ) -> tuple[dict[str, NDArray], dict[str, NDArray], NDArray]:
        """Return directions and palms of the arms and the racket, in the axes of the thorax."""
        rows = {}
        for k, (side, sign) in enumerate((("left", 1.0), ("right", -1.0))):
            swung = two_bone_ik.turn(pitch=-sign * SWING * moment.swing[k] * stride)
            rows[side] = getattr(moment, side) @ swung.T
        racket = swung @ moment.racket
        if self.arms is not None:
            rows = self.arms.blend(rows, time_s)
        directions: dict[str, NDArray] = {}
        palms = {}
        for side, (upper, fore, hand, palm) in rows.items():
            directions |= {
                f"{side}_upper_arm": upper,
                f"{side}_forearm": fore,
                f"{side}_hand": hand,
            }
            palms[side] = two_bone_ik.across(palm, hand)
        return directions, palms, racket


def hop_rise(hops: tuple[tuple[float, float], ...]) -> CubicHermiteSpline:
    """Return the pelvis's height in hops over its height without them, m; in flight a parabola."""
    knots = []
    for off, land in hops:
        lasts = land - off
        speed = easing.GRAVITY_M_S2 * lasts / 2
        knots += [(off - SINK_S[0], 0.0, 0.0), (off - SINK_S[1], -SINK_M, 0.0), (off, 0.0, speed)]
        knots += [((off + land) / 2, easing.flight_m(lasts), 0.0), (land, 0.0, -speed)]
        knots += [(land + GIVE_S[0], -GIVE_M, 0.0), (land + GIVE_S[1], 0.0, 0.0)]
    return CubicHermiteSpline(*np.array(knots).T)


@dataclass(frozen=True, eq=False)
class Player:
    """Who performs: a body on one half ("near": y below the net's, or "far") of a court."""

    proportions: stance.Proportions
    court: Court
    rng: np.random.Generator
    hand: str = "right"
    half: str = "near"

    def __post_init__(self) -> None:
        if self.hand not in SIDES or self.half not in ("near", "far"):
            found = f"{self.hand}, {self.half}"
            raise ValueError(f"expected hand left or right and half near or far, found {found}")

    @property
    def half_m(self) -> NDArray:
        """Half the court's width and length (2,), m."""
        return np.asarray(self.court.size_m, float) / 2

    def motion(
        self,
        seconds: float,
        route: Route | Lap,
        feet: dict[str, Foot],
        course: Course,
        *,
        events: Mapping[str, float] | None = None,
        **options: Any,
    ) -> Motion:
        """Return the motion of a route, feet and poses in the frame of the player's half."""
        turned = np.diag([1.0, 1.0, 1.0] if self.half == "near" else [-1.0, -1.0, 1.0])
        return Motion(
            seconds=float(seconds),
            events={name: float(time_s) for name, time_s in (events or {}).items()},
            proportions=self.proportions,
            route=route,
            feet=feet,
            course=course,
            frame=(turned, np.append(self.half_m, 0.0)),
            left_handed=self.hand == "left",
            **options,
        )
