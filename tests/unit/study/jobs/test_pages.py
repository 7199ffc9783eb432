"""Layers and settings of viewers and videos: written out for the tiny study."""

from dataclasses import replace

from courtside.study.configuration.sessions import Device
from courtside.study.jobs import pages, takes

SHOT = {"session": "players-tiny", "take": "shot", "model": "blazepose-full"}
CLAPS = {"session": "single-view-tiny", "take": "claps", "model": "blazepose-full"}


def test_a_viewer_of_fixed_cameras_has_a_layer_for_each_stage(job):
    way = "known18/all-robust/blazepose-full.npz"
    folder = "results/players-tiny/takes/shot"
    stages = [("corrected", True), ("filtered", False), ("raw", False)]
    files = [f"{folder}/pose3d{end}/{way}" for end in ("_corrected", "_filtered", "")]
    assert pages.layers(job(**SHOT)) == [
        {"file": file, "name": name, "of": "blazepose33", "shown": shown, "skeleton": 0}
        for file, (name, shown) in zip(files, stages, strict=True)
    ]


def test_a_viewer_of_devices_shows_the_first_and_places_the_others_on_it(job):
    found = pages.layers(job(**CLAPS))
    assert [layer["name"] for layer in found] == [
        *("d415-depth", "d415-rgb", "mocopi", "mocopi-corrected"),
    ]
    assert [layer["shown"] for layer in found] == [True, False, False, False]
    assert [layer["placed"] for layer in found] == [False, True, True, True]
    assert [layer["skeleton"] for layer in found] == [0, 0, 1, 1]
    assert found[-1]["source"] == "mocopi"
    assert found[-1]["person"] == "p1"
    names = [path.stem for path in pages.skeleton_files(job(**CLAPS))]
    assert names == ["blazepose33", "mocopi27"]


def test_devices_beside_fixed_cameras_follow_their_stages(job, study):
    session = study.sessions["players-tiny"]
    suit = {"suit": Device("inertial", "m.bvh", "p1")}
    worn = replace(session, takes={"shot": replace(session.takes["shot"], devices=suit)})
    found = pages.layers(job(replace(study, sessions={"players-tiny": worn}), **SHOT))
    assert [layer["name"] for layer in found] == [
        *("corrected", "filtered", "raw", "suit", "suit-corrected"),
    ]
    assert [layer["shown"] for layer in found] == [True, False, False, False, False]


def test_cameras_and_court_are_viewed_where_skeletons_stand_on_it(job, study):
    cameras = "results/players-tiny/calibration/known18/cameras.toml"
    assert pages.viewed_cameras(job(**SHOT)) == cameras
    assert pages.viewed_court(job(**SHOT)) == study.folder / "courts" / "badminton.yaml"
    assert pages.viewed_cameras(job(**CLAPS)) == []
    assert pages.viewed_court(job(**CLAPS)) == []
    real = {"session": "walk-4cams-tiny", "take": "balancing"}
    assert pages.viewed_court(job(**real)) == []


def test_videos_with_skeletons_are_written_as_the_study_says(job):
    assert pages.overlay(job()) == {
        "crf": 23,
        "effort": "veryfast",
        "keep_background": False,
    }


def test_the_page_of_people_is_by_the_first_calibration_and_network(job):
    one = job(session="walk-4cams-tiny", take="balancing")
    folder = "results/walk-4cams-tiny/takes/balancing"
    found = pages.first_way(one, "{take}/{calibration}/{model}.found.npz")
    assert found == "balancing/file/blazepose-full.found.npz"
    assert pages.first_keypoints(one)[0] == f"{folder}/pose2d/blazepose-full/cam01.npz"
    assert takes.first_skeleton(one).name == "blazepose33.yaml"
    assert pages.people_target(one) == "data/walk-4cams-tiny/people.csv"


def test_all_takes_are_known_to_the_page(job, study):
    session = study.sessions["players-tiny"]
    session = replace(session, withheld={"late": session.takes["shot"]})
    one = job(replace(study, sessions={"players-tiny": session}), **SHOT)
    assert pages.known_takes(one) == ["shot", "rally", "late"]


def test_a_page_for_quality_shows_each_camera_by_the_first_way_of_those_who_agreed(job, study):
    real, name = "results/walk-4cams-tiny/takes/balancing", "walk-4cams-tiny"
    (take,) = pages.judged_takes(job(session=name))
    cameras = [f"cam0{at}" for at in (1, 2, 3, 4)]
    assert take["pose2d"] == [f"{real}/pose2d/blazepose-full/{camera}.npz" for camera in cameras]
    assert take["videos"] == list(study.sessions[name].takes["balancing"].videos.values())
    assert take["people"] == f"{real}/people/file/blazepose-full.npz"
    assert (take["name"], take["quality"]) == ("balancing", f"{real}/quality.csv")
    assert take["left_out"] == ""
    assert [one["name"] for one in pages.judged_takes(job(session="players-tiny"))] == [
        *("shot", "rally"),
    ]
    session = study.sessions[name]
    shy = {key: replace(one, consent=("analysis",)) for key, one in session.subjects.items()}
    refused = replace(study, sessions={name: replace(session, subjects=shy)})
    (take,) = pages.judged_takes(job(refused, session=name))
    assert (take["pose2d"], take["videos"]) == ([], [])
    assert take["left_out"] == "No pictures: p1 not agreed to pictures."
    points = {"body25": dict.fromkeys(cameras, "keypoints")}
    unfilmed = replace(session.takes["balancing"], videos={}, pose2d=points)
    alone = replace(study, sessions={name: replace(session, takes={"balancing": unfilmed})})
    assert "keypoints alone" in pages.judged_takes(job(alone, session=name))[0]["left_out"]
