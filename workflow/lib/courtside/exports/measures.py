"""CSV of kinematics: a row per frame and person, a row per measure."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from courtside.geometry.interpolation import window
from courtside.kinematics import measures, path_length
from courtside.kinematics.joint_angles import Angle
from courtside.records.keypoints import missing_reason
from courtside.records.keypoints.skeletal_motion import SkeletalMotion

# The data dictionary, docs/results.md, describes the columns.
SUMMARY_COLUMNS = (
    "person", "measure", "value", "sigma", "sigma_camera", "unit", "n", "definition",
)  # fmt: skip
# measure, value, sigma, sigma_camera, unit, n
Row = tuple[str, float, float, float, str, int]
# Over which a largest speed is a mean: one frame with a large error would be the largest of all. At
# 10 frames per second it is one frame, but of joints filtered at 4.5 Hz.
PEAK_S = 0.1
# Left out beside gaps, at least one frame: splines have large errors at their ends. Noise of 4 mm,
# filtered at 6 Hz, made the largest speed 0.028 m/s too high at 240 frames per second without one
# frame, 0.018 without 8, 0.015 without 24.
EDGE_S = 1 / 30
# Over which the largest change of velocity is taken. Single wrong joints and noise make short peaks
# of the acceleration: on the eight takes of players-dev the largest mean over 0.1 s of the
# skeleton's centre was wrong by 17.6 m/s2 (root mean square; the median of the true ones is 13.1),
# the change over 0.2 s by 2.3 (7.2), over 0.3 s by 0.8 (6.1), over 0.4 s by 0.5 (5.3).
CHANGE_S = 0.3
# The largest of many is above the true one: its standard deviation also has this share of it. On
# the same takes the acceleration is 0.7 (neck), 0.8 (centre) and 0.3 m/s2 (mass) off (root mean
# square). With 0.03 for speeds, 90 % intervals hold 109 of 120 on development sessions (neck,
# centre and mass of 40 persons), without it 104: 101 (100) of 102 where a person is alone, 8 (4) of
# 18 where two cross and hide one another.
LARGEST_SPEED, LARGEST_CHANGE = 0.03, 0.1
PEAKS = (
    f"largest mean over {PEAK_S} s",
    f"largest change of velocity over {CHANGE_S} s, per second",
)


def frames(people: Sequence[measures.Person]) -> pd.DataFrame:
    """Return the measures of every frame, T rows for each person."""
    return pd.concat([_frames_of(person) for person in people], ignore_index=True)


def _frames_of(person: measures.Person) -> pd.DataFrame:
    columns = {
        "frame_idx": np.arange(len(person.time_s)),
        "time_s": person.time_s.round(6),
        "person": person.person,
    }
    for name, point in person.points.items():
        columns |= {f"{name}_{key}": value for key, value in _columns(point).items()}
    for name, angle in person.angles.items():
        columns[f"{name}_deg"] = angle.degrees.round(2)
        columns[f"{name}_sd_deg"] = angle.sigma_deg.round(2)
    return pd.DataFrame(columns)


def _columns(point: measures.Point) -> dict[str, NDArray]:
    position, velocity, acceleration = (
        own + np.nan_to_num(camera)
        for own, camera in zip(point.covariance, point.camera_covariance, strict=True)
    )
    speed, speed_sd = measures.size(point.velocity, velocity)
    ground, ground_sd = measures.size(point.velocity, velocity, path_length.GROUND)
    change, change_sd = measures.size(point.acceleration, acceleration)
    return {
        **{f"{axis}_m": point.position[:, at].round(5) for at, axis in enumerate("xyz")},
        "sd_mm": (1000 * np.sqrt(np.trace(position, axis1=1, axis2=2))).round(2),
        "speed_m_s": speed.round(4),
        "speed_sd_m_s": speed_sd.round(4),
        "ground_speed_m_s": ground.round(4),
        "ground_speed_sd_m_s": ground_sd.round(4),
        "acceleration_m_s2": change.round(3),
        "acceleration_sd_m_s2": change_sd.round(3),
        "reason": pd.Series(point.reason).map(missing_reason.WORDS).to_numpy(),
    }


def summary(people: Sequence[measures.Person], stage: str) -> pd.DataFrame:
    """Return the measures of the whole take, in `SUMMARY_COLUMNS`.

    `stage` says in each definition which joints were measured: `filtered` or `corrected`. Largest
    speeds are means over `PEAK_S` away from gaps; the largest acceleration is the largest change of
    velocity over `CHANGE_S`, per second. Largest angles are those of one frame, with its sigma: of
    many noisy frames the largest lies above the true one.
    """
    rows = []
    for person in people:
        for name, point in person.points.items():
            words = point.definition
            found = [(*row, words) for row in (*_distances(point), *_noise(point))]
            for row, how in zip(_peaks(person.time_s, point), PEAKS, strict=True):
                found.append((*row, f"{words}; {how}"))
            rows += [(person.person, f"{name}_{row[0]}", *row[1:]) for row in found]
        for name, angle in person.angles.items():
            rows += [(person.person, *row) for row in _angle_rows(name, angle)]
    table = pd.DataFrame(rows, columns=list(SUMMARY_COLUMNS))
    return table.assign(definition=table["definition"] + f"; {stage} joints")


def _distances(point: measures.Point) -> Iterator[Row]:
    known = np.flatnonzero(np.isfinite(point.velocity).all(axis=1))
    n_frames, unknown = len(known), float("nan")
    n_missing = int(np.ptp(known)) + 1 - n_frames if n_frames else 0
    for prefix, found in (("", point.distance), ("ground_", point.ground_distance)):
        value, sigma, camera = found.corrected_m, found.sigma_m, found.camera_sigma_m
        seconds = found.seconds if found.seconds > 0 else unknown
        yield f"{prefix}distance", value, sigma, camera, "m", n_frames
        yield f"{prefix}distance_measured", found.measured_m, unknown, unknown, "m", n_frames
        gaps = found.gaps_m, found.gaps_sigma_m
        yield f"{prefix}distance_in_gaps", *gaps, unknown, "m", n_missing
        bias = found.bias_m, found.bias_sigma_m
        yield f"{prefix}distance_noise_bias", *bias, unknown, "m", n_frames
        most = found.bias_most_m
        yield f"{prefix}distance_noise_bias_most", most, unknown, unknown, "m", n_frames
        mean = value / seconds, sigma / seconds, camera / seconds
        yield f"{prefix}speed_mean", *mean, "m/s", n_frames


def _peaks(time_s: NDArray, point: measures.Point) -> Iterator[Row]:
    """Yield the largest speed, a mean over `PEAK_S`, and the largest acceleration over `CHANGE_S`.

    `EDGE_S` at both ends of a stretch without gaps is left out. Errors of the frames that make a
    mean are taken as equal, those of the two that make a change as independent; the cameras' are
    not, and left out: they cancel or add as both velocities have one direction or opposite ones.
    """
    step_s = float(np.median(np.diff(time_s))) if len(time_s) > 1 else PEAK_S
    inside = _inside(point.velocity, max(1, window(EDGE_S, 1 / step_s)))
    spread = point.covariance[1], point.camera_covariance[1]
    n = max(1, window(PEAK_S, 1 / step_s))
    yield _peak("speed_max", "m/s", point.velocity, spread, inside, n, LARGEST_SPEED)
    n = max(1, window(CHANGE_S, 1 / step_s))
    change = _over(point.velocity, n, -1) / (n * step_s)
    own = _over(spread[0], n, 1) / (n * step_s) ** 2
    both = own, np.zeros_like(own)
    whole = pd.Series(inside).rolling(n + 1).sum().to_numpy() == n + 1
    row = _peak("acceleration_max", "m/s2", change, both, whole, 1, LARGEST_CHANGE)
    yield *row[:-1], int(inside.sum())


def _inside(vectors: NDArray, n: int) -> NDArray:
    """Return which vectors (T, 3) are known, with n known ones before and after."""
    known = pd.Series(np.isfinite(vectors).all(axis=1))
    return np.asarray(known.rolling(2 * n + 1, center=True).sum() == 2 * n + 1)


def _over(values: NDArray, n: int, sign: int) -> NDArray:
    """Return each of values (T, ...) plus, or minus, that of n frames before; NaN without one."""
    both = np.full(values.shape, np.nan)
    both[n:] = values[n:] + sign * values[: max(0, len(values) - n)]
    return both


def _peak(
    name: str,
    unit: str,
    vectors: NDArray,
    spread: Sequence[NDArray],
    used: NDArray,
    n: int,
    share: float,
) -> Row:
    """Return the largest mean over n used frames of the lengths of vectors (T, 3).

    `spread`: their covariances (T, 3, 3) of own errors, and of the cameras'. `share` of the value
    is added to its standard deviation, in quadrature.
    """
    value, sigma = measures.size(vectors, spread[0])
    _, camera = measures.size(vectors, spread[1])
    table = pd.DataFrame({"value": value, "sigma": sigma, "camera": camera})
    means = table.where(pd.Series(used)).rolling(n).mean()
    found, own, of_cameras = means.iloc[_largest(means["value"].to_numpy())[0]]
    own = float(np.hypot(own, share * found))
    return name, found, own, of_cameras or float("nan"), unit, int(used.sum())


def _largest(values: NDArray) -> tuple[int, int]:
    """Return the index of the largest known value, 0 if none is known, and how many are."""
    known = np.isfinite(values)
    return (int(np.nanargmax(values)) if known.any() else 0), int(known.sum())


def _noise(point: measures.Point) -> Iterator[Row]:
    n_frames, unknown = int(np.isfinite(point.position).all(axis=1).sum()), float("nan")
    yield "noise_memory", point.noise.memory_s, unknown, unknown, "s", n_frames
    yield "noise_white_share", point.noise.white, unknown, unknown, "", n_frames
    yield "noise_scale", point.noise.scale, unknown, unknown, "", n_frames


def _angle_rows(name: str, angle: Angle) -> Iterator[tuple[Any, ...]]:
    unknown, words = float("nan"), "angle between lines from joint to joint"
    for what, sign in (("max", 1), ("min", -1)):
        at, n_frames = _largest(sign * angle.degrees)
        value, sigma = angle.degrees[at], angle.sigma_deg[at]
        yield f"{name}_{what}", value, sigma, unknown, "degrees", n_frames, words


def angles(motion: SkeletalMotion) -> pd.DataFrame:
    """Return the joint angles of a skeletal motion, T rows for each person.

    The rotation of the pelvis goes on beyond 180 degrees where a person turns round.
    """
    parts = []
    for at, person in enumerate(motion.person_id.tolist()):
        columns = {
            "frame_idx": np.arange(len(motion.time_s)),
            "time_s": motion.time_s.round(6),
            "person": person,
        }
        for k, name in enumerate(motion.angles.tolist()):
            degrees = motion.angle_deg[at, :, k].copy()
            if name == "pelvis_rotation":
                fitted = np.isfinite(degrees)
                degrees[fitted] = np.unwrap(degrees[fitted], period=360)
            columns[f"{name}_deg"] = degrees.round(2)
            columns[f"{name}_sd_deg"] = motion.angle_sigma_deg[at, :, k].round(2)
        parts.append(pd.DataFrame(columns))
    return pd.concat(parts, ignore_index=True)
