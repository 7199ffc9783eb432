"""Input functions of the report: what the study has made of each session and take, and every figure of it.

Inputs: the checked configuration. Outputs: none. Steps: files and words by session, take, figure and table.
"""

REPORT = "results/report.html"
REPORTED_STEPS = [
    "extract_features",
    "match_images",
    "adjust_network",
    "detect_pose",
    "synchronise_cameras",
    "triangulate",
    "filter_motion",
    "measure_kinematics",
]
REPORTED_TABLES = {
    "calibration.csv": (
        "Calibration",
        "Errors of the fixed cameras against the truth of simulated sessions, by method, number of clicks and "
        "number of pictures of the walk.",
    ),
    "players.csv": (
        "Players",
        "Errors of joints, paths and clocks against the truth of simulated takes, by cameras and rule.",
    ),
}


def reported_study():
    """Return all that the report is made of, as plain values."""
    sessions = [session for session in STUDY.sessions.values() if not session.condition]
    wanted = [
        path for path in every_study_figure() + every_players_figure() if path.endswith(".csv")
    ]
    return {
        "title": "Report of the study",
        "parameters": {name: STUDY.parameters[name] for name in REPORTED_STEPS},
        "sessions": [reported_session(session) for session in sessions],
        "figures": [reported_figure(path) for path in report_pictures()],
        "tables": [
            {"file": path, "title": name, "words": words, "link": from_report(path)}
            for path in wanted
            if Path(path).name in REPORTED_TABLES and Path(path).parent.name == "figures"
            for name, words in [REPORTED_TABLES[Path(path).name]]
        ],
    }


def report_files(study):
    """Return every file below results/ and every caption that is named in what the report is made of."""
    if isinstance(study, dict):
        study = [value for key, value in study.items() if key not in ("links", "link", "params")]
    if isinstance(study, list | tuple):
        return sorted({path for item in study for path in report_files(item)})
    named = isinstance(study, str) and (study.startswith("results/") or study.endswith(".rst"))
    return [study] if named else []


def from_report(path):
    """Return a path as seen from the folder of the report."""
    return str(Path(path).relative_to(Path(REPORT).parent))


def reported_session(session):
    """Return what the report needs to know of a session."""
    ways, folder = session.calibrations(), f"results/{session.name}"
    way = next(iter(session.take_calibrations() or ways), None)
    mapped = bool(session.walks) and any(kind.startswith(("sfm", "sim3")) for kind in ways)
    n_images = re.search(r"-n(\d+)", way or "")
    n_images = int(n_images.group(1)) if n_images else session.parameters["sweep"]["n_images"][0]
    files = {"quality": {kind: f"{folder}/calibration/{kind}/quality.json" for kind in ways}}
    if mapped:
        files["model"] = f"{folder}/sfm/global-n{n_images}-o0/summary.json"
        files["static"] = [f"{folder}/static/{camera}.csv" for camera in session.cameras]
    limits = session.parameters["extract_static"]
    return {
        "name": session.name,
        "description": session.description,
        "virtual": bool(session.virtual),
        "way": way,
        "mapper": "global" if mapped else None,
        "n_images": n_images,
        "fusion": next(iter(session.fusions()), None),
        "model": session.parameters["models"][0],
        "overrides": reported_overrides(session),
        "withheld": consent.left_out(session),
        "limits": {key: limits[key] for key in ("max_shift_px", "max_zoom_percent")},
        "files": files,
        "takes": [reported_take(session, take) for take in session.takes.values()],
    }


def reported_overrides(session):
    """Return the keys of the reported steps in which a session differs from the study."""
    found = {}
    for name in REPORTED_STEPS:
        own, usual = session.parameters[name], STUDY.parameters[name]
        differ = {key: value for key, value in own.items() if usual.get(key) != value}
        found |= {name: differ} if differ else {}
    return found


def reported_take(session, take):
    """Return what the report needs to know of a take: measured with the first network and the first way."""
    folder, model = f"results/{session.name}/takes/{take.name}", session.parameters["models"][0]
    files, links = {}, []
    fusion = next(iter(session.fusions()), None)
    if take.videos and session.take_calibrations() and fusion:
        way = f"{session.take_calibrations()[0]}/{fusion}/{model}"
        dotted = ".".join(Path(way).parts)
        kinematics = f"{folder}/kinematics/{way}"
        files = {
            "summary": f"{kinematics}.summary.csv",
            "frames": f"{kinematics}.frames.csv",
            "pose3d": f"{folder}/pose3d/{way}.npz",
            "sync": f"{folder}/sync/{session.take_calibrations()[0]}/cameras.{model}.json",
        }
        files |= {"shake": f"{folder}/figures/shake.{dotted}.txt"} if take.steady else {}
        checked = [path for path in every_check() if path.startswith(f"{folder}/movement/")]
        files |= {"movement": checked}
        links = [(f"{kinematics}.{name}.csv", f"{name} (CSV)") for name in ("summary", "frames")]
        if session.virtual:
            truth = f"results/{session.name}/evaluation/takes/{take.name}"
            short = f"{session.take_calibrations()[0]}.{model}"
            files |= {
                "errors": f"{truth}/errors/{short}.csv",
                "kinematics": f"{truth}/kinematics/{way}.csv",
            }
    files |= {"checks": f"{folder}/sync/devices.{model}.checks.csv"} if take.devices else {}
    links += [(path, "3D viewer") for path in every_viewer() if path.startswith(f"{folder}/pages/")]
    links += [
        (path, f"video {Path(path).stem.rpartition('.')[2]}")
        for path in every_overlay_video()
        if path.startswith(f"{folder}/videos/")
    ]
    return {
        "name": take.name,
        "fusion": fusion,
        "files": files,
        "links": [(from_report(path), words) for path, words in links],
    }
