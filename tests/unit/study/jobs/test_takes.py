"""Files and settings of takes: written out for the tiny study."""

from dataclasses import replace

import pytest

from courtside.study import paths
from courtside.study.errors import InputError
from courtside.study.execution import verdicts
from courtside.study.jobs import figures, takes

RALLY = {"session": "players-tiny", "take": "rally"}
SHOT = {"session": "players-tiny", "take": "shot"}
REAL = {"session": "walk-4cams-tiny", "take": "balancing"}


def test_files_of_each_camera_of_a_take(job):
    found = takes.each_camera(job(**SHOT, model="net"), paths.POSE2D)
    folder = "results/players-tiny/takes/shot/pose2d/net"
    assert found == [f"{folder}/{name}.npz" for name in ("oblique", "back", "mirror")]


def test_a_file_of_every_take_of_a_session(job):
    found = takes.every_take(job(session="players-tiny", model="net"), "{take}/{model}/{x}", x="y")
    assert found == ["shot/net/y", "rally/net/y"]


def test_clocks_that_a_take_states_are_told_by_name(job, study):
    session = study.sessions["players-tiny"]
    stated = {"back": {"offset_s": 1.0}, "phone": {"offset_s": 2.0}}
    changed = replace(session, takes={"shot": replace(session.takes["shot"], clocks=stated)})
    one = job(replace(study, sessions={"players-tiny": changed}), **SHOT)
    assert takes.clocks(one, one.take.videos) == {"back": {"offset_s": 1.0}}


def test_shake_is_taken_out_of_steady_takes_but_for_comparison(job):
    way = {"calibration": "known18", "model": "net", "fusion": "all-robust"}
    folder = "results/players-tiny/takes/rally/pose2d_steadied/known18/net"
    shake = [f"{folder}/{name}.csv" for name in ("oblique", "back", "mirror")]
    assert takes.shake(job(**RALLY, **way)) == shake
    assert takes.shake(job(**RALLY, **way | {"fusion": "all-unsteady"})) == []
    assert takes.shake(job(**SHOT, **way)) == []
    back = job(**RALLY, **way, camera="back")
    assert takes.shake(back) == [shake[1]] and takes.knocks(back) == []
    assert takes.measured_shake(back) == "results/players-tiny/takes/rally/shake/back.csv"


def test_knocks_that_people_show_are_taken_out_of_every_take(job):
    shot = job(**SHOT, calibration="known-people", model="net", camera="back")
    folder = "results/players-tiny/takes/shot/pose2d_steadied/known-people/net"
    assert takes.knocks(shot) == "results/players-tiny/calibration/known-people/knocks.csv"
    assert takes.keypoints_2d(shot)[1] == f"{folder}/back.npz"
    assert takes.shake(shot) == [f"{folder}/back.csv"] and takes.measured_shake(shot) == []


def test_steady_takes_are_measured_from_steadied_keypoints_but_for_comparison(job):
    way, names = {"calibration": "known18", "model": "net"}, ("oblique", "back", "mirror")
    folder = "results/players-tiny/takes"
    steadied = [f"{folder}/rally/pose2d_steadied/known18/net/{name}.npz" for name in names]
    seen = [f"{folder}/rally/pose2d/net/{name}.npz" for name in names]
    assert takes.keypoints_2d(job(**RALLY, **way)) == steadied  # of clocks and people
    assert takes.keypoints_2d(job(**RALLY, **way, fusion="two-robust")) == steadied
    assert takes.keypoints_2d(job(**RALLY, **way, fusion="all-unsteady")) == seen
    still = [f"{folder}/shot/pose2d/net/{name}.npz" for name in names]
    assert takes.keypoints_2d(job(**SHOT, **way)) == still


@pytest.mark.parametrize(
    ("name", "used", "rule"),
    [
        ("all-robust", ["oblique", "back", "mirror"], "robust"),
        ("two-dlt", ["back", "mirror"], "dlt"),
        ("two-unsteady", ["back", "mirror"], "robust"),
        ("halfbody", ["back", "oblique", "mirror"], "halfbody"),
    ],
)
def test_a_fusion_is_a_set_of_cameras_and_a_rule(job, name, used, rule):
    assert takes.fusion(job(**SHOT, fusion=name)) == {"used": used, "rule": rule}


def test_fusions_of_a_session_are_the_exported_ones_and_those_compared(job):
    names = ["all-robust", "two-dlt", "halfbody", "three-robust", "three-dlt"]
    one = job(**SHOT, calibration="known18", model="net")
    assert one.every_fusion() == names
    folder = "results/players-tiny/takes/shot/pose3d/known18"
    assert takes.every_fused(one) == [f"{folder}/{name}/net.npz" for name in names]


def test_a_fusion_that_is_exported_and_compared_is_judged_once(job, studies):
    one = job(
        studies(compared_fusions=["two-dlt", "all-robust"]),
        **SHOT,
        calibration="known18",
        model="net",
    )
    assert one.every_fusion().count("all-robust") == 1


def test_fusions_of_a_take_are_those_of_cameras_that_see_it(job, study):
    session = study.sessions["players-tiny"]
    seen = {name: f"{name}.mp4" for name in ("oblique", "mirror")}  # two is back and mirror
    apart = {**session.takes, "shot": replace(session.takes["shot"], videos=seen)}
    of = replace(study, sessions={session.name: replace(session, takes=apart)})
    one = job(of, **SHOT, calibration="known18", model="blazepose-full")
    compared = [name for name in one.every_fusion() if name not in session.fusions()]
    assert "all-robust" in one.every_fusion()
    assert not {"two-dlt", "halfbody"} & set(compared)
    assert set(figures.fused_cameras(one)) == set(one.every_fusion())
    assert set(map(tuple, figures.fused_cameras(one).values())) == {("oblique", "mirror")}
    assert {way["labels"]["fusion"] for way in takes.judged(one)} == {"all-robust"}
    assert {fusion for _, fusion in one.judged_stages()} == set(one.every_fusion())
    with pytest.raises(InputError, match=r"takes\.shot: expected enough .* halfbody .*, found obl"):
        takes.fusion(job(of, **SHOT, fusion="halfbody"))


def test_sexes_are_those_of_a_take_or_of_the_whole_session(job, study):
    assert takes.sexes(job(**SHOT)) == {"p1": "m"}
    assert takes.sexes(job(session="players-tiny")) == {"p1": "m", "p2": "f"}
    session = study.sessions["players-tiny"]
    unstated = {**session.subjects, "p1": replace(session.subjects["p1"], sex="other")}
    other = replace(session, subjects=unstated)
    one = job(replace(study, sessions={"players-tiny": other}), **SHOT)
    assert takes.sexes(one) == {"p1": None}


def test_people_are_recorded_or_virtual(job):
    assert takes.recorded(job(**REAL)) and not takes.recorded(job(**SHOT))


def test_what_is_stated_of_persons_is_by_person_of_a_take(job, study):
    assert takes.stated(job(**SHOT), "mass_kg") == {"p1": 74}
    session = study.sessions["players-tiny"]
    unstated = {**session.subjects, "p1": replace(session.subjects["p1"], mass_kg=None)}
    other = replace(session, subjects=unstated)
    one = job(replace(study, sessions={"players-tiny": other}), **SHOT)
    assert takes.stated(one, "mass_kg") == {"p1": None}


def test_files_for_other_programs_are_made_of_a_stage_with_consent(job, study):
    way = {"calibration": "file", "fusion": "all-robust", "model": "net"}
    folder = "results/walk-4cams-tiny/takes/balancing"
    one = job(**REAL, **way, stage="pose3d_filtered")
    assert takes.exported(one) == f"{folder}/pose3d_filtered/file/all-robust/net.npz"
    assert takes.exported(job(**REAL, **way)) == f"{folder}/pose3d/file/all-robust/net.npz"
    session = study.sessions["walk-4cams-tiny"]
    subjects = {"p1": replace(session.subjects["p1"], consent=("analysis",))}
    refusing = replace(study, sessions={session.name: replace(session, subjects=subjects)})
    with pytest.raises(InputError, match="expected export"):
        takes.exported(job(refusing, **REAL, **way))
    with pytest.raises(InputError, match="expected pictures"):
        takes.blur_faces(job(refusing, **REAL))


def test_faces_are_blurred_in_real_sessions(job):
    assert takes.blur_faces(job(**REAL))
    assert not takes.blur_faces(job(**SHOT))


def test_tables_of_a_network_are_there_or_not(job, study):
    known = job(**SHOT, model="blazepose-full")
    found = takes.known_of_network(known, paths.ERRORS_CSV)
    assert found == study.folder / "joint_errors" / "blazepose-full.csv"
    assert takes.known_of_network(job(**SHOT, model="net"), paths.OFFSETS_CSV) == []


def test_sightings_are_those_of_the_take(job, study, tmp_path):
    session = study.sessions["players-tiny"]
    seen = ({"take": "rally", "camera": "back"}, {"camera": "front"})
    subjects = {**session.subjects, "p1": replace(session.subjects["p1"], seen=seen)}
    csv = tmp_path / "people.csv"
    changed = replace(session, subjects=subjects, people=str(csv))
    of = replace(study, sessions={"players-tiny": changed})
    assert takes.sightings(job(of, **RALLY)) == [
        ("p1", {"camera": "back"}),
        ("p1", {"camera": "front"}),
    ]
    assert takes.sightings(job(of, **SHOT)) == [("p1", {"camera": "front"})]
    assert takes.people_csv(job(of, **SHOT)) == []  # not saved yet
    csv.touch()
    assert takes.people_csv(job(of, **SHOT)) == str(csv)
    assert takes.people_csv(job(**SHOT)) == []


def test_a_take_is_judged_in_each_way_in_which_it_is_measured(job, study):
    one = job(**REAL)
    ways = takes.judged(one)
    assert [way["labels"]["calibration"] for way in ways] == one.session.take_calibrations()
    first, folder = ways[0], "results/walk-4cams-tiny/takes/balancing"
    assert first["labels"] == {
        "calibration": "file",
        "fusion": "all-robust",
        "model": "blazepose-full",
    }
    assert first["pose3d"] == f"{folder}/pose3d/file/all-robust/blazepose-full.npz"
    assert first["pose2d"][0] == f"{folder}/pose2d/blazepose-full/cam01.npz"
    calibration = "results/walk-4cams-tiny/calibration/file"
    assert first["quality"] == f"{calibration}/quality.json"
    assert (first["check"], first["court_check"]) == (f"{calibration}/check.json", "")
    assert first["heights_m"] == {"p1": None}
    shot = takes.judged(job(**SHOT))
    assert not any(way["check"] for way in shot)
    assert {way["heights_m"]["p1"] for way in shot} == {1.84}


def test_only_a_take_that_failed_is_judged_in_each_run(job, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert takes.failed_before(job(**REAL)) == 0
    path = tmp_path / paths.QUALITY.format(**REAL)
    path.parent.mkdir(parents=True)
    head = ",".join([*verdicts.WAY, *verdicts.COLUMNS])
    for word in verdicts.ORDER:
        path.write_text(f"{head}\nfile,r,net,all,all,whole,,,,{word},,Words.\n", encoding="utf-8")
        assert (takes.failed_before(job(**REAL)) > 0) == (word == "failed")
