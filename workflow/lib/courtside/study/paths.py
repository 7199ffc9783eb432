"""The name of every file of the study, as a pattern with Snakemake's wildcards.

Fill a pattern with `str.format`. Names in braces are wildcards: `session`, `take`, `camera`,
`model` (a pose network), `calibration` and `fusion` (see `courtside.study.methods`); `mapper`,
`n_images` and `offset` of a structure from motion, ... Log files are named in the rules, each by
the one rule that writes it.
"""

from collections.abc import Iterable, Mapping
from itertools import product
from typing import Any

RESULTS = "results"
SESSION = "results/{session}"
TAKE = SESSION + "/takes/{take}"
FUSED = "{calibration}/{fusion}/{model}"
OF_FUSED = "{take}.{calibration}.{fusion}.{model}"  # in names of log and benchmark files
FORMATS = ("pdf", "png", "csv")  # of every figure
STAGES = ("pose3d", "pose3d_filtered", "pose3d_corrected")
MODELLED = "pose3d_ik"  # made beside the last of these: joints of the skeletal model

# From outside, and the networks made of it.
EXTERNAL = "results/external/"
NETWORKS = "results/networks/"
EXTERNAL_MEMBER = EXTERNAL + "{artefact}/{member}"
ONNX = NETWORKS + "{model}/{part}.onnx"
CHECKED_ONNX = NETWORKS + "{model}/{part}.checked.onnx"

# Simulated recordings and their truth.
VIRTUAL = "results/virtual/{session}"
VIRTUAL_TAKE = VIRTUAL + "/takes/{take}"
RECORDING = VIRTUAL + "/{name}.mp4"  # of a camera or a walk
VIRTUAL_BOARDS = VIRTUAL + "/boards"
BACKDROPS = VIRTUAL + "/backdrops.npz"
VIRTUAL_CLICKS = VIRTUAL + "/court_points.csv"
TRUTH = VIRTUAL + "/truth.npz"
TRUE_TAKE = VIRTUAL_TAKE + "/truth.npz"
VIRTUAL_FILM = VIRTUAL_TAKE + "/{name}.mp4"
VIRTUAL_DEVICE = VIRTUAL_TAKE + "/{name}.{suffix}"
RACKET_CLICKS = VIRTUAL_TAKE + "/racket.csv"

# Pictures of fixed cameras and walks.
STATIC = SESSION + "/static/{camera}.png"
STATIC_CHECK = SESSION + "/static/{camera}.csv"
FRAMES = SESSION + "/frames/{walk}"
FRAME_TABLE = SESSION + "/frames/{walk}.csv"
MOVEMENT = TAKE + "/movement/{camera}.csv"
SHAKE = TAKE + "/shake/{camera}.csv"
BACKGROUND = TAKE + "/background/{camera}.png"

# Structure from motion.
SFM = SESSION + "/sfm/"
VARIANT = "{mapper}-n{n_images}-o{offset}"  # see `courtside.study.methods.Variant`
FEATURES = SFM + "features.db"
FEATURE_TABLE = SFM + "features.csv"
MATCHES = SFM + "matches.db"
MATCH_TABLE = SFM + "matches.csv"
MODEL = tuple(  # a COLMAP model
    SFM + VARIANT + f"/{part}.bin" for part in ("cameras", "images", "points3D", "rigs", "frames")
)
SFM_SUMMARY = SFM + VARIANT + "/summary.json"
TIES = SFM + VARIANT + "/ties.npz"
BENCHMARK = SESSION + "/benchmarks/{rule}/{job}.tsv"

# Calibration of the fixed cameras.
CALIBRATION = SESSION + "/calibration/{calibration}"
CAMERAS = CALIBRATION + "/cameras.toml"
CAMERA_COVARIANCE = CALIBRATION + "/covariance.npz"
CALIBRATION_QUALITY = CALIBRATION + "/quality.json"
CAMERA_EXPORT = CALIBRATION + "/other_programs"
REFINEMENT = CALIBRATION + "/refinement.csv"
KNOCKS = CALIBRATION + "/knocks.csv"
CALIBRATION_CHECK = SESSION + "/calibration/file/check.{suffix}"  # json or csv
COURT_CHECK = SESSION + "/calibration/file/court.{suffix}"  # likewise
VIDEO_CHECK = SESSION + "/calibration/file/videos.{suffix}"  # likewise
COURT_PROPOSALS = CALIBRATION + "/proposals.csv"
FOUND_COURT = SESSION + "/calibration/court_lines/{part}"  # found.json or proposals.csv
LENS = SESSION + "/calibration/lens/{camera}.toml"
CLICKS = "data/{session}/court_points.csv"  # where clicks are saved if the session does not say it
CLICKING_PAGE = SESSION + "/pages/clicking.html"

# Keypoints, clocks and skeletons of a take.
POSE2D = TAKE + "/pose2d/{model}/{camera}.npz"
POSE2D_STEADIED = TAKE + "/pose2d_steadied/{calibration}/{model}/{camera}.npz"  # without shake
SHAKE_TAKEN_OUT = POSE2D_STEADIED.replace(".npz", ".csv")  # shake measured, and knocks
CAMERA_CLOCKS = TAKE + "/sync/{calibration}/cameras.{model}.json"
FOUND_PEOPLE = TAKE + "/people/{calibration}/{model}.found.npz"
PEOPLE = TAKE + "/people/{calibration}/{model}.npz"
PEOPLE_CSV = "data/{session}/people.csv"  # where names are saved if the session does not say it
PEOPLE_PAGE = TAKE + "/pages/people.html"
SKELETONS = TAKE + "/{stage}/" + FUSED + ".npz"
POSE3D, POSE3D_FILTERED, POSE3D_CORRECTED = (SKELETONS.replace("{stage}", name) for name in STAGES)
POSE3D_IK = SKELETONS.replace("{stage}", MODELLED)
SKELETAL_MOTION = TAKE + "/motion/" + FUSED + ".npz"
JOINT_ANGLES = TAKE + "/motion/" + FUSED + ".angles.csv"
POSE3D_IMPORTED = TAKE + "/pose3d/imported/trc/{model}.npz"
EXPORT = TAKE + "/{stage}/" + FUSED + ".{person}.{suffix}"
MOTION_EXPORT = TAKE + "/motion/" + FUSED + ".{person}.{suffix}"
MODELLED_EXPORT = EXPORT.replace("{stage}", MODELLED)  # mot: motion, osim: model, for OpenSim
POSE2SIM = TAKE + "/pose2sim/" + FUSED
KINEMATICS = TAKE + "/kinematics/" + FUSED
FRAME_MEASURES = KINEMATICS + ".frames.csv"
MEASURES = KINEMATICS + ".summary.csv"
CUTOFFS = KINEMATICS + ".cutoffs.csv"
FOOTWORK = TAKE + "/footwork/" + FUSED
CONTACTS = FOOTWORK + ".contacts.npz"
STEPS = FOOTWORK + ".steps.csv"
FOOT_EVENTS = FOOTWORK + ".events.csv"
FOOTWORK_MEASURES = FOOTWORK + ".summary.csv"
STROKES = TAKE + "/strokes/" + FUSED + ".csv"
REACTIONS = TAKE + "/strokes/" + FUSED + ".reactions.csv"
QUALITY = TAKE + "/quality.csv"
QUALITY_PAGE = SESSION + "/pages/quality.html"
VIEW_DISTANCES = TAKE + "/views/{calibration}.{model}.csv"
OVERLAY_VIDEO = TAKE + "/videos/" + FUSED + ".{camera}.mp4"
VIEWER = TAKE + "/pages/viewer.{model}.html"

# Devices of their own. `source`: a skeleton that a device gives.
DEVICE = TAKE + "/devices/{device}.npz"
DEVICE_EXPORT = TAKE + "/devices/{device}.{suffix}"
COLOUR_VIDEO = TAKE + "/devices/{device}.mp4"
COLOUR_FRAMES = TAKE + "/devices/{device}.frames.csv"
COLOUR_CAMERA = TAKE + "/devices/{device}.toml"
SOURCE = TAKE + "/devices/{source}.{model}.npz"
CAMERA_SOURCE = SOURCE.replace("{source}", "cameras")
RGB_SOURCE = SOURCE.replace("{source}", "{device}-rgb")
DEPTH_SOURCE = SOURCE.replace("{source}", "{device}-depth")
CORRECTED_SOURCE = SOURCE.replace("{source}", "{device}-corrected")
CORRECTED_BVH = TAKE + "/devices/{device}-corrected.{model}.bvh"
CORRECTED_GLB = CORRECTED_BVH.replace(".bvh", ".glb")
SOURCE_EXPORT = TAKE + "/devices/{source}.{model}.{suffix}"
CORRECTED_EVENTS = TAKE + "/devices/{device}-corrected.{model}.events.json"
CORRECTION_REPORT = TAKE + "/devices/{device}-corrected.{model}.json"
FITTED_SOURCE = TAKE + "/pose3d_ik/devices/{source}/{model}.npz"  # by the skeletal model
SOURCE_MOTION = TAKE + "/motion/devices/{source}/{model}.npz"
SOURCE_ANGLES = TAKE + "/motion/devices/{source}/{model}.angles.csv"
DEVICE_CLOCKS = TAKE + "/sync/devices.{model}.json"
DEVICE_EVENTS = TAKE + "/sync/devices.{model}.events.csv"
DEVICE_CHECKS = TAKE + "/sync/devices.{model}.checks.csv"
WRISTS = TAKE + "/sync/{clocks}.{model}.wrists.csv"  # clocks: devices or events
EVENTS = TAKE + "/sync/events.{model}.json"
OWN_EVENTS = TAKE + "/sync/events.{model}.csv"
BODY = TAKE + "/body/{source}.{model}.npz"
BODY_FRAME = TAKE + "/body/{source}.{model}.json"
ARCS = TAKE + "/body/arcs.{model}.{what}.csv"  # what: paths or distortion

# Errors against truth.
EVALUATION = SESSION + "/evaluation/"
SFM_ERRORS = EVALUATION + VARIANT + ".csv"
KNOWN_ERRORS = EVALUATION + "known.csv"
RACKET_LENGTHS = EVALUATION + "racket.csv"
JOINT_OFFSETS = NETWORKS + "{model}/joint_offsets.csv"
JOINT_ERRORS = NETWORKS + "{model}/joint_errors.csv"
SKIN_DEPTHS = EVALUATION + "skin_depths.{device}.{model}.csv"
TAKE_EVALUATION = EVALUATION + "takes/{take}/"
ERRORS = TAKE_EVALUATION + "errors/{calibration}.{model}.csv"
RELIABILITY = TAKE_EVALUATION + "reliability/{calibration}.{model}.csv"
CLOCK_ERRORS = TAKE_EVALUATION + "clocks/{calibration}.{model}.csv"
MEASURE_ERRORS = TAKE_EVALUATION + "kinematics/" + FUSED + ".csv"
CONTACT_ERRORS = TAKE_EVALUATION + "contacts/" + FUSED + ".csv"
STROKE_ERRORS = TAKE_EVALUATION + "strokes/" + FUSED + ".csv"
REACTION_ERRORS = TAKE_EVALUATION + "reactions/" + FUSED + ".csv"
ANGLE_ERRORS = TAKE_EVALUATION + "angles/{calibration}.{model}.csv"
GAINS = TAKE_EVALUATION + "gains/{stage}.{calibration}.{model}.csv"
DETECTION_ERRORS = TAKE_EVALUATION + "detection/{model}.csv"
ROUND_TRIP = TAKE_EVALUATION + "round_trip/{calibration}.{model}.csv"
SOURCE_ERRORS = TAKE_EVALUATION + "sources/{model}.errors.csv"
SOURCE_ANGLE_ERRORS = TAKE_EVALUATION + "sources/{model}.angles.csv"
ERROR_PARTS = TAKE_EVALUATION + "sources/{model}.parts.csv"
TRUE_PATHS = TAKE_EVALUATION + "sources/{model}.true_paths.csv"
TRUE_DISTORTION = TAKE_EVALUATION + "sources/{model}.true_distortion.csv"
BODY_FRAME_ERRORS = TAKE_EVALUATION + "body_frames/{model}.csv"

# Figures, without their format, and tables.
STUDY_FIGURE = "results/figures/{figure}"
SESSION_FIGURE = SESSION + "/figures/{figure}"
TAKE_FIGURE = TAKE + "/figures/{figure}.{calibration}.{fusion}.{model}"
CALIBRATED_FIGURE = TAKE + "/figures/{figure}.{calibration}.{model}"
DEVICE_FIGURE = TAKE + "/figures/{figure}.{model}"
PLAN_FIGURE = "results/plans/{plan}/{figure}"
SHAKE_TEXT = TAKE_FIGURE.replace("{figure}", "shake") + ".txt"
CALIBRATION_TABLE = "results/figures/calibration.csv"
WAYS_TABLE = "results/figures/ways.csv"
PLAYERS_TABLE = "results/figures/players.csv"
ANGLES_TABLE = "results/figures/angles.csv"
STUDY_TABLE = "results/figures/study.csv"
NETWORK_PAIRS = "results/figures/agreement.pairs.csv"
NETWORK_AGREEMENT = "results/figures/agreement.table.csv"
NETWORK_ERRORS = "results/figures/networks.table.csv"

# Names in the folder of STUDY_FIGURE that are taken: no condition's figure may have them.
TAKEN_FIGURES = (
    *("agreement", "archive", "badminton_fig05", "badminton_fig12", "clock_errors", "networks"),
    *("reliability", "smoothness", "thesis_fig3_1", "thesis_fig3_2"),
    *("angles", "calibration", "players", "study", "ways"),  # tables
)

# Below the folder config/.
COURT_YAML = "courts/{court}.yaml"
SKELETON_YAML = "skeletons/{skeleton}.yaml"
OFFSETS_CSV = "joint_offsets/{model}.csv"  # from a network's joints to the anatomical ones
ERRORS_CSV = "joint_errors/{model}.csv"  # of a network's joints, that residuals do not show
DERIVED_JOINTS_YAML = "derived_joints.yaml"  # joints that are computed from others
PUBLISHED_CSV = "published/{table}.csv"
PLAN_YAML = "plans/{plan}.yaml"
SESSION_YAML = "sessions/{session}.yaml"

# Of a run.
REPORT = "results/report.html"
RUN = "results/run"
CHECKSUMS = RUN + "/checksums.json"
WITHOUT_CONSENT = RUN + "/without_consent/{session}.txt"
SIDECAR = "run/provenance/{file}.json"  # below `RESULTS`, as is the file


def part(pattern: str, **known: str) -> str:
    """Fill some wildcards of a pattern, and leave the others."""
    for name, value in known.items():
        pattern = pattern.replace(f"{{{name}}}", value)
    return pattern


def each(pattern: str, **values: str | int | Iterable[str]) -> list[str]:
    """Fill a pattern with every combination of values; the last name varies fastest."""
    lists = [[one] if isinstance(one, str | int) else one for one in values.values()]
    return [pattern.format(**dict(zip(values, chosen, strict=True))) for chosen in product(*lists)]


def files_in(settings: Iterable[Mapping[str, Any]], *keys: str) -> list[str]:
    """Return the files that settings name under some keys (one, a list, by name), each once."""
    found: list[str] = []
    for one, key in product(settings, keys):
        named = one[key] or []
        named = named.values() if isinstance(named, Mapping) else named
        found += [named] if isinstance(named, str) else named
    return list(dict.fromkeys(found))


def formats(stems: list[str]) -> list[str]:
    """Return the files of figures, of every format."""
    return [f"{stem}.{suffix}" for stem in stems for suffix in FORMATS]
