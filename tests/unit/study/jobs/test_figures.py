"""Files and settings of figures: written out for the tiny study."""

from courtside.study import paths
from courtside.study.jobs import figures

SHOT = {"session": "players-tiny", "take": "shot", "calibration": "known18"}
STROKE = {**SHOT, "fusion": "all-robust", "model": "net"}


def test_axes_of_a_condition_are_its_settings_with_several_values(job, studies):
    vary = {"size_px": [[640, 360], [960, 540]], "seed": [1, 2], "stabiliser": [True, False]}
    conditions = {"wide": {"session": "plain-tiny", "vary": vary}}
    study = studies(variations=["wide"], conditions=conditions)
    one = job(study, condition="wide")
    axes = {"x": "width_px", "group": "stabiliser", "n_bridging": 12}
    assert figures.condition_axes(one) == axes
    errors = figures.condition_errors(one)
    assert len(errors) == 8 * 3
    assert errors[0] == "results/wide-0/evaluation/global-n12-o0.csv"


def test_a_condition_of_one_value_is_drawn_over_it(job, studies):
    vary = {"seed": [1, 2], "baseline_deg": [30], "size_px": [[640, 360]]}
    conditions = {"one": {"session": "plain-tiny", "vary": vary}}
    study = studies(variations=["one"], conditions=conditions)
    assert figures.condition_axes(job(study, condition="one"))["x"] == "baseline_deg"


def test_times_are_those_of_every_step_of_structure_from_motion(job):
    folder = "results/plain-tiny/benchmarks"
    assert figures.timings(job(session="plain-tiny")) == [
        f"{folder}/extract_features/all.tsv",
        f"{folder}/match_images/all.tsv",
        f"{folder}/map_images/global-n12-o0.tsv",
        f"{folder}/map_images/incremental-n12-o0.tsv",
        f"{folder}/adjust_network/global-n12-o0.tsv",
        f"{folder}/adjust_network/incremental-n12-o0.tsv",
    ]


def test_a_file_of_each_number_of_bridging_images(job):
    found = figures.of_each_count(job(session="plain-tiny", mapper="global"), paths.TIES)
    assert found == ["results/plain-tiny/sfm/global-n12-o0/ties.npz"]


def test_a_stroke_is_so_many_frames_from_a_time_on(job, studies):
    assert figures.stroke(job(**SHOT), n=3) == {"n_frames": 17, "start_s": None, "n": 3}
    step = {"takes": {"players-tiny/shot": 0.2}, "n_frames": 5, "limit_torso": 0.1}
    study = studies(draw_stroke=step)
    assert figures.stroke(job(study, **SHOT)) == {"n_frames": 5, "start_s": 0.2}


def test_detections_beside_the_skeleton_need_all_that_was_found(job, study):
    folder = "results/players-tiny/takes/shot"
    model = {**STROKE, "model": "blazepose-full"}
    cameras = ("oblique", "back", "mirror")
    assert figures.seen_and_made(job(**model)) == {
        "pose3d": f"{folder}/pose3d/known18/all-robust/blazepose-full.npz",
        "cameras": "results/players-tiny/calibration/known18/cameras.toml",
        "pose2d": [f"{folder}/pose2d/blazepose-full/{camera}.npz" for camera in cameras],
        "shake": [],
        "people": f"{folder}/people/known18/blazepose-full.npz",
        "sync": f"{folder}/sync/known18/cameras.blazepose-full.json",
        "videos": [f"results/virtual/players-tiny/takes/shot/{name}.mp4" for name in cameras],
        "skeleton": study.folder / "skeletons" / "blazepose33.yaml",
        "derived": study.folder / "derived_joints.yaml",
    }


def test_fig_5_shows_each_camera_once(study, studies):
    errors = ["results/players-tiny/evaluation/takes/shot/detection/blazepose-full.csv"]
    assert figures.fig05_errors(study) == errors
    layout = {"take": "players-tiny/shot", "cameras": ["back", "oblique"]}
    twice = studies(draw_badminton_fig05={"layouts": {"a": layout, "b": layout}})
    assert figures.fig05_errors(twice) == errors
    found = figures.fig05_sources(twice)
    assert found[0] == {
        "name": ["players-tiny", "shot", "back"],
        "pose2d": "results/players-tiny/takes/shot/pose2d/blazepose-full/back.npz",
        "video": "results/virtual/players-tiny/takes/shot/back.mp4",
    }
    assert [source["name"][2] for source in found] == ["back", "oblique"]


def test_fig_5_shows_two_takes_of_one_session_each_with_its_video(studies):
    layouts = {
        take: {"take": f"players-tiny/{take}", "cameras": ["back"]} for take in ("shot", "rally")
    }
    both = studies(draw_badminton_fig05={"layouts": layouts})
    found = figures.fig05_sources(both)
    assert [source["name"] for source in found] == [
        ["players-tiny", take, "back"] for take in layouts
    ]
    assert [source["video"] for source in found] == [
        f"results/virtual/players-tiny/takes/{take}/back.mp4" for take in layouts
    ]


def test_cameras_of_every_fusion(job):
    found = figures.fused_cameras(job(**SHOT))
    assert found["two-dlt"] == ("back", "mirror")
    assert found["halfbody"] == ("back", "oblique", "mirror")
