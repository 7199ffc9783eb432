"""Python in forks of a process that has imported what Snakemake and checks of sessions import.

Neither Snakemake nor the library is among it: Snakemake keeps the folder in which it was imported,
and tests edit copies of the library. A fork imports both as a new process does.
"""

import functools
import importlib
import json
import os
import runpy
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

IMPORTED = ("sqlmodel", "smart_open", "nbformat", "jsonschema", "pandas", "cv2", "av")
POSSIBLE = sys.platform == "linux"  # elsewhere, what is imported may not bear a fork


def run(module, *words, cwd, timeout_s):
    """Do what `python -m` does with a module and words in a folder; return the finished process."""
    with tempfile.TemporaryDirectory() as folder:
        streams = [str(Path(folder) / name) for name in ("stdout", "stderr")]
        job = {"module": module, "words": words, "cwd": str(cwd), "timeout_s": timeout_s}
        job |= {"environment": dict(os.environ), "streams": streams}
        print(json.dumps(job), file=_parent().stdin, flush=True)
        code = int(_parent().stdout.readline())
        return subprocess.CompletedProcess(words, code, *(Path(s).read_text() for s in streams))


@functools.cache
def _parent():
    """Start the process that forks; it ends when this one does, which closes its input."""
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    return subprocess.Popen([sys.executable, __file__], text=True, **pipes)


def _serve():
    """Run each line of the input in a fork, and print its exit status."""
    for name in IMPORTED:
        importlib.import_module(name)
    for line in sys.stdin:
        if child := os.fork():
            print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
        else:
            sys.exit(_become(**json.loads(line)))


def _become(module, words, cwd, timeout_s, environment, streams):
    signal.alarm(timeout_s)  # ends the process
    os.chdir(cwd)
    os.environ.clear()
    os.environ.update(environment)
    for number, path in enumerate([os.devnull, *streams]):
        os.dup2(os.open(path, os.O_RDWR | os.O_CREAT), number)
    sys.path[0], sys.argv[1:] = cwd, words
    runpy.run_module(module, run_name="__main__", alter_sys=True)


if __name__ == "__main__":
    _serve()
