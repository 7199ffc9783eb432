"""What a checked configuration says, as plain records."""

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Subject:
    """A person under a pseudonym; None where not stated."""

    height_m: float | None = None
    mass_kg: float | None = None
    sex: str | None = None
    hand: str | None = None


@dataclass(frozen=True)
class FixedCamera:
    """One fixed camera of a session.

    Attributes
    ----------
    static : str or None
        A recording without people.
    crop_px : tuple of int or None
        (x, y, width, height): the part of the calibrated picture that the videos show.
    name_in_calibration : str or None
        Its name in the calibration file where that differs.
    """

    static: str | None = None
    crop_px: tuple | None = None
    name_in_calibration: str | None = None


@dataclass(frozen=True)
class Take:
    """One recording by several fixed cameras.

    Attributes
    ----------
    name : str
    videos : dict of str to str
        Path by camera.
    subjects : tuple of str
        Persons in it.
    trim_s : tuple of float or None
        (start, stop) on each camera's own clock.
    """

    name: str
    videos: dict
    subjects: tuple
    trim_s: tuple | None = None


@dataclass(frozen=True)
class Session:
    """One visit to one gym.

    Attributes
    ----------
    name, file, description : str
    court : str or None
    subjects : dict of str to Subject
    cameras : dict of str to FixedCamera
    takes : dict of str to Take
    calibration_file : str
    blur_faces : bool
    parameters : dict
        The steps' parameters of the study, with this session's overrides.
    """

    name: str
    file: str
    description: str
    court: str | None
    subjects: dict
    cameras: dict
    takes: dict
    calibration_file: str
    blur_faces: bool
    parameters: dict

    def calibration_camera_names(self):
        """Return for each camera its name in the calibration file."""
        return {name: c.name_in_calibration or name for name, c in self.cameras.items()}


@dataclass(frozen=True)
class Network:
    """A file of a model: a member of an artefact, with its checksum and the outputs to keep."""

    artefact: str
    member: str
    sha256: str
    outputs: list | None = None


@dataclass(frozen=True)
class Model:
    """A 2D pose model of config/models.yaml."""

    name: str
    decoder: str
    skeleton: str
    detector: Network
    landmarks: Network
    input: dict = field(default_factory=dict)

    def decoder_options(self):
        """Return the keyword arguments of `courtside.pose.decoders.landmark_network`."""
        options = {"decoder": self.decoder}
        if self.input:
            options |= {"input_range": self.input["range"], "channels": self.input["channels"]}
        return options


@dataclass(frozen=True)
class Study:
    """Everything the rules need to know.

    Attributes
    ----------
    sessions : dict of str to Session
    artefacts : dict of str to courtside.study.artefacts.Artefact
    models : dict of str to Model
    parameters : dict
        The study's configuration as checked.
    """

    sessions: dict
    artefacts: dict
    models: dict
    parameters: dict


def session(name, file, content, parameters):
    """Build a `Session`.

    Parameters
    ----------
    name, file : str
    content : dict
        The session's YAML file, checked.
    parameters : dict
        The study's configuration, whose steps `override` in `content` changes.
    """
    override = content.get("override", {})
    merged = {
        key: {**value, **override.get(key, {})} if isinstance(value, dict) else value
        for key, value in parameters.items()
    }
    subjects = {key: Subject(**(value or {})) for key, value in content["subjects"].items()}
    takes = {
        key: Take(
            name=key,
            videos=dict(value["videos"]),
            subjects=tuple(value.get("subjects", subjects)),
            trim_s=tuple(value["trim_s"]) if "trim_s" in value else None,
        )
        for key, value in content["takes"].items()
    }
    return Session(
        name=name,
        file=str(file),
        description=content["description"],
        court=None if content["court"] == "none" else content["court"],
        subjects=subjects,
        cameras={key: _camera(value or {}) for key, value in content["cameras"].items()},
        takes=takes,
        calibration_file=content["calibration"]["file"],
        blur_faces=content.get("blur_faces", True),
        parameters=merged,
    )


def _camera(content):
    crop_px = tuple(content["crop_px"]) if "crop_px" in content else None
    return FixedCamera(**{**content, "crop_px": crop_px})


def model(name, content):
    """Build a `Model` from a checked YAML dictionary."""
    networks = {part: Network(**content[part]) for part in ("detector", "landmarks")}
    rest = {key: value for key, value in content.items() if key not in networks}
    return Model(name=name, **rest, **networks)
