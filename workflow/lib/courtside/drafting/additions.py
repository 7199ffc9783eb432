"""Takes that a session's file does not have yet, as lines to paste into it."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from courtside.drafting import advice, draft
from courtside.drafting.names import distinct
from courtside.drafting.recordings import Guess, Take
from courtside.drafting.survey import written
from courtside.study.configuration.yaml_files import Content
from courtside.study.errors import InputError, StrPath


def to_paste(guess: Guess, content: Content, *, path: StrPath, folder: str) -> list[str]:
    """Return what to say of a session's file that is there: the takes that it lacks, and where to.

    `content` is the file's, as its schema allows it, `path` its own; `folder` is that of the
    recordings. A take is missing if the file names none of its recordings. Takes and cameras are
    called as in the file. An `InputError` if nothing is missing, or the session is another one:
    virtual, or of recordings elsewhere alone.
    """
    _check_folder(content, path, folder)
    new = missing(guess, content)
    if not new.takes:
        raise InputError(
            f"{path}: expected no file of that name, or takes in {folder} that it does not name, "
            "found one that has all and left it; delete it to draft it anew, or give another name "
            "by --name"
        )
    lines = ["takes:"] * (not content.get("takes"))
    for take in new.takes:
        head, *rest = draft.take_lines(new, take)
        lines += [head, *_subjects(content), *rest]
    n_new = len(new.takes)
    guesses = f"Look at every line with `{draft.MARK}`." if draft.MARK in "".join(lines) else None
    return [
        f"Left {path} as it is. {n_new} take{'s' * (n_new > 1)} of {folder} "
        f"{'are' if n_new > 1 else 'is'} not in it: copy these lines to the end of its `takes`.",
        *["", *lines, ""],
        *(f"Odd: {line}" for line in (*_odd(new, content), *advice.doubts(new))),
        *filter(None, [guesses]),
        "Write new persons into its `subjects`, with their consent.",
    ]


def _check_folder(content: Content, path: StrPath, folder: str) -> None:
    """Refuse a file of another session: takes of other days have other cameras."""
    walks = [path for walk in content.get("walks", {}).values() for path in (walk or {}).values()]
    there = [*_recordings(content), *(Path(path).resolve() for path in walks)]
    if any(file.is_relative_to(Path(folder).resolve()) for file in there):
        return
    found = f"one of recordings in {written(there[0].parent, Path.cwd())}" if there else ""
    found = "that of a virtual session" if "virtual" in content else found
    if found:
        raise InputError(
            f"{path}: expected no file of that name, or one of recordings in {folder}, found "
            f"{found} and left it; give this session another name by --name"
        )


def missing(guess: Guess, content: Content) -> Guess:
    """Return a guess of the takes alone that a session's file has not, called as in the file."""
    there = _recordings(content)
    own = {camera: _name_there(guess, camera, content, there) for camera in guess.cameras}
    taken = {*content.get("takes", {})}
    names = {}
    for name, films in guess.takes.items():
        every = [*films.values(), *guess.keypoints.get(name, {}).values()]
        every += [recording for take, _, recording in guess.devices if take == name]
        if not any(Path(recording.path).resolve() in there for recording in every):
            names[name] = distinct(name, taken)
            taken.add(names[name])

    def named(takes: dict[str, Take]) -> dict[str, Take]:
        return {
            names[name]: {own.get(camera, camera): film for camera, film in take.items()}
            for name, take in takes.items()
            if name in names
        }

    return replace(
        guess,
        cameras=[own[camera] for camera in guess.cameras],
        takes=named(guess.takes),
        keypoints=named(guess.keypoints),
        by_order=[names[take] for take in guess.by_order if take in names],
        devices=[(names[take], kind, r) for take, kind, r in guess.devices if take in names],
    )


def _recordings(content: Content) -> dict[Path, str]:
    """Return the camera, or the device, of every recording that a session's file names."""
    found = []
    for name, camera in content["cameras"].items():
        found += [(name, (camera or {}).get("static"))]
    for take in content.get("takes", {}).values():
        for films in (take.get("videos", {}), *take.get("pose2d", {}).values()):
            found += films.items()
        found += [(name, device.get("file")) for name, device in take.get("devices", {}).items()]
    return {Path(path).resolve(): name for name, path in found if path}


def _name_there(guess: Guess, camera: str, content: Content, there: dict[Path, str]) -> str:
    """Return what a session's file calls a camera: by recordings of it that the file names."""
    every = [*guess.films(camera), *filter(None, [guess.static.get(camera)])]
    every += [take[camera] for take in guess.keypoints.values() if camera in take]
    files = [Path(recording.path).resolve() for recording in every]
    named = {there[file] for file in files if file in there} & {*content["cameras"]}
    return named.pop() if len(named) == 1 else camera


def _subjects(content: Content) -> list[str]:
    """Return the line on who is in a take, where the session has several persons."""
    persons = [*content.get("subjects", {})]
    line = f"    subjects: [{', '.join(persons)}]  {draft.MARK} who is in it"
    return [line] * (len(persons) > 1)


def _odd(new: Guess, content: Content) -> Iterator[str]:
    filmed = {camera for take in new.takes.values() for camera in take}
    for camera in sorted(filmed - {*content["cameras"]}):
        yield f"the session has no camera {camera}: correct the name, or add it to `cameras`."
