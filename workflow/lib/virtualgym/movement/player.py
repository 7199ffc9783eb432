"""A motion of a virtual player: route, feet and poses put together into a stance at any time."""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.ndimage import convolve1d, minimum_filter1d

from virtualgym.body import stance
from virtualgym.body.stance import SIDES, Stance
from virtualgym.movement import two_bone_ik

MOST_REACH = 0.994  # of a leg's length, so that no knee is ever locked
STANDING_REACH = 0.999
SOFT_S, GRID_S = 0.12, 0.02  # the pelvis's height is smooth over that; sampled at that
SWING = 0.85  # radians of an arm per leg length between the feet, forward
COUNTER = 0.22  # radians of the pelvis per leg length between the feet; the thorax turns against it
PELVIS_SHARE = 0.35  # of the lean and of the twist of the thorax, the pelvis takes part
DROP = 0.35  # radians of roll of the pelvis per metre of a foot's lift
SWAY = 0.18  # of a foot's lift, the pelvis moves over the other
NARROWEST = 0.35  # of a leg's length: the lowest a hip comes over its ankle


@dataclass(frozen=True, eq=False)
class _Body:
    """Feet (ankle, direction, lift), stride, body axes when upright, of the pelvis, and its place (2,)."""

    feet: dict
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
        True times of what happens, s.
    proportions : stance.Proportions
        Of the body for which the feet were planted.
    route : footwork.Route
    feet : dict of str to footsteps.Foot
    course : poses.Course
    arms : clapping.Arms or None
        Takes over both arms in its span.
    racket : bool
    reach : float
        The longest a leg gets, in leg lengths.
    frame : (3, 3) float, (3,) float
        The player's half of the court in the world: origin on the floor below the middle of the net, y
        towards the net.
    left_handed : bool
        Performed in the mirror of the court's long middle line.
    """

    seconds: float
    events: dict
    proportions: stance.Proportions
    route: object
    feet: dict
    course: object
    arms: object = None
    racket: bool = True
    reach: float = MOST_REACH
    frame: tuple = (np.eye(3), np.zeros(3))
    left_handed: bool = False

    def __post_init__(self):
        # The lowest of the next and the last SOFT_S, averaged over as long: smooth, and never too high.
        times = np.arange(-2 * SOFT_S, self.seconds + 2 * SOFT_S, GRID_S)
        highest = [self._highest(time_s) for time_s in times]
        lowest = minimum_filter1d(highest, 2 * round(SOFT_S / GRID_S) + 1)
        kernel = np.hanning(2 * round(SOFT_S / GRID_S) + 1)
        smooth = convolve1d(lowest, kernel / kernel.sum())
        object.__setattr__(self, "_height", CubicSpline(times, smooth))

    def stance(self, time_s):
        """Return the `stance.Stance` at a time, s; before 0 and after the end it stays as there."""
        time_s = float(np.clip(time_s, 0.0, self.seconds))
        local = self._local(time_s)
        if self.left_handed:
            local = stance.mirrored(local, np.zeros(3), np.array([1.0, 0.0, 0.0]))
        return stance.moved(local, *self.frame)

    def planted(self, side):
        """Return the spans (n, 2) s during which a foot stands flat and still."""
        own = stance.OTHER[side] if self.left_handed else side
        return self.feet[own].standing()

    def _body(self, moment, time_s):
        """Return what the legs and the trunk do, apart from the pelvis's height."""
        place, heading = self.route.at(time_s)
        feet = {side: self.feet[side].at(time_s) for side in SIDES}
        stride = self._stride(feet, heading)
        upright = two_bone_ik.facing(heading)
        drop = (
            feet["right"][2] - feet["left"][2]
        )  # over the standing foot, and down on the other side
        turned = PELVIS_SHARE * moment.twist - COUNTER * stride
        pelvis = two_bone_ik.turn(turned, PELVIS_SHARE * moment.lean, DROP * drop)
        return _Body(feet, stride, upright, upright @ pelvis, place + SWAY * drop * upright[:2, 0])

    def _local(self, time_s):
        moment = self.course.at(time_s)
        body = self._body(moment, time_s)
        thorax = two_bone_ik.turn(
            moment.twist + 0.6 * COUNTER * body.stride, moment.lean, moment.roll
        )
        thorax = body.upright @ thorax
        head = body.upright @ two_bone_ik.turn(moment.look[0], moment.look[1], 0.0)
        middle = np.append(body.place, float(self._height(time_s)))
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

    def _stride(self, feet, heading):
        """Return how far the right foot is ahead of the left, in leg lengths, limited."""
        forward = np.array([-np.sin(heading), np.cos(heading)])
        ahead = (feet["right"][0] - feet["left"][0])[:2] @ forward
        return np.tanh(ahead / self._leg())

    def _leg(self):
        return self.proportions.thigh + self.proportions.shank

    def _hips(self, pelvis):
        half = self.proportions.hip_width / 2
        return {side: sign * half * pelvis[:, 0] for side, sign in (("left", 1), ("right", -1))}

    def _highest(self, time_s):
        """Return how high the pelvis may be, m: as the pose wants it, but both feet within reach."""
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

    def _legs(self, middle, body):
        directions = {}
        lengths = self.proportions.thigh, self.proportions.shank
        for side, hip in self._hips(body.pelvis).items():
            ankle, foot, _ = body.feet[side]
            toes = np.append(two_bone_ik.unit(foot[:2]), 0.0)
            pole = 0.6 * toes + 0.4 * body.upright[:, 2]
            thigh, shank = two_bone_ik.bend(middle + hip, ankle, lengths, pole)
            directions |= {f"{side}_thigh": thigh, f"{side}_shank": shank, f"{side}_foot": foot}
        return directions

    def _arms(self, moment, stride, time_s):
        """Return directions and palms of the arms and the racket, in the axes of the thorax."""
        rows = {}
        for k, (side, sign) in enumerate((("left", 1.0), ("right", -1.0))):
            swung = two_bone_ik.turn(pitch=-sign * SWING * moment.swing[k] * stride)
            rows[side] = getattr(moment, side) @ swung.T
        racket = swung @ moment.racket
        if self.arms is not None:
            rows = self.arms.blend(rows, time_s)
        directions, palms = {}, {}
        for side, (upper, fore, hand, palm) in rows.items():
            directions |= {
                f"{side}_upper_arm": upper,
                f"{side}_forearm": fore,
                f"{side}_hand": hand,
            }
            palms[side] = two_bone_ik.across(palm, hand)
        return directions, palms, racket


@dataclass(frozen=True, eq=False)
class Player:
    """Who performs: a body, on a half of a court, from one source of chance.

    Attributes
    ----------
    proportions : stance.Proportions
    court : courtside.calibration.court.court.Court
    rng : numpy.random.Generator
    hand : str
        "right" or "left".
    half : str
        "near" (y below the net's) or "far".
    """

    proportions: stance.Proportions
    court: object
    rng: np.random.Generator
    hand: str = "right"
    half: str = "near"

    def __post_init__(self):
        if self.hand not in SIDES or self.half not in ("near", "far"):
            found = f"{self.hand}, {self.half}"
            raise ValueError(f"expected hand left or right and half near or far, found {found}")

    @property
    def half_m(self):
        """Half the court's width and length (2,), m."""
        return np.asarray(self.court.size_m, float) / 2

    def motion(self, seconds, route, feet, course, *, events=None, **options):
        """Return the `Motion` of a route, feet and poses planned in the frame of the player's half."""
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
