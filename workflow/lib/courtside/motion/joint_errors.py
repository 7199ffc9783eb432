"""How far 3D joints lie from the truth, and from what a camera saw that they do not rest on."""

from dataclasses import replace

import numpy as np

from courtside.geometry import camera as camera_models
from courtside.motion import pose_errors
from courtside.reconstruction import resampling
from courtside.records import derived
from courtside.study.errors import InputError


def derive_truth(truth, table, skeleton, names):
    """Append derived joints to a truth, where the network's skeleton defines them alike.

    Parameters
    ----------
    truth
        A dataclass as for `true`.
    table : courtside.records.derived.DerivedJoints
    skeleton : str
        Of the network: a joint that it defines otherwise is left out, and has no true error then.
    names : sequence of str

    Returns
    -------
    truth
    """
    alike = [name for name in names if table.comparable(skeleton, derived.RIG, name)]
    if not alike:
        return truth
    weights = np.stack([table.weights(derived.RIG, name, truth.joints) for name in alike])
    more = np.einsum("nj,ptjk->ptnk", weights, truth.xyz)
    joints = np.array([*map(str, truth.joints), *alike])
    return replace(truth, joints=joints, xyz=np.concatenate([truth.xyz, more], axis=2))


def true(points, truth):
    """Return the distance to the truth, (P, T, J) mm; NaN where either is missing.

    Parameters
    ----------
    points : Keypoints3D
    truth
        Has joints (J,), person_id (P,), time_s (T,), xyz (P, T, J, 3) m on the same clock and in world;
        interpolated at the times of `points`, never beyond its ends.

    Raises
    ------
    InputError
        If none of the persons is in the truth.
    """
    known, wanted = list(map(str, truth.person_id)), list(map(str, points.person_id))
    if not set(known) & set(wanted):
        raise InputError(
            f"truth: expected one of the persons {wanted}, found {known}; name the takes' persons alike"
        )
    real = pose_errors.true_places(points, truth)
    names, apart, _ = pose_errors.errors(points, list(map(str, truth.joints)), real)
    at = [list(points.joints).index(name) for name in names]
    error = np.full(points.xyz.shape[:-1], np.nan)
    error[:, :, at] = 1000 * np.linalg.norm(apart, axis=-1)
    return error


def left_out(points, camera, view, clock=None):
    """Return how far the detections of a view lie from points that do not rest on it, (P, T, J) px.

    Parameters
    ----------
    points : Keypoints3D
    camera : Camera
    view : Keypoints2D
        Of that camera. A tracklet belongs to the person whose projection is closest in the median over
        the whole take, and of several the closest in the median comes first: no frame chooses its own.
    clock : Clock, optional
        The view's.
    """
    xy, _ = resampling.resample(view, points.time_s, clock)
    names = list(map(str, view.joints))
    at = [names.index(joint) if joint in names else -1 for joint in map(str, points.joints)]
    xy = np.where((np.array(at) >= 0)[:, None], xy[:, :, at], np.nan)
    projected = camera_models.project(camera, points.xyz)
    apart = np.linalg.norm(xy[None] - projected[:, None], axis=-1)
    middle = np.array([[_median(tracklet) for tracklet in person] for person in apart])
    error = np.full(points.xyz.shape[:-1], np.nan)
    closest = np.nan_to_num(middle, nan=np.inf).min(axis=0)
    for tracklet in np.argsort(closest)[: np.isfinite(closest).sum()]:
        person = int(np.nanargmin(middle[:, tracklet]))
        error[person] = np.where(np.isnan(error[person]), apart[person, tracklet], error[person])
    return error


def _median(values):
    known = values[np.isfinite(values)]
    return np.median(known) if len(known) else np.nan
