"""The configuration that is committed has no fault; a bad one reports all of its own."""

import copy
import math
import shutil
from pathlib import Path

import pytest
import yaml

from courtside.study.configuration import configuration, yaml_files
from courtside.study.errors import InputError

CONFIG = Path(__file__).parents[4] / "config"
SESSION = {
    "description": "a hall",
    "court": "none",
    "subjects": {"p1": None},
    "cameras": {"left": None, "right": {"crop_px": [0, 0, 100, 50]}},
    "calibration": {"file": "cal.toml"},
    "takes": {"t1": {"videos": {"left": "l.mp4", "right": "r.mp4"}}},
}


@pytest.fixture
def folder(tmp_path):
    """Return a copy of config/ with a session `hall` whose files exist."""
    shutil.copytree(CONFIG, tmp_path / "config")
    for name in ("cal.toml", "l.mp4", "r.mp4"):
        (tmp_path / name).touch()
    return tmp_path / "config"


def load(folder, session=None, **changes):
    (folder / "sessions" / "hall.yaml").write_text(yaml.safe_dump(session or SESSION))
    alone = {"sessions": ["hall"], "variations": []}
    config = yaml_files.read(CONFIG / "config.yaml") | alone | changes
    return configuration.load(config, "config/config.yaml", folder, root=folder.parent)


def faults(folder, session=None, **changes):
    with pytest.raises(InputError) as caught:
        load(folder, session, **changes)
    assert all("\n" not in line for line in caught.value.lines)
    return caught.value.lines


def changed(*keys, value):
    session = copy.deepcopy(SESSION)
    inner = session
    for key in keys[:-1]:
        inner = inner[key]
    inner[keys[-1]] = value
    return session


@pytest.mark.parametrize("name", ["config", "tiny", "full"])
def test_the_committed_configuration_has_no_fault(name):
    config = yaml_files.read(CONFIG / "config.yaml") | yaml_files.read(CONFIG / f"{name}.yaml")
    study = configuration.load(config, f"config/{name}.yaml", CONFIG)
    variations = [name for name in study.sessions if study.sessions[name].condition]
    assert list(study.sessions) == config["sessions"] + variations
    assert len(variations) == sum(
        math.prod(map(len, config["conditions"][name]["vary"].values()))
        for name in config["variations"]
    )


def test_every_committed_session_has_no_fault():
    config = yaml_files.read(CONFIG / "config.yaml")
    config["sessions"] = [path.stem for path in (CONFIG / "sessions").glob("*.yaml")]
    study = configuration.load(config, "config/config.yaml", CONFIG)
    assert len(study.sessions) >= 2


def test_a_session_becomes_records(folder):
    session = load(folder).sessions["hall"]
    assert session.takes["t1"].subjects == ("p1",)
    assert session.cameras["right"].crop_px == (0, 0, 100, 50)
    assert session.court is None
    assert session.blur_faces
    assert session.calibration_camera_names() == {"left": "left", "right": "right"}


def test_an_override_changes_one_key_and_keeps_the_others(folder):
    session = SESSION | {"override": {"triangulate": {"max_error_px": 40}}}
    study = load(folder, session)
    ours, common = study.sessions["hall"].parameters["triangulate"], study.parameters["triangulate"]
    assert ours == common | {"max_error_px": 40}
    assert "max_error_px" not in common


def test_all_faults_of_all_files_come_at_once(folder):
    (folder / "sessions" / "gym.yaml").write_text("description: 3\ncourts: none\n")
    steps = yaml_files.read(CONFIG / "config.yaml")
    found = faults(
        folder,
        changed("takes", "t1", "videos", "centre", value="c.mp4"),
        sessions=["hall", "gym", "nowhere"],
        models=["blazepose-full", "resnet"],
        draw_overlay=steps["draw_overlay"],
    )
    text = "\n".join(found)
    for part in ("resnet", "nowhere", "gym.yaml: description", "did you mean 'court'?", "'centre'"):
        assert part in text
    assert len(found) >= 6


@pytest.mark.parametrize(
    ("changes", "parts"),
    [
        ({"fusions": ["all-robust", "all-robust"]}, ["fusions", "entries that differ"]),
        ({"draw_overlay": {"n_frame": 3}}, ["draw_overlay", "did you mean 'n_frames'?"]),
        ({"draw_overlay": {"n_frames": 0}}, ["draw_overlay.n_frames", "at least 1", "found 0"]),
        ({"draw_overlay": {"n_frames": "x"}}, ["draw_overlay.n_frames", "a whole number", "'x'"]),
        ({"compare_networks": {"min_subjects": 1}}, ["min_subjects", "at least 2", "found 1"]),
        ({"sessions": ["../hall"]}, ["sessions.0", "'../hall'"]),
        ({"sessions": ["hall; ls"]}, ["sessions.0"]),
        ({"sessions": ["hall\n"]}, ["sessions.0"]),
        ({"sessions": ["external"]}, ["sessions", "'external'; rename it"]),
    ],
)
def test_a_fault_of_the_study_names_key_and_value(folder, changes, parts):
    found = faults(folder, **changes)
    assert any(all(part in line for part in ["config/config.yaml", *parts]) for line in found)


@pytest.mark.parametrize(
    ("session", "parts"),
    [
        (changed("takes", "t1", "videos", "left", value="gone.mp4"), ["videos.left", "gone.mp4"]),
        (
            changed("takes", "t1", "videos", "left", value="{a}/l.mp4"),
            ["videos.left: expected a path from", "without { and }, found '{a}/l.mp4'"],
        ),
        (changed("subjects", "p1", value={"weight": 66}), ["'weight'; did you mean 'mass_kg'?"]),
        (changed("takes", "t1", "fps", value=60), ["found 'fps'; did you mean 'rate_hz'?"]),
        (changed("takes", "t1", "trim_s", value=[3, 1]), ["trim_s", "start before the stop"]),
        (changed("takes", "t1", "subjects", value=["p2"]), ["subjects", "'p2'"]),
        (changed("takes", "t1", "videos", value={"left": "l.mp4"}), ["videos", "at least 2"]),
        (changed("court", value="squash"), ["court", "'squash'; correct the name, or describe"]),
        (changed("court", value="badmington"), ["found 'badmington'; did you mean 'badminton'?"]),
        (
            changed("takes", "t1", "videos", "lefft", value="l.mp4"),
            ["videos: expected one of ['left', 'right'], found 'lefft'; did you mean 'left'?"],
        ),
        (
            changed("subjects", "p1", value={"consent": ["analyse"]}),
            ["found 'analyse'; did you mean 'analysis'?"],
        ),
        (changed("subjects", "p1", value={"height_m": 174}), ["height_m", "at most 2.5", "174"]),
        (changed("cameras", "left", value={"crop": [0, 0, 1, 1]}), ["did you mean 'crop_px'?"]),
        (changed("takes", "Take 1", value={}), ["takes", "lower-case letters"]),
        (
            changed("override", value={"triangulat": {}}),
            ["override", "did you mean 'triangulate'?"],
        ),
        (changed("override", value={"triangulate": {"min_views": 1}}), ["min_views", "at least 2"]),
        (
            changed("calibration", "file", value="results/external/pose2sim/nothing.toml"),
            ["calibration.file", "member of external.yaml"],
        ),
    ],
)
def test_a_fault_of_a_session_names_key_and_value(folder, session, parts):
    found = faults(folder, session)
    assert any(all(part in line for part in ["hall.yaml", *parts]) for line in found), found


def test_a_model_must_fit_its_artefact_and_skeleton(folder):
    models = yaml_files.read(CONFIG / "models.yaml")
    models["blazepose-full"]["skeleton"] = "octopus"
    models["blazepose-full"]["landmarks"]["sha256"] = "0" * 64
    (folder / "models.yaml").write_text(yaml.safe_dump(models))
    text = "\n".join(faults(folder))
    assert "blazepose-full.skeleton" in text
    assert "blazepose-full.landmarks" in text


def test_a_single_video_needs_a_network_with_a_metric_body(folder):
    session = changed("takes", "t1", "devices", value={"phone": {"file": "l.mp4"}})
    assert load(folder, session).sessions["hall"].takes["t1"].devices["phone"].kind == "rgb"
    (line,) = faults(folder, session, models=["cpm-mobile-14"])
    assert "hall.yaml: takes.t1.devices.phone: expected a network with a metric body" in line
    assert "found cpm-mobile-14" in line
    load(folder, session | {"override": {"models": ["blazepose-full"]}}, models=["cpm-mobile-14"])


def test_a_depth_camera_needs_a_network_even_beside_imported_keypoints(folder):
    for name in ("left_json", "right_json"):
        (folder.parent / name).mkdir()
    (folder.parent / "d.bag").touch()
    take = SESSION["takes"]["t1"] | {"devices": {"d415": {"file": "d.bag"}}}
    take["pose2d"] = {"body25b": {"left": "left_json", "right": "right_json"}}
    session = changed("takes", "t1", value=take) | {"override": {"models": ["body25b"]}}
    (line,) = faults(folder, session)
    assert "hall.yaml: takes.t1.devices.d415: expected a network" in line
    assert "found body25b; name one first" in line
    load(folder, session | {"override": {"models": ["cpm-mobile-14", "body25b"]}})


def test_cameras_of_another_session_are_made_or_there(folder):
    path = "results/players-b/calibration/sfm-n40/cameras.toml"
    borrowed = changed("calibration", "file", value=path)
    (line,) = faults(folder, borrowed)
    assert line.endswith(
        f"hall.yaml: calibration.file: expected {path} and {path[:-12]}covariance.npz, or a "
        "session of the study that makes them, found neither: session players-b is not one of "
        "`sessions`; add players-b there, or put the files there"
    )
    load(folder, borrowed, sessions=["hall", "players-b"])
    other = changed("calibration", "file", value=path.replace("sfm-n40", "sfm-n12"))
    (line,) = faults(folder, other, sessions=["hall", "players-b"])
    ways = "['sfm-n40', 'sfm-n40-lines', 'known18']"
    assert f"found neither: session players-b has the calibrations {ways}" in line
    assert line.endswith("; add sfm-n12 to them, or put the files there")
    made = (folder.parent / path).parent
    made.mkdir(parents=True)
    (made / "cameras.toml").touch()
    assert len(faults(folder, borrowed)) == 1  # its covariance is missing
    (made / "covariance.npz").touch()
    load(folder, borrowed)


def test_a_fault_in_one_file_hides_no_fault_in_another(folder):
    (folder / "external.yaml").write_text("a: {sha256: x, licence: MIT, members: {../b: y}}\n")
    (folder / "models.yaml").write_text("m: {decoder: heatmap}\n")
    (folder / "sessions" / "gym.yaml").write_text("court: none\ncourt: none\n")
    session = changed("takes", "t1", "videos", "left", value="gone.mp4")
    found = faults(folder, session, sessions=["hall", "gym", "hal"], draw_overlay={"n_frames": 0})
    for part in (
        "external.yaml: a.sha256",
        "external.yaml: a.members: expected a path inside the artefact",
        "external.yaml: a: expected one of",
        "models.yaml: m.decoder",
        "config.yaml: draw_overlay.n_frames",
        "hall.yaml: takes.t1.videos.left",
        "gym.yaml: line 2: expected each key once, found 'court' again",
        "did you mean 'hall'?",
    ):
        assert len([line for line in found if part in line]) == 1, (part, found)
    assert all("expected" in line for line in found)


@pytest.mark.parametrize("name", ["external", "networks", "run", "figures", "virtual"])
def test_a_session_may_not_be_named_like_a_folder_of_results(folder, name):
    shutil.copy(CONFIG / "sessions" / "walk-4cams.yaml", folder / "sessions" / f"{name}.yaml")
    assert len(faults(folder, sessions=[name])) == 1


@pytest.mark.parametrize(
    ("override", "part"),
    [
        ({"filter_motion": {"cutoff_hz": {"head": 6, "trunk": 6, "arms": 6, "legs": 600}}}, "600"),
        ({"filter_motion": {"distance_cutoff_hz": 6}}, "found 'distance_cutoff_hz'"),
        ({"measure_kinematics": {"order": 4}}, "are those of filter_motion"),
        ({"filter_motion": {"max_gap_s": float("nan")}}, "expected a number, found nan"),
        ({"filter_motion": {"max_gap_s": float("inf")}}, "expected a number, found inf"),
        ({"filter_motion": {"max_gap_s": 10**400}}, "expected a number, found 1000"),
        (
            {"filter_motion": {"max_gap_s": 200}},
            "filter_motion.max_gap_s: expected at most 2 (seconds, not milliseconds), found 200",
        ),
        ({"draw_overlay": {"n_frames": 3.0}}, "expected a whole number, found 3.0"),
        ({"draw_overlay": {"n_frames": True}}, "expected a whole number, found True"),
        ({"triangulate": {"fix_sides": "yes"}}, "expected true or false, found 'yes'"),
        ({"detect_pose": [1]}, "expected keys and values, found [1]"),
        ({"sessions": ["hall"]}, "found 'sessions'"),
    ],
)
def test_an_override_obeys_the_rules_of_its_step(folder, override, part):
    found = faults(folder, SESSION | {"override": override})
    assert len(found) == 1
    assert "hall.yaml: override" in found[0]
    assert part in found[0]


@pytest.mark.parametrize(
    ("step", "own"),
    [
        ("filter_motion", {"cutoff_hz": {"arms": 12}}),
        ("map_images", {"attempts": {"incremental": 3}}),
        ("correct_inertial", {"sigma_m": {"depth": 0.05}}),
        ("fit_source", {"sigma_m": {"rgb": {"wrist": 0.07}}}),
    ],
)
def test_an_override_of_one_value_in_a_table_keeps_its_other_values(folder, step, own):
    study = load(folder, SESSION | {"override": {step: own}})
    common, ours = study.parameters[step], study.sessions["hall"].parameters[step]
    usual = common
    while isinstance(own, dict):
        (key,) = own
        assert {**ours, key: None} == {**usual, key: None}
        own, ours, usual = own[key], ours[key], usual[key]
    assert ours == own != usual
    assert study.parameters[step] == yaml_files.read(CONFIG / "config.yaml")[step]


@pytest.mark.parametrize(("key", "value"), [("attempts", 6), ("colmap", {})])
def test_a_study_states_whole_tables(folder, key, value):
    block = yaml_files.read(CONFIG / "config.yaml")["map_images"]
    (line,) = faults(folder, map_images=block | {key: {"global": value}})
    assert line.startswith(f"config/config.yaml: map_images.{key}: expected the key 'incremental'")


def test_an_override_of_one_value_in_a_table_is_checked(folder):
    own = {"filter_motion": {"cutoff_hz": {"arm": 12}}}
    (line,) = faults(folder, SESSION | {"override": own})
    assert "override.filter_motion.cutoff_hz" in line
    assert "did you mean 'arms'?" in line


def test_an_override_of_all_cut_offs_is_taken(folder):
    cutoff_hz = {"head": 1, "trunk": 2, "arms": "residual", "legs": 4}
    study = load(folder, SESSION | {"override": {"filter_motion": {"cutoff_hz": cutoff_hz}}})
    common = study.parameters["filter_motion"]
    ours = study.sessions["hall"].parameters["filter_motion"]
    assert ours == common | {"cutoff_hz": cutoff_hz}


@pytest.mark.parametrize(
    ("session", "part"),
    [
        (changed("calibration", "file", value="cal.toml\n"), "calibration.file"),
        (changed("takes", "t1\n", value=SESSION["takes"]["t1"]), "takes"),
        (changed("takes", "$(ls)", value=SESSION["takes"]["t1"]), "takes"),
        (changed("subjects", "p\n2", value={"height_m": 9}), "subjects.'p\\n2'.height_m"),
        (changed("cameras", "a/b", value=None), "cameras"),
        (changed("cameras", "left", value={"crop_px": [0, 0, 0, 50]}), "cameras.left.crop_px.2"),
        (changed("cameras", "left", value={"crop_px": [0, 0, 50]}), "at least 4 entries"),
        (changed("takes", "t1", "trim_s", value=[float("nan"), 1]), "takes.t1.trim_s.0"),
        (changed("takes", "t1", "trim_s", value=[1, 1]), "takes.t1.trim_s"),
        (changed("court", value="../config"), "court"),
        (
            changed("calibration", "file", value="results/external/../../cal.toml"),
            "member of external.yaml",
        ),
    ],
)
def test_odd_names_paths_and_numbers_are_one_line(folder, session, part):
    assert any(part in line for line in faults(folder, session))


def test_a_skeleton_is_a_name_not_a_path(folder):
    models = yaml_files.read(CONFIG / "models.yaml")
    models["blazepose-full"]["skeleton"] = "../skeletons/blazepose33"
    (folder / "models.yaml").write_text(yaml.safe_dump(models))
    assert "blazepose-full.skeleton" in "\n".join(faults(folder))


def test_every_missing_key_is_named(folder):
    config = yaml_files.read(CONFIG / "config.yaml")
    del config["fusions"], config["filter_motion"]["order"]
    with pytest.raises(InputError) as caught:
        configuration.load(config, "mine.yaml", folder)
    assert [line.split(";")[0] for line in caught.value.lines] == [
        "mine.yaml: top level: expected the key 'fusions', missing ['fusions']",
        "mine.yaml: filter_motion: expected the key 'order', missing ['order']",
    ]


VIRTUAL = {
    "description": "a virtual hall",
    "court": "badminton",
    "cameras": {"side": None, "back": None},
    "walks": {"walk": {}},
    "virtual": {
        "preset": "plain",
        "layout": "a",
        "seed": 1,
        "size_px": [640, 360],
        "walk_frames": 9,
    },
}


def test_a_virtual_session_with_variations_becomes_sessions(folder):
    condition = {"session": "hall", "set": {"walk_frames": 5}, "vary": {"seed": [4, 6]}}
    condition["override"] = {"sweep": {"n_images": [4]}}
    study = load(folder, VIRTUAL, variations=["speed"], conditions={"speed": condition})
    assert list(study.sessions) == ["hall", "speed-0", "speed-1"]
    varied = study.sessions["speed-1"]
    assert (varied.virtual["seed"], varied.virtual["walk_frames"]) == (6, 5)
    assert varied.walks == {"walk": "results/virtual/speed-1/walk.mp4"}
    assert varied.parameters["sweep"]["n_images"] == [4]
    assert varied.parameters["sweep"]["mappers"] == study.parameters["sweep"]["mappers"]


@pytest.mark.parametrize(
    ("condition", "parts"),
    [
        ({"vary": {"sped_kmh": [1]}}, ["conditions.c.vary", "did you mean 'speed_kmh'?"]),
        ({"vary": {"speed_kmh": 4}}, ["conditions.c.vary.speed_kmh", "expected a list, found 4"]),
        ({"vary": {"speed_kmh": []}}, ["conditions.c.vary.speed_kmh", "at least 1 entries"]),
        (
            {"vary": {"speed_kmh": [4, -1]}},
            ["conditions.c.vary.speed_kmh.1", "more than 0, found -1"],
        ),
        ({"vary": {"size_px": [[640, 361]]}}, ["vary.size_px.0.1", "a multiple of 2", "found 361"]),
        ({"vary": {"layout": ["c"]}}, ["vary.layout.0", "one of ['a', 'b'", "found 'c'"]),
        ({"vary": {}}, ["conditions.c.vary", "at least 1 entries"]),
        ({"set": {"boards": 1}}, ["conditions.c.set.boards", "expected true or false, found 1"]),
        ({"set": {"frames": 1}}, ["conditions.c.set", "found 'frames'"]),
        ({"override": {"swep": {}}}, ["conditions.c.override", "did you mean 'sweep'?"]),
        ({"override": {"conditions": {}}}, ["conditions.c.override", "found 'conditions'"]),
        ({"override": {"sweep": {"n_images": [1]}}}, ["override.sweep.n_images.0", "at least 2"]),
        ({"varied": {}}, ["conditions.c", "found 'varied'"]),
    ],
)
def test_a_fault_of_a_condition_names_key_and_value(folder, condition, parts):
    condition = {"session": "hall", "vary": {"seed": [1]}, **condition}
    (line,) = faults(folder, VIRTUAL, variations=["c"], conditions={"c": condition})
    assert all(part in line for part in ["config/config.yaml: conditions.c", *parts]), line


@pytest.mark.parametrize(
    ("step", "key", "value"),
    [
        *[("sweep", "n_images", v) for v in ([1], [5, 5], 5, [2.5])],
        *[("sweep", "n_offsets", v) for v in (0, 4)],
        *[("sweep", "offsets_up_to", v) for v in (-1, "all")],
        *[("sweep", "mappers", v) for v in ([], ["glomap"], ["global", "global"])],
        *[("extract_static", "frames", v) for v in (0, 201)],
        *[("extract_static", "max_shift_px", v) for v in (0, "1 px")],
        *[("extract_static", "max_zoom_percent", v) for v in (0, None)],
        *[("extract_frames", "every_s", v) for v in (0, -1)],
        *[("extract_features", "max_features", v) for v in (99, 65537)],
        *[("extract_features", "first_octave", v) for v in (-2, 3, 0.5)],
        *[("extract_features", "focal_factor", v) for v in (0.1, 11)],
        *[("match_images", "max_ratio", v) for v in (0, 1.1)],
        *[("match_images", "seed", v) for v in (-1, True)],
        *[("map_images", "rule", v) for v in ("odd", None)],
        *[("map_images", "seed", v) for v in (-1, 1.0)],
        *[("map_images", "colmap", v) for v in ({"global": {}, "incremental": {}, "x": {}},)],
        *[("adjust_network", "min_points", v) for v in (2, "20")],
        *[("adjust_network", "tie_sigma", v) for v in (0, -1)],
        *[("adjust_network", "tie_loss", v) for v in (0,)],
        *[("adjust_network", "click_sigma_px", v) for v in (0,)],
        *[("adjust_network", "click_bias_px", v) for v in (-0.1, "x")],
        *[("adjust_network", "click_loss", v) for v in (0, float("inf"))],
        *[("adjust_network", "images_per_part", v) for v in (9, 40.5)],
        *[("adjust_network", "min_angle_deg", v) for v in (-1, 91)],
        *[("adjust_network", "max_error_px", v) for v in (0,)],
        *[("adjust_network", "max_points", v) for v in (19,)],
        *[("adjust_network", "seed", v) for v in (-1,)],
        *[("evaluate_calibration", "n_draws", v) for v in (0,)],
        *[("evaluate_calibration", "seed", v) for v in (-1,)],
        *[("evaluate_calibration", "sets", v) for v in ([], ["All"], ["all", "all"])],
        *[("draw_error_map", "heights_m", v) for v in ([], [0, 1, 2, 3, 4], [-1], [11])],
    ],
)
def test_every_number_of_the_calibration_has_its_limits(folder, step, key, value):
    block = yaml_files.read(CONFIG / "config.yaml")[step]
    found = faults(folder, **{step: block | {key: value}})
    assert len(found) == 1 and found[0].startswith(f"config/config.yaml: {step}.{key}")
    missing = {name: inner for name, inner in block.items() if name != key}
    (line,) = faults(folder, **{step: missing})
    assert f"{step}: expected the key '{key}'" in line
    (line,) = faults(folder, SESSION | {"override": {step: {key: value}}})
    assert f"hall.yaml: override.{step}.{key}" in line


@pytest.mark.parametrize(
    "name",
    [
        "files",
        "sfm",
        "sfm-40",
        "sfm-n0",
        "sfm-n1",
        "paper-n1",
        "known-board",
        "dlt-n8",
        "paper-global",
        "known8-boards",
        "dlt8-board",
    ],
)
def test_a_calibration_that_is_none_is_named(folder, name):
    (line,) = faults(folder, calibrations=[name])
    assert (
        "calibrations.0: expected file, known, board, wand, sfm-nN" in line
        and f"found {name!r}" in line
    )


@pytest.mark.parametrize(
    ("changes", "parts"),
    [
        ({"virtual": {"layout": "a"}}, ["virtual: expected the key 'preset'"]),
        ({"virtual": VIRTUAL["virtual"] | {"size_px": [640]}}, ["virtual.size_px", "at least 2"]),
        (
            {"virtual": VIRTUAL["virtual"] | {"walk_frames": 1}},
            ["virtual.walk_frames", "two or more"],
        ),
        ({"virtual": VIRTUAL["virtual"] | {"speed_kmh": 0}}, ["virtual.speed_kmh", "more than 0"]),
        ({"virtual": VIRTUAL["virtual"] | {"people": -1}}, ["virtual.people", "at least 0"]),
        ({"virtual": VIRTUAL["virtual"] | {"baseline_deg": 181}}, ["baseline_deg", "at most 180"]),
        ({"virtual": VIRTUAL["virtual"] | {"static_frames": -1}}, ["static_frames", "at least 0"]),
        ({"virtual": VIRTUAL["virtual"] | {"stabilizer": True}}, ["did you mean 'stabiliser'?"]),
        (
            {"virtual": VIRTUAL["virtual"] | {"world": {"lens": 3}}},
            ["virtual.world.lens: expected at most 2 (strength: 0 off, 1 realistic, 2 twice)"],
        ),
        (
            {"virtual": VIRTUAL["virtual"] | {"world": {"flikker": 1}}},
            ["virtual.world: expected keys of", "did you mean 'flicker'?"],
        ),
        ({"virtual": VIRTUAL["virtual"] | {"world": {"court": "5 mm"}}}, ["world.court", "number"]),
        ({"walks": {"walk": {"vido": "w.mp4"}}}, ["walks.walk", "did you mean 'video'?"]),
        ({"walks": {"walk": {"video": "w", "images": "i"}}}, ["walks.walk", "found {"]),
        ({"walks": {"Walk": {}}}, ["walks: expected", "lower-case letters"]),
        ({"cameras": {"side": {"chessboard": {"images": "b"}}}}, ["chessboard: expected the key"]),
        (
            {
                "cameras": {
                    "side": {"chessboard": {"images": "b", "inner_corners": [7, 2], "square_m": 1}}
                }
            },
            ["chessboard.inner_corners.1", "at least 3"],
        ),
        (
            {"cameras": {"side": {"chessboard": {"images": "b", "inner_corners": [5, 5]}}}},
            ["cameras.side.chessboard.inner_corners: expected entries that differ", "5 again"],
        ),
        (
            {
                "cameras": {
                    "side": {"chessboard": {"images": "b", "inner_corners": [7, 4], "square_m": 60}}
                }
            },
            ["chessboard.square_m", "at most 1", "found 60"],
        ),
        ({"court_points": ""}, ["court_points"]),
    ],
)
def test_a_fault_of_a_virtual_session_names_key_and_value(folder, changes, parts):
    found = faults(folder, VIRTUAL | changes)
    assert any(all(part in line for part in ["hall.yaml: ", *parts]) for line in found), found


@pytest.mark.parametrize(
    ("override", "parts"),
    [
        ({"take_calibrations": ["sfm-n41"]}, ["take_calibrations", "['file']", "sfm-n41"]),
        ({"take_calibrations": ["file-people"]}, ["take_calibrations", "in both lists"]),
        ({"fusions": ["three-robust"]}, ["fusions", "three-robust", "`views`"]),
    ],
)
def test_takes_that_nothing_measures_are_a_fault(folder, override, parts):
    (found,) = faults(folder, SESSION | {"override": override})
    assert all(part in found for part in ["hall.yaml: ", *parts])


@pytest.mark.parametrize(
    ("key", "names", "found"),
    [
        (
            "take_calibrations",
            ["file", "file-people"],
            "`calibrations`, ['file'], found file-people",
        ),
        ("fusions", ["all-robust", "lc-robust"], "['all', 'left_centre'], found lc-robust"),
        ("compared_fusions", ["halfbody"], "['all', 'left_centre'], found halfbody"),
    ],
)
def test_a_name_that_nothing_has_is_told_in_a_sessions_own_list(folder, key, names, found):
    session = SESSION | {"views": {"left_centre": ["left", "right"]}}
    override = {"calibrations": ["file"], key: names}
    (line,) = faults(folder, session | {"override": override})
    assert f"hall.yaml: override.{key}: expected " in line and found in line
    # The lists of a study serve all its sessions.
    load(folder, session | {"override": {"calibrations": ["file"]}}, **{key: names})
    override[key] = {"take_calibrations": ["file"]}.get(key, ["all-robust", "left_centre-dlt"])
    load(folder, session | {"override": override})


def test_a_variation_is_not_asked_for_the_calibrations_of_takes(folder):
    own = {"calibrations": ["known18"], "take_calibrations": ["known18"]}
    condition = {"session": "hall", "vary": {"seed": [4]}}
    changes = {"variations": ["speed"], "conditions": {"speed": condition}}
    assert "speed-0" in load(folder, VIRTUAL | {"override": own}, **changes).sessions


def load_own(folder, session, own):
    """Load a study of which a user's file `mine.yaml` states some keys, the others config.yaml."""
    (folder / "sessions" / "hall.yaml").write_text(yaml.safe_dump(session))
    config = yaml_files.read(folder / "config.yaml") | {"variations": [], "sessions": ["hall"]}
    return configuration.load(config | own, "mine.yaml", folder, root=folder.parent)


@pytest.mark.parametrize(
    ("session", "own", "stands"),
    [
        ({}, {"fusions": ["two-robust"]}, "mine.yaml: fusions: "),
        ({"fusions": ["two-robust"]}, {}, "{sessions}/hall.yaml: override.fusions: "),
        ({}, {"take_calibrations": ["wand"]}, "mine.yaml: take_calibrations: "),
        ({"take_calibrations": ["wand"]}, {}, "{sessions}/hall.yaml: override.take_calibrations: "),
        ({"calibrations": ["file-people"]}, {}, "{folder}/config.yaml: take_calibrations: "),
        ({}, {"calibrations": ["file-people"]}, "{folder}/config.yaml: take_calibrations: "),
    ],
)
def test_takes_that_nothing_measures_are_told_where_the_value_stands(folder, session, own, stands):
    with pytest.raises(InputError) as caught:
        load_own(folder, SESSION | {"override": session}, own)
    (line,) = caught.value.lines
    assert line.startswith(stands.format(folder=folder, sessions=folder / "sessions"))
    assert " of session hall, " in line


def test_a_study_that_lists_its_sessions_alone_has_no_variations_of_others(folder):
    """The default file names variations of a session of its own."""
    (folder / "sessions" / "hall.yaml").write_text(yaml.safe_dump(SESSION))
    config = yaml_files.read(folder / "config.yaml") | {"sessions": ["hall"]}
    study = configuration.load(config, "mine.yaml", folder, root=folder.parent)
    assert list(study.sessions) == ["hall"] and study.parameters["variations"] == []
    own = config | {"variations": ["capture-speed"]}
    with pytest.raises(InputError, match=r"capture-speed.session: expected one of \['hall'\]"):
        configuration.load(own, "mine.yaml", folder, root=folder.parent)


def test_another_number_of_bridging_images_is_told_with_the_line_to_write(folder):
    """The fault stands in the default file, which a user leaves as it is."""
    for override, own, advice in (
        (["file-people"], [], "override: {{take_calibrations: [file-people]}}` to {hall}, beside"),
        ([], ["file-people"], "add `take_calibrations: [file-people]` to mine.yaml, beside"),
    ):
        session = SESSION | ({"override": {"calibrations": override}} if override else {})
        with pytest.raises(InputError) as caught:
            load_own(folder, session, {"calibrations": own} if own else {})
        advice = advice.format(hall=folder / "sessions" / "hall.yaml")
        assert f"{advice} `calibrations`" in str(caught.value)


def test_a_fault_is_told_of_the_file_in_which_its_value_stands(folder):
    usual = yaml_files.read(folder / "config.yaml")
    usual["models"], usual["sweep"]["mappers"] = ["resnet"], ["glomap"]
    (folder / "config.yaml").write_text(yaml.safe_dump(usual))
    own = {"plans": "none", "sweep": usual["sweep"] | {"n_offsets": 9}}
    with pytest.raises(InputError) as caught:
        load_own(folder, SESSION, own)
    assert [line.split(": expected")[0] for line in caught.value.lines] == [
        "mine.yaml: plans",
        f"{folder}/config.yaml: sweep.mappers.0",
        "mine.yaml: sweep.n_offsets",
        f"{folder}/config.yaml: models",
    ]


def test_the_file_of_a_session_given_as_a_study_is_told_with_the_right_one(folder):
    """Both may have one name; the keys of a session must not be called wrong in its own file."""
    (folder / "sessions" / "hall.yaml").write_text(yaml.safe_dump(SESSION))
    config = yaml_files.read(folder / "config.yaml") | SESSION
    start = "expected the file of a study, found that of a session; give"

    def said(own):
        with pytest.raises(InputError) as caught:
            configuration.load(config, own, folder, root=folder.parent)
        return caught.value.lines

    own = "config/sessions/hall.yaml"
    assert said(own) == [f"{own}: {start} a study that names this session among its `sessions`"]
    (folder / "hall.yaml").write_text("sessions: [hall]\n")
    assert said(own) == [f"{own}: {start} --configfile {folder}/hall.yaml"]
    assert said(f"{own} or --config") == [
        f"{own} or --config: {start} --configfile {folder}/hall.yaml"
    ]
    assert len(said(f"{folder}/hall.yaml")) > 1  # keys of a session in the study's own file


def test_a_session_may_say_that_its_takes_are_not_measured(folder):
    study = load(folder, SESSION | {"override": {"take_calibrations": []}})
    assert study.sessions["hall"].take_calibrations() == []


def test_a_session_without_heights_is_not_calibrated_by_people_alone(folder):
    session = changed("cameras", "back", value=None)
    study = load(folder, session, calibrations=["file", "people"])
    assert study.sessions["hall"].calibrations() == ["file"]


def test_people_alone_without_heights_are_told_where_nothing_else_is_wanted(folder):
    session = changed("cameras", "back", value=None)
    (line,) = faults(folder, session, calibrations=["people"], take_calibrations=["people"])
    where = "config/config.yaml: calibrations: session hall: expected `height_m` of every person"
    assert line.startswith(where)
    stated = session | {"subjects": {"p1": {"height_m": 1.74}}}
    study = load(folder, stated, calibrations=["people"], take_calibrations=["people"])
    assert study.sessions["hall"].calibrations() == ["people"]


@pytest.mark.parametrize(
    ("override", "own", "stands", "found"),
    [
        (["board"], {}, "{sessions}/hall.yaml: override.calibrations", ["board"]),
        (["known18", "sfm-n40"], {}, "{sessions}/hall.yaml: override.calibrations", None),
        (None, {"calibrations": ["wand"]}, "mine.yaml: calibrations", ["wand"]),
    ],
)
def test_calibrations_that_are_all_impossible_are_told(folder, override, own, stands, found):
    session = SESSION | ({"override": {"calibrations": override}} if override else {})
    with pytest.raises(InputError) as caught:
        load_own(folder, session, own)
    (line,) = caught.value.lines
    stands = stands.format(sessions=folder / "sessions")
    assert line.startswith(f"{stands}: expected a calibration that the recordings and the court ")
    assert f"of session hall allow, such as file, found {found or override}; name another" in line


def test_impossible_calibrations_are_no_fault_where_no_take_is_to_be_measured(folder):
    override = {"calibrations": ["board"], "take_calibrations": []}
    study = load(folder, SESSION | {"override": override})
    assert study.sessions["hall"].calibrations() == []


def test_a_session_that_waits_for_clicks_has_no_calibration_yet(folder):
    (folder.parent / "empty.mp4").touch()
    session = changed("cameras", value={key: {"static": "empty.mp4"} for key in ("left", "right")})
    session |= {"court": "badminton", "court_points": "clicks.csv"}
    session = {key: value for key, value in session.items() if key != "calibration"}
    study = load(folder, session)
    assert study.sessions["hall"].unclicked == "clicks.csv"
    assert study.sessions["hall"].calibrations() == []


def test_a_session_waits_with_another_whose_cameras_it_uses(folder):
    for name in ("empty.mp4", "walk.mp4"):
        (folder.parent / name).touch()
    first = changed("cameras", value={key: {"static": "empty.mp4"} for key in ("left", "right")})
    first |= {"court": "badminton", "court_points": "c.csv", "walks": {"w": {"video": "walk.mp4"}}}
    del first["calibration"]
    (folder / "sessions" / "first.yaml").write_text(yaml.safe_dump(first))
    later = changed("calibration", "file", value="results/first/calibration/sfm-n40/cameras.toml")
    sessions = load(folder, later, sessions=["hall", "first"]).sessions
    assert [sessions[name].calibrations() for name in ("first", "hall")] == [[], []]
    other = changed("calibration", "file", value="results/first/calibration/sfm-n12/cameras.toml")
    (line,) = faults(folder, other, sessions=["hall", "first"])
    assert line.endswith("add sfm-n12 to them, or put the files there")
    (folder.parent / "c.csv").touch()
    sessions = load(folder, later, sessions=["hall", "first"]).sessions
    assert sessions["hall"].calibrations() == ["file"]


def changed_step(step, **change):
    return {step: yaml_files.read(CONFIG / "config.yaml")[step] | change}


def test_networks_that_are_compared_are_known(folder):
    networks = ["blazepose-full", "blazepose-huge"]
    (line,) = faults(folder, **changed_step("compare_networks", networks=networks))
    assert line.startswith("config/config.yaml: compare_networks.networks: expected one of [")
    assert line.endswith("found 'blazepose-huge'; did you mean 'blazepose-heavy'?")


@pytest.mark.parametrize("sessions", [[], ["hall"], ["other"]])
def test_files_of_networks_that_are_compared_are_there(folder, sessions):
    entry = {"decoder": "simcc", "skeleton": "coco17", "landmarks": {"file": "my.onnx"}}
    entry["landmarks"]["sha256"] = "0" * 64
    entry["input"] = {"size": [192, 256], "channels": "rgb", "padding": 1.25}
    text = (folder / "models.yaml").read_text()
    (folder / "models.yaml").write_text(text + yaml.safe_dump({"mine": entry}))
    step = changed_step("compare_networks", networks=["blazepose-full", "mine"], sessions=sessions)
    if sessions == ["hall"]:
        (line,) = faults(folder, **step)
        assert "mine.landmarks.file: expected an ONNX file, found none at my.onnx" in line
    else:
        load(folder, **step)


def test_layouts_of_figure_5_show_cameras_of_takes_that_are_compared_with_something(folder):
    def said(**place):
        layouts = {"a": {"take": "hall/t1", "cameras": ["left"]} | place}
        return faults(folder, **changed_step("draw_badminton_fig05", layouts=layouts))

    strange, unseen = said(cameras=["left", "middle"])
    where = "config/config.yaml: draw_badminton_fig05.layouts.a"
    assert strange == f"{where}.cameras: expected one of ['left', 'right'], found 'middle'"
    assert unseen.startswith(f"{where}.take: expected a virtual take, or one of evaluate_networks")
    (folder.parent / "openpose").mkdir()
    take = SESSION["takes"]["t1"] | {
        "pose2d": {"coco17": dict.fromkeys(("left", "right"), "openpose")}
    }
    compared = yaml_files.read(CONFIG / "config.yaml")["evaluate_networks"]
    steps = changed_step(
        "draw_badminton_fig05", layouts={"a": {"take": "hall/t1", "cameras": ["left"]}}
    )
    steps |= {"evaluate_networks": compared | {"takes": {"hall/t1": "coco17"}}}
    (unpaired,) = faults(folder, changed("takes", value={"t1": take}), **steps)
    assert unpaired.startswith(
        f"{where}.take: expected a take of one person by cameras on one clock"
    )
    load(folder, changed("takes", value={"t1": take | {"synchronised": True}}), **steps)
    layouts = {"a": {"take": "elsewhere/t1", "cameras": ["left"]}}
    load(folder, **changed_step("draw_badminton_fig05", layouts=layouts))


def test_a_take_that_no_session_has_is_told_of_the_file_that_names_it(folder):
    (line,) = faults(folder, **changed_step("export_overlay_video", takes=["hall/t9"]))
    assert line.startswith("config/config.yaml: export_overlay_video.takes: expected one of the ")
