"""What the study makes of takes with devices: figures, exports, errors of virtual ones."""

from dataclasses import dataclass

from courtside.study import paths
from courtside.study.configuration import consent
from courtside.study.configuration.sessions import Session, Study, Take
from courtside.study.methods import DEVICES

FIGURES = ("wrist_distance.devices", "wrist_distance.events", "wrist_arcs", "skeleton_plates")
JOINTS, POSED = ("trc", "c3d", "csv"), ("bvh", "glb")
EXPORTED = JOINTS + POSED  # of suits; POSED of depth cameras, single videos and Nuitrack
THESIS_FIGURES = ("thesis_fig3_1", "thesis_fig3_2")


@dataclass(frozen=True)
class DeviceTake:
    """A take with devices, and the session's first network, which measures its videos.

    `metric_body`: whether that gives a body in metres.
    """

    session: Session
    take: Take
    model: str
    metric_body: bool

    @property
    def labels(self) -> dict[str, str]:
        """Its names for tables."""
        return {"session": self.session.name, "take": self.take.name}

    def file(self, pattern: str, **more: str) -> str:
        """Return one of its files."""
        return pattern.format(**self.labels, model=self.model, **more)

    @property
    def fitted(self) -> list[str]:
        """The sources to which the skeletal model is fitted."""
        kinds = {device.kind for device in self.take.devices.values()}
        seen = "rgbd" in kinds or self.session.measures(self.take)
        found: list[str] = []
        for name, device in self.take.devices.items():
            corrected = [f"{name}-corrected"] if seen and device.is_suit else []
            found += [*device.sources(name, self.metric_body), *corrected]
        return found

    def true_file(self, pattern: str, **more: str) -> list[str]:
        """Return a file that rests on the truth; none of a real take."""
        return [self.file(pattern, **more)] if self.session.virtual else []


def device_takes(study: Study) -> list[DeviceTake]:
    """Return all takes with devices."""
    return [_measured(study, *pair) for pair in study.takes() if pair[1].devices]


def _measured(study: Study, session: Session, take: Take) -> DeviceTake:
    model = session.parameters["models"][0]
    return DeviceTake(session, take, model, study.models[model].metric_body)


def thesis_take(study: Study) -> DeviceTake | None:
    """Return the take of figures 3.1 and 3.2; None where the study does not have it."""
    for pair in study.named_takes([study.parameters["draw_thesis_fig3"]["take"]]):
        return _measured(study, *pair)
    return None


def every_true_file(study: Study, pattern: str) -> list[str]:
    """Return a file of every virtual take with devices, one that rests on its truth."""
    return [path for one in device_takes(study) for path in one.true_file(pattern)]


def every_body_frame(study: Study) -> list[str]:
    """Return the errors of the body frames of virtual takes with devices."""
    return every_true_file(study, paths.BODY_FRAME_ERRORS)


def every_source_angle(study: Study) -> list[str]:
    """Return the joint angles by the skeletal model of all sources of takes with devices."""
    return [
        one.file(paths.SOURCE_ANGLES, source=source)
        for one in device_takes(study)
        for source in one.fitted
    ]


def every_device_export(study: Study) -> list[str]:
    """Return the files of devices for other programs, of persons who agreed to them."""
    found = []
    for one in device_takes(study):
        if one.take.person_of_devices in consent.refusing(one.session, one.take, "export"):
            continue
        for name, device in one.take.devices.items():
            if device.is_suit:
                known = {**one.labels, "device": name, "suffix": EXPORTED}
                found += paths.each(paths.DEVICE_EXPORT, **known)
            else:
                sources = device.sources(name, one.metric_body)
                known = {**one.labels, "source": sources, "model": one.model}
                found += paths.each(paths.SOURCE_EXPORT, **known, suffix=POSED)
        if paths.MODELLED in one.session.parameters["export_stages"]:
            found += _modelled(one)
    return found


def _modelled(one: DeviceTake) -> list[str]:
    """Return the exported files of the skeletal model of a take's sources."""
    known = {"calibration": DEVICES, "person": one.take.person_of_devices}
    patterns = {paths.MODELLED_EXPORT: (*JOINTS, "mot", "osim"), paths.MOTION_EXPORT: POSED}
    return [
        one.file(pattern, fusion=name, suffix=suffix, **known)
        for name in one.fitted
        for pattern, suffixes in patterns.items()
        for suffix in suffixes
    ]


def every_device_figure(study: Study) -> list[str]:
    """Return the figures of all takes with devices, and those of the thesis."""
    stems, takes = [], device_takes(study)
    for one in takes:
        names = [*FIGURES, "source_errors"] if one.session.virtual else FIGURES
        stems += [one.file(paths.DEVICE_FIGURE, figure=name) for name in names]
    together = [*(THESIS_FIGURES if thesis_take(study) else ()), *["smoothness"] * bool(takes)]
    return paths.formats(stems + [paths.STUDY_FIGURE.format(figure=name) for name in together])
