"""Calibrate the fixed cameras in the court's frame: ties, clicked court points -> cameras, covariance, quality."""

import json

from courtside.geometry import cameras as camera_models
from courtside.geometry import court_adjustment, courts, quality
from courtside.records import camera_covariance, clicks, ties
from courtside.study import log
from courtside.study.errors import InputError
from courtside.study.files import atomic


def main(ties_npz, clicks_csv, court_yaml, cameras_toml, covariance_npz, quality_json, *, name, **options):
    record = ties.read(ties_npz)
    if record.outcome or record.fault:
        raise InputError(record.outcome or record.fault)
    court = courts.read(court_yaml)
    names = list(record.ties.cameras)
    marked = clicks.read(clicks_csv, names, list(court.points))
    found = court_adjustment.solve(record.ties, marked, court, max_iterations=30, **options)
    report = {
        "calibration": name,
        "tie_residual_px": round(record.residual_px, 4),
        "n_images": len(record.images),
        "n_points_seen": dict(zip(names, map(int, record.n_points_seen), strict=True)),
        **quality.of_court(
            court,
            found.cameras,
            marked,
            click_sigma_px=court_adjustment.largest_click_sigma(options["click_sigma_px"], found.cameras),
            point_covariance=found.point_covariance,
        ),
    }
    for warning in report["warnings"]:
        log.logger.warning("%s", warning)
    camera_models.write_toml(cameras_toml, found.cameras, source=name)
    covariance = camera_covariance.of_network(names, found.covariance)
    camera_covariance.write(covariance_npz, covariance)
    with atomic(quality_json) as temporary:
        temporary.write_text(json.dumps(report, indent=1) + "\n")


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(
        snakemake.input.ties,
        snakemake.input.clicks,
        snakemake.input.court,
        snakemake.output.cameras,
        snakemake.output.covariance,
        snakemake.output.quality,
        name=snakemake.wildcards.calibration,
        **snakemake.params.step,
    )
