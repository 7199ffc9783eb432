"""The process that reads the changed files: it says what came of each, and what it wrote outside.

Started by `watch.Watched` with the module whose `FORMATS` are read, the folder of whole files, the
folder it may write in and how much memory it may take; then, for each case, `format path` on a
line.
"""

import importlib
import json
import os
import resource
import shutil
import sys
import traceback
import warnings
from pathlib import Path

LONGEST_LINE = 2000
WRITES = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND
MOVES = ("os.remove", "os.rename", "os.rmdir", "os.mkdir", "os.link", "os.symlink", "os.truncate")
FORBIDDEN = ("pickle.find_class", "os.system", "os.exec", "os.posix_spawn", "socket.connect")
FORBIDDEN += ("subprocess.Popen", "marshal.loads", "webbrowser.open")


class Guard:
    """Notes what a reader does that none may: write outside its folder, unpickle, start programs.

    Parameters
    ----------
    folder : Path
        Where it may write.
    """

    def __init__(self, folder):
        self.folder, self.seen, self.on = folder, [], False
        sys.addaudithook(self._hook)

    def _hook(self, event, arguments):
        if not self.on:
            return
        if event in FORBIDDEN:
            self.seen.append(f"{event} {arguments!r:.100}")
        elif event == "open" and arguments[2] & WRITES:
            self._place(event, arguments[0])
        elif event in MOVES:
            for name in arguments[:2]:
                self._place(event, name)

    def _place(self, event, name):
        if isinstance(name, str | bytes | os.PathLike):
            place = Path(os.path.realpath(os.fsdecode(name)))
            if self.folder not in (place, *place.parents) and place != Path(os.devnull):
                self.seen.append(f"{event} {place}")


def unclear(error, path):
    """Return what is wrong with a message; empty where it is one readable line naming the file."""
    lines = error.lines  # of a configuration one for each fault
    for line in lines:
        if line.splitlines() != [line] or not line.isprintable():
            return f"not one printable line: {line!r:.300}"
        if len(line) > LONGEST_LINE:
            return f"a line of {len(line)} characters: {line[:300]!r}"
        if path.is_file() and path.name not in line:
            return f"a line that does not name {path.name}: {line[:300]}"
    return "" if lines else "no fault named"


def outcome(read, path, expected):
    """Return (what came of it, more about it)."""
    try:
        read(path)
    except expected as error:
        fault = unclear(error, path)
        return ("failure", fault) if fault else ("refused", str(error)[:500])
    except BaseException as error:  # noqa: BLE001 - whatever it is, it is reported
        where = traceback.extract_tb(error.__traceback__)[-1]
        return (
            "failure",
            f"{type(error).__name__}: {error!s:.200} ({where.filename}:{where.lineno})",
        )
    return "value", ""


def warm(form, wholes, folder, expected):
    """Read the whole files of a format: what this imports and keeps is no part of the limit."""
    for whole in sorted((wholes / form.name).iterdir()):
        path = folder / "warm" / whole.name
        path.parent.mkdir()
        shutil.copytree(whole, path) if whole.is_dir() else shutil.copy(whole, path)
        what, more = outcome(form.read, path, expected)
        shutil.rmtree(path.parent)
        if what == "failure":
            raise RuntimeError(f"{whole.name} of {form.name}: {more}")


def limited(more_bytes):
    """Limit the memory to what is used and so much more; return the former."""
    used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (used + more_bytes, resource.RLIM_INFINITY))


def main(module, wholes, folder, more_bytes):
    """Read what is asked for until there is nothing more."""
    answers = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(2, 1)
    from courtside.study.errors import InputError

    formats = importlib.import_module(module).FORMATS
    warnings.simplefilter("ignore")
    folder, current = Path(folder).resolve(), None
    guard = Guard(folder / "case")
    answers.write("ready\n")
    for line in sys.stdin:
        name, path = line.rstrip("\n").split("\t")
        if name != current:
            resource.setrlimit(resource.RLIMIT_AS, (resource.RLIM_INFINITY,) * 2)
            warm(formats[name], Path(wholes), folder, InputError)
            limited(more_bytes)
            current = name
        answers.write("started\n")
        guard.on = True
        what, more = outcome(formats[name].read, Path(path), InputError)
        guard.on = False
        if guard.seen:
            what, more = "failure", f"did what it may not: {guard.seen[:3]}"
            guard.seen.clear()
        answers.write(json.dumps([what, more]) + "\n")


if __name__ == "__main__":
    main(*sys.argv[1:4], int(sys.argv[4]))
