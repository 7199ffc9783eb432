"""What onnxruntime is given: checked files, named outputs, providers that are really there."""

import os
import shutil
import subprocess
import sys

import numpy as np
import onnx
import onnxruntime
import pytest
from onnx import TensorProto

from courtside.pose.networks import session
from courtside.study.errors import InputError
from courtside.study.execution import files
from fixtures.recordings import onnx_files

SHAPE = (1, 3, 8, 8)


def doubled(path, shape=SHAPE, kind=TensorProto.FLOAT, **options):
    """Write a network that doubles its picture by a constant of its own size."""
    graph = onnx_files.Graph(list(shape), kind)
    factor = graph.store(np.full((1, 3, 8, 8), 2, np.float32))
    source = graph.add("Cast", "image", to=TensorProto.FLOAT)
    graph.output(graph.add("Mul", source, factor), "twice")
    return graph.write(path, **options)


def line(function, *arguments, **options):
    with pytest.raises(InputError) as caught:
        function(*arguments, **options)
    assert len(caught.value.lines) == 1
    return str(caught.value)


def test_a_network_runs(tmp_path):
    network = session.Network(doubled(tmp_path / "n.onnx"), SHAPE)
    (found,) = network.run(np.ones(SHAPE, np.float32))
    np.testing.assert_array_equal(found, np.full(SHAPE, 2))
    assert network.session.get_providers() == ["CPUExecutionProvider"]


@pytest.mark.parametrize("shape", [("batch", 3, "height", "width"), (None, 3, 8, 8)])
def test_open_sizes_fit_every_input(tmp_path, shape):
    assert session.Network(doubled(tmp_path / "n.onnx", shape), SHAPE).input_name == "image"


@pytest.mark.parametrize(
    ("shape", "kind"),
    [
        ((1, 3, 8, 9), TensorProto.FLOAT),
        ((4, 3, 8, 8), TensorProto.FLOAT),
        ((3, 8, 8), TensorProto.FLOAT),
        ((1, 3, 8, 8), TensorProto.FLOAT16),
    ],
)
def test_another_input_is_one_line(tmp_path, shape, kind):
    graph = onnx_files.Graph(list(shape), kind)
    graph.output(graph.add("Cast", "image", to=TensorProto.FLOAT), "same")
    message = line(session.Network, graph.write(tmp_path / "n.onnx"), SHAPE)
    assert "tensor(float) of shape [1, 3, 8, 8], found" in message
    assert "correct its entry in config/models.yaml" in message


def counted(network):
    """Return a list that notes how many pictures each run of a network gets."""
    counts, outputs = [], network._outputs

    def noted(session, tensor):
        counts.append(len(tensor))
        return outputs(session, tensor)

    network._outputs = noted
    return counts


@pytest.mark.parametrize("at_once", [False, True])
def test_several_pictures_give_what_each_gives_alone(tmp_path, at_once):
    network = session.Network(doubled(tmp_path / "n.onnx", ("batch", 3, 8, 8)), SHAPE)
    assert not network.at_once  # on the processor
    network.at_once, counts = at_once, counted(network)
    pictures = [np.full(SHAPE, value, np.float32) for value in (1, 5, 3)]
    found = network.run_each(pictures)
    for outputs, picture in zip(found, pictures, strict=True):
        np.testing.assert_array_equal(outputs, [2 * picture])
    assert counts == ([3] if at_once else [1, 1, 1])


def test_a_network_that_mixes_its_pictures_is_one_line(tmp_path):
    graph = onnx_files.Graph(["batch", 3, 8, 8])
    graph.output(graph.add("ReduceSum", "image", graph.ints(0), keepdims=1), "sum")
    network = session.Network(graph.write(tmp_path / "n.onnx"), SHAPE)
    network.at_once = True
    message = line(network.run_each, [np.ones(SHAPE, np.float32)] * 2)
    assert "expected outputs for 2 pictures at once, found [(1, 3, 8, 8)]" in message


def test_outputs_that_are_not_there_are_named(tmp_path):
    message = line(session.Network, doubled(tmp_path / "n.onnx"), SHAPE, outputs=["once", "twice"])
    assert "expected the outputs ['once'], found ['twice']" in message


def test_a_foreign_operator_is_one_line(tmp_path):
    graph = onnx_files.Graph(list(SHAPE))
    graph.output(graph.add("TRTBatchedNMS", "image", domain="mmdeploy"), "boxes")
    path = tmp_path / "n.onnx"
    onnx.save_model(graph.model(["mmdeploy"]), path)
    session.check_file(path, files.sha256(path))
    message = line(session.open_session, path)
    assert str(path) in message
    assert "TRTBatchedNMS" in message
    assert "export it again" in message


@pytest.mark.parametrize("content", [b"", b"\x08", b"no network", bytes(range(256)) * 9])
def test_what_is_no_network_is_one_line(tmp_path, content):
    path = tmp_path / "n.onnx"
    path.write_bytes(content)
    message = line(session.open_session, path)
    assert message.startswith(f"{path}: expected")


def test_a_checksum_that_differs_is_one_line(tmp_path):
    path = doubled(tmp_path / "n.onnx")
    assert session.check_file(path, files.sha256(path)) is None
    message = line(session.check_file, path, "0" * 64)
    assert f"expected sha256 {'0' * 64}, found {files.sha256(path)}" in message
    assert "expected an ONNX file" in line(session.check_file, tmp_path / "none.onnx", "0" * 64)


EXTERNAL = {"save_as_external_data": True, "location": "weights.bin", "size_threshold": 0}


def test_data_in_another_file_is_refused(tmp_path):
    path = doubled(tmp_path / "n.onnx", **EXTERNAL)
    assert (tmp_path / "weights.bin").stat().st_size >= 8 * 8 * 3 * 4
    message = line(session.check_file, path, files.sha256(path))
    assert "expected all its data inside, found 1 tensors in ['weights.bin']" in message
    elsewhere = tmp_path / "elsewhere" / "n.onnx"  # a checked copy would not find it either
    elsewhere.parent.mkdir()
    shutil.copyfile(path, elsewhere)
    assert "expected a network" in line(session.open_session, elsewhere)


@pytest.mark.parametrize("place", ["function", "branch", "attribute", "sparse"])
def test_data_in_another_file_is_found_wherever_it_is_named(tmp_path, place):
    outside = onnx.numpy_helper.from_array(np.ones(3, np.float32), "w")
    outside.data_location = TensorProto.EXTERNAL
    outside.external_data.add(key="location", value="../secret")
    graph = onnx_files.Graph(list(SHAPE))
    graph.output(graph.add("Identity", "image"), "same")
    model = graph.model()
    constant = onnx.helper.make_node("Constant", [], ["k"], value=outside)
    if place == "attribute":
        model.graph.node.append(constant)
    elif place == "branch":
        inner = onnx.helper.make_graph([constant], "inner", [], [])
        model.graph.node.append(
            onnx.helper.make_node("If", ["c"], ["r"], then_branch=inner, else_branch=inner)
        )
    elif place == "function":
        opset = [onnx.helper.make_opsetid("", 17)]
        model.functions.append(onnx.helper.make_function("own", "f", [], ["k"], [constant], opset))
    else:
        model.graph.sparse_initializer.add().values.CopyFrom(outside)
    path = tmp_path / "n.onnx"
    path.write_bytes(model.SerializeToString())
    assert "['../secret']" in line(session.check_file, path, files.sha256(path))


@pytest.mark.parametrize(
    ("name", "package"),
    [
        ("cuda", "onnxruntime-gpu"),
        ("openvino", "onnxruntime-openvino"),
        ("directml", "onnxruntime-directml"),
        ("coreml", "onnxruntime for macOS"),
    ],
)
def test_a_missing_provider_names_its_package(tmp_path, monkeypatch, name, package):
    monkeypatch.setattr(onnxruntime, "get_available_providers", lambda: ["CPUExecutionProvider"])
    message = line(session.check_providers, ["cpu", name])
    assert f"execution provider {name}, found ['cpu']" in message
    assert f"install {package} in place of onnxruntime" in message
    path = doubled(tmp_path / "n.onnx")
    assert package in line(session.open_session, path, [name])


def test_a_provider_that_does_not_open_is_no_silent_fall_back(tmp_path, monkeypatch):
    every = [full for full, _ in session.PROVIDERS.values()]
    monkeypatch.setattr(onnxruntime, "get_available_providers", lambda: every)
    path, plain, asked = doubled(tmp_path / "n.onnx"), onnxruntime.InferenceSession, []

    def without_driver(path, options, providers):
        asked.append(providers)
        return plain(path, options, providers=["CPUExecutionProvider"])

    monkeypatch.setattr(onnxruntime, "InferenceSession", without_driver)
    message = line(session.open_session, path, ["cuda", "cpu"])
    single = {"use_tf32": "0"}  # else the graphics card rounds to 10 bits
    assert asked == [[("CUDAExecutionProvider", single), ("CPUExecutionProvider", {})]]
    assert "expected to run it by cuda" in message
    assert "or leave out cuda" in message
    assert session.open_session(path, ["cpu"])


def test_onnxruntime_keeps_no_records_of_its_use(tmp_path):
    code = "from courtside.pose.networks import session"
    own = {"HOME": str(tmp_path), "PYTHONPATH": os.pathsep.join(sys.path)}
    kept = {k: v for k, v in os.environ.items() if k not in ("ORT_DISABLE_TELEMETRY", "HOME")}
    subprocess.run([sys.executable, "-c", code], check=True, env=kept | own, cwd=tmp_path)
    assert list(tmp_path.iterdir()) == []
