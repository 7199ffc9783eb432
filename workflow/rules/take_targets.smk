"""What the study makes of takes: the files that `snakemake` asks for.

Inputs: the checked configuration. Outputs: none. Steps: lists of files, by subject.
"""


def each_take(pattern, **choices):
    """Return `pattern` for every take of every session and every method of the study."""
    return [
        path
        for session in STUDY.sessions.values()
        for take in session.takes.values()
        for path in expand(
            pattern,
            session=session.name,
            take=take.name,
            person=take.subjects,
            **{
                "calibration": session.take_calibrations(),
                "fusion": session.fusions(),
                "model": session.parameters["models"],
                **{key: listed(session, value) for key, value in choices.items()},
            },
        )
    ]


def listed(session, value):
    """Return a list, or the list of this name among the session's parameters."""
    return session.parameters[value] if isinstance(value, str) else value


def every_check():
    """Return the checks that cameras with a static recording stood still until each take."""
    return [
        f"results/{session.name}/takes/{take.name}/movement/{camera}.csv"
        for session in STUDY.sessions.values()
        for take in session.takes.values()
        for camera in take.videos
        if session.cameras[camera].static
    ]


def every_export():
    """Return the files for other programs that the study makes."""
    return with_offsets(
        each_take(
            "results/{session}/takes/{take}/{stage}/{calibration}/{fusion}/{model}.{person}.{suffix}",
            stage="export_stages",
            suffix=["trc", "c3d", "csv"],
        )
    )


def with_offsets(paths):
    """Return the paths without those of corrected joints of networks whose offsets nobody has estimated."""
    return [
        path
        for path in paths
        if "/pose3d_corrected/" not in path or has_offsets(Path(path).name.split(".")[0])
    ]


def every_figure():
    """Return the figures of all takes."""
    return each_take(
        "results/{session}/takes/{take}/figures/{figure}.{calibration}.{fusion}.{model}.{suffix}",
        figure="take_figures",
        suffix=FORMATS,
    )


def every_kinematics():
    """Return the measures of all takes."""
    return each_take(
        "results/{session}/takes/{take}/kinematics/{calibration}/{fusion}/{model}.summary.csv"
    )


def every_take_evaluation():
    """Return the errors of all takes of virtual sessions, of their kinematics and of their clocks."""
    found = []
    for session in (s for s in STUDY.sessions.values() if s.virtual):
        for take in session.takes.values():
            folder = f"results/{session.name}/evaluation/takes/{take.name}"
            ways = product(session.take_calibrations(), session.parameters["models"])
            for way, model in ways:
                found.append(f"{folder}/errors/{way}.{model}.csv")
                found += [
                    f"{folder}/kinematics/{way}/{fusion}/{model}.csv"
                    for fusion in session.fusions()
                ]
                if not take.synchronised:
                    found.append(f"{folder}/clocks/{way}.{model}.csv")
    return found


def every_players_figure():
    """Return the figures that takes are drawn in together."""
    stems = []
    for session, take in tabled_takes():
        stem = f"results/{session}/takes/{take}/figures/badminton_tab01"
        models = STUDY.sessions[session].parameters["models"]
        ways = STUDY.sessions[session].take_calibrations()
        stems += [f"{stem}.{way}.{model}" for way, model in product(ways, models)]
    stems += ["results/figures/agreement"] if compared_takes() else []
    stems += ["results/figures/archive"] if archived_takes() else []
    return [f"{stem}.{suffix}" for stem in stems for suffix in FORMATS]
