"""What a checked configuration says, as plain records."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from courtside.study import paths
from courtside.study.configuration import consent
from courtside.study.methods import HALFBODY, Calibration, Fusion, Variant


@dataclass(frozen=True)
class Subject:
    """A person under a pseudonym; None where not stated. `consent`: words of `consent.WORDS`."""

    height_m: float | None = None
    mass_kg: float | None = None
    sex: str | None = None
    hand: str | None = None
    consent: tuple = consent.UNSTATED


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
    chessboard : dict or None
        `images`, `inner_corners`, `square_m`: pictures of a chessboard that this camera took.
    """

    static: str | None = None
    crop_px: tuple | None = None
    name_in_calibration: str | None = None
    chessboard: dict | None = None


@dataclass(frozen=True)
class Device:
    """What follows one person by itself during a take.

    Attributes
    ----------
    kind : str
        `inertial` (mocopi's BVH), `rgb` (a video), `rgbd` (a RealSense recording or a folder), `nuitrack`.
    file : str
        Its recording.
    subject : str
        Whom it follows.
    """

    kind: str
    file: str
    subject: str

    def sources(self, name):
        """Return the names of the skeletons that this device, of this name, gives."""
        endings = {"rgb": ("-rgb",), "rgbd": ("-depth", "-rgb")}
        return tuple(name + ending for ending in endings.get(self.kind, ("",)))


@dataclass(frozen=True)
class Take:
    """One recording by several fixed cameras, by devices of their own, or by both.

    Attributes
    ----------
    name : str
    videos : dict of str to str
        Path by camera.
    subjects : tuple of str
        Persons in it.
    trim_s : tuple of float or None
        (start, stop) on each camera's own clock.
    synchronised : bool
        Whether the cameras share one clock; otherwise it is found from the videos.
    steady : bool
        Whether the shake of the cameras is measured and taken out.
    virtual : dict or None
        What a take of a virtual session is made from.
    devices : dict of str to Device
    clocks : dict of str to dict
        Clocks of cameras and devices that are known: `offset_s`, perhaps `drift_ppm` and `uncertainty_s`.
    pose2d : dict of str to dict of str to str
        For a skeleton, by camera, the folder of keypoints that another program found.
    pose3d : dict of str to dict of str to str
        For a skeleton, by person, the TRC file of another program.
    """

    name: str
    videos: dict
    subjects: tuple
    trim_s: tuple | None = None
    synchronised: bool = False
    steady: bool = False
    virtual: dict | None = None
    devices: dict = field(default_factory=dict)
    clocks: dict = field(default_factory=dict)
    pose2d: dict = field(default_factory=dict)
    pose3d: dict = field(default_factory=dict)


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
    calibration_file : str or None
        Cameras found elsewhere.
    walks : dict of str to str
        Video, or folder of photos, of each walk by the mobile camera.
    court_points : str or None
        Clicked court points.
    virtual : dict or None
        What a virtual session is made from.
    condition : dict
        What makes this session differ from the one it is a variation of.
    blur_faces : bool
    views : dict of str to tuple of str
        Named sets of cameras.
    halfbody : dict or None
        The cameras that play `centre`, `left` and `right` in the paper's rule for three cameras.
    parameters : dict
        The steps' parameters of the study, with this session's overrides.
    unclicked : str or None
        Where court points are to be saved that nobody has clicked yet.
    withheld : dict of str to tuple of str
        Takes that are not among `takes`, for somebody in them has not agreed to be measured: who, by take.
    """

    name: str
    file: str
    description: str
    court: str | None
    subjects: dict
    cameras: dict
    takes: dict
    calibration_file: str | None
    walks: dict
    court_points: str | None
    virtual: dict | None
    condition: dict
    blur_faces: bool
    views: dict
    halfbody: dict | None
    parameters: dict
    unclicked: str | None = None
    withheld: dict = field(default_factory=dict)

    def calibration_camera_names(self):
        """Return for each camera its name in the calibration file."""
        return {name: c.name_in_calibration or name for name, c in self.cameras.items()}

    def calibrations(self):
        """Return those of the study's ways to find cameras for which this session has recordings."""
        clicked, walked = self.court_points is not None and bool(self.cameras), bool(self.walks)
        boards = clicked and all(camera.chessboard for camera in self.cameras.values())
        possible = {
            "file": self.calibration_file is not None,
            "known": clicked,
            "dlt": clicked,
            "sfm": walked and bool(self.cameras) and not self.unclicked,
            "sim3": walked and clicked,
            "paper": walked and clicked,
        }
        ways = map(Calibration.parse, self.parameters["calibrations"])
        return [way.name for way in ways if possible[way.kind] and (boards or not way.board)]

    def take_calibrations(self):
        """Return those of the session's calibrations that its takes are measured with."""
        wanted = self.parameters["take_calibrations"]
        return [way for way in self.calibrations() if way in wanted]

    def fusions(self, key="fusions"):
        """Return those of the study's ways to fuse views for which this session names cameras."""
        return [name for name in self.parameters[key] if self.fused_cameras(name)]

    def fused_cameras(self, fusion):
        """Return the cameras that a way to fuse views rests on; empty where the session names none."""
        how = Fusion.parse(fusion)
        if how.rule == HALFBODY:
            return tuple((self.halfbody or {}).values())
        return {"all": tuple(self.cameras), **self.views}.get(how.cameras, ())

    def variants(self):
        """Return all structures from motion of the sweep."""
        sweep = self.parameters["sweep"]
        return [
            Variant(mapper, count, offset)
            for mapper in sweep["mappers"]
            for count in sweep["n_images"]
            for offset in range(sweep["n_offsets"] if count <= sweep["offsets_up_to"] else 1)
        ]

    def filmed(self):
        """Return the names of all cameras and walks."""
        return [*self.cameras, *self.walks]

    def films_boards(self):
        """Say whether this is a virtual session whose cameras take pictures of a chessboard."""
        return bool(self.virtual and self.virtual.get("boards"))


@dataclass(frozen=True)
class Network:
    """A file of a model: a member of an artefact, with its checksum and the outputs to keep."""

    artefact: str
    member: str
    sha256: str
    outputs: list | None = None


@dataclass(frozen=True)
class Model:
    """A 2D pose model of config/models.yaml, or a skeleton whose keypoints another program finds.

    Without `tracking` it searches the person in every frame; without networks its decoder is `imported`.
    """

    name: str
    decoder: str
    skeleton: str
    detector: Network | None = None
    landmarks: Network | None = None
    input: dict = field(default_factory=dict)
    tracking: bool = True

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
    artefacts : dict of str to courtside.study.execution.artefacts.Artefact
    models : dict of str to Model
    parameters : dict
        The study's configuration as checked.
    folder : Path
        The folder config/.
    """

    sessions: dict
    artefacts: dict
    models: dict
    parameters: dict
    folder: Path = Path("config")

    def takes(self) -> Iterator[tuple[Session, Take]]:
        """Yield every take with its session."""
        for session in self.sessions.values():
            for take in session.takes.values():
                yield session, take

    def named_takes(self, names: Iterable[str]) -> list[tuple[Session, Take]]:
        """Return those takes, named `session/take`, that the study has."""
        pairs = [name.split("/") for name in names]
        found = [(self.sessions[s], t) for s, t in pairs if s in self.sessions]
        return [(session, session.takes[take]) for session, take in found if take in session.takes]

    def stages(self, model: str) -> tuple[str, ...]:
        """Return the stages of a network's skeletons; the last is the best.

        Joints are corrected only of networks whose offsets were estimated.
        """
        estimated = paths.joint_offsets(self.folder, model).is_file()
        return paths.STAGES if estimated else paths.STAGES[:-1]

    def court_file(self, session: Session) -> Path | None:
        """Return the file of a session's court, None without a court."""
        return paths.court(self.folder, session.court) if session.court else None

    def skeleton_file(self, model: str) -> Path:
        """Return the file of the skeleton of a network."""
        return paths.skeleton(self.folder, self.models[model].skeleton)


def imported(name):
    """Return the `Model` of keypoints of another program, named after their skeleton."""
    return Model(name=name, decoder="imported", skeleton=name)


def model(name, content):
    """Build a `Model` from a checked YAML dictionary."""
    networks = {part: Network(**content[part]) for part in ("detector", "landmarks")}
    rest = {key: value for key, value in content.items() if key not in networks}
    return Model(name=name, **rest, **networks)
