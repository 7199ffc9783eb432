"""What a correction of an inertial skeleton by vision changed, and what it rests on."""

from dataclasses import asdict, dataclass

import numpy as np

from courtside.geometry import rotations
from courtside.records.devices.hierarchy import forward
from courtside.study.execution.files import write_json


@dataclass(frozen=True)
class CorrectionReport:
    """A correction in numbers; every array as a list.

    Attributes
    ----------
    source : str
        Vision's.
    joints : list of str
        Those that vision and the skeleton have in common, in the order of the lists below.
    seen : list of float
        Share of vision's frames with that joint.
    weight : list of float
        Mean weight of these frames: 1 as expected, towards 0 for outliers.
    noise_mm, offset_mm : list of float
        Standard deviation per axis of vision as found; length of its constant offset as found.
    independent_s : list of float
        Time per independent value of vision, as found.
    before_mm, after_mm : list of float
        Median distance to vision of the skeleton, in place by the first estimate, and corrected. Agreement,
        not accuracy.
    change_mm : dict of str to float
        Median change of each joint of the skeleton about the root, the change of heading taken out.
    bone_scale : dict of str to float
        Factor on the bone that ends at a joint.
    mount_deg, slow_deg : dict of str to float
        Constant turn of each segment; standard deviation of the slow ones as estimated, by kind.
    heading_removed_deg : float
        Range of the heading correction.
    heading_s, heading_deg : list of float
        Heading correction, once a second.
    shift_m : float
        Standard deviation of the slow shift of the root as estimated.
    lag_s, lag_sd_s : float
        Shift of the clock as found: taken off the device's times; its standard deviation.
    vision_from_device : list of list of float, (3, 4)
        Where the corrected skeleton lies in vision's frame.
    rounds : int
    rms_change_mm : list of float
        Change of all joints in each round of the fit.
    """

    source: str
    joints: list
    seen: list
    weight: list
    noise_mm: list
    offset_mm: list
    independent_s: list
    before_mm: list
    after_mm: list
    change_mm: dict
    bone_scale: dict
    mount_deg: dict
    slow_deg: dict
    heading_removed_deg: float
    heading_s: list
    heading_deg: list
    shift_m: float
    lag_s: float
    lag_sd_s: float
    vision_from_device: list
    rounds: int
    rms_change_mm: list

    def write(self, path):
        """Write as JSON."""
        write_json(path, asdict(self))


def describe(fit, before, after):
    """Describe a finished fit.

    Parameters
    ----------
    fit : courtside.inertial.fit.Fit
    before, after : PosedHierarchy
        The performed frames, uncorrected and corrected.

    Returns
    -------
    report : CorrectionReport
    """
    seen = np.isfinite(fit.seen.xyz).all(axis=2)
    count = np.maximum(seen.sum(axis=0), 1)
    sigma = np.sqrt(np.trace(fit.noise.covariance, axis1=1, axis2=2) / 3)
    typical = [
        np.median(fit.seen.sigma_m[at, d]) if at.any() else 1.0 for d, at in enumerate(seen.T)
    ]
    fixed, layout = fit.fixed, fit.model.fixed
    mount = np.linalg.norm(fixed[layout["mount"]].reshape(-1, 3), axis=1)
    offset = np.linalg.norm(fixed[layout["offset"]].reshape(-1, 3), axis=1)
    slow = {kind: np.degrees(size) for kind, size in fit.size.items() if kind != "shift"}
    return CorrectionReport(
        source=fit.seen.source,
        joints=list(fit.seen.joints),
        seen=_list(seen.mean(axis=0), 3),
        weight=_list(fit.noise.weight.sum(axis=0) / count, 3),
        noise_mm=_list(1e3 * sigma * np.array(typical), 1),
        offset_mm=_list(1e3 * offset, 1),
        independent_s=_list(fit.noise.inflation / fit.rate_hz, 2),
        **_agreement(fit),
        change_mm=_changes(fit, before, after),
        bone_scale=_scales(fit),
        mount_deg=dict(zip(fit.segments.names, _list(np.degrees(mount), 2), strict=True)),
        slow_deg={kind: round(float(size), 2) for kind, size in slow.items()},
        **_heading(fit),
        shift_m=float(fit.size["shift"]),
        lag_s=float(fixed[layout["lag"]][0]),
        lag_sd_s=float(np.sqrt(fit.border_covariance[layout["lag"], layout["lag"]][0, 0])),
        vision_from_device=_vision_from_device(fit, after),
        rounds=fit.round,
        rms_change_mm=_list(1e3 * np.array(fit.rms_change_m), 3),
    )


def _list(values, digits):
    return [round(float(value), digits) for value in values]


def _agreement(fit):
    away = {}
    for name, xyz in (("before_mm", fit.first), ("after_mm", fit.last)):
        distance = 1e3 * np.linalg.norm(fit.vision - xyz, axis=2)
        away[name] = [
            round(float(np.nanmedian(joint)), 1) if np.isfinite(joint).any() else None
            for joint in distance.T
        ]
    return away


def _scales(fit):
    joints, parents = fit.posed.hierarchy.joints, fit.posed.hierarchy.parents
    factor = fit.model.stretches(fit.fixed)
    return {
        joint: round(float(value), 4)
        for joint, parent, value in zip(joints, parents, factor, strict=True)
        if parent >= 0
    }


def _total_heading(fit, time_s):
    return (
        fit.alignment.heading_at(time_s) + fit.slow_at(time_s)[:, fit.model.slow["heading"]][:, 0]
    )


def _heading(fit):
    time_s = np.arange(fit.posed.time_s[0], fit.posed.time_s[-1], 1.0)
    heading = np.degrees(_total_heading(fit, time_s))
    return {
        "heading_removed_deg": round(float(np.ptp(heading)), 2),
        "heading_s": _list(time_s, 3),
        "heading_deg": _list(heading, 2),
    }


def _changes(fit, before, after):
    """Return the median change of each joint about the root, in axes turned back by the heading."""
    old, new = (forward(posed)[0] for posed in (before, after))
    turn = rotations.matrices_from_vectors(_total_heading(fit, after.time_s)[:, None] * fit.up)
    old = np.einsum("tij,tkj->tki", turn, old - old[:, :1])
    change = 1e3 * np.median(np.linalg.norm(new - new[:, :1] - old, axis=2), axis=0)
    return dict(zip(before.hierarchy.joints, _list(change, 1), strict=True))


def _vision_from_device(fit, after):
    layout = fit.model.fixed
    turned = rotations.matrices_from_vectors(fit.fixed[layout["tilt"]])
    rotation = fit.alignment.vision_from_device @ turned
    root = fit.translation[:, 0] + fit.slow_at(after.time_s)[:, fit.model.slow["shift"]]
    place = root @ turned.T + fit.fixed[layout["place"]] + fit.place
    place = place @ fit.alignment.vision_from_device.T - after.translation[:, 0] @ rotation.T
    return np.column_stack([rotation, place.mean(axis=0)]).tolist()
