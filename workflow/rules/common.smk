"""What all rules share: the checked configuration, the library on the path, names of files.

Inputs: config/. Outputs: none. Steps: check every YAML file, then offer the functions below.
"""

import os
import re
import sys
from itertools import product
from pathlib import Path

REPOSITORY = Path(str(workflow.current_basedir)).parents[1]
CONFIG = Path(os.path.relpath(REPOSITORY / "config"))  # relative: a study may move with its results
SCRIPTS = REPOSITORY / "workflow" / "scripts"
LIBRARY = REPOSITORY / "workflow" / "lib"
ASSETS = Path(os.path.relpath(LIBRARY / "courtside" / "pages" / "assets"))
LOCK = REPOSITORY / "environment.lock"
PINS = LOCK.read_text(encoding="utf-8") if LOCK.is_file() else ""
sys.path.insert(0, str(LIBRARY))
os.environ.update(OPENBLAS_NUM_THREADS="1")  # sums do not depend on the number of cores

from courtside.study.configuration import configuration, plans
from courtside.study.errors import InputError
from courtside.study.execution import digest, files, future_dates, machine_resources

try:
    for folder in filter(Path.exists, [Path.cwd(), Path("results")]):
        machine_resources.check(folder)
except InputError as error:
    sys.exit(f"Error: {error}")


configfile: str(REPOSITORY / "config" / "config.yaml")


NAME = "[a-z0-9][a-z0-9_-]*"
MODEL_PARTS = ["cameras", "images", "points3D", "rigs", "frames"]  # files of a COLMAP model
STAGES = ["pose3d", "pose3d_filtered", "pose3d_corrected"]
FORMATS = ["pdf", "png", "csv"]

try:
    STUDY = configuration.load(config, workflow.configfiles[-1], folder=CONFIG, root=Path.cwd())
    PLANS = {name: plans.read(CONFIG / "plans" / f"{name}.yaml") for name in config["plans"]}
    future_dates.check([CONFIG, "results/external", *(f"data/{name}" for name in STUDY.sessions)])
except InputError as error:
    sys.exit("\n".join(f"Error: {line}" for line in str(error).splitlines()))

DIGESTS = digest.Remembered(Path(".snakemake") / "courtside" / "code.json", PINS)


wildcard_constraints:
    session="|".join(STUDY.sessions),
    take=NAME,
    camera=NAME,
    person=NAME,
    device=NAME,
    source=NAME,
    plan=NAME,
    model="|".join(STUDY.models),
    calibration=NAME,
    fusion=NAME,
    stage="|".join(STAGES),
    walk=NAME,
    mapper="global|incremental",
    n_images="[1-9][0-9]*",
    offset="[0-2]",
    court=NAME,


def code(script):
    """Return the digest of a script, the code that it reaches, the packages they import: a change reruns the rule."""
    return DIGESTS.digest(SCRIPTS / script, LIBRARY)


def session_of(wildcards):
    """Return the `Session` that a job belongs to."""
    return STUDY.sessions[wildcards.session]


def take_of(wildcards):
    """Return the `Take` that a job belongs to."""
    session = session_of(wildcards)
    if wildcards.take in session.withheld:
        raise WorkflowError(
            f"{session.file}: expected analysis in the consent of {', '.join(session.withheld[wildcards.take])}, "
            f"found none: nothing is made of take {wildcards.take}"
        )
    return session.takes[wildcards.take]


def step(name):
    """Return an input function for the parameters of one step, with the session's overrides."""
    return lambda wildcards: session_of(wildcards).parameters[name]


def each_camera(pattern):
    """Return an input function for the files of all cameras of a take, in the take's order."""
    return lambda wildcards: [
        pattern.format(**dict(wildcards.items()), camera=camera)
        for camera in take_of(wildcards).videos
    ]


def models_of(imported):
    """Return a pattern of the names of networks, or of skeletons whose keypoints other programs find."""
    found = [name for name, m in STUDY.models.items() if (m.decoder == "imported") == imported]
    return "|".join(found) or "none-at-all"


def skeleton_file(wildcards):
    """Return the path of the skeleton of a job's network."""
    return CONFIG / "skeletons" / f"{STUDY.models[wildcards.model].skeleton}.yaml"


def network(wildcards):
    """Return the entry of a model's network in config/models.yaml."""
    return getattr(STUDY.models[wildcards.model], wildcards.part)


def tflite_file(wildcards):
    """Return the TFLite file of a model's network."""
    return f"results/external/{network(wildcards).artefact}/{network(wildcards).member}"


def figure(name):
    """Return the three files of a take's figure."""
    stem = f"results/{{session}}/takes/{{take}}/figures/{name}.{{calibration}}.{{fusion}}.{{model}}"
    labels = {"figure": name, "network": "{model}", "calibration": "{calibration}"}
    return drawn(stem, name, ("{session}", "{take}"), labels)


def session_figure(name):
    """Return the three files of a session's figure of the calibration study."""
    labels = {"figure": name}
    return drawn(f"results/{{session}}/figures/{name}", name, ("calibration", "{session}"), labels)


def drawn(stem, name, category, labels):
    """Return the three files of a figure; the PNG goes into the report with its caption."""
    return {
        "pdf": f"{stem}.pdf",
        "csv": f"{stem}.csv",
        "png": report(
            f"{stem}.png",
            caption=f"../report/draw_{name}.rst",
            category=category[0],
            subcategory=category[1],
            labels=labels,
        ),
    }
