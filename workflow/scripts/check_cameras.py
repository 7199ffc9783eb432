"""Check a calibration made elsewhere by static points and by the people in the takes."""

import numpy as np

from courtside.calibration import file_formats
from courtside.calibration.file_check import residuals, upright, verdict
from courtside.geometry import camera
from courtside.reconstruction import common_views
from courtside.records import tables
from courtside.records.cameras import clicks
from courtside.study.execution import log
from courtside.study.execution.files import write_json
from courtside.study.execution.script import run


def main(paths, check_json, check_csv, *, names, override, takes, unit=None):
    found = file_formats.read_session(paths.calibration_path, names, override, unit)
    # Everything in px of the calibrated picture, which is what the file's numbers are of.
    shown, static = camera.read_toml(paths.cameras_toml), None
    if paths.static_csv:
        _, static = clicks.read_static(paths.static_csv, list(names))
        static = np.stack(in_calibrated(found, shown, static))
    people = common_views.of_takes(paths.cameras_toml, list(names), takes)
    views = in_calibrated(found, shown, people.xy) if people else []
    joints = residuals.of_people(views) if views else None
    seen = verdict.Seen(static, joints)
    person_px = residuals.height_px(views, people.height_px) if people else np.inf
    judged = verdict.judge(found, seen, person_px)
    turned = upright.warning(found, np.stack(views)) if views else ""
    shared = [turned] if turned else []
    for line in judged.warnings + shared:
        log.tell(line, check_json)
    rows = verdict.by_camera(found, seen)
    tables.write(check_csv, rows, float_format="%.3f")
    content = {
        "warnings": judged.warnings + shared,
        "shared": shared,  # of them, about all cameras together
        "faults": [
            {"what": one.what, "advice": one.advice, "cameras": one.names} for one in judged.faults
        ],
        "disagree_px": judged.px,
        "without_faults_px": judged.mended_px,
    }
    write_json(check_json, content)


def in_calibrated(calibrated, shown, xy):
    """Return px (..., 2) of each camera's video as px of the calibrated picture."""
    each = zip(calibrated, shown, xy, strict=True) if len(xy) else ()
    return [camera.in_other_picture(here, whole, px) for whole, here, px in each]


if __name__ == "__main__":
    run(main, snakemake)
