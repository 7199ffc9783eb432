"""Check a calibration made elsewhere by static points and by the people in the takes."""

import numpy as np

from courtside.calibration import file_formats
from courtside.calibration.file_check import residuals, verdict
from courtside.geometry import camera
from courtside.reconstruction import resampling
from courtside.records import tables
from courtside.records.cameras import clicks, footage
from courtside.records.keypoints import skeleton
from courtside.study.execution import log
from courtside.study.execution.files import write_json
from courtside.study.execution.script import run


def main(paths, check_json, check_csv, *, names, override, takes, unit=None):
    found = file_formats.rename(file_formats.read(paths.calibration_path, unit), names)
    found = file_formats.with_principal_points(found, override.get("principal_point_px", {}))
    # Everything in px of the calibrated picture, which is what the file's numbers are of.
    shown, static = camera.read_toml(paths.cameras_toml), None
    if paths.static_csv:
        _, static = clicks.read_static(paths.static_csv, list(names))
        static = np.stack(in_calibrated(found, shown, static))
    views = in_calibrated(found, shown, people(paths.cameras_toml, list(names), takes))
    joints = residuals.of_people(views) if views else None
    seen = verdict.Seen(static, joints)
    said = verdict.judge(found, seen, residuals.height_px(views))
    for line in said.warnings:
        log.logger.warning("%s", line)
    rows = verdict.by_camera(found, seen)
    tables.write(check_csv, rows, float_format="%.3f")
    content = {
        "warnings": said.warnings,
        "faults": [{"what": one.what, "advice": one.advice} for one in said.faults],
        "disagree_px": said.px,
        "without_faults_px": said.mended_px,
    }
    write_json(check_json, content)


def in_calibrated(calibrated, shown, xy):
    """Return px (..., 2) of each camera's video as px of the calibrated picture."""
    each = zip(calibrated, shown, xy, strict=True) if len(xy) else ()
    return [camera.in_other_picture(here, whole, px) for whole, here, px in each]


def people(cameras_toml, names, takes):
    """Return the limb joints (T, J, 2) px of everybody in all takes, for each camera."""
    parts = []
    for take in takes:
        seen = footage.read(cameras_toml, take["pose2d"], take["people"], take["sync"])
        each, clocks = [one.view for one in seen], [one.clock for one in seen]
        time_s = resampling.common_times(each, clocks)
        joints = [list(each[0].joints).index(name) for name in skeleton.JOINTS]
        xy = {
            one.camera.name: resampling.resample(one.view, time_s, one.clock)[0][:, :, joints]
            for one in seen
        }
        shape = next(iter(xy.values())).shape
        of_all = np.stack([xy.get(name, np.full(shape, np.nan)) for name in names])
        parts.append(of_all.reshape(len(names), -1, len(joints), 2))
    return list(np.concatenate(parts, axis=1)) if parts else []


if __name__ == "__main__":
    run(main, snakemake)
