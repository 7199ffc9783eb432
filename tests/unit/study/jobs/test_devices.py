"""Files and settings of devices: written out for the tiny study and for takes made up of it."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from courtside.records.devices.clocks import Clock
from courtside.study import paths
from courtside.study.configuration import sessions
from courtside.study.configuration.sessions import Device
from courtside.study.errors import InputError
from courtside.study.jobs import devices

CLAPS = {"session": "single-view-tiny", "take": "claps", "model": "blazepose-full"}
FOLDER = "results/single-view-tiny/takes/claps"


def of_devices(study, **found):
    """Return the tiny study whose take has other devices."""
    session = study.sessions["single-view-tiny"]
    take = replace(session.takes["claps"], devices=found)
    other = replace(session, takes={"claps": take})
    return replace(study, sessions={**study.sessions, "single-view-tiny": other})


def test_sources_are_what_devices_give_and_the_corrected_ones(job):
    found = devices.sources(job(**CLAPS))
    assert {name: (one.file, one.skeleton, one.device) for name, one in found.items()} == {
        "d415-depth": (f"{FOLDER}/devices/d415-depth.blazepose-full.npz", "blazepose33", "d415"),
        "d415-rgb": (f"{FOLDER}/devices/d415-rgb.blazepose-full.npz", "blazepose33", "d415"),
        "mocopi": (f"{FOLDER}/devices/mocopi.npz", "mocopi27", "mocopi"),
        "mocopi-corrected": (
            f"{FOLDER}/devices/mocopi-corrected.blazepose-full.npz",
            "mocopi27",
            "mocopi",
        ),
    }
    assert list(devices.sources(job(**CLAPS), corrected=False))[-1] == "mocopi"
    files = devices.source_files(job(**CLAPS), corrected=False)
    assert files == [one.file for one in list(found.values())[:3]]
    assert devices.skeletons(job(**CLAPS))["mocopi"] == "mocopi27"


def test_a_depth_camera_gives_no_metric_body_of_other_networks(job):
    found = devices.sources(job(**CLAPS | {"model": "cpm-mobile-14"}))
    assert list(found) == ["d415-depth", "mocopi", "mocopi-corrected"]
    assert found["d415-depth"].skeleton == "cpm14"


def test_a_suit_is_exported_only_where_its_person_agreed(job, study):
    wildcards = CLAPS | {"device": "mocopi"}
    assert devices.exported(job(**wildcards)) == f"{FOLDER}/devices/mocopi.npz"
    session = study.sessions["single-view-tiny"]
    subjects = {name: replace(s, consent=("analysis",)) for name, s in session.subjects.items()}
    silent = replace(study, sessions={session.name: replace(session, subjects=subjects)})
    with pytest.raises(InputError, match="expected export in the consent of"):
        devices.exported(job(silent, **wildcards))
    source = {**CLAPS, "source": "d415-depth"}
    folder = study.folder / "skeletons"
    assert devices.exported_source(job(**source)).endswith("/d415-depth.blazepose-full.npz")
    assert devices.source_skeleton(job(**source)) == folder / "blazepose33.yaml"
    with pytest.raises(InputError, match="expected export in the consent of p1"):
        devices.exported_source(job(silent, **source))


@pytest.mark.parametrize(
    ("function", "asked", "told"),
    [
        (devices.exported, {"device": "d415"}, "a device of mocopi, found 'd415'"),
        (devices.exported_source, {"source": "d415"}, "a source of d415-depth, d415-rgb, mocopi,"),
        (devices.source_skeleton, {"source": "d415"}, "a source of d415-depth, d415-rgb, mocopi,"),
        (devices.source, {"source": "d415"}, "a source of d415-depth, d415-rgb, mocopi,"),
    ],
)
def test_a_file_of_no_suit_or_source_is_told(job, function, asked, told):
    with pytest.raises(InputError, match=f"single-view-tiny.yaml: expected {told}"):
        function(job(**CLAPS, **asked))


def test_fixed_cameras_are_the_first_source(job, study):
    session = study.sessions["players-tiny"]
    suit = {"suit": Device("inertial", "m.bvh", "p1")}
    worn = replace(session, takes={"shot": replace(session.takes["shot"], devices=suit)})
    wildcards = {"session": "players-tiny", "take": "shot", "model": "blazepose-full"}
    one = job(replace(study, sessions={"players-tiny": worn}), **wildcards)
    assert list(devices.sources(one)) == ["cameras", "suit", "suit-corrected"]
    folder = "results/players-tiny/takes/shot"
    assert devices.fused(one) == (
        f"{folder}/pose3d_corrected/known18/all-robust/blazepose-full.npz"
    )
    assert devices.vision_file(one) == f"{folder}/devices/cameras.blazepose-full.npz"

    fitted = devices.fitted(one)
    assert fitted["cameras"] == f"{folder}/pose3d_ik/known18/all-robust/blazepose-full.npz"
    assert list(fitted) == ["suit", "suit-corrected", "cameras"]
    assert devices.compared_sources(one)[-1] == f"{folder}/devices/cameras.blazepose-full.npz"


def test_the_model_is_fitted_with_the_errors_of_each_kind_of_source(job):
    one = job(**CLAPS)
    stated = one.step("fit_source")["sigma_m"]
    assert devices.source_sigmas(one) == {
        "d415-depth": stated["depth"],
        "d415-rgb": stated["rgb"],
        "mocopi": stated["inertial"],
        "mocopi-corrected": stated["corrected"],
    }
    found = devices.fitting(job(**CLAPS, source="mocopi-corrected"))
    assert found == {
        "max_gap_s": 0.2,
        "cutoff_hz": one.step("filter_motion")["cutoff_hz"],
        "person": "p1",
        "height_m": 1.84,
        "sigma_m": stated["corrected"],
    }
    assert devices.fitted(one)["d415-rgb"] == (
        f"{FOLDER}/pose3d_ik/devices/d415-rgb/blazepose-full.npz"
    )
    compared = devices.compared_angles(one)
    assert compared["person"] == "p1" and compared["devices"] == devices.clocks(one)


def test_errors_that_are_not_stated_are_told_in_one_line(job, study):
    other = of_devices(study, suit=Device("other", "m.csv", "p1"))
    with pytest.raises(
        InputError, match=r"^fit_source\.sigma_m: expected .*'other', .* suit "
    ) as e:
        devices.source_sigmas(job(other, **CLAPS))
    assert "\n" not in str(e.value)


def test_bodies_and_body_frames_of_all_sources(job):
    frames = devices.bodies(job(**CLAPS), paths.BODY_FRAME)
    names = ("d415-depth", "d415-rgb", "mocopi", "mocopi-corrected")
    assert frames == [f"{FOLDER}/body/{name}.blazepose-full.json" for name in names]
    assert len(devices.bodies(job(**CLAPS))) == 4


def test_a_device_brings_its_skeleton(job, study):
    path = devices.skeleton_file(job(**CLAPS, device="mocopi"))
    assert path == study.folder / "skeletons" / "mocopi27.yaml"


def test_only_depth_cameras_have_times_of_colour_pictures(job, study):
    found = devices.colour_frames(job(**CLAPS, device="d415"))
    assert found == f"{FOLDER}/devices/d415.frames.csv"
    phone = of_devices(study, phone=Device("rgb", "p.mp4", "p1"))
    assert devices.colour_frames(job(phone, **CLAPS, device="phone")) == []


def test_clocks_belong_to_devices_and_a_corrected_source_has_that_of_its_own(job):
    owners = {"d415-depth": "d415", "d415-rgb": "d415", "mocopi": "mocopi"}
    assert devices.clocks(job(**CLAPS), corrected=False) == owners
    corrected = job(**CLAPS, source="mocopi-corrected")
    assert devices.alignment(corrected) == {
        "skeleton": "mocopi27",
        "devices": {**owners, "mocopi-corrected": "mocopi"},
        "stated": [],
    }
    assert devices.event_files(corrected) == [
        f"{FOLDER}/sync/events.blazepose-full.json",
        f"{FOLDER}/devices/mocopi-corrected.blazepose-full.events.json",
    ]
    assert devices.take_clocks(job(**CLAPS)) == f"{FOLDER}/sync/devices.blazepose-full.json"


def test_stated_clocks_are_against_the_source_that_is_the_reference(job, study):
    """They are stated against the first camera; here, no calibration lets it measure the take."""
    session = study.sessions["single-view-tiny"]

    def stated(videos, **clocks):
        take = replace(session.takes["claps"], videos=videos, clocks=clocks)
        other = replace(session, takes={"claps": take})
        own = replace(study, sessions={**study.sessions, session.name: other})
        return devices.stated_clocks(job(own, **CLAPS))

    d415, mocopi = {"offset_s": -1.0, "drift_ppm": 40.0}, {"offset_s": 0.36, "uncertainty_s": 0.01}
    filmed = {"left": "left.mp4", "right": "right.mp4"}
    found = stated(filmed, d415=d415, mocopi=mocopi, left={"offset_s": 0.0})
    assert list(found) == ["mocopi"]  # d415 is the reference
    clock = Clock(**found["mocopi"])
    assert clock.uncertainty_s == 0.01
    at_s = np.array([0.0, 100.0])  # of the camera
    own_s, other_s = (Clock(**one).from_reference(at_s) for one in (d415, mocopi))
    np.testing.assert_allclose(clock.from_reference(own_s), other_s, atol=1e-9)
    assert stated(filmed, mocopi=mocopi) == {}  # nothing tells the clock of the d415
    assert stated({}, mocopi=mocopi) == {"mocopi": mocopi}


def test_inertial_devices_are_corrected_by_a_depth_camera(job):
    assert devices.vision(job(**CLAPS)) == "d415-depth"
    assert devices.correctable(job(**CLAPS)) == ["mocopi"]
    sigma_m = job(**CLAPS).step("correct_inertial")["sigma_m"]["depth"]
    assert devices.correction(job(**CLAPS, device="mocopi")) == {
        "device": "mocopi",
        "vision_device": "d415-depth",
        "sigma_m": sigma_m,
    }


def test_without_vision_nothing_is_corrected(job, study):
    alone = of_devices(study, suit=Device("inertial", "m.bvh", "p1"))
    one = job(alone, **CLAPS, device="suit")
    assert devices.vision(one) is None
    assert list(devices.sources(one)) == ["suit"]
    with pytest.raises(InputError, match=r"takes\.claps: expected fixed cameras or a depth camera"):
        devices.vision_file(one)


def test_a_suit_of_another_kind_is_corrected_with_its_own_skeleton(job, study, monkeypatch):
    monkeypatch.setattr(sessions, "SUITS", ("inertial", "other"))
    monkeypatch.setitem(sessions.SKELETONS, "other", "other15")
    suit, depth = Device("other", "m.csv", "p1"), Device("rgbd", "d.bag", "p1")
    one = job(of_devices(study, suit=suit, d415=depth), **CLAPS, device="suit")
    skeletons = devices.skeletons(one)
    assert next(iter(skeletons)) == "d415-depth"
    assert skeletons["suit"] == skeletons["suit-corrected"] == "other15"
    assert devices.skeleton_file(one) == study.folder / "skeletons" / "other15.yaml"
    assert devices.correctable(one) == ["suit"]


def test_names_of_devices_do_not_make_them_cameras(job, study):
    suit, skeletons = Device("inertial", "m.bvh", "p1"), Device("nuitrack", "n.csv", "p1")
    named = {"suit-cameras": suit, "nuitrack-depth": skeletons}
    alone = job(of_devices(study, **named), **CLAPS)
    assert devices.vision(alone) is None and devices.correctable(alone) == []
    beside = job(of_devices(study, **named, d415=Device("rgbd", "d.bag", "p1")), **CLAPS)
    assert devices.vision(beside) == "d415-depth"


def test_only_the_fixed_cameras_are_no_source_of_the_export_rule():
    """A device may be called `cameras2`."""
    text = (Path(__file__).parents[4] / "workflow" / "rules" / "devices.smk").read_text()
    rule = text.partition("rule export_source:")[2]
    pattern = re.search(r'source=rf"(.*)"', rule)[1].replace("{NAME}", "[a-z0-9][a-z0-9_-]*")
    path = re.compile(rf"({pattern})\.blazepose-full\.bvh")
    assert path.fullmatch("cameras2.blazepose-full.bvh")
    assert path.fullmatch("cameras-rgb.blazepose-full.bvh")
    assert not path.fullmatch("cameras.blazepose-full.bvh")
    assert not path.fullmatch("suit-corrected.blazepose-full.bvh")


def test_persons_and_kinds_of_devices(job, study):
    assert job(**CLAPS).take.person_of_devices == "p1"
    assert devices.kinds(job(**CLAPS)) == {"d415": "rgbd", "mocopi": "inertial"}
    assert devices.all_kinds(study) == {"d415": "rgbd", "mocopi": "inertial"}


def test_events_are_by_found_clocks_or_by_each_own(job):
    common = f"{FOLDER}/sync/devices.blazepose-full.events.csv"
    assert devices.events(job(**CLAPS, clocks="devices")) == common
    assert devices.events(job(**CLAPS, clocks="events")) == (
        f"{FOLDER}/sync/events.blazepose-full.csv"
    )


def test_skeletons_side_by_side_are_each_drawn_once(job):
    names = [path.stem for path in devices.plates(job(**CLAPS))]
    assert names == ["blazepose33", "mocopi27", "nuitrack19", "cpm14"]


def test_truth_is_that_of_virtual_takes(job, study):
    paths_csv = (
        "results/single-view-tiny/evaluation/takes/claps/sources/blazepose-full.true_paths.csv"
    )
    assert job(**CLAPS).true_file(paths.TRUE_PATHS) == paths_csv
    assert devices.thesis_truth(study) == paths_csv
    real = replace(study.sessions["single-view-tiny"], virtual=None)
    study = replace(study, sessions={"single-view-tiny": real})
    assert job(study, **CLAPS).true_file(paths.TRUE_PATHS) == []
    assert devices.thesis_truth(study) == []


def test_arcs_of_the_thesis(study, studies):
    arcs = f"{FOLDER}/body/arcs.blazepose-full.distortion.csv"
    assert devices.thesis_file(study, "distortion") == arcs
    with pytest.raises(InputError, match="expected a take of the study, found single-view-tiny"):
        devices.thesis_file(studies(sessions=["plain-tiny"]), "paths")
