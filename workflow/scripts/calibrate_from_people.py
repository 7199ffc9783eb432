"""Calibrate fixed cameras from people alone: keypoints, heights or known lengths -> cameras."""

from courtside.calibration import file_formats
from courtside.calibration.people import from_nothing, metric_scale
from courtside.calibration.people.views import Limits
from courtside.calibration.records import covariance as camera_covariance
from courtside.geometry import camera as camera_models
from courtside.reconstruction import joint_correction, self_calibration
from courtside.records.cameras import clicks
from courtside.records.keypoints import keypoints
from courtside.study.execution import log
from courtside.study.execution.files import write_json
from courtside.study.execution.script import run
from courtside.synchronisation.cameras import of_take as clocks_of


def main(
    paths, cameras_toml, covariance_npz, quality_json, *, names, takes, known_lengths, **steps
):
    lenses = file_formats.known_lenses(None, {}, paths.lens_tomls)
    filmed = [[keypoints.read_2d(path) for path in take["pose2d"]] for take in takes]
    heights_m, known = {take["take"]: take["heights_m"] for take in takes}, []
    if known_lengths:
        weights = {key: steps["clicks"][key] for key in ("click_sigma_px", "click_bias_px")}
        points, xy = clicks.read_static(paths.static, names)
        known = metric_scale.of_clicks(known_lengths, points, xy, **weights)

    def timed(cameras):
        """Return the name, keypoints and clocks of each take; clocks by cameras if known."""
        return [
            (take["take"], each, clocks_of(each, cameras, **take["timing"], **steps["clock_step"]))
            for take, each in zip(takes, filmed, strict=True)
        ]

    limits = Limits.of(steps["views"])
    offsets = joint_correction.read(paths.offsets) if paths.offsets else None
    found = self_calibration.calibrate(names, lenses, timed, heights_m, limits, known, offsets)
    camera_models.write_toml(cameras_toml, found.cameras, source="people alone")
    camera_covariance.write(covariance_npz, found.covariance)
    report = from_nothing.summary(found, [take["take"] for take in takes])
    log.logger.info("%s", report["line"])
    for warning in report["warnings"]:
        log.logger.warning("%s", warning)
    write_json(quality_json, report)


if __name__ == "__main__":
    run(main, snakemake)
