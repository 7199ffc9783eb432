"""What the study makes: the files that `snakemake` asks for.

Inputs: the checked configuration. Outputs: none. Steps: lists of files, by subject.
"""


def each_take(pattern, **choices):
    """Return `pattern` for every take of every session and every method of the study."""
    methods = {key: STUDY.parameters[f"{key}s"] for key in ("fusion", "model")}
    return [
        path
        for session in STUDY.sessions.values()
        for take in session.takes.values()
        for path in expand(
            pattern,
            session=session.name,
            take=take.name,
            person=take.subjects,
            calibration=session.calibrations(),
            **methods,
            **choices,
        )
    ]


def every_export():
    """Return the files for other programs that the study makes."""
    return each_take(
        "results/{session}/takes/{take}/{stage}/{calibration}/{fusion}/{model}.{person}.{suffix}",
        stage=STAGES,
        suffix=["trc", "c3d", "csv"],
    )


def every_figure():
    """Return the figures that the study makes."""
    return each_take(
        "results/{session}/takes/{take}/figures/{figure}.{calibration}.{fusion}.{model}.{suffix}",
        figure=FIGURES,
        suffix=FORMATS,
    )


def every_calibration():
    """Return the cameras of every session, found in every way that the study names."""
    return [
        f"results/{session.name}/calibration/{way}/cameras.toml"
        for session in STUDY.sessions.values()
        for way in session.calibrations()
    ]


def every_evaluation():
    """Return the errors of every structure from motion of the virtual sessions, and of known points alone."""
    virtual = [session for session in STUDY.sessions.values() if session.virtual]
    known = [f"results/{session.name}/evaluation/known.csv" for session in virtual]
    return [path for session in virtual for path in evaluations(session)] + known


def evaluations(session, mapper=None):
    """Return the tables of errors of a session's structures from motion."""
    return [
        f"results/{session.name}/evaluation/{variant}.csv"
        for variant in session.variants()
        if mapper is None or variant.startswith(mapper)
    ]
