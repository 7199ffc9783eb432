"""Calibrate all fixed cameras with a wand: markers in the pictures -> cameras, covariance."""

from functools import partial

import cv2

from courtside.calibration import file_formats
from courtside.calibration.court import place_checks
from courtside.calibration.court import quality as court_quality
from courtside.calibration.people import adjustment as clicked
from courtside.calibration.records import covariance as camera_covariance
from courtside.calibration.wand import calibration, points, quality
from courtside.geometry import camera as cameras
from courtside.study.errors import about
from courtside.study.execution import log
from courtside.study.execution.files import write_json
from courtside.study.execution.script import run
from courtside.video import reader


def main(paths, cameras_toml, covariance_npz, quality_json, *, given, names, placed, weights):
    cv2.setNumThreads(1)  # with several, the order of sums changes
    wand = points.Wand.of(given)
    lenses = file_formats.known_lenses(given.get("lenses"), names, paths.lens_tomls)
    sizes = {name: lens.size for name, lens in lenses.items()}
    for name, path in zip(names, paths.pictures, strict=bool(paths.pictures)):
        size = reader.picture_size(path)
        if name in lenses:
            cameras.check_size(lenses[name], size, f"wand, picture of camera {name}")
        sizes[name] = size
    seen = points.read(given, wand, names, sizes)
    court, clicks = None, None
    if paths.clicks_csv:
        files = paths.clicks_csv, paths.court_yaml
        court, marked = place_checks.read(*files, list(names), placed)
        clicks = partial(clicked.court_clicks, court, marked, **weights)
    floor = calibration.Floor.of(given)
    of_boards = [] if "lenses" in given else list(lenses)
    world = {"floor": floor, "clicks": clicks}
    found = calibration.calibrate(wand, seen, sizes, lenses=lenses, of_boards=of_boards, **world)
    report = quality.summary(found, wand, seen, set(lenses))
    if court is not None:
        with about(paths.clicks_csv):
            report["warnings"] += place_checks.check_cameras(court, found.cameras, marked)
    for warning in report["warnings"]:
        log.logger.warning("%s", warning)
    if court is not None:
        report |= court_quality.expected_volume(court, found.cameras, found.covariance)
    cameras.write_toml(cameras_toml, found.cameras, source=f"wand, {len(seen.frames)} frames")
    camera_covariance.write(covariance_npz, found.covariance)
    write_json(quality_json, report)


if __name__ == "__main__":
    run(main, snakemake)
