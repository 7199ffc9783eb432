"""Input functions of pages, and what the study makes of them.

Inputs: the checked configuration. Outputs: none. Steps: which layers a viewer shows; lists of files.
"""


def viewer_layers(wildcards):
    """Return the layers of a take's viewer: the fixed cameras' skeletons, raw and made, then each device's."""
    session, take = session_of(wildcards), take_of(wildcards)
    layers = fused_layers(wildcards) if take.videos and session.take_calibrations() else []
    for source, (file, skeleton, _) in sources_of(wildcards).items() if take.devices else ():
        if source != "cameras":
            layers.append(
                {
                    "file": file,
                    "name": source,
                    "of": skeleton,
                    "shown": not layers,
                    "person": worn_by(wildcards),
                    "source": source.removesuffix("-corrected"),
                    "placed": bool(layers),
                }
            )
    known = list(dict.fromkeys(layer["of"] for layer in layers))
    return [{**layer, "skeleton": known.index(layer["of"])} for layer in layers]


def fused_layers(wildcards):
    """Return the layers of the fixed cameras: the last stage shown, the others to be switched on."""
    session = session_of(wildcards)
    way = f"{session.take_calibrations()[0]}/{session.fusions()[0]}/{wildcards.model}"
    stages = stages_of(wildcards.model)
    words = {"pose3d": "raw", "pose3d_filtered": "filtered", "pose3d_corrected": "corrected"}
    return [
        {
            "file": f"results/{wildcards.session}/takes/{wildcards.take}/{stage}/{way}.npz",
            "name": words[stage],
            "of": skeleton_file(wildcards).stem,
            "shown": stage == stages[-1],
        }
        for stage in reversed(stages)
    ]


def layer_skeletons(wildcards):
    """Return the names of the skeletons of a viewer's layers, each once, in their order."""
    return list(dict.fromkeys(layer["of"] for layer in viewer_layers(wildcards)))


def viewed_cameras(wildcards):
    """Return the cameras that a viewer draws; none of a take of devices alone."""
    session = session_of(wildcards)
    if not (take_of(wildcards).videos and session.take_calibrations()):
        return []
    return f"results/{session.name}/calibration/{session.take_calibrations()[0]}/cameras.toml"


def viewed_court(wildcards):
    """Return the court that a viewer draws, where the skeletons stand on one."""
    court = court_file(session_of(wildcards))
    return court if court and viewed_cameras(wildcards) else []


def device_clocks(wildcards):
    """Return the clocks of a take's devices, where it has any."""
    if not take_of(wildcards).devices:
        return []
    return f"results/{wildcards.session}/takes/{wildcards.take}/sync/devices.{wildcards.model}.json"


def every_viewer():
    """Return the viewers of all takes, with the first network."""
    return [
        f"results/{session.name}/takes/{take.name}/pages/viewer.{session.parameters['models'][0]}.html"
        for session in STUDY.sessions.values()
        for take in session.takes.values()
        if take.devices or (take.videos and session.take_calibrations())
    ]


def proposals_file(wildcards):
    """Return the proposed court points of a session whose cameras are found: some points were clicked before."""
    session = session_of(wildcards)
    ways = [way for way in session.calibrations() if way.startswith("sfm-")]
    if not (session.court_points and ways):
        return []
    return f"results/{session.name}/calibration/{ways[0]}/proposals.csv"


def clicking_settings(wildcards):
    """Return what the page for clicking says and saves."""
    session = session_of(wildcards)
    path = session.unclicked or session.court_points or f"data/{session.name}/court_points.csv"
    said = {"session": session.name, "names": list(session.cameras), "jpeg_quality": None}
    return {**said, "targets": {"court_points.csv": path}}


def every_clicking_page():
    """Return the pages for clicking the court points of sessions that wait for them."""
    return [f"results/{s.name}/pages/clicking.html" for s in STUDY.sessions.values() if s.unclicked]


def waiting_for_clicks():
    """Return one line for each session whose court points nobody has clicked yet."""
    return [
        f"{s.name}: court points are not clicked yet: open results/{s.name}/pages/clicking.html in a browser, "
        f"click them, save them as {s.unclicked}, and run snakemake again"
        for s in STUDY.sessions.values()
        if s.unclicked
    ]


def overlay_parameters(wildcards):
    """Return how videos with skeletons are written."""
    step = STUDY.parameters["export_overlay_video"]
    return {key: value for key, value in step.items() if key != "takes"}


def every_overlay_video():
    """Return the videos with skeletons that the study asks for."""
    return [
        f"{path}.{camera}.mp4"
        for session in STUDY.sessions.values()
        for take in session.takes.values()
        if f"{session.name}/{take.name}" in STUDY.parameters["export_overlay_video"]["takes"]
        if agree(session, take, "pictures")
        for camera in take.videos
        for way, model in product(session.take_calibrations(), session.parameters["models"][:1])
        for path in [
            f"results/{session.name}/takes/{take.name}/videos/{way}/{session.fusions()[0]}/{model}"
        ]
    ]


def planned_court(wildcards):
    """Return the court of a planned session."""
    return CONFIG / "courts" / f"{PLANS[wildcards.plan].court}.yaml"


def plan_figure(part):
    """Return the three files of a figure of a planned session, by keys that name the part."""
    category, labels = ("planning", "{plan}"), {"figure": f"plan_{part}"}
    files = drawn(f"results/plans/{{plan}}/{part}", f"plan_{part}", category, labels)
    return {f"{part}_{form}": path for form, path in files.items()}


def every_plan():
    """Return the figures of all planned sessions."""
    stems = [f"results/plans/{plan}/{part}" for plan in PLANS for part in ("growth", "map")]
    return [f"{stem}.{suffix}" for stem in stems for suffix in FORMATS]
