"""Read changed files again, or all.

Usage: `python tests/fuzz FORMAT SEED CASE`, `python tests/fuzz [FORMAT ...]`.

With a case, the changed file is kept in the folder named, and what its reader says is printed.
"""

import sys
import tempfile
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(TESTS), str(TESTS.parent / "workflow" / "lib")]

from fuzz import formats, watch  # noqa: E402


def one(name, seed, case):
    """Make and read one case."""
    watched = watch.Watched(Path(tempfile.mkdtemp(prefix="courtside-fuzz-")))
    path = watched.make(name, seed, case)
    what, more, seconds = watched.read(name, path)
    watched.stop()
    print(f"{path}\n{what} after {seconds:.2f} s: {more}")


def every(names, share=1.0, seed=1):
    """Run formats and print their table."""
    results = []
    with tempfile.TemporaryDirectory(prefix="courtside-fuzz-") as folder:
        watched = watch.Watched(Path(folder))
        for name in names or formats.FORMATS:
            result = watched.run(name, seed, range(round(share * formats.FORMATS[name].cases)))
            results.append(result)
            print("\n".join([result.line(), *result.failures]), flush=True)
        watched.stop()
    print("\n".join(watch.table(results)))


if __name__ == "__main__":
    words = sys.argv[1:]
    if len(words) == 3 and words[2].isdigit():
        one(words[0], int(words[1]), int(words[2]))
    else:
        share = next((float(w[2:]) for w in words if w.startswith("x=")), 1.0)
        every([w for w in words if w in formats.FORMATS], share)
