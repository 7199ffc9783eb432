"""A Pose2Sim project holds what was measured, in a form Pose2Sim reads; its TRC files come back.

`open_by_pose2sim.py` beside this file opens such a project with Pose2Sim itself.
"""

import json
import re
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from courtside.exports import markers, pose2sim, trc
from courtside.geometry import camera as cameras
from courtside.records.keypoints import keypoints, missing_reason, skeleton
from courtside.study.errors import InputError
from fixtures.cameras import scene
from fixtures.people import walker
from fixtures.recordings.real_data import REAL, needs_real

SKELETONS = Path(__file__).parents[3] / "config" / "skeletons"


def views_of(points, found):
    return {view.camera: (view.xy, view.score) for view in walker.views(points, found)}


@pytest.fixture
def project(tmp_path):
    """Two persons before eleven cameras, whose names sort otherwise than their order."""
    points = walker.points(n_persons=2)
    found = [replace(c, name=f"z{11 - at}") for at, c in enumerate(scene.ring(11))]
    views = views_of(points, found)
    views["z4"][0][1, 6, 2] = np.nan
    pose2sim.write_project(tmp_path / "take", found, views, points, skeleton="blazepose33")
    return tmp_path / "take", found, views, points


def test_cameras_and_their_folders_come_in_one_order(project):
    """Pose2Sim pairs the calibration's tables with the folders.

    The folders are sorted by the last number in their names.
    """
    folder, found, *_ = project
    assert [p.name for p in folder.glob("*calib*/*.toml")] == ["Calib.toml"]
    tables = tomllib.loads((folder / "calibration" / "Calib.toml").read_text())
    named = [table["name"] for key, table in tables.items() if key != "metadata"]
    assert named == [camera.name for camera in found]
    folders = [path.name for path in (folder / "pose").iterdir()]
    folders.sort(key=lambda name: int(re.findall(r"\d+", name)[-1]))
    assert [name.split("_")[0] for name in folders] == named
    assert all("json" in name for name in folders)
    again = cameras.read_toml(folder / "calibration" / "Calib.toml")
    assert again[3].cam_from_world == pytest.approx(found[3].cam_from_world, abs=1e-12)


def test_2d_keypoints_are_in_each_frames_file(project):
    folder, _, views, points = project
    files = sorted((folder / "pose" / "z4_08_json").iterdir())
    assert len(files) == len(points.time_s)
    assert [int(re.split(r"(\d+)", path.name)[-2]) for path in files] == list(range(len(files)))
    people = json.loads(files[6].read_text())["people"]
    assert len(people) == 2
    table = np.array(people[1]["pose_keypoints_2d"]).reshape(-1, 3)
    assert table[2].tolist() == [0, 0, 0]
    xy, score = views["z4"]
    assert table[3:, :2] == pytest.approx(xy[1, 6, 3:], abs=1e-4)
    assert table[3:, 2] == pytest.approx(score[1, 6, 3:], abs=1e-4)


def test_3d_keypoints_come_back_from_the_folder(project):
    folder, _, _, points = project
    files = {person: folder / "pose-3d" / f"take_{person}_1-20.trc" for person in ("p1", "p2")}
    found = pose2sim.read_takes(files, walker.SKELETON, model="theirs")
    assert found.person_id.tolist() == ["p1", "p2"]
    assert found.joints.tolist() == points.joints.tolist()
    np.testing.assert_allclose(found.xyz, points.xyz, atol=1e-6)
    assert found.time_s == pytest.approx(points.time_s)
    assert found.reason[0, 3, 4] == missing_reason.UNSEEN
    assert found.n_views[0, 3, 3:5].tolist() == [2, 0]
    keypoints.write_3d(folder / "x.npz", found)  # a record as any other
    assert keypoints.read_3d(folder / "x.npz").model == "theirs"


def test_filtered_files_keep_the_person_in_their_names(project):
    """`Pose2Sim.filtering` replaces the part after the last `_` by the frames and the filter."""
    names = [path.name for path in (project[0] / "pose-3d").iterdir()]
    filtered = {name.replace(name.split("_")[-1], "1-20_filt_butterworth.trc") for name in names}
    assert filtered == {f"take_{person}_1-20_filt_butterworth.trc" for person in ("p1", "p2")}


def test_settings_name_the_skeleton(project, tmp_path):
    folder, found, views, points = project
    content = tomllib.loads((folder / "Config.toml").read_text())
    assert content["project"] == {"multi_person": True, "frame_rate": 50, "frame_range": "all"}
    assert content["pose"] == {"pose_model": "BLAZEPOSE"}
    assert content["triangulation"]["undistort_points"] is True
    pose2sim.write_project(tmp_path / "own", found, views, points, skeleton="rig")
    content = tomllib.loads((tmp_path / "own" / "Config.toml").read_text())["pose"]
    children = content[content["pose_model"]]["children"]
    assert [child["id"] for child in children] == list(range(33))
    assert [child["name"] for child in children] == markers.names(list(points.joints))


def test_a_project_is_replaced_as_a_whole(project):
    folder, found, views, points = project
    (folder / "old.txt").write_text("x")
    pose2sim.write_project(folder, found, views, points, skeleton="blazepose33")
    assert not (folder / "old.txt").exists()
    assert (folder / "kinematics" / "Markers_COURTSIDE.xml").is_file()


def test_views_of_other_shapes_are_refused(project, tmp_path):
    _, found, views, points = project
    for wrong in ({}, views | {"z1": (views["z1"][0][:1], views["z1"][1][:1])}):
        with pytest.raises(ValueError, match="of camera z1"):
            pose2sim.write_project(tmp_path / "x", found, wrong, points, skeleton="rig")


def test_files_that_do_not_fit_are_named(project, tmp_path):
    folder, *_ = project
    good = folder / "pose-3d" / "take_p1_1-20.trc"
    with pytest.raises(
        InputError, match=r"take_p1_1-20.trc: expected markers of skeleton small such as"
    ):
        other = replace(walker.SKELETON, name="small", joints=("tail",))
        pose2sim.read_takes({"p1": good}, other, model="m")
    short = walker.points(n_frames=12)
    trc.write(tmp_path / "short.trc", short, 0)
    with pytest.raises(InputError, match=r"short.trc: expected the times of .*take_p1_1-20.trc"):
        files = {"p1": good, "p2": tmp_path / "short.trc"}
        pose2sim.read_takes(files, walker.SKELETON, model="m")


@pytest.mark.parametrize(("unit", "found"), [("mm", "0.00"), ("in", "0.0")])
def test_a_person_of_no_person_s_size_is_refused(project, tmp_path, unit, found):
    text = (project[0] / "pose-3d" / "take_p1_1-20.trc").read_text()
    path = tmp_path / "p1.trc"
    path.write_text(text.replace("\tm\t", f"\t{unit}\t", 1))
    message = rf"p1.trc: expected joints of a person over 0.1 to 4 m, found them over {found}"
    with pytest.raises(InputError, match=message):
        pose2sim.read_takes({"p1": path}, walker.SKELETON, model="m")


@pytest.mark.parametrize(("order", "axis"), [([2, 0, 1], "Z"), ([1, 2, 0], "X")])
def test_a_file_with_another_axis_up_than_y_is_refused(tmp_path, order, axis):
    points = walker.points()
    trc.write(tmp_path / "p1.trc", replace(points, xyz=points.xyz[..., order]), 0)
    message = rf"p1.trc: expected Y up, found the trunk along {axis}; export it with Y up"
    with pytest.raises(InputError, match=message):
        pose2sim.read_takes({"p1": tmp_path / "p1.trc"}, walker.SKELETON, model="m")


def test_a_person_who_lies_is_read(tmp_path):
    points = walker.points()
    lying = points.xyz[..., [2, 0, 1]] + [3.0, 0, 0]
    trc.write(tmp_path / "p1.trc", replace(points, xyz=lying), 0)
    found = pose2sim.read_takes({"p1": tmp_path / "p1.trc"}, walker.SKELETON, model="m")
    np.testing.assert_allclose(found.xyz, lying, atol=1e-6)


@pytest.mark.parametrize(("at_m", "told"), [(0.0, True), (-0.9, False)])
def test_a_person_who_lies_at_the_origin_is_read_and_asked_about_if_they_could_stand(
    tmp_path, capsys, at_m, told
):
    """With the soles at zero they have the joints of one who stands in a file with Z up."""
    points = walker.points()
    lying = points.xyz[..., [2, 0, 1]] + [at_m, 0, 0.3]
    trc.write(tmp_path / "p1.trc", replace(points, xyz=lying), 0)
    found = pose2sim.read_takes({"p1": tmp_path / "p1.trc"}, walker.SKELETON, model="m")
    np.testing.assert_allclose(found.xyz, lying, atol=1e-6)
    line = "found the trunk along Z; export it with Y up, unless the person lies"
    assert (line in capsys.readouterr().err) == told


@pytest.mark.parametrize("turn", [1, -1])
@pytest.mark.parametrize("at_m", [-1.0, -0.3, 0.0, 0.3, 0.8])
def test_a_cyclist_at_the_origin_is_read(tmp_path, capsys, at_m, turn):
    """The trunk is level, but the feet are below the hips, not beside them."""
    points = walker.points()
    places = {"hip": (0.0, 0.9), "knee": (0.3, 0.6), "ankle": (0.05, 0.1), "heel": (0.0, 0.05)}
    ahead, up = np.transpose(
        [places.get(joint.split("_")[-1], (0.5, 1.1)) for joint in walker.SKELETON.joints]
    )
    xyz = np.stack([turn * ahead + at_m, 0 * ahead, up], axis=1) + 0 * points.xyz
    trc.write(tmp_path / "p1.trc", replace(points, xyz=xyz), 0)
    found = pose2sim.read_takes({"p1": tmp_path / "p1.trc"}, walker.SKELETON, model="m")
    np.testing.assert_allclose(found.xyz, xyz, atol=1e-6)
    assert not capsys.readouterr().err


def test_a_joint_at_zero_is_missing(project, tmp_path):
    """Programs without blanks write 0 0 0; no joint is there to a micrometre."""
    lines = (project[0] / "pose-3d" / "take_p1_1-20.trc").read_text().splitlines()
    cells = lines[8].split("\t")
    cells[5:8] = ["0.000000"] * 3
    path = tmp_path / "p1.trc"
    path.write_text("\n".join([*lines[:8], "\t".join(cells), *lines[9:], ""]))
    given, found = (
        pose2sim.read_takes({"p1": one}, walker.SKELETON, model="m").xyz
        for one in (project[0] / "pose-3d" / "take_p1_1-20.trc", path)
    )
    assert np.isfinite(given[0, 2, 1]).all()
    assert np.argwhere(np.isnan(found) & ~np.isnan(given)).tolist() == [
        [0, 2, 1, axis] for axis in range(3)
    ]


@needs_real
def test_a_file_of_pose2sim_itself_is_read():
    """Its markers are the joints by name; columns as the real data's own table of axes states."""
    path = REAL / "walk-4cams" / "trc" / "Balancing_for_IK.trc"
    body = skeleton.read(SKELETONS / "halpe26.yaml")
    found = pose2sim.read_takes({"p1": path}, body, model="pose2sim")
    assert found.xyz.shape == (1, 100, 26, 3)
    missing = np.isnan(found.xyz[0, :, :, 0]).all(axis=0)
    assert found.joints[missing].tolist() == [
        "left_eye",
        "right_eye",
        "left_ear",
        "right_ear",
        "mid_hip",
    ]
    row = path.read_text().splitlines()[5].split("\t")
    knee = np.array(row[5:8], dtype=float)  # RKnee: X2 Y2 Z2
    assert found.xyz[0, 0, body.index("right_knee")] == pytest.approx(knee[[2, 0, 1]])
    height = (
        found.xyz[0, :, body.index("head_top"), 2] - found.xyz[0, :, body.index("left_heel"), 2]
    )
    assert 1.4 < np.median(height) < 1.9
