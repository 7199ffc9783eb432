"""Import a calibration made elsewhere: its file -> the session's cameras, as their videos show."""

from courtside.calibration import file_formats
from courtside.calibration.court import court, quality
from courtside.calibration.file_check import stated
from courtside.calibration.records import covariance as camera_covariance
from courtside.geometry import camera
from courtside.study.execution.files import write_json
from courtside.study.execution.script import run


def main(
    calibration_path,
    cameras_toml,
    quality_json,
    *,
    names,
    crops_px,
    scales,
    override,
    covariance_npz="",
    court_yaml="",
    unit=None,
):
    in_file = file_formats.read(calibration_path, unit)
    theirs = file_formats.rename(calibration_path, in_file, names)
    file_formats.check_apart(calibration_path, theirs, unit)
    points_px = override.get("principal_point_px", {})
    found = file_formats.with_principal_points(theirs, points_px)
    stated.check(calibration_path, found)
    source = f"imported from {calibration_path}"
    if points_px:
        source += f", principal points of {', '.join(points_px)} replaced: {override['reason']}"
    cropped = [camera.crop(c, crops_px[c.name]) if c.name in crops_px else c for c in found]
    cropped = [camera.scaled(c, scales[c.name]) if c.name in scales else c for c in cropped]
    camera.write_toml(cameras_toml, cropped, source=source)
    report = {
        "source": str(calibration_path),
        "cameras": {c.name: {"size_px": list(map(int, c.size))} for c in cropped},
        "covariance": covariance_npz or "unknown: the file gives none",
    }
    if covariance_npz and court_yaml:
        known = camera_covariance.read(covariance_npz)
        report |= quality.expected_volume(court.read(court_yaml), cropped, known)
    if points_px:
        replaced = {c.name: c.K[:2, 2].tolist() for c in theirs if c.name in points_px}
        report["override"] = {**override, "principal_point_px_in_file": replaced}
    write_json(quality_json, report)


if __name__ == "__main__":
    run(main, snakemake)
