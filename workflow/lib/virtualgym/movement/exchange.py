"""A rally of two players: they hit in turns; who receives does a split step, runs and strikes."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from virtualgym.movement import badminton, upper_body
from virtualgym.movement.badminton import BASE, CORNERS, SWING_S
from virtualgym.movement.footwork import Station
from virtualgym.movement.player import Motion, Player

# ASSUME: times between two hits of a club player's singles, by where the shuttle is played; elite
# players hit more often. Lifts and clears to the rear fly longer than drops and net shots.
FLIGHT_S = {"front": (1.15, 1.45), "mid": (1.2, 1.5), "rear": (1.55, 1.95)}
FIRST_S = (1.0, 1.3)  # when a shuttle is fed to the first player
# ASSUME: a split step pays if it lands between the opponent's hit and the response to it, and the
# response time scatters by 0.06 s and more (Uzu, Shinya & Oda 2009, choice reactions of collegiate
# tennis players); landings before the hit occur, too. Flights of a low hop.
LANDS_S, LANDS_SD_S, LANDS_WITHIN_S = 0.12, 0.06, (-0.05, 0.26)
AIR_S = (0.11, 0.19)
# ASSUME: the first foot leaves the floor this long after the landing; without a split step, which
# players sometimes omit, this long after the hit: about 0.1 s later (Uzu, Shinya & Oda 2009).
STEP_S, STEP_SD_S, STEP_WITHIN_S = 0.2, 0.05, (0.1, 0.32)
BARE_S, BARE_SD_S, BARE_WITHIN_S = 0.42, 0.06, (0.3, 0.6)
OMITTED = 0.12  # share of hits that are answered without a split step
# ASSUME: mean speed of a trip at most; who is late plays the shuttle on the way.
FASTEST_M_S = 2.0
ARRIVES_S = {"net": (0.12, 0.2), "side": (0.12, 0.2), "overhead": (0.3, 0.4)}  # before the hit
CADENCE_HZ = 5.0  # faster than in a drill
REACH = 0.98  # of a leg's length: nearly straight legs in a fast run would snap
SHORT_M = 0.6  # a way back of two steps
READY_S = (0.2, 0.35)  # before the opponent's hit a player is back
STANDS_S = 0.1  # at least, before a hop
HOPS_M = 0.05  # standard deviation of how far a split step goes
POSES = {"net": upper_body.NET_REACH, "side": upper_body.SIDE_REACH}


@dataclass(frozen=True)
class Shot:
    """One hit: whose (0: near, 1: far), when, and in which of `CORNERS` of their own half."""

    player: int
    hit_s: float
    corner: str


def script(rng: np.random.Generator, seconds: float) -> tuple[float, list[Shot]]:
    """Return when the first shuttle is fed, s, and the shots of a rally of at least `seconds`."""
    fed_s = time_s = rng.uniform(*FIRST_S)
    shots: list[Shot] = []
    while len(shots) < 2 or shots[-2].hit_s < seconds:
        before = shots[-2].corner if len(shots) > 1 else ""
        corner = str(rng.choice([name for name in CORNERS if name != before]))
        time_s += rng.uniform(*FLIGHT_S[corner.split("_")[0]])
        shots.append(Shot(len(shots) % 2, float(time_s), corner))
    return float(fed_s), shots


def perform(player: Player, fed_s: float, shots: Sequence[Shot]) -> Motion:
    """Return the part of one player, on the half of `player`, in a rally of `script`.

    Events: hit_1, hit_1_start, hit_1_stop, hit_2 ... as of drills; split_1_start (the last foot
    leaves the floor), split_1_stop (the first foot lands), first_step_1 (a foot leaves after that)
    of the answer to the first hit of the opponent, or to the shuttle that is fed, and so on;
    an answer without a split step has first_step alone.
    """
    own, part = ("near", "far").index(player.half), _Part(player)
    hits_s = [fed_s, *(shot.hit_s for shot in shots)]
    for at, shot in enumerate(shots):
        if shot.player == own:
            next_s = hits_s[at + 2] if at + 2 < len(hits_s) else shot.hit_s + FLIGHT_S["rear"][0]
            part.answer(hits_s[at], shot, next_s)
    return part.finish(hops=tuple(part.hops), reach=REACH)


class _Part(badminton.Drill):
    """A player's part in a rally, answer by answer; at first the player waits at the base."""

    cadence_hz = CADENCE_HZ

    def __init__(self, player: Player) -> None:
        super().__init__(player)
        self.hops: list[tuple[float, float]] = []
        self.n_answers = 0

    def answer(self, hit_s: float, shot: Shot, next_s: float) -> None:
        """Answer the opponent's hit by a shot, and be back before the next hit."""
        self.n_answers += 1
        if self.rng.uniform() < OMITTED:
            self._leave(hit_s + self._drawn(BARE_S, BARE_SD_S, BARE_WITHIN_S), lead_s=0.05)
        else:
            self._split(hit_s + self._drawn(LANDS_S, LANDS_SD_S, LANDS_WITHIN_S))
        self.events[f"first_step_{self.n_answers}"] = self.time_s
        self._play(shot)
        self._come_back(next_s - self.rng.uniform(*READY_S))

    def _drawn(self, mean: float, spread: float, within: tuple[float, float]) -> float:
        return float(np.clip(self.rng.normal(mean, spread), *within))

    def _leave(self, time_s: float, lead_s: float) -> None:
        """Leave the last station at a time, crouched `lead_s` before that."""
        self.stations[-1] = replace(self.stations[-1], leave_s=time_s)
        self.keys[-1] = (time_s - lead_s, badminton.low(self.rng))

    def _split(self, land_s: float) -> None:
        """Hop so that the first foot lands at a time, or later: the feet must stand before."""
        air_s = self.rng.uniform(*AIR_S)
        earliest = max(self.stations[-1].arrive_s + STANDS_S, self.keys[-2][0] + 0.1)
        off_s = max(land_s - air_s, earliest)
        land_s = off_s + air_s
        self._leave(off_s, lead_s=0.04)
        step_s = land_s + self._drawn(STEP_S, STEP_SD_S, STEP_WITHIN_S)
        place = self.stations[-1].place + self.rng.normal(0, HOPS_M, 2)
        heading = self.rng.normal(0, 0.05)
        self.stations.append(Station(land_s, step_s, place, heading, settle_s=0.06, hop=True))
        self.keys += [(land_s, upper_body.READY), (step_s - 0.02, badminton.low(self.rng))]
        self.hops.append((off_s, land_s))
        self.events[f"split_{self.n_answers}_start"] = off_s
        self.events[f"split_{self.n_answers}_stop"] = land_s

    def _play(self, shot: Shot) -> None:
        """Run to the shuttle, as far as there is time, and play it when the script says."""
        corner, start = CORNERS[shot.corner], self.time_s
        heading = np.radians(corner.heading_deg + self.rng.normal(0, 4))
        arrive = shot.hit_s - self.rng.uniform(*ARRIVES_S[corner.stroke])
        place, _ = self._within(self._at(corner.place), arrive - start)
        self.keys.append((start + 0.35 * (arrive - start), upper_body.RUN))
        if corner.stroke == "overhead":
            swing = self.rng.uniform(*SWING_S)
            self._strike(arrive, shot.hit_s, place, heading, swing)
        else:
            self._reach(arrive, shot.hit_s, place, heading, POSES[corner.stroke])

    def _within(self, place: np.ndarray, lasts_s: float) -> tuple[np.ndarray, float]:
        """Return a place on the way that is reached in a time, and the length of the way, m."""
        start = self.stations[-1].place
        way_m = float(np.linalg.norm(place - start))
        share = min(1.0, FASTEST_M_S * lasts_s / max(way_m, 1e-9))
        return start + share * (place - start), share * way_m

    def _come_back(self, latest_s: float) -> None:
        """Run towards the base and be ready by a time."""
        start = self.time_s
        place, way_m = self._within(self._at(BASE, 0.08), latest_s - start)
        usual_s = max(badminton.LEAST_S, way_m / self.rng.uniform(*badminton.SPEED_M_S))
        arrive = min(latest_s, start + usual_s)
        fewest = 2 if way_m < SHORT_M else 3
        steps = max(fewest, round((arrive - start) * self.cadence_hz))
        lead = "right" if steps % 2 else "left"
        heading = self.rng.normal(0, 0.05)
        self.stations.append(Station(arrive, arrive + 0.3, place, heading, lead=lead, steps=steps))
        run = max(start + 0.5 * (arrive - start), self.keys[-1][0] + 0.2)
        self.keys += [
            (run, upper_body.RUN),
            (max(arrive, run + 0.1), upper_body.READY),
            (max(arrive, run + 0.1) + 0.1, badminton.low(self.rng)),
        ]
