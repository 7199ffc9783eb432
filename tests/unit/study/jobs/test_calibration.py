"""Files and settings of calibrations: written out for the tiny study."""

from dataclasses import replace

import pytest

from courtside.calibration.foreign import colmap, easymocap, opencap
from courtside.study import paths
from courtside.study.errors import InputError
from courtside.study.jobs import calibration

PLAIN = {"session": "plain-tiny"}


def test_files_of_each_fixed_camera_and_of_each_walk(job):
    static = ["results/plain-tiny/static/side.png", "results/plain-tiny/static/back.png"]
    assert calibration.each_fixed(job(**PLAIN), paths.STATIC) == static
    frames = ["results/plain-tiny/frames/walk.csv"]
    assert calibration.each_walk(job(**PLAIN), paths.FRAME_TABLE) == frames


def test_the_size_of_clicked_pictures_is_that_of_the_static_recording_or_of_a_take(job):
    static = ["results/plain-tiny/static/side.png", "results/plain-tiny/static/back.png"]
    assert calibration.of_full_size(job(**PLAIN)) == static
    mixed = calibration.of_full_size(job(session="walk-4cams-tiny"))
    assert [path.rpartition("/")[2] for path in mixed][::3] == ["cam01.png", "cam04.mp4"]


def test_a_mapper_has_its_own_options_and_attempts(job):
    found = calibration.mapping(job(**PLAIN, mapper="global"))
    assert found == {"rule": "even", "seed": 0, "options": {}, "attempts": 6}
    assert calibration.mapping(job(**PLAIN, mapper="incremental"))["attempts"] == 1


def test_clicks_have_the_parameters_of_the_adjustment(job):
    found = calibration.clicks(job(**PLAIN))
    assert found == {"click_sigma_px": 1.75, "click_bias_px": 1.25, "click_loss": 4.0}


def test_crops_are_those_of_cameras_that_have_one(job):
    crop = (0, 0, 1080, 1920)
    found = calibration.crops_px(job(session="walk-4cams-tiny"))
    assert found == {"cam01": crop, "cam02": crop}


@pytest.mark.parametrize(
    ("name", "variant"),
    [
        ("sfm-n12", "global-n12-o0"),
        ("sim3-n12-o2", "global-n12-o2"),
        ("paper-n40", "incremental-n40-o0"),
        ("paper-global-n40", "global-n40-o0"),
    ],
)
def test_ties_are_those_of_the_structure_from_motion_of_a_calibration(job, name, variant):
    found = calibration.ties(job(**PLAIN, calibration=name))
    assert found == f"results/plain-tiny/sfm/{variant}/ties.npz"


def test_lines_are_measured_in_the_pictures_of_fixed_cameras_where_a_calibration_asks(job):
    one = job(**PLAIN, calibration="sfm-n12-lines")
    assert calibration.line_pictures(one) == calibration.each_fixed(one, paths.STATIC)
    assert calibration.line_search(one) == {"search_share": 0.006, "lines": "light"}
    assert calibration.ties(one) == "results/plain-tiny/sfm/global-n12-o0/ties.npz"
    assert calibration.covariance(one).endswith("calibration/sfm-n12-lines/covariance.npz")
    assert calibration.line_pictures(job(**PLAIN, calibration="sfm-n12")) == []


def test_only_adjusted_cameras_have_a_covariance(job):
    found = calibration.covariance(job(**PLAIN, calibration="sfm-n12"))
    assert found == "results/plain-tiny/calibration/sfm-n12/covariance.npz"
    assert calibration.covariance(job(**PLAIN, calibration="known18")) == []
    with pytest.raises(InputError, match="such as file"):
        calibration.covariance(job(**PLAIN, calibration="wrong"))


def test_cameras_of_a_file_have_the_covariance_that_lies_beside_it(job, study):
    real = {"session": "walk-4cams-tiny", "calibration": "file"}
    assert calibration.covariance(job(**real)) == calibration.court_of_file(job(**real)) == []
    session = replace(study.sessions["walk-4cams-tiny"], file_covariance="hall/covariance.npz")
    known = replace(study, sessions={"walk-4cams-tiny": session})
    assert calibration.covariance(job(known, **real)) == "hall/covariance.npz"
    refined = job(known, **real | {"calibration": "file-people"})
    assert calibration.base_covariance(refined) == "hall/covariance.npz"
    assert calibration.covariance(refined) == refined.fill(paths.CAMERA_COVARIANCE)


def test_pictures_of_a_chessboard_are_simulated_or_files(job, study, tmp_path):
    one = job(**PLAIN, camera="side")
    assert calibration.boards(one) == "results/virtual/plain-tiny/boards"
    (tmp_path / "1.png").touch()
    session = study.sessions["plain-tiny"]
    camera = replace(session.cameras["side"], chessboard={"images": str(tmp_path)})
    real = replace(session, virtual=None, cameras={"side": camera})
    one = job(replace(study, sessions={"plain-tiny": real}), **PLAIN, camera="side")
    assert calibration.boards(one) == [str(tmp_path / "1.png")]


def test_a_board_before_all_cameras_has_pictures_and_lenses(job, study, tmp_path):
    (tmp_path / "1.png").touch()
    lenses = tmp_path / "c.toml"
    lenses.touch()
    session = study.sessions["plain-tiny"]

    def of(board):
        made = replace(study, sessions={"plain-tiny": replace(session, board=board)})
        return job(made, **PLAIN)

    held = of({"images": {"side": str(tmp_path), "back": str(tmp_path)}, "lenses": str(lenses)})
    pictures = [str(tmp_path / name) for name in ("1.png", "c.toml")]
    assert calibration.board_files(held) == [*pictures, *pictures, str(lenses)]
    assert calibration.board_lenses(held) == calibration.board_pictures(held) == []
    tracks = of({"corners": "xy.csv"})
    assert calibration.board_files(tracks) == ["xy.csv"]
    assert calibration.board_lenses(tracks) == calibration.each_fixed(tracks, paths.LENS)
    assert calibration.board_pictures(tracks) == calibration.of_full_size(tracks)


def test_a_wand_before_all_cameras_has_points_and_lenses_or_pictures(job, study, tmp_path):
    lenses = tmp_path / "c.toml"
    lenses.touch()
    session = study.sessions["plain-tiny"]

    def of(wand):
        made = replace(study, sessions={"plain-tiny": replace(session, wand=wand)})
        return job(made, **PLAIN)

    tracks = of({"points": "w.csv"})
    assert calibration.wand_files(tracks) == ["w.csv"]
    assert calibration.wand_lenses(tracks) == calibration.known_lenses(tracks)
    assert calibration.wand_pictures(tracks) == calibration.of_full_size(tracks)
    known = of({"points": "w.csv", "lenses": str(lenses)})
    assert calibration.wand_files(known) == ["w.csv", str(lenses)]
    assert calibration.wand_lenses(known) == calibration.wand_pictures(known) == []


def test_only_calibrations_with_a_board_take_its_lenses(job):
    lenses = [f"results/plain-tiny/calibration/lens/{name}.toml" for name in ("side", "back")]
    assert calibration.lenses(job(**PLAIN, calibration="known18-board")) == lenses
    assert calibration.lenses(job(**PLAIN, calibration="known18")) == []


def test_court_points_are_proposed_by_cameras_that_were_adjusted(job):
    found = calibration.proposals(job(**PLAIN))
    assert found == "results/plain-tiny/calibration/sfm-n12/proposals.csv"
    assert calibration.proposals(job(session="players-tiny")) == []


def test_before_the_first_click_painted_lines_propose_points(job, study):
    waiting = replace(study.sessions["plain-tiny"], court_points=None, unclicked="mine.csv")
    one = job(replace(study, sessions={"plain-tiny": waiting}), **PLAIN)
    found = calibration.proposals(one)
    assert found == "results/plain-tiny/calibration/court_lines/proposals.csv"


def test_clicks_are_saved_where_the_session_says_or_in_its_folder_of_data(job, study):
    found = calibration.clicking(job(**PLAIN))
    assert found == {
        "session": "plain-tiny",
        "names": ["side", "back"],
        "targets": {"court_points.csv": "results/virtual/plain-tiny/court_points.csv"},
    }
    session = study.sessions["plain-tiny"]
    for unclicked, path in (("mine.csv", "mine.csv"), (None, "data/plain-tiny/court_points.csv")):
        waiting = replace(session, court_points=None, unclicked=unclicked)
        one = job(replace(study, sessions={"plain-tiny": waiting}), **PLAIN)
        assert calibration.clicking(one)["targets"] == {"court_points.csv": path}


def test_a_calibration_file_is_checked_by_what_cameras_see(job):
    folder = "results/walk-4cams-tiny/takes/balancing"
    cameras = ("cam01", "cam02", "cam03", "cam04")
    (take,) = calibration.checked(job(session="walk-4cams-tiny"))
    assert take == {
        "take": "balancing",
        "pose2d": [f"{folder}/pose2d/blazepose-full/{camera}.npz" for camera in cameras],
        "sync": f"{folder}/sync/file/cameras.blazepose-full.json",
        "people": f"{folder}/people/file/blazepose-full.found.npz",
    }


def test_the_hall_is_seen_in_static_pictures_or_in_the_first_take(job):
    folder = "results/walk-4cams-tiny"
    assert calibration.of_hall(job(session="walk-4cams-tiny"))[2:] == [
        f"{folder}/static/cam03.png",
        f"{folder}/takes/balancing/background/cam04.png",
    ]


def test_the_hall_is_filmed_by_static_recordings_and_in_takes_without_them(job, study):
    folder = "results/walk-4cams-tiny"
    one = job(session="walk-4cams-tiny")
    static, hall = calibration.halls(one)
    assert (static["take"], list(static["pictures"])) == ("", ["cam01", "cam02", "cam03"])
    assert hall["take"] == "balancing"
    assert hall["pictures"]["cam03"] == f"{folder}/static/cam03.png"
    assert hall["pictures"]["cam04"] == f"{folder}/takes/balancing/background/cam04.png"
    filmed = {name: replace(c, static="s.mp4") for name, c in one.session.cameras.items()}
    session = replace(one.session, cameras=filmed)
    assert session.filmed_halls() == {"": ["cam01", "cam02", "cam03", "cam04"]}
    assert replace(session, cameras={"cam01": filmed["cam01"]}).filmed_halls() == {}


def test_scales_are_those_of_cameras_whose_videos_are_scaled(job):
    one = job(session="walk-4cams-tiny")
    assert calibration.scales(one) == {}
    one.session.cameras["cam03"] = replace(one.session.cameras["cam03"], scale=0.5)
    assert calibration.scales(one) == {"cam03": 0.5}
    one.session.cameras["cam03"] = replace(one.session.cameras["cam03"], scale=1.0)


def test_cameras_refined_by_people_rest_on_their_base_and_its_people(job, study):
    one = job(session="walk-4cams-tiny", calibration="file-people")
    base = "results/walk-4cams-tiny/calibration/file/cameras.toml"
    assert calibration.of_base(one, paths.CAMERAS) == base
    assert calibration.base_covariance(one) == []
    assert calibration.base_file(one) == study.sessions["walk-4cams-tiny"].calibration_file
    (take,) = calibration.refining(one)
    assert take["people"].endswith("/balancing/people/file/blazepose-full.found.npz")
    adjusted = job(session="players-tiny", calibration="known-people")
    assert calibration.base_file(adjusted) == []
    assert calibration.base_covariance(adjusted).endswith("/calibration/known/covariance.npz")
    takes = {take["sync"].split("/")[3] for take in calibration.refining(adjusted)}
    assert takes == {"shot", "rally"}


@pytest.mark.parametrize(
    ("base", "judge"), [("file", True), ("board", True), ("wand", False), ("known", False)]
)
def test_clicks_that_a_base_was_fitted_to_do_not_judge_its_refinement(job, base, judge):
    one = job(session="players-tiny", calibration=f"{base}-people")
    assert calibration.unused_clicks(one) == (one.session.court_points if judge else [])


def test_maps_of_refined_cameras_show_their_base_too(job):
    one = job(session="walk-4cams-tiny", calibration="file-people")
    stated = {"rotation_deg": 0.3, "position_m": 0.03, "focal_percent": 0.5}
    stated |= {"principal_point_percent": 0.3, "k1": 0.01}
    assert calibration.error_map(one)["stated"] == calibration.stated(one) == stated
    alone = job(session="players-tiny", calibration="known")
    assert calibration.of_base(alone, paths.CAMERAS) == calibration.base_covariance(alone) == []


def test_people_alone_place_cameras_with_their_heights_and_known_lenses(job, study):
    real = job(session="walk-4cams-tiny", calibration="people")
    session = study.sessions["walk-4cams-tiny"]
    (one,) = calibration.placing(real)
    take = session.takes[one["take"]]
    assert one["heights_m"] == {who: session.subjects[who].height_m for who in take.subjects}
    assert [path.rpartition("/")[2] for path in one["pose2d"]] == [f"{c}.npz" for c in take.cameras]
    assert calibration.known_lenses(real) == []
    offsets = f"{study.models[session.parameters['models'][0]].name}.csv"
    assert calibration.joint_offsets(real) == study.folder / "joint_offsets" / offsets
    other = {**session.parameters, "models": ["body25b"]}
    wanting = replace(study, sessions={session.name: replace(session, parameters=other)})
    assert calibration.joint_offsets(job(wanting, session=session.name)) == []
    assert len(calibration.known_lenses(job(**PLAIN, calibration="people"))) == sum(
        bool(camera.chessboard) for camera in study.sessions["plain-tiny"].cameras.values()
    )


def test_takes_that_refine_cameras_must_be_filmed(job, study):
    session = study.sessions["players-tiny"]
    step = {**session.parameters["refine_cameras"], "takes": ["shot", "nothing"]}
    parameters = {**study.parameters, "refine_cameras": step}
    asking = replace(session, parameters=parameters)
    wanting = replace(study, sessions={"players-tiny": asking}, parameters=parameters)
    one = job(wanting, session="players-tiny")
    one = replace(one, wildcards={**one.wildcards, "calibration": "known-people"})
    said = r"expected filmed takes of session players-tiny, \['shot', .* found \['nothing'\]"
    with pytest.raises(InputError, match=rf"^config/tiny.yaml: refine_cameras.takes: {said}"):
        calibration.refining(one)


@pytest.mark.parametrize(
    ("given", "beside"),
    [
        (".", [*easymocap.FILES, "left.XML", f"Cam0/{opencap.IN_SESSION}", *sorted(colmap.NAMES)]),
        *[(one, sorted(set(easymocap.FILES) - {one})) for one in easymocap.FILES],
        *[(one, sorted(colmap.NAMES - {one})) for one in sorted(colmap.NAMES)],
        ("left.XML", []),
    ],
)
def test_a_calibration_in_several_files_rests_on_each(job, study, tmp_path, given, beside):
    every = {*easymocap.FILES, *colmap.NAMES, "left.XML", f"Cam0/{opencap.IN_SESSION}"}
    for name in (*every, "points3D.bin", "videos/left.mp4", "left.jpg"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).touch()
    session = study.sessions["walk-4cams-tiny"]
    session = replace(session, calibration_file=(tmp_path / given).as_posix())
    other = replace(study, sessions={session.name: session})
    known = {"session": session.name}
    expected = sorted((tmp_path / name).as_posix() for name in beside)
    assert calibration.file_parts(job(other, **known, calibration="file")) == expected
    assert calibration.base_parts(job(other, **known, calibration="file-people")) == expected
    assert calibration.base_parts(job(other, **known, calibration="known-people")) == []


def test_a_calibration_in_one_file_has_no_further_parts(job, study):
    assert calibration.file_parts(job(session="walk-4cams-tiny")) == []
    assert study.sessions["plain-tiny"].calibration_file is None
    assert calibration.file_parts(job(**PLAIN)) == []
