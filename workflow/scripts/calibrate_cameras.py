"""Calibrate fixed cameras in the court's frame: ties, clicks, lines -> cameras, covariance."""

from courtside.calibration import arrangement
from courtside.calibration.court import court as court_files
from courtside.calibration.court import joint_adjustment, quality
from courtside.calibration.court_lines import walk_and_lines
from courtside.calibration.records import covariance as camera_covariance
from courtside.calibration.records import tie_points
from courtside.geometry import camera as camera_models
from courtside.geometry import camera_fields
from courtside.records.cameras import clicks, image_names
from courtside.study.errors import InputError
from courtside.study.execution import log
from courtside.study.execution.files import write_json
from courtside.study.execution.script import run
from courtside.video import images


def main(
    ties_npz,
    clicks_csv,
    court_yaml,
    cameras_toml,
    covariance_npz,
    quality_json,
    *,
    calibration,
    pictures=(),
    **options,
):
    record = tie_points.read(ties_npz)
    found, checked = calibrate(record, clicks_csv, court_yaml, pictures=pictures, **options)
    names = list(record.ties.cameras)
    report = {
        "calibration": calibration,
        "tie_residual_px": round(record.residual_px, 4),
        "n_images": len(record.images),
        "n_maps_agreeing": record.n_maps[0],
        "n_maps": record.n_maps[1],
        "explained": record.support._asdict(),
        "n_points_seen": dict(zip(names, map(int, record.n_points_seen), strict=True)),
        **checked,
    }
    log.logger.info("warnings: %s", report["warnings"] or "none")
    unit = "m" if court_yaml else camera_fields.UNSCALED
    camera_models.write_toml(cameras_toml, found.cameras, source=calibration, unit=unit)
    camera_covariance.write(covariance_npz, found.named)
    write_json(quality_json, report)


def calibrate(record, clicks_csv, court_yaml, **options):
    """Return the result of `solve`; a doubtful map gives no warnings on clicks, court or names."""
    doubtful_map = quality.map_warning(record.support)
    if record.outcome:
        raise InputError(record.outcome)
    at = dict(zip(record.images, record.centres, strict=True))
    fixed = {c.name: at[image_names.static(c.name)] for c in record.sfm_cameras}
    one_place = quality.one_place(fixed, record.centres)
    try:
        if record.fault:
            raise InputError(record.fault)
        found, checked = solve(record, clicks_csv, court_yaml, **options)
    except InputError as error:
        raise InputError(
            doubtful_map or "; ".join(filter(None, [str(error), one_place]))
        ) from error
    if doubtful_map:
        checked["warnings"] = [doubtful_map] if court_yaml else [*checked["warnings"], doubtful_map]
    checked["warnings"] += [one_place] * bool(one_place)
    return found, checked


def solve(record, clicks_csv, court_yaml, *, pictures, search=None, **options):
    if not court_yaml:
        found = joint_adjustment.free(record.ties)
        expected = arrangement.expected(found.cameras, found.named)
        return found, quality.check_maps(*record.n_maps) | expected
    court = court_files.read(court_yaml)
    marked = clicks.read(clicks_csv, list(record.ties.cameras), list(court.points))
    if pictures:
        shown = dict(zip(record.ties.cameras, map(images.read, pictures), strict=True))
        found, checked = walk_and_lines.adjust_and_check(
            court, record.ties, marked, shown, search, **options
        )
    else:
        found, checked = quality.adjust_and_check(court, record.ties, marked, **options)
    sunken = quality.sunken(court, record.xyz)
    checked["warnings"] += [sunken] * bool(sunken)
    strained = quality.strained(record.strain)
    checked["warnings"] += [strained] * bool(strained)
    return found, checked


if __name__ == "__main__":
    run(main, snakemake)
