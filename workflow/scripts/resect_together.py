"""Calibrate all fixed cameras together from points at known places alone.

Reads clicked court points, or points with your own coordinates. Writes cameras, their covariance
and quality.
"""

from courtside.calibration.court import place_checks, points_alone, quality
from courtside.calibration.records import covariance as camera_covariance
from courtside.geometry import camera as camera_models
from courtside.study.errors import about
from courtside.study.execution import log
from courtside.study.execution.files import write_json
from courtside.study.execution.script import run
from courtside.video import reader


def main(
    clicks_csv,
    court_yaml,
    pictures,
    cameras_toml,
    covariance_npz,
    quality_json,
    *,
    cameras,
    placed,
    calibration,
    step,
):
    court, marked = place_checks.read(clicks_csv, court_yaml, cameras, placed)
    sizes = {name: reader.picture_size(path) for name, path in zip(cameras, pictures, strict=True)}
    with about(clicks_csv):
        found = points_alone.calibrate(court, marked, sizes, **step)
    for warning in found.warnings:
        log.logger.warning("%s", warning)
    covariance = found.solution.named
    report = {"calibration": calibration, **points_alone.summary(found)}
    report |= quality.expected_volume(court, found.solution.cameras, covariance)
    report["left_out"] = quality.leave_one_out_errors(court, found.solution.cameras, marked)[1]
    camera_models.write_toml(cameras_toml, found.solution.cameras, source=calibration)
    camera_covariance.write(covariance_npz, covariance)
    write_json(quality_json, report)


if __name__ == "__main__":
    run(main, snakemake)
