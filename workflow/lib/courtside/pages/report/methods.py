"""The methods paragraph of the report, from the configuration that was run, with the sources it rests on."""

from courtside.pages.page import text

SOURCES = {
    "paper": "H. Shishido, I. Kitahara. Camera calibration for markerless 3D pose estimation and "
    "practice in "
    "badminton video processing, 2020 (in Japanese).",
    "thesis": "Homma. Three-dimensional measurement of full-body motion from a single viewpoint, "
    "thesis, "
    "National Institute of Technology, Nagaoka College, 2023 (in Japanese).",
    "sift": "D. G. Lowe. Distinctive image features from scale-invariant keypoints. IJCV 60, 2004.",
    "colmap": "J. L. Schönberger, J.-M. Frahm. Structure-from-motion revisited. CVPR 2016.",
    "glomap": "L. Pan, D. Baráth, M. Pollefeys, J. L. Schönberger. Global structure-from-motion "
    "revisited. "
    "ECCV 2024.",
    "blazepose": "V. Bazarevsky and others. BlazePose: on-device real-time body pose tracking. "
    "CVPR workshop "
    "on computer vision for augmented and virtual reality, 2020.",
    "hartley": "R. Hartley, A. Zisserman. Multiple view geometry in computer vision, 2nd "
    "edition, 2004.",
    "winter": "D. A. Winter. Biomechanics and motor control of human movement, 4th edition, 2009.",
    "leva": "P. de Leva. Adjustments to Zatsiorsky-Seluyanov's segment inertia parameters. "
    "Journal of "
    "Biomechanics 29, 1996.",
}
WAYS = {
    "sfm": "adjusted together: structure from motion over the pictures of a walk, and the "
    "clicked court points",
    "sim3": "structure from motion over the pictures of a walk, laid onto the court points by "
    "one similarity",
    "paper": "structure from motion, scaled and aligned as Shishido & Kitahara (2020, eq 2 to 5) "
    "do",
    "known": "from clicked court points alone",
    "dlt": "from clicked court points alone, linearly (DLT)",
    "file": "taken from a calibration made elsewhere",
}
RULES = {
    "robust": "views are weighed, and those that contradict the others fade out",
    "dlt": "all views count as they are (DLT)",
    "unsteady": "views are weighed, and the shake of cameras is left in",
}


def paragraphs(parameters, sessions):
    """Return the methods as HTML.

    Parameters
    ----------
    parameters : dict
        The study's steps as configured: `match_images`, `adjust_network`, `triangulate`, `filter_motion` ...
    sessions : list of dict
        Of the report: `name`, `way` (calibration of its takes), `mapper`, `n_images`, `fusion`, `model`,
        `virtual`, `overrides` ({step: {key: value}}), `takes`.

    Returns
    -------
    html : str
        Paragraphs, then the list of sources that they cite.
    """
    cited = ["paper"]
    parts = [_recorded(sessions), _cameras(parameters, sessions, cited)]
    if any(take["files"].get("pose3d") for session in sessions for take in session["takes"]):
        parts += [_skeletons(parameters, sessions, cited), _motion(parameters, cited)]
    if any(take["files"].get("checks") for session in sessions for take in session["takes"]):
        cited.append("thesis")
        parts.append(
            "Devices of their own (inertial suit, depth camera, single video) were brought onto "
            "one clock "
            "by claps and by the motion itself, and into one body frame by a T-pose (Homma 2023)."
        )
    parts += _overridden(sessions)
    listed = "".join(f"<li>{text(SOURCES[name])}</li>" for name in SOURCES if name in cited)
    body = "".join(f"<p>{part}</p>" for part in parts)
    return f"{body}<h3>Sources</h3><ul>{listed}</ul>"


def _recorded(sessions):
    made = [session["name"] for session in sessions if session["virtual"]]
    real = [session["name"] for session in sessions if not session["virtual"]]
    said = f"Recordings of real people: {_names(real)}. " if real else ""
    said += (
        f"Simulated, ray-cast with exact truth, and read from their video files like the others: "
        f"{_names(made)}. "
        if made
        else ""
    )
    return said + "Errors in cm and mm against a truth are known of simulated sessions only."


def _cameras(parameters, sessions, cited):
    said, adjust = [], parameters["adjust_network"]
    for way in dict.fromkeys(session["way"] for session in sessions if session["way"]):
        named = _names([session["name"] for session in sessions if session["way"] == way])
        kind = next((kind for kind in WAYS if way.startswith(kind)), "file")
        said.append(f"Cameras of {named} were {WAYS[kind]} (<code>{text(way)}</code>).")
    mapped = {(s["mapper"], s["n_images"]) for s in sessions if s["mapper"]}
    for mapper, count in sorted(mapped):
        cited += ["sift", "colmap"] + ["glomap"] * (mapper == "global")
        by = (
            "global, Pan et al. 2024"
            if mapper == "global"
            else "incremental, Schönberger & Frahm 2016"
        )
        said.append(
            f"The model of the hall was mapped by COLMAP ({by}) from {count} pictures of the walk "
            f"beside those "
            f"of the fixed cameras: SIFT features (Lowe 2004), at most "
            f"{parameters['extract_features']['max_features']} in a picture, matched up to a "
            f"ratio of "
            f"{parameters['match_images']['max_ratio']}."
        )
    if mapped:
        said.append(
            f"In the adjustment, a click counts as {adjust['click_sigma_px']} px exact per axis "
            f"with "
            f"{adjust['click_bias_px']} px in common (at 3840 px width), a tie between pictures as "
            f"{adjust['tie_sigma']} robust standard deviations of the model's own residuals."
        )
    return " ".join(said) or "No camera was calibrated."


def _skeletons(parameters, sessions, cited):
    models = list(dict.fromkeys(session["model"] for session in sessions))
    cited += ["hartley"] + ["blazepose"] * any(name.startswith("blazepose") for name in models)
    fusions = list(dict.fromkeys(session["fusion"] for session in sessions if session["fusion"]))
    step, rules = parameters["triangulate"], []
    for fusion in fusions:
        rule = RULES.get(fusion.rpartition("-")[2], "half of the body from two cameras each")
        rules.append(f"<code>{text(fusion)}</code>: {rule}")
    blaze = " (Bazarevsky et al. 2020)" if "blazepose" in cited else ""
    sides = (
        "Left and right were decided over time by all views together." if step["fix_sides"] else ""
    )
    return (
        f"Joints were found in every picture by the network {_names(models)}{blaze}; a region "
        f"counts as a "
        f"person from a confidence of {parameters['detect_pose']['min_presence']} on. The "
        f"cameras' clocks "
        f"were found from the motion of the people, offsets up to "
        f"{parameters['synchronise_cameras']['max_offset_s']} s, unless the session says that "
        f"they share one. "
        f"Joints seen by {step['min_views']} cameras or more were triangulated (Hartley & "
        f"Zisserman 2004; "
        f"{'; '.join(rules)}): keypoints below a confidence of {step['min_score']} do not count, "
        f"a view within "
        f"{step['max_error_px']} px of the projected point is accepted, and one {step['fade_px']} "
        f"px off has a "
        f"quarter of its weight. {sides}"
    )


def _motion(parameters, cited):
    cited += ["winter", "leva"]
    smooth, measured = parameters["filter_motion"], parameters["measure_kinematics"]
    return (
        f"Gaps up to {smooth['max_gap_s']} s were filled, and skeletons filtered by a Butterworth "
        f"filter "
        f"without delay, effective order {smooth['order']}, -3 dB at {_cut(smooth['cutoff_hz'])} "
        f"(Winter 2009). "
        f"Speeds are derivatives of paths filtered at {_cut(measured['cutoff_hz'])}; distances "
        f"are lengths of "
        f"paths filtered at {measured['distance_cutoff_hz']} Hz, less 0.7 (&plusmn; 0.4) of what "
        f"the model of "
        f"their noise adds. The centre of mass follows de Leva (1996). Error bars hold nine "
        f"errors in ten, as "
        f"far as the disagreement of the views and the calibration's own residuals show them; an "
        f"error that all "
        f"views share, such as a hip that the network always places too high, is in no error bar."
    )


def _cut(cutoffs):
    if not isinstance(cutoffs, dict):
        return f"{text(cutoffs)} Hz"
    return ", ".join(f"{text(value)} Hz ({text(group)})" for group, value in cutoffs.items())


def _overridden(sessions):
    found = {}
    for session in sessions:
        for step, value in session["overrides"].items():
            found.setdefault(f"{step}: {_plain(value)}", []).append(session["name"])
    said = [f"<code>{text(what)}</code> in {_names(names)}" for what, names in found.items()]
    return [f"Where sessions differ from this: {'; '.join(said)}."] if said else []


def _plain(value):
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {_plain(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_plain(item) for item in value) + "]"
    return str(value)


def _names(names):
    *most, last = [text(name) for name in names]
    return f"{', '.join(most)} and {last}" if most else last
