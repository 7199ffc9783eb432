"""What is compared with truth, and how it is labelled: written out for the tiny study."""

from dataclasses import replace
from pathlib import Path

import pytest

from courtside.study import paths
from courtside.study.jobs import evaluation
from courtside.study.targets import together

SHOT = {"session": "players-tiny", "take": "shot", "calibration": "known18"}
NET = {**SHOT, "model": "blazepose-static"}
PLAIN = {"session": "plain-tiny"}
CLICKS = {"click_sigma_px": 1.75, "click_bias_px": 1.25, "click_loss": 4.0}
TRUE = "results/virtual/players-tiny/takes"


def test_recorded_takes_are_compared_with_the_imported_keypoints_that_are_named(job, study):
    assert evaluation.reference(job(**SHOT)) == []
    take = {"session": "walk-4cams-tiny", "take": "balancing"}
    step = {"evaluate_networks": {"takes": {"walk-4cams-tiny/balancing": "body25b"}}}
    named = replace(study, parameters=study.parameters | step)
    found = evaluation.reference(job(named, **take))
    folder = "results/walk-4cams-tiny/takes/balancing/pose2d/body25b"
    assert found == [f"{folder}/cam0{at}.npz" for at in (1, 2, 3, 4)]


def test_networks_have_a_truth_where_they_have_skeletons(study):
    takes = together.evaluated_takes(study)
    assert evaluation.compared_truths(takes) == [f"{TRUE}/shot/truth.npz"]
    assert evaluation.compared_truths([replace(takes[0], pose3d=None)]) == []


def test_all_calibrations_are_put_side_by_side(study):
    ways = {(one["session"], one["calibration"]): one for one in evaluation.ways(study)}
    real = ways["walk-4cams-tiny", "file"]
    assert (real["truth"], real["court"], real["base"]) == ([], "", "")
    pose3d = "takes/balancing/pose3d/file/all-robust/blazepose-full.npz"
    assert real["skeletons"] == [f"results/walk-4cams-tiny/{pose3d}"]
    plain = ways["plain-tiny", "sim3-n12"]
    assert plain["truth"] == "results/virtual/plain-tiny/truth.npz"
    assert plain["court"].endswith("courts/badminton.yaml") and plain["skeletons"] == []


def test_skeletons_of_every_stage_and_fusion_are_compared_and_labelled(job):
    fusions = ["all-robust", "two-dlt", "halfbody", "three-robust", "three-dlt"]
    stages = ["pose3d", "pose3d_filtered"]
    folder = "results/players-tiny/takes/shot"
    assert evaluation.skeletons(job(**NET)) == [
        f"{folder}/{stage}/known18/{fusion}/blazepose-static.npz"
        for stage in stages
        for fusion in fusions
    ]
    labels = evaluation.skeleton_labels(job(**NET))
    assert labels[0] == {**NET, "stage": "pose3d", "fusion": "all-robust"}
    assert [row["fusion"] for row in labels] == fusions * 2


def test_stated_errors_are_judged_in_the_fusion_that_is_exported(job):
    folder = "results/players-tiny/takes/shot"
    stages = ["pose3d", "pose3d_filtered"]
    assert evaluation.exported_skeletons(job(**NET)) == [
        f"{folder}/{stage}/known18/all-robust/blazepose-static.npz" for stage in stages
    ]
    assert evaluation.exported_measures(job(**NET), paths.MEASURES) == (
        f"{folder}/kinematics/known18/all-robust/blazepose-static.summary.csv"
    )
    assert evaluation.exported_labels(job(**NET)) == [{**NET, "stage": one} for one in stages]


def test_offsets_are_fitted_on_every_virtual_take_with_its_true_cameras(study):
    found = evaluation.fitted_takes(study, "net")
    sessions = [Path(take["session_truth"]).parent.name for take in found]
    virtual = {name: len(one.takes) for name, one in study.sessions.items() if one.virtual}
    assert {name: sessions.count(name) for name in virtual} == virtual
    shot = next(take for take in found if "/players-tiny/takes/shot/" in take["truth"])
    folder = "results/players-tiny/takes/shot/pose2d/net/{}.npz"
    assert shot["pose2d"] == [folder.format(c) for c in ("oblique", "back", "mirror")]
    session = study.sessions["players-tiny"]
    sexes = {name: session.subjects[name].sex for name in session.takes["shot"].subjects}
    assert shot["sex_of"] == sexes and set(sexes.values()) <= {"m", "f", None}


def test_pairs_of_fusions_are_those_that_a_session_has(job):
    found = evaluation.pairs(job(**NET))
    assert found == [("three-robust", "three-dlt"), ("three-robust", "halfbody")]


def test_labels_are_some_wildcards_and_more(job):
    found = evaluation.chosen(job(**NET), ("session", "model"), stage="pose3d")
    assert found == {"session": "players-tiny", "model": "blazepose-static", "stage": "pose3d"}


def test_a_table_says_the_command_that_made_it():
    assert evaluation.estimated_by(["dev", "near"], "net", "results/x.csv") == (
        "Estimated by: "
        "snakemake --config sessions=[dev,near] variations=[] models=[net] -- results/x.csv"
    )


def test_errors_of_a_structure_from_motion_are_labelled_with_it(job, study):
    one = job(**PLAIN, mapper="global", n_images="12", offset="0")
    found = evaluation.sfm_errors(one)
    draws = study.parameters["evaluate_calibration"]
    assert found["labels"] == {
        "session": "plain-tiny",
        "preset": "plain",
        "layout": "a",
        "width_px": 480,
        "mapper": "global",
        "n_bridging": "12",
        "offset": "0",
    }
    assert found["clicks"] == {
        "n_draws": draws["n_draws"],
        "seed": draws["seed"],
        "preset": "plain",
        "session": "plain-tiny",
    }
    assert {key: found[key] for key in CLICKS} == CLICKS
    assert found["sets"] == draws["sets"]
    assert found["strengths"] == [1, 3]  # the session's own


def test_variations_are_labelled_with_what_varies_but_the_size_twice(job, study):
    session = study.sessions["plain-tiny"]
    condition = {"condition": "small", "size_px": [640, 360], "speed_kmh": 2}
    virtual = {**session.virtual, "size_px": [640, 360]}
    varied = replace(session, condition=condition, virtual=virtual)
    one = job(replace(study, sessions={"plain-tiny": varied}), **PLAIN)
    labels = evaluation.known_errors(one)["labels"]
    assert labels == {
        "session": "plain-tiny",
        "preset": "plain",
        "layout": "a",
        "width_px": 640,
        "condition": "small",
        "speed_kmh": 2,
    }


def test_known_points_need_no_bias_nor_loss_of_clicks(job):
    found = evaluation.known_errors(job(**PLAIN))
    assert set(found) == {"labels", "clicks", "strengths", "sets", "click_sigma_px"}


def test_lenses_are_evaluated_where_every_camera_has_a_board(job):
    lenses = [f"results/plain-tiny/calibration/lens/{name}.toml" for name in ("side", "back")]
    assert evaluation.lenses(job(**PLAIN)) == lenses
    assert evaluation.lenses(job(session="players-tiny")) == []


def test_a_racket_is_measured_with_its_own_draws(job):
    assert evaluation.racket_ties(job(**PLAIN)) == ["results/plain-tiny/sfm/global-n12-o0/ties.npz"]
    found = evaluation.racket(job(**PLAIN))
    assert found["clicks"]["n_draws"] == 12
    assert (found["length_m"], found["tips_px"]) == (0.674, [0.7, 1.8])
    assert not {"sets", "strengths"} & set(found)
    assert {key: found[key] for key in CLICKS} == CLICKS


@pytest.mark.parametrize(
    ("n_images", "step", "strengths"),
    [
        ("12", {"strengths_for": [40]}, [1]),
        ("40", {"strengths_for": [40]}, [1, 2, 3]),
        ("12", {}, [1, 2, 3]),
    ],
)
def test_clicks_scatter_more_for_some_numbers_of_images_alone(job, n_images, step, strengths):
    one = job(**PLAIN, mapper="global", n_images=n_images, offset="0")
    draws = {"n_draws": 3, "seed": 0, "sets": ["all"], "click_strengths": [1, 2, 3], **step}
    known = one.session.parameters | {"evaluate_calibration": draws}
    sessions = {"plain-tiny": replace(one.session, parameters=known)}
    one = replace(one, study=replace(one.study, sessions=sessions))
    assert evaluation.sfm_errors(one)["strengths"] == strengths


def test_table_1_is_of_the_sets_of_cameras_that_a_session_names(job):
    folder = "results/players-tiny/takes/shot/pose3d/known18"
    found = evaluation.round_trip_skeletons(job(**NET))
    assert found == [
        f"{folder}/two-robust/blazepose-static.npz",
        f"{folder}/three-robust/blazepose-static.npz",
    ]
    assert evaluation.round_trip(job(**NET)) == {
        "joints": ["left_wrist", "right_wrist"],
        "derived_joints": ["neck"],
        "n_frames": 17,
        "published_width": 3840,
        "start_s": None,
    }


def test_a_wrong_world_is_labelled_by_its_effect_and_strength(study, job):
    session = study.sessions["plain-tiny"]
    expected = [
        ({}, ("none", 0)),
        ({"lens": 0}, ("none", 0)),
        ({"lens": 2, "court": 0}, ("lens", 2)),
        ({"lens": 1, "court": 1}, ("together", 1)),
    ]
    for world, found in expected:
        varied = replace(session, condition={"condition": "worlds", "world": world})
        one = job(replace(study, sessions={"plain-tiny": varied}), **PLAIN)
        labels = evaluation.known_errors(one)["labels"]
        assert (labels["effect"], labels["strength"]) == found
        assert "world" not in labels
