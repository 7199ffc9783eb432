"""What the report is made of: written out for the tiny study."""

from dataclasses import replace
from types import SimpleNamespace

import pytest

from courtside.study import paths
from courtside.study.jobs import report_page

REAL = "results/walk-4cams-tiny/takes/balancing"
WAY = {"calibration": "file", "fusion": "all-robust", "model": "blazepose-full"}


class Output(SimpleNamespace):
    """A picture that a made-up rule draws, as Snakemake's rules have it."""

    def match(self, path):
        return path.endswith(".png")


class DrawAnything(SimpleNamespace):
    """A made-up rule that draws every picture."""

    output = (Output(flags={"report": SimpleNamespace(caption="/far/draw_it.rst")}),)

    def is_producer(self, path):
        return True

    def get_wildcards(self, path):
        return {"stem": path.removesuffix(".png")}


@pytest.fixture(scope="module")
def rules():
    params = {"code": "abc", "step": lambda w: {"of": dict(w.items())}, "source": "d415"}
    return [
        SimpleNamespace(is_producer=lambda path: False),
        DrawAnything(params=params),
    ]


@pytest.fixture(scope="module")
def content(study, rules):
    return report_page.content(study, rules, "workflow/report")


def test_figures_bear_the_caption_and_parameters_of_their_rule(content):
    first = content["figures"][0]
    stem = f"{REAL}/figures/overlay.file.all-robust.blazepose-full"
    assert first == {
        "png": f"{stem}.png",
        "caption": "workflow/report/draw_it.rst",
        "wildcards": {"stem": stem},
        "params": {"step": {"of": {"stem": stem}}, "source": "d415"},
        "session": "walk-4cams-tiny",
        "take": "balancing",
        "links": [
            (f"{stem.removeprefix('results/')}.csv", "numbers (CSV)"),
            (f"{stem.removeprefix('results/')}.pdf", "PDF"),
        ],
    }
    places = {figure["png"]: figure["session"] for figure in content["figures"]}
    assert places["results/figures/badminton_fig12.png"] == ""
    assert places["results/plans/plain-a/map.png"] == "planned sessions"
    assert len(places) == len(content["figures"])


def test_tables_are_those_that_the_study_makes(content, study, rules, studies):
    assert [(table["file"], table["title"]) for table in content["tables"]] == [
        ("results/figures/calibration.csv", "Calibration"),
        ("results/figures/ways.csv", "Ways to calibrate"),
        ("results/figures/players.csv", "Players"),
        ("results/figures/angles.csv", "Joint angles"),
    ]
    alone = report_page.content(studies(sessions=["walk-4cams-tiny"]), rules, "captions")
    assert [table["title"] for table in alone["tables"]] == ["Ways to calibrate"]


def test_a_session_is_told_with_its_first_calibration_and_its_overrides(content):
    real, plain, players, single = content["sessions"]
    assert (real["calibration"], real["mapper"], real["virtual"]) == ("file", None, False)
    assert real["files"] == {
        "quality": {"file": "results/walk-4cams-tiny/calibration/file/quality.json"},
        "checks": [
            "results/walk-4cams-tiny/calibration/file/videos.json",
            "results/walk-4cams-tiny/calibration/file/check.json",
        ],
    }
    assert (plain["calibration"], plain["mapper"], plain["n_images"]) == ("known18", "global", 12)
    assert plain["files"]["model"] == "results/plain-tiny/sfm/global-n12-o0/summary.json"
    assert plain["files"]["static"] == [
        "results/plain-tiny/static/side.csv",
        "results/plain-tiny/static/back.csv",
    ]
    assert plain["overrides"] == {"extract_features": {"first_octave": -1}}
    assert (players["fusion"], players["model"]) == ("all-robust", "blazepose-full")
    assert not players["imported"]
    words = "verdicts on takes and cameras, with pictures"
    assert real["links"] == [("walk-4cams-tiny/pages/quality.html", words)]
    assert single["links"] == []
    assert (single["calibration"], single["takes"][0]["name"]) == (None, "claps")


def test_the_page_for_quality_rests_on_what_the_report_says_of_the_cameras(study, content):
    for told in content["sessions"][:3:2]:
        found = report_page.cameras(study.sessions[told["name"]])
        own = paths.CALIBRATION_QUALITY.format(session=told["name"], calibration="{}")
        ways = [found["calibration"], *found["others"]]
        assert found["files"]["quality"] == {way: own.format(way) for way in ways}
        same = [one | {"quality": {}} for one in (found["files"], told["files"])]
        assert same[0] == same[1]
        assert all(found[key] == told[key] for key in ("calibration", "limits"))


def test_the_number_of_images_is_that_of_the_calibration(study, rules):
    session = study.sessions["plain-tiny"]
    parameters = {**session.parameters, "calibrations": ["sfm-n40"]}
    other = replace(session, parameters=parameters)
    found = report_page.content(replace(study, sessions={"plain-tiny": other}), rules, "captions")
    assert [s["n_images"] for s in found["sessions"]] == [40]


@pytest.mark.parametrize(
    ("ways", "model"),
    [
        (["sfm-n40-o1"], "global-n40-o1"),
        (["known18", "sim3-n12-o2"], "global-n12-o2"),
        (["sfm-n40-o1-people"], "global-n40-o1"),
        (["paper-n40"], None),
        (["known18"], None),
    ],
)
def test_the_structure_from_motion_is_the_one_that_the_calibration_rests_on(study, ways, model):
    session = study.sessions["plain-tiny"]
    sweep = {**session.parameters["sweep"], "n_images": []}
    own = {"calibrations": ways, "take_calibrations": ways, "sweep": sweep}
    players = study.sessions["players-tiny"]
    filmed = {"takes": players.takes, "subjects": players.subjects}
    other = replace(session, parameters={**session.parameters, **own}, **filmed)
    found = report_page._session(study, other)
    summary = model and f"results/plain-tiny/sfm/{model}/summary.json"
    assert found["files"].get("model") == summary
    assert found["mapper"] == (model and "global")


def test_photos_alone_are_told_with_their_model(study, rules):
    session = study.sessions["plain-tiny"]
    sweep = {**session.parameters["sweep"], "n_images": [7], "mappers": ["incremental"]}
    photos = replace(
        session, cameras={}, court_points=None, parameters={**session.parameters, "sweep": sweep}
    )
    assert photos.calibrations() == []
    found = report_page.content(replace(study, sessions={"door": photos}), rules, "captions")
    (session,) = found["sessions"]
    assert session["files"]["model"].endswith("/sfm/incremental-n7-o0/summary.json")
    assert (session["mapper"], session["n_images"]) == ("incremental", 7)


def test_takes_are_told_with_their_measures_errors_and_links(content):
    real, _, players, single = content["sessions"]
    way = "file/all-robust/blazepose-full"
    take = real["takes"][0]
    assert take["files"] == {
        "summary": f"{REAL}/kinematics/{way}.summary.csv",
        "frames": f"{REAL}/kinematics/{way}.frames.csv",
        "cutoffs": f"{REAL}/kinematics/{way}.cutoffs.csv",
        "footwork": f"{REAL}/footwork/{way}.summary.csv",
        "pose3d": f"{REAL}/pose3d/{way}.npz",
        "sync": f"{REAL}/sync/file/cameras.blazepose-full.json",
        "movement": [f"{REAL}/movement/cam0{k}.csv" for k in (1, 2, 3)],
        "quality": {"file": f"{REAL}/quality.csv", "way": WAY},
    }
    short = REAL.removeprefix("results/")
    assert take["links"] == [
        (f"{short}/kinematics/{way}.summary.csv", "summary (CSV)"),
        (f"{short}/kinematics/{way}.frames.csv", "frames (CSV)"),
        (f"{short}/footwork/{way}.steps.csv", "steps (CSV)"),
        (f"{short}/pages/viewer.blazepose-full.html", "3D viewer"),
        *((f"{short}/videos/{way}.cam0{k}.mp4", f"video cam0{k}") for k in (1, 2, 3, 4)),
    ]
    shot, rally = players["takes"]
    folder = "results/players-tiny/evaluation/takes/shot"
    assert shot["files"]["errors"] == f"{folder}/errors/known18.blazepose-full.csv"
    assert shot["files"]["kinematics"] == (
        f"{folder}/kinematics/known18/all-robust/blazepose-full.csv"
    )
    assert "shake" not in shot["files"]
    assert rally["files"]["shake"] == (
        "results/players-tiny/takes/rally/figures/shake.known18.all-robust.blazepose-full.txt"
    )
    assert single["takes"][0]["files"] == {
        "checks": "results/single-view-tiny/takes/claps/sync/devices.blazepose-full.checks.csv"
    }


def test_files_are_all_that_is_named_but_links_and_parameters():
    session = {
        "a": ["results/b.csv", {"c": "results/a.csv"}, "results/b.csv"],
        "caption": "captions/x.rst",
        "words": "of results",
        "links": [("results/no.csv", "no")],
        "link": "results/no.csv",
        "params": {"file": "results/no.csv"},
        "n": 3,
    }
    assert report_page.files(session) == ["captions/x.rst", "results/a.csv", "results/b.csv"]


def test_variations_are_no_session_of_the_report(studies, rules):
    conditions = {"v": {"session": "plain-tiny", "vary": {"seed": [1, 2]}}}
    study = studies(variations=["v"], conditions=conditions)
    assert "v-0" in study.sessions
    names = [s["name"] for s in report_page.content(study, rules, "captions")["sessions"]]
    assert names == ["walk-4cams-tiny", "plain-tiny", "players-tiny", "single-view-tiny"]
