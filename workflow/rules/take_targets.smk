"""What the study makes of takes: the files that `snakemake` asks for.

Inputs: the checked configuration. Outputs: none. Steps: lists of files, by subject.
"""


def each_take(pattern, **choices):
    """Return `pattern` for every take of every session and every method of the study.

    A choice is a list, the name of a list among the session's parameters, or a function of session and take.
    """
    return [
        path
        for session in STUDY.sessions.values()
        for take in session.takes.values()
        for path in expand(
            pattern,
            session=session.name,
            take=take.name,
            **{
                "person": take.subjects,
                "calibration": session.take_calibrations(),
                "fusion": session.fusions(),
                "model": session.parameters["models"],
                **{key: listed(session, take, value) for key, value in choices.items()},
            },
        )
    ]


def listed(session, take, value):
    """Return a list: as it is, of this name among the session's parameters, or what a function says."""
    if callable(value):
        return value(session, take)
    return session.parameters[value] if isinstance(value, str) else value


def every_check():
    """Return the checks that cameras with a static recording stood still until each take."""
    return [
        f"results/{session.name}/takes/{take.name}/movement/{camera}.csv"
        for session in STUDY.sessions.values()
        for take in session.takes.values()
        for camera in take.videos
        if session.cameras[camera].static and not take.steady
    ]


def every_export():
    """Return the files for other programs that the study makes."""
    return with_offsets(
        each_take(
            "results/{session}/takes/{take}/{stage}/{calibration}/{fusion}/{model}.{person}.{suffix}",
            stage="export_stages",
            suffix=["trc", "c3d", "csv"],
            person=lambda session, take: [
                name
                for name in take.subjects
                if name not in consent.refusing(session, take, "export")
            ],
        )
    )


def with_offsets(paths):
    """Return the paths without those of corrected joints of networks whose offsets nobody has estimated."""
    return [
        path
        for path in paths
        if "pose3d_corrected" not in Path(path).parts or has_offsets(Path(path).name.split(".")[0])
    ]


def every_figure():
    """Return the figures of all takes."""
    return each_take(
        "results/{session}/takes/{take}/figures/{figure}.{calibration}.{fusion}.{model}.{suffix}",
        figure=lambda session, take: shown(session, take, session.parameters["take_figures"]),
        suffix=FORMATS,
    )


def every_shake():
    """Return the figures of how cameras shook, of the takes in which that is taken out."""
    return [
        f"results/{session.name}/takes/{take.name}/figures/shake.{way}.{fusion}.{model}.{suffix}"
        for session in STUDY.sessions.values()
        for take in session.takes.values()
        if take.steady
        for way, model in product(session.take_calibrations(), session.parameters["models"])
        for fusion, suffix in product(session.fusions(), FORMATS)
    ]


def every_kinematics():
    """Return the measures of all takes, those of other programs' skeletons included."""
    imported = [
        f"results/{session.name}/takes/{take.name}/kinematics/imported/trc/{skeleton}.summary.csv"
        for session in STUDY.sessions.values()
        for take in session.takes.values()
        for skeleton in take.pose3d
    ]
    return imported + each_take(
        "results/{session}/takes/{take}/kinematics/{calibration}/{fusion}/{model}.summary.csv"
    )


def evaluations_of_takes(kind):
    """Return the tables of one kind of error of all takes of virtual sessions.

    Kinds: errors, kinematics, clocks (of cameras without a common clock), gains (of one way to fuse over another).
    """
    found = []
    for session in (s for s in STUDY.sessions.values() if s.virtual):
        compared = session.fusions("compared_fusions")
        for take in session.takes.values():
            folder = f"results/{session.name}/evaluation/takes/{take.name}"
            for way, model in product(session.take_calibrations(), session.parameters["models"]):
                last = stages_of(model)[-1]
                found += {
                    "errors": [f"{folder}/errors/{way}.{model}.csv"],
                    "kinematics": [
                        f"{folder}/kinematics/{way}/{fusion}/{model}.csv"
                        for fusion in session.fusions()
                    ],
                    "clocks": [f"{folder}/clocks/{way}.{model}.csv"] * (not take.synchronised),
                    "gains": [
                        f"{folder}/gains/{stage}.{way}.{model}.csv" for stage in ("pose3d", last)
                    ]
                    * bool(compared),
                }[kind]
    return found
