"""Calibrate all fixed cameras from a board: pictures, videos or corners -> cameras, covariance."""

import cv2

from courtside.calibration import file_formats
from courtside.calibration.boards import adjustment, corners, quality
from courtside.calibration.boards.board import Board
from courtside.calibration.records import covariance as camera_covariance
from courtside.geometry import camera as cameras
from courtside.study.execution import log
from courtside.study.execution.files import write_json
from courtside.study.execution.script import run
from courtside.video import reader


def main(paths, cameras_toml, covariance_npz, quality_json, *, given, names):
    cv2.setNumThreads(1)  # of several, sums depend on which ends first
    board = Board.of(given)
    seen = found_in(given, names, board)
    lenses = file_formats.known_lenses(given.get("lenses"), names, paths.lens_tomls)
    sizes = seen.sizes or {name: lens.size for name, lens in lenses.items()}
    sizes = sizes or {
        name: reader.picture_size(path) for name, path in zip(names, paths.pictures, strict=True)
    }
    for name, lens in lenses.items():
        cameras.check_size(lens, sizes[name], f"board of camera {name}")
    floor = None if given.get("floor") is None else str(given["floor"])
    found = adjustment.calibrate(board, seen, sizes, lenses=lenses or None, floor=floor)
    report = quality.summary(found, seen, board, known=bool(lenses))
    for warning in report["warnings"]:
        log.logger.warning("%s", warning)
    cameras.write_toml(cameras_toml, found.cameras, source=f"board, {len(seen.pictures)} places")
    camera_covariance.write(covariance_npz, found.covariance)
    write_json(quality_json, report)


def found_in(given, names, board):
    """Return the corners of the board, from whichever source the session names."""
    if "corners" in given:
        return corners.of_table(given["corners"], names, board)
    if "images" in given:
        return corners.of_pictures({name: given["images"][name] for name in names}, board)
    videos = {name: given["videos"][name] for name in names}
    return corners.of_videos(videos, board, every_s=given.get("every_s", 0.5))


if __name__ == "__main__":
    run(main, snakemake)
