"""Input functions and parameters of the figures of a stroke.

Inputs: the checked configuration. Outputs: none. Steps: which takes, frames and cameras are drawn.
"""


def stroke(wildcards):
    """Return which frames of a take are its stroke: so many from a time on, in seconds."""
    step = STUDY.parameters["draw_stroke"]
    return {
        "n_frames": step["n_frames"],
        "start_s": step["takes"].get(f"{wildcards.session}/{wildcards.take}"),
    }


def fig05_layouts():
    """Return for each layout of fig 5 its session and cameras, of the sessions that the study has and may show."""
    wanted = STUDY.parameters["draw_badminton_fig05"]["layouts"]
    return {
        layout: [name, place["cameras"]]
        for layout, place in wanted.items()
        for name, take in named_takes([place["take"]])
        if agree(STUDY.sessions[name], STUDY.sessions[name].takes[take], "pictures")
    }


def fig05_evaluations():
    """Return (folder, network) of the evaluations of fig 5's takes."""
    wanted = STUDY.parameters["draw_badminton_fig05"]["layouts"]
    takes = named_takes(dict.fromkeys(wanted[layout]["take"] for layout in fig05_layouts()))
    model = STUDY.parameters["models"][0]
    return [(f"results/{session}/evaluation/takes/{take}", model) for session, take in takes]


def fig05_sources():
    """Return name, 2D keypoints and video of each camera of fig 5."""
    wanted, found = STUDY.parameters["draw_badminton_fig05"]["layouts"], {}
    model = STUDY.parameters["models"][0]
    for layout in fig05_layouts():
        session, take = Path(wanted[layout]["take"]).parts
        for camera in wanted[layout]["cameras"]:
            found[session, camera] = {
                "name": [session, camera],
                "pose2d": f"results/{session}/takes/{take}/pose2d/{model}/{camera}.npz",
                "video": STUDY.sessions[session].takes[take].videos[camera],
            }
    return list(found.values())


def fig_of_take(name):
    """Return the three files of a figure of the paper."""
    labels = {"figure": name, "network": "{model}", "calibration": "{calibration}"}
    stem = f"{TAKE}/figures/{name}.{{calibration}}.{{fusion}}.{{model}}"
    return drawn(stem, name, ("{session}", "{take}"), labels)


def seen_and_made(wildcards):
    """Return what a picture of detections beside the skeleton needs, by name."""
    take = f"results/{wildcards.session}/takes/{wildcards.take}"
    way, model = wildcards.calibration, wildcards.model
    return {
        "pose3d": f"{take}/pose3d/{way}/{wildcards.fusion}/{model}.npz",
        "cameras": f"results/{wildcards.session}/calibration/{way}/cameras.toml",
        "pose2d": [f"{take}/pose2d/{model}/{camera}.npz" for camera in take_of(wildcards).videos],
        "people": f"{take}/people/{way}/{model}.npz",
        "sync": f"{take}/sync/{way}/cameras.{model}.json",
        "videos": list(take_of(wildcards).videos.values()),
        "skeleton": skeleton_file(wildcards),
        "derived": CONFIG / "derived_joints.yaml",
    }
