"""What the study makes of each take: written out for the tiny study."""

import fnmatch
from dataclasses import replace
from pathlib import Path

import pytest

from courtside.study.configuration.sessions import Device
from courtside.study.jobs.devices import sources
from courtside.study.jobs.job import Job
from courtside.study.jobs.pages import layers
from courtside.study.provenance import comparison, provenance
from courtside.study.targets import devices, pages, takes, together

REAL = "results/walk-4cams-tiny/takes/balancing"
FORMATS = ("pdf", "png", "csv")


def agreeing(study, *words):
    """Return the study whose real person has agreed to these things only."""
    session = study.sessions["walk-4cams-tiny"]
    subjects = {"p1": replace(session.subjects["p1"], consent=words)}
    sessions = {**study.sessions, session.name: replace(session, subjects=subjects)}
    return replace(study, sessions=sessions)


def test_cameras_with_a_static_recording_are_checked_unless_shake_is_measured(study):
    assert takes.every_check(study) == [
        f"{REAL}/movement/cam01.csv",
        f"{REAL}/movement/cam02.csv",
        f"{REAL}/movement/cam03.csv",
        "results/players-tiny/takes/shot/movement/oblique.csv",
        "results/players-tiny/takes/shot/movement/back.csv",
        "results/players-tiny/takes/shot/movement/mirror.csv",
    ]


def test_every_take_that_fixed_cameras_measure_is_judged(study):
    takes_of = (
        "walk-4cams-tiny/takes/balancing",
        *(f"players-tiny/takes/{t}" for t in ("shot", "rally")),
    )
    assert takes.every_verdict(study) == [f"results/{take}/quality.csv" for take in takes_of]


def test_skeletons_of_every_stage_are_exported(study):
    stages = ("pose3d", "pose3d_filtered", "pose3d_corrected")
    exported = [
        f"{REAL}/{stage}/file/all-robust/blazepose-full.p1.{suffix}"
        for stage in stages
        for suffix in ("trc", "c3d", "csv", "bvh", "glb")
    ]
    joints = f"{REAL}/pose3d_ik/file/all-robust/blazepose-full.p1"
    motion = [f"{joints}.{end}" for end in ("trc", "c3d", "csv", "mot", "osim")]
    motion += [f"{REAL}/motion/file/all-robust/blazepose-full.p1.{end}" for end in ("bvh", "glb")]
    assert takes.every_export(study) == [*exported, *motion]


def test_every_exported_file_has_a_record_and_can_be_compared(study):
    made = takes.every_export(study) + devices.every_device_export(study)
    made += pages.every_overlay_video(study)
    assert {Path(path).suffix for path in made} <= provenance.FINAL
    for path in made:
        unread = any(fnmatch.fnmatch(path, pattern) for pattern in comparison.UNREAD)
        assert unread or Path(path).suffix in {*comparison.READERS, *comparison.TABLED}, path


def test_joints_are_corrected_only_of_networks_with_offsets(studies):
    found = takes.every_export(studies(models=["blazepose-static"]))
    assert len(found) == 10
    assert not any("corrected" in path for path in found)


def test_nothing_is_exported_of_whom_has_not_agreed(study):
    assert takes.every_export(agreeing(study, "analysis", "pictures")) == []


def test_figures_without_consent_to_pictures_show_nobody(study):
    names = ("overlay", "skeletons", "reprojection", "visibility", "kinematics", "footwork")
    figures = [
        f"{REAL}/figures/{name}.file.all-robust.blazepose-full.{suffix}"
        for name in names
        for suffix in FORMATS
    ]
    on_court = [
        f"results/players-tiny/takes/{take}/figures/{name}.known18.all-robust.blazepose-full.{suffix}"
        for take in ("shot", "rally")
        for name in ("rally", "strokes")
        for suffix in FORMATS
    ]
    assert takes.every_figure(study) == figures + on_court
    assert takes.every_figure(agreeing(study, "analysis")) == figures[3:] + on_court


def seen_by(study, *cameras):
    """Return the study whose real take has a device, and videos of these cameras alone."""
    session, device = study.sessions["walk-4cams-tiny"], Device("inertial", "suit.bvh", "p1")
    take = session.takes["balancing"]
    videos = {name: take.videos[name] for name in cameras}
    filmed = replace(take, videos=videos, devices={"suit": device})
    return replace(study, sessions={session.name: replace(session, takes={take.name: filmed})})


@pytest.mark.parametrize("cameras", [(), ("cam01",)])
def test_a_take_without_two_cameras_has_the_outputs_of_its_devices_alone(study, cameras):
    study = seen_by(study, *cameras)
    nothing = (takes.every_export, takes.every_figure, takes.every_shake, takes.every_kinematics)
    nothing += (takes.every_footwork, takes.every_verdict, takes.every_comparison_of_views)
    nothing += (pages.every_people_page, pages.every_quality_page, pages.every_overlay_video)
    assert [every(study) for every in nothing] == [[]] * len(nothing)
    assert together.tabulated_takes(study) == []
    angles = f"{REAL}/motion/devices/suit/blazepose-full.angles.csv"
    assert devices.every_source_angle(study) == [angles]
    assert f"{REAL}/devices/suit.trc" in devices.every_device_export(study)
    assert len(devices.every_device_figure(study)) == 15
    assert len(pages.every_viewer(study)) == 1
    (session,) = study.sessions.values()
    job = Job(study, {"session": session.name, "take": "balancing", "model": "blazepose-full"})
    assert list(sources(job)) == ["suit"]
    assert [layer["name"] for layer in layers(job)] == ["suit"]


def test_compared_sets_are_those_of_which_two_cameras_see_a_take(study):
    there = seen_by(study, "cam01", "cam02")
    (session,) = there.sessions.values()
    wanted = session.parameters | {"compared_fusions": ["two-robust"]}
    for two, n_tables in ((("cam02", "cam03"), 0), (("cam02", "cam01"), 1)):
        own = replace(session, views={"two": two}, parameters=wanted)
        study = replace(there, sessions={session.name: own})
        assert len(takes.every_comparison_of_views(study)) == n_tables
        assert len(takes.every_verdict(study)) == 1


def unfilmed(study):
    """Return the study whose real take has another program's keypoints and no videos."""
    session = study.sessions["walk-4cams-tiny"]
    take = session.takes["balancing"]
    pose2d = {"body25b": {name: f"{name}_json" for name in take.videos}}
    alone = replace(take, videos={}, pose2d=pose2d, rate_hz=60.0)
    sessions = {session.name: replace(session, takes={"balancing": alone})}
    return replace(study, sessions=sessions)


def test_without_videos_only_pictures_are_left_out(study):
    study = unfilmed(study)
    assert takes.every_check(study) == []
    assert takes.every_verdict(study) == [f"{REAL}/quality.csv"]
    assert takes.every_kinematics(study) == [
        f"{REAL}/kinematics/file/all-robust/blazepose-full.summary.csv",
        f"{REAL}/motion/file/all-robust/blazepose-full.angles.csv",
    ]
    drawn = {path.split("/")[-1].split(".")[0] for path in takes.every_figure(study)}
    assert drawn == {"skeletons", "reprojection", "visibility", "kinematics", "footwork"}
    assert pages.every_people_page(study) == pages.every_overlay_video(study) == []
    assert len(pages.every_viewer(study)) == 1


def test_shake_is_drawn_of_steady_takes(study):
    stem = "results/players-tiny/takes/rally/figures/shake.known18.all-robust.blazepose-full"
    assert takes.every_shake(study) == [f"{stem}.{suffix}" for suffix in FORMATS]


def test_measures_of_all_takes_with_cameras(study):
    way, players = "all-robust/blazepose-full", "results/players-tiny/takes"
    stems = [
        (REAL, "file"),
        (f"{players}/shot", "known18"),
        (f"{players}/rally", "known18"),
    ]
    assert takes.every_kinematics(study) == [
        f"{take}/{kind}/{calibration}/{way}.{end}.csv"
        for take, calibration in stems
        for kind, end in (("kinematics", "summary"), ("motion", "angles"))
    ]


def test_footwork_of_all_takes_and_its_errors_of_virtual_ones(study):
    found = takes.every_footwork(study)
    way = "all-robust/blazepose-full"
    assert found[0] == f"{REAL}/footwork/file/{way}.summary.csv"
    virtual = ["shot", "rally"]
    errors = "results/players-tiny/evaluation/takes"
    assert [path for path in found if "evaluation" in path] == [
        f"{errors}/{take}/contacts/known18/{way}.csv" for take in virtual
    ]
    assert len(found) == 5


def test_strokes_of_takes_of_badminton_with_errors_of_virtual_ones(study):
    way, folder = "known18/all-robust/blazepose-full", "results/players-tiny"
    assert takes.every_stroke(study) == [
        path
        for take in ("shot", "rally")
        for path in (
            f"{folder}/takes/{take}/strokes/{way}.csv",
            f"{folder}/evaluation/takes/{take}/strokes/{way}.csv",
            f"{folder}/evaluation/takes/{take}/reactions/{way}.csv",
        )
    ]
    session = replace(study.sessions["players-tiny"], court="tennis")
    elsewhere = replace(study, sessions={**study.sessions, "players-tiny": session})
    assert takes.every_stroke(elsewhere) == []
    assert not [path for path in takes.every_figure(elsewhere) if "players-tiny" in path]


def test_sets_of_cameras_are_compared_in_real_takes(study):
    assert takes.every_comparison_of_views(study) == [f"{REAL}/views/file.blazepose-full.csv"]


@pytest.mark.parametrize(
    ("kind", "names"),
    [
        ("errors", ["errors/known18.blazepose-full.csv"]),
        ("kinematics", ["kinematics/known18/all-robust/blazepose-full.csv"]),
        ("clocks", []),
        (
            "gains",
            [
                "gains/pose3d.known18.blazepose-full.csv",
                "gains/pose3d_corrected.known18.blazepose-full.csv",
            ],
        ),
    ],
)
def test_errors_are_those_of_virtual_takes(study, kind, names):
    folder = "results/players-tiny/evaluation/takes"
    expected = [f"{folder}/{take}/{name}" for take in ("shot", "rally") for name in names]
    assert takes.evaluations(study, kind) == expected


def test_tables_of_a_sessions_first_network_come_first(study):
    session = study.sessions["players-tiny"]
    models = ["blazepose-static", "blazepose-full"]
    two = replace(session, parameters={**session.parameters, "models": models})
    other = replace(study, sessions={**study.sessions, "players-tiny": two})
    found = takes.evaluations(other, "reliability")
    assert [path.split(".")[-2] for path in found] == 2 * models


def test_clocks_are_evaluated_where_cameras_have_no_common_one(study):
    session = study.sessions["players-tiny"]
    apart = {**session.takes, "shot": replace(session.takes["shot"], synchronised=False)}
    other = {**study.sessions, "players-tiny": replace(session, takes=apart)}
    assert takes.evaluations(replace(study, sessions=other), "clocks") == [
        "results/players-tiny/evaluation/takes/shot/clocks/known18.blazepose-full.csv"
    ]
