"""What reruns when something changes: for each cause, the rules and how many of their jobs.

The jobs are counted by hand.

Beside test_workflow.py, which has the parameters, the modules of the library and one more N of the
sweep. The counts follow from the rules and from the tiny study, which has `walk-4cams-tiny` (real,
four cameras, three with a static recording, one take fused in two ways), `plain-tiny` (calibration,
two mappers, one N), `players-tiny` (two takes of three cameras, fused in five ways, one of them
drawn) and `single-view-tiny` (a depth camera and an inertial suit).
"""

import os
import shutil
import subprocess
import sys
from contextlib import ExitStack, contextmanager
from importlib import metadata
from pathlib import Path

import cv2
import numpy as np
import pytest
import yaml

from courtside.study.execution import digest
from smoke.snakemake_runs import FOLDER, ROOT, TINY, changed, copy_repository, edited, planned, run

RESULTS = FOLDER / "results"
DEMO = RESULTS / "external/pose2sim/Pose2Sim/Demo_SinglePerson"
NETWORK = RESULTS / "networks/blazepose-full/landmarks.onnx"
SUIT = RESULTS / "virtual/single-view-tiny/takes/claps/mocopi.bvh"
DEPTH = RESULTS / "virtual/single-view-tiny/takes/claps/d415.bag"
CLICKS = RESULTS / "virtual/plain-tiny/court_points.csv"
SESSIONS = Path("config/sessions")
PLATES = {"draw_wrist_arcs": 1, "draw_skeleton_plates": 1, "draw_source_errors": 1}


def together(*parts):
    """Return the sum of several counts of jobs."""
    rules = sorted({rule for part in parts for rule in part})
    return {
        rule: (max if rule in OF_ALL_TAKES else sum)(part.get(rule, 0) for part in parts)
        for rule in rules
    }


OF_ALL_TAKES = {"tabulate_study": 1, "compare_sessions": 1}  # the second reads the first's table


# The real take once a camera's keypoints are new. Every way to fuse views reads the keypoints of
# all cameras, and so does whatever shows them; the static pictures, and what was measured in them,
# do not.
REAL_FUSED = {
    "synchronise_cameras": 1,
    "associate_people": 1,
    "name_people": 1,
    "build_people_page": 1,
    "check_cameras": 1,
    "triangulate": 2,  # all-robust, two-dlt
    "compare_views": 1,
    "filter_motion": 1,  # two-dlt is only compared, raw
    "correct_joints": 1,
    "fit_skeleton": 1,
    "export_take": 3,  # one person, three stages
    "export_motion": 1,
    "measure_kinematics": 1,
    "find_contacts": 1,
    "judge_take": 1,
    "build_quality_page": 1,
    **OF_ALL_TAKES,
    "build_viewer": 1,
    "export_overlay_video": 4,  # one for each camera, all with the same skeleton
    **{
        f"draw_{name}": 1
        for name in ("overlay", "skeletons", "reprojection", "visibility", "kinematics", "footwork")
    },
}
# The virtual players once keypoints are new: two takes, and the way `two-robust` of table 1 in one
# of them.
PLAYERS_FUSED = {
    "steady_keypoints": 3,  # cameras of the take that is steadied
    "synchronise_cameras": 2,
    "associate_people": 2,
    "name_people": 2,
    "triangulate": 2 * 5 + 1,
    "filter_motion": 2 * 5,
    "correct_joints": 2 * 5,
    "fit_skeleton": 2,
    "measure_kinematics": 2 + 4,  # the exported way in both takes, the others where they are drawn
    "find_contacts": 2,
    "evaluate_contacts": 2,
    **dict.fromkeys(("find_strokes", "evaluate_strokes", "draw_rally", "draw_strokes"), 2),
    "judge_take": 2,
    "evaluate_kinematics": 2 + 4,
    "evaluate_take": 2,
    "evaluate_angles": 2,
    "evaluate_reliability": 2,
    "evaluate_fusions": 2 * 2,  # raw and corrected
    "evaluate_round_trip": 1,
    "evaluate_detection": 1,  # fig 5 and the figure of networks are of one take
    "evaluate_networks": 1,
    "draw_networks": 1,
    "build_viewer": 2,
    "build_quality_page": 1,
    **OF_ALL_TAKES,
    "tabulate_players": 1,
    "tabulate_angles": 1,
    "draw_reliability": 1,
    "draw_three_cameras": 1,
    "draw_shake": 1,  # of the take that is steadied, over its skeleton
    **{f"draw_badminton_{name}": 1 for name in ("fig05", "fig09", "fig10", "fig11", "tab01")},
}
# The take of devices once any of its sources is new: clocks come from all of them, all else from
# the clocks.
DEVICES_ALIGNED = {
    "detect_events": 1,
    "synchronise_devices": 1,
    "correct_inertial": 1,
    "align_bodies": 4,  # colour, depth, suit, corrected suit
    "measure_arcs": 1,
    "evaluate_sources": 1,
    "evaluate_source_angles": 1,
    "evaluate_body_frames": 1,
    "build_viewer": 1,
    "draw_wrist_distance": 2,  # by each device's own clock, and by the clocks found
    "draw_thesis_fig3": 2,
    "draw_smoothness": 1,
    **PLATES,
}
# The calibration study once the ties of both mappers are new.
TIES = {
    "calibrate_cameras": 1,  # sfm-n12
    "align_cameras": 2,  # sim3-n12, paper-global-n12
    "evaluate_calibration": 2,
    "evaluate_racket": 1,
    "tabulate_calibration": 1,
    "draw_badminton_fig06": 2,
    **{f"draw_{name}": 1 for name in ("badminton_fig08", "badminton_fig12")},
    **{f"draw_{name}": 1 for name in ("coverage", "error_map", "growth")},
}


def test_a_video_with_other_content_reruns_its_camera_and_what_joins_cameras(kept):
    video = kept / DEMO / "videos/cam01.mp4"
    with changed(video, video.read_bytes() + b"\0"):
        jobs = planned(root=kept)
    own = {"extract_static": 1, "check_movement": 1, "check_videos": 1, "detect_pose": 1}
    assert jobs == together(own, REAL_FUSED)


def test_a_suit_recorded_anew_spares_the_depth_camera(kept):
    with changed(kept / SUIT, (kept / SUIT).read_bytes() + b"\n"):
        jobs = planned(root=kept)
    suit = {"import_device": 1, "export_device": 1}
    suit |= {"fit_source": 2, "export_motion": 2}  # as it is, and corrected
    assert jobs == together(suit, DEVICES_ALIGNED)


def test_points_clicked_anew_spare_pictures_features_and_models(kept):
    with changed(kept / CLICKS, (kept / CLICKS).read_bytes() + b"\n"):
        jobs = planned(root=kept)
    # known18, known8, known18-board, dlt8; the errors of known points are of clicks drawn anew, not
    # of these
    assert jobs == together({"adjust_network": 2, "resect_cameras": 4}, TIES)


def test_what_changes_no_result_reruns_nothing(kept):
    """All at once: what one of them reran, it would rerun among the others too.

    One video changed behind an older date: only verify_study tells this.
    """
    video = kept / DEMO / "videos/cam01.mp4"
    state = video.stat()
    with changed(video, video.read_bytes() + b"\0"):
        os.utime(video, ns=(state.st_atime_ns, state.st_mtime_ns))
        with ExitStack() as changes:
            for change in (fresh_checkout, remarks_words_and_other_packages, new_dates, new_source):
                changes.enter_context(change(kept))
            assert planned(root=kept) == {}
        message = {
            line.split(":")[0] for line in by_file(verify(kept)) if "cam01.mp4 changed" in line
        }
    folder = "results/walk-4cams-tiny/"
    assert f"{folder}takes/balancing/figures/overlay.file.all-robust.blazepose-full.png" in message
    others = {name for name in message if not name.startswith(folder)}
    figures = {f"results/figures/archive.{kind}" for kind in ("csv", "pdf", "png")}
    of_all = {"results/report.html", "results/figures/study.csv", "results/figures/ways.csv"}
    assert others <= of_all | figures


@contextmanager
def fresh_checkout(root):
    """Give all files of the repository the date of a checkout, later than all results."""
    with ExitStack() as dates:
        for path in root.rglob("*"):
            if is_of_the_repository(path, root):
                dates.enter_context(changed(path))
        yield


def is_of_the_repository(path, root):
    parts = path.relative_to(root).parts
    return path.is_file() and not {"results", ".snakemake"} & set(parts)


@contextmanager
def remarks_words_and_other_packages(root):
    session, lock = root / SESSIONS / "players-tiny.yaml", root / "environment.lock"
    text = session.read_text().replace("Virtual players", "Two virtual players", 1)
    tests = f"\npytest=={pytest.__version__} "  # no rule runs tests
    assert text != session.read_text() and lock.read_text().count(tests) == 1
    packages = lock.read_text().replace(tests, "\npytest==99 ") + "\n# compiled again\n"
    module = root / "workflow/lib/courtside/geometry/triangulation.py"
    script = root / "workflow/scripts/detect_pose.py"
    with (
        changed(session, f"# a remark\n{text}".encode()),
        changed(lock, packages.encode()),
        changed(module, module.read_bytes() + b"\n# a remark\n"),
        changed(script, script.read_bytes() + b"\n# a remark\n"),
    ):
        yield


@contextmanager
def new_source(root):
    """Fetch artefacts from elsewhere, by other code: a checksum states what they hold."""
    config, script = root / "config/config.yaml", root / "workflow/scripts/fetch_artefact.py"
    mirrored = config.read_text().replace("mirror_folder: null", f"mirror_folder: {root}", 1)
    assert mirrored != config.read_text()
    code = script.read_bytes() + b"\nOTHER = 1\n"
    with changed(config, mirrored.encode()), changed(script, code):
        yield


@contextmanager
def new_dates(root):
    """Give recordings the present date."""
    assert (root / DEPTH).stat().st_size > 100e6  # no recording is too large to be compared
    with (
        changed(root / DEMO / "videos/cam02.mp4"),
        changed(root / DEMO / "calibration/Calib.qca.txt"),
        changed(root / DEPTH),
    ):
        yield


def test_what_is_too_large_to_be_compared_goes_by_its_date(kept):
    with changed(kept / DEMO / "videos/cam04.mp4"):
        jobs = planned("--max-checksum-file-size", "1000", root=kept)
    own = {"estimate_background": 1, "check_videos": 1, "detect_pose": 1}
    assert jobs == together(own, REAL_FUSED)


def verify(root, *words):
    program = [sys.executable, "workflow/verify_study.py", "--directory", str(FOLDER), *words]
    done = subprocess.run(program, cwd=root, capture_output=True, text=True, check=False)
    assert done.stderr == ""
    return done.stdout.splitlines()


def by_file(lines):
    """Return the lines about one file each, without the sum at the end."""
    return [line for line in lines if line.startswith("results/")]


def test_a_network_reruns_detection_and_all_that_rests_on_keypoints(kept):
    with changed(kept / NETWORK, (kept / NETWORK).read_bytes() + b"\0"):
        jobs = planned(root=kept)
    cameras = {"detect_pose": 4 + 2 * 3 + 1}  # of the real take, two virtual ones, the depth camera
    devices = {"convert_landmarks": 1, "lift_depth": 1, "export_source": 2}
    devices |= {"fit_source": 3, "export_motion": 3}  # colour, depth, corrected suit
    assert jobs == together(cameras, REAL_FUSED, PLAYERS_FUSED, devices, DEVICES_ALIGNED)


def test_a_pin_of_an_artefact_fetches_it_and_reruns_what_is_made_of_it(kept):
    pins = kept / "config/external.yaml"
    sha256 = yaml.safe_load(pins.read_text())["pose2sim"]["sha256"]
    with edited(pins, sha256, sha256[::-1]):
        jobs = planned(root=kept)
    films = {"extract_static": 3, "check_movement": 3, "estimate_background": 1, "detect_pose": 4}
    films["check_videos"] = 1
    assert jobs == together({"fetch_pose2sim": 1, "import_cameras": 1}, films, REAL_FUSED)


def test_a_key_of_a_session_reruns_its_steps(kept):
    session = kept / SESSIONS / "walk-4cams-tiny.yaml"
    with edited(session, "p1: {sex: m,", "p1: {sex: f,"):
        jobs = planned(root=kept)
    # Triangulated places have offsets and errors that depend on the body.
    before = ("synchronise_cameras", "associate_people", "build_people_page", "check_cameras")
    before += ("name_people",)
    assert jobs == {rule: n for rule, n in REAL_FUSED.items() if rule not in before}
    with edited(session, "trim_s: [0.0, 0.4]", "trim_s: [0.0, 0.3]"):
        jobs = planned(root=kept)
    shorter = {"estimate_background": 1, "check_videos": 1, "detect_pose": 4, "check_movement": 3}
    assert jobs == together(shorter, REAL_FUSED)


def test_a_sighting_names_people_anew(kept):
    session = kept / SESSIONS / "walk-4cams-tiny.yaml"
    seen = "p1: {seen: {camera: cam01, time_s: 0, at_px: [430, 620]}, sex: m,"
    with edited(session, "p1: {sex: m,", seen):
        jobs = planned(root=kept)
    before = ("synchronise_cameras", "associate_people", "check_cameras")
    assert jobs == {rule: n for rule, n in REAL_FUSED.items() if rule not in before}


def test_a_script_reruns_its_rule(kept):
    drawing = kept / "workflow/scripts/draw_wrist_arcs.py"
    with changed(drawing, drawing.read_bytes() + b"\nX = 1\n"):
        assert planned(root=kept) == {"draw_wrist_arcs": 1}


def test_a_package_of_the_lock_reruns_what_imports_it(kept):
    lock = kept / "environment.lock"
    with edited(lock, f"\nezc3d=={metadata.version('ezc3d')} ", "\nezc3d==99 "):
        writing_c3d = {"export_take": 3, "export_motion": 5, "export_device": 1}
        assert planned(root=kept) == writing_c3d
        message = by_file(verify(kept))
    recorded = list((kept / RESULTS / "run" / "provenance").rglob("*.json"))
    assert sum("environment.lock changed" in line for line in message) == len(recorded) > 100


def add_session(root, name, like, **change):
    """Write a session like another."""
    content = yaml.safe_load((root / SESSIONS / f"{like}.yaml").read_text())
    content |= change
    (root / SESSIONS / f"{name}.yaml").write_text(yaml.safe_dump(content, sort_keys=False))


def test_sessions_that_are_added_rerun_only_the_table_that_they_share(kept):
    add_session(kept, "walk-again", "walk-4cams-tiny")
    virtual = yaml.safe_load((kept / SESSIONS / "plain-tiny.yaml").read_text())["virtual"]
    boards = {"inner_corners": [7, 4], "square_m": 0.06}
    cameras = {
        name: {"chessboard": {"images": f"results/virtual/plain-again/boards/{name}", **boards}}
        for name in ("side", "back")
    }
    add_session(kept, "plain-again", "plain-tiny", virtual={**virtual, "seed": 12}, cameras=cameras)
    study = kept / "config/tiny.yaml"
    with edited(study, "single-view-tiny]", "single-view-tiny, walk-again, plain-again]"):
        jobs = planned(root=kept)
    real = {"import_cameras": 1, "extract_static": 3, "check_movement": 3}
    real |= {"estimate_background": 1, "check_videos": 1, "detect_pose": 4, **REAL_FUSED}
    del real["export_overlay_video"]  # the study names the takes whose videos it writes
    found = {"simulate_plain-again": 1, "extract_static": 2, "extract_frames": 1}
    found |= {"extract_features": 1, "match_images": 1, "map_images": 2, "adjust_network": 2}
    found |= {"resect_cameras": 4, "calibrate_lens": 2, "evaluate_known": 1, **TIES}
    del found["evaluate_racket"], found["draw_badminton_fig12"]  # the study names their sessions
    assert jobs == together(real, found)


def test_a_session_that_is_removed_reruns_only_the_table_of_all_takes(kept):
    study = kept / "config/tiny.yaml"
    for name in ("single-view-tiny", "walk-4cams-tiny"):
        listed = f", {name}]" if name == "single-view-tiny" else f"[{name}, "
        with edited(study, listed, "]" if listed.endswith("]") else "["):
            measured = name == "walk-4cams-tiny"  # by fixed cameras
            assert planned(root=kept) == (OF_ALL_TAKES if measured else {})


def test_a_take_that_is_removed_reruns_the_tables_that_it_was_in(kept):
    session = kept / SESSIONS / "players-tiny.yaml"
    content = yaml.safe_load(session.read_text())
    del content["takes"]["rally"]
    tables = {"tabulate_players": 1, "tabulate_angles": 1, "draw_reliability": 1}
    with changed(session, yaml.safe_dump(content, sort_keys=False).encode()):
        said = run("-n", root=kept, check=False)
        assert said.returncode and "compare_sessions.takes: expected how names" in said.stderr
        with edited(kept / TINY, "takes: [shot, rally]", "takes: [shot]"):
            assert planned(root=kept) == {**tables, **OF_ALL_TAKES, "build_quality_page": 1}


def test_photos_in_a_folder_are_compared_one_by_one(tmp_path):
    """Snakemake compares files; of a folder it knows only the date."""
    copy_repository(tmp_path)
    photos = tmp_path / FOLDER / "data" / "hall"
    photos.mkdir(parents=True)
    random = np.random.default_rng(1)
    for at in range(4):
        picture = random.integers(0, 256, (30, 40, 3), dtype=np.uint8)
        cv2.imwrite(str(photos / f"{at}.png"), cv2.resize(picture, (480, 360)))
    session = {"description": "photos", "court": "none", "cameras": {}}
    session["walks"] = {"hall": {"images": "data/hall"}}
    session["override"] = {"sweep": {"n_images": [4], "n_offsets": 1}}
    (tmp_path / SESSIONS / "hall.yaml").write_text(yaml.safe_dump(session))
    asked = ("--config", "sessions=[hall]", "--", "results/hall/frames/hall.csv")
    run(*asked, root=tmp_path)
    for path in (*photos.iterdir(), photos):
        os.utime(path)
    assert planned(*asked, root=tmp_path) == {}
    with changed(photos / "2.png", (photos / "1.png").read_bytes()):
        assert planned(*asked, root=tmp_path) == {"extract_frames": 1}
    shutil.copy(photos / "1.png", photos / "5.png")
    assert planned(*asked, root=tmp_path) == {"extract_frames": 1}


@pytest.mark.slow
def test_results_without_their_dates_or_records_are_repaired_by_touch(tiny_study, tmp_path):
    """Copied with new dates in copying order, and without Snakemake's records of what it did."""
    copy_repository(tmp_path, FOLDER, copy_file=shutil.copy)
    shutil.rmtree(tmp_path / FOLDER / ".snakemake")
    assert planned(root=tmp_path) != {}
    before = {path: path.read_bytes() for path in figures(tmp_path)}
    run("--touch", root=tmp_path)
    assert planned(root=tmp_path) == {}
    assert {path: path.read_bytes() for path in figures(tmp_path)} == before


def figures(root):
    """Return the files of figures, without their records, which say when these were written."""
    found = [path for path in (root / RESULTS).rglob("figures/*") if path.is_file()]
    return [path for path in found if "provenance" not in path.parts]


@pytest.mark.slow
def test_every_script_is_known_to_reach_what_python_imports():
    """What a script's digest covers, against the modules Python has loaded after importing it."""
    library = ROOT / "workflow" / "lib"
    words = (
        "import runpy, sys; runpy.run_path(sys.argv[1]);"
        "print(*(name for name in sys.modules if name.split('.')[0] == 'courtside'))"
    )
    for script in sorted((ROOT / "workflow" / "scripts").glob("*.py")):
        done = subprocess.run(
            [sys.executable, "-c", words, str(script)],
            env={**os.environ, "PYTHONPATH": str(library)},
            capture_output=True,
            text=True,
            check=True,
        )
        assert set(done.stdout.split()) <= digest.modules_of(script, library), script
