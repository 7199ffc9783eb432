"""Files and settings of devices of their own: their sources, clocks, corrections and figures.

A source is a skeleton over time: of a device, of one picture of it by depth or network, of all
fixed cameras, or corrected.
"""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from courtside.study import paths
from courtside.study.configuration.sessions import Study
from courtside.study.errors import InputError
from courtside.study.jobs.job import Job
from courtside.study.targets.devices import DeviceTake, thesis_take

CAMERAS = "cameras"  # the source that fixed cameras give
PLATES = ("blazepose33", "mocopi27", "nuitrack19", "cpm14")  # skeletons drawn side by side


@dataclass(frozen=True)
class Source:
    """The file of a source, the name of its skeleton, and the device whose clock it has."""

    file: str
    skeleton: str
    device: str


def sources(job: Job, corrected: bool = True) -> dict[str, Source]:
    """Return the sources of a take, the one whose clock is the reference first."""
    of_network, found = job.model.skeleton, {}
    if job.session.measures(job.take):
        found[CAMERAS] = Source(job.fill(paths.CAMERA_SOURCE), of_network, CAMERAS)
    devices = sorted(job.take.devices.items(), key=lambda pair: pair[1].is_suit)
    for name, device in devices:
        own = device.skeleton
        for source in device.sources(name, job.model.metric_body):
            known = {"device": name, "source": source}
            file = job.fill(paths.DEVICE if own else paths.SOURCE, **known)
            found[source] = Source(file, own or of_network, name)
    for name in correctable(job) if corrected else ():
        source = f"{name}-corrected"
        own = job.take.devices[name].skeleton or of_network
        found[source] = Source(job.fill(paths.SOURCE, source=source), own, name)
    return found


def source(job: Job, corrected: bool = True) -> Source:
    """Return the source that a file is of; an error where its take has none of that name."""
    return job.named(sources(job, corrected), "source")


def source_files(job: Job, corrected: bool = True) -> list[str]:
    """Return the files of all sources of a take."""
    return [source.file for source in sources(job, corrected).values()]


def skeletons(job: Job) -> dict[str, str]:
    """Return the name of the skeleton of each source of a take."""
    return {name: source.skeleton for name, source in sources(job).items()}


def bodies(job: Job, pattern: str = paths.BODY) -> list[str]:
    """Return the aligned skeletons of all sources of a take, or another file of each."""
    return job.of_each(pattern, source=sources(job))


def skeleton_file(job: Job) -> Path:
    """Return the skeleton that a device comes with."""
    return job.study.skeleton_yaml(str(job.device.skeleton))


def exported(job: Job) -> str:
    """Return the motion of a device that a file for other programs is made from, where agreed."""
    job.named({name: one for name, one in job.take.devices.items() if one.is_suit}, "device")
    _demand_export(job)
    return job.fill(paths.DEVICE)


def exported_source(job: Job) -> str:
    """Return the joints of a source for export; raise an error without the person's consent."""
    _demand_export(job)
    return source(job, corrected=False).file


def _demand_export(job: Job) -> None:
    Job(job.study, {**job.wildcards, "person": job.take.person_of_devices}).demand("export")


def source_skeleton(job: Job) -> Path:
    """Return the skeleton of a source."""
    name = source(job).skeleton
    return job.study.skeleton_yaml(name)


def colour_frames(job: Job) -> str | list:
    """Return the times of a depth camera's colour pictures; nothing for a plain video."""
    return job.fill(paths.COLOUR_FRAMES) if job.device.kind == "rgbd" else []


def fused(job: Job, stage: str = "") -> str:
    """Return the fixed cameras' skeletons of a stage, by default the last, by the first method."""
    session = job.session
    fusion = session.fusions_of(job.take)[0]
    way = {"calibration": session.take_calibrations()[0], "fusion": fusion}
    return job.fill(paths.SKELETONS, stage=stage or job.stages()[-1], **way)


def clocks(job: Job, corrected: bool = True) -> dict[str, str]:
    """Return for each source of a take the device whose clock it has."""
    return {name: source.device for name, source in sources(job, corrected).items()}


def stated_clocks(job: Job) -> dict[str, dict[str, float]]:
    """Return the clocks that a take states of its devices, against that of the first source.

    They are stated against the first fixed camera. Where cameras do not measure the take (their
    points are not clicked yet), its clock is known only if that of the first device is stated.
    """
    take = job.take
    stated = {name: clock for name, clock in take.clocks.items() if name in take.devices}
    reference = next(iter(sources(job, corrected=False).values())).device
    if reference == CAMERAS or not take.cameras:
        return stated
    own = stated.pop(reference, None)
    return {name: _against(clock, own) for name, clock in stated.items()} if own else {}


def _against(clock: dict[str, float], other: dict[str, float]) -> dict[str, float]:
    """Return the numbers of a clock against another one; both are against a third."""
    rate, other_rate = (1 + 1e-6 * one.get("drift_ppm", 0.0) for one in (clock, other))
    uncertain_s = math.hypot(*(one.get("uncertainty_s", 0.0) for one in (clock, other)))
    return {
        "offset_s": clock["offset_s"] - other["offset_s"] * rate / other_rate,
        "drift_ppm": 1e6 * (rate / other_rate - 1),
        "uncertainty_s": uncertain_s,
    }


def event_files(job: Job) -> list[str]:
    """Return the files of what all sources of a take show."""
    return [job.fill(paths.EVENTS), *job.of_each(paths.CORRECTED_EVENTS, device=correctable(job))]


def alignment(job: Job) -> dict[str, Any]:
    """Return the skeleton of a source, the devices of all, and those whose clock is stated."""
    skeleton = source(job).skeleton
    return {"skeleton": skeleton, "devices": clocks(job), "stated": list(job.take.clocks)}


def vision(job: Job) -> str | None:
    """Return the source that corrects inertial ones: fixed cameras, a depth camera, or None."""
    found = sources(job, corrected=False)
    lifted = [name for name, source in found.items() if name == f"{source.device}-depth"]
    return CAMERAS if CAMERAS in found else next(iter(lifted), None)


def correctable(job: Job) -> list[str]:
    """Return the inertial devices of a take that vision can correct."""
    suits = [name for name, device in job.take.devices.items() if device.is_suit]
    return [] if vision(job) is None else suits


def vision_file(job: Job) -> str:
    """Return the file of the source that corrects inertial ones."""
    return sources(job, corrected=False)[_vision(job)].file


def correction(job: Job) -> dict[str, Any]:
    """Return how an inertial device is corrected."""
    source = _vision(job)
    sigma_m = job.step("correct_inertial")["sigma_m"][source.rpartition("-")[2]]
    return {"device": job["device"], "vision_device": source, "sigma_m": sigma_m}


def _vision(job: Job) -> str:
    found = vision(job)
    if found is None:
        raise InputError(
            f"{job.session.file}: takes.{job.take.name}: expected fixed cameras or a depth camera "
            f"to correct {job['device']} by, found neither"
        )
    return found


def fitting(job: Job) -> dict[str, Any]:
    """Return the options of the fit to a source: person and height, filter, stated errors."""
    who = job.take.person_of_devices
    return {
        **job.some("filter_motion", ["max_gap_s", "cutoff_hz"]),
        "person": who,
        "height_m": job.session.subjects[who].height_m,
        "sigma_m": source_sigmas(job)[job["source"]],
    }


def source_sigmas(job: Job) -> dict[str, dict[str, float]]:
    """Return the stated errors of limb joints, m, by source, without the fixed cameras.

    They are those of the method (`depth`, `rgb`, `corrected`), otherwise of the kind of the device;
    an `InputError` if they are not stated.
    """
    stated, devices, found = job.step("fit_source")["sigma_m"], job.take.devices, {}
    for name, source in sources(job).items():
        if name != CAMERAS:
            method = name.removeprefix(source.device).removeprefix("-")
            kind = method or devices[source.device].kind
            if kind not in stated:
                raise InputError(
                    f"fit_source.sigma_m: expected the errors of joints of {kind!r}, from which "
                    f"{name} comes, found those of {sorted(stated)}; state them"
                )
            found[name] = stated[kind]
    return found


def fitted(job: Job) -> dict[str, str]:
    """Return the files with the joints of the skeletal model, by source of a take.

    The fixed cameras are among them if the joint offsets of their network are known.
    """
    found = {name: job.fill(paths.FITTED_SOURCE, source=name) for name in source_sigmas(job)}
    if CAMERAS in sources(job) and paths.MODELLED in job.study.written_stages(job["model"]):
        found[CAMERAS] = fused(job, paths.MODELLED)
    return found


def compared_angles(job: Job) -> dict[str, Any]:
    """Return the person, the devices and the stated errors of the sources of `fitted`."""
    names = fitted(job)
    return {
        "person": job.take.person_of_devices,
        "devices": {name: device for name, device in clocks(job).items() if name in names},
        "sigma_m_of": source_sigmas(job),
    }


def compared_sources(job: Job) -> list[str]:
    """Return the files of the sources of `fitted`, in the same order."""
    return [sources(job)[name].file for name in fitted(job)]


def take_clocks(job: Job) -> str | list:
    """Return the clocks of a take's devices, where it has any."""
    return job.fill(paths.DEVICE_CLOCKS) if job.take.devices else []


def kinds(job: Job) -> dict[str, str]:
    """Return the kind of each device of a take."""
    return {name: device.kind for name, device in job.take.devices.items()}


def all_kinds(study: Study) -> dict[str, str]:
    """Return the kind of each device of the study."""
    return {name: device.kind for _, take in study.takes() for name, device in take.devices.items()}


def events(job: Job) -> str:
    """Return the events of a take, by the clocks that were found or by each device's own."""
    return job.fill(paths.DEVICE_EVENTS if job["clocks"] == "devices" else paths.OWN_EVENTS)


def plates(job: Job) -> list[Path]:
    """Return the skeletons that are drawn side by side, those of a take's own sources included."""
    names = dict.fromkeys((*PLATES, *skeletons(job).values()))
    return [job.study.skeleton_yaml(name) for name in names]


def thesis_file(study: Study, what: str) -> str:
    """Return a table of the arcs of the take of figures 3.1 and 3.2."""
    return _thesis_take(study).file(paths.ARCS, what=what)


def thesis_truth(study: Study) -> str | list:
    """Return the true arcs of that take, where there is a truth."""
    found = _thesis_take(study).true_file(paths.TRUE_PATHS)
    return found[0] if found else []


def _thesis_take(study: Study) -> DeviceTake:
    found = thesis_take(study)
    if found is None:
        name = study.parameters["draw_thesis_fig3"]["take"]
        raise InputError(f"draw_thesis_fig3.take: expected a take of the study, found {name}")
    return found
