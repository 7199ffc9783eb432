"""Tables that the numbers of the documents come from: those that a configuration makes, no older.

A folder of results may hold files of an earlier configuration; Snakemake leaves them there.
"""

from pathlib import Path

from courtside.study import paths
from courtside.study.configuration import configuration, yaml_files
from courtside.study.configuration.sessions import Study
from courtside.study.errors import StrPath
from courtside.study.targets import calibration, devices, takes, together


def made(repository: StrPath) -> frozenset[str]:
    """Return the tables below the results that the repository's default configuration makes."""
    folder = Path(repository) / "config"
    file = folder / "config.yaml"
    study = configuration.load(yaml_files.read(file), str(file), folder, root=Path(repository))
    return frozenset(path.removeprefix(f"{paths.RESULTS}/") for path in every_table(study))


def every_table(study: Study) -> list[str]:
    """Return the tables (CSV) of errors and measures, and those beside figures of the study."""
    drawn = [
        *calibration.every_study_figure(study),
        *together.every_players_figure(study),
        *devices.every_device_figure(study),
    ]
    return [
        *(path for path in drawn if path.endswith(".csv")),
        *[paths.NETWORK_ERRORS] * bool(together.evaluated_takes(study)),
        *calibration.every_evaluation(study),
        *takes.evaluations(study, "errors"),
        *takes.evaluations(study, "kinematics"),
        *takes.every_comparison_of_views(study),
        *_of_named_takes(study),
        *devices.every_body_frame(study),
        *devices.every_true_file(study, paths.SOURCE_ERRORS),
    ]


def _of_named_takes(study: Study) -> list[str]:
    """Return the tables behind table 1, and behind the figure of two, three and all cameras."""
    found = []
    for session, take in study.named_takes(study.parameters["evaluate_round_trip"]["takes"]):
        found += takes.files(paths.ROUND_TRIP, session, take)
    for session, take in study.named_takes(study.parameters["draw_three_cameras"]["takes"]):
        compared = session.fusions_of(take, "compared_fusions")
        found += takes.files(paths.MEASURE_ERRORS, session, take, fusion=compared)
    return found
