"""Place the body's bones in a stance; bend a hand's fingers; place a racket's grip in it."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from virtualgym.body import rotations
from virtualgym.body.makehuman import Figure
from virtualgym.body.stance import SIDES, Stance

SPINE = ("spine05", "spine04", "spine03", "spine02", "spine01")
# ASSUME: how a rotation is spread over spine, neck and twist bones was chosen to look natural, as
# were the limits below; no source is recorded.
SPINE_SHARES = (0.1, 0.35, 0.65, 0.9, 1.0)  # of the rotation from pelvis to thorax
NECK = ("neck01", "neck02", "neck03", "head")
NECK_SHARES = (0.25, 0.5, 0.75, 1.0)
TOES = "toe2-1"  # represents all toes of a foot
ARM = ("clavicle", "upperarm01", "upperarm02", "lowerarm01", "lowerarm02", "wrist")
LEG = ("upperleg01", "upperleg02", "lowerleg01", "lowerleg02", "foot", TOES)
SUFFIX = {"left": ".L", "right": ".R"}
BONES = ("root", *SPINE, *NECK, *(b + SUFFIX[side] for side in SIDES for b in ARM + LEG))
# The clavicle takes part in the arm's elevation, by some 30 degrees of 180 [Inman 1944].
LIFT, REACH = 0.3, 0.12  # radians of the clavicle per unit that the upper arm points up, forward
FIRST_HALF = 0.5  # share of a twist in the first of two bones of upper arm or thigh
FOREARM_TWIST = 0.2, 0.65  # shares of the hand's twist in the forearm's two bones
MOST_TWIST, MOST_TOES = np.radians(110), np.radians(75)
# Sine of a vector's angle to the twist axis: below, it says nothing about the twist; above, all.
BENT = 0.15, 0.5
# Vertical component of the shank: below, its foot is in the air; above, on the floor.
STANDING = 0.3, 0.8


@dataclass(frozen=True, eq=False)
class Skeleton:
    """The joints of a body in its rest pose, body axes, metres.

    Attributes
    ----------
    heads : dict of str to (3,) float
        Start of each of BONES.
    hips : (3,) float
        Midpoint of the two hip joints.
    knuckles, toes, tips : dict of str to (3,) float
        By side: the first joint of the middle finger, of the second toe, and that toe's tip.
    across, palms : dict of str to (3,) float
        By side: unit vectors from little to index finger and out of the palm, orthogonal to the
        hand.
    """

    heads: dict[str, np.ndarray]
    hips: np.ndarray
    knuckles: dict[str, np.ndarray]
    toes: dict[str, np.ndarray]
    tips: dict[str, np.ndarray]
    across: dict[str, np.ndarray]
    palms: dict[str, np.ndarray]

    @classmethod
    def of(cls, figure: Figure) -> "Skeleton":
        """Find the joints of a `makehuman.Figure`."""
        heads = {bone: figure.head(bone) for bone in BONES}
        knuckles = {side: figure.head(f"finger3-1{SUFFIX[side]}") for side in SIDES}
        toes = {side: figure.head(f"toe2-1{SUFFIX[side]}") for side in SIDES}
        tips = {side: figure.tail(f"toe2-3{SUFFIX[side]}") for side in SIDES}
        across, palms = {}, {}
        for side, sign in (("left", 1), ("right", -1)):
            index, little = (figure.head(f"finger{n}-1{SUFFIX[side]}") for n in (2, 5))
            hand = rotations.unit_vector(knuckles[side] - heads["wrist" + SUFFIX[side]])
            aside = index - little
            across[side] = rotations.unit_vector(aside - (aside @ hand) * hand)
            palms[side] = sign * np.cross(hand, across[side])
        hips = (heads["upperleg01.L"] + heads["upperleg01.R"]) / 2
        return cls(heads, hips, knuckles, toes, tips, across, palms)


class Posed:
    """Rigid motions of bones: a point x of the rest pose moves to `rotation @ x + shift`."""

    def __init__(self) -> None:
        self.rotation: dict[str, NDArray] = {}
        self.shift: dict[str, NDArray] = {}

    def put(self, bone: str, rotation: NDArray, rest: NDArray, place: NDArray) -> NDArray:
        """Turn a bone, move the point `rest` of the rest pose to `place`; return the rotation."""
        self.rotation[bone] = rotation
        self.shift[bone] = place - rotation @ rest
        return rotation

    def at(self, bone: str, rest: NDArray) -> NDArray:
        """Return the place of a point (3,) of the rest pose that moves with a bone."""
        return self.rotation[bone] @ rest + self.shift[bone]

    def stacked(self) -> tuple[NDArray, NDArray]:
        """Return rotations (B, 3, 3) and shifts (B, 3) in the order of BONES."""
        return (
            np.stack([self.rotation[bone] for bone in BONES]),
            np.stack([self.shift[bone] for bone in BONES]),
        )


def pose(skeleton: Skeleton, stance: Stance) -> Posed:
    """Place all bones: mid-hip at the stance's pelvis, limbs in the stance's directions."""
    posed = Posed()
    posed.put("root", stance.world_from_pelvis, skeleton.hips, stance.pelvis)
    _chain(posed, skeleton, "root", SPINE, stance.world_from_thorax, SPINE_SHARES)
    _chain(posed, skeleton, SPINE[-1], NECK, stance.world_from_head, NECK_SHARES)
    for side in SIDES:
        ways = {
            part: rotations.unit_vector(
                np.asarray(stance.directions[f"{side}_{part}"], dtype=float)
            )
            for part in ("upper_arm", "forearm", "hand", "thigh", "shank", "foot")
        }
        limb = _Limb(posed, skeleton, SUFFIX[side])
        _arm(limb, ways, _hold(limb, stance, side), side)
        _leg(limb, ways, skeleton.toes[side])
        _toes(limb, skeleton.toes[side], skeleton.tips[side])
    return posed


def _chain(
    posed: Posed,
    skeleton: Skeleton,
    below: str,
    bones: Sequence[str],
    end: NDArray,
    shares: Sequence[float],
) -> None:
    turned = rotations.shares(posed.rotation[below], end, shares)
    for bone, rotation in zip(bones, turned, strict=True):
        head = skeleton.heads[bone]
        posed.put(bone, rotation, head, posed.at(below, head))
        below = bone


@dataclass(frozen=True, eq=False)
class _Limb:
    posed: Posed
    skeleton: Skeleton
    suffix: str

    def rest(self, bone: str) -> NDArray:
        return self.skeleton.heads[bone + self.suffix]

    def turned(self, bone: str) -> NDArray:
        return self.posed.rotation[bone + self.suffix]

    def at(self, bone: str, rest: NDArray) -> NDArray:
        return self.posed.at(bone + self.suffix, rest)

    def put(self, bone: str, rotation: NDArray, rest: NDArray, place: NDArray) -> None:
        self.posed.put(bone + self.suffix, rotation, rest, place)

    def pair(
        self,
        first: str,
        second: str,
        rotation: NDArray,
        place: NDArray,
        twists: Sequence[float],
        way: NDArray,
    ) -> None:
        """Place the two parts of a limb's bone, twisted about the line through its joints."""
        rest = self.rest(first)
        for bone, twist in zip((first, second), twists, strict=True):
            self.put(bone, rotations.about_axis(way, twist) @ rotation, rest, place)


def _arm(
    limb: _Limb, ways: dict[str, NDArray], hold: tuple[NDArray, NDArray] | None, side: str
) -> None:
    thorax, upper, fore = limb.posed.rotation[SPINE[-1]], ways["upper_arm"], ways["forearm"]
    shoulder, elbow, wrist = (limb.rest(bone) for bone in ("upperarm01", "lowerarm01", "wrist"))
    rest = [
        rotations.unit_vector(end - start) for start, end in ((shoulder, elbow), (elbow, wrist))
    ]
    girdle = thorax @ _girdle(thorax.T @ upper, 1 if side == "left" else -1)
    limb.put(
        "clavicle", girdle, limb.rest("clavicle"), limb.posed.at(SPINE[-1], limb.rest("clavicle"))
    )

    rotation = rotations.swing(girdle @ rest[0], upper) @ girdle
    hinge = rotations.cross3(rest[0], rest[1])
    turn = _towards(upper, rotation @ hinge, rotations.cross3(upper, fore), hinge_is_line=True)
    place = limb.at("clavicle", shoulder)
    limb.pair("upperarm01", "upperarm02", rotation, place, (FIRST_HALF * turn, turn), upper)

    above = limb.turned("upperarm02")
    rotation = rotations.swing(above @ rest[1], fore) @ above
    hand = _hand(limb, rotation, ways["hand"], hold, side)
    turn = rotations.twist(hand @ rotation.T, fore)
    place = limb.at("upperarm02", elbow)
    limb.pair("lowerarm01", "lowerarm02", rotation, place, [s * turn for s in FOREARM_TWIST], fore)
    limb.put("wrist", hand, wrist, limb.at("lowerarm02", wrist))


def _girdle(upper: NDArray, sign: int) -> NDArray:
    """Return the clavicle's rotation (3, 3) in the thorax for the upper arm's direction there."""
    lift = sign * LIFT * (upper[1] + 0.7)  # at rest the arm points 45 degrees down
    reach = -sign * REACH * upper[2]
    return rotations.about_axis(np.array([0.0, 1, 0]), reach) @ rotations.about_axis(
        np.array([0.0, 0, 1]), lift
    )


def _hold(limb: _Limb, stance: Stance, side: str) -> tuple[NDArray, NDArray] | None:
    """Return a vector of the hand at rest and its wanted direction in the world, or None."""
    if stance.racket is not None and stance.racket_hand == side:
        return limb.skeleton.across[side], np.asarray(stance.racket, dtype=float)
    if stance.palms and stance.palms.get(side) is not None:
        return limb.skeleton.palms[side], np.asarray(stance.palms[side], dtype=float)
    return None


def _hand(
    limb: _Limb, forearm: NDArray, way: NDArray, hold: tuple[NDArray, NDArray] | None, side: str
) -> NDArray:
    rest = rotations.unit_vector(limb.skeleton.knuckles[side] - limb.rest("wrist"))
    rotation = rotations.swing(forearm @ rest, way) @ forearm
    if hold is None:
        return rotation
    turn = _towards(way, rotation @ hold[0], hold[1], hinge_is_line=False)
    return rotations.about_axis(way, turn) @ rotation


def _leg(limb: _Limb, ways: dict[str, NDArray], toe: NDArray) -> None:
    thigh, shank, foot = ways["thigh"], ways["shank"], ways["foot"]
    hip, knee, ankle = (limb.rest(bone) for bone in ("upperleg01", "lowerleg01", "foot"))
    pelvis, left = limb.posed.rotation["root"], np.array([1.0, 0, 0])
    rotation = rotations.swing(pelvis @ rotations.unit_vector(knee - hip), thigh) @ pelvis
    # The knee's axis points to the left: it follows from the bend or, for a straight knee, from the
    # foot.
    hinge = rotations.cross3(thigh, shank) + 0.5 * rotations.cross3(foot, shank)
    turn = _towards(thigh, rotation @ left, hinge, hinge_is_line=False)
    place = limb.posed.at("root", hip)
    limb.pair("upperleg01", "upperleg02", rotation, place, (FIRST_HALF * turn, turn), thigh)

    above = limb.turned("upperleg02")
    rotation = rotations.swing(above @ rotations.unit_vector(ankle - knee), shank) @ above
    place = limb.at("upperleg02", knee)
    limb.pair("lowerleg01", "lowerleg02", rotation, place, (0.0, 0.0), shank)

    place = limb.at("lowerleg02", ankle)
    rotation = rotations.swing(rotation @ rotations.unit_vector(toe - ankle), foot) @ rotation
    # A foot on the floor lies flat, however the shank leans.
    flat = rotations.cross3(np.array([0.0, 0, 1]), foot)
    level = _smooth(-shank[2], *STANDING)
    sideways = level * flat + (1 - level) * rotations.cross3(foot, shank)
    turn = _towards(foot, rotation @ left, sideways, hinge_is_line=False)
    limb.put("foot", rotations.about_axis(foot, turn) @ rotation, ankle, place)


def _toes(limb: _Limb, joint: NDArray, tip: NDArray) -> None:
    """Bend the toes up if they would go below the floor (z = 0), as when the heel rises."""
    rotation, place = limb.turned("foot"), limb.at("foot", joint)
    length = np.sqrt((tip - joint) @ (tip - joint))
    now = (rotation @ (tip - joint))[2] / length
    least = np.clip((tip[1] - place[2]) / length, -1, 1)
    rise = np.clip(np.arcsin(least) - np.arcsin(now), 0, MOST_TOES)
    limb.put(TOES, rotation @ rotations.about_axis(np.array([-1.0, 0, 0]), rise), joint, place)


def _towards(axis: NDArray, start: NDArray, end: NDArray, *, hinge_is_line: bool) -> float:
    """Return the twist about an axis from `start` to `end`, less where `end` is near the axis."""
    angle = rotations.angle_about(axis, start, end)
    if hinge_is_line and abs(angle) > np.pi / 2:
        angle = np.sign(angle) * (np.pi - abs(angle))
    sideways = end - (end @ axis) * axis
    hold = _smooth(np.sqrt(sideways @ sideways), *BENT)
    return hold * float(np.clip(angle, -MOST_TWIST, MOST_TWIST))


def _smooth(value: float, low: float, high: float) -> float:
    share = min(1.0, max(0.0, (value - low) / (high - low)))
    return share * share * (3 - 2 * share)


FINGERS = (2, 3, 4, 5)
# ASSUME: angles and offsets that close the modelled hand round a racket's grip, chosen by eye.
LOOSE, CLOSED = np.radians([12, 18, 10]), np.radians([62, 78, 45])  # at the three joints
THUMB_LOOSE, THUMB_CLOSED = np.radians([5, 8, 8]), np.radians([28, 25, 35])
# Of the grip's axis from the knuckles: out of the palm, to the wrist.
GRIP_OUT_M, GRIP_BACK_M = 0.024, 0.012


def bent(figure: Figure, skeleton: Skeleton, side: str, *, closed: bool) -> Figure:
    """Return the figure with the fingers of one hand bent: closed round a grip, or loose."""
    suffix, palm = SUFFIX[side], skeleton.palms[side]
    hand = rotations.unit_vector(skeleton.knuckles[side] - skeleton.heads["wrist" + suffix])
    turns = {}
    for finger in FINGERS:
        root, tip = (
            figure.head(f"finger{finger}-1{suffix}"),
            figure.tail(f"finger{finger}-3{suffix}"),
        )
        axis = rotations.unit_vector(np.cross(rotations.unit_vector(tip - root), palm))
        for joint, angle in enumerate(CLOSED if closed else LOOSE, start=1):
            turns[f"finger{finger}-{joint}{suffix}"] = rotations.about_axis(axis, angle)
    root, tip = figure.head(f"finger1-1{suffix}"), figure.tail(f"finger1-3{suffix}")
    # The thumb closes over the palm, towards the fingers' tips.
    goal = 0.6 * palm + 0.5 * hand - 0.5 * skeleton.across[side] if closed else palm
    axis = rotations.unit_vector(np.cross(rotations.unit_vector(tip - root), goal))
    for joint, angle in enumerate(THUMB_CLOSED if closed else THUMB_LOOSE, start=1):
        turns[f"finger1-{joint}{suffix}"] = rotations.about_axis(axis, angle)
    return figure.bent(turns)


def grip(figure: Figure, skeleton: Skeleton, side: str) -> NDArray:
    """Return where the axis of a racket's grip crosses the hand of a bare body, (3,) m."""
    suffix = SUFFIX[side]
    knuckles = np.mean([figure.head(f"finger{n}-1{suffix}") for n in FINGERS], axis=0)
    hand = rotations.unit_vector(skeleton.knuckles[side] - skeleton.heads["wrist" + suffix])
    return knuckles + GRIP_OUT_M * skeleton.palms[side] - GRIP_BACK_M * hand
