"""What the benchmarks conclude from their times; that they give scripts what these take."""

import ast
import importlib.util
import inspect
import json
import os
import re
import runpy
import shutil
import sqlite3
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from unittest import mock

import numpy as np
import onnx
import pandas as pd
import pytest

sys.path.append(str(Path(__file__).parents[1] / "benchmarks"))  # last: both have a `scene`
import blender
import body_model
import device_angles
import find_persons
import hall_markers
import long_take
import many_sessions
import mapping_seeds
import networks
import opensim_angles
import opensim_ik
import pose_batches
import real_footage
import real_people
import rows
import run_log
import structure_from_motion
import ways_to_calibrate
from comparisons import pose
from courtside.devices import openpose
from courtside.geometry import camera as camera_models
from courtside.geometry import similarity
from courtside.pose.detector import Region
from courtside.records.cameras import image_names
from courtside.records.keypoints import keypoints, skeleton
from courtside.study.configuration import configuration, yaml_files
from courtside.study.targets import together
from fixtures.cameras import court_cameras

ROOT = Path(__file__).parents[1]
WRONG_CALL = r"Missing positional|Unexpected keyword|Missing named|\[attr-defined\]"  # of mypy
LOG = """Provided cores: 2
[Sat Nov 21 16:12:02 2026]
localrule film:
    output: results/a/film.mp4
    jobid: 9
    benchmark: results/a/benchmarks/film/one.tsv
[Sat Nov 21 16:12:05 2026]
rule look:
    jobid: 12
[Sat Nov 21 16:13:02 2026]
Finished jobid: 9 (Rule: film)
[Sat Nov 21 16:13:05 2026]
rule film:
    jobid: 10
    benchmark: results/a/benchmarks/film/two.tsv
[Sat Nov 21 16:13:09 2026]
Finished jobid: 12 (Rule: look)
"""
TSV = "s\th:m:s\tmax_rss\tcpu_time\n{}\t0:00:58\t-\t{}\n"


@pytest.fixture
def study(tmp_path):
    for name, wall_s, cpu_s in (("one", 58.0, 40.0), ("two", 7.0, 5.0)):
        path = tmp_path / "results" / "a" / "benchmarks" / "film" / f"{name}.tsv"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(TSV.format(wall_s, cpu_s))
    (tmp_path / "run.snakemake.log").write_text(LOG)
    return tmp_path


def test_every_benchmark_stands_in_the_readme():
    folder = Path(__file__).parents[1] / "benchmarks"
    readme = (folder / "README.md").read_text(encoding="utf-8")
    scripts = [path.name for path in folder.glob("*.py") if "__main__" in path.read_text("utf-8")]
    assert scripts and [name for name in scripts if name not in readme] == []


def test_a_log_says_when_jobs_began_and_ended(study):
    jobs = run_log.jobs(study / "run.snakemake.log")
    took_s = {job.rule: (job.ended - job.began).total_seconds() for job in jobs}
    assert took_s == {"film": 60.0, "look": 64.0}, "the second film did not end"
    assert run_log.seconds_in_jobs(study, jobs) == (60.0, 58.0, 1), "look has no benchmark file"
    assert run_log.cores(study / "run.snakemake.log") == 2


def test_stages_add_up_the_benchmark_files_of_a_rule(study):
    (stage,) = run_log.stages(study).itertuples()
    assert (stage.rule, stage.jobs, stage.cpu_s, stage.wall_s) == ("film", 2, 45.0, 65.0)


def test_ratios_are_between_times_per_unit_at_the_same_work():
    ours = [
        rows.Row("a", rows.OURS, True, "point", 100 * n, n, 1.0 * n, limit_s=0.1) for n in (1, 2)
    ]
    peer = [
        rows.Row("a", "peer", False, "point", 10, 1, 2.0),
        rows.Row("a", "peer", False, "point", 20, 2, 8.0),
    ]
    other = [rows.Row("b", "peer", False, "point", 10, 1, 2.0)]
    table = rows.table([*ours, *peer, *other])
    np.testing.assert_allclose(table["over_ours"], [1, 1, 20, 40, np.nan])
    np.testing.assert_allclose(table["growth"], [1, 2, 1, 4, 1])
    np.testing.assert_allclose(table["over_limit"], [10, 20, np.nan, np.nan, np.nan])
    lines = rows.markdown(table).splitlines()
    assert len(lines) == 2 + 3 and "| 40 | 4 at 2x |" in lines[3]


def test_multiplications_of_a_convolution():
    weights = onnx.numpy_helper.from_array(np.zeros((4, 3, 5, 5), np.float32), "weights")
    value = onnx.helper.make_tensor_value_info
    graph = onnx.helper.make_graph(
        [onnx.helper.make_node("Conv", ["x", "weights"], ["y"], strides=[2, 2], pads=[2, 2, 2, 2])],
        "one", [value("x", 1, [1, 3, 16, 16])], [value("y", 1, None)], [weights],
    )  # fmt: skip
    assert pose.multiplications(onnx.helper.make_model(graph)) == 8 * 8 * 4 * 3 * 5 * 5


def test_every_pair_of_features_of_matched_images_is_compared(tmp_path):
    with sqlite3.connect(tmp_path / "f.db") as made:
        made.execute("CREATE TABLE images (image_id, name)")
        made.execute("CREATE TABLE keypoints (image_id, rows)")
        made.executemany("INSERT INTO images VALUES (?, ?)", enumerate("abc"))
        made.executemany("INSERT INTO keypoints VALUES (?, ?)", enumerate((2, 3, 5)))
    count = structure_from_motion.compared_features
    assert count(tmp_path / "f.db") == 2 * 3 + 2 * 5 + 3 * 5
    assert count(tmp_path / "f.db", [("a", "c")]) == 10


def local_file(module):
    """Return the file of a module of the project, None where it belongs to nobody here."""
    folders = ("benchmarks", "workflow/lib", "workflow/scripts")
    places = [Path(ROOT, folder, *module.split(".")) for folder in folders]
    files = [found for at in places for found in (at.with_suffix(".py"), at / "__init__.py")]
    return next((path for path in files if path.is_file()), None)


def defined(path):
    """Return the names that a module has."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    found = {path.stem for path in path.parent.iterdir()} if path.stem == "__init__" else set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import | ast.ImportFrom):
            found |= {one.asname or one.name for one in node.names}
        elif isinstance(node, ast.FunctionDef | ast.ClassDef):
            found.add(node.name)
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            found.add(node.id)
    return found


def elsewhere(module):
    """Return whether a module is installed; those of the tests are not for benchmarks."""
    root = module.partition(".")[0]
    installed = root in sys.stdlib_module_names or importlib.util.find_spec(root) is not None
    return installed and not (ROOT / "tests" / root).exists()


@pytest.mark.parametrize(
    "path",
    [p for p in sorted((ROOT / "benchmarks").rglob("*.py")) if p.parent.name != "methods"],
    ids=lambda path: path.stem,
)
def test_what_a_benchmark_imports_is_there(path):
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names = [one.name for one in node.names]
            assert all(local_file(name) or elsewhere(name) for name in names), names
        elif isinstance(node, ast.ImportFrom):
            file = local_file(node.module)
            assert file or elsewhere(node.module), node.module
            if file:
                assert {one.name for one in node.names} <= defined(file), node.module


def test_benchmarks_call_the_library_as_it_is():
    """Only what a call lacks, or what is not there: they unpack rows and tuples of any length."""
    command = [sys.executable, "-m", "mypy", "--config-file", "pyproject.toml", "benchmarks"]
    path = os.pathsep.join(["workflow/lib", "benchmarks"])
    environment = os.environ | {"MYPYPATH": path}
    said = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True)
    assert "checked" in said.stdout, said
    wrong = [line for line in said.stdout.splitlines() if re.search(WRONG_CALL, line)]
    assert wrong == []


def test_both_models_of_structure_from_motion_are_scored_over_the_volume(tmp_path):
    """The true cameras, in another frame before the alignment, have no error."""
    true = court_cameras.right_cameras(2)
    names = [image_names.static(camera.name) for camera in true]
    sfm_from_world = similarity.Sim3(0.3, np.eye(3)[[1, 2, 0]], np.array([1.0, 2, 3]))
    sfm = [sfm_from_world.camera(camera) for camera in true]
    network = SimpleNamespace(lens_of_image=[0, 1])
    marked = dict(zip([c.name for c in true], court_cameras.views(true, noise_px=0), strict=True))
    parameters = {
        "adjust_network": {
            "min_points": 15, "click_bias_px": 0.5, "click_sigma_px": 0.9, "click_loss": 4.0,
            "tie_sigma": 4,
        }
    }  # fmt: skip
    benched = structure_from_motion
    with (
        mock.patch.object(benched.model, "read", lambda _: (network, names, [(1920, 1080)] * 2)),
        mock.patch.object(benched.registration, "outcome", lambda *_, **__: ""),
        mock.patch.object(benched.conversion, "fixed_cameras", lambda *_: sfm),
        mock.patch.object(benched.selection, "residual_spread", lambda _: 0.3),
        mock.patch.object(benched.joint_adjustment, "condense", lambda *_, **__: (None, [])),
        mock.patch.object(
            benched.joint_adjustment, "solve", lambda *_, **__: SimpleNamespace(cameras=true)
        ),
    ):
        found = benched.errors(
            tmp_path, SimpleNamespace(cameras=true), court_cameras.COURT, marked, parameters
        )
    assert found == (2, pytest.approx(0, abs=1e-3), pytest.approx(0, abs=1e-3))


def test_scripts_are_called_by_benchmarks_that_the_next_tests_run():
    calling = {
        path.stem
        for path in (ROOT / "benchmarks").rglob("*.py")
        if '"workflow" / "scripts"' in path.read_text()
    }
    assert calling == {"body_model", "device_angles", "long_take", "mapping_seeds", "real_footage"}


def test_long_take_gives_each_script_what_it_takes(tmp_path, monkeypatch):
    found = SimpleNamespace(person_id=np.array(["person-1", "person-2"]))
    monkeypatch.setattr(long_take.people, "read", lambda path: found)
    given = SimpleNamespace(
        cameras=Path("file/cameras.toml"), covariance=None, model="blazepose-full",
        skeleton="blazepose33",
    )  # fmt: skip
    steps = list(long_take.steps(tmp_path, given))
    assert steps[-1][0] == "measure_kinematics"
    for script, arguments, options in steps:
        main = runpy.run_path(str(ROOT / "workflow" / "scripts" / f"{script}.py"))["main"]
        inspect.signature(main).bind(*arguments, **options)


def test_a_take_is_repeated_with_all_that_its_file_has(tmp_path):
    names = {"xy": (2,), "score": (), "xyz_in_body": (3,)}
    seen = {name: np.random.default_rng(0).random((1, 4, 5, *of)) for name, of in names.items()}
    view = keypoints.Keypoints2D(
        "side", "made", np.array(list("abcde")), np.array([640, 360]), np.arange(4) / 2,
        **seen, reason=np.zeros((1, 4, 5), np.uint8), clothing=np.arange(24.0).reshape(1, 4, 2, 3),
    )  # fmt: skip
    keypoints.write_2d(tmp_path / "long.npz", long_take.repeated(view, 3.0))
    long = keypoints.read_2d(tmp_path / "long.npz")
    np.testing.assert_array_equal(long.time_s, np.arange(6) / 2)
    np.testing.assert_array_equal(long.clothing[0], view.clothing[0, [0, 1, 2, 3, 0, 1]])


def test_the_unit_of_memory_depends_on_the_system(monkeypatch):
    for system, unit in (("linux", 2**10), ("darwin", 2**20)):
        monkeypatch.setattr(sys, "platform", system)
        assert many_sessions.mib(300 * unit) == 300


def test_mapping_seeds_gives_each_script_what_it_takes(tmp_path, monkeypatch):
    called = []
    for script in (mapping_seeds.map_images, mapping_seeds.adjust_network):
        name = script.__name__
        main = mock.create_autospec(
            script.main, side_effect=lambda *_, name=name, **__: called.append(name)
        )
        monkeypatch.setattr(script, "main", main)
    monkeypatch.setattr(mapping_seeds.session_truth, "read", mock.Mock())
    monkeypatch.setattr(mapping_seeds.tie_points, "read", mock.Mock())
    for mapper in ("global", "incremental"):
        assert mapping_seeds.errors(tmp_path, "plain-dev", mapper, 0, 40, 10) == {}
    assert called == 2 * ["map_images", "adjust_network"]


def test_real_footage_gives_its_scripts_what_they_take(monkeypatch):
    scripts = (real_footage.filter_motion, real_footage.correct_joints)
    mains = [mock.create_autospec(script.main) for script in scripts]
    for script, main in zip(scripts, mains, strict=True):
        monkeypatch.setattr(script, "main", main)
    monkeypatch.setattr(real_footage.keypoints, "write_3d", mock.Mock())
    monkeypatch.setattr(real_footage.keypoints, "read_3d", mock.Mock())
    config = yaml_files.read(ROOT / "config" / "config.yaml")
    cameras = court_cameras.right_cameras()
    made = real_footage.stages(mock.Mock(), cameras, config["filter_motion"], {"p1": "m"})
    assert list(made) == ["raw", "filtered", "corrected"]
    for main in mains:
        main.assert_called_once()
    needed = {"raw", "filtered", "cameras", "cutoffs", "skeleton", "offsets"}
    assert needed <= set(vars(mains[1].call_args.args[0]))


PERSON_M = {"shoulder": 1.4, "elbow": 1.1, "wrist": 0.85, "hip": 0.9, "knee": 0.5, "ankle": 0.1}


def standing():
    """Return the limb joints (3, 12, 3) m of a person who stands upright, arms hanging."""
    names = [joint.split("_") for joint in skeleton.JOINTS]
    one = [(0.15 if side == "left" else -0.15, 0, PERSON_M[part]) for side, part in names]
    return np.array([one] * 3)


def test_recorded_people_are_compared_stage_by_stage():
    other = standing()
    corrected = other.copy()
    at = [joint.endswith("shoulder") for joint in skeleton.JOINTS]
    corrected[:, at, 2] -= 0.04
    corrected[:, [joint.endswith("knee") for joint in skeleton.JOINTS], 1] += 0.1
    corrected[0, skeleton.JOINTS.index("left_shoulder")] = np.nan
    stages = {"raw": other, "corrected": corrected}
    found = {
        (row[1].removeprefix("hall: "), row[2]): row
        for row in real_people.rows("hall", "session", stages, other, "command")
    }
    distance = "shoulders, distance, median / 90 %, mm"
    assert found[distance, "raw_first"][3] == "0" and found[distance, "corrected_first"][3] == "40"
    assert found[distance, "corrected_first"][6:8] == [5, 1]
    arms = {key[1]: row[3] for key, row in found.items() if key[0].startswith("upper arms")}
    firsts = [arms[f"{stage}_first"] for stage in ("raw", "corrected", "reference")]
    assert firsts == ["300", "260", "300"]
    bent = [row[3] for key, row in found.items() if "left hip flexion" in key[0]]
    assert bent == ["+0.0", "0.0", "+14.0", "14.0"]  # 0.1 m forwards of 0.4


def test_shoulders_set_by_hand_are_triangulated(tmp_path):
    cameras, joints = court_cameras.right_cameras(), ("left_shoulder", "right_ankle")
    true = np.array([[0.3, 0.5, 1.5], [-0.2, 0.4, 0.1]])
    lines = ["camera,frame_idx,joint,x_px,y_px,visibility"]
    for camera in cameras:
        for name, (x, y) in zip(
            ("LShoulder", "RAnkle"), camera_models.project(camera, true), strict=True
        ):
            lines.append(f"{camera.name},0,{name},{x},{y},2")
    (tmp_path / "annotations.csv").write_text("\n".join(lines))
    times, found = hall_markers.by_hand(tmp_path, cameras, 12.0, joints)
    assert times.tolist() == [0]
    np.testing.assert_allclose(found, true[None], atol=1e-4)


def test_the_body_model_gives_its_script_what_it_takes(tmp_path, monkeypatch):
    main = mock.create_autospec(body_model.fit_skeleton.main)
    monkeypatch.setattr(body_model.fit_skeleton, "main", main)
    contacts = mock.create_autospec(body_model.find_contacts.main)
    monkeypatch.setattr(body_model.find_contacts, "main", contacts)
    stored = SimpleNamespace(xyz=np.zeros((1, 5, 2, 3)))
    monkeypatch.setattr(body_model.keypoints, "read_3d", lambda _: stored)
    found, seconds = body_model.fitted(tmp_path, "players-a", ("shot", "known18"), tmp_path)
    assert set(found) == set(body_model.STAGES) and seconds >= 0
    assert main.call_args.kwargs["height_m_of"]["m3"] == pytest.approx(1.84)


def test_angles_of_devices_give_their_script_what_it_takes(tmp_path, monkeypatch):
    main = mock.create_autospec(device_angles.fit_source.main)
    monkeypatch.setattr(device_angles.fit_source, "main", main)
    for name in ("device", "source", "keypoints"):
        monkeypatch.setattr(device_angles, name, mock.Mock())
    suit = SimpleNamespace(source="mocopi-corrected", kind="inertial")
    stages, seconds = device_angles.fitted("suit.npz", suit, ("p1", 1.8), tmp_path)
    assert set(stages) == set(device_angles.STAGES) and seconds >= 0
    given = main.call_args.kwargs
    assert given["sigma_m"] == device_angles.parameters()["fit_source"]["sigma_m"]["corrected"]
    assert given["height_m"] == 1.8 and device_angles.heights("single-view") == {"p1": 1.84}


def test_intervals_of_angles_hold_their_error():
    error = np.random.default_rng(0).normal(0, 3, (2, 400))
    n, rmse, least, most = body_model.interval(error, 12.0)
    assert n == 800 and least < rmse < most
    assert rmse == pytest.approx(3, abs=0.3)


def test_angles_of_opensim_are_compared_at_their_own_frames(tmp_path):
    columns = [f"{name}_{side}" for name in opensim_angles.ANGLES.values() for side in "lr"]
    ours = pd.DataFrame(np.arange(60.0).reshape(10, 6), columns=columns)
    # Their rows 3 and 7, counted from 1, show the video's frames 3 and 7, counted from 0. The third
    # is one that this study does not have.
    rows = [[3 / 60, *ours.loc[3] - 4], [7 / 60, *ours.loc[7] + 2], [50 / 60, *[0.0] * 6]]
    lines = ["inDegrees=yes", "endheader", "\t".join(["time", *columns])]
    file = tmp_path / "part.mot"
    file.write_text("\n".join([*lines, *("\t".join(f"{v:.8f}" for v in r) for r in rows)]))
    found = dict(opensim_angles.differences(ours, opensim_angles.motion(file)))
    assert len(found) == 6
    for apart in found.values():
        np.testing.assert_allclose(apart, [4, -2], atol=1e-6)


def test_markers_of_opensims_tool_become_joints_of_the_world(tmp_path):
    points = SimpleNamespace(
        joints=np.array(["a", "b"]), time_s=np.arange(3) / 30, xyz=np.ones((1, 3, 2, 3))
    )
    points.xyz[0, 2, 1] = np.nan  # missing joints stay so
    names = "\t".join(["time", *(f"{joint}_t{axis}" for joint in "ba" for axis in "xyz")])
    rows = [[k / 30, *range(10 * k, 10 * k + 6)] for k in range(1, 3)]  # frame 0 was not solved
    lines = ["Model Marker Locations", "endheader", names]
    lines += ["\t".join(f"{value:.8f}" for value in row) for row in rows]
    (tmp_path / "_ik_model_marker_locations.sto").write_text("\n".join(lines))
    found = opensim_ik.located(tmp_path, points)
    assert np.isnan(found[0, 0]).all() and np.isnan(found[0, 2, 1]).all()
    np.testing.assert_array_equal(found[0, 1], [[15, 13, 14], [12, 10, 11]])


def test_without_the_recording_of_the_hall_one_line_says_where_it_is_from(tmp_path):
    with pytest.raises(SystemExit) as caught:
        hall_markers.checked(tmp_path)
    assert "expected the recording mocap_8, found no mocap.csv" in str(caught.value)
    assert "docs/measured/real_footage.md" in str(caught.value) and "\n" not in str(caught.value)


def test_the_session_of_the_hall_is_a_session(tmp_path):
    data = tmp_path / "recording"
    data.mkdir()
    for name in (*hall_markers.FILES, *(f"{one}.mp4" for one in hall_markers.CAMERAS)):
        (data / name).write_text("")
    (data / "court_points.csv").write_text(
        "camera,x_px,y_px,x_m,y_m\ncam02,1,2,3,4\ncam01,5,6,3,4\n"
    )
    one = {"mtx": [[4000, 0, 1920], [0, 4000, 1080], [0, 0, 1]], "dist": [[-0.3, 0, 0, 0, 0]]}
    one |= {"rvecs": [[0], [0], [0]], "tvecs": [[-3000], [0], [9000]]}
    given = json.dumps(dict.fromkeys(hall_markers.CAMERAS, one))
    (data / "calibration_given.json").write_text(given)
    hall_markers.checked(data)
    config = tmp_path / "config"
    shutil.copytree(ROOT / "config", config)
    written = hall_markers.write_study(tmp_path, data, "blazepose-heavy-flip")
    study = yaml_files.read(config / "config.yaml") | yaml_files.read(tmp_path / written)
    sessions = configuration.load(study, written, config, tmp_path).sessions
    found = sessions["hall-markers"]
    assert (
        found.calibrations() == found.take_calibrations() == hall_markers.calibrations(found.name)
    )
    assert sessions["hall-given"].calibrations() == ["file", "file-people"]
    camera = camera_models.read_toml(tmp_path / "data" / "given.toml")[0]
    assert camera.centre_in_world.tolist() == [3, 0, -9]
    assert (tmp_path / "data" / "court_points.csv").read_text().count("cam0") == 1


def test_cameras_whose_court_is_not_found_are_clicked():
    clicks = {"back": np.zeros((2, 2)), "side": np.ones((2, 2))}
    found = ways_to_calibrate.together({"back": np.full((2, 2), 5.0), "side": None}, clicks)
    assert (found["back"] == 5).all() and found["side"] is clicks["side"]


def test_bones_in_blender_are_compared_at_the_frames_of_the_record():
    time_s, xyz = 5 + np.arange(10) / 50, np.zeros((10, 2, 3))
    xyz[:, :, 0] = np.arange(10)[:, None]
    xyz[:2] = np.nan  # the person enters with the third frame
    head = {"bones": np.array(["hip", "hip_to_knee", "knee"]), "time_s": np.arange(8) / 50}
    moved = np.tile([0, 0.003, 0], (8, 3, 1))
    moved[:, :, 0] = np.arange(2, 10)[:, None]
    record = ["hip", "knee"], time_s, xyz
    apart, frames = blender.distances_mm(*record, None, head | {"xyz": moved})
    assert frames == 8 and apart.shape == (8, 2)
    np.testing.assert_allclose(apart, 3)
    of_take = head | {"xyz": moved, "time_s": np.arange(2, 10) / 50}
    np.testing.assert_allclose(blender.distances_mm(*record, 5.0, of_take)[0], 3)
    late = head | {"xyz": moved, "time_s": head["time_s"] + 0.01}
    assert blender.distances_mm(*record, None, late)[0].shape == (0, 2)


def test_joints_set_by_hand_are_read_as_keypoints_of_another_program(tmp_path):
    (tmp_path / "annotations.csv").write_text(
        "camera,frame_idx,joint,x_px,y_px,visibility\n"
        "cam02,0,LShoulder,10,20,2\ncam02,0,RHand,30,40,2\ncam02,1,LShoulder,11,20,2\n"
        "cam01,0,LShoulder,1,2,2\ncam02,0,Spine,5,6,2\n"
    )
    folders = networks.write_json(tmp_path, tmp_path / "hand")
    joints = skeleton.read(ROOT / "config" / "skeletons" / "body25.yaml")
    view = openpose.read(folders["cam02"], joints, camera="cam02", model="body25", size=(99, 99),
                         time_s=np.array([0.0, 0.1]))  # fmt: skip
    at = [view.joints.tolist().index(name) for name in ("left_shoulder", "right_wrist", "nose")]
    np.testing.assert_array_equal(view.xy[0, 0, at], [[10, 20], [30, 40], [np.nan] * 2])
    assert view.xy[0, 1, at[0]].tolist() == [11, 20] and view.xy.shape[:2] == (1, 2)


def test_the_study_of_networks_on_recorded_pictures_has_no_fault(tmp_path):
    demo, config = tmp_path / "demo", tmp_path / "config"
    for at in range(1, 5):
        (demo / "openpose_body25b" / f"cam{at}_json").mkdir(parents=True)
    shutil.copytree(ROOT / "config", config)
    written = networks.write_study(tmp_path, demo, None, ["blazepose-full", "blazepose-static"])
    study = yaml_files.read(config / "config.yaml") | yaml_files.read(tmp_path / written)
    found = configuration.load(study, written, config, tmp_path)
    rows = together.evaluated_takes(found)
    assert [row.labels["against"] for row in rows] == ["body25b"] * 2
    assert [row.pose3d for row in rows] == [None, None]


def test_times_of_networks_stand_over_the_first():
    about = {"session": "repeats", "against": "truth", "unit": "%", "n": 9, "value": 90.0}
    made = [
        {**about, "network": name, "measure": "pck", "value_from": 88.0, "value_to": np.nan}
        for name in ("full", "heavy")
    ]
    made.append({**made[0], "session": "walk-4cams", "against": "body25b"})
    found = list(networks.rows(pd.DataFrame(made), {"full": 20.0, "heavy": 70.0}))
    printed = {(row[1], row[2]): row[3] for row in found}
    assert printed["`heavy`; virtual, `repeats`", "time"] == "3.50"
    assert [part for row, part in printed if "virtual" in row] == ["time", "time"]
    recorded = "`full`; real, `walk-4cams`, against OpenPose (no truth)"
    assert printed[recorded, "pck_from"] == "88.0" and printed[recorded, "pck_to"] == "-"


def test_a_person_is_found_by_a_region_of_its_size_and_place():
    person, far = np.array([[100.0, 100], [140, 300]]), np.array([[400.0, 100], [440, 300]])
    short = np.array([[10.0, 10], [20, 80]])  # below 80 px: not counted, but no false region
    there = [Region(125, 205, 280, box=(60, 210)), Region(15, 45, 100, box=(10, 70))]
    wrong = [Region(420, 200, 280, box=(60, 90)), Region(300, 200, 280, box=(60, 210))]

    class Detector:
        side_px = 1000

        def detect(self, image):
            return there + wrong

    picture = np.zeros((480, 640, 3), np.uint8)
    counts, n_pictures, n_persons = find_persons.counted(
        [(picture, [person, far, short])], {"made": Detector()}
    )
    assert (n_pictures, n_persons) == (1, 2)
    assert counts["made", "whole"].tolist() == [1, 2]


def test_a_run_without_some_scene_leaves_the_stated_numbers_alone(tmp_path, monkeypatch):
    monkeypatch.setattr(find_persons, "OUTPUT", tmp_path / "table.csv")
    known = dict.fromkeys(["blazepose-detector", *find_persons.OWN])
    monkeypatch.setattr(find_persons, "detectors", lambda *_: known)
    monkeypatch.setattr(find_persons, "counted", lambda *_: ({("made", "whole"): (1, 0)}, 1, 1))
    call = ["find_persons.py", "results", "--models", "folder", "--demo", "demo"]
    whole = [*call, "--session", "crowd-dev", "--hall", "data"]
    for arguments in (call, [*whole, "--every", "80"], whole):
        assert not find_persons.OUTPUT.exists()
        monkeypatch.setattr(sys, "argv", arguments)
        find_persons.main()
    assert find_persons.OUTPUT.read_text().count("\n") == 4


def test_a_network_is_brought_to_several_crops(tmp_path):
    picture = onnx.helper.make_tensor_value_info("x", onnx.TensorProto.FLOAT, [1, 2, 2, 3])
    flat = onnx.helper.make_tensor_value_info("y", onnx.TensorProto.FLOAT, [1, 12])
    sizes = onnx.numpy_helper.from_array(np.array([1, 12]), "sizes")
    node = onnx.helper.make_node("Reshape", ["x", "sizes"], ["y"])
    graph = onnx.helper.make_graph([node], "made", [picture], [flat], [sizes])
    opset = [onnx.helper.make_opsetid("", 17)]
    onnx.save(onnx.helper.make_model(graph, opset_imports=opset, ir_version=8), tmp_path / "n.onnx")
    measured = pose_batches.measure(tmp_path / "n.onnx", [1, 3], 1)
    assert [apart for _, apart in measured.values()] == [0, 0]
    assert all(ms < 1000 for ms, _ in measured.values())
