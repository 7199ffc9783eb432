"""A take or a person that a step names and no session has is told before any job."""

from dataclasses import replace
from pathlib import Path

import pytest
import yaml

from courtside.study.configuration import named_faults, session_files
from courtside.study.configuration.sessions import Device, Study

PARAMETERS = yaml.safe_load(Path("config/config.yaml").read_text(encoding="utf-8"))
COMPARED = PARAMETERS["compare_sessions"] | {"takes": ["pre", "post"], "measures": None}


def session(name, persons, takes, cameras=("left",), file=None):
    content = {
        "description": "a hall",
        "court": "none",
        "subjects": {person: {} for person in persons},
        "cameras": {camera: {} for camera in cameras},
        "takes": {take: {"videos": dict.fromkeys(cameras, "a.mp4")} for take in takes},
    }
    content |= {"calibration": {"file": file}} if file else {}
    return session_files.session(name, f"{name}.yaml", content, PARAMETERS)


def study(**steps):
    spring, autumn = session("spring", ["alma"], ["pre1"]), session("autumn", ["bert"], ["post1"])
    sessions = {"spring": spring, "autumn": autumn}
    return Study(sessions, {}, {}, PARAMETERS | steps)


def said(one):
    return list(named_faults.find("season.yaml", one))


def overlay(*takes):
    return {"export_overlay_video": PARAMETERS["export_overlay_video"] | {"takes": list(takes)}}


def test_a_take_that_its_session_does_not_have_is_told():
    (line,) = said(study(**overlay("spring/pre1", "spring/pre9", "winter/pre1")))
    assert line == (
        "season.yaml: export_overlay_video.takes: expected one of the takes of session spring, "
        "['pre1'], found spring/pre9; correct the name, or remove it"
    )
    step = {"draw_thesis_fig3": {"take": "autumn/pre1", "sources": ["a", "b"]}}
    (line,) = said(study(**step))
    assert line.startswith("season.yaml: draw_thesis_fig3.take: expected one of the takes of")


def test_a_recorded_session_that_is_to_be_compared_with_the_truth_is_told():
    drawn = {"draw_three_cameras": {"takes": ["spring/pre1", "winter/pre1"]}}
    (line,) = said(study(**drawn))
    assert line == (
        "season.yaml: draw_three_cameras.takes: expected names of virtual sessions, whose truth is "
        "known, found spring/pre1; remove it"
    )
    measured = {"evaluate_racket": PARAMETERS["evaluate_racket"] | {"sessions": ["autumn"]}}
    (line,) = said(study(**measured))
    assert line.startswith("season.yaml: evaluate_racket.sessions: expected names of virtual")
    one = study(**drawn, **measured)
    virtual = {name: replace(each, virtual={"seed": 1}) for name, each in one.sessions.items()}
    assert said(replace(one, sessions=virtual)) == []


def test_a_take_without_any_set_of_cameras_of_table_1_is_told():
    step = PARAMETERS["evaluate_round_trip"] | {"takes": {"spring/pre1": None, "winter/pre1": None}}
    (line,) = said(study(evaluate_round_trip=step | {"fusions": ["three-robust"]}))
    assert line == (
        "season.yaml: evaluate_round_trip.takes: expected takes that one of "
        "evaluate_round_trip.fusions, ['three-robust'], can be made of, found spring/pre1; name "
        "one of its sets of cameras there (`views` of the session), or remove the take"
    )
    one = study(evaluate_round_trip=step | {"fusions": ["three-robust", "all-dlt"]})
    spring = session("spring", ["alma"], ["pre1"], cameras=("left", "right"))
    assert said(replace(one, sessions={"spring": spring})) == []


def test_takes_whose_networks_cannot_be_compared_are_told():
    """BlazePose looks in videos; keypoints of another program are those of the take."""
    spring = session("spring", ["alma"], ["pre1", "pre2"], ("left", "right"), file="Calib.toml")
    imported = {"coco17": {"left": "a", "right": "b"}}
    spring.takes["pre1"] = replace(spring.takes["pre1"], videos={}, pose2d=imported)
    step = PARAMETERS["compare_networks"] | {"sessions": ["spring", "winter"]}
    one = study(compare_networks=step | {"networks": ["coco17", "blazepose-full"]})
    one = replace(one, sessions={"spring": spring}, models={"blazepose-full": None})
    key = "season.yaml: compare_networks.sessions: expected takes with"
    assert said(one) == [
        f"{key} videos, found none in spring/pre1; remove the session, or blazepose-full from "
        "compare_networks.networks",
        f"{key} `pose2d: coco17`, found none in spring/pre2; remove the session, or coco17 from "
        "compare_networks.networks",
    ]


def test_beginnings_of_compared_takes_that_no_take_has_are_told():
    step = PARAMETERS["compare_networks"] | {"sessions": ["spring", "autumn"]}
    step["networks"] = ["a", "b"]
    one = study(compare_networks=step | {"takes": ["mid"]})
    assert said(one) == [
        "season.yaml: compare_networks.takes: expected how names of takes of spring, autumn begin, "
        "['post1', 'pre1'], found mid; correct it, or remove it"
    ]
    elsewhere = step | {"takes": ["mid"], "sessions": ["spring", "winter"]}
    assert said(study(compare_networks=elsewhere)) == []


def test_a_take_without_the_sources_of_the_thesis_figures_is_told():
    step = {"take": "spring/pre1", "sources": ["suit", "bag-depth"]}
    one = study(draw_thesis_fig3=step)
    (line,) = said(one)
    assert line == (
        "season.yaml: draw_thesis_fig3.take: expected a take with devices, found spring/pre1; name "
        "another, or remove the key"
    )
    spring = one.sessions["spring"]
    devices = {"suit": Device("inertial", "a.bvh", "alma"), "d415": Device("rgbd", "a.bag", "alma")}
    take = replace(spring.takes["pre1"], devices=devices)
    one = replace(one, sessions={"spring": replace(spring, takes={"pre1": take})})
    (line,) = said(one)
    assert line == (
        "season.yaml: draw_thesis_fig3.sources: expected sources of spring/pre1, ['suit', "
        "'suit-corrected', 'd415-depth', 'd415-rgb'], found ['bag-depth']; name two of them"
    )
    step["sources"] = ["d415-rgb", "suit-corrected"]
    assert said(one) == []


def test_a_take_without_consent_and_a_value_of_the_default_file_are_not_told():
    one = study(**overlay("spring/pre2"))
    spring = one.sessions["spring"]
    spring = replace(spring, withheld={"pre2": next(iter(spring.takes.values()))})
    assert said(replace(one, sessions=one.sessions | {"spring": spring})) == []
    named = {"walk-4cams": session("walk-4cams", ["p1"], ["another"])}
    assert said(Study(named, {}, {}, PARAMETERS)) == []


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({}, None),
        ({"subject": "carla"}, "subject: expected one of the persons of spring, autumn, "
         "['alma', 'bert'], found carla; correct the name, or the list of sessions"),
        ({"takes": ["pre", "mid"]}, "takes: expected how names of takes of spring, autumn begin, "
         "['post1', 'pre1'], found mid; correct it, or remove it"),
        ({"subject": "carla", "sessions": ["spring", "walk-4cams"]}, None),
        ({"sessions": ["spring", "capture-speed-0"]}, None),
        ({"sessions": ["spri-ng", "autumn"]}, "sessions: expected sessions with a file in "
         "config/sessions, found 'spri-ng'; did you mean 'spring'?"),
        ({"sessions": ["spring", "xy"]}, "sessions: expected sessions with a file in "
         "config/sessions, found 'xy'; correct the name, or remove it"),
        ({"measures": ["neck_distance", "rally_3_time"]}, None),
        ({"measures": ["neck_distence"]}, "measures: expected measures of study.csv, such as "
         "neck_distance, found 'neck_distence'; did you mean 'neck_distance'?"),
        ({"subject": "carla", "sessions": []}, None),
    ],
)  # fmt: skip
def test_what_is_compared_over_sessions_is_known(change, words):
    step = COMPARED | {"subject": "alma", "sessions": ["spring", "autumn"]} | change
    where = "season.yaml: compare_sessions"
    assert said(study(compare_sessions=step)) == ([f"{where}.{words}"] if words else [])


def varied(names, vary):
    conditions = {name: {"session": "spring", "vary": vary} for name in names}
    return study(variations=list(names), conditions=conditions)


def test_conditions_whose_figures_would_have_one_file_are_told():
    (line,) = said(varied(["fast-walk", "slow", "fast_walk"], {"speed_kmh": [1, 6]}))
    assert line == (
        "season.yaml: variations: expected conditions whose figures have different files, found "
        "fast-walk and fast_walk, both results/figures/fast_walk.csv; rename one of these "
        "conditions"
    )
    one = varied(["fast-walk", "fast_walk"], {"speed_kmh": [1, 6]})
    one.parameters["conditions"]["fast_walk"]["vary"] = {"world": [{}, {"clicks": 2}]}
    (line,) = said(one)  # two rules would draw it
    assert "found fast-walk and fast_walk, both results/figures/fast_walk.csv" in line


@pytest.mark.parametrize("name", ["clock-errors", "calibration"])
def test_a_condition_whose_figure_has_the_name_of_another_result_is_told(name):
    (line,) = said(varied([name], {"speed_kmh": [1, 6]}))
    assert line == (
        "season.yaml: variations: expected a condition whose figure has a file of its own, found "
        f"{name}: results/figures/{name.replace('-', '_')}.csv is another result of the study; "
        "rename the condition"
    )


def test_conditions_of_seeds_alone_have_no_figure_and_any_name():
    assert said(varied(["fast-walk", "fast_walk", "calibration"], {"seed": [1, 2]})) == []
