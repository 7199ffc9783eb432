"""Cases made, read in a watched process, and counted: who hangs or crashes is ended and named."""

import contextlib
import importlib
import json
import os
import random
import select
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path

from fuzz import mutations

TESTS = Path(__file__).parents[1]
LIBRARY = TESTS.parent / "workflow" / "lib"
LIMIT_S = 5.0
SLEEP_S = 30.0  # a process that neither ends nor computes waits for something
STARVED_S = 900.0  # one that others leave no processor
MORE_BYTES = 1 << 30
CASES_PER_PROCESS = 4000
MOST_FAILURES = 25  # of a format: then its other cases are left out
TICK_S = 0.2


@dataclass
class Result:
    """What came of the cases of a format."""

    name: str
    cases: int = 0
    values: int = 0
    refused: int = 0
    failures: list = field(default_factory=list)
    slowest_s: float = 0.0

    def line(self):
        """Return the row of the table."""
        return (
            f"{self.name:<18} {self.cases:>6} {self.values:>7} {self.refused:>12} "
            f"{len(self.failures):>8} {self.slowest_s:>9.2f}"
        )


HEAD = (
    f"{'format':<18} {'cases':>6} {'values':>7} {'clear errors':>12} "
    f"{'failures':>8} {'slowest s':>9}"
)


def table(results):
    """Return the lines of the table of all formats, the sum below."""
    total = Result("all")
    for result in results:
        total.cases += result.cases
        total.values += result.values
        total.refused += result.refused
        total.failures += result.failures
        total.slowest_s = max(total.slowest_s, result.slowest_s)
    return [HEAD, *(result.line() for result in results), total.line()]


class Watched:
    """A process that reads files, and the folder that it may write in.

    Parameters
    ----------
    folder : Path
        New and empty.
    module : str
        Whose `FORMATS` are read.
    limit_s : float
        Of the process's own time for one case.
    sleep_s : float
        Of time in which it does not compute.
    """

    def __init__(self, folder, module="fuzz.formats", *, limit_s=LIMIT_S, sleep_s=SLEEP_S):
        self.outside, self.module = Path(folder), module
        self.limit_s, self.sleep_s = limit_s, sleep_s
        self.formats = importlib.import_module(module).FORMATS
        self.wholes = self.outside / "wholes"
        self.inside = self.outside / "inside"
        self.case = self.inside / "case"
        self.case.mkdir(parents=True)
        self.noise = self.inside / "noise"
        self.process, self.n_read = None, 0

    def run(self, name, seed, cases):
        """Read `cases` changed files of a format and return its `Result`."""
        result = Result(name)
        for case in cases:
            what, more, seconds = self.one(name, seed, case)
            result.cases += 1
            result.slowest_s = max(result.slowest_s, seconds)
            result.values += what == "value"
            result.refused += what == "refused"
            if what == "failure":
                again = f"python tests/fuzz {name} {seed} {case}"
                result.failures.append(f"{name} {seed} {case}: {more}  [{again}]")
            if len(result.failures) >= MOST_FAILURES:
                break
        return result

    def one(self, name, seed, case):
        """Make one case, have it read, and return (what came of it, more, seconds)."""
        return self.read(name, self.make(name, seed, case))

    def make(self, name, seed, case):
        """Write the changed file or folder of a case and return its path."""
        rng = random.Random(f"{name}/{seed}/{case}")
        for old in self.case.iterdir():
            shutil.rmtree(old) if old.is_dir() and not old.is_symlink() else old.unlink()
        source = rng.choice(self.whole(name))
        path = self.case / source.name
        if source.is_dir():
            shutil.copytree(source, path)
            chosen = rng.choice(self.formats[name].changeable(path))
        else:
            chosen = path
        data = changed = chosen.read_bytes() if source.is_dir() else source.read_bytes()
        while changed == data:
            changed = mutations.mutate(data, chosen.suffix, rng)
        chosen.write_bytes(changed)
        return path

    def whole(self, name):
        """Return the whole files, or folders, that a format starts from."""
        folder = self.wholes / name
        if not folder.is_dir():
            folder.mkdir(parents=True)
            self.formats[name].make(folder)
        return sorted(folder.iterdir())

    def read(self, name, path):
        """Have a file or folder read and return (what came of it, more, seconds)."""
        if self.process is None or self.n_read >= CASES_PER_PROCESS:
            self.start()
        self.n_read += 1
        self.process.stdin.write(f"{name}\t{path}\n".encode())
        self.process.stdin.flush()
        if self._answer(STARVED_S) != "started":
            return self._dead("did not start")
        began_s, began = self._own_s()[0], time.monotonic()
        while (answer := self._answer(TICK_S)) is None:
            own_s, sleeps = self._own_s()
            waited_s = time.monotonic() - began
            if own_s - began_s > self.limit_s or waited_s > (self.sleep_s if sleeps else STARVED_S):
                return self._dead(f"still reading after {own_s - began_s:.1f} s")
        if not answer:
            return self._dead("the process ended")
        what, more = json.loads(answer)
        escaped = [p.name for p in (*self.outside.iterdir(), *self.inside.iterdir())]
        escaped = sorted(set(escaped) - {"wholes", "inside", "case", "noise"})
        if escaped:
            what, more = "failure", f"wrote outside: {escaped}"
        own_s = max(self._own_s()[0] - began_s, 0.0) + 1 / os.sysconf("SC_CLK_TCK")
        seconds = min(time.monotonic() - began, own_s)
        return ("failure", "too slow", seconds) if seconds > self.limit_s else (what, more, seconds)

    def start(self):
        """Start the process anew."""
        self.stop()
        words = [sys.executable, "-m", "fuzz.worker", self.module]
        words += [str(self.wholes), str(self.inside), str(MORE_BYTES)]
        paths = os.pathsep.join(map(str, (TESTS, LIBRARY)))
        kept = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "TMPDIR", "HOME")}
        own = {"PYTHONPATH": paths, "TMPDIR": str(self.case), "HOME": str(self.outside)}
        own |= {"PYTHONDONTWRITEBYTECODE": "1", "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
        with self.noise.open("wb") as noise:
            self.process = subprocess.Popen(
                words, cwd=self.case, env=kept | own, bufsize=0,
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=noise,
            )  # fmt: skip
        self.n_read, self.rest = 0, b""
        if self._answer(STARVED_S) != "ready":
            raise RuntimeError(f"the worker does not start: {self._output()}")

    def stop(self):
        """End the process."""
        if self.process is not None:
            with contextlib.suppress(ProcessLookupError):
                self.process.kill()
            self.process.communicate()
        self.process = None

    def _dead(self, why):
        seconds = self.limit_s
        self.process.kill()
        code = self.process.wait()
        message, self.process = self._output(), None
        return "failure", f"{why} (status {code}): {message}", seconds

    def _output(self):
        text = self.noise.read_bytes()[-600:].decode("utf-8", "replace")
        return " | ".join(text.split("\n")[-6:])

    def _answer(self, seconds):
        """Return the next line: None where none comes in time, empty where the process ended."""
        until = time.monotonic() + seconds
        while b"\n" not in self.rest:
            ready, _, _ = select.select(
                [self.process.stdout], [], [], max(until - time.monotonic(), 0)
            )
            if not ready:
                return None
            more = os.read(self.process.stdout.fileno(), 65536)
            if not more:
                return ""
            self.rest += more
        line, _, self.rest = self.rest.partition(b"\n")
        return line.decode()

    def _own_s(self):
        """Return the seconds the process has computed in all its threads, and whether it sleeps."""
        try:
            stat = Path(f"/proc/{self.process.pid}/stat").read_text()
        except OSError:
            return 0.0, True
        state, *fields = stat.rpartition(")")[2].split()
        user, system = fields[10:12]
        return (int(user) + int(system)) / os.sysconf("SC_CLK_TCK"), state != "R"
