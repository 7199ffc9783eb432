"""What the study makes: the files that `snakemake` asks for.

Inputs: the checked configuration. Outputs: none. Steps: lists of files, by subject.
"""


def every_calibration():
    """Return the cameras of every session, found in every way that the study names."""
    return [
        f"results/{session.name}/calibration/{way}/cameras.toml"
        for session in STUDY.sessions.values()
        for way in session.calibrations()
    ]


def every_photo_model():
    """Return the models of sessions of photos only: no fixed camera, no frame but the model's own."""
    return [
        f"results/{session.name}/sfm/{variant}/summary.json"
        for session in STUDY.sessions.values()
        if session.walks and not session.cameras
        for variant in session.variants()
    ]


def every_evaluation():
    """Return the errors of every structure from motion of the virtual sessions, and of known points alone."""
    return every_error(filmed_for_calibration())


def every_study_figure():
    """Return the figures and tables of the calibration study."""
    stems = [f"results/figures/court_points.{court}" for court in courts_used()]
    stems += [f"results/figures/{figure}" for figure in drawn_conditions()]
    for session in swept():
        names = ["badminton_fig08", "coverage", "growth"]
        names += [f"badminton_fig06.{mapper}" for mapper in session.parameters["sweep"]["mappers"]]
        stems += [f"results/{session.name}/figures/{name}" for name in names]
    for session in STUDY.sessions.values():
        ways = [way for way in session.calibrations() if way.startswith("sfm") and session.court]
        stems += [f"results/{session.name}/figures/error_map.{way}" for way in ways]
    stems += ["results/figures/badminton_fig12"] if racket_sessions() else []
    tables = ["results/figures/calibration.csv"] if swept() else []
    return [f"{stem}.{suffix}" for stem in stems for suffix in FORMATS] + tables


def courts_used():
    """Return the names of the courts of all sessions."""
    return sorted({session.court for session in STUDY.sessions.values() if session.court})


def filmed_for_calibration():
    """Return the virtual sessions of the calibration study: those with a walk and without takes."""
    return [s for s in STUDY.sessions.values() if s.virtual and s.walks and not s.takes]


def swept():
    """Return those of the calibration study that are no variation of another."""
    return [session for session in filmed_for_calibration() if not session.condition]


def tabulated():
    """Return the virtual sessions of the table: all but those of conditions with a figure of their own."""
    drawn = drawn_conditions().values()
    return [s for s in filmed_for_calibration() if s.condition.get("condition") not in drawn]


def varied(condition):
    """Return the sessions that are variations under a condition."""
    sessions = STUDY.sessions.values()
    return [s for s in sessions if s.condition.get("condition") == condition]


def evaluations(session):
    """Return the tables of errors of a session's structures from motion."""
    return [f"results/{session.name}/evaluation/{variant}.csv" for variant in session.variants()]


def every_error(sessions):
    """Return all tables of errors of virtual sessions."""
    known = [f"results/{session.name}/evaluation/known.csv" for session in sessions]
    return [path for session in sessions for path in evaluations(session)] + known


def timings(session):
    """Return the benchmark files of a session's structures from motion."""
    folder = f"results/{session.name}/benchmarks"
    once = [f"{folder}/{name}/all.tsv" for name in ("extract_features", "match_images")]
    swept = ("map_images", "adjust_network")
    return once + [f"{folder}/{name}/{v}.tsv" for name in swept for v in session.variants()]
