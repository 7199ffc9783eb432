"""Tables that the numbers of the documents come from: those that a configuration makes, no older.

A folder of results may hold files of an earlier configuration; Snakemake leaves them there.
"""

from courtside.study import paths
from courtside.study.configuration.sessions import Study
from courtside.study.targets import calibration, devices, takes, together


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
        *(p for one in devices.device_takes(study) for p in one.true_file(paths.SOURCE_ERRORS)),
    ]


def _of_named_takes(study: Study) -> list[str]:
    """Return the tables behind table 1, and behind the figure of two, three and all cameras."""
    found = []
    for session, take in study.named_takes(study.parameters["evaluate_round_trip"]["takes"]):
        found += takes.files(paths.ROUND_TRIP, session, take)
    for session, take in study.named_takes(study.parameters["draw_three_cameras"]["takes"]):
        compared = session.fusions("compared_fusions")
        found += takes.files(paths.MEASURE_ERRORS, session, take, fusion=compared)
    return found
