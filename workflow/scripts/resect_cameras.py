"""Calibrate each fixed camera from known court points alone: clicked points, lenses -> cameras, quality."""

import cv2

from courtside.calibration.court import court as courts
from courtside.calibration.court import joint_adjustment, known_points, quality
from courtside.geometry import camera as camera_models
from courtside.records.cameras import clicks
from courtside.study.execution import log
from courtside.study.execution.files import write_json


def main(
    clicks_csv,
    court_yaml,
    static_png,
    lens_toml,
    cameras_toml,
    quality_json,
    *,
    name,
    click_sigma_px,
):
    court = courts.read(court_yaml)
    marked = clicks.read(clicks_csv, list(static_png), list(court.points))
    sizes = {camera: cv2.imread(str(path)).shape[1::-1] for camera, path in static_png.items()}
    lenses = {camera: camera_models.read_toml(path)[0] for camera, path in lens_toml.items()}
    way = known_points.method(name, court)
    results = known_points.calibrate(
        way, court, marked, sizes, lenses, click_sigma_px=click_sigma_px
    )
    for result in results.values():
        if way.linear and result.degenerate:
            log.logger.warning("%s", result.reason)
    found = known_points.cameras(results)
    sigma_px = joint_adjustment.largest_click_sigma(click_sigma_px, found)
    report = {
        "calibration": name,
        "rms_px": {camera: round(result.rms_px, 4) for camera, result in results.items()},
        "degenerate": {c: r.reason for c, r in results.items() if way.linear and r.degenerate},
        **quality.of_court(court, found, marked, click_sigma_px=sigma_px, strict=not way.linear),
    }
    camera_models.write_toml(cameras_toml, found, source=name)
    write_json(quality_json, report)


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    cameras = snakemake.params.cameras
    main(
        snakemake.input.clicks,
        snakemake.input.court,
        dict(zip(cameras, snakemake.input.static, strict=True)),
        dict(zip(cameras, snakemake.input.lenses, strict=False)),
        snakemake.output.cameras,
        snakemake.output.quality,
        name=snakemake.wildcards.calibration,
        click_sigma_px=snakemake.params.step["click_sigma_px"],
    )
