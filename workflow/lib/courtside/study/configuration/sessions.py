"""What a checked configuration says, as plain records."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from courtside.study import paths
from courtside.study.configuration import consent, yaml_files
from courtside.study.execution import files
from courtside.study.execution.artefacts import Artefact
from courtside.study.methods import ALONE, HALFBODY, Calibration, Fusion, Variant, distinct_offsets

DEFAULT = "config.yaml"  # in config/, over which a user's files are merged
DEFAULT_DETECTOR = "blazepose-detector"  # of config/detectors.yaml
FEWEST_ALONE = 3  # cameras that people alone can place
ONE_STAGE = ("rtmo", "yolo-pose")  # decoders of networks that find persons themselves
SUITS = ("inertial",)  # kinds of devices that vision corrects and whose motion is exported
SKELETONS = {"inertial": "mocopi27", "nuitrack": "nuitrack19"}  # that devices come with, by kind


@dataclass(frozen=True)
class Subject:
    """A person under a pseudonym; None where not stated. `consent`: words of `consent.WORDS`."""

    height_m: float | None = None
    mass_kg: float | None = None
    sex: str | None = None
    hand: str | None = None
    consent: tuple[str, ...] = consent.UNSTATED
    # Where the person was seen: `camera`, `time_s`, `at_px`, and `take` where there are several
    seen: tuple[dict[str, Any], ...] = ()


@dataclass(frozen=True)
class FixedCamera:
    """One fixed camera of a session."""

    static: str | None = None  # a recording without people
    # (x, y, width, height): the part of the calibrated picture that the videos show
    crop_px: tuple[int, ...] | None = None
    name_in_calibration: str | None = None  # its name in the calibration file where that differs
    # `images`, `inner_corners`, `square_m`: pictures of a chessboard that this camera took
    chessboard: dict[str, Any] | None = None
    scale: float = 1.0  # px of the videos per px of the calibrated picture, or of `crop_px`


@dataclass(frozen=True)
class Device:
    """A device that follows one person by itself during a take."""

    # `inertial` (mocopi's BVH), `rgb` (a video), `rgbd` (a RealSense recording or a folder),
    # `nuitrack`
    kind: str
    file: str  # its recording
    subject: str  # whom it follows
    unit: str | None = None  # of the lengths in its file, where that is not its format's
    angles: str | None = None  # of a BVH: `degrees` or `radians`, where that is stated

    @property
    def is_suit(self) -> bool:
        """Whether it is an inertial suit."""
        return self.kind in SUITS

    @property
    def skeleton(self) -> str | None:
        """The name of the skeleton that it comes with; None if a network measures its pictures."""
        return SKELETONS.get(self.kind)

    def sources(self, name: str, metric_body: bool) -> tuple[str, ...]:
        """Return the names of the skeletons that this device, called `name`, gives.

        Those called `-rgb` need a network with a metric body (`Model.metric_body`).
        """
        own = ("-rgb",) if metric_body else ()
        endings = {"rgb": own, "rgbd": ("-depth", *own)}
        return tuple(name + ending for ending in endings.get(self.kind, ("",)))


@dataclass(frozen=True)
class Take:
    """One recording by several fixed cameras, by devices of their own, or by both."""

    name: str
    videos: dict[str, str]  # path by camera
    subjects: tuple[str, ...]  # persons in it
    trim_s: tuple[float, ...] | None = None  # (start, stop) on each camera's own clock
    # Whether the cameras share one clock; otherwise it is found from the videos
    synchronised: bool = False
    steady: bool = False  # whether the shake of the cameras is measured and taken out
    virtual: dict[str, Any] | None = None  # settings of the simulation of a virtual take
    devices: dict[str, Device] = field(default_factory=dict)
    # Known clocks of cameras and devices: `offset_s`, perhaps `drift_ppm`, `uncertainty_s`
    clocks: dict[str, dict[str, float]] = field(default_factory=dict)
    # For a skeleton, by camera, the folder of keypoints that another program found
    pose2d: dict[str, dict[str, str]] = field(default_factory=dict)
    # For a skeleton, by person, the TRC file of another program
    pose3d: dict[str, dict[str, str]] = field(default_factory=dict)
    rate_hz: float | None = None  # of the frames of `pose2d`, where there are no videos

    @property
    def cameras(self) -> tuple[str, ...]:
        """The fixed cameras that see it: of its videos, else of another program's keypoints."""
        folders = [] if self.videos else self.pose2d.values()
        return tuple(dict.fromkeys(name for own in (self.videos, *folders) for name in own))

    @property
    def person_of_devices(self) -> str:
        """The person whom all its devices follow; others need a take of their own."""
        return next(iter(self.devices.values())).subject


@dataclass(frozen=True)
class Session:
    """One visit to one gym."""

    name: str
    file: str  # its YAML file
    description: str
    court: str | None
    subjects: dict[str, Subject]
    cameras: dict[str, FixedCamera]
    takes: dict[str, Take]
    calibration_file: str | None  # cameras found elsewhere
    walks: dict[str, str]  # video, or folder of photos, of each walk by the mobile camera
    court_points: str | None  # clicked court points
    virtual: dict[str, Any] | None  # settings of the simulation of a virtual session
    condition: dict[str, Any]  # what makes this session differ from the one it is a variation of
    blur_faces: bool
    views: dict[str, tuple[str, ...]]  # named sets of cameras
    # The cameras that play `centre`, `left`, `right` in the paper's rule for three cameras
    halfbody: dict[str, str] | None
    parameters: dict[str, Any]  # the steps' parameters of the study, with this session's overrides
    # Numbers of points of the court's sets, all of its points among them; None where unknown
    point_sets: frozenset[int] | None = None
    placed: bool = False  # whether the file of court points states their places itself
    # Whether cameras are calibrated from points alone, too, where there are better ways
    also_known: bool = False
    unclicked: str | None = None  # where court points that nobody has clicked yet are to be saved
    waits: bool = False  # whether it uses the cameras of another session that waits for clicks
    # Of `calibration`, where numbers of the file are replaced: `principal_point_px` and `reason`
    calibration_override: dict[str, Any] = field(default_factory=dict)
    board: dict[str, Any] | None = None  # what several cameras see, and where they do
    wand: dict[str, Any] | None = None  # the same of a wand
    calibration_unit: str | None = None  # of the lengths in that file, where it states none
    file_covariance: str | None = None  # of the cameras in that file, where it is known
    static_points: str | None = None  # points at rest, clicked in several cameras
    # Known lengths between two of them: `points`, `length_m`, perhaps `on_floor`
    known_lengths: tuple[dict[str, Any], ...] = ()
    people: str | None = None  # people.csv, in which persons are named
    # Takes that are not among `takes`, because persons in them have not agreed to be measured
    withheld: dict[str, Take] = field(default_factory=dict)
    override: dict[str, Any] = field(default_factory=dict)  # what of `parameters` its file states

    def calibration_camera_names(self) -> dict[str, str]:
        """Return for each camera its name in the calibration file."""
        return {name: c.name_in_calibration or name for name, c in self.cameras.items()}

    def calibrations(self) -> list[str]:
        """Return the study's calibrations for which this session has recordings and a court."""
        clicked, walked = self.court_points is not None and bool(self.cameras), bool(self.walks)
        others = walked or self.calibration_file or self.board or self.wand
        alone = clicked and (self.also_known or not others)
        clicked = clicked and not self.placed
        pictured = clicked and all(camera.static for camera in self.cameras.values())
        boards = clicked and all(camera.chessboard for camera in self.cameras.values())
        filmed = any(take.cameras for take in self.takes.values())
        possible = {
            "file": self.calibration_file is not None,
            "board": self.board is not None,
            "wand": self.wand is not None,
            # Whose world a court's would not be
            ALONE: self.court is None and self.has_scale() and len(self.cameras) >= FEWEST_ALONE,
            "known": pictured,
            "dlt": pictured,
            "sfm": walked and bool(self.cameras) and not self.unclicked,
            "sim3": walked and clicked,
            "paper": walked and clicked,
        }

        def allowed(way: Calibration) -> bool:
            if way.base:
                return filmed and self._in_metres(way) and allowed(Calibration.parse(way.base))
            if way.lines and not clicked:
                return False
            if way.n_points and self.point_sets and way.n_points not in self.point_sets:
                return False
            return (
                alone if way.name == "known" else possible[way.kind] and (boards or not way.board)
            )

        ways = map(Calibration.parse, [] if self.waits else self.parameters["calibrations"])
        return [way.name for way in ways if allowed(way)]

    def chessboards_of(self, way: str) -> list[str]:
        """Return the cameras whose lenses from a chessboard a calibration, or its base, reads."""
        own = [name for name, camera in self.cameras.items() if camera.chessboard]
        found = Calibration.parse(way)
        kind = Calibration.parse(found.base).kind if found.base else found.kind
        stated = {"board": self.board, "wand": self.wand}.get(kind) or {}
        reads = {
            "board": "lenses" not in stated and len(own) == len(self.cameras),
            "wand": "lenses" not in stated,
            ALONE: True,
        }
        return own if reads.get(kind, found.board) else []

    def has_covariance(self, way: Calibration) -> bool:
        """Return whether the covariance of the cameras of a calibration is known."""
        return way.has_covariance or (way.kind == "file" and self.file_covariance is not None)

    def _in_metres(self, way: Calibration) -> bool:
        """Say whether a calibration gives metres: those of walks do by the points of a court."""
        return way.variant is None or self.court is not None

    def unscaled(self) -> list[str]:
        """Return those of `take_calibrations` that measure no take, as they give no metres."""
        wanted = self.parameters["take_calibrations"]
        ways = (way for way in self.calibrations() if way in wanted)
        return [way for way in ways if not self._in_metres(Calibration.parse(way))]

    def has_scale(self) -> bool:
        """Say whether people alone give lengths in metres.

        All persons of a filmed take have a height, or lengths are known.
        """
        shown = [take.subjects for take in self.takes.values() if take.cameras]
        heights = [[self.subjects[name].height_m for name in names] for names in shown]
        return bool(shown and self.known_lengths) or any(each and all(each) for each in heights)

    def take_calibrations(self) -> list[str]:
        """Return the session's calibrations that its takes are measured with."""
        wanted, unscaled = self.parameters["take_calibrations"], self.unscaled()
        return [way for way in self.calibrations() if way in wanted and way not in unscaled]

    def fusions(self, key: str = "fusions") -> list[str]:
        """Return the study's fusions for which this session names cameras."""
        return [name for name in self.parameters[key] if self.fused_cameras(name)]

    def fused_cameras(self, fusion: str) -> tuple[str, ...]:
        """Return the cameras of a fusion; empty where the session names none."""
        how = Fusion.parse(fusion)
        if how.rule == HALFBODY:
            return tuple((self.halfbody or {}).values())
        return {"all": tuple(self.cameras), **self.views}.get(how.cameras, ())

    def fusions_of(self, take: Take, key: str = "fusions") -> list[str]:
        """Return those fusions of which enough cameras see a take (`fused_cameras_of`)."""
        return [name for name in self.fusions(key) if self.fused_cameras_of(take, name)]

    def fused_cameras_of(self, take: Take, fusion: str) -> tuple[str, ...]:
        """Return the cameras of a fusion that see a take; empty if it needs more.

        It needs two cameras, `halfbody` all three.
        """
        named = self.fused_cameras(fusion)
        used = tuple(name for name in named if name in take.cameras)
        needed = len(named) if Fusion.parse(fusion).rule == HALFBODY else 2
        return used if len(used) >= needed else ()

    def measures(self, take: Take) -> bool:
        """Say whether fixed cameras measure a take: there is a calibration, and a fusion of it."""
        return bool(self.take_calibrations() and self.fusions_of(take))

    def variants(self) -> list[Variant]:
        """Return all structures from motion of the sweep, each choice of images once."""
        sweep = self.parameters["sweep"]
        return [
            Variant(mapper, count, offset)
            for mapper in sweep["mappers"]
            for count in sweep["n_images"]
            for offset in self._offsets(count)
        ]

    def _offsets(self, n_images: int) -> Iterable[int]:
        sweep, n_frames = self.parameters["sweep"], self.n_walk_frames()
        if n_images > sweep["offsets_up_to"]:
            return [0]
        if n_frames is None or self.parameters["map_images"]["rule"] != "even":
            return range(sweep["n_offsets"])
        return distinct_offsets(n_images, n_frames, sweep["n_offsets"])

    def n_walk_frames(self) -> int | None:
        """Return how many pictures the walks give, None where only decoding a video tells."""
        if self.virtual:
            return self.virtual["walk_frames"]
        if not self.walks or not all(Path(path).is_dir() for path in self.walks.values()):
            return None
        there = [file for path in self.walks.values() for file in Path(path).iterdir()]
        visible = [file for file in there if not file.name.startswith(".")]
        return sum(file.suffix.lower() in files.PHOTOS for file in visible)

    def recordings(self) -> list[str]:
        """Return the files and folders of a user that its videos, photos and devices are in."""
        static = [camera.static for camera in self.cameras.values()]
        takes = self.takes.values()
        filmed = [path for take in takes for path in take.videos.values()]
        devices = [device.file for take in takes for device in take.devices.values()]
        named = [*static, *self.walks.values(), *filmed, *devices]
        return [path for path in named if path and not path.startswith(f"{paths.RESULTS}/")]

    def cameras_and_walks(self) -> list[str]:
        """Return the names of all cameras and walks."""
        return [*self.cameras, *self.walks]

    def recorded_empty(self) -> list[str]:
        """Return the names of the recordings of the hall: of cameras before takes, and of walks."""
        return [*(name for name, camera in self.cameras.items() if camera.static), *self.walks]

    def first_take(self, camera: str) -> str | None:
        """Return the first take that a camera films; None without one."""
        return next((name for name, take in self.takes.items() if camera in take.videos), None)

    def shows_court(self) -> bool:
        """Say whether painted lines can check a calibration file: all cameras film the court."""
        filmed = (one.static or self.first_take(name) for name, one in self.cameras.items())
        return bool(self.calibration_file and self.court and len(self.cameras) > 1 and all(filmed))

    def filmed_halls(self) -> dict[str, list[str]]:
        """Return the cameras that film the hall together, by take; "" for static recordings.

        Takes whose cameras all have static recordings are not named: these show the hall.
        """
        static = [name for name, camera in self.cameras.items() if camera.static]
        of_takes = {
            name: [camera for camera in self.cameras if camera in take.videos]
            for name, take in self.takes.items()
        }
        halls = {"": static} | {
            take: cameras for take, cameras in of_takes.items() if not set(cameras) <= set(static)
        }
        return {name: cameras for name, cameras in halls.items() if len(cameras) > 1}

    def films_boards(self) -> bool:
        """Say whether the session is virtual and its cameras take pictures of a chessboard."""
        return bool(self.virtual and self.virtual.get("boards"))


@dataclass(frozen=True)
class Network:
    """A file of a model or detector with its checksum, and the names of the outputs to keep.

    It is a member of an artefact, or a `file` of the user. A TFLite network is converted, an ONNX
    file is run as it is.
    """

    sha256: str
    artefact: str | None = None
    member: str | None = None
    file: str | None = None
    outputs: list | None = None

    @property
    def path(self) -> str:
        """The file."""
        member = paths.EXTERNAL_MEMBER.format(artefact=self.artefact, member=self.member)
        return self.file or member

    @property
    def is_onnx(self) -> bool:
        """Whether it is run as it is."""
        return self.path.endswith(".onnx")


@dataclass(frozen=True)
class Detector:
    """A person detector of config/detectors.yaml, or of a model that finds persons itself."""

    decoder: str
    network: Network
    options: dict[str, Any] = field(default_factory=dict)  # of its decoder

    def decoder_options(self) -> dict[str, Any]:
        """Return the keyword arguments of `courtside.pose.open_network.person_detector`."""
        return {"decoder": self.decoder, **_outputs(self.network), **self.options}


@dataclass(frozen=True)
class Model:
    """A 2D pose model of config/models.yaml, or a skeleton whose keypoints another program finds.

    Without `tracking` it searches the person in every frame. Without `landmarks` its decoder is
    `imported`; without `detector` it finds persons itself.
    """

    name: str
    decoder: str
    skeleton: str
    detector: Detector | None = None
    landmarks: Network | None = None
    tracking: bool = True
    options: dict[str, Any] = field(default_factory=dict)  # of its decoder

    @property
    def metric_body(self) -> bool:
        """Whether it estimates the body in metres from one picture (`xyz_in_body`)."""
        return self.decoder == "blazepose"

    def decoder_options(self) -> dict[str, Any]:
        """Return the keyword arguments of `courtside.pose.open_network.landmark_network`."""
        outputs = _outputs(self.landmarks) if self.landmarks else {}
        return {"decoder": self.decoder, **outputs, **self.options}


def _outputs(network: Network) -> dict[str, Any]:
    return {"outputs": network.outputs} if network.is_onnx and network.outputs else {}


@dataclass(frozen=True)
class Study:
    """Everything the rules need to know."""

    sessions: dict[str, Session]
    artefacts: dict[str, Artefact]
    models: dict[str, Model]
    parameters: dict[str, Any]  # the study's configuration as checked
    folder: Path = Path("config")
    file: str = ""  # the file or files that a user gave it in, for messages

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

    def where(self, session: Session, key: str) -> str:
        """Return file and key in which a parameter of a session stands, for messages."""
        if yaml_files.same(key, session.override, session.parameters):
            return f"{session.file}: override.{key}"
        file = yaml_files.file_of(key, self.parameters, self.file, self.folder / DEFAULT)
        return f"{file}: {key}"

    def stages(self, model: str) -> tuple[str, ...]:
        """Return the stages of a network's skeletons; the last is the best.

        Joints are corrected only of networks whose offsets were estimated.
        """
        estimated = (self.folder / paths.OFFSETS_CSV.format(model=model)).is_file()
        return paths.STAGES if estimated else paths.STAGES[:-1]

    def written_stages(self, model: str) -> tuple[str, ...]:
        """Return the stages that can be written: the model's, too, where joints are corrected."""
        stages = self.stages(model)
        return (*stages, paths.MODELLED) if stages == paths.STAGES else stages

    def court_file(self, session: Session) -> Path | None:
        """Return the file of a session's court, None without a court."""
        return self.folder / paths.COURT_YAML.format(court=session.court) if session.court else None

    def skeleton_file(self, model: str) -> Path:
        """Return the file of the skeleton of a network."""
        return self.skeleton_yaml(self.models[model].skeleton)

    def skeleton_yaml(self, name: str) -> Path:
        """Return the file of a skeleton."""
        return self.folder / paths.SKELETON_YAML.format(skeleton=name)


def model(name: str, content: dict[str, Any], detectors: dict[str, Any]) -> Model:
    """Build a model from its checked entry in config/models.yaml.

    `detectors` is the content of config/detectors.yaml.
    """
    own = {key: content[key] for key in ("decoder", "skeleton", "tracking") if key in content}
    others = (*own, "detector", "landmarks")
    options = {key: value for key, value in content.items() if key not in others}
    found = None
    if content["decoder"] not in ONE_STAGE:
        found = detector(detectors[content.get("detector", DEFAULT_DETECTOR)])
    landmarks = Network(**content["landmarks"])
    return Model(name=name, **own, detector=found, landmarks=landmarks, options=options)


def detector(content: dict[str, Any]) -> Detector:
    """Build a detector from its checked entry in config/detectors.yaml."""
    options = {key: value for key, value in content.items() if key not in ("decoder", "network")}
    return Detector(content["decoder"], Network(**content["network"]), options)
