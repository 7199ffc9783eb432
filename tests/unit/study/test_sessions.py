"""Records of a model; sessions are tested through test_configuration."""

from courtside.study import sessions

NETWORK = {"artefact": "a", "member": "m", "sha256": "0" * 64}


def test_a_heat_map_model_passes_its_input_to_the_decoder():
    entry = {
        "decoder": "heatmaps",
        "skeleton": "cpm14",
        "detector": NETWORK,
        "landmarks": NETWORK,
        "input": {"range": [0, 255], "channels": "bgr"},
    }
    model = sessions.model("m", entry)
    assert model.decoder_options() == {
        "decoder": "heatmaps",
        "input_range": [0, 255],
        "channels": "bgr",
    }


def test_blazepose_needs_no_input():
    entry = {"decoder": "blazepose", "skeleton": "s", "detector": NETWORK, "landmarks": NETWORK}
    assert sessions.model("m", entry).decoder_options() == {"decoder": "blazepose"}
    assert sessions.model("m", entry).landmarks.outputs is None


CONTENT = {
    "description": "d",
    "court": "hall",
    "subjects": {"p1": None, "p2": {"height_m": 1.8}},
    "cameras": {"a": None, "b": {"crop_px": [1, 2, 3, 4], "name_in_calibration": "B"}},
    "calibration": {"file": "c.toml"},
    "takes": {
        "t1": {"videos": {"a": "1", "b": "2"}, "subjects": ["p2"], "trim_s": [0.5, 2]},
        "t2": {"videos": {"a": "3", "b": "4"}},
    },
    "override": {"step": {"x": 5}},
}


def test_a_session_holds_what_its_file_says():
    parameters = {"step": {"x": 1, "y": 2}, "models": ["m"]}
    found = sessions.session("s", "s.yaml", CONTENT, parameters)
    assert found.court == "hall"
    assert found.subjects["p2"] == sessions.Subject(height_m=1.8)
    assert found.cameras["b"] == sessions.FixedCamera(None, (1, 2, 3, 4), "B")
    assert hash(found.cameras["b"]) == hash(sessions.FixedCamera(None, (1, 2, 3, 4), "B"))
    assert found.cameras["a"].crop_px is None
    assert found.calibration_camera_names() == {"a": "a", "b": "B"}
    assert (found.takes["t1"].subjects, found.takes["t1"].trim_s) == (("p2",), (0.5, 2))
    assert (found.takes["t2"].subjects, found.takes["t2"].trim_s) == (("p1", "p2"), None)
    assert found.parameters == {"step": {"x": 5, "y": 2}, "models": ["m"]}
    assert parameters == {"step": {"x": 1, "y": 2}, "models": ["m"]}
