"""Refine cameras by the people in takes: cameras, keypoints, clicks -> cameras, where better."""

import numpy as np

from courtside.calibration import file_formats
from courtside.calibration.court import court as court_files
from courtside.calibration.court import quality
from courtside.calibration.people import adjustment, knocks, prior, refinement
from courtside.calibration.people.adjustment import Limits
from courtside.calibration.people.held_out import Points
from courtside.calibration.people.views import joined
from courtside.calibration.records import covariance as camera_covariance
from courtside.geometry import camera as camera_models
from courtside.reconstruction import common_views
from courtside.records import tables
from courtside.records.cameras import clicks, knock_table
from courtside.records.devices import clocks
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
    rows = []
    try:
        parts = [seen_of(paths, base, known, take, limits(views), rows) for take in takes]
        told = joined(parts), limits(views), points(paths, base, weights)
        theirs = in_file(paths.calibration, names, override, unit)
        found = refinement.refine(base, known, *told, calibrated=theirs)
    except InputError as error:
        found = refinement.unchanged(base, known, str(error))
    said = [found.line, *found.wrong, *knocks.lines(rows)]
    for line in said:
        log.logger.warning("%s", line)
    report |= {"taken": found.taken, "verdicts": found.verdicts, "wrong": found.wrong}
    report["expected_before_cm"] = expected_cm(paths.court, base, known)
    report["expected_volume_rms_cm"] = expected_cm(paths.court, found.cameras, found.covariance)
    knock_table.write(knocks_csv, rows)
    camera_models.write_toml(cameras_toml, found.cameras, source=f"{calibration}, {found.taken}")
    camera_covariance.write(covariance_npz, found.covariance)
    tables.write(table_csv, found.table, float_format="%.4f")
    write_json(quality_json, {**report, "warnings": said})


def seen_of(paths, base, known, take, limits, rows):
    """Return what cameras see in a take, knocks that are taken undone; add all found to `rows`."""
    seen = common_views.of_take(paths.cameras, [camera.name for camera in base], take)
    found, clock = knocks.find(base, known, seen, limits), clocks.read(take["sync"])[1]
    rows += [{"take": take["take"]} | knocks.row(one, base, clock) for one in found]
    return knocks.undone(base, seen, found)


def limits(views):
    """Return which views count, as for the triangulation."""
    return Limits(views["min_score"], views["max_error_share"], views["fade_share"])


def expected_cm(court_yaml, cameras, covariance):
    """Return the error to expect over a court, cm, by covariances; None without a court."""
    if not court_yaml:
        return None
    grid = quality.volume(court_files.read(court_yaml))
    value, _ = quality.expected_cm(cameras, covariance, grid)
    return round(value, 4) if np.isfinite(value) else None


def in_file(path, names, override, unit):
    """Return the cameras of a calibration file in their own pictures, None of another base."""
    if not path:
        return None
    found = file_formats.rename(file_formats.read(path, unit), names)
    return file_formats.with_principal_points(found, override.get("principal_point_px", {}))


def points(paths, base, weights):
    """Return points at rest and the court's clicks; these are fitted where the base is a file."""
    names, static, court = [camera.name for camera in base], None, None
    if paths.static:
        _, by_camera = clicks.read_static(paths.static, names)
        static = np.stack(list(by_camera))
    if paths.clicks and paths.court:
        lines = court_files.read(paths.court)
        marked = clicks.read(paths.clicks, names, list(lines.points))
        court = adjustment.court_clicks(lines, marked, base, **weights)
    return Points(static, court, fitted=bool(paths.calibration))


if __name__ == "__main__":
    run(main, snakemake)
