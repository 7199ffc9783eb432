"""A network for one picture as a network for several at once."""

import onnx
from onnx import numpy_helper

from courtside.study.errors import StrPath

SIZED = {"Reshape": 1, "Resize": 3}  # operators that state sizes: which of their inputs


def of_size(path: StrPath, count: int) -> bytes:
    """Return the ONNX file of a network as one for `count` pictures.

    The first dimension of all inputs, outputs and stated sizes must be the picture's, as it is in
    the networks of `courtside.pose.conversion`.
    """
    model = onnx.load(str(path))
    graph = model.graph
    stated = {
        node.input[SIZED[node.op_type]]
        for node in graph.node
        if node.op_type in SIZED and len(node.input) > SIZED[node.op_type]
    }
    for value in graph.initializer:
        if value.name in stated:
            sizes = numpy_helper.to_array(value).copy()
            sizes[0] = count
            value.CopyFrom(numpy_helper.from_array(sizes, value.name))
    for value in (*graph.input, *graph.output):
        if value.type.tensor_type.shape.dim:
            value.type.tensor_type.shape.dim[0].dim_value = count
    del graph.value_info[:]
    return bytes(model.SerializeToString())
