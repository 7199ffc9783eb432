"""What the study makes of several takes: written out for the tiny study."""

from dataclasses import replace

from courtside.study.targets import takes, together

SHOT = "results/players-tiny/takes/shot"


def test_figures_of_players(study):
    method = "known18.all-robust.blazepose-full"
    stems = [
        f"{SHOT}/figures/badminton_tab01.known18.blazepose-full",
        f"{SHOT}/figures/badminton_fig09.{method}",
        f"{SHOT}/figures/badminton_fig10.{method}",
        f"{SHOT}/figures/badminton_fig11.{method}",
        "results/figures/badminton_fig05",
        f"{SHOT}/figures/three_cameras.known18.blazepose-full",
        "results/figures/reliability",
        "results/figures/archive",
        "results/figures/networks",
    ]
    figures = [f"{stem}.{suffix}" for stem in stems for suffix in ("pdf", "png", "csv")]
    assert together.every_players_figure(study) == [
        *figures,
        "results/figures/players.csv",
        "results/figures/angles.csv",
    ]


def test_a_study_without_the_named_takes_has_no_figure_of_players(studies):
    assert together.every_players_figure(studies(sessions=["plain-tiny"])) == []


def test_layouts_of_fig_5_are_those_whose_take_the_study_has(study, studies):
    assert together.fig05_layouts(study) == {"b": ["players-tiny", "shot", ["oblique", "back"]]}
    assert together.fig05_layouts(studies(sessions=["plain-tiny"])) == {}


def test_takes_of_one_subject_are_compared_over_sessions(study, studies):
    found = together.archived_takes(study)
    assert [row.labels["take"] for row in found] == ["shot", "rally"]
    assert found[0].measures == f"{SHOT}/kinematics/known18/all-robust/blazepose-full.summary.csv"
    assert found[0].pose3d == f"{SHOT}/pose3d_corrected/known18/all-robust/blazepose-full.npz"
    assert found[0].labels == {
        "session": "players-tiny",
        "take": "shot",
        "calibration": "known18",
        "model": "blazepose-full",
    }
    assert "model" not in found[0].joint_labels
    other = {**study.parameters["compare_sessions"], "subject": "p2"}
    assert together.archived_takes(studies(compare_sessions=other)) == []


def test_sessions_are_compared_by_their_own_networks(studies):
    """The table of the study has no rows of another network."""
    one = studies()
    own = one.sessions["players-tiny"]
    own = replace(own, parameters=own.parameters | {"models": ["blazepose-lite"]})
    other = replace(one, sessions=one.sessions | {"players-tiny": own})
    measured = {row["measures_csv"] for row in together.tabulated_takes(other)}
    found = together.archived_takes(other)
    assert {row.labels["model"] for row in found} == {"blazepose-lite"}
    assert measured.issuperset(row.measures for row in found)


def test_the_table_of_the_study_has_measures_of_motion_and_of_feet(study):
    way = "known18/all-robust/blazepose-full"
    rows = [one for one in together.tabulated_takes(study) if one["labels"]["take"] == "shot"]
    measured = [f"{SHOT}/{kind}/{way}.summary.csv" for kind in ("kinematics", "footwork")]
    assert [one["measures_csv"] for one in rows] == measured
    assert [one["camera_errors"] for one in rows] == [True, False]
    assert {one["quality_csv"] for one in rows} == {f"{SHOT}/quality.csv"}
    assert rows[1]["provenance"] == f"run/provenance/{measured[1].removeprefix('results/')}.json"
    feet = {one["measures_csv"] for one in together.tabulated_takes(study)} & set(
        takes.every_footwork(study)
    )
    assert len(feet) == 3


def test_networks_are_compared_take_by_take(study, studies):
    assert together.compared_takes(study) == []
    step = {**study.parameters["compare_networks"], "sessions": ["walk-4cams-tiny", "absent"]}
    found = together.compared_takes(studies(compare_networks=step))
    assert [row.labels["model"] for row in found] == ["blazepose-full", "blazepose-static"]


def test_networks_are_compared_in_takes_of_one_task(study, studies):
    """Takes of several tasks are no repeats of one movement."""
    step = {**study.parameters["compare_networks"], "sessions": ["players-tiny"]}
    assert len({row.labels["take"] for row in compared(studies, step | {"takes": None})}) > 1
    assert {row.labels["take"] for row in compared(studies, step | {"takes": ["sh"]})} == {"shot"}


def compared(studies, step):
    return together.compared_takes(studies(compare_networks=step))


def test_a_take_with_two_calibrations_is_one_repeat(study, studies):
    step = {**study.parameters["compare_networks"], "sessions": ["players-tiny"]}
    both = studies(take_calibrations=["known18", "known", "file"], compare_networks=step)
    assert both.sessions["players-tiny"].take_calibrations() == ["known18", "known"]
    for found in (together.compared_takes(both), together.archived_takes(both)):
        assert {row.labels["calibration"] for row in found} == {"known18"}


def test_networks_are_evaluated_with_the_truth_or_with_imported_keypoints(study, studies):
    (one,) = together.evaluated_takes(study)
    assert one.errors == ("results/players-tiny/evaluation/takes/shot/detection/blazepose-full.csv")
    assert one.pose3d == f"{SHOT}/pose3d/known18/all-robust/blazepose-full.npz"
    assert one.labels["against"] == "truth" and one.labels["model"] == "blazepose-full"
    assert together.evaluated_takes(studies(sessions=["plain-tiny"])) == []
