"""Link candidate places to persons over time, and assign each frame of each row to a person."""

import numpy as np
from numpy.typing import NDArray

from courtside.geometry import camera as camera_models
from courtside.geometry import interpolation
from courtside.geometry.camera import Camera
from courtside.reconstruction.association.appearance import Looks
from courtside.reconstruction.association.candidates import Candidates
from courtside.reconstruction.association.rows import Rows

# ASSUME: this block has no source but the development takes (CONTRIBUTING.md). Costs are negative
# log-likelihoods.
HISTORIES = 60  # kept after each instant
# Further ones kept of each instant of birth within this time: at first, a new person costs more
# than many variants of all others together.
NEWBORN, NEWBORN_S = 5, 0.5
HOPELESS = 20.0  # histories that cost this much more than the best are dropped
PLACE_M = 0.07  # standard deviation of a body about its prediction one instant later
ACCELERATION_MS2 = 6.0  # of a player, for predictions over gaps
RUN_MS = 2.0  # standard deviation of the velocity of who may run, seen at one instant only
LARGEST_M = 4.0  # limit of the prediction's standard deviation, for persons lost for long
WARM_S = 5.0  # at first, backwards: births take instants, and of many people one after another
AGAIN_S = 0.1  # between the repeated instants of a short take, as usual between instants
COAST_S = 0.3  # a lost person is expected to keep the velocity for this long
BIRTH = 20.0  # cost of a new person: more than that of finding a lost one again
SHORT = 2.0  # and at most this much an instant, or takes of half a second would have no people
# Cost of an instant without a candidate, for a person seen within this time.
MISSED, MISSED_S = 2.0, 1.0
SHARED = 0.7  # cost of a row that shows somebody else, who may hide this person
EXCHANGE = 10.0  # cost of an uncut piece that changes its owner
NET_CROSSED = 3.0  # cost of a player who changes the half of the court
ONE_VIEW = 0.9  # rays with a larger cosine between them count as one view
GAIN = 0.5  # of the velocity's update
# Candidates considered in one instant: at least so many, or so many for each person followed.
MOST, MOST_EACH = 16, 4
REMEMBERED = 30  # instants: a person's colours are the mean of about so many


class _Histories:
    """H histories of S persons each; arrays lead with H."""

    def __init__(self, slots: int, n_cameras: int, n_colours: int) -> None:
        self.cost = np.zeros(1)
        self.alive = np.zeros((1, slots), bool)
        self.born_s = np.full(1, -np.inf)  # of the last birth
        self.place = np.zeros((1, slots, 3))
        self.velocity = np.zeros((1, slots, 3))
        self.time_s = np.zeros((1, slots))  # of the last candidate
        self.placed_s = np.zeros((1, slots))  # of the last place
        self.ray = np.zeros((1, slots, 3))  # direction of the rays since then
        self.owned = np.full((1, slots, n_cameras), -1)
        self.worn = np.full((1, slots, n_colours), np.nan)
        self.looked = np.zeros((1, slots))  # instants that the colours are the mean of

    def keep(self, parent: NDArray) -> None:
        """Reorder to the given parents."""
        for name, value in vars(self).items():
            setattr(self, name, value[parent])


def link(
    candidates: Candidates,
    piece: NDArray,
    time_s: NDArray,
    slots: int,
    net_y_m: float | None = None,
    looks: Looks | None = None,
) -> NDArray:
    """Link candidates over time: the index (S, N) of each person's candidate, -1 for none.

    `piece` (M, C) is the uncut piece of each candidate's row in each camera, -1 without one;
    `time_s` (N,) is of the instants; `slots` the largest number S of persons followed. With
    `net_y_m`, the position of a net, crossing it has a cost. With `looks`, people are re-identified
    by the colours of their clothes.

    A multiple-hypothesis tracker (Reid 1979): at each instant candidates are assigned to persons,
    and the best histories are kept. A history costs its candidates, their distance from a
    constant-velocity prediction, and a price for each uncut tracklet piece that changes its owner,
    so that a view without a crossing carries identities through a crossing in another view. While
    only one view sees a person, its rays continue the history; the position along a ray is free. If
    two people are behind one another, both may use the one visible row; its cost counts once. It
    starts some seconds after the first instant and goes back to it: who is there at the first
    instant is known then.
    """
    colours = looks.middle(candidates) if looks else np.zeros((len(piece), 0))
    state = _Histories(slots, piece.shape[1], colours.shape[1])
    birth = min(BIRTH, SHORT * len(time_s))
    first = np.searchsorted(candidates.instant, np.arange(len(time_s) + 1))
    most = max(MOST, MOST_EACH * slots)
    warm, before_s = _warm_up(time_s, slots)
    order = np.concatenate([warm, np.arange(len(time_s))])
    running_s = np.concatenate([before_s, time_s])
    parents, choices = [], []
    for at, now_s in zip(order, running_s, strict=True):
        here = _best(candidates, np.arange(first[at], first[at + 1]), most)
        if len(here):
            offered, seen = candidates.subset(here), colours[here]
            own = _own_cost(state, offered, now_s, birth, net_y_m)
            own = own + _looks_cost(state, seen, looks)
            parent, choice = _advance(state, own, offered, piece[here], seen, now_s)
        else:
            parent = np.arange(len(state.cost))
            choice = np.full((len(parent), slots), -1)
        parents.append(parent)
        choices.append(np.where(choice >= 0, here[choice] if len(here) else -1, -1))
        if len(parents) == len(warm) + 1:  # the first instant: from here on time runs forwards
            state.velocity = -state.velocity
    return _trace(state, parents, choices, slots)[:, len(warm) :]


def _warm_up(time_s: NDArray, slots: int) -> tuple[NDArray, NDArray]:
    """Return the instants before the first forward one, backwards, and their running times.

    Each instant has one birth at most. If a take has no more instants than slots, the last one is
    repeated, so that all are born before the first forward instant.
    """
    warm = np.flatnonzero(time_s < time_s[0] + WARM_S)[::-1]
    running_s = 2 * time_s[0] - time_s[warm]
    again = np.arange(max(slots + 1 - len(warm), 0), 0, -1)
    warm = np.concatenate([np.full(len(again), warm[0]), warm])
    running_s = np.concatenate([running_s[0] - AGAIN_S * again, running_s])
    return warm[:-1], running_s[:-1]


def _best(candidates: Candidates, here: NDArray, most: int) -> NDArray:
    """Return those of the candidates of an instant that are considered."""
    total = candidates.view_cost[here].sum(axis=1) + 99 * candidates.is_ray[here]
    return np.sort(here[np.argsort(total, kind="stable")[:most]])


def _advance(state, own, offered, piece, colours, now_s) -> tuple[NDArray, NDArray]:
    """Add one instant to the histories; return their parents and choices."""
    parent, choice, cost = _assign(state, own, offered, now_s)
    state.keep(parent)
    pieces = np.where((choice >= 0)[..., None], piece[choice], -1)
    shared = _shared(pieces)
    state.cost = cost + EXCHANGE * _exchanged(state.owned, pieces, shared)
    order = np.argsort(state.cost, kind="stable")
    state.keep(order)
    parent, choice = parent[order], choice[order]
    _move(state, choice, offered, now_s)
    _own(state, pieces[order], shared[order])
    _remember(state, np.where(shared[order].any(axis=2), -1, choice), colours)
    different = _different(state, choice, now_s)
    state.keep(different)
    state.cost = state.cost - state.cost.min()
    return parent[different], choice[different]


def _shared(pieces: NDArray) -> NDArray:
    """Return (H, S, C) bool: another person of the same history uses the same piece."""
    same = (pieces[:, :, None] == pieces[:, None]) & (pieces[:, :, None] >= 0)
    return same.sum(axis=2) > 1


def _exchanged(owned: NDArray, pieces: NDArray, shared: NDArray) -> NDArray:
    """Return (H,) the number of pieces that change from one person to another."""
    owner = (owned[:, :, None] == pieces[:, None]) & (pieces[:, None] >= 0)
    other = owner & ~np.eye(pieces.shape[1], dtype=bool)[:, :, None]
    return (other.any(axis=1) & ~shared).sum(axis=(1, 2))


def _own_cost(state, offered, now_s, birth, net_y_m) -> NDArray:
    """Return (H, S, n) costs of giving each candidate to each person."""
    move = _move_cost(state, offered, now_s)
    young = state.alive & ~state.velocity.any(axis=2)
    if young.any():  # who stands or walks costs no more, though others may run
        ran = _move_cost(state, offered, now_s, RUN_MS)
        move = np.where(young[..., None], np.minimum(move, ran), move)
    if net_y_m is not None:
        sides = (state.place[..., 1:2] > net_y_m) != (offered.xyz[:, 1] > net_y_m)
        move = move + NET_CROSSED * (sides & ~offered.is_ray)
    # A person is born only after all before: otherwise the same history comes in many orders.
    unborn = ~state.alive
    unborn[:, 1:] &= state.alive[:, :-1]
    born = np.where(unborn[..., None] & ~offered.is_ray, birth, np.inf)
    return np.where(state.alive[..., None], move, born) + offered.view_cost.sum(axis=1)


def _move_cost(
    state: _Histories, offered: Candidates, now_s: float, unknown_ms: float = 0.0
) -> NDArray:
    """Return (H, S, n) negative log-likelihoods of candidates about the predicted places.

    A person recently seen by only one view is less certain along its ray than across. `unknown_ms`
    is the standard deviation of the velocities.
    """
    gone_s = np.maximum(now_s - state.time_s, 0.0)[..., None]
    ahead = state.place + state.velocity * np.minimum(gone_s, COAST_S)
    off, sigma_m = _offset(ahead[:, :, None], offered.xyz, offered.direction, offered.sigma_m)
    along = (off * state.ray[:, :, None]).sum(axis=-1) ** 2
    across = np.maximum((off**2).sum(axis=-1) - along, 0.0)
    unknown_m = unknown_ms * np.minimum(gone_s, COAST_S)
    spread_m = _spread_m(gone_s) + unknown_m
    variance = spread_m**2 + sigma_m**2
    blind_m = _spread_m(np.maximum(now_s - state.placed_s, 0.0)[..., None]) + unknown_m
    blind = blind_m**2 + sigma_m**2
    blind = np.where(np.any(state.ray, axis=-1)[..., None], blind, variance)
    cosine = (state.ray @ offered.direction.T) ** 2
    # Of a place by two views, mostly one direction is uncertain. Not so with more cameras, where
    # places by two views must cost more than those by all. A ray does not measure along itself.
    loose = ~offered.is_ray & (offered.row.shape[1] == 2)
    sure = np.where(loose, spread_m**2, variance)
    volume = 2 * np.log(sure / PLACE_M**2) + np.log(blind / PLACE_M**2)
    unmeasured = cosine * np.log(blind / PLACE_M**2) + (1 - cosine) * np.log(variance / PLACE_M**2)
    volume = volume - np.where(offered.is_ray, unmeasured, 0.0)
    return 0.5 * (across / variance + along / blind + volume)


def _offset(ahead, xyz, direction, sigma_m) -> tuple[NDArray, NDArray]:
    """Return shortest vectors (..., 3) from predictions to places or rays, and the sigmas there."""
    off = xyz - ahead
    back = (off * direction).sum(axis=-1)
    off = off - back[..., None] * direction
    return off, np.where(direction.any(axis=-1), np.abs(back), 1.0) * sigma_m


def _spread_m(gone_s: NDArray) -> NDArray:
    return np.minimum(PLACE_M + 0.5 * ACCELERATION_MS2 * gone_s**2, LARGEST_M)


def _assign(state, own, offered, now_s) -> tuple[NDArray, NDArray, NDArray]:
    """Return parents (H',), choices (H', S) and costs (H',) of the best assignments."""
    count, slots, n = own.shape
    parent, cost, born_s = np.arange(count), state.cost, state.born_s
    choice = np.full((count, slots), -1)
    taken_rows = np.zeros((count, n, offered.row.shape[1]), bool)
    same = (offered.row[:, None] == offered.row[None]) & (offered.row[:, None] >= 0)
    views = (offered.row >= 0).sum(axis=1)
    missed = MISSED * (state.alive & (now_s - state.time_s < MISSED_S))
    for slot in range(slots):
        # A row that already shows somebody else is no evidence for this person, who may be hidden.
        lost = np.where(taken_rows, SHARED - offered.view_cost, 0.0).sum(axis=2)
        lost = np.where(taken_rows.sum(axis=2) < views, lost, np.inf)
        every = np.concatenate([missed[parent, slot, None], own[parent, slot] + lost], axis=1)
        every += cost[:, None]
        near = np.flatnonzero(every <= every.min() + HOPELESS)
        best = near[np.argsort(every.flat[near], kind="stable")]
        source, taken = np.divmod(best, n + 1)
        fresh = (taken > 0) & ~state.alive[parent[source], slot]
        born_s = np.where(fresh, now_s, born_s[source])
        kept = _kept(born_s, now_s, 3 * HISTORIES)
        best, source, taken, born_s = best[kept], source[kept], taken[kept], born_s[kept]
        parent, cost, choice = parent[source], every.flat[best], choice[source]
        choice[:, slot] = taken - 1
        taken_rows = taken_rows[source] | np.where(
            (taken > 0)[:, None, None], same[taken - 1], False
        )
    return parent, choice, cost


def _move(state: _Histories, choice: NDArray, offered: Candidates, now_s: float) -> None:
    history, slot = np.nonzero(choice >= 0)
    taken = choice[history, slot]
    born = ~state.alive[history, slot][:, None]
    gone_s = np.maximum(now_s - state.time_s[history, slot], 1e-6)[:, None]
    old, direction = state.velocity[history, slot], offered.direction[taken]
    ahead = state.place[history, slot] + old * np.minimum(gone_s, COAST_S)
    off, sigma_m = _offset(ahead, offered.xyz[taken], direction, offered.sigma_m[taken])
    spread = 2 * _spread_m(gone_s)
    new = ahead + np.where(born, 1.0, spread**2 / (spread**2 + sigma_m[:, None] ** 2)) * off
    speed = (new - state.place[history, slot]) / gone_s
    gain = np.where(old.any(axis=1, keepdims=True), GAIN, 1.0)
    velocity = np.where(gone_s > COAST_S, 0.5 * speed, old + gain * (speed - old))
    state.velocity[history, slot] = np.where(born, 0.0, velocity)
    state.place[history, slot], state.time_s[history, slot] = new, now_s
    state.born_s[history[born[:, 0]]] = now_s
    state.alive[history, slot] = True
    # Rays of one view leave the place along them open; a second view closes it.
    before, ray = state.ray[history, slot], direction.any(axis=1)
    open_ = ray & (~before.any(axis=1) | (np.abs((before * direction).sum(axis=1)) > ONE_VIEW))
    state.placed_s[history, slot] = np.where(open_, state.placed_s[history, slot], now_s)
    state.ray[history, slot] = direction


def _own(state: _Histories, pieces: NDArray, shared: NDArray) -> None:
    """Make persons the owners of the pieces that only they use."""
    gained = (pieces >= 0) & ~shared
    lost = (state.owned[:, :, None] == np.where(gained, pieces, -2)[:, None]).any(axis=2)
    state.owned = np.where(gained, pieces, np.where(lost, -1, state.owned))


def _looks_cost(state: _Histories, colours: NDArray, looks: Looks | None) -> NDArray | float:
    """Return (H, S, n) costs of the colours (n, K) of candidates, by those that persons wear."""
    if looks is None:
        return 0.0
    few = 1 / np.maximum(state.looked, 1)[..., None]
    return looks.cost(colours - state.worn[:, :, None], few)


def _remember(state: _Histories, choice: NDArray, colours: NDArray) -> None:
    """Add the colours (n, K) of the chosen candidates (H, S), -1 for none, to what persons wear."""
    seen = np.where((choice >= 0)[..., None], colours[choice], np.nan)
    known = np.all(np.isfinite(seen), axis=2)
    state.looked = np.where(known, np.minimum(state.looked + 1, REMEMBERED), state.looked)
    share = 1 / np.maximum(state.looked, 1)[..., np.newaxis]
    new = np.where(np.isfinite(state.worn), state.worn + share * (seen - state.worn), seen)
    state.worn = np.where(np.expand_dims(known, 2), new, state.worn)


def _different(state: _Histories, choice: NDArray, now_s: float) -> NDArray:
    """Return the best histories; of those with the same present state only the best one."""
    first: dict[bytes, int] = {}
    for at in range(len(choice)):  # the cheapest comes first
        key = choice[at].tobytes() + state.owned[at].tobytes() + state.time_s[at].tobytes()
        first.setdefault(key, at)
    different = np.array(list(first.values()))
    return different[_kept(state.born_s[different], now_s, HISTORIES)]


def _kept(born_s: NDArray, now_s: float, most: int) -> NDArray:
    """Return the histories kept, of those of the last births (H,), s, the cheapest first."""
    kept = np.arange(len(born_s)) < most
    for birth_s in np.unique(born_s[now_s - born_s < NEWBORN_S]):
        kept[np.flatnonzero(born_s == birth_s)[:NEWBORN]] = True
    return np.flatnonzero(kept)


def _trace(state, parents, choices, slots) -> NDArray:
    chosen = np.full((slots, len(parents)), -1)
    at = int(np.argmin(state.cost))
    for instant in range(len(parents) - 1, -1, -1):
        chosen[:, instant] = choices[instant][at]
        at = parents[instant][at]
    return chosen


# ASSUME: this block has no source but the development takes (CONTRIBUTING.md).
NOBODY = 6.0  # cost of a frame that belongs to none of the persons
FAR = 14.0  # limit of a frame's cost
CHANGE = 15.0  # cost of a change of owner within an uncut piece
CHANGE_AT_CUT = 0.7
DRIFT_MS2 = 3.0  # growth of a path's standard deviation with the square of the time to an instant
BELIEVED_S = 0.4  # beyond this time from an instant a path is unknown


def along(time_s: NDArray, at_s: NDArray, xyz: NDArray) -> tuple[NDArray, NDArray]:
    """Return a person's path at all frames, and its standard deviation.

    At least one increasing instant `at_s` (N,) has a place `xyz` (N, 3), metres. The path (T, 3) is
    linear between instants, constant before the first and after the last; the standard deviation
    (T,) is 0 at an instant, inf where too far from any.
    """
    path = np.stack([np.interp(time_s, at_s, column) for column in xyz.T], axis=1)
    away = np.abs(time_s - at_s[interpolation.nearest(at_s, time_s)])
    return path, np.where(away <= BELIEVED_S, DRIFT_MS2 * away**2, np.inf)


def costs(camera: Camera, rows: Rows, path: NDArray, sigma_m: NDArray, wanted: NDArray) -> NDArray:
    """Return the cost (P, T, S + 1) of assigning each frame of each row to each person.

    The last column is nobody's; all are zero where the row is absent. Persons have a `path` (S, T,
    3) m, NaN without any place, of standard deviation `sigma_m` (S, T) as `along` returns it;
    `wanted` (S,) persons get rows that nobody else explains while only this view sees them.
    """
    count = len(path)
    cost = np.zeros((*rows.present.shape, count + 1))
    for person in range(count):
        expected = camera_models.project(camera, path[person])
        depth_m = path[person] @ camera.cam_from_world[2, :3] + camera.cam_from_world[2, 3]
        drift_px = sigma_m[person] * camera.K[0, 0] / np.maximum(depth_m, 0.1)
        sigma_px = np.hypot(rows.sigma_px[:, None], drift_px)
        with np.errstate(invalid="ignore"):
            off = np.linalg.norm(rows.centre - expected, axis=-1) / sigma_px
        spread = np.log(np.maximum(sigma_px, 1e-9) / np.maximum(rows.sigma_px, 1e-9)[:, None])
        value = np.minimum(0.5 * np.nan_to_num(off, nan=np.inf) ** 2 + 2 * spread, FAR)
        lost = NOBODY - 0.5 if wanted[person] else NOBODY + 0.5
        value = np.where(np.isfinite(sigma_m[person]), value, lost)
        cost[..., person] = value
    cost[..., -1] = NOBODY
    cost[~rows.present] = 0.0
    return cost


def follow(cost: NDArray, cut: NDArray, present: NDArray) -> NDArray:
    """Return the cheapest owners of rows over time, by Viterbi 1967, for each row alone.

    The last column of `cost` (R, T, S + 1) is nobody's; changing the owner is cheap where `cut`
    (R, T). Owners (R, T) are 0 to S - 1, or -1 for nobody and where absent.
    """
    change = np.where(cut | ~present, CHANGE_AT_CUT, CHANGE)
    total, back = cost[:, 0].copy(), np.zeros(cost.shape, dtype=np.int16)
    stay = np.arange(cost.shape[2])
    for t in range(1, cost.shape[1]):
        best = np.argmin(total, axis=1)
        moved = np.take_along_axis(total, best[:, None], axis=1) + change[:, t, None]
        moves = moved < total
        back[:, t] = np.where(moves, best[:, None], stay)
        total = np.where(moves, moved, total) + cost[:, t]
    owner = np.empty(present.shape, dtype=int)
    state = np.argmin(total, axis=1)
    for t in range(cost.shape[1] - 1, -1, -1):
        owner[:, t] = state
        state = back[np.arange(len(state)), t, state]
    nobody = cost.shape[2] - 1
    return np.where(present & (owner != nobody), owner, -1)


def one_row_each(owner: NDArray, cost: NDArray) -> NDArray:
    """Give each person at most one row of a camera in each frame: the one that fits best.

    `owner` (P, T) comes from `follow`, `cost` is (P, T, S + 1); the result (S, T) is the row of
    each person, -1 for none.
    """
    count = cost.shape[2] - 1
    index = np.full((count, owner.shape[1]), -1)
    for person in range(count):
        own = np.where(owner == person, _smoothed(cost[..., person]), np.inf)
        best = np.argmin(own, axis=0)
        index[person] = np.where(np.isfinite(own.min(axis=0)), best, -1)
    return index


def _smoothed(cost: NDArray, half: int = 5) -> NDArray:
    """Return the mean over neighbouring frames, so that two rows do not alternate."""
    total = np.cumsum(np.pad(cost, ((0, 0), (half + 1, half)), mode="edge"), axis=1)
    return (total[:, 2 * half + 1 :] - total[:, : -2 * half - 1]) / (2 * half + 1)
