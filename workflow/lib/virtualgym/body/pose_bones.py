"""Poses of the body's bones, hands included."""

from dataclasses import dataclass

import numpy as np

from courtside.geometry import rotations
from virtualgym.body.stance import SIDES

SPINE = ("spine05", "spine04", "spine03", "spine02", "spine01")
SPINE_SHARES = (0.1, 0.35, 0.65, 0.9, 1.0)  # of the turn from pelvis to thorax
NECK = ("neck01", "neck02", "neck03", "head")
NECK_SHARES = (0.25, 0.5, 0.75, 1.0)
TOES = "toe2-1"  # stands for all of a foot
ARM = ("clavicle", "upperarm01", "upperarm02", "lowerarm01", "lowerarm02", "wrist")
LEG = ("upperleg01", "upperleg02", "lowerleg01", "lowerleg02", "foot", TOES)
SUFFIX = {"left": ".L", "right": ".R"}
BONES = ("root", *SPINE, *NECK, *(b + SUFFIX[side] for side in SIDES for b in ARM + LEG))
# The shoulder girdle takes part in the arm's elevation: the clavicle by some 30 degrees of 180 [Inman 1944].
LIFT, REACH = 0.3, 0.12  # radians of the clavicle per unit that the upper arm points up, forward
FIRST_HALF = 0.5  # of a twist of upper arm or thigh
FOREARM_TWIST = 0.2, 0.65  # of the hand's twist, in the forearm's two parts
MOST_TWIST, MOST_TOES = np.radians(110), np.radians(75)
BENT = 0.15, 0.5  # sine of a bend below which a hinge has no say, and above which it has all
STANDING = 0.3, 0.8  # how upright a shank is when its foot is in the air, and on the floor


@dataclass(frozen=True, eq=False)
class Skeleton:
    """The joints of a body in its rest pose, body axes, metres.

    Attributes
    ----------
    heads : dict of str to (3,) float
        Where each of BONES begins.
    hips : (3,) float
        Midpoint of the two hip joints.
    knuckles, toes, tips : dict of str to (3,) float
        For each side, the joint of the middle finger, the joint of the toes, the tip of the middle toe.
    across, palms : dict of str to (3,) float
        For each side, unit vectors from little to index finger and out of the palm, orthogonal to the hand.
    """

    heads: dict
    hips: np.ndarray
    knuckles: dict
    toes: dict
    tips: dict
    across: dict
    palms: dict

    @classmethod
    def of(cls, figure):
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
    """Rigid motions of bones: a point x of the rest pose goes to `rotation @ x + shift`."""

    def __init__(self):
        self.rotation, self.shift = {}, {}

    def put(self, bone, rotation, rest, place):
        """Turn a bone, and bring this point of the rest pose to a place; return the rotation."""
        self.rotation[bone] = rotation
        self.shift[bone] = place - rotation @ rest
        return rotation

    def at(self, bone, rest):
        """Return where a bone carries a point (3,) of the rest pose."""
        return self.rotation[bone] @ rest + self.shift[bone]

    def stacked(self):
        """Return rotations (B, 3, 3) and shifts (B, 3) in the order of BONES."""
        return (
            np.stack([self.rotation[bone] for bone in BONES]),
            np.stack([self.shift[bone] for bone in BONES]),
        )


def pose(skeleton, stance):
    """Place all bones.

    Parameters
    ----------
    skeleton : Skeleton
    stance : virtualgym.body.stance.Stance

    Returns
    -------
    posed : Posed
        The midpoint of the hip joints is the stance's pelvis, and each limb's bone points as it says.
    """
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


def _chain(posed, skeleton, below, bones, end, shares):
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

    def rest(self, bone):
        return self.skeleton.heads[bone + self.suffix]

    def turned(self, bone):
        return self.posed.rotation[bone + self.suffix]

    def at(self, bone, rest):
        return self.posed.at(bone + self.suffix, rest)

    def put(self, bone, rotation, rest, place):
        self.posed.put(bone + self.suffix, rotation, rest, place)

    def pair(self, first, second, rotation, place, twists, way):
        """Place the two parts of a limb's bone, twisted about the line through its joints."""
        rest = self.rest(first)
        for bone, twist in zip((first, second), twists, strict=True):
            self.put(bone, rotations.about_axis(way, twist) @ rotation, rest, place)


def _arm(limb, ways, hold, side):
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


def _girdle(upper, sign):
    """Return the clavicle's rotation in the thorax (3, 3) for an upper arm's direction there."""
    lift = sign * LIFT * (upper[1] + 0.7)  # the rest pose points 45 degrees down
    reach = -sign * REACH * upper[2]
    return rotations.about_axis(np.array([0.0, 1, 0]), reach) @ rotations.about_axis(
        np.array([0.0, 0, 1]), lift
    )


def _hold(limb, stance, side):
    """Return the vector of the hand in rest that is to be turned, and whither; or None."""
    if stance.racket is not None and stance.racket_hand == side:
        return limb.skeleton.across[side], np.asarray(stance.racket, dtype=float)
    if stance.palms and stance.palms.get(side) is not None:
        return limb.skeleton.palms[side], np.asarray(stance.palms[side], dtype=float)
    return None


def _hand(limb, forearm, way, hold, side):
    rest = rotations.unit_vector(limb.skeleton.knuckles[side] - limb.rest("wrist"))
    rotation = rotations.swing(forearm @ rest, way) @ forearm
    if hold is None:
        return rotation
    turn = _towards(way, rotation @ hold[0], hold[1], hinge_is_line=False)
    return rotations.about_axis(way, turn) @ rotation


def _leg(limb, ways, toe):
    thigh, shank, foot = ways["thigh"], ways["shank"], ways["foot"]
    hip, knee, ankle = (limb.rest(bone) for bone in ("upperleg01", "lowerleg01", "foot"))
    pelvis, left = limb.posed.rotation["root"], np.array([1.0, 0, 0])
    rotation = rotations.swing(pelvis @ rotations.unit_vector(knee - hip), thigh) @ pelvis
    # The knee's axis points to the left: from its bend and, where it is straight, from the foot.
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
    # A foot on the floor lies flat on it, whichever way the shank leans.
    flat = rotations.cross3(np.array([0.0, 0, 1]), foot)
    level = _smooth(-shank[2], *STANDING)
    sideways = level * flat + (1 - level) * rotations.cross3(foot, shank)
    turn = _towards(foot, rotation @ left, sideways, hinge_is_line=False)
    limb.put("foot", rotations.about_axis(foot, turn) @ rotation, ankle, place)


def _toes(limb, joint, tip):
    """Bend the toes up where they would go into the floor, as when the heel rises; the floor is z = 0."""
    rotation, place = limb.turned("foot"), limb.at("foot", joint)
    length = np.sqrt((tip - joint) @ (tip - joint))
    now = (rotation @ (tip - joint))[2] / length
    least = np.clip((tip[1] - place[2]) / length, -1, 1)
    rise = np.clip(np.arcsin(least) - np.arcsin(now), 0, MOST_TOES)
    limb.put(TOES, rotation @ rotations.about_axis(np.array([-1.0, 0, 0]), rise), joint, place)


def _towards(axis, start, end, *, hinge_is_line):
    """Return the twist that brings one vector towards another, less where the other gives little hold."""
    angle = rotations.angle_about(axis, start, end)
    if hinge_is_line and abs(angle) > np.pi / 2:
        angle = np.sign(angle) * (np.pi - abs(angle))
    sideways = end - (end @ axis) * axis
    hold = _smooth(np.sqrt(sideways @ sideways), *BENT)
    return hold * float(np.clip(angle, -MOST_TWIST, MOST_TWIST))


def _smooth(value, low, high):
    share = min(1.0, max(0.0, (value - low) / (high - low)))
    return share * share * (3 - 2 * share)


FINGERS = (2, 3, 4, 5)
LOOSE, CLOSED = np.radians([12, 18, 10]), np.radians([62, 78, 45])  # at the three joints
THUMB_LOOSE, THUMB_CLOSED = np.radians([5, 8, 8]), np.radians([28, 25, 35])
GRIP_OUT_M, GRIP_BACK_M = (
    0.024,
    0.012,
)  # of the grip's axis from the knuckles: out of the palm, to the wrist


def bent(figure, skeleton, side, *, closed):
    """Bend the fingers of one hand.

    Parameters
    ----------
    figure : virtualgym.body.makehuman.Figure
    skeleton : virtualgym.body.pose_bones.Skeleton
    side : str
    closed : bool

    Returns
    -------
    figure : virtualgym.body.makehuman.Figure
    """
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


def grip(figure, skeleton, side):
    """Return where the axis of a racket's grip passes through the hand at rest, (3,) m.

    Parameters
    ----------
    figure : virtualgym.body.makehuman.Figure
        The bare body.
    skeleton : virtualgym.body.pose_bones.Skeleton
    side : str
        "left" or "right".
    """
    suffix = SUFFIX[side]
    knuckles = np.mean([figure.head(f"finger{n}-1{suffix}") for n in FINGERS], axis=0)
    hand = rotations.unit_vector(skeleton.knuckles[side] - skeleton.heads["wrist" + suffix])
    return knuckles + GRIP_OUT_M * skeleton.palms[side] - GRIP_BACK_M * hand
