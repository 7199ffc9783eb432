"""Methods of the study, parsed from their names: calibration, structure from motion, fusion."""

import re
from dataclasses import dataclass, replace

from courtside.study.errors import InputError

# The default choice of bridging images is o0; a name leaves it out.
CALIBRATION = re.compile(
    r"file|(?P<alone>known|board|wand|people)"
    r"|(?P<points>known|dlt)(?P<n_points>[0-9]+)(?P<board>-board)?"
    r"|(?P<kind>sfm|sim3|paper)(?P<mapped>-global)?-n(?P<n_images>[0-9]+)"
    r"(-o(?P<offset>[0-9]+))?(?P<lines>-lines)?"
)
VARIANT = re.compile(r"(?P<mapper>[a-z]+)-n(?P<n_images>[0-9]+)-o(?P<offset>[0-9]+)")
PEOPLE = "-people"  # behind the name of a calibration: refined by people
ALONE = "people-alone"  # the kind of a calibration from people and nothing else
IMPORTED = "imported"  # in place of a calibration: 3D joints are another program's
DEVICES = "devices"  # in place of a calibration: joints are a device's, its source the fusion
HALFBODY = "halfbody"  # the paper's rule for three cameras
# Stages of skeletons in words.
STAGE_WORDS = {"pose3d": "raw", "pose3d_filtered": "filtered", "pose3d_corrected": "corrected"}
# Of takes of a session with a walk and no court.
NEEDS_COURT = (
    "the walk gives no metres without a court, so takes are not measured; name a court, or "
    "describe one (config/README.md, A court of your own)"
)
OFFSETS = 3  # choices of so many bridging images: they start thirds of their spacing late


@dataclass(frozen=True)
class Variant:
    """One structure from motion of a session's sweep."""

    mapper: str  # `global` or `incremental`
    n_images: int  # number of bridging images
    offset: int = 0  # which choice of so many images

    @classmethod
    def parse(cls, name: str) -> "Variant":
        """Parse a name such as `global-n40-o0`."""
        found = VARIANT.fullmatch(name)
        if found is None:
            raise InputError(
                f"expected a structure from motion such as global-n40-o0, found {name!r}"
            )
        return cls(found["mapper"], int(found["n_images"]), int(found["offset"]))

    @property
    def name(self) -> str:
        """Its name in paths: `{mapper}-n{n_images}-o{offset}`."""
        return f"{self.mapper}-n{self.n_images}-o{self.offset}"


def fewer_images(n_images: int) -> str:
    """Return the key of a session, as YAML, that asks for no more bridging images than so many.

    Sessions without fixed cameras map the sweep, others the images of their calibrations.
    """
    n_images = max(2, n_images)
    sweep, ways = f"{{n_images: [{n_images}], n_offsets: 1}}", f"[sfm-n{n_images}]"
    return f"override: {{sweep: {sweep}, calibrations: {ways}, take_calibrations: {ways}}}"


def start(n_images: int, n_frames: int, offset: int, every: int = 1) -> int:
    """Return how late the evenly spaced images of a choice start, in steps of `every` frames."""
    return round(offset * (n_frames - 1) / (n_images - 1) / OFFSETS / every)


def distinct_offsets(n_images: int, n_frames: int, n_offsets: int) -> list[int]:
    """Return the offsets whose choices of evenly spaced images differ, the first of equal ones.

    Where images are spaced by fewer than three frames, thirds of the spacing round to the same
    frames.
    """
    if n_images >= n_frames:
        return [0]
    starts: dict[int, int] = {}
    for offset in range(n_offsets):
        starts.setdefault(start(n_images, n_frames, offset), offset)
    return list(starts.values())


@dataclass(frozen=True)
class Calibration:
    """A way to find the fixed cameras of a session."""

    # `file`, `known`, `board`, `wand`, `sfm-n40`, `sfm-n40-o1`, `sfm-n40-lines`, `sim3-n40`,
    # `paper-n40`, `paper-global-n40`, `known18`, `known8-board`, `dlt18`, `people`, `file-people`
    # and the like
    name: str
    # `file` (made elsewhere); from structure from motion: `sfm` (ties and clicks adjusted
    # together), `sim3` (one similarity), `paper` (the paper's alignment); from clicks alone:
    # `known` (resection; without a number all points, all cameras together), `dlt`; from a board
    # that several cameras see: `board`; from a wand: `wand`; from people in takes and
    # nothing else: `people-alone`; `people`: another calibration, refined by people in takes
    kind: str
    # The structure from motion that it rests on. Only `paper-n40` is mapped incrementally, as in
    # the paper
    variant: Variant | None = None
    n_points: int | None = None  # number of clicked points, where they are all that it rests on
    board: bool = False  # whether lenses come from pictures of a chessboard
    lines: bool = False  # whether the court's painted lines are adjusted with ties and clicks
    base: str | None = None  # the calibration that people refine, of kind `people`

    @classmethod
    def parse(cls, name: str) -> "Calibration":
        """Parse a name of the configuration's `calibrations`."""
        if name.endswith(PEOPLE):
            of = cls.parse(name.removesuffix(PEOPLE))
            if of.base is None and of.kind != ALONE:
                return replace(of, name=name, kind="people", base=of.name)
        found = CALIBRATION.fullmatch(name)
        if (
            found is None
            or (found["mapped"] and found["kind"] != "paper")
            or (found["lines"] and found["kind"] != "sfm")
        ):
            raise InputError(
                f"expected a calibration such as file, sfm-n40 or known18, found {name!r}"
            )
        if found["points"]:
            n_points, board = int(found["n_points"]), bool(found["board"])
            return cls(name, found["points"], n_points=n_points, board=board)
        if name == "people":
            return cls(name, ALONE)
        if not found["kind"]:
            return cls(name, found["alone"] or "file")
        incremental = found["kind"] == "paper" and not found["mapped"]
        mapper = "incremental" if incremental else "global"
        variant = Variant(mapper, int(found["n_images"]), int(found["offset"] or 0))
        return cls(name, found["kind"], variant, lines=bool(found["lines"]))

    @property
    def of_clicks(self) -> bool:
        """Whether it is fitted to clicked points, where there are any."""
        return self.kind not in ("file", "board", "people", ALONE)

    @property
    def has_covariance(self) -> bool:
        """Whether the covariance of the cameras is known."""
        return self.kind in ("sfm", "people", ALONE) or self.name in ("known", "board", "wand")


@dataclass(frozen=True)
class Fusion:
    """A way to fuse views into 3D joints."""

    # `all-robust`, `two-dlt`, `all-unsteady`, `halfbody`; `trc` of another program's 3D joints
    name: str
    # Name of the set of cameras: `all`, or a key of the session's `views`; empty for `halfbody` and
    # `trc`
    cameras: str
    rule: str  # `robust`, `dlt`, `halfbody` or `trc`
    # Whether the shake of cameras is taken out, in takes where it is measured
    steadied: bool = True

    @classmethod
    def parse(cls, name: str) -> "Fusion":
        """Parse a name of the configuration's `fusions` or `compared_fusions`."""
        cameras, _, rule = name.rpartition("-")
        unsteady = rule == "unsteady"
        return cls(name, cameras, "robust" if unsteady else rule, steadied=not unsteady)
