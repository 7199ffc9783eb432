"""Reading TFLite files: against scipy and Google's interpreter, and what is refused."""

import math

import numpy as np
import pytest
import scipy.sparse
from ai_edge_litert.interpreter import Interpreter

from courtside.pose.conversion import tflite_graph, tflite_tensors
from courtside.study.errors import InputError
from fixtures.recordings.tflite_files import NETWORKS, Network, find, sparse_rows


@pytest.mark.parametrize("density", [0.0, 0.05, 0.5, 1.0])
@pytest.mark.parametrize("shape", [(1, 1), (5, 9), (3, 4, 7), (6, 1, 1, 32)])
def test_sparse_rows_become_dense_as_in_scipy(shape, density):
    rng = np.random.default_rng(3)
    rows = scipy.sparse.random_array(
        (math.prod(shape[:-1]), shape[-1]), density=density, format="csr", rng=rng
    )
    dense = tflite_tensors.densify(rows.data, shape, rows.indptr, rows.indices)
    np.testing.assert_array_equal(dense, rows.toarray().reshape(shape))


@pytest.mark.parametrize(
    ("segments", "indices"),
    [
        ([0, 2, 3], [0, 1]),  # more entries than indices
        ([0, 1, 2], [0, 3]),  # a column too far
        ([0, 1, 2], [0, -1]),
        ([0, 2, 1, 2], [0, 1]),  # rows run back, and too many
        ([0, 2], [0, 1]),  # too few rows
        ([1, 1, 2], [0, 1]),  # the first row starts late
        ([0, 3, 2], [0, 1]),
        ([], [0, 1]),
    ],
)
def test_sparse_parts_that_do_not_belong_together_are_refused(segments, indices):
    with pytest.raises(ValueError, match=r"sparse|entries"):
        tflite_tensors.densify(np.ones(2), (2, 3), np.array(segments, int), np.array(indices, int))


@pytest.mark.parametrize("name", NETWORKS)
def test_tensors_are_those_of_the_interpreter(name):
    path = find(name)
    if path is None:
        pytest.skip(f"{name} is neither in shared/real nor fetched: see tests/README.md")
    graph = tflite_graph.read(path)
    interpreter = Interpreter(model_path=str(path))
    interpreter.allocate_tensors()
    for ends, details in (
        (graph.inputs, interpreter.get_input_details()),
        (graph.outputs, interpreter.get_output_details()),
    ):
        assert [graph.tensors[index].name for index in ends] == [d["name"] for d in details]
    constants = 0
    for detail in interpreter.get_tensor_details():
        if detail["index"] >= len(graph.tensors):
            continue  # the interpreter's own scratch tensors follow the file's
        tensor = graph.tensors[detail["index"]]
        assert (tensor.name, tensor.shape) == (detail["name"], tuple(detail["shape"]))
        assert tensor.dtype == detail["dtype"]
        if tensor.data is not None and not detail["sparsity_parameters"]:
            np.testing.assert_array_equal(tensor.data, interpreter.get_tensor(detail["index"]))
            constants += 1
    assert constants > 100


def test_an_output_left_out_takes_its_own_operators_along(tmp_path):
    network = Network()
    image = network.image(1, 4, 4, 2)
    shared = network.add("RELU", [image], (1, 4, 4, 2))
    kept = network.add("LOGISTIC", [shared], (1, 4, 4, 2))
    between = network.add("ABS", [shared], (1, 4, 4, 2))
    dropped = network.add("LOGISTIC", [between], (1, 4, 4, 2))
    network.graph.outputs = [kept, dropped]
    graph = tflite_graph.read(network.write(tmp_path / "n.tflite"))
    assert [operator.kind for operator in graph.operators] == [
        "RELU",
        "LOGISTIC",
        "ABS",
        "LOGISTIC",
    ]
    smaller = tflite_graph.keep_outputs(graph, [f"t{kept}"])
    assert [operator.place for operator in smaller.operators] == [0, 1]
    assert smaller.outputs == (kept,)
    for names, found in ((["t99"], "found t99"), ([], "found none")):
        with pytest.raises(InputError, match=f"among t{kept}, t{dropped}, {found}"):
            tflite_graph.keep_outputs(graph, names)


def refused(path, match):
    with pytest.raises(InputError, match=match) as caught:
        tflite_graph.read(path)
    assert str(caught.value).startswith(str(path))
    assert "\n" not in str(caught.value)


def relu():
    network = Network()
    network.add("RELU", [network.image(1, 4, 4, 2)], (1, 4, 4, 2))
    return network


def test_other_files_are_refused(tmp_path):
    refused(tmp_path / "missing.tflite", "found: No such file")
    refused(tmp_path, "found: Is a directory")
    path = tmp_path / "n.tflite"
    for content in (b"", b"\0" * 100, b"not a network at all", b"TFL3TFL2"):
        path.write_bytes(content)
        refused(path, "expected a TFLite file, found one that starts")


def test_random_bytes_behind_the_identifier_are_refused(tmp_path):
    rng = np.random.default_rng(4)
    path = tmp_path / "n.tflite"
    for length in (0, 1, 3, 8, 50, 2000):
        for _ in range(20):
            path.write_bytes(rng.bytes(4) + b"TFL3" + rng.bytes(length))
            refused(path, "expected a whole TFLite network")
            offset = int(rng.integers(0, length + 8)).to_bytes(4, "little")
            path.write_bytes(offset + b"TFL3" + rng.bytes(length))
            refused(path, "expected a whole TFLite network")


def broken(change):
    network = relu()
    change(network)
    return network


@pytest.mark.parametrize(
    ("change", "match"),
    [
        (lambda n: setattr(n.model, "version", 2), "schema version 2"),
        (lambda n: n.model.subgraphs.append(n.graph), "2 subgraphs"),
        (lambda n: setattr(n.graph.tensors[0], "type", 9), "'t0': type INT8"),
        (lambda n: setattr(n.graph.tensors[0], "type", 99), "'t0': type 99"),
        (lambda n: setattr(n.graph.tensors[0], "shape", [1, -1]), r"'t0': shape \(1, -1\)"),
        (lambda n: setattr(n.graph.tensors[0], "shape", [1] * 9), "'t0': 9 shape"),
        (lambda n: setattr(n.graph.tensors[0], "buffer", 7), "'t0': .*buffer 7 of 1"),
        (lambda n: setattr(n.graph.tensors[0], "name", "x" * 5000), "name of 5000 bytes"),
        (lambda n: setattr(n.graph.operators[0], "inputs", [0] * 300), "0 RELU: 300 inputs"),
        (lambda n: setattr(n.graph.operators[0], "inputs", [2]), r"0 RELU: inputs \(2,\)"),
        (lambda n: setattr(n.graph.operators[0], "outputs", [-1]), r"0 RELU: outputs \(-1,\)"),
        (lambda n: setattr(n.graph.operators[0], "opcodeIndex", 5), "operator 0 of no listed kind"),
        (lambda n: setattr(n.graph, "inputs", []), "inputs without a name"),
        (lambda n: setattr(n.graph.tensors[1], "name", ""), "outputs without a name"),
        (lambda n: n.add("ADD", [0, 1], (1, 4, 4, 2)), "operator 1 ADD: no AddOptions"),
        (
            lambda n: n.add("ADD", [0, 1], (1, 4, 4, 2), "AddOptions", fusedActivationFunction=77),
            "operator 1 ADD: unknown fused_activation_function 77",
        ),
        (
            lambda n: n.tensor((5000, 5000), values=np.ones(4, np.float32)),
            r"constant of shape \(5000, 5000\)",
        ),
        (lambda n: n.tensor((5,), values=np.ones(4, np.float32)), "cannot reshape"),
    ],
)
def test_what_does_not_fit_is_named(tmp_path, change, match):
    refused(broken(change).write(tmp_path / "n.tflite"), match)


def test_a_sparse_layout_of_another_kind_is_refused(tmp_path):
    dense = np.eye(3, 4, dtype=np.float32)

    def blocked(layout):
        layout.blockMap = [1]

    def turned(layout):
        layout.traversalOrder = [1, 0]

    def swapped(layout):
        layout.dimMetadata.reverse()

    def larger(layout):
        layout.dimMetadata[0].denseSize = 4

    def untyped(layout):
        layout.dimMetadata[1].arrayIndicesType = 0
        layout.dimMetadata[1].arrayIndices = None

    for change in (blocked, turned, swapped, larger, untyped):
        network = relu()
        values, layout = sparse_rows(dense)
        change(layout)
        network.tensor(dense.shape, values=values, sparsity=layout)
        refused(network.write(tmp_path / "n.tflite"), "'t2': .*sparse")


def test_kinds_that_nobody_knows_keep_a_name(tmp_path):
    network = relu()
    network.model.operatorCodes[0].builtinCode = 32
    network.model.operatorCodes[0].deprecatedBuiltinCode = 32
    network.model.operatorCodes[0].customCode = "Convolution2DTransposeBias"
    graph = tflite_graph.read(network.write(tmp_path / "custom.tflite"))
    assert str(graph.operators[0]) == "operator 0 CUSTOM Convolution2DTransposeBias"
    network.model.operatorCodes[0].builtinCode = 9999
    graph = tflite_graph.read(network.write(tmp_path / "unknown.tflite"))
    assert str(graph.operators[0]) == "operator 0 of unknown code 9999"
