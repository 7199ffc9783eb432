"""Convert a TFLite network of floats to ONNX, and check the result against what the file states."""

from collections.abc import Iterable

import numpy as np
import onnx
from onnx import helper

from courtside.pose.conversion import tflite_graph, tflite_operators
from courtside.pose.conversion.onnx_writer import Writer
from courtside.pose.conversion.tflite_graph import Graph
from courtside.study.errors import InputError, StrPath, reading
from courtside.study.execution.files import atomic, sha256

OPSET = 17
IR_VERSION = 8  # the one of opset 17
ONNX_FAULTS = (onnx.checker.ValidationError, onnx.shape_inference.InferenceError)


def convert(
    tflite_path: StrPath, onnx_path: StrPath, *, outputs: Iterable[str] | None = None
) -> None:
    """Convert a TFLite network of floats to ONNX (opset 17).

    Only the named `outputs` (by default all) are kept, with what they need. Inputs and outputs keep
    their names, order and TFLite layout; all are float32. The shape of each operator's result, as
    ONNX infers it, must be the one the TFLite file states. Equal inputs give equal bytes. Raises
    `InputError` if the file is no TFLite network or a damaged one, lacks one of the `outputs`, or
    needs an operator, a fused activation, a sparse layout or a tensor type that is not supported.
    """
    graph = tflite_graph.read(tflite_path)
    if outputs is not None:
        graph = tflite_graph.keep_outputs(graph, outputs)
    writer = Writer(graph)
    for operator in graph.operators:
        try:
            tflite_operators.convert_operator(writer, operator)
        except ValueError as error:
            raise InputError(
                f"{graph.path}: expected operators that can be converted, found {operator}: "
                f"{error}; use another network"
            ) from None
    model = _model(writer, sha256(tflite_path))
    _check(model, writer)
    with atomic(onnx_path) as temporary:
        temporary.write_bytes(model.SerializeToString(deterministic=True))


def _model(writer: Writer, source_sha256: str) -> onnx.ModelProto:
    graph = writer.graph
    results, writer.operator = [], "output"
    for index in graph.outputs:
        try:
            results.append((writer.channels_last(index), graph.tensors[index].name))
        except ValueError as error:
            raise InputError(
                f"{graph.path}: expected output {graph.tensors[index].name}, found {error}; "
                "leave that output out, or use another network"
            ) from None
    nodes = [*writer.nodes, *(helper.make_node("Identity", [a], [b], b) for a, b in results)]
    ends = [
        [_value_info(graph, index) for index in indices]
        for indices in (graph.inputs, graph.outputs)
    ]
    model = helper.make_model(
        helper.make_graph(nodes, "network", *ends, writer.initializers),
        opset_imports=[helper.make_opsetid("", OPSET)],
        ir_version=IR_VERSION,
        producer_name="courtside",
    )
    helper.set_model_props(model, {"source_sha256": source_sha256})
    return model


def _value_info(graph: Graph, index: int) -> onnx.ValueInfoProto:
    tensor = graph.tensors[index]
    if tensor.dtype != np.float32:
        raise InputError(
            f"{graph.path}: expected {tensor.name} as float32, found {tensor.dtype}; "
            "use a network of floats"
        )
    return helper.make_tensor_value_info(tensor.name, onnx.TensorProto.FLOAT, tensor.shape)


def _check(model: onnx.ModelProto, writer: Writer) -> None:
    """Compare the shapes that ONNX infers with those that the TFLite file states."""
    path = writer.graph.path
    # Without the outputs' shapes: a wrong one is then found at the operator, not at the end.
    bare = onnx.ModelProto()
    bare.CopyFrom(model)
    for output in bare.graph.output:
        output.type.tensor_type.ClearField("shape")
    with reading(path, "a consistent network", "fetch it again", kinds=ONNX_FAULTS):
        onnx.checker.check_model(model)
        inferred = onnx.shape_inference.infer_shapes(bare, check_type=True, strict_mode=True)
    shapes = {
        value.name: tuple(dimension.dim_value for dimension in value.type.tensor_type.shape.dim)
        for value in inferred.graph.value_info
    }
    for operator, name, expected in writer.results:
        if shapes.get(name) != expected:
            raise InputError(
                f"{path}: {operator}: expected a result of shape {expected}, as the file states, "
                f"found {shapes.get(name)}; fetch it again"
            )
