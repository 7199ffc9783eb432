"""Calibrate all fixed cameras together from points at known places alone.

Reads clicked court points, or points with places of their own; writes cameras, covariance, quality.
"""

from courtside.calibration.court import court as court_files
from courtside.calibration.court import place_checks, points_alone, quality
from courtside.calibration.records import covariance as camera_covariance
from courtside.geometry import camera as camera_models
from courtside.records.cameras import clicks, placed_points
from courtside.study.errors import InputError
from courtside.study.execution import log
from courtside.study.execution.files import write_json
from courtside.study.execution.script import run
from courtside.video import images, reader


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
    court, marked = known_points(clicks_csv, court_yaml, cameras, placed)
    sizes = {name: size(path) for name, path in zip(cameras, pictures, strict=True)}
    found = points_alone.calibrate(court, marked, sizes, **step)
    for warning in found.warnings:
        log.logger.warning("%s", warning)
    covariance = camera_covariance.of_network(cameras, found.solution.covariance)
    report = {"calibration": calibration, **points_alone.said(found)}
    report |= volume(court, found.solution.cameras, covariance)
    report["left_out"] = quality.leave_one_out_errors(court, found.solution.cameras, marked)[1]
    camera_models.write_toml(cameras_toml, found.solution.cameras, source=calibration)
    camera_covariance.write(covariance_npz, covariance)
    write_json(quality_json, report)


def known_points(clicks_csv, court_yaml, cameras, placed):
    """Return the court and the clicks; of points with places of their own, these as a court."""
    if not placed:
        court = court_files.read(court_yaml)
        return court, clicks.read(clicks_csv, cameras, list(court.points))
    placed = placed_points.read(clicks_csv, cameras)
    if wrong := place_checks.shifts(placed):
        raise InputError(*(f"{clicks_csv}: {one}" for one in wrong))
    return court_files.of_places("points", placed.points, placed.xyz), placed.clicks


def size(path):
    """Return width and height of a picture or video, px."""
    if str(path).endswith(".png"):
        return images.read(path).shape[1::-1]
    return reader.probe(path).size


def volume(court, found, covariance):
    grid = quality.volume(court)
    if not len(court.lines_m):  # places of their own: their frame begins anywhere
        grid[:, :2] += court.xyz[:, :2].min(axis=0)
    expected_cm, share = quality.expected_cm(found, covariance, grid)
    return {"expected_volume_rms_cm": round(expected_cm, 4), "volume_seen": round(share, 4)}


if __name__ == "__main__":
    run(main, snakemake)
