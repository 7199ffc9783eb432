"""Import a calibration made elsewhere: its file -> the session's cameras, as their videos show."""

from courtside.calibration import file_formats
from courtside.geometry import camera
from courtside.study.execution.files import write_json
from courtside.study.execution.script import run


def main(calibration_path, cameras_toml, quality_json, *, names, crops_px):
    found = file_formats.rename(file_formats.read(calibration_path), names)
    found = [camera.crop(c, crops_px[c.name]) if c.name in crops_px else c for c in found]
    camera.write_toml(cameras_toml, found, source=f"imported from {calibration_path}")
    quality = {
        "source": str(calibration_path),
        "cameras": {c.name: {"size_px": list(map(int, c.size))} for c in found},
        "covariance": "unknown: the file gives none",
    }
    write_json(quality_json, quality)


if __name__ == "__main__":
    run(main, snakemake)
