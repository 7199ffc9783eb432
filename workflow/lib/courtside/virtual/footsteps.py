"""Feet that stand still while they carry, and step from plant to plant between."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from courtside.virtual import easing, limb_chain

SLAP_S = 0.07  # from the heel's landing until the toes are down
CLEARANCE_M = 0.19  # between the middles of a swinging foot and a standing one


@dataclass(frozen=True)
class Plant:
    """One stand of one foot.

    Attributes
    ----------
    land_s, off_s : float
        The foot carries from landing until its toes leave the floor.
    place : (2,) float
        Of the ankle while the foot is flat, metres.
    yaw : float
        Where the toes point, as a heading, radians.
    """

    land_s: float
    off_s: float
    place: np.ndarray
    yaw: float


@dataclass(frozen=True, eq=False)
class Foot:
    """The way of one foot, from its plants.

    Attributes
    ----------
    plants : tuple of Plant
    roll_s : (n - 1,) float
        How long before each take-off the heel begins to rise.
    aside : (n - 1, 2) float
        Detour of each swing round the standing foot, metres.
    ankle_m, length_m, toe_m : float
        Height of the ankle, length from ankle to the joint of the toes, height of that joint.
    """

    plants: tuple
    roll_s: np.ndarray
    aside: np.ndarray
    ankle_m: float
    length_m: float
    toe_m: float

    def __post_init__(self):
        before, after = self.plants[:-1], self.plants[1:]
        steps = np.array([b.place - a.place for a, b in zip(before, after, strict=True)])
        steps = steps.reshape(-1, 2)
        length = np.linalg.norm(steps, axis=1)
        table = {
            "off": np.array([plant.off_s for plant in before]),
            "land": np.array([plant.land_s for plant in after]),
            "steps": steps,
            "turns": np.array([b.yaw - a.yaw for a, b in zip(before, after, strict=True)]),
            "lift": np.clip(0.04 + 0.08 * length, 0.04, 0.12),
            "heel": np.clip(0.15 + 0.6 * length, 0.15, 0.75),
            "toe": np.clip(0.3 * (length - 0.2), 0.0, 0.3),
        }
        object.__setattr__(self, "_table", table)

    def at(self, time_s):
        """Return the ankle (3,) m, the direction ankle to toes (3,) and the lift m at a time."""
        table = self._table
        first, swing = self.plants[0], table["land"] - table["off"]
        x = (time_s - table["off"]) / swing if len(swing) else swing
        moved = easing.ease(x)
        place = first.place + moved @ table["steps"] + easing.bump(x) @ self.aside
        yaw = first.yaw + moved @ table["turns"]
        lift = float(table["lift"] @ easing.bump(x))
        heel = float(table["heel"] @ self._heel(time_s, x, swing))
        toe = float(table["toe"] @ self._toe(time_s, x, swing))
        forward, flat = np.array([-np.sin(yaw), np.cos(yaw)]), self._flat_slope()
        ball = np.append(place + self.length_m * np.cos(flat) * forward, self.toe_m)
        raised = limb_chain.facing(yaw) @ [0.0, np.sin(flat + heel), -np.cos(flat + heel)]
        ankle = ball + self.length_m * raised + [0.0, 0.0, lift]
        down = flat + heel - toe
        return ankle, np.append(np.cos(down) * forward, -np.sin(down)), lift

    def standing(self):
        """Return the spans (n, 2) s during which the foot is flat and its ankle still."""
        early = [
            *(plant.off_s - roll for plant, roll in zip(self.plants, self.roll_s, strict=False))
        ]
        stops = [*early, self.plants[-1].off_s]
        return np.array([(p.land_s, stop) for p, stop in zip(self.plants, stops, strict=True)])

    def _flat_slope(self):
        """Return by how much a flat foot points down, radians."""
        return np.arcsin((self.ankle_m - self.toe_m) / self.length_m)

    def _heel(self, time_s, x, swing):
        """Return how far the heel is up at each step: it rises round the toes, and falls in the swing."""
        start = self._table["off"] - self.roll_s
        rise = easing.step((time_s - start) / (self.roll_s + 0.25 * swing))
        return rise * (1 - easing.step((x - 0.25) / 0.6))

    def _toe(self, time_s, x, swing):
        """Return how far the toes are up at each step, about the ankle: as the heel lands first."""
        fall = easing.step((time_s - self._table["land"]) / SLAP_S)
        return easing.step((x - 0.5) / 0.45) * (1 - fall)


def walk(plants, proportions, *, rolls):
    """Make both feet from their plants.

    Parameters
    ----------
    plants : dict of str to list of Plant
        For "left" and "right", in order of time.
    proportions : courtside.virtual.stance.Proportions
    rolls : dict of str to list of float
        For each swing, how long before it the heel begins to rise, seconds; cut to what the stand allows.

    Returns
    -------
    feet : dict of str to Foot
    """
    feet = {}
    for side, other in (("left", "right"), ("right", "left")):
        mine = plants[side]
        roll = [
            max(0.02, min(wanted, plant.off_s - plant.land_s - SLAP_S))
            for wanted, plant in zip(rolls[side], mine[:-1], strict=True)
        ]
        aside = [_detour(a, b, plants[other], side) for a, b in pairwise(mine)]
        feet[side] = Foot(
            plants=tuple(mine),
            roll_s=np.array(roll),
            aside=np.array(aside).reshape(-1, 2),
            ankle_m=proportions.ankle_height,
            length_m=proportions.foot,
            toe_m=proportions.toe_height,
        )
    return feet


def _detour(before, after, others, side):
    """Return by how much (2,) m a swing bows to its own side, so as not to pass through the standing leg."""
    middle = (before.off_s + after.land_s) / 2
    standing = min(others, key=lambda plant: abs((plant.land_s + plant.off_s) / 2 - middle))
    way = after.place - before.place
    share = np.clip((standing.place - before.place) @ way / max(way @ way, 1e-9), 0, 1)
    yaw = (before.yaw + after.yaw) / 2
    left = np.array([-np.cos(yaw), -np.sin(yaw)])
    own = left if side == "left" else -left
    gap = (before.place + share * way - standing.place) @ own
    return own * np.clip(CLEARANCE_M - gap, 0.0, 0.25) * easing.bump(np.clip(share, 0.2, 0.8))
