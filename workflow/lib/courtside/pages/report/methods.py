"""The methods section of the report, from the configuration of the run, with its sources."""

from collections.abc import Iterable, Mapping, Sequence

from markupsafe import Markup

from courtside.kinematics import measures
from courtside.kinematics.cutoffs import RESIDUAL
from courtside.pages import page
from courtside.study.methods import Calibration, Fusion

SOURCES = {
    "paper": "H. Shishido, I. Kitahara. Camera calibration for markerless 3D pose estimation and "
    "practice in badminton video processing, 2020 (in Japanese).",
    "thesis": "Homma. Three-dimensional measurement of full-body motion from a single viewpoint, "
    "thesis, National Institute of Technology, Nagaoka College, 2023 (in Japanese).",
    "sift": "D. G. Lowe. Distinctive image features from scale-invariant keypoints. IJCV 60, 2004.",
    "colmap": "J. L. Schönberger, J.-M. Frahm. Structure-from-motion revisited. CVPR 2016.",
    "glomap": "L. Pan, D. Baráth, M. Pollefeys, J. L. Schönberger. Global structure-from-motion "
    "revisited. ECCV 2024.",
    "blazepose": "V. Bazarevsky and others. BlazePose: on-device real-time body pose tracking. "
    "CVPR workshop on computer vision for augmented and virtual reality, 2020.",
    "hartley": "R. Hartley, A. Zisserman. Multiple view geometry in computer vision, 2nd "
    "edition, 2004.",
    "winter": "D. A. Winter. Biomechanics and motor control of human movement, 4th edition, 2009.",
    "leva": "P. de Leva. Adjustments to Zatsiorsky-Seluyanov's segment inertia parameters. "
    "Journal of Biomechanics 29, 1996.",
}
CALIBRATED = {  # by the kind of a calibration
    "sfm": "calibrated by one bundle adjustment of structure from motion over the pictures of a "
    "walk and of the clicked court points",
    "sim3": "calibrated by structure from motion over the pictures of a walk, aligned to the court "
    "points by one similarity transform",
    "paper": "calibrated by structure from motion, scaled and aligned as in Shishido & Kitahara "
    "(2020, equations 2 to 5)",
    "known": "calibrated from clicked court points alone",
    "board": "calibrated from a board of known size that several cameras saw, all cameras and all "
    "places of the board adjusted together",
    "wand": "calibrated from a wand of known length that several cameras saw, all cameras and all "
    "places of the wand adjusted together",
    "dlt": "calibrated from clicked court points alone, by the linear method (DLT)",
    "file": "taken from a calibration made elsewhere",
    "people-alone": "calibrated from the people in takes alone, the scale from their stated "
    "heights or known lengths",
    "people": "calibrated in another way and refined by the people in takes, where people and "
    "points that the adjustment did not see say that this is better",
}
# Of the kind `known` with all points: those of a court, or points with places of their own
BY_POINTS = "calibrated from clicked points at known places alone"
UNCLICKED = (  # of the kind `sfm`
    "calibrated by one bundle adjustment of structure from motion over the pictures of a walk "
    "alone, without a court: scale and axes are arbitrary"
)
WITH_LINES = (  # of the kind `sfm`
    "calibrated by one bundle adjustment of structure from motion over the pictures of a walk, of "
    "the clicked court points and of the court's painted lines"
)
AGAIN = "taken from an earlier calibration, with its covariance"  # of a file
FUSED = {  # by the rule of a fusion
    "robust": "views are weighted, and those that contradict the others lose their weight",
    "dlt": "all views have the same weight (DLT)",
    "halfbody": "half of the body from two cameras each",
    "trc": "3D joints as another program gave them",
}
Cutoffs = dict[str, float]  # Hz of each group of joints
UNSTEADY = "views are weighted, and camera shake is not corrected"


def paragraphs(
    parameters: dict, sessions: Sequence[dict], used_hz: Mapping[tuple[str, str], Cutoffs]
) -> Markup:
    """Return the methods as HTML: paragraphs, then the sources that they cite.

    `parameters` are the study's steps as configured: `match_images`, `adjust_network` ... Each of
    `sessions` has `name`, `calibration` (of its takes), `clicked` (whether court points were used
    there), `has_covariance` (of this calibration), `mapper`, `n_images`, `fusion`, `model`,
    `imported` (whether another program found the joints), `virtual`, `overrides` ({step: {key:
    value}}), `takes`. `used_hz` are the cut-offs of the filter by session and take, as used.
    """
    files = [take["files"] for session in sessions for take in session["takes"]]
    mapped = sorted({(s["mapper"], s["n_images"]) for s in sessions if s["mapper"]})
    networks = _different([one for one in sessions if not one["imported"]], "model")
    imported = [one for one in sessions if one["imported"]]
    used = {
        "posed": any(one.get("pose3d") for one in files),
        "compared": any(one.get("checks") for one in files),
    }
    cited = _cited({mapper for mapper, _ in mapped}, networks, **used)
    return page.render(
        "report_methods.html",
        step=parameters,
        bias=measures.MODEL_BIAS,
        real=[session["name"] for session in sessions if not session["virtual"]],
        simulated=[session["name"] for session in sessions if session["virtual"]],
        calibrations=_calibrations(sessions),
        mapped=mapped,
        clicked=any(session["mapper"] and session["clicked"] for session in sessions),
        networks=networks,
        imported=[
            (name, _users(imported, "model", name)) for name in _different(imported, "model")
        ],
        uncertain=[session["name"] for session in sessions if _is_uncertain(session)],
        fusions=[(name, _fused(name)) for name in _different(sessions, "fusion")],
        overrides=_overrides(sessions),
        cited=cited,
        sources=[words for name, words in SOURCES.items() if name in cited],
        names=_names,
        cut=_cut,
        lowered=_lowered(parameters, sessions, used_hz),
        **used,
    )


def _cited(mappers: set[str], networks: Iterable[str], *, posed: bool, compared: bool) -> set[str]:
    cited = {"paper"} | ({"sift", "colmap"} if mappers else set())
    cited |= {"glomap"} if "global" in mappers else set()
    cited |= {"hartley", "winter", "leva"} if posed else set()
    cited |= {"blazepose"} if posed and any(n.startswith("blazepose") for n in networks) else set()
    return cited | ({"thesis"} if compared else set())


def _different(sessions: Iterable[dict], key: str) -> list[str]:
    return list(dict.fromkeys(session[key] for session in sessions if session[key]))


def calibrated(way: Calibration, *, clicked: bool, has_covariance: bool) -> str:
    """Return in words how cameras were calibrated; `clicked`: whether court points were."""
    if way.kind == "file" and has_covariance:
        return AGAIN
    if way.kind == "sfm" and not clicked:
        return UNCLICKED
    if way.kind == "known" and not way.n_points:
        return BY_POINTS
    return WITH_LINES if way.lines else CALIBRATED[way.kind]


def _calibrations(sessions: Iterable[dict]) -> list[tuple[str, str, list[str]]]:
    """Return each calibration, what it is in words, and the sessions that use it."""
    found: dict[tuple[str, str], list[str]] = {}
    for session in sessions:
        if name := session["calibration"]:
            about = {key: session[key] for key in ("clicked", "has_covariance")}
            words = calibrated(Calibration.parse(name), **about)
            found.setdefault((name, words), []).append(session["name"])
    return [(*one, users) for one, users in found.items()]


def _users(sessions: Iterable[dict], key: str, value: str) -> list[str]:
    return [session["name"] for session in sessions if session[key] == value]


def _is_uncertain(session: dict) -> bool:
    """Return whether skeletons of a session rest on cameras whose error is not known."""
    way = session["calibration"]
    measured = any(take["files"].get("pose3d") for take in session["takes"])
    return bool(way and measured) and not session["has_covariance"]


def _fused(name: str) -> str:
    fusion = Fusion.parse(name)
    return FUSED[fusion.rule] if fusion.steadied else UNSTEADY


def _cut(cutoffs: Mapping[str, object]) -> str:
    """Return the cut-offs of groups of joints in words: numbers, or how they are chosen."""
    return ", ".join(
        f"a frequency by residual analysis ({group})"
        if value == RESIDUAL
        else f"{value:g} Hz ({group})"
        for group, value in cutoffs.items()
    )


def _lowered(
    parameters: dict, sessions: Sequence[dict], used_hz: Mapping[tuple[str, str], Cutoffs]
) -> list[tuple[str, list[str]]]:
    """Return cut-offs in words that are not those configured, and the takes filtered so."""
    found: dict[str, list[str]] = {}
    for session in sessions:
        own = session["overrides"].get("filter_motion", {})
        stated = own.get("cutoff_hz", parameters["filter_motion"]["cutoff_hz"])
        for take in session["takes"]:
            used = used_hz.get((session["name"], take["name"]), {})
            other = {group: hz for group, hz in used.items() if hz != stated.get(group)}
            if other:
                found.setdefault(_cut(other), []).append(f"{session['name']} {take['name']}")
    return list(found.items())


def _overrides(sessions: Iterable[dict]) -> dict[str, list[str]]:
    """Return {step and values that differ from the study's: names of sessions}."""
    found: dict[str, list[str]] = {}
    for session in sessions:
        for step, value in session["overrides"].items():
            found.setdefault(f"{step}: {_plain(value)}", []).append(session["name"])
    return found


def _plain(value: object) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {_plain(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_plain(item) for item in value) + "]"
    return str(value)


def _names(names: Sequence[str]) -> str:
    *most, last = names
    return f"{', '.join(most)} and {last}" if most else last
