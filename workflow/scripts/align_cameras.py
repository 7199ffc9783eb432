"""Align a model with the court by a similarity: ties, clicks -> cameras.

The similarity is the paper's or that of all points.
"""

from courtside.calibration.court import court as court_files
from courtside.calibration.court import quality, sfm_alignment
from courtside.calibration.records import tie_points
from courtside.geometry import camera as camera_models
from courtside.records.cameras import clicks
from courtside.study.errors import InputError
from courtside.study.execution import log
from courtside.study.execution.files import write_json
from courtside.study.execution.script import run
from courtside.study.methods import Calibration


def main(ties_npz, clicks_csv, court_yaml, cameras_toml, quality_json, *, calibration, **options):
    record = tie_points.read(ties_npz)
    if record.outcome:
        raise InputError(record.outcome)
    court = court_files.read(court_yaml)
    marked = clicks.read(clicks_csv, [c.name for c in record.sfm_cameras], list(court.points))
    xyz_in_sfm = sfm_alignment.reconstruct(record.sfm_cameras, marked)
    try:
        world_from_sfm, how = align(court, xyz_in_sfm, calibration)
    except InputError as error:  # a doubtful map says nothing about clicks
        raise InputError(
            quality.map_warning(record.support) or record.fault or str(error)
        ) from error
    found = [world_from_sfm.camera(camera) for camera in record.sfm_cameras]
    report = {
        "calibration": calibration,
        "scale": world_from_sfm.scale,
        **how,
        "misfit_cm": round(100 * sfm_alignment.misfit_m(court, world_from_sfm, xyz_in_sfm), 2),
        "warnings": warnings_of(court, record, marked, **options),
        "left_out": quality.leave_one_out_errors(court, found, marked)[1],
    }
    log.logger.info("warnings: %s", report["warnings"] or "none")
    camera_models.write_toml(cameras_toml, found, source=calibration)
    write_json(quality_json, report)


def align(court, xyz_in_sfm, calibration):
    """Return the similarity from a model to the court, and its uncertainty."""
    if Calibration.parse(calibration).kind == "paper":
        world_from_sfm, skew_deg = sfm_alignment.paper_frame(court, xyz_in_sfm)
        return world_from_sfm, {"skew_deg": skew_deg}
    world_from_sfm, accepted = sfm_alignment.align(court, xyz_in_sfm)
    return world_from_sfm, {"n_points": int(accepted.sum())}


def warnings_of(court, record, marked, **options):
    """Return warnings on map, clicks and court; the remaining bend of this model is no fault."""
    if warning := quality.map_warning(record.support):
        return [warning]
    try:
        if record.fault:
            raise InputError(record.fault)
        return quality.adjust_and_check(court, record.ties, marked, **options)[1]["warnings"]
    except InputError as error:
        return [str(error)]


if __name__ == "__main__":
    run(main, snakemake)
