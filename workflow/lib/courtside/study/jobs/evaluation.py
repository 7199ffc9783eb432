"""Truth of virtual sessions and takes, what is compared with it, and the labels of errors."""

from collections.abc import Iterable, Mapping
from typing import Any

from courtside.study import paths
from courtside.study.configuration.sessions import Session, Study
from courtside.study.jobs import calibration
from courtside.study.jobs.calibration import CLICK_KEYS
from courtside.study.jobs.job import Job
from courtside.study.methods import Calibration
from courtside.study.targets.calibration import racket_models
from courtside.study.targets.together import EvaluatedTake

PAIRS = [  # of fusions that are compared, ours first
    ("two-robust", "two-dlt"),
    ("three-robust", "three-dlt"),
    ("three-robust", "halfbody"),
    ("all-robust", "all-dlt"),
    ("all-robust", "all-unsteady"),
    ("two-robust", "two-unsteady"),
]


def reference(job: Job) -> list[str]:
    """Return the imported keypoints that a recorded take is compared with; nothing of a virtual."""
    takes = job.study.parameters["evaluate_networks"]["takes"]
    model = takes.get(job.fill("{session}/{take}"))
    return job.of_each(paths.POSE2D, camera=job.take.cameras, model=[model]) if model else []


def compared_truths(takes: Iterable[EvaluatedTake]) -> list[str]:
    """Return the truth of each take in which a network's skeletons are compared with one."""
    return [paths.TRUE_TAKE.format(**take.labels) for take in takes if take.pose3d]


def skeletons(job: Job) -> list[str]:
    """Return the skeletons that are compared with the truth: every stage and fusion."""
    of = job.judged_stages()
    return [job.fill(paths.SKELETONS, stage=stage, fusion=fusion) for stage, fusion in of]


def skeleton_labels(job: Job) -> list[dict[str, str]]:
    """Return the labels of these skeletons."""
    of = job.judged_stages()
    return [{**job.wildcards, "stage": stage, "fusion": fusion} for stage, fusion in of]


def exported_skeletons(job: Job) -> list[str]:
    """Return the skeletons of every stage, of the fusion that is exported first."""
    return job.of_each(
        paths.SKELETONS, stage=job.stages(), fusion=job.session.fusions_of(job.take)[:1]
    )


def exported_measures(job: Job, pattern: str) -> str:
    """Return a file of measures, of the fusion that is exported first."""
    return job.fill(pattern, fusion=job.session.fusions_of(job.take)[0])


def exported_labels(job: Job) -> list[dict[str, str]]:
    """Return the labels of these skeletons."""
    return [{**job.wildcards, "stage": stage} for stage in job.stages()]


def fitted_takes(study: Study, model: str, calibration: str = "known18") -> list[dict[str, Any]]:
    """Return the files of every virtual take of a study that offsets of a network are fitted on.

    And the sexes of its persons, `sex_of`. People were found with the cameras of `calibration`.
    """
    found = []
    for session in study.sessions.values():
        of = {"session": session.name, "model": model, "calibration": calibration}
        for name, take in session.takes.items() if session.virtual else ():
            job = Job(study, {**of, "take": name})
            found.append(
                {
                    "cameras": job.fill(paths.CAMERAS),
                    "session_truth": job.fill(paths.TRUTH),
                    "pose2d": job.of_each(paths.POSE2D, camera=take.videos),
                    "people": job.fill(paths.PEOPLE),
                    "sync": job.fill(paths.CAMERA_CLOCKS),
                    "truth": job.fill(paths.TRUE_TAKE),
                    "sex_of": {who: session.subjects[who].sex for who in take.subjects},
                }
            )
    return found


def pairs(job: Job) -> list[tuple[str, str]]:
    """Return the pairs of fusions of a session that are compared."""
    return [pair for pair in PAIRS if set(pair) <= set(job.every_fusion())]


def chosen(job: Job, names: Iterable[str], **more: str) -> dict[str, str]:
    """Return some wildcards as labels, and more labels."""
    return {**{name: job[name] for name in names}, **more}


def estimated_by(sessions: Iterable[str], model: str, file: str) -> str:
    """Return a line on where a network's table of development sessions comes from."""
    named = ",".join(sessions)
    command = f"snakemake --config sessions=[{named}] variations=[] models=[{model}] -- {file}"
    return f"Estimated by: {command}"


def sfm_errors(job: Job) -> dict[str, Any]:
    """Return the settings of the evaluation of one structure from motion."""
    labels = {"mapper": job["mapper"], "n_bridging": job["n_images"], "offset": job["offset"]}
    found = _drawn_clicks(job, labels, CLICK_KEYS)
    n_images, step = int(job["n_images"]), job.step("evaluate_calibration")
    varied = n_images in step.get("strengths_for", [n_images])
    return found if varied else {**found, "strengths": [1]}


def known_errors(job: Job) -> dict[str, Any]:
    """Return the settings of the evaluation of calibrations from known points alone."""
    return _drawn_clicks(job, {}, ["click_sigma_px"])


def _drawn_clicks(job: Job, labels: dict[str, str], keys: Iterable[str]) -> dict[str, Any]:
    """Return how clicks are drawn, and what rows of errors are labelled with."""
    session, draws = job.session, job.step("evaluate_calibration")
    made = {key: job.virtual[key] for key in ("preset", "layout")}
    made["width_px"] = job.virtual["size_px"][0]
    varied = {k: v for k, v in session.condition.items() if k not in ("size_px", "world")}
    if "world" in session.condition:
        varied |= _world(session.condition["world"])
    return {
        "labels": {"session": session.name, **made, **varied, **labels},
        "clicks": {
            "n_draws": draws["n_draws"],
            "seed": draws["seed"],
            "preset": job.virtual["preset"],
            "session": session.name,
        },
        "strengths": draws["click_strengths"],
        "sets": draws["sets"],
        **job.some("adjust_network", keys),
    }


def _world(strengths: Mapping[str, float]) -> dict[str, Any]:
    """Return the effect that is varied, or `none` or `together`, and its strength."""
    there = {effect: strength for effect, strength in strengths.items() if strength}
    effect = "together" if len(there) > 1 else next(iter(there), "none")
    return {"effect": effect, "strength": max(there.values(), default=0)}


def lenses(job: Job) -> list[str]:
    """Return the lens of each fixed camera where all have pictures of a chessboard."""
    if not all(camera.chessboard for camera in job.session.cameras.values()):
        return []
    return calibration.each_fixed(job, paths.LENS)


def racket_ties(job: Job) -> list[str]:
    """Return the ties of the structures from motion that a racket is measured with."""
    return [job.fill(paths.TIES, **vars(v)) for v in racket_models(job.study, job.session)]


def racket(job: Job) -> dict[str, Any]:
    """Return what is known of the clicks of court and racket."""
    settings, step = _drawn_clicks(job, {}, CLICK_KEYS), job.study.parameters["evaluate_racket"]
    clicks = {**settings["clicks"], "n_draws": step["n_runs"]}
    del settings["sets"], settings["strengths"]
    return {**settings, "clicks": clicks, "length_m": step["length_m"], "tips_px": step["tips_px"]}


def ways(study: Study) -> list[dict[str, Any]]:
    """Return of each calibration of the sessions with fixed cameras what says how good it is."""
    return [
        _way(study, session, way)
        for session in study.sessions.values()
        if session.cameras and not session.condition
        for way in session.calibrations()
    ]


def _way(study: Study, session: Session, way: str) -> dict[str, Any]:
    """Return its files, empty where there are none; `skeletons` of the takes measured with it."""
    model = session.parameters["models"][0]
    job = Job(study, {"session": session.name, "calibration": way, "model": model})
    used = way in session.take_calibrations()
    fused = {name: session.fusions_of(take)[:1] for name, take in session.takes.items() if used}
    return {
        "session": session.name,
        "calibration": way,
        "base": Calibration.parse(way).base or "",
        "cameras": job.fill(paths.CAMERAS),
        "quality": job.fill(paths.CALIBRATION_QUALITY),
        "truth": job.true_file(paths.TRUTH),
        "court": str(job.court_file() or ""),
        "skeletons": [
            job.fill(paths.POSE3D, take=name, fusion=fusion)
            for name, fusions in fused.items()
            for fusion in fusions
        ],
    }


def round_trip_skeletons(job: Job) -> list[str]:
    """Return the skeletons of those sets of cameras of table 1 that see a take."""
    wanted = job.study.parameters["evaluate_round_trip"]["fusions"]
    named = [name for name in wanted if job.session.fused_cameras_of(job.take, name)]
    return job.of_each(paths.POSE3D, fusion=named)


def round_trip(job: Job) -> dict[str, Any]:
    """Return which joints and frames table 1 is of."""
    step = job.study.parameters["evaluate_round_trip"]
    keys = ("joints", "derived_joints", "n_frames", "published_width")
    return {
        **{key: step[key] for key in keys},
        "start_s": step["takes"][job.fill("{session}/{take}")],
    }
