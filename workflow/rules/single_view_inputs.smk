"""Input functions of the figures of devices, and what the study makes of them.

Inputs: the checked configuration. Outputs: none. Steps: which files belong to a figure; lists of files.
"""

PLATES = ("blazepose33", "mocopi27", "nuitrack19", "cpm14")  # skeletons side by side


def device_figure(name, caption):
    """Return the three files of a figure of a take's devices."""
    stem = f"results/{{session}}/takes/{{take}}/figures/{name}.{{model}}"
    return drawn(stem, caption, ("{session}", "{take}"), {"figure": caption, "network": "{model}"})


def kinds_of(wildcards):
    """Return the kind of each device of a take."""
    return {name: device.kind for name, device in take_of(wildcards).devices.items()}


def all_kinds():
    """Return the kind of each device of the study."""
    return {
        name: device.kind
        for session in STUDY.sessions.values()
        for take in session.takes.values()
        for name, device in take.devices.items()
    }


def events_file(wildcards):
    """Return the events of a take, by each device's own clock or by the one found."""
    folder = f"results/{wildcards.session}/takes/{wildcards.take}/sync"
    ending = "events.csv" if wildcards.clocks == "devices" else "csv"
    return f"{folder}/{wildcards.clocks}.{wildcards.model}.{ending}"


def plate_skeletons(wildcards):
    """Return the files of the skeletons that are drawn side by side, those of a take's own sources included."""
    own = [skeleton for _, skeleton, _ in sources_of(wildcards).values()]
    return [CONFIG / "skeletons" / f"{name}.yaml" for name in dict.fromkeys((*PLATES, *own))]


def true_arcs(wildcards, what):
    """Return the true arcs of a take's wrists, where there is a truth."""
    if not session_of(wildcards).virtual:
        return []
    folder = f"results/{wildcards.session}/evaluation/takes/{wildcards.take}/sources"
    return f"{folder}/{wildcards.model}.true_{what}.csv"


def thesis_take():
    """Return (session, take, model) of the take of figures 3.1 and 3.2; None where the study has it not."""
    for session, take in named_takes([STUDY.parameters["draw_thesis_fig3"]["take"]]):
        return session, take, STUDY.sessions[session].parameters["models"][0]
    return None


def thesis_file(wildcards, what):
    """Return a table of the arcs of the take of figures 3.1 and 3.2."""
    session, take, model = thesis_take()
    return f"results/{session}/takes/{take}/body/arcs.{model}.{what}.csv"


def thesis_truth(wildcards):
    """Return the true arcs of that take, where there is a truth."""
    session, take, model = thesis_take()
    if not STUDY.sessions[session].virtual:
        return []
    return f"results/{session}/evaluation/takes/{take}/sources/{model}.true_paths.csv"


def smoothed_takes():
    """Return one row per take with devices: its tables of arcs and errors, with the first network."""
    rows = []
    for session, take, model in device_takes():
        folder = f"results/{session}/evaluation/takes/{take}/sources/{model}"
        virtual = STUDY.sessions[session].virtual
        rows.append(
            {
                "labels": {"session": session, "take": take},
                "distortion": f"results/{session}/takes/{take}/body/arcs.{model}.distortion.csv",
                "errors": f"{folder}.errors.csv" if virtual else None,
                "truth": f"{folder}.true_distortion.csv" if virtual else None,
            }
        )
    return rows


def device_takes():
    """Return (session, take, first model) of all takes with devices."""
    return [
        (session.name, take.name, session.parameters["models"][0])
        for session in STUDY.sessions.values()
        for take in session.takes.values()
        if take.devices
    ]


def every_body_frame():
    """Return the tables of how far the body frames of virtual takes with devices are from the true ones."""
    return [
        f"results/{session}/evaluation/takes/{take}/body_frames/{model}.csv"
        for session, take, model in device_takes()
        if STUDY.sessions[session].virtual
    ]


def every_device_figure():
    """Return the figures of all takes with devices, and those of the thesis."""
    stems = []
    for session, take, model in device_takes():
        names = ["wrist_distance.devices", "wrist_distance.events", "wrist_arcs", "skeleton_plates"]
        names += ["source_errors"] if STUDY.sessions[session].virtual else []
        stems += [f"results/{session}/takes/{take}/figures/{name}.{model}" for name in names]
    stems += ["results/figures/thesis_fig3_1", "results/figures/thesis_fig3_2"] * bool(
        thesis_take()
    )
    stems += ["results/figures/smoothness"] if device_takes() else []
    return [f"{stem}.{suffix}" for stem in stems for suffix in FORMATS]
