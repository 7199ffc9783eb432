"""Faults of a session's file beyond its schema: names, files, ways to find the cameras."""

import re
from collections.abc import Collection, Iterator
from itertools import product
from pathlib import Path

from courtside.study.configuration import consent, sighting_faults, take_faults
from courtside.study.configuration.session_files import (
    FOR_ALL_TAKES,
    MADE,
    has_places,
    is_there,
    of_configuration,
)
from courtside.study.configuration.sessions import FEWEST_ALONE
from courtside.study.configuration.yaml_files import Content
from courtside.study.errors import nearest
from courtside.study.execution.artefacts import Artefact
from courtside.study.execution.files import misspelt
from courtside.study.paths import EXTERNAL, VIRTUAL

SIMULATED = VIRTUAL.format(session="")
ALL = "all"  # of cameras in fusions, of cameras and persons in tables
UNSCALED = (
    "expected `height_m` of every person of one take or more, for the calibration `people`, found "
    "no such take; state the heights, or `known_lengths`: nothing else defines the scale"
)
# Of cameras in a calibration file; the first also of those in the file of `lenses`.
OF_CALIBRATED = ("name_in_calibration", "crop_px", "scale")
OWN_COURT = "config/README.md, A court of your own"
# What else to do where nobody has clicked the points of a court yet.
BY_CLICKS = ", or give every camera `static`, and the study makes a page to click them on"


def find(
    folder: Path, file: Path, content: Content, known: dict[str, Artefact] | None, root: Path
) -> Iterator[str]:
    """Yield what in a session contradicts the rest of the configuration or the disk.

    `folder` is config/, `file` the session's and `content` what it says, as its schema allows it
    and `session_files.filled` returns it; `known` are the artefacts by name, and relative paths
    start from `root`.
    """
    cameras, subjects = content["cameras"], content.get("subjects", {})
    court, virtual = content["court"], "virtual" in content
    if court != "none" and not (folder / "courts" / f"{court}.yaml").is_file():
        courts = sorted(path.stem for path in (folder / "courts").glob("*.yaml"))
        advice = nearest(court, courts, f"correct the name, or describe it ({OWN_COURT})")
        yield f"{file}: court: expected 'none' or one of {courts}, found {court!r}; {advice}"
    yield from _name_faults(file, content)
    yield from _virtual_faults(file, content) if virtual else _recorded_faults(file, content, root)
    yield from _static_point_faults(file, content)
    yield from _replacement_faults(file, content)
    yield from _useless_keys(file, content)
    yield from _people_faults(file, content)
    yield from consent.faults(file, content)
    yield from sighting_faults.find(file, content)
    yield from _view_faults(file, content)
    paths = dict(_paths(content))
    if static := of_configuration(content.get("static_points"), folder):
        paths["static_points"] = static
    shared = {key: content[key] for key in FOR_ALL_TAKES if key in content}
    for name, own in content.get("takes", {}).items():
        take = shared | own
        yield from take_faults.find(f"{file}: takes.{name}", take, cameras, subjects, virtual)
        if not consent.is_withheld(content, take):  # else its recordings may be gone
            paths |= dict(_take_paths(f"takes.{name}", take))
    yield from take_faults.of_other_programs(folder, file, content)
    for where, path in paths.items():
        advice = BY_CLICKS if where == "court_points" and court != "none" else ""
        yield from _path_faults(f"{file}: {where}", path, known, root, advice)


def _name_faults(file: Path, content: Content) -> Iterator[str]:
    """Yield the names that mean something else."""
    for key in ("cameras", "subjects", "views"):
        if ALL in content.get(key, {}):
            yield (
                f"{file}: {key}.{ALL}: expected another name, found {ALL!r}, which means all of "
                "them in fusions and tables; rename it"
            )
    for name in sorted(set(content["cameras"]) & set(content.get("walks", {}))):
        yield f"{file}: walks.{name}: expected a name that no camera has, found {name!r}; rename it"


def _view_faults(file: Path, content: Content) -> Iterator[str]:
    """Yield the faults of sets of cameras."""
    cameras, players = content["cameras"], content.get("halfbody", {}).values()
    for key, views in content.get("views", {}).items():
        yield from take_faults.unknown(f"{file}: views.{key}", views, cameras)
    yield from take_faults.unknown(f"{file}: halfbody", players, cameras)
    if len(set(players)) < len(players):
        yield (
            f"{file}: halfbody: expected three different cameras, found {', '.join(players)}; "
            "correct one"
        )


def _asks_people(content: Content) -> bool:
    """Say whether cameras are to be found from people alone."""
    return "people" in content.get("override", {}).get("calibrations", [])


def _people_faults(file: Path, content: Content) -> Iterator[str]:
    """Yield why cameras cannot be found from people alone, where a session asks for that."""
    if not _asks_people(content):
        return
    if content["court"] != "none":
        yield (
            f"{file}: override.calibrations: expected `people` in a session with court: none, "
            f"found court: {content['court']}; people do not tell where its lines are"
        )
    takes = content.get("takes", {}).values()
    filmed = [take for take in takes if take_faults.cameras_of(take)]
    if "virtual" not in content and not filmed:
        yield (
            f"{file}: takes: expected one that fixed cameras film, for the calibration `people`, "
            "found none; state a take with `videos`"
        )
    if len(content["cameras"]) < FEWEST_ALONE:
        yield (
            f"{file}: cameras: expected three or more for the calibration `people`, found "
            f"{len(content['cameras'])}; people do not tell how two stand"
        )
    measured = [take for take in filmed if not consent.is_withheld(content, take)]
    known = "known_lengths" in content or any(_has_heights(content, take) for take in measured)
    if measured and not known:
        yield f"{file}: subjects: {UNSCALED}"


def _has_heights(content: Content, take: Content) -> bool:
    """Say whether the heights of all persons of a take are stated."""
    subjects: Content = content.get("subjects", {})
    there = [subjects.get(name, {}) for name in take.get("subjects", subjects)]
    return bool(there) and all(one.get("height_m") for one in there)


def _static_point_faults(file: Path, content: Content) -> Iterator[str]:
    """Yield the faults of static points, and of known lengths between them."""
    measured = "known_lengths" in content
    if "static_points" in content and not ("calibration" in content or measured):
        yield (
            f"{file}: static_points: expected `calibration` (a file that they check) or "
            "`known_lengths` (lengths between them), found neither; add one, or remove them"
        )
    if measured and not ("static_points" in content and _asks_people(content)):
        yield (
            f"{file}: known_lengths: expected `static_points` with their ends, and `people` in "
            "override.calibrations, found only one or neither; add both: only this calibration "
            "uses known lengths; a walk gets metres from clicked points of a court, such as one of "
            f"your own ({OWN_COURT})"
        )


def _replacement_faults(file: Path, content: Content) -> Iterator[str]:
    """Yield the faults of numbers that replace those of a calibration file."""
    calibration, where = content.get("calibration", {}), f"{file}: calibration"
    points = calibration.get("principal_point_px", {})
    yield from take_faults.unknown(f"{where}.principal_point_px", points, content["cameras"])
    if bool(points) != ("reason" in calibration):
        missing, there = ("reason", "principal_point_px")[:: 1 if points else -1]
        yield (
            f"{where}: expected `{missing}` beside `{there}`, found none; numbers of a file are "
            "replaced for a stated reason only"
        )


def _useless_keys(file: Path, content: Content) -> Iterator[str]:
    """Yield the keys of cameras that say how they are in a file which the session does not have."""
    lenses = any("lenses" in content.get(target, {}) for target in ("board", "wand"))
    used = OF_CALIBRATED if "calibration" in content else OF_CALIBRATED[:1] if lenses else ()
    for name, camera in content["cameras"].items():
        for key in (key for key in OF_CALIBRATED if key in camera and key not in used):
            more = " (or `lenses` of a board or wand)" if key == OF_CALIBRATED[0] else ""
            yield (
                f"{file}: cameras.{name}.{key}: expected it with a `calibration` file{more} only, "
                "found it without; remove it"
            )


def _take_paths(where: str, take: Content) -> Iterator[tuple[str, str]]:
    """Yield (key, path) of all recordings of a take."""
    for camera, path in take.get("videos", {}).items():
        yield f"{where}.videos.{camera}", path
    for key in ("pose2d", "pose3d"):
        for skeleton, files in take.get(key, {}).items():
            for at, path in files.items():
                yield f"{where}.{key}.{skeleton}.{at}", path
    for name, device in take.get("devices", {}).items():
        yield f"{where}.devices.{name}.file", device["file"]


def _target_paths(content: Content) -> Iterator[tuple[str, str]]:
    """Yield (key, path) of a board and a wand."""
    for target, keys in (("board", ("corners", "lenses")), ("wand", ("points", "lenses"))):
        given = content.get(target, {})
        yield from ((f"{target}.{key}", given[key]) for key in keys if key in given)
    for key in ("images", "videos"):
        for camera, path in content.get("board", {}).get(key, {}).items():
            yield f"board.{key}.{camera}", path


def _paths(content: Content) -> Iterator[tuple[str, str]]:
    """Yield (key, path) of all recordings but those of takes."""
    if "calibration" in content:
        yield "calibration.file", content["calibration"]["file"]
    yield from _target_paths(content)
    for name, camera in content["cameras"].items():
        if "static" in camera:
            yield f"cameras.{name}.static", camera["static"]
        if "chessboard" in camera:
            yield f"cameras.{name}.chessboard.images", camera["chessboard"]["images"]
    for name, walk in content.get("walks", {}).items():
        for key, path in walk.items():
            yield f"walks.{name}.{key}", path
    still = [camera for camera in content["cameras"].values() if "static" in camera]
    clicks = content.get("court_points", "")
    clickable = len(still) == len(content["cameras"]) and content["court"] != "none"
    # Else the study makes a page to click them on.
    if clicks and (clicks.startswith(EXTERNAL) or not clickable):
        yield "court_points", clicks


def _virtual_faults(file: Path, content: Content) -> Iterator[str]:
    takes = content.get("takes", {}).values()
    if not content["cameras"] and not any("devices" in take.get("virtual", {}) for take in takes):
        yield f"{file}: virtual: expected cameras that it films with, found none; name them"
    made = ("chessboard.images", "calibration.file")
    named = [key for key, _ in _paths(content) if not key.endswith(made)]
    if named:
        yield (
            f"{file}: {named[0]}: expected no file of its own in a virtual session, which makes "
            "its own; remove it"
        )
    if content["court"] == "none":
        yield (
            f"{file}: court: expected a court to build the virtual hall around, found 'none'; "
            "name one"
        )
    for key, line in _setting_faults(content["virtual"], content.get("walks", {})):
        yield f"{file}: virtual.{key}: {line}"


def _recorded_faults(file: Path, content: Content, root: Path) -> Iterator[str]:
    cameras, walks = content["cameras"], content.get("walks", {})
    takes = content.get("takes", {}).values()
    found = {"walks", "calibration", "court_points", "board", "wand"} & set(content)
    if not found and not _asks_people(content) and (cameras or not takes):
        yield (
            f"{file}: expected `walks`, `court_points`, `board`, `wand` or `calibration`, or "
            "`override: {calibrations: [people]}`, found none; say how the cameras are to be found"
        )
    yield from _board_faults(file, content)
    yield from _wand_faults(file, content)
    placed = {"calibration", "board", "wand"} & set(content)
    if len(cameras) < 2 and (placed or any(map(take_faults.cameras_of, takes))):
        yield (
            f"{file}: cameras: expected two or more, found {len(cameras)}; one camera sees no depth"
        )
    for name in (name for name, walk in walks.items() if not walk):
        yield (
            f"{file}: walks.{name}: expected `video` or `images`, found neither; name a file or a "
            "folder"
        )
    withdrawn = any(consent.is_withheld(content, take) for take in takes)
    for name, camera in cameras.items() if walks else ():
        if "static" not in camera:
            yield (
                f"{file}: cameras.{name}: expected `static`, a recording or photo of the empty "
                "court, found none"
                + " (the video of somebody who has withdrawn is none)" * withdrawn
                + "; bridging images are tied to it"
            )
    yield from _point_faults(file, content, root)


def _board_faults(file: Path, content: Content) -> Iterator[str]:
    """Yield the faults of a board that several cameras see."""
    if "board" not in content:
        return
    given, where = content["board"], f"{file}: board"
    sources = [key for key in ("images", "videos", "corners") if key in given]
    if len(sources) != 1:
        yield (
            f"{where}: expected one of `images`, `videos` and `corners`, found "
            f"{' and '.join(sources) or 'none'}; say where the cameras see the board"
        )
    for key in ("images", "videos"):
        yield from take_faults.unknown(f"{where}.{key}", given.get(key, {}), content["cameras"])
        missing = sorted(set(content["cameras"]) - set(given.get(key, content["cameras"])))
        if missing:
            yield f"{where}.{key}: expected every camera, found none for {', '.join(missing)}"
    if given["kind"] in ("charuco", "tags") and "dictionary" not in given:
        yield (
            f"{where}: expected `dictionary` of its markers, such as DICT_4X4_50, found none; it "
            "stands where the board was printed"
        )
    if "lenses" not in given:
        yield from _lens_faults(where, content["cameras"])
    if "corners" in given and "lenses" not in given:
        yield from _unsized(file, content)


def _lens_faults(where: str, cameras: Content) -> Iterator[str]:
    """Yield the fault of a board where some cameras have a lens from a chessboard, others none."""
    missing = sorted(name for name, one in cameras.items() if "chessboard" not in one)
    if 0 < len(missing) < len(cameras):
        yield (
            f"{where}: expected `chessboard` of every camera or of none, found none for "
            f"{', '.join(missing)}; add it, or give `lenses`"
        )


def _wand_faults(file: Path, content: Content) -> Iterator[str]:
    """Yield the faults of a wand that several cameras see."""
    if "wand" not in content:
        return
    given, where = content["wand"], f"{file}: wand"
    order = given.get("cameras", list(content["cameras"]))
    if sorted(order) != sorted(content["cameras"]):
        yield (
            f"{where}.cameras: expected each camera of the session once, found "
            f"{', '.join(map(str, order))}; list them in the order of the program"
        )
    if "cameras" in given and "program" not in given:
        yield (
            f"{where}.cameras: expected `program`, found none; a CSV of the study contains the "
            "names of its cameras: remove `cameras`, or add `program`"
        )
    n_markers, middle = len(given.get("markers", [])), "middle_m" in given
    if n_markers and n_markers != 2 + middle:
        yield (
            f"{where}.markers: expected {2 + middle} names, found {n_markers}; three markers need "
            "`middle_m`, the distance of the first marker from the middle one"
        )
    if middle and not given["middle_m"] < given["length_m"]:
        yield (
            f"{where}.middle_m: expected less than length_m ({given['length_m']:g}), found "
            f"{given['middle_m']:g}; measure it from the first marker to the middle one"
        )
    if "lenses" not in given:
        yield from _unsized(file, content)


def _point_faults(file: Path, content: Content, root: Path) -> Iterator[str]:
    """Yield the faults of court points, or points with your own coordinates."""
    cameras, walks, court = content["cameras"], content.get("walks", {}), content["court"]
    clicked = "court_points" in content
    placed = clicked and has_places(root / content["court_points"])
    there = clicked and is_there(root / content["court_points"])
    fetched = content.get("court_points", "").startswith(EXTERNAL)
    if court == "none" and not placed and (there or fetched):
        yield (
            f"{file}: court_points: expected the columns x_m, y_m and z_m with the places of the "
            f"points, as there is no court, found none in {content['court_points']}; add them, or "
            "name the court of the points"
        )
    if court != "none" and placed and not walks:
        yield (
            f"{file}: court: expected 'none' beside points with their own places x_m, y_m, z_m, "
            f"found {court!r}; set court: none, or remove these columns and name the points"
        )
    if placed and walks:
        yield (
            f"{file}: court_points: expected points of the court by their names beside `walks`, "
            "found places x_m, y_m, z_m; write these places into a court file of your own, "
            f"config/courts/<court>.yaml, give `court` and the points by its names ({OWN_COURT}), "
            "or remove the walks"
        )
    known = "known" in content.get("override", {}).get("calibrations", [])
    if there and not walks and (known or "calibration" not in content):
        yield from _unsized(file, content)
    if court != "none" and walks and cameras and not clicked:
        yield (
            f"{file}: expected `court_points` for a session with a court, found none; say where "
            "they are to be saved, and the study makes a page to click them on, or set court: none"
        )


def _unsized(file: Path, content: Content) -> Iterator[str]:
    """Yield the cameras of which nothing tells the size of the picture that points are in."""
    takes = [*content.get("takes", {}).values()]
    measured = [take for take in takes if not consent.is_withheld(content, take)]
    filmed = {name for take in measured for name in take.get("videos", {})}
    for name, camera in content["cameras"].items():
        if "static" not in camera and name not in filmed:
            yield (
                f"{file}: cameras.{name}: expected `static` or a video in a take, which tell the "
                "size of its picture, found neither"
                + " in takes of persons who have agreed to analysis" * (takes != measured)
                + "; add one or remove the camera"
            )


def _setting_faults(virtual: Content, walks: Collection[str]) -> Iterator[tuple[str, str]]:
    """Yield the settings of a virtual session that contradict others or its walks, and why."""
    n_frames = virtual["walk_frames"]
    if n_frames == 1 or bool(walks) != bool(n_frames):
        yield (
            "walk_frames",
            f"expected two or more with a walk and 0 without, found {n_frames} and walks "
            f"{sorted(walks)}; correct one of them",
        )
    elif n_frames and virtual.get("static_frames") == 0:
        yield (
            "static_frames",
            "expected 1 or more with a walk, whose pictures are tied to those of the empty hall, "
            "found 0; remove it or the walk",
        )
    if "baseline_deg" in virtual and virtual["layout"] != "a":
        yield (
            "baseline_deg",
            f"expected it with layout a only, found {virtual['layout']}; remove it",
        )


def _varied_faults(where: str, base: Content, condition: Content) -> list[str]:
    """Return the faults of the settings of all variations of a session, each once."""
    fixed, vary, walks = condition.get("set", {}), condition["vary"], base.get("walks", {})
    places = {key: f".{part}.{key}" for part in ("set", "vary") for key in condition.get(part, {})}
    faults: dict[str, None] = {}
    for values in product(*vary.values()):
        virtual = {**base["virtual"], **fixed, **dict(zip(vary, values, strict=True))}
        for key, line in _setting_faults(virtual, walks):
            place = places.get(key, f": virtual.{key} of session {condition['session']}")
            faults[f"{where}{place}: {line}"] = None
    return list(faults)


def _figure_faults(where: str, base: Content, vary: Content) -> Iterator[str]:
    """Yield why there is no figure of a condition, or one that does not show what varies."""
    drawn = [key for key in vary if not key.endswith("seed")]
    several = [key for key in drawn if len(vary[key]) > 1]
    if "world" not in vary and len(several) > 2:
        yield (
            f"{where}.vary: expected at most two keys with several values besides seeds, because "
            f"its figure shows no more, found {', '.join(several)}; write further conditions"
        )
    if drawn and not base.get("walks"):
        yield f"{where}.session: expected one with a walk, as its figure needs, found none"
    widths = [width for width, _ in vary.get("size_px", [])]
    if len(set(widths)) < len(widths):
        yield f"{where}.vary.size_px: expected widths that differ, for its figure, found {widths}"


def conditions(config_file: str, config: Content, found: dict[str, tuple]) -> list[str]:
    """Return the faults of the conditions; `found` has (file, content) of each session, by name."""
    wanted, known = config["variations"], config["conditions"]
    faults = take_faults.unknown(f"{config_file}: variations", wanted, known)
    for name in (name for name in wanted if name in known):
        condition = known[name]
        where, base = f"{config_file}: conditions.{name}", condition["session"]
        faults += take_faults.unknown(f"{where}.session", [base], found)
        if base in found and "virtual" not in found[base][1]:
            faults.append(f"{where}.session: expected a virtual session, found {base!r}; name one")
        elif base in found:
            faults += _varied_faults(where, found[base][1], condition)
            faults += _figure_faults(where, found[base][1], condition["vary"])
        faults += [
            f"{where}: expected {key} in either `set` or `vary`, found it in both; remove one"
            for key in sorted(set(condition.get("set", {})) & set(condition["vary"]))
        ]
        # Variations are sessions named after their condition.
        faults += [
            f"{where}: expected a name that no session has, found session {own!r}; rename it"
            for own in found
            if own == name or re.fullmatch(rf"{name}-\d+", own)
        ]
    return faults


def _path_faults(
    where: str, path: str, known: dict[str, Artefact] | None, root: Path, advice: str
) -> Iterator[str]:
    if path.startswith(SIMULATED) or MADE.fullmatch(path):
        return
    if not path.startswith(EXTERNAL):
        if not is_there(root / path):
            mend = misspelt(path, root) or f"correct the path or put it there{advice}"
            yield f"{where}: expected a file, found none at {path}; {mend}"
        return
    if known is None:
        return
    artefact, _, member = path.removeprefix(EXTERNAL).partition("/")
    if artefact not in known or member not in known[artefact].members:
        yield f"{where}: expected a member of external.yaml, found {path}; add it there"
