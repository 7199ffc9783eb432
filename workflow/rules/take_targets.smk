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
    known = {path.stem for path in (CONFIG / "joint_offsets").glob("*.csv")}
    return [
        path
        for path in paths
        if "/pose3d_corrected/" not in path or Path(path).name.split(".")[0] in known
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
    """Return the errors of all takes of virtual sessions: by stage, views and rule; and of their clocks."""
    virtual = [session for session in STUDY.sessions.values() if session.virtual]
    found = []
    for session in virtual:
        fusions = session.fusions() + session.fusions("compared_fusions")
        for take in session.takes.values():
            names = {
                "session": session.name,
                "take": take.name,
                "calibration": session.take_calibrations(),
                "model": session.parameters["models"],
            }
            folder = "results/{session}/evaluation/takes/{take}"
            fused = folder + "/{stage}/{calibration}/{fusion}/{model}.csv"
            found += expand(fused, stage=STAGES, fusion=fusions, **names)
            if not take.synchronised:
                found += expand(folder + "/clocks/{calibration}.{model}.csv", **names)
    return with_offsets(found)
