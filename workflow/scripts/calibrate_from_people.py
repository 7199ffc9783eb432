"""Calibrate fixed cameras from the people that they film: keypoints, heights -> cameras."""

from courtside.calibration.people import from_nothing
from courtside.calibration.people.adjustment import Limits
from courtside.calibration.records import covariance as camera_covariance
from courtside.geometry import camera as camera_models
from courtside.reconstruction import self_calibration
from courtside.records.devices import clocks
from courtside.records.keypoints import keypoints
from courtside.study.errors import InputError
from courtside.study.execution import log
from courtside.study.execution.files import write_json
from courtside.study.execution.script import run
from courtside.synchronisation import cameras as camera_sync


def main(paths, cameras_toml, covariance_npz, quality_json, *, names, takes, clock_step, views):
    lenses = {
        lens.name: lens for path in paths.lens_tomls for lens in camera_models.read_toml(path)
    }
    filmed = [[keypoints.read_2d(path) for path in take["pose2d"]] for take in takes]
    heights_m = [take["heights_m"] for take in takes]
    limits = Limits.of(views)

    def timed(cameras):
        """Return of each take its name, keypoints and clocks, by cameras where they are known."""
        return [
            (take["take"], each, clocks_of(take, each, cameras, clock_step))
            for take, each in zip(takes, filmed, strict=True)
        ]

    first = self_calibration.guess(names, lenses, timed(None), heights_m)
    known = {camera.name: camera for camera in first.cameras}
    seen = self_calibration.seen(first, timed(known))
    of = [take for take, _ in first.tracks]
    found = from_nothing.adjust(first.cameras, lenses, seen, of, heights_m, limits)
    camera_models.write_toml(cameras_toml, found.cameras, source="people alone")
    camera_covariance.write(covariance_npz, found.covariance)
    report = from_nothing.said(found, [take["take"] for take in takes])
    log.logger.info("%s", report["line"])
    write_json(quality_json, report)


def clocks_of(take, seen, cameras, step):
    """Return the clocks of a take's cameras, by name; they must be sure."""
    if take["synchronised"]:
        return clocks.one_clock([view.camera for view in seen])
    known = cameras and [cameras[view.camera] for view in seen]
    found = camera_sync.synchronise(seen, known, **step) | clocks.stated(take["clocks"])
    if cameras and (fault := clocks.fault_line(f"take {take['take']}", found)):
        raise InputError(fault)
    return found


if __name__ == "__main__":
    run(main, snakemake)
