"""Results that the session files no longer ask for: found on the disk, by session."""

from dataclasses import replace
from pathlib import Path

from courtside.study import paths
from courtside.study.provenance import run
from courtside.study.targets import devices, remains, takes, together


def test_folders_of_takes_that_are_not_measured_are_found(study, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    session = study.sessions["players-tiny"]
    folder, compared = "results/players-tiny/takes", "results/players-tiny/evaluation/takes"
    for take in (*session.takes, "old", "hers"):
        (Path(folder) / take).mkdir(parents=True)
    for take in (*session.takes, "hers"):
        (Path(compared) / take).mkdir(parents=True)
    session = replace(session, withheld={"hers": session.takes["shot"]})
    expected = {f"{folder}/hers": True, f"{folder}/old": False, f"{compared}/hers": True}
    assert remains.of_takes(session) == expected
    assert remains.of_takes(study.sessions["plain-tiny"]) == {}


def test_files_of_persons_whom_a_take_no_longer_has_are_found(study, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    session = study.sessions["walk-4cams-tiny"]
    take = "results/walk-4cams-tiny/takes/balancing"
    for name in ("p1.trc", "old.trc", "old.osim", "npz", "covariance.csv"):
        path = Path(take) / "pose3d" / "file" / "all-robust" / f"blazepose-full.{name}"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    (Path(take) / "motion" / "file").mkdir(parents=True)
    (Path(take) / "motion" / "file" / "blazepose-full.older.glb").touch()
    assert remains.of_nobody(session) == {take: ["old", "older"]}


def test_files_of_cameras_that_a_take_no_longer_has_are_found(study, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    session = study.sessions["walk-4cams-tiny"]
    take = Path("results/walk-4cams-tiny/takes/balancing")
    videos, keypoints = take / "videos/file/all-robust", take / "pose2d/blazepose-full"
    for folder in (videos, keypoints):
        folder.mkdir(parents=True)
    for camera in ("cam01", "left"):
        (videos / f"blazepose-full.{camera}.mp4").touch()
    (keypoints / "right.npz").touch()
    (keypoints / ".snakemake_timestamp").touch()
    assert remains.of_no_camera(session) == {take.as_posix(): ["left", "right"]}


def test_files_of_devices_that_a_take_no_longer_has_are_found(study, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    session = study.sessions["single-view-tiny"]
    take = Path("results/single-view-tiny/takes/claps")
    own = [p for p in devices.every_device_export(study) if p.startswith(f"{take.as_posix()}/")]
    own += [path for path in devices.every_source_angle(study) if path.startswith(f"{take}/")]
    own += [f"{take}/devices/{name}" for name in ("d415.frames.csv", "cameras.blazepose-full.npz")]
    own += [f"{take}/devices/mocopi-corrected.blazepose-full.bvh", f"{take}/devices/.snakemake_x.y"]
    left = [
        f"{take}/devices/suit.trc",
        f"{take}/devices/suit-corrected.blazepose-full.bvh",
        f"{take}/motion/devices/old-depth/blazepose-full.angles.csv",
        f"{take}/pose3d_ik/devices/old-depth/blazepose-full.p1.mot",
    ]
    assert len(own) > 10
    for path in map(Path, own + left):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    gone = ["old-depth", "suit", "suit-corrected"]
    assert remains.of_no_camera(session) == {take.as_posix(): gone}
    assert remains.of_records(study, own + left) == left


def test_folders_of_sessions_without_a_file_are_found(study, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("players-tiny", "of-another-study", "renamed"):
        (tmp_path / "results" / name / "takes").mkdir(parents=True)
    (tmp_path / "results" / "virtual" / "players-tiny").mkdir(parents=True)
    study = replace(study, folder=Path("config"))
    file = tmp_path / "config" / paths.SESSION_YAML.format(session="of-another-study")
    file.parent.mkdir(parents=True)
    file.touch()
    assert remains.of_no_session(study) == ["results/renamed"]
    (line,) = run.remaining(study)
    assert line.startswith("results/renamed belongs to no session of config/sessions: delete it")
    assert run.left_out(study)[0] == line


def test_tables_of_compared_networks_that_nobody_agrees_to_are_found(study, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    session = study.sessions["walk-4cams-tiny"]
    networks = {"sessions": [session.name], "networks": session.parameters["models"][:1]}
    networks["takes"] = None
    parameters = {**study.parameters, "compare_networks": networks}
    only = {session.name: replace(session, takes={}, withheld=session.takes)}
    study = replace(study, parameters=parameters, sessions=only)
    assert not together.compared_takes(study)
    tables = [paths.NETWORK_PAIRS, paths.NETWORK_AGREEMENT]
    for path in map(Path, tables):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    assert remains.without_consent(study) == {session.name: sorted(tables)}


def test_records_of_what_nobody_asks_for_are_found_whether_here_or_deleted(study, monkeypatch):
    session = study.sessions["walk-4cams-tiny"]
    only = {name: replace(one, consent=("analysis",)) for name, one in session.subjects.items()}
    sessions = {
        "walk-4cams-tiny": replace(session, subjects=only),
        "plain-tiny": replace(study.sessions["plain-tiny"], takes={}),
        "players-tiny": study.sessions["players-tiny"],
    }
    study = replace(study, sessions=sessions)
    take = "results/walk-4cams-tiny/takes/balancing"
    way = "file/all-robust/blazepose-full"
    left = [
        "results/walk-4cams-tiny/takes/old/quality.csv",
        f"{take}/pose3d/{way}.older.trc",
        f"{take}/motion/{way}.older.glb",
        f"{take}/videos/{way}.cam01.mp4",
        f"{take}/shake/old.csv",
        f"{take}/pages/people.html",
        f"{take}/pose2sim/{way}/pose-3d/take.trc",
        "results/walk-4cams-tiny/evaluation/takes/old/round_trip/file.blazepose-full.csv",
        "results/plain-tiny/pages/quality.html",
        "results/report.html",
    ]
    kept = [
        f"{take}/motion/{way}.angles.csv",
        f"{take}/quality.csv",
        f"{take}/shake/cam01.csv",
        "results/walk-4cams-tiny/evaluation/takes/balancing/round_trip/file.blazepose-full.csv",
        "results/players-tiny/pages/quality.html",
        "results/another/takes/old/quality.csv",
        "results/figures/study.csv",
    ]
    assert remains.of_records(study, [*kept, *left]) == left


def test_only_files_of_persons_who_refuse_are_found(study, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    made = takes.every_export(study)
    for path in map(Path, made):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    session = study.sessions["walk-4cams-tiny"]
    assert not any(name != "walk-4cams-tiny" for name in remains.without_consent(study))
    person = next(iter(session.subjects))
    refused = {person: replace(session.subjects[person], consent=("analysis", "pictures"))}
    other = replace(session, subjects={**session.subjects, **refused})
    study = replace(study, sessions={**study.sessions, "walk-4cams-tiny": other})
    of_session = [path for path in made if path.startswith("results/walk-4cams-tiny/")]
    found = remains.without_consent(study)["walk-4cams-tiny"]
    assert found == sorted(path for path in of_session if f".{person}." in path)


def test_exports_of_devices_that_a_take_no_longer_has_are_found(study, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    session = study.sessions["walk-4cams-tiny"]
    assert not session.takes["balancing"].devices
    kept = "results/walk-4cams-tiny/takes/balancing/devices/mocopi.trc"
    Path(kept).parent.mkdir(parents=True)
    Path(kept).touch()

    def listed(*consent):
        subjects = {name: replace(p, consent=consent) for name, p in session.subjects.items()}
        only = {session.name: replace(session, subjects=subjects)}
        return remains.without_consent(replace(study, sessions=only)).get(session.name, [])

    assert listed("analysis", "export") == []
    assert listed("analysis", "pictures") == [kept]


def test_files_asked_for_by_name_and_of_earlier_studies_are_found(study, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    session = study.sessions["single-view-tiny"]
    take, way = Path("results/single-view-tiny/takes/claps"), "known/two-dlt/older-network"
    pictured = [f"figures/badminton_fig09.{way.replace('/', '.')}.png", f"videos/{way}.left.mp4"]
    exported = [
        f"pose2sim/{way}/pose-3d/claps.trc",
        f"pose3d/{way}.p1.csv",
        f"pose3d_ik/{way}.p1.mot",
        "devices/mocopi.csv",
        "devices/d415-depth.older-network.bvh",
    ]
    allowed = [
        f"figures/skeletons.{way.replace('/', '.')}.png",
        f"pose3d/{way}.p2.csv",
        f"pose3d/{way}.npz",
        f"pose2sim/{way}/.snakemake_timestamp",
        "devices/d415.frames.csv",
        "devices/mocopi-corrected.blazepose-full.bvh",
        "videos/readme.txt",
    ]
    for path in (take / one for one in (*pictured, *exported, *allowed)):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()

    def listed(*consent):
        subjects = {"p1": replace(session.subjects["p1"], consent=consent)}
        only = {session.name: replace(session, subjects=subjects)}
        return remains.without_consent(replace(study, sessions=only)).get(session.name, [])

    def below(*parts):
        return sorted((take / one).as_posix() for one in parts)

    assert listed("analysis", "export", "pictures") == []
    assert listed("analysis", "export") == below(*pictured)
    assert listed("analysis", "pictures") == below(*exported)
    assert listed("analysis") == below(*pictured, *exported)


def test_static_pictures_of_somebody_who_withdrew_are_found(study, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    session, folder = study.sessions["walk-4cams-tiny"], Path("results/walk-4cams-tiny")
    made = [folder / "static" / f"{camera}.png" for camera in ("cam01", "cam02")]
    made.append(folder / "pages" / "clicking.html")
    for path in made:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    cam01 = replace(session.cameras["cam01"], static=None)

    def listed(**changes):
        only = {session.name: replace(session, **changes)}
        return remains.without_consent(replace(study, sessions=only)).get(session.name, [])

    cameras = {**session.cameras, "cam01": cam01}
    assert listed(cameras=cameras) == []
    expected = [f"{folder}/pages/clicking.html", f"{folder}/static/cam01.png"]
    assert listed(cameras=cameras, takes={}, withheld=session.takes) == expected


def test_pages_of_a_session_without_any_take_left_are_found(study, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    session = study.sessions["walk-4cams-tiny"]
    page, table = "results/walk-4cams-tiny/pages/quality.html", "results/figures/study.csv"
    overlay = "results/walk-4cams-tiny/takes/balancing/pages/people.html"
    for path in map(Path, (page, table, overlay)):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    refused = {"takes": {}, "withheld": session.takes}
    gone = replace(study, sessions={session.name: replace(session, **refused)})
    assert remains.without_consent(gone) == {session.name: sorted([page, table])}
    kept = {**study.sessions, session.name: replace(session, **refused)}  # others are tabulated
    assert remains.without_consent(replace(study, sessions=kept)) == {session.name: [page]}
    other = replace(session, **refused | {"takes": {"again": session.takes["balancing"]}})
    assert remains.without_consent(replace(study, sessions={session.name: other})) == {}
