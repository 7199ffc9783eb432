"""What the study makes of calibrations: written out for the tiny study."""

from dataclasses import replace

from courtside.study.targets import calibration


def test_every_session_is_calibrated_in_the_ways_that_it_has_recordings_for(study):
    assert calibration.every_calibration(study) == [
        "results/walk-4cams-tiny/calibration/file/cameras.toml",
        *(
            f"results/plain-tiny/calibration/{way}/cameras.toml"
            for way in (
                *("sfm-n12", "sim3-n12", "paper-global-n12"),
                *("known18", "known8", "known18-board", "dlt8"),
            )
        ),
        "results/players-tiny/calibration/known18/cameras.toml",
        "results/players-tiny/calibration/known/cameras.toml",
    ]


def test_the_errors_of_the_calibration_study_are_those_of_sessions_with_a_walk(study):
    assert [session.name for session in calibration.filmed_for_calibration(study)] == ["plain-tiny"]
    assert calibration.every_evaluation(study) == [
        "results/plain-tiny/evaluation/global-n12-o0.csv",
        "results/plain-tiny/evaluation/incremental-n12-o0.csv",
        "results/plain-tiny/evaluation/known.csv",
    ]


def test_the_figures_of_the_calibration_study(study):
    found = calibration.every_study_figure(study)
    stems = [
        "results/figures/court_points.badminton",
        "results/plain-tiny/figures/badminton_fig08",
        "results/plain-tiny/figures/coverage",
        "results/plain-tiny/figures/growth",
        "results/plain-tiny/figures/badminton_fig06.global",
        "results/plain-tiny/figures/badminton_fig06.incremental",
        "results/plain-tiny/figures/error_map.sfm-n12",
        "results/players-tiny/figures/error_map.known",
        "results/figures/badminton_fig12",
    ]
    figures = [f"{stem}.{suffix}" for stem in stems for suffix in ("pdf", "png", "csv")]
    assert found == [*figures, "results/figures/calibration.csv"]


def test_without_a_session_of_the_calibration_study_there_is_no_table(studies):
    study = studies(sessions=["walk-4cams-tiny"])
    assert calibration.every_study_figure(study) == []
    assert calibration.every_evaluation(study) == []


def test_variations_are_evaluated_and_those_with_a_figure_are_not_in_the_table(studies):
    seeds = {"session": "plain-tiny", "vary": {"seed": [1, 2], "walk_seed": [3]}}
    speeds = {"session": "plain-tiny", "vary": {"speed_kmh": [1, 2], "stabiliser": [True]}}
    study = studies(
        variations=["re-seeded", "fast-er"], conditions={"re-seeded": seeds, "fast-er": speeds}
    )
    assert calibration.drawn_conditions(study) == {"fast_er": "fast-er"}
    assert [s.name for s in calibration.varied(study, "fast-er")] == ["fast-er-0", "fast-er-1"]
    assert [s.name for s in calibration.swept(study)] == ["plain-tiny"]
    tabulated = [session.name for session in calibration.tabulated(study)]
    assert tabulated == ["plain-tiny", "re-seeded-0", "re-seeded-1"]
    assert "results/figures/fast_er.png" in calibration.every_study_figure(study)
    assert "results/fast-er-1/evaluation/known.csv" in calibration.every_evaluation(study)


def test_worlds_have_a_figure_of_their_own_and_are_not_in_the_table(studies):
    sweep = {"n_images": [12], "n_offsets": 1, "mappers": ["global"]}
    wrong = {
        "session": "plain-tiny",
        "vary": {"world": [{}, {"lens": 1}], "walk_seed": [3]},
        "override": {"calibrations": ["sfm-n12"], "sweep": sweep},
    }
    study = studies(variations=["wrong-er"], conditions={"wrong-er": wrong})
    assert calibration.drawn_conditions(study) == {}
    assert calibration.world_conditions(study) == {"wrong_er": "wrong-er"}
    assert [session.name for session in calibration.tabulated(study)] == ["plain-tiny"]
    assert "results/figures/wrong_er.csv" in calibration.every_study_figure(study)
    assert study.sessions["wrong-er-1"].virtual["world"] == {"lens": 1}
    assert study.sessions["wrong-er-1"].calibrations() == ["sfm-n12"]


def test_a_racket_is_measured_with_global_models_of_one_number_of_images(study, studies):
    assert calibration.racket_sessions(study) == ["plain-tiny"]
    models = calibration.racket_models(study, study.sessions["plain-tiny"])
    assert [variant.name for variant in models] == ["global-n12-o0"]
    step = {**study.parameters["evaluate_racket"], "n_images": 40}
    assert calibration.racket_sessions(studies(evaluate_racket=step)) == []


def test_walks_without_fixed_cameras_become_models_only(study):
    assert calibration.every_photo_model(study) == []
    alone = replace(study.sessions["plain-tiny"], cameras={})
    assert calibration.every_photo_model(replace(study, sessions={"plain-tiny": alone})) == [
        "results/plain-tiny/sfm/global-n12-o0/summary.json",
        "results/plain-tiny/sfm/incremental-n12-o0/summary.json",
    ]


def test_calibration_files_that_are_used_are_checked(study):
    assert calibration.every_file_check(study) == [
        "results/walk-4cams-tiny/calibration/file/videos.json",
        "results/walk-4cams-tiny/calibration/file/check.json",
    ]
    session = study.sessions["walk-4cams-tiny"]
    empty = replace(session, takes={}, static_points=None)
    videos, check = calibration.every_file_check(study)
    (own,) = set(calibration.warning_files(empty)) - {videos}
    assert own == "results/walk-4cams-tiny/calibration/file/quality.json"
    assert calibration.file_checks(empty) == [videos]
    assert calibration.file_checks(replace(empty, static_points="points.csv")) == [videos, check]
    unused = replace(session, parameters=session.parameters | {"take_calibrations": []})
    assert calibration.file_checks(unused) == []
    assert calibration.file_checks(study.sessions["players-tiny"]) == []


def test_painted_lines_check_a_file_where_all_cameras_film_the_court(study):
    session = study.sessions["walk-4cams-tiny"]
    on_court = replace(session, court="badminton")
    assert calibration.file_checks(on_court) == [
        "results/walk-4cams-tiny/calibration/file/videos.json",
        "results/walk-4cams-tiny/calibration/file/court.json",
        "results/walk-4cams-tiny/calibration/file/check.json",
    ]
    empty = replace(on_court, takes={}, static_points=None)
    assert calibration.file_checks(empty) == [
        "results/walk-4cams-tiny/calibration/file/videos.json"
    ]
    filmed = {name: replace(one, static="s.mp4") for name, one in session.cameras.items()}
    assert calibration.file_checks(replace(empty, cameras=filmed)) == [
        "results/walk-4cams-tiny/calibration/file/videos.json",
        "results/walk-4cams-tiny/calibration/file/court.json",
    ]


def test_errors_of_a_session_are_of_each_structure_from_motion_and_of_known_points(study):
    assert calibration.every_error([study.sessions["plain-tiny"]]) == [
        "results/plain-tiny/evaluation/global-n12-o0.csv",
        "results/plain-tiny/evaluation/incremental-n12-o0.csv",
        "results/plain-tiny/evaluation/known.csv",
    ]
