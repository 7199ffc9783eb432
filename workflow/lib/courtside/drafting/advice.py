"""Say what a user should check after drafting a session: what is missing, odd or guessed."""

from collections.abc import Iterator

from courtside.drafting import draft, names
from courtside.drafting.recordings import (
    STATIC,
    Guess,
    Take,
    is_called_walk,
    lengths_fit,
    uncounted,
)
from courtside.study.errors import StrPath
from courtside.study.methods import NEEDS_COURT

SHOWN = 5  # files that are not used, on the terminal; the draft lists all
SHORT_S = 15  # ASSUME: in shorter takes the clocks of cameras are seldom found


def to_check(
    guess: Guess, path: StrPath, court_points: str | None, study: StrPath, where: str = ""
) -> list[str]:
    """List what a user should check after drafting, in order.

    `path` is the draft, `court_points` where clicked court points are expected, None without a
    court, `study` the study that names the session; `where` begins the lines with commands.
    """
    lines = [f"Look at {path}: every line with `{draft.MARK}`, and everything under `not used`."]
    left_out = draft.left_out(guess)
    lines += [f"Not used: {file}: {why}" for file, why in left_out[:SHOWN]]
    lines += [f"Not used: {len(left_out) - SHOWN} more"] * (len(left_out) > SHOWN)
    lines += [f"Odd: {line}" for line in _odd(guess)]
    lines += _translated(guess)
    if draft.synchronised(guess):
        lines.append(
            "Clocks: as many frames in all cameras, so `synchronised: true`; remove it if the "
            "cameras were started by hand."
        )
    if draft.unfilmed(guess):
        wanted = f"state `rate_hz` of {', '.join(draft.unfilmed(guess))}"
        if guess.calibration is None:
            wanted += "; put the calibration file into the folder and name it as `calibration`"
        lines.append(f"Keypoints without videos: {wanted}.")
    elif guess.calibration is None and guess.cameras:
        lines += _of_cameras(guess, court_points)
    lines.append(
        f"{where}`snakemake -n -q rules --configfile {study}` checks it and counts what will be "
        "made."
    )
    lines.append(f"{where}`snakemake --configfile {study}` makes it.")
    return lines


def _of_cameras(guess: Guess, court_points: str | None) -> Iterator[str]:
    """Yield how the cameras will be found, and what that takes."""
    if guess.court_points and guess.own_points and not guess.walks:
        yield (
            "Cameras: they will be calibrated from the points with their own coordinates in "
            f"{guess.court_points.path}."
        )
        return
    if court_points is None:
        if guess.walks and any(guess.takes.values()):
            yield f"Court: {NEEDS_COURT}."
        if not guess.walks:
            alone = "; or use the draft's line for people alone" * bool(draft.people_alone(guess))
            yield (
                "Cameras: nothing in the folder tells how they stand, and without a court there is "
                "no page for clicks: add a `calibration` file, `court_points` with your own "
                f"coordinates, a `board` or a `wand` (config/README.md){alone}."
            )
        return
    if guess.court_points is None:
        yield f"Court points: the first run makes a page to click them on, for {court_points}."
    if not guess.walks:
        yield "No walk was found: the cameras will be calibrated from clicked court points alone."


def _translated(guess: Guess) -> list[str]:
    """Return a line on names that stand for words of another script; empty where there are none."""
    said = []
    for camera in guess.cameras:
        films = guess.films(camera)
        said += [f"camera {camera} ({r.path})" for r in films[:1] if not r.path.isascii()]
    for name, take in guess.takes.items():
        films = [r for r in take.values() if not r.path.isascii()]
        said += [f"take {name} ({films[0].path})"] if films else []
    return [f"Names, with one of their files each: {', '.join(said)}."] if said else []


def _odd(guess: Guess) -> Iterator[str]:
    """Yield unusual sizes, rates and lengths, and what may be a wrong guess."""
    for camera in guess.cameras:
        films = [*guess.films(camera), *filter(None, [guess.static.get(camera)])]
        sizes = sorted({film.size for film in films if film.size is not None})
        if len(sizes) > 1:
            found = " and ".join(f"{width}x{height}" for width, height in sizes)
            yield f"camera {camera} has pictures of {found} pixels"
    for name, take in guess.takes.items():
        yield from _odd_take(name, take)
    yield from _copies(guess)
    yield from _static_trial(guess)
    yield from doubts(guess)
    yield from _only_video(guess)
    filmed = [recording for take in guess.takes.values() for recording in take.values()]
    for recording in [*guess.walks.values(), *filmed, *(r for *_, r in guess.devices)]:
        if recording.note:
            yield f"{recording.path}: {recording.note}"


def doubts(guess: Guess) -> Iterator[str]:
    """Yield what names leave open: which words name cameras, which videos are takes and which."""
    if guess.by_order:
        yield (
            f"no name tells which videos are of one take: those of {', '.join(guess.by_order)} "
            "were put together in the order of each camera's files; check them"
        )
    once = all(len(guess.films(camera)) < 2 for camera in guess.cameras)
    if any(guess.takes.values()) and (guess.doubtful or (once and len(guess.takes) > 1)):
        yield (
            f"the file names can be read in several ways: {', '.join(guess.cameras)} were taken "
            f"for cameras, {', '.join(guess.takes)} for takes; check that the videos of each take "
            "show one recording"
        )
    own = {word for camera in guess.cameras for word in names.words_of([camera])}
    takes = [set(names.words_of([take])) for take in guess.takes]
    for walk in guess.walks.values():
        spelled = names.name("_".join(walk.words), "walk")  # as takes are
        said = {*walk.words, *names.words_of([spelled])}
        named = is_called_walk(walk)
        taken = any(uncounted(word) in own for word in said)
        taken = taken or (not named and any(take <= said for take in takes))
        doubtful = not named if guess.cameras else len(guess.walks) > 1
        if taken or (doubtful and not takes and walk.kind == "video"):
            yield (
                f"{walk.path} was taken for a walk; if a fixed camera filmed it, name the camera "
                "and the take in its name"
            )


def _copies(guess: Guess) -> Iterator[str]:
    """Yield takes of as many frames in each camera as an earlier one, where cameras differ."""
    seen: dict[frozenset, str] = {}
    for name, take in guess.takes.items():
        lengths = frozenset((camera, r.n_frames) for camera, r in take.items())
        other = seen.setdefault(lengths, name)
        if other != name and len({r.n_frames for r in take.values()}) > 1:
            yield f"takes {other} and {name} have as many frames in each camera; is one a copy?"


def _static_trial(guess: Guess) -> Iterator[str]:
    """Yield videos of all cameras called `static`, as also the trial of a standing person is."""
    empty = list(guess.static.values())
    said = {word for r in empty for word in map(uncounted, r.words)} & STATIC
    filmed = len(empty) == len(guess.cameras) and all(r.kind == "video" for r in empty)
    if guess.takes and filmed and said == {"static"}:
        yield (
            f"{empty[0].path} and the other videos called `static` were taken for the empty court; "
            "if a person stands there, call them `neutral`"
        )


def _only_video(guess: Guess) -> Iterator[str]:
    """Yield that the only video was taken for a walk, if its name does not say so."""
    if guess.cameras or guess.takes:
        return
    for walk in guess.walks.values():
        if walk.kind == "video" and not is_called_walk(walk):
            yield (
                f"{walk.path} is the only video, and was taken for a walk; if it shows a person, "
                "it is a device of a take (config/README.md, Devices)"
            )


def _odd_take(name: str, take: Take) -> Iterator[str]:
    if not take or any(recording.kind == "keypoints" for recording in take.values()):
        return
    rates = {round(r.rate_hz or 0) for r in take.values()}
    if len(rates) > 1:
        yield f"take {name} has videos of {' and '.join(map(str, sorted(rates)))} Hz"
    lengths = [r.duration_s for r in take.values() if r.duration_s is not None]
    if max(lengths) > 2 * min(lengths):
        yield f"take {name} has videos whose lengths differ more than twofold"
    elif not lengths_fit(take.values()):
        found = f"{min(lengths):.1f} to {max(lengths):.1f} s"
        yield f"take {name} has videos of {found}; check that they show one recording"
    if len(lengths) > 1 and min(lengths) < SHORT_S and not draft.as_many_frames(take):
        yield (
            f"take {name} is {min(lengths):.1f} s long: in less than {SHORT_S} s the clocks of "
            "cameras are seldom found; say `synchronised: true` if they share one"
        )
