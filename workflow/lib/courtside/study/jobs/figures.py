"""Files and settings of figures of the calibration study and of the badminton paper."""

from typing import Any

from courtside.study import paths
from courtside.study.configuration.sessions import Study
from courtside.study.jobs import takes
from courtside.study.jobs.job import Job
from courtside.study.targets.calibration import (
    drawn_conditions,
    every_error,
    varied,
    world_conditions,
)
from courtside.study.targets.together import fig05_layouts


def condition_errors(job: Job) -> list[str]:
    """Return all tables of errors of the variations under a condition."""
    return every_error(varied(job.study, drawn_conditions(job.study)[job["condition"]]))


def condition_axes(job: Job) -> dict[str, Any]:
    """Return the axes of a condition's figure: settings with several values, number of images."""
    name = drawn_conditions(job.study)[job["condition"]]
    vary = job.study.parameters["conditions"][name]["vary"]
    keys = [key for key in vary if not key.endswith("seed")]
    keys = [key for key in keys if len(vary[key]) > 1] or keys[:1]
    keys = ["width_px" if key == "size_px" else key for key in keys]
    sweeps = [session.parameters["sweep"]["n_images"] for session in varied(job.study, name)]
    counts = {count for sweep in sweeps for count in sweep}
    return {
        "x": keys[0],
        "group": keys[1] if len(keys) > 1 else None,
        "n_bridging": counts.pop() if len(counts) == 1 else None,
    }


def world_errors(job: Job) -> list[str]:
    """Return all tables of errors of the worlds of a condition."""
    return every_error(varied(job.study, world_conditions(job.study)[job["condition"]]))


def world_qualities(job: Job) -> list[str]:
    """Return what the calibrations of the worlds of a condition say of themselves."""
    return [
        paths.CALIBRATION_QUALITY.format(session=session.name, calibration=way)
        for session in varied(job.study, world_conditions(job.study)[job["condition"]])
        for way in session.calibrations()
    ]


def timings(job: Job) -> list[str]:
    """Return the benchmark files of a session's structures from motion."""
    once = [("extract_features", "all"), ("match_images", "all")]
    names = [variant.name for variant in job.session.variants()]
    swept = [(rule, name) for rule in ("map_images", "adjust_network") for name in names]
    return [job.fill(paths.BENCHMARK, rule=rule, job=name) for rule, name in once + swept]


def of_each_count(job: Job, pattern: str) -> list[str]:
    """Return a file of each number of bridging images, of the first choice of images."""
    counts = job.session.parameters["sweep"]["n_images"]
    return [job.fill(pattern, n_images=count, offset=0) for count in counts]


def stroke(job: Job, **more: Any) -> dict[str, Any]:
    """Return which frames of a take are its stroke (so many from `start_s`), and more settings."""
    step = job.study.parameters["draw_stroke"]
    start_s = step["takes"].get(job.fill("{session}/{take}"))
    return {"n_frames": step["n_frames"], "start_s": start_s, **more}


def seen_and_made(job: Job) -> dict[str, Any]:
    """Return what a picture of detections beside the skeleton needs, by name."""
    return {
        "pose3d": job.fill(paths.POSE3D),
        "cameras": job.fill(paths.CAMERAS),
        "pose2d": takes.each_camera(job, paths.POSE2D),
        "shake": takes.shake(job),
        "people": job.fill(paths.PEOPLE),
        "sync": job.fill(paths.CAMERA_CLOCKS),
        "videos": list(job.take.videos.values()),
        "skeleton": job.skeleton_file(),
        "derived": job.study.folder / paths.DERIVED_JOINTS_YAML,
    }


def fig05_errors(study: Study) -> list[str]:
    """Return the errors of detection of fig 5's takes."""
    wanted = study.parameters["draw_badminton_fig05"]["layouts"]
    named = dict.fromkeys(wanted[layout]["take"] for layout in fig05_layouts(study))
    known = {"model": study.parameters["models"][0]}
    return [
        paths.DETECTION_ERRORS.format(session=session.name, take=take.name, **known)
        for session, take in study.named_takes(named)
    ]


def fig05_sources(study: Study) -> list[dict[str, Any]]:
    """Return name, 2D keypoints and video of each take's cameras of fig 5, each once."""
    wanted, found = study.parameters["draw_badminton_fig05"]["layouts"], {}
    model = study.parameters["models"][0]
    for layout in fig05_layouts(study):
        ((session, take),) = study.named_takes([wanted[layout]["take"]])
        for camera in wanted[layout]["cameras"]:
            known = {"session": session.name, "take": take.name, "model": model}
            name = [session.name, take.name, camera]
            found[tuple(name)] = {
                "name": name,
                "pose2d": paths.POSE2D.format(**known, camera=camera),
                "video": take.videos[camera],
            }
    return list(found.values())


def fused_cameras(job: Job) -> dict[str, tuple[str, ...]]:
    """Return the cameras of a take of every way to fuse views."""
    session, take = job.session, job.take
    return {name: session.fused_cameras_of(take, name) for name in job.every_fusion()}
