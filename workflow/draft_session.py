"""Draft a session's file from a folder of recordings.

Example: `python workflow/draft_session.py data/north`.

A plain program, for Snakemake checks sessions before it runs. It writes
config/sessions/<session>.yaml with every guess marked and config/<session>.yaml, the study of this
session alone, never over a file that is there, and says what to look at next. Of a session that is
there it prints the new takes, to be copied into the file.
"""

import argparse
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
COURTS = REPOSITORY / "config" / "courts"
SESSIONS = REPOSITORY / "config" / "sessions"
sys.path.insert(0, str(REPOSITORY / "workflow" / "lib"))

from courtside.study import installed

installed.require()

from courtside.drafting import additions, advice, draft, guess, survey
from courtside.drafting import names as file_names
from courtside.study.configuration import schemas, session_files
from courtside.study.configuration.configuration import RESERVED
from courtside.study.errors import InputError

# Files of config/ that no session's study may replace.
CONFIG_FILES = ("config", "derived_joints", "detectors", "external", "full", "models", "tiny")


def main(folder, name, court, sessions=None):
    """Draft one session and return the lines to print.

    Without a folder for the files of sessions, these and the study are this repository's.
    """
    root, sessions = (Path.cwd(), sessions) if sessions else (REPOSITORY, SESSIONS)
    check_court(court)
    title = (folder.resolve() if folder.name in ("", "..") else folder).name  # of a link its own
    name = name or file_names.name(title, "session1")
    check_name(name)
    check_folder(sessions)
    recordings = survey.survey(folder, root=root)
    found = guess.guess(recordings)
    written = survey.written(folder, root)
    path = sessions / f"{name}.yaml"
    if path.is_file():
        content = session_files.filled(schemas.read(path, "session"))
        return additions.to_paste(found, content, path=shown(path), folder=written)
    draft.write(path, draft.text(found, title=title, folder=written, court=court))
    study = sessions.parent / f"{name}.yaml"
    filmed = [t for t, films in found.takes.items() if films and t not in draft.unfilmed(found)]
    said = [f"Wrote {shown(path)}.", draft.write_study(shown(study), name, filmed)]
    points = None if court == "none" else draft.court_points(found, written)
    where = "" if Path.cwd() == root else f"In {root}: "
    return [*said, *advice.to_check(found, shown(path), points, survey.written(study, root), where)]


def check_court(court):
    """Refuse a court of which there is no file."""
    known = ["none", *sorted(path.stem for path in COURTS.glob("*.yaml"))]
    if court not in (None, *known):
        raise InputError(
            f"--court: expected one of {', '.join(known)}, found {court}; correct it, or add "
            f"{shown(COURTS / f'{court}.yaml')}"
        )


def check_name(name):
    """Refuse the name of a session that no session, or no study of a session, may have."""
    taken = sorted({*RESERVED, *CONFIG_FILES})
    if name in taken:
        raise InputError(
            f"--name: expected another name than {', '.join(taken)}, which config/ or results/ "
            f"have for files of their own, found {name}; give the session another name"
        )


def check_folder(sessions):
    """Refuse a folder of sessions that is not there."""
    if not sessions.is_dir():
        raise InputError(
            f"--sessions: expected a folder of the files of sessions, found "
            f"{'a file' if sessions.exists() else 'none'} at {shown(sessions)}; make it, or "
            "correct the path"
        )


def shown(path):
    """Return a path as it is given to Snakemake: from the working directory if below it."""
    return path.relative_to(Path.cwd()) if path.is_relative_to(Path.cwd()) else path


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=" ".join(__doc__.split("\n\n")[:2]))
    parser.add_argument("folder", type=Path, help="folder of recordings, such as data/north")
    parser.add_argument("--name", help="of the session (default: the name of the folder)")
    parser.add_argument(
        "--court",
        help="a file of config/courts, or none (default: badminton; none with a calibration file, "
        "with points that have their own coordinates, or without videos of fixed cameras)",
    )
    parser.add_argument(
        "--sessions",
        type=Path,
        help="folder of the files of sessions (default: config/sessions)",
    )
    given = parser.parse_args()
    try:
        print("\n".join(main(given.folder, given.name, given.court, given.sessions)))
    except (InputError, OSError) as error:
        sys.exit(f"Error: {error}")
