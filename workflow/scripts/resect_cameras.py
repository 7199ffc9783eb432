"""Calibrate each fixed camera from known court points alone.

Reads clicked points and lenses; writes cameras and quality.
"""

from courtside.calibration.court import court as court_files
from courtside.calibration.court import joint_adjustment, known_points, quality
from courtside.geometry import camera as camera_models
from courtside.records.cameras import clicks
from courtside.study.execution import log
from courtside.study.execution.files import write_json
from courtside.study.execution.script import run
from courtside.video import images


def main(
    clicks_csv,
    court_yaml,
    static_png,
    lens_toml,
    cameras_toml,
    quality_json,
    *,
    cameras,
    calibration,
    step,
):
    court = court_files.read(court_yaml)
    click_sigma_px = step["click_sigma_px"]
    marked = clicks.read(clicks_csv, cameras, list(court.points))
    pictures = dict(zip(cameras, static_png, strict=True))
    sizes = {camera: images.read(path).shape[1::-1] for camera, path in pictures.items()}
    lens_of = dict(zip(cameras, lens_toml, strict=False))
    lenses = {camera: camera_models.read_toml(path)[0] for camera, path in lens_of.items()}
    for camera, lens in lenses.items():
        camera_models.check_size(lens, sizes[camera], pictures[camera])
    way = known_points.method(calibration, court)
    results = known_points.calibrate(
        way, court, marked, sizes, lenses, click_sigma_px=click_sigma_px
    )
    for result in results.values():
        if way.linear and result.reason:
            log.logger.warning("%s", result.reason)
    found = known_points.cameras(results)
    sigma_px = joint_adjustment.click_sigmas(click_sigma_px, found)
    report = {
        "calibration": calibration,
        "rms_px": {camera: round(result.rms_px, 4) for camera, result in results.items()},
        "degenerate": {c: r.reason for c, r in results.items() if way.linear and r.reason},
        **quality.check_cameras(
            court, found, marked, click_sigma_px=sigma_px, strict=not way.linear
        ),
    }
    camera_models.write_toml(cameras_toml, found, source=calibration)
    write_json(quality_json, report)


if __name__ == "__main__":
    run(main, snakemake)
