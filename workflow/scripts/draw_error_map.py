"""Draw the error to expect over the court: cameras, covariance, court -> figure, CSV.

Of cameras refined by people, the error before and after.
"""

from courtside.calibration.court import court as court_files
from courtside.calibration.people import prior
from courtside.calibration.records import covariance as camera_covariance
from courtside.figures.calibration import error_map
from courtside.figures.style import style
from courtside.geometry import camera
from courtside.study.execution.script import run


def main(
    cameras_toml,
    covariance_npz,
    court_yaml,
    pdf,
    png,
    csv,
    *,
    session,
    calibration,
    heights_m,
    stated,
    base_toml=None,
    base_npz=None,
):
    found, court = camera.read_toml(cameras_toml), court_files.read(court_yaml)
    covariance = camera_covariance.read(covariance_npz)
    rows = error_map.table(found, covariance, court, heights_m)
    if base_toml:
        base = camera.read_toml(base_toml)
        known = camera_covariance.read(base_npz) if base_npz else prior.stated(base, **stated)
        rows = error_map.compared(rows, error_map.table(base, known, court, heights_m))
    title = f"{session}, calibration {calibration}"
    style.save(error_map.draw(rows, found, court, title), rows, pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
