"""Input functions and parameters of rules.

Inputs: the checked configuration. Outputs: none. Steps: which files and settings belong to a job.
"""


def court_file(session):
    """Return the path of a session's court, None without a court."""
    return CONFIG / "courts" / f"{session.court}.yaml" if session.court else None


def each_fixed(pattern):
    """Return an input function for the files of all fixed cameras of a session."""
    return lambda wildcards: [
        pattern.format(**dict(wildcards.items()), camera=camera)
        for camera in session_of(wildcards).cameras
    ]


def each_walk(pattern):
    """Return an input function for the files of all walks of a session."""
    return lambda wildcards: [
        pattern.format(**dict(wildcards.items()), walk=walk) for walk in session_of(wildcards).walks
    ]


def first_of_each_count(pattern):
    """Return an input function for a file of each number of bridging images, first choice of images."""
    return lambda wildcards: [
        pattern.format(session=wildcards.session, variant=f"{wildcards.mapper}-n{count}-o0")
        for count in session_of(wildcards).parameters["sweep"]["n_images"]
    ]


def map_parameters(wildcards):
    """Return the parameters of one mapping: those of its mapper among COLMAP's."""
    chosen = dict(step("map_images")(wildcards))
    per_mapper = {"options": chosen.pop("colmap"), "attempts": chosen.pop("attempts")}
    return {**chosen, **{key: value[wildcards.mapper] for key, value in per_mapper.items()}}


def click_parameters(wildcards):
    """Return what is said of clicks, which all calibrations share."""
    chosen = step("adjust_network")(wildcards)
    return {key: chosen[key] for key in ("click_sigma_px", "click_bias_px", "click_loss")}


def ties_file(wildcards):
    """Return the ties that a calibration rests on; only the paper's own row is mapped incrementally."""
    name, n_images, offset = re.fullmatch(
        r"(.+?)-(n\d+)(?:-(o\d+))?", wildcards.calibration
    ).groups()
    mapper = "incremental" if name == "paper" else "global"
    return f"results/{wildcards.session}/sfm/{mapper}-{n_images}-{offset or 'o0'}/ties.npz"


def board_source(wildcards):
    """Return what a camera's pictures of a chessboard come from: the folder that is simulated, or the pictures."""
    session = session_of(wildcards)
    if session.films_boards():
        return f"results/virtual/{session.name}/boards"
    return inside(session.cameras[wildcards.camera].chessboard["images"])


def lens_files(wildcards):
    """Return the lens of each fixed camera where the calibration needs it."""
    if not wildcards.calibration.endswith("-board"):
        return []
    return each_fixed("results/{session}/calibration/lens/{camera}.toml")(wildcards)


def every_lens_file(wildcards):
    """Return the lens of each fixed camera where all have pictures of a chessboard."""
    session = session_of(wildcards)
    if not all(camera.chessboard for camera in session.cameras.values()):
        return []
    return each_fixed("results/{session}/calibration/lens/{camera}.toml")(wildcards)


def evaluation_parameters(wildcards, labels, keys):
    """Return what an evaluation needs to know: how clicks are drawn, and what its rows are labelled with."""
    session = session_of(wildcards)
    draws = step("evaluate_calibration")(wildcards)
    adjusting = step("adjust_network")(wildcards)
    made = {key: session.virtual[key] for key in ("preset", "layout")}
    made["width_px"] = session.virtual["size_px"][0]
    varied = {key: value for key, value in session.condition.items() if key != "size_px"}
    return {
        "labels": {"session": session.name, **made, **varied, **labels},
        "clicks": {
            "n_draws": draws["n_draws"],
            "seed": draws["seed"],
            "preset": session.virtual["preset"],
            "session": session.name,
        },
        "sets": draws["sets"],
        **{key: adjusting[key] for key in keys},
    }


def racket_models(name):
    """Return the structures from motion, several choices of as many images, that a racket is measured with."""
    count = STUDY.parameters["evaluate_racket"]["n_images"]
    variants = STUDY.sessions[name].variants()
    return [variant for variant in variants if variant.startswith(f"global-n{count}-")]


def racket_sessions():
    """Return the names of the virtual sessions in which a racket is measured: those with such models."""
    wanted = STUDY.parameters["evaluate_racket"]["sessions"]
    return [name for name in wanted if name in STUDY.sessions and racket_models(name)]


def racket_parameters(wildcards):
    """Return what is known of the clicks of court and racket."""
    keys = ["click_sigma_px", "click_bias_px", "click_loss"]
    settings = evaluation_parameters(wildcards, labels={}, keys=keys)
    step = STUDY.parameters["evaluate_racket"]
    clicks = {**settings["clicks"], "n_draws": step["n_runs"]}
    del settings["sets"]
    return {**settings, "clicks": clicks, "length_m": step["length_m"], "tips_px": step["tips_px"]}


def drawn_conditions():
    """Return the conditions that have a figure of their own: those that vary more than seeds, by its name."""
    conditions = STUDY.parameters["conditions"]
    return {
        name.replace("-", "_"): name
        for name in STUDY.parameters["variations"]
        if not all(key.endswith("seed") for key in conditions[name]["vary"])
    }


def varied_axes(name):
    """Return the axes of a condition's figure: the settings that take several values, and the number of images."""
    vary = STUDY.parameters["conditions"][name]["vary"]
    keys = [key for key, values in vary.items() if len(values) > 1 and not key.endswith("seed")]
    keys = ["width_px" if key == "size_px" else key for key in keys]
    counts = {
        count
        for session in STUDY.sessions.values()
        if session.condition.get("condition") == name
        for count in session.parameters["sweep"]["n_images"]
    }
    return {
        "x": keys[0],
        "group": keys[1] if len(keys) > 1 else None,
        "n_bridging": counts.pop() if len(counts) == 1 else None,
    }
