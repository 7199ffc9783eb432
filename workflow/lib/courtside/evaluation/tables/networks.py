"""Networks on the same frames: 2D errors, exchanged sides, jitter and 3D errors, with intervals."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from courtside.evaluation import joints
from courtside.records.keypoints import skeleton
from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.statistics import moving_blocks

BLOCK_S = 0.5  # errors of neighbouring frames are alike: blocks of frames are drawn again
FEWEST = 3  # ASSUME: blocks below which an interval would say nothing
LEVEL = 0.95  # of the intervals
COLUMNS = [
    "session", "against", "network", "measure", "unit", "value", "value_from", "value_to",
    "difference", "difference_from", "difference_to", "n", "n_takes", "n_blocks",
]  # fmt: skip
KEY = ["person", "camera", "joint"]
USED = ["x_px", "y_px", "true_x_px", "true_y_px", "torso_px", "error_px", "error_torso"]
USED += ["in_picture", "placed", "exchanged"]
# Jitter: the noise of the error as if it were independent from frame to frame; slow errors hardly
# count. The second difference of independent noise has 6 times its variance per axis; the median
# length of a normal vector of two axes is sqrt(2 ln 2) times its standard deviation per axis.
JITTER = 1 / np.sqrt(6 * 2 * np.log(2))
MEASURES = {  # name: unit, series that it is of, percentile of this series or None for its mean
    "error_median": ("px", "error_px", 50),
    "error_p95": ("px", "error_px", 95),
    "error_median_torso": ("%", "error_torso", 50),
    "error_p95_torso": ("%", "error_torso", 95),
    "pck": ("%", "placed", None),
    "exchanged": ("%", "exchanged", None),
    "missing": ("%", "missing", None),
    "jitter": ("px", "jitter", 50),
    "error_3d_median": ("mm", "error_3d", 50),
    "error_3d_p95": ("mm", "error_3d", 95),
}


@dataclass
class ComparedTake:
    """One take as several networks see it."""

    session: str
    against: str  # truth, or what else it is compared with
    pictures: dict[str, pd.DataFrame]  # rows of `detection.evaluate` or `against`, by network
    # Distances from the truth (P, T, J) mm of the same joints, NaN where missing, by network
    error_3d: dict[str, NDArray] = field(default_factory=dict)
    rate_hz_3d: float = np.nan


@dataclass(frozen=True)
class Series:
    """Values (T, K) of a take by name, NaN where there is none, and their frames per second."""

    values: dict[str, NDArray]
    rate_hz: float


def errors_3d(
    points: Mapping[str, Keypoints3D], truth: joints.Truth
) -> tuple[dict[str, NDArray], float]:
    """Return the errors of the limb joints (P, T, 12) mm by network, and frames per second.

    Persons are the truth's, T the frames of all networks together; NaN where a joint is missing.
    """
    rate_hz = next(iter(points.values())).rate_hz
    start_s = min(record.time_s[0] for record in points.values())
    slots = {n: np.rint((of.time_s - start_s) * rate_hz).astype(int) for n, of in points.items()}
    shape = len(truth.person_id), max(at[-1] for at in slots.values()) + 1, len(skeleton.JOINTS)
    known, found = list(map(str, truth.person_id)), {}
    for name, record in points.items():
        error_mm = joints.limb_distances(record, truth)
        found[name] = np.full(shape, np.nan)
        for at, person in enumerate(map(str, record.person_id)):
            if person in known:
                found[name][known.index(person), slots[name]] = error_mm[at]
    return found, rate_hz


def table(takes: Sequence[ComparedTake], networks: Sequence[str]) -> pd.DataFrame:
    """Return the measures of each network in the takes of each session together: `COLUMNS`.

    Values of 2D and 3D errors and of jitter are those of joints that all networks have, the shares
    are of all joints in the picture. Differences are a network's less the first one's, where the
    same frames are drawn again for both. Intervals hold for these takes, persons and halls alone.
    In simulations of five takes of four blocks, with errors as those of `repeats`, they hold 89 to
    96 % of values and 93 % of differences; of one take of eight blocks 70 to 90 % of medians. Fewer
    than `FEWEST` blocks have none.
    """
    rows = []
    groups: dict[tuple[str, str], list[ComparedTake]] = {}
    for take in takes:
        groups.setdefault((take.session, take.against), []).append(take)
    for (session, against), group in groups.items():
        for row in _measured(group, networks):
            rows.append({"session": session, "against": against, **row})
    return pd.DataFrame(rows, columns=COLUMNS)


def _measured(group: Sequence[ComparedTake], networks: Sequence[str]) -> Iterator[dict]:
    """Yield the rows of the takes of one session."""
    seen = [_of_pictures(take, networks) for take in group]
    space = [_series_3d(take) for take in group if take.error_3d]
    for name, (unit, key, percentile) in MEASURES.items():
        series = space if key == "error_3d" else seen
        names = [name for name in networks if series and name in series[0]]
        lengths = [len(one[names[0]].values[key]) for one in series]
        counts, n_blocks = _counts(lengths, [one[names[0]].rate_hz for one in series])
        first: NDArray | None = None
        for network in names:
            values, frame = _flat([one[network].values[key] for one in series])
            value, drawn = _statistic(values, percentile), _drawn(counts, values, frame, percentile)
            first = np.append(drawn, value) if first is None else first
            row = {"network": network, "measure": name, "unit": unit, "value": value}
            row |= {"n": len(values), "n_takes": len(series), "n_blocks": n_blocks}
            row |= _ends("value", drawn)
            if network != networks[0] == names[0]:
                row |= {"difference": value - first[-1], **_ends("difference", drawn - first[:-1])}
            yield row


def _flat(parts: Sequence[NDArray]) -> tuple[NDArray, NDArray]:
    """Return the values (N,) of takes (T, K) that are there, and the frame (N,) of each."""
    starts = np.cumsum([0, *(len(part) for part in parts)])
    known = [np.isfinite(part) for part in parts]
    frame = [np.nonzero(of)[0] + at for of, at in zip(known, starts, strict=False)]
    values = [part[of] for part, of in zip(parts, known, strict=True)]
    return np.concatenate(values), np.concatenate(frame)


def _statistic(values: NDArray, percentile: float | None) -> float:
    if not len(values):
        return np.nan
    return float(values.mean() if percentile is None else np.percentile(values, percentile))


def _counts(lengths: Sequence[int], rates_hz: Sequence[float]) -> tuple[NDArray | None, int]:
    """Return how often each frame (R, T) of all takes is drawn, and the number of blocks.

    None for too few blocks. The draws are the same for all networks.
    """
    blocks = [max(1, round(BLOCK_S * rate)) for rate in rates_hz]
    n_blocks = sum(length // block for length, block in zip(lengths, blocks, strict=True))
    if n_blocks < FEWEST:
        return None, n_blocks
    return moving_blocks.counts(lengths, blocks), n_blocks


def _drawn(
    counts: NDArray | None, values: NDArray, frame: NDArray, percentile: float | None
) -> NDArray:
    """Return the statistic (R,) of values (N,) whose frames are drawn so often; NaN without."""
    if counts is None or not len(values):
        return np.full(moving_blocks.REPLICATES, np.nan)
    order = np.argsort(values, kind="stable")
    values, frame = values[order], frame[order]
    found = np.full(len(counts), np.nan)
    for at, often in enumerate(counts):
        weight = often[frame]
        if not weight.any():
            continue
        if percentile is None:
            found[at] = (weight * values).sum() / weight.sum()
        else:
            below = np.cumsum(weight)
            place = np.searchsorted(below, percentile / 100 * below[-1])
            found[at] = values[min(place, len(values) - 1)]
    return found


def _ends(name: str, drawn: NDArray) -> dict[str, float]:
    known = drawn[np.isfinite(drawn)]
    if not len(known):
        return {}
    low, high = np.quantile(known, [(1 - LEVEL) / 2, (1 + LEVEL) / 2])
    return {f"{name}_from": low, f"{name}_to": high}


def _of_pictures(take: ComparedTake, networks: Sequence[str]) -> dict[str, Series]:
    """Return the series of each network in the pictures of a take, of the same frames."""
    first = take.pictures[networks[0]]
    step_s, slot = _slots(first)
    tables = {}
    for name in networks:
        rows = take.pictures[name]
        frames = pd.MultiIndex.from_frame(rows[["camera", "frame_idx"]])
        rows = rows.assign(slot=slot.reindex(frames).to_numpy()).set_index(["slot", *KEY])[USED]
        tables[name] = rows.unstack(KEY).sort_index(axis=1)
    every = np.arange(int(slot.max()) + 1)
    grids = {name: one.reindex(every) for name, one in tables.items()}
    both = np.logical_and.reduce([np.isfinite(_grid(one, "error_px")) for one in grids.values()])
    return {name: Series(_values(one, both), 1 / step_s) for name, one in grids.items()}


def _slots(rows: pd.DataFrame) -> tuple[float, pd.Series]:
    """Return the time between frames, and for each camera's frame a number on the common clock."""
    times = rows.drop_duplicates(["camera", "frame_idx"]).set_index(["camera", "frame_idx"])
    time_s = times["time_s"].sort_index()
    step_s = float(time_s.groupby("camera").diff().median())
    frame = time_s.index.get_level_values("frame_idx").to_numpy()
    ahead = (time_s / step_s - frame).groupby("camera").transform("median").round()
    slot = (ahead + frame).astype(int)
    return step_s, slot - slot.min()


def _grid(one: pd.DataFrame, column: str, missing: float = np.nan) -> NDArray:
    return one[column].astype(float).fillna(missing).to_numpy()


def _values(one: pd.DataFrame, both: NDArray) -> dict[str, NDArray]:
    """Return the series (T, K) of one network; `both`: all networks have the joint there."""
    known = (_grid(one, "in_picture", 0) > 0) & np.isfinite(_grid(one, "torso_px"))
    axes = [_grid(one, axis) - _grid(one, f"true_{axis}") for axis in ("x_px", "y_px")]
    off = np.where(both[..., None], np.stack(axes, axis=-1), np.nan)
    jitter = np.full(both.shape, np.nan)
    jitter[1:-1] = JITTER * np.linalg.norm(np.diff(off, n=2, axis=0), axis=-1)
    shares = {key: _grid(one, key, 0) for key in ("placed", "exchanged")}
    error_px = _grid(one, "error_px")
    shares["missing"] = ~np.isfinite(error_px)
    return {
        **{key: np.where(known, 100.0 * values, np.nan) for key, values in shares.items()},
        "error_px": np.where(both, error_px, np.nan),
        "error_torso": np.where(both, 100 * _grid(one, "error_torso"), np.nan),
        "jitter": jitter,
    }


def _series_3d(take: ComparedTake) -> dict[str, Series]:
    """Return the 3D errors of each network, of the places that all have."""
    known = np.logical_and.reduce([np.isfinite(error) for error in take.error_3d.values()])
    found = {}
    for name, error in take.error_3d.items():
        frames = np.where(known, error, np.nan).transpose(1, 0, 2)
        found[name] = Series({"error_3d": frames.reshape(len(frames), -1)}, take.rate_hz_3d)
    return found
