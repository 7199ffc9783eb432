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
