"""Make the environments of other programs that the benchmarks run side by side with this project.

    python benchmarks/peers.py                      all of them, below benchmarks/.environments/
    python benchmarks/peers.py mediapipe            one; prints its interpreter
    python benchmarks/peers.py --folder DIR ...     elsewhere

Every package is pinned and installed with --no-deps, because Pose2Sim's own list asks for OpenSim,
Qt and more that triangulation does not touch; `opensim` is Pose2Sim with OpenSim. An environment is
made once and used again until its pins change. No peer is ever imported into this project's own
process: `run_method` starts its interpreter.
"""

import argparse
import hashlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
import venv
from pathlib import Path

import numpy as np

import rows

HERE = Path(__file__).parent
FOLDER = HERE / ".environments"
MARK = "courtside-pins.sha256"
PLOTTING = """
    contourpy==1.3.3 cycler==0.12.1 fonttools==4.68.0 kiwisolver==1.5.1 matplotlib==3.11.2
    packaging==26.3 pillow==13.0.0 pyparsing==3.3.3 python-dateutil==4.0.0
"""
POSE2SIM = f"""
    pose2sim==0.10.49 anytree==2.13.0 c3d==0.6.0 filterpy==2.0.0 numpy==2.4.6
    opencv-python-headless==5.0.0.93 patsy==1.0.3 statsmodels==0.15.0
    pandas==3.1.1 rtoml==0.14.0 scipy==1.17.1 tqdm==4.70.1 tzdata==2026.6 {PLOTTING}
"""
PINS = {
    "aniposelib": """
        aniposelib==0.8.0 jax==0.10.2 jaxlib==0.10.2 llvmlite==0.50.0 ml_dtypes==0.6.0 numba==0.68.1
        numpy==2.4.6 opencv-contrib-python==5.0.0.93 opt_einsum==3.4.0 pandas==3.1.1
        python-dateutil==4.0.0 scipy==1.17.1 toml==0.10.2 tqdm==4.70.1 tzdata==2026.6
    """,
    "blender": "bpy==5.0.1 numpy==1.26.4",
    "caliscope": """
        caliscope==0.11.8 numpy==2.4.6 opencv-python-headless==5.0.0.93 pandas==3.1.1
        platformdirs==4.14.7 python-dateutil==4.0.0 rtoml==0.14.0 scipy==1.17.1 tzdata==2026.6
    """,
    "ffmpeg": "imageio-ffmpeg==0.8.1",
    "mediapipe": f"""
        mediapipe==0.10.21 absl-py==2.5.1 attrs==26.1.0 cffi==2.1.1 flatbuffers==25.12.19 jax==0.7.1
        jaxlib==0.7.1 ml_dtypes==0.5.4 numpy==1.26.4 opencv-contrib-python==4.11.0.86
        opt_einsum==3.4.0 protobuf==4.25.9 pycparser==3.12 scipy==1.17.1 sentencepiece==0.2.3
        sounddevice==0.5.6 {PLOTTING}
    """,
    "opensim": f"opensim==4.6 lxml==6.1.1 {POSE2SIM}",
    "pose2sim": POSE2SIM,
}
THREADS = "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"
ONE_THREAD = dict.fromkeys(THREADS, "1")
NEWEST_PYTHON = {"blender": (3, 11), "mediapipe": (3, 12)}  # their wheels end there


def interpreter(peer, folder=FOLDER):
    """Return the interpreter of a peer's environment, made if it is missing or its pins changed."""
    home = Path(folder).resolve() / peer
    python = home / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    pins = PINS[peer].split()
    digest = hashlib.sha256("\n".join(pins).encode()).hexdigest()
    mark = home / MARK
    if mark.is_file() and mark.read_text() == digest:
        return python
    newest = NEWEST_PYTHON.get(peer, sys.version_info[:2])
    if sys.version_info[:2] > newest:
        raise SystemExit(
            f"{peer}: expected Python {newest[0]}.{newest[1]} or older, "
            f"found {sys.version.split()[0]}: run the benchmark with an older Python"
        )
    shutil.rmtree(home, ignore_errors=True)
    print(f"making {home}", file=sys.stderr)
    venv.create(home, with_pip=True)
    quiet = ["--quiet", "--disable-pip-version-check"]
    subprocess.run([python, "-m", "pip", "install", *quiet, "--no-deps", *pins], check=True)
    mark.write_text(digest)
    return python


def run_method(python, script, *arguments):
    """Run one script of methods/ on one core and one thread, and return what it printed as JSON.

    Parameters
    ----------
    python : path
        Interpreter of the environment to run in.
    script : str
        File name below benchmarks/methods.
    *arguments : str or path

    Returns
    -------
    result : dict
        The last line of its output; `{"failed": reason}` where it ended with an error.
    """
    environment = {**os.environ, **ONE_THREAD, "MPLBACKEND": "Agg"}
    command = [python, HERE / "methods" / script, *arguments]
    done = subprocess.run(
        [str(part) for part in command],
        env=environment,
        preexec_fn=_one_core if os.name == "posix" else None,
        capture_output=True,
        text=True,
    )
    if done.returncode:
        return {"failed": (done.stderr.strip().splitlines() or ["no message"])[-1]}
    return json.loads(done.stdout.strip().splitlines()[-1])


def measured(runs, arrays, environments):
    """Run methods on the same arrays, and return the least seconds and the result of each.

    Parameters
    ----------
    runs : list of (str or None, str, tuple of str)
        Peer (None: this project, which runs first and last), script of methods/, its further
        arguments.
    arrays : dict of str to array-like
        What each script reads from its first file; its second file takes one result per function.
    environments : path
        Where the peers' environments are.

    Returns
    -------
    found : dict of str to (float, ndarray)
        By method, which is `rows.OURS` for this project.
    """
    found = {}
    with tempfile.TemporaryDirectory() as name:
        given, result = Path(name) / "given.npz", Path(name) / "result.npz"
        np.savez(given, **arrays)
        for peer, script, arguments in runs:
            python = interpreter(peer, environments) if peer else sys.executable
            timed = run_method(python, script, given, result, *arguments)
            if "failed" in timed:
                raise SystemExit(f"{script}: {timed['failed']}")
            with np.load(result) as made:
                for function, each in timed.items():
                    method = f"{peer} {function}" if peer else rows.OURS
                    best_s = min([*each["seconds"], found.get(method, (np.inf,))[0]])
                    found[method] = best_s, made[function]
    return found


def on_one_thread():
    """Start this program anew unless its libraries were told to use one thread before they load."""
    if any(os.environ.get(name) != "1" for name in ONE_THREAD):
        sys.stdout.flush()
        command = [sys.executable, *sys.orig_argv[1:]]
        os.execve(sys.executable, command, {**os.environ, **ONE_THREAD})


def _one_core():
    if hasattr(os, "sched_setaffinity"):  # not on macOS
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})


def main():
    """Make the environments asked for."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("peers", nargs="*", help=f"{', '.join(PINS)}; all by default")
    parser.add_argument("--folder", type=Path, default=FOLDER)
    given = parser.parse_args()
    unknown = sorted(set(given.peers) - set(PINS))
    if unknown:
        parser.error(f"unknown peers {unknown}: expected some of {list(PINS)}")
    for peer in given.peers or PINS:
        print(interpreter(peer, given.folder))


if __name__ == "__main__":
    main()
