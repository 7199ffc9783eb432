"""Draft a session's YAML file from a folder of recordings."""

import json
import re
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from pathlib import Path

import yaml

from courtside.drafting import names as file_names
from courtside.drafting.recordings import Guess, Recording, Take
from courtside.geometry import picture_size
from courtside.study.configuration import configuration, schemas, yaml_files
from courtside.study.configuration.sessions import FEWEST_ALONE
from courtside.study.errors import InputError

MARK = "# guess:"
PLAIN = re.compile(r"[A-Za-z0-9_./+-]+( [A-Za-z0-9_./+-]+)*")
SUBJECTS = (
    "pseudonyms; what each agreed to (export, faces?); "
    "height_m: 1.74, mass_kg: 66, sex: m, hand: left"
)
BOARD = "inner_corners: [7, 4], square_m: 0.06"


def text(guess: Guess, *, title: str, folder: str, court: str | None = None) -> str:
    """Write a session's file as YAML text, every guess marked by `# guess:`.

    `title` is one line on the session. `folder` is that of the recordings, as paths in the file
    begin; clicked court points are expected in it. `court` is one of config/courts, or `none`; by
    default badminton where cameras are to be calibrated by it, otherwise `none`, also with points
    that have their own coordinates. An `InputError` if there is no recording to make a session of.
    """
    if not guess.walks and not guess.takes and not guess.static:
        raise InputError(
            f"{folder}: expected videos, photos, keypoints or files of devices, found "
            f"{_what_is_there(guess)}; put the videos of the fixed cameras and of the walk there"
        )
    measured = guess.calibration is None and bool(guess.cameras) and not unfilmed(guess)
    court = court or ("badminton" if measured and not guess.own_points else "none")
    lines = [
        f"# Drafted from {_quoted(folder)}: check the lines with `{MARK}`; config/README.md lists "
        "all keys.",
        f"description: {_quoted(title)}  {MARK} one line for captions: the gym, the day, the "
        "layout; no names of persons, the report shows it",
        f"court: {court}  {MARK} none, or a file of config/courts",
    ]
    if guess.takes:
        lines += ["subjects:", f"  p1: {{consent: [analysis, pictures]}}  {MARK} {SUBJECTS}"]
    clicked = measured and (court != "none" or guess.own_points)
    if (clicked and not guess.own_points) or guess.walks:  # both need a picture of every camera
        lines += _cameras(guess, _stand_ins(guess))
    else:
        lines += _cameras(guess, {})
    lines += [*_walks(guess), *_places(guess, folder, clicked)]
    lines += [*_people(guess, folder), *synchronised(guess), *_takes(guess)]
    lines += _override(guess)
    if measured and court == "none" and not guess.walks and not guess.own_points:
        lines += people_alone(guess)
    return "\n".join([*lines, *_unused(guess)]) + "\n"


def write(path: Path, content: str) -> None:
    """Write a drafted session (from `text`) to config/sessions/<session>.yaml, never over a file.

    An `InputError` if the file exists, or its name is not allowed for a session.
    """
    if not _is_free(path.stem):
        small = path.stem.lower()
        found = "another; give one by --name"
        if _is_free(small):
            found = f"capital letters; give --name {small}"
        raise InputError(
            f"{path.stem}: expected a session's name of at most 64 of a-z, 0-9, _ and -, begun "
            "with a letter or digit, no device of Windows such as con, and none of na, nan, none, "
            f"null, {', '.join(configuration.RESERVED)}, found {found}"
        )
    try:
        with path.open("x", encoding="utf-8") as stream:
            stream.write(content)
    except FileExistsError:
        raise InputError(
            f"{path}: expected no file of that name, found one and left it; delete it to draft it "
            "anew, or give another name by --name"
        ) from None
    faults = schemas.faults(yaml_files.read(path), "session", path)
    if faults:
        path.unlink()
        raise ValueError(f"the draft does not hold its own schema: {faults[0]}")


def _is_free(name: str) -> bool:
    """Say whether a session may have a name."""
    return bool(configuration.NAME.fullmatch(name)) and name not in configuration.RESERVED


def _stand_ins(guess: Guess) -> Take:
    """Return the first take of each camera that has no recording of the empty court."""
    films = {camera: guess.films(camera)[:1] for camera in guess.cameras}
    return {
        camera: film
        for camera, first in films.items()
        for film in first
        if film.kind == "video" and camera not in guess.static
    }


def _cameras(guess: Guess, stand_ins: Take) -> list[str]:
    if not guess.cameras:
        return ["cameras: {}"]
    lines = [f"cameras:  {MARK} one name for each physical camera"]
    calibrated = guess.calibration.cameras if guess.calibration else {}
    for camera in guess.cameras:
        keys, remarks = _pictures(guess, camera, stand_ins)
        for more in _calibrated(guess, camera, calibrated):
            keys += filter(None, more[:1])
            remarks += more[1:]
        if camera in guess.numbered:
            remarks.append("no name tells the cameras apart: numbered in the order of their files")
        remark = f"  {MARK} {'; '.join(remarks)}" if remarks else ""
        lines.append(f"  {_quoted(camera)}: {{{', '.join(keys)}}}{remark}")
    return lines


def _pictures(guess: Guess, camera: str, stand_ins: Take) -> tuple[list[str], list[str]]:
    """Return the keys of a camera's own recordings, and remarks."""
    keys, remarks = [], []
    if camera in guess.static:
        keys.append(f"static: {_quoted(guess.static[camera].path)}")
        remarks.append(_described(guess.static[camera]))
    if camera in stand_ins:
        keys.append(f"static: {_quoted(stand_ins[camera].path)}")
        remarks = ["no recording of the empty court found, this take is used instead"]
    if camera in guess.boards:
        keys.append(f"chessboard: {{images: {_quoted(guess.boards[camera].path)}, {BOARD}}}")
        remarks.append("the chessboard's inner corners and the length of a square")
    return keys, remarks


def _calibrated(
    guess: Guess, camera: str, calibrated: Mapping[str, tuple[int, int]]
) -> Iterator[tuple[str, str]]:
    """Yield the keys that a camera needs to match the calibration, each with a remark."""
    if not calibrated:
        return
    theirs, like = _name_there(guess, camera, calibrated), "name"
    if theirs is None:
        theirs, like = _of_number(guess, camera, calibrated), "number"
    if theirs is None:
        names = ", ".join(_quoted(name) for name in calibrated)
        yield f"name_in_calibration: {_quoted(camera)}", f"one of {names} is its name there"
        return
    if theirs != camera:
        yield f"name_in_calibration: {_quoted(theirs)}", f"the same {like} there"
    size = next((film.size for film in guess.films(camera)), None)
    if size and tuple(size) != tuple(calibrated[theirs]):
        yield from _resized(calibrated[theirs], size)


def _name_there(guess: Guess, camera: str, calibrated: Mapping[str, tuple[int, int]]) -> str | None:
    """Return the name of a camera in the calibration: its own, a similar one or its serial."""
    ways: tuple[Callable[[str], bool], ...] = (
        lambda there: there in (camera, guess.serials.get(camera)),
        lambda there: file_names.name(there, "") == camera,
        lambda there: file_names.alike(
            *("_".join(file_names.words_of([n])) for n in (there, camera))
        ),
    )
    return next((there for like in ways for there in calibrated if like(there)), None)


def _of_number(guess: Guess, camera: str, calibrated: Collection[str]) -> str | None:
    """Return the camera of the calibration with the same number, if all have the same numbers.

    Where one side counts from 0 and the other one from 1, none.
    """
    own = {name: _number(name) for name in guess.cameras}
    theirs = {_number(name): name for name in calibrated}
    same = sorted(map(str, own.values())) == sorted(str(_number(name)) for name in calibrated)
    distinct = len(theirs) == len(calibrated) and None not in theirs
    return theirs[own[camera]] if same and distinct else None


def _number(name: str) -> int | None:
    found = re.search("[0-9]{1,3}$", name)
    return int(found[0]) if found else None


def _resized(calibrated: tuple[int, int], size: tuple[int, int]) -> Iterator[tuple[str, str]]:
    """Yield the keys of a camera whose videos have not the calibrated size, each with a remark."""
    there = f"{calibrated[0]}x{calibrated[1]} px"
    found = picture_size.relation(calibrated, size)
    if found.kind == "turned":
        yield "", f"turned against the calibrated {there}: export it as it was calibrated"
    if found.crop_px:
        yield f"crop_px: {list(found.crop_px)}", f"which part of the calibrated {there} it shows"
    if found.scale:
        yield f"scale: {found.scale:g}", f"a scaled copy of the calibrated {there}"


def _walks(guess: Guess) -> list[str]:
    head = f"walks:  {MARK} recordings by the camera that was carried past the others"
    lines = [head] * bool(guess.walks)
    for name, recording in guess.walks.items():
        key = "images" if recording.kind == "photos" else "video"
        lines.append(
            f"  {_quoted(name)}: {{{key}: {_quoted(recording.path)}}}  # {_described(recording)}"
        )
    return lines


def _places(guess: Guess, folder: str, clicked: bool) -> list[str]:
    if guess.calibration:
        return [f"calibration: {{file: {_quoted(guess.calibration.path)}}}"]
    if not clicked:
        return []
    remark = "" if guess.court_points else "  # not there yet: click them, see config/README.md"
    remark = f"  {MARK} points with their own coordinates" if guess.own_points else remark
    return [f"court_points: {_quoted(court_points(guess, folder))}{remark}"]


def _people(guess: Guess, folder: str) -> list[str]:
    """Return the key of the table in which persons are named, where they can be seen."""
    if guess.people:
        return [f"people: {_quoted(guess.people.path)}"]
    if all(name in unfilmed(guess) or not take for name, take in guess.takes.items()):
        return []
    remark = "not there yet: needed if a take shows several people, who are named on a page"
    return [f"people: {_quoted(f'{folder}/people.csv')}  # {remark}"]


def court_points(guess: Guess, folder: str) -> str:
    """Return the path of the clicked court points, which need not exist."""
    return guess.court_points.path if guess.court_points else f"{folder}/court_points.csv"


def synchronised(guess: Guess) -> list[str]:
    """Return the key by which all cameras share a clock, if every take looks like it."""
    filmed = [take for take in guess.takes.values() if take]
    if not filmed or not all(as_many_frames(take) for take in filmed):
        return []
    remark = "as many frames in all cameras of a take; remove it if they were started by hand"
    return [f"synchronised: true  {MARK} {remark}"]


def as_many_frames(take: Take) -> bool:
    """Say whether all cameras of a take have as many frames, which cameras of one clock have."""
    counts = {recording.n_frames for recording in take.values()}
    return len(counts) == 1 and None not in counts and len(take) > 1


def _takes(guess: Guess) -> list[str]:
    remark = "recordings that belong together; `synchronised: true` where the cameras share a clock"
    lines = [f"takes:  {MARK} {remark}"] * bool(guess.takes)
    return lines + [line for name in guess.takes for line in take_lines(guess, name)]


def take_lines(guess: Guess, name: str) -> list[str]:
    """Return the lines of one take, which a session's file has under `takes`."""
    lines, take = [f"  {_quoted(name)}:"], guess.takes[name]
    if name not in unfilmed(guess):
        lines += [*["    videos:"] * bool(take), *_of_each_camera(guess, take, "      ")]
    return [*lines, *_keypoints(guess, name), *_devices(guess, name)]


def _of_each_camera(guess: Guess, take: Take, indent: str) -> Iterator[str]:
    """Yield a line for each camera's recording of a take."""
    for camera in (camera for camera in guess.cameras if camera in take):
        recording = take[camera]
        path = f"{_quoted(camera)}: {_quoted(recording.path)}"
        yield f"{indent}{path}  # {_described(recording)}"


def unfilmed(guess: Guess) -> list[str]:
    """Return the takes of which there are keypoints alone, no videos."""
    return [name for name, take in guess.keypoints.items() if take == guess.takes[name]]


def _keypoints(guess: Guess, name: str) -> list[str]:
    """Return the keys of the keypoints of a take, found by another program."""
    if name not in guess.keypoints:
        return []
    take = guess.keypoints[name]
    n_points, skeletons = next(iter(take.values())).skeleton
    what = f"another program's keypoints; {n_points} points are {' or '.join(skeletons)}"
    if len(skeletons) > 1:
        what += f": the points look like {skeletons[0]}, ask what they were made with"
    rate = f"    # rate_hz: 60  {MARK} no file states it: write the frame rate, without the #"
    return [
        *[rate] * (name in unfilmed(guess)),
        "    pose2d:",
        f"      {skeletons[0]}:  {MARK} {what}",
        *_of_each_camera(guess, take, "        "),
    ]


def _devices(guess: Guess, take: str) -> list[str]:
    lines: list[str] = []
    names: set[str] = set()
    for device, recording in ((d, r) for name, d, r in guess.devices if name == take):
        names.add(name := file_names.distinct(device, names))
        lines.append(
            f"      {name}: {{file: {_quoted(recording.path)}}}  {MARK} whom it follows: subject"
        )
    return ["    devices:", *lines] if lines else []


def _override(guess: Guess) -> list[str]:
    """Return the key of what differs from the study: few bridging images, imported keypoints."""
    keys, remarks = [*_fewer_images(guess), *_imported(guess)], []
    remarks += ["the walks give no more bridging images"] * bool(_fewer_images(guess))
    if _imported(guess):
        alone = "for there are no videos" if unfilmed(guess) else "remove it to use a network"
        remarks.append(f"keypoints of another program, {alone}")
    return [f"override: {{{', '.join(keys)}}}  {MARK} {'; '.join(remarks)}"] * bool(keys)


def _imported(guess: Guess) -> list[str]:
    """Return the key that measures with imported keypoints, where all takes have some."""
    filmed = [name for name, take in guess.takes.items() if take]
    if not guess.keypoints or set(guess.keypoints) != set(filmed):
        return []
    found = [next(iter(t.values())).skeleton[1][0] for t in guess.keypoints.values()]
    return [f"models: [{', '.join(dict.fromkeys(found))}]"]


def people_alone(guess: Guess) -> list[str]:
    """Return a line to be uncommented by which people tell how three cameras or more stand."""
    if not any(guess.takes.values()) or len(guess.cameras) < FEWEST_ALONE:
        return []
    keys = ", ".join([*_imported(guess), "calibrations: [people]"])
    how = "to calibrate by people alone, remove the first #"
    how += " and the line above" * bool(_imported(guess))
    return [f"# override: {{{keys}}}  {MARK} {how}, and state height_m of every person"]


def _fewer_images(guess: Guess) -> list[str]:
    """Return the keys that ask for as many bridging images as walks give, where they are few."""
    if not guess.walks:
        return []
    each = [_bridging_images(recording) for recording in guess.walks.values()]
    n_images = max(2, sum(each))
    if n_images >= USUAL_IMAGES:
        return []
    keys = [f"sweep: {{n_images: [{n_images}], n_offsets: 1}}"]
    if guess.cameras and guess.calibration is None:
        ways = f"calibrations: [sfm-n{n_images}]"
        keys += [ways, f"take_{ways}"]
    return keys


def _bridging_images(recording: Recording) -> int:
    """Return how many bridging images a walk gives; some frames of a video are blurred or alike."""
    if recording.kind == "photos":
        return recording.n_photos
    return round(USABLE * (recording.duration_s or 0) / EVERY_S)


def _unused(guess: Guess) -> list[str]:
    lines = [f"#   {json.dumps(path)}: {why}" for path, why in left_out(guess)]
    return ["# not used:", *lines] if lines else []


def left_out(guess: Guess) -> list[tuple[str, str]]:
    """Return the path of each file that the draft does not use, with the reason in one line."""
    found = [(r.path, _one_line(why)) for r, why in guess.unused]
    found += [(r.path, f"{d} of no take") for take, d, r in guess.devices if not take]
    if guess.calibration and guess.court_points:
        why = "clicked points; as `static_points` they check the calibration file"
        if guess.own_points:
            why = "points with their own coordinates; without `calibration` they calibrate"
        found.append((guess.court_points.path, why))
    return found


def _described(recording: Recording) -> str:
    size = "" if recording.size is None else f"{recording.size[0]}x{recording.size[1]}"
    if recording.kind == "keypoints":
        return f"{recording.n_frames} files"
    if recording.kind == "video":
        rate = "one frame" if recording.rate_hz is None else f"{recording.rate_hz:.4g} Hz"
        return ", ".join([size, rate, f"{recording.duration_s:.1f} s"])
    return f"{recording.n_photos} photos, {size}" if recording.n_photos else f"photo, {size}"


def _what_is_there(guess: Guess) -> str:
    if not guess.unused:
        return "none"
    reasons = Counter(why for _, why in guess.unused)
    recording, why = max(guess.unused, key=lambda one: reasons[one[1]])  # the first of most
    more = f" and {len(guess.unused) - 1} more" if len(guess.unused) > 1 else ""
    return f"{recording.path} ({_one_line(why)}){more}"


def _one_line(why: object) -> str:
    return " ".join(str(why).split())


def _quoted(value: str) -> str:
    """Return a text as a YAML scalar that is read as text, also within brackets."""
    if PLAIN.fullmatch(value) and yaml.safe_load(value) == value:
        return value
    return json.dumps(value, ensure_ascii=False)


WAYS = ("file", "sfm-n40", "known", "board", "wand")  # of `calibrations` in config.yaml
USUAL_IMAGES, EVERY_S = 40, 0.5  # `sweep.n_images` and `extract_frames.every_s` of config.yaml
USABLE = 0.8  # ASSUME: share of a walk's frames that are sharp and differ


def write_study(path: Path, session: str, takes: Iterable[str]) -> str:
    """Write a study (config/<session>.yaml) of one session alone, with videos of its takes.

    A file that is there is left as it is. Returns one line on what was done.
    """
    filmed = ", ".join(f"{session}/{take}" for take in takes)  # those with videos
    lines = [
        f"# The study of {session} alone; keys not stated here are as in config.yaml.",
        f"sessions: [{_quoted(session)}]",
        "plans: []",
        "variations: []",
        f"calibrations: [{', '.join(WAYS)}] # without ways that are only compared with these",
        f"export_overlay_video: {{takes: [{filmed}]}} # videos with the skeletons drawn in",
    ]
    try:
        with path.open("x", encoding="utf-8") as stream:
            stream.write("\n".join(lines) + "\n")
    except FileExistsError:
        return f"Left {path} as it is: name {session} among its `sessions`."
    return f"Wrote {path}."
