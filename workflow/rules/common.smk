"""What all rules share: the checked configuration, the library, binders of input functions.

Inputs: config/. Outputs: none. Steps: check every YAML file, then offer the functions below.
Which files and settings belong to a job is decided in `courtside.study.jobs`, what the study makes
in `courtside.study.targets`; every file is named in `courtside.study.paths`.
"""

import os
import sys
from pathlib import Path

REPOSITORY = Path(str(workflow.current_basedir)).parents[1]
SCRIPTS = REPOSITORY / "workflow" / "scripts"
LIBRARY = REPOSITORY / "workflow" / "lib"
LOCK = REPOSITORY / "environment.lock"
PINS = LOCK.read_text(encoding="utf-8") if LOCK.is_file() else ""
sys.path.insert(0, str(LIBRARY))
os.environ.update(OPENBLAS_NUM_THREADS="1")  # sums do not depend on the number of cores

from courtside.study import methods, paths, targets
from courtside.study.configuration import configuration, consent, plans, yaml_files
from courtside.study.errors import InputError
from courtside.study.execution import digest, file_dates, files, machine_resources
from courtside.study.jobs import (
    calibration,
    devices,
    evaluation,
    figures,
    pages,
    recordings,
    report_page,
    takes,
)
from courtside.study.jobs.job import Job

# Relative: a study may move with its results.
CONFIG = Path(files.seen_from(REPOSITORY / "config"))
CAPTIONS = files.seen_from(REPOSITORY / "workflow" / "report")
ASSETS = Path(files.seen_from(LIBRARY / "courtside" / "pages" / "assets"))

try:
    for folder in filter(Path.exists, [Path.cwd(), Path(paths.RESULTS)]):
        machine_resources.check(folder)
except InputError as error:
    sys.exit(f"Error: {error}")


configfile: str(REPOSITORY / "config" / "config.yaml")


NAME = "[a-z0-9][a-z0-9_-]*"

# Where faults are told to be, but those of the default file's values: the files of --configfile,
# which come before it, and --config.
OWN_FILES = [files.seen_from(path) for path in workflow.configfiles]
GIVEN = OWN_FILES[:-1]
OWN_FILES = GIVEN + ["--config"] * bool(workflow.config_settings.config) or OWN_FILES
OWN_FILES = " or ".join(OWN_FILES)

try:
    if workflow.is_main_process:
        yaml_files.check(GIVEN)
    STUDY = configuration.load(config, OWN_FILES, folder=CONFIG, root=Path.cwd())
    PLANS = {
        name: plans.read(CONFIG / paths.PLAN_YAML.format(plan=name)) for name in config["plans"]
    }
    REMARKS = []  # on recordings and stated bodies: told at the start, and again at the end
    if workflow.is_main_process:  # jobs need not look again, nor load what looks
        from courtside.validation import check as validation
        from courtside.validation import providers
        from courtside.validation.remembered import Remembered

        providers.check(STUDY)
        # Settings are parameters of jobs, which Snakemake compares whatever the dates of their files.
        settings = {*CONFIG.glob("*.yaml"), *map(files.seen_from, workflow.configfiles)}
        settings -= {CONFIG / paths.DERIVED_JOINTS_YAML}  # an input, as plans are
        apart = [paths.RESULTS, CONFIG / "sessions", *settings]
        file_dates.check_exchanged(paths.CHECKSUMS, apart)
        looks = Remembered(Path(".snakemake") / "courtside" / "recordings.json")
        REMARKS = [f"Remark: {remark}" for remark in validation.check(STUDY, looks)]
        print(*REMARKS, sep="\n", end="\n" * bool(REMARKS), file=sys.stderr)
    own = [f"data/{name}" for name in STUDY.sessions]
    own += [path for session in STUDY.sessions.values() for path in session.recordings()]
    file_dates.check_future([CONFIG, paths.EXTERNAL, *own])
except InputError as error:
    sys.exit("\n".join(f"Error: {line}" for line in str(error).splitlines()))

# Threads of a job that can use several. With two cores, two jobs side by side keep them busier than
# one with two threads, which waits until both are free; with more, all would wait for the longest.
SEVERAL = 1 if workflow.resource_settings.cores in (1, 2) else 2

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
    stage="|".join((*paths.STAGES, paths.MODELLED)),
    walk=NAME,
    mapper="global|incremental",
    n_images="[1-9][0-9]*",
    offset="[0-2]",
    court=NAME,


def code(script):
    """Return the digest of a script, of the code that it reaches, and of imported packages."""
    return DIGESTS.digest(SCRIPTS / script, LIBRARY)


def asked(function, *args, **options):
    """Return what a function of the library says; its error is told in one line."""
    try:
        return function(*args, **options)
    except InputError as error:
        raise WorkflowError(str(error)) from None


def tried(function, *args):
    """Call a function of the library; its error is one line after the fault that stopped a run."""
    try:
        function(*args)
    except InputError as error:
        print(f"Error: {error}", file=sys.stderr)


def of_job(function, *args, **options):
    """Return the input function of a library function whose first argument is the `Job`."""
    return lambda w: asked(function, Job(STUDY, dict(w.items())), *args, **options)


def files_of(function, *keys):
    """Return the input function of the files that the settings of a job name under some keys."""
    return of_job(lambda job: paths.files_in(function(job), *keys))


def session_of(wildcards):
    """Return the `Session` that a job belongs to."""
    return Job(STUDY, dict(wildcards.items())).session


def take_of(wildcards):
    """Return the `Take` that a job belongs to."""
    return of_job(lambda job: job.take)(wildcards)


def device_of(wildcards):
    """Return the `Device` that a job belongs to."""
    return of_job(lambda job: job.device)(wildcards)


def step(name):
    """Return an input function for the parameters of one step, with the session's overrides."""
    return lambda wildcards: session_of(wildcards).parameters[name]


def whole(path):
    """Return a recording as an input; of a folder, only its files have useful dates (`inside`)."""
    return ancient(path) if path and Path(path).is_dir() else path


def models_of(imported):
    """Return a pattern of the names of networks, or of skeletons of imported keypoints."""
    found = [name for name, m in STUDY.models.items() if (m.decoder == "imported") == imported]
    return "|".join(found) or "none-at-all"


def drawn(stem, name, category, labels):
    """Return the three files of a figure; the PNG goes into the report with its caption."""
    in_report = {"caption": f"../report/draw_{name}.rst", "labels": labels}
    in_report |= {"category": category[0], "subcategory": category[1]}
    return {"pdf": f"{stem}.pdf", "csv": f"{stem}.csv", "png": report(f"{stem}.png", **in_report)}


def figure(name):
    """Return the three files of a take's figure."""
    labels = {"figure": name, "network": "{model}", "calibration": "{calibration}"}
    stem = paths.part(paths.TAKE_FIGURE, figure=name)
    return drawn(stem, name, ("{session}", "{take}"), labels)


def calibrated_figure(name, label):
    """Return the three files of a figure of a take with all ways to fuse views."""
    labels = {"figure": label, "calibration": "{calibration}", "network": "{model}"}
    stem = paths.part(paths.CALIBRATED_FIGURE, figure=name)
    return drawn(stem, name, ("{session}", "{take}"), labels)


def device_figure(name, caption):
    """Return the three files of a figure of a take's devices."""
    stem = paths.part(paths.DEVICE_FIGURE, figure=name)
    return drawn(stem, caption, ("{session}", "{take}"), {"figure": caption, "network": "{model}"})


def session_figure(name, caption=None, **labels):
    """Return the three files of a session's figure of the calibration study."""
    stem = paths.part(paths.SESSION_FIGURE, figure=name)
    labels = labels or {"figure": name}
    return drawn(stem, caption or name, ("calibration", "{session}"), labels)


def study_figure(name, caption, category, **labels):
    """Return the three files of a figure of the study."""
    stem = paths.part(paths.STUDY_FIGURE, figure=name)
    return drawn(stem, caption, category, labels or {"figure": name})


def plan_figure(part):
    """Return the three files of a figure of a planned session, by keys that name the part."""
    stem = paths.part(paths.PLAN_FIGURE, figure=part)
    made = drawn(stem, f"plan_{part}", ("planning", "{plan}"), {"figure": f"plan_{part}"})
    return {f"{part}_{form}": path for form, path in made.items()}
