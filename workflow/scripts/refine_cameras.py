"""Refine cameras by the people in takes: cameras, keypoints, clicks -> cameras, where better."""

from dataclasses import replace

from courtside.calibration import file_formats
from courtside.calibration.court import court as court_files
from courtside.calibration.court import quality
from courtside.calibration.people import adjustment, prior, refinement, resection
from courtside.calibration.people.held_out import Points
from courtside.calibration.people.views import Limits
from courtside.calibration.records import covariance as camera_covariance
from courtside.geometry import camera as camera_models
from courtside.reconstruction import joint_correction, lost_cameras
from courtside.records import tables
from courtside.records.cameras import clicks, footage, knock_table
from courtside.records.devices import clocks
from courtside.records.keypoints import skeleton
from courtside.study.errors import InputError
from courtside.study.execution import log
from courtside.study.execution.files import write_json
from courtside.study.execution.script import run


def main(
    paths, cameras_toml, covariance_npz, quality_json, table_csv, knocks_csv, *,
    calibration, names, override, takes, weights, views, stated, unit=None,
):  # fmt: skip
    base = camera_models.read_toml(paths.cameras)
    known = prior.stated(base, **stated)
    if paths.covariance:
        known = camera_covariance.read(paths.covariance).of([camera.name for camera in base])
    report = {"calibration": calibration, "takes": [take["sync"] for take in takes]}
    rows, lost, limits = [], [], Limits.of(views)
    try:
        again = people_of(paths, base, takes, limits)
        wide, lost = resection.widened(known, base, again.which), again.lines
        read = {take["take"]: clocks.read(take["sync"])[1] for take in takes}
        still = again.cameras or base
        seen, rows = refinement.without_knocks(still, wide, again.parts, read, limits)
        kept = {"calibrated": in_file(paths.calibration, names, override, unit)}
        kept["found_again"] = again.cameras
        found = refinement.refine(base, wide, seen, limits, points(paths, base, weights), **kept)
    except InputError as error:
        found = refinement.unchanged(base, known, str(error))
    wrong, is_kept = found.wrong, found.taken == "base"
    covariance = known if is_kept else replace(found.covariance, frame=known.frame)
    report |= {"line": found.line, "warnings": [*(wrong if is_kept else []), *lost]}
    mended = [] if is_kept else [f"put right here, by people alone: {line}" for line in wrong]
    report["remarks"] = [found.line, *mended, *knock_table.lines(rows)]
    for line in report["warnings"] + report["remarks"]:
        log.logger.info("%s", line)
    report |= {"taken": found.taken, "verdicts": found.verdicts, "wrong": found.wrong}
    report["expected_before_cm"] = expected_cm(paths.court, base, known)
    report["expected_volume_rms_cm"] = expected_cm(paths.court, found.cameras, covariance)
    knock_table.write(knocks_csv, rows)
    camera_models.write_toml(cameras_toml, found.cameras, source=f"{calibration}, {found.taken}")
    camera_covariance.write(covariance_npz, covariance)
    tables.write(table_csv, found.table, float_format="%.4f")
    write_json(quality_json, report)


def people_of(paths, base, takes, limits):
    """Return the keypoints of each take; lost cameras are recovered."""
    filmed = {
        take["take"]: footage.read(paths.cameras, take["pose2d"], take["people"], take["sync"])
        for take in takes
    }
    court = court_files.read(paths.court) if paths.court else None
    offsets = joint_correction.read(paths.offsets) if paths.offsets else None
    joints = skeleton.read(paths.skeleton)
    return lost_cameras.recover(base, filmed, limits, joints, court, offsets)


def expected_cm(court_yaml, cameras, covariance):
    """Return the error to expect over a court, cm, by covariances; None without a court."""
    if not court_yaml:
        return None
    expected = quality.expected_volume(court_files.read(court_yaml), cameras, covariance)
    return expected["expected_volume_rms_cm"]


def in_file(path, names, override, unit):
    """Return the cameras of a calibration file in their own pictures, None of another base."""
    return file_formats.read_session(path, names, override, unit) if path else None


def points(paths, base, weights):
    """Return points at rest, and clicks that the base did not use; fitted if it is a file."""
    names, static, court = [camera.name for camera in base], None, None
    if paths.static:
        static = clicks.read_static(paths.static, names)[1]
    if paths.clicks and paths.court:
        lines = court_files.read(paths.court)
        marked = clicks.read(paths.clicks, names, list(lines.points))
        court = adjustment.court_clicks(lines, marked, base, **weights)
    return Points(static, court, fitted=bool(paths.calibration))


if __name__ == "__main__":
    run(main, snakemake)
