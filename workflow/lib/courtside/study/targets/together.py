"""What the study makes of several takes: the figures and tables that draw or compare them."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

from courtside.study import paths
from courtside.study.configuration import consent
from courtside.study.configuration.sessions import Study
from courtside.study.execution.verdicts import WAY
from courtside.study.methods import IMPORTED
from courtside.study.targets import takes

STROKE_FIGURES = ("badminton_fig09", "badminton_fig10", "badminton_fig11")


@dataclass(frozen=True)
class MeasuredTake:
    """A take measured with one calibration and one network."""

    measures: str  # the file of its summary of measures
    pose3d: str  # the file of the skeletons that were measured
    labels: dict[str, str]  # session, take, calibration and model
    fusion: str

    @property
    def joint_labels(self) -> dict[str, str]:
        """Its labels without the network."""
        return {key: value for key, value in self.labels.items() if key != "model"}


@dataclass(frozen=True)
class EvaluatedTake:
    """A take in which one network is compared with the truth, or with imported keypoints."""

    errors: str  # the file of its errors in the pictures
    pose3d: str | None  # of its raw skeletons; None where these are not compared
    labels: dict[str, str]  # session, take, against (truth, or imported keypoints) and model


def every_players_figure(study: Study) -> list[str]:
    """Return the figures that takes are drawn in together, and the tables of players."""
    stems = []
    for session, take in study.named_takes(study.parameters["evaluate_round_trip"]["takes"]):
        stems += takes.files(paths.CALIBRATED_FIGURE, session, take, figure="badminton_tab01")
    for session, take in study.named_takes(study.parameters["draw_stroke"]["takes"]):
        names = takes.allowed_figures(session, take, STROKE_FIGURES)
        model = session.parameters["models"][0]
        stems += takes.files(paths.TAKE_FIGURE, session, take, model=model, figure=names)
    stems += [paths.STUDY_FIGURE.format(figure="badminton_fig05")] if fig05_layouts(study) else []
    for session, take in study.named_takes(study.parameters["draw_three_cameras"]["takes"]):
        known = {"figure": "three_cameras", "model": session.parameters["models"][0]}
        stems += takes.files(paths.CALIBRATED_FIGURE, session, take, **known)
    there = {
        "clock_errors": takes.evaluations(study, "clocks"),
        "reliability": takes.evaluations(study, "reliability"),
        "agreement": compared_takes(study),
        "archive": archived_takes(study),
        "networks": evaluated_takes(study),
    }
    stems += [paths.STUDY_FIGURE.format(figure=name) for name, found in there.items() if found]
    tables = [paths.PLAYERS_TABLE, paths.ANGLES_TABLE]
    return paths.formats(stems) + tables * bool(takes.evaluations(study, "errors"))


def every_network_table(study: Study) -> list[str]:
    """Return the tables that the figures of compared networks are drawn from."""
    tables = [paths.NETWORK_PAIRS, paths.NETWORK_AGREEMENT] * bool(compared_takes(study))
    return tables + [paths.NETWORK_ERRORS] * bool(evaluated_takes(study))


def fig05_layouts(study: Study) -> dict[str, list]:
    """Return session, take and cameras of each layout of fig 5 that the study has and may show."""
    wanted = study.parameters["draw_badminton_fig05"]["layouts"]
    return {
        layout: [session.name, take.name, place["cameras"]]
        for layout, place in wanted.items()
        for session, take in study.named_takes([place["take"]])
        if not consent.refusing(session, take, "pictures")
    }


def measured_takes(
    study: Study, sessions: Iterable[str], models: Sequence[str] | None = None
) -> list[MeasuredTake]:
    """Return every take of some sessions, with its first calibration and each of some networks.

    Without `models` with the first network of its session. A take that is measured with two
    calibrations is one repeat. Takes whose views are not fused are left out.
    """
    found = []
    for session in (study.sessions[name] for name in sessions if name in study.sessions):
        own = session.parameters["models"][:1] if models is None else models
        for take, way, model in product(session.takes, session.take_calibrations()[:1], own):
            labels = {"session": session.name, "take": take, "calibration": way, "model": model}
            for fusion in session.fusions_of(session.takes[take])[:1]:
                known = {**labels, "fusion": fusion}
                measures = paths.MEASURES.format(**known)
                pose3d = paths.SKELETONS.format(stage=study.stages(model)[-1], **known)
                found.append(MeasuredTake(measures, pose3d, labels, fusion))
    return found


def every_study_table(study: Study) -> list[str]:
    """Return the table of the study; none where nothing is measured."""
    return [paths.STUDY_TABLE] if tabulated_takes(study) else []


def tabulated_takes(study: Study) -> list[dict[str, Any]]:
    """Return what the table of the study has of each take and way of measuring it.

    `labels` are session, take and way; `measures_csv` are of the motion and, with
    `camera_errors` False, of the feet; `quality_csv` is None of other programs' skeletons, whose
    feet are not looked at; `provenance` is the record of the measures below the folder of results.
    """
    found = []
    for session, take in study.takes():
        fusions, models = session.fusions_of(take), session.parameters["models"]
        ways = dict.fromkeys(product([IMPORTED], ["trc"], take.pose3d), False)
        ways |= dict.fromkeys(product(session.take_calibrations(), fusions, models), True)
        for way, own in ways.items():
            labels = {"session": session.name, "take": take.name}
            labels |= dict(zip(WAY, way, strict=True))
            judged = takes.verdicts(session, take) if own else []
            kinds = [(paths.MEASURES, True)] + [(paths.FOOTWORK_MEASURES, False)] * own
            for pattern, camera_errors in kinds:
                measures = pattern.format(**labels)
                below = measures.removeprefix(f"{paths.RESULTS}/")
                found.append(
                    {
                        "labels": labels,
                        "measures_csv": measures,
                        "camera_errors": camera_errors,
                        "quality_csv": next(iter(judged), None),
                        "provenance": paths.SIDECAR.format(file=below),
                    }
                )
    return found


def compared_takes(study: Study) -> list[MeasuredTake]:
    """Return the takes in which two networks are compared."""
    step = study.parameters["compare_networks"]
    rows = measured_takes(study, step["sessions"], step["networks"])
    begins = tuple(step["takes"] or [""])
    return [row for row in rows if row.labels["take"].startswith(begins)]


def evaluated_takes(study: Study) -> list[EvaluatedTake]:
    """Return the takes in which networks are evaluated, with each of them."""
    step, found = study.parameters["evaluate_networks"], []
    for session, take in study.named_takes(step["takes"]):
        labels = {"session": session.name, "take": take.name}
        labels["against"] = step["takes"][f"{session.name}/{take.name}"] or "truth"
        ways = product(session.take_calibrations(), session.fusions_of(take))
        first = next(ways, None) if session.virtual else None
        for model in step["networks"]:
            known, pose3d = {**labels, "model": model}, None
            if first and model in step["skeletons"]:
                way = {"calibration": first[0], "fusion": first[1]}
                pose3d = paths.POSE3D.format(**known, **way)
            errors = paths.DETECTION_ERRORS.format(**known)
            found.append(EvaluatedTake(errors, pose3d, known))
    return found


def archived_takes(study: Study) -> list[MeasuredTake]:
    """Return the takes of a subject that are compared over sessions."""
    step = study.parameters["compare_sessions"]
    rows = measured_takes(study, step["sessions"])
    named = [row for row in rows if row.labels["take"].startswith(tuple(step["takes"]))]
    of = {(session.name, take.name): take.subjects for session, take in study.takes()}
    return [r for r in named if step["subject"] in of[r.labels["session"], r.labels["take"]]]
