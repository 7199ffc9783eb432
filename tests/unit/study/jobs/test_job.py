"""A job knows what its wildcards name."""

from dataclasses import replace
from pathlib import Path

import pytest

from courtside.study.errors import InputError

REAL = {"session": "walk-4cams-tiny", "take": "balancing"}


def agreeing(study, *words):
    """Return the study whose real person has agreed to these things only."""
    session = study.sessions["walk-4cams-tiny"]
    subjects = {"p1": replace(session.subjects["p1"], consent=words)}
    return replace(study, sessions={"walk-4cams-tiny": replace(session, subjects=subjects)})


def test_wildcards_name_session_take_camera_device_and_network(job, study):
    one = job(**REAL, camera="cam01", model="blazepose-full")
    assert one["camera"] == "cam01"
    assert one.session is study.sessions["walk-4cams-tiny"]
    assert one.take.name == "balancing"
    assert one.camera.crop_px == (0, 0, 1080, 1920)
    assert one.model.skeleton == "blazepose33"
    other = job(session="single-view-tiny", take="claps", device="mocopi")
    assert other.device.kind == "inertial"


def test_the_device_of_a_file_of_all_takes_is_one_of_any_take(job):
    assert job(session="single-view-tiny", device="d415").device.kind == "rgbd"
    with pytest.raises(InputError, match=r"expected a device of .*d415.*, found 'suit'"):
        assert job(session="single-view-tiny", device="suit").device


def test_a_step_has_the_overrides_of_the_session(job):
    assert job(session="plain-tiny").step("extract_features")["first_octave"] == -1
    assert job(session="players-tiny").some("extract_features", ["first_octave"]) == {
        "first_octave": 0
    }


def test_patterns_are_filled_with_wildcards_and_others(job):
    one = job(session="s", camera="left")
    assert one.fill("{session}/{camera}/{take}", camera="right", take="t") == "s/right/t"
    assert one.of_each("{session}/{take}", take=["a", "b"]) == ["s/a", "s/b"]


def test_the_court_and_the_skeleton_are_files_of_the_configuration(job, study):
    assert job(session="plain-tiny").court_file() == study.folder / "courts" / "badminton.yaml"
    assert job(**REAL).court_file() == []
    path = job(**REAL, model="blazepose-full").skeleton_file()
    assert path == study.folder / "skeletons" / "blazepose33.yaml"


def test_joints_are_corrected_of_networks_with_offsets_only(job, study, tmp_path):
    assert job(model="blazepose-full").stages()[-1] == "pose3d_corrected"
    assert job(model="blazepose-static").stages() == ("pose3d", "pose3d_filtered")
    elsewhere = replace(study, folder=Path(tmp_path))
    assert job(elsewhere, model="blazepose-full").stages()[-1] == "pose3d_filtered"


def test_a_take_of_somebody_who_withdrew_is_refused(job, study):
    session = study.sessions["walk-4cams-tiny"]
    subjects = {"p1": replace(session.subjects["p1"], consent=())}
    withdrawn = replace(session, subjects=subjects, takes={}, withheld=session.takes)
    one = job(replace(study, sessions={"walk-4cams-tiny": withdrawn}), **REAL)
    with pytest.raises(InputError, match="expected analysis in the consent of p1, found none"):
        assert one.take


def test_names_that_a_session_does_not_have_are_told_with_the_nearest_one(job):
    where = "walk-4cams-tiny.yaml: expected"
    with pytest.raises(InputError, match=rf"{where} a take of balancing, .*mean 'balancing'\?"):
        assert job(**REAL | {"take": "balance"}).take
    with pytest.raises(InputError, match=rf"{where} a camera of cam01, .* found 'cam1'; did you m"):
        assert job(**REAL, camera="cam1").camera
    with pytest.raises(InputError, match=rf"{where} a device of none, found 'suit'; ask for files"):
        assert job(**REAL, device="suit").device


def test_files_need_the_consent_of_the_persons_in_them(job, study):
    job(**REAL).demand("export")
    refused = agreeing(study, "analysis")
    with pytest.raises(InputError, match=r"expected export in the consent of p1 .* balancing"):
        job(refused, **REAL).demand("export")
    job(refused, **REAL, person="p2").demand("export")  # a file of another person
