"""The ONNX graph that grows while a TFLite network is converted.

TFLite keeps images as (batch, height, width, channels), "channels last"; ONNX convolves them as
(batch, channels, height, width), "channels first". Each tensor is held in the layout it was made
in, and transposed once, when an operator first asks for the other one.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from onnx import helper, numpy_helper

from courtside.pose.conversion.tflite_graph import Graph, Operator

IMAGE_RANK = 4
TO_FIRST, TO_LAST = (0, 3, 1, 2), (0, 2, 3, 1)


class Writer:
    """The ONNX graph so far, and the place of each TFLite tensor in it."""

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        self.constants = {
            index: tensor.data
            for index, tensor in enumerate(graph.tensors)
            if tensor.data is not None
        }
        self.last = {index: graph.tensors[index].name for index in graph.inputs}
        self.first: dict[int, str] = {}  # ONNX names, by tensor index; `last` in the file's layout
        self.nodes: list[Any] = []
        self.initializers: list[Any] = []
        self.results: list[tuple[Operator, str, tuple[int, ...]]] = []
        self.operator = ""

    def add(self, kind: str, inputs: Sequence[str], **attributes: Any) -> str:
        """Add a node and return the name of its result."""
        name = f"courtside/{len(self.nodes)}"
        self.nodes.append(
            helper.make_node(kind, inputs, [name], f"{self.operator} {name}", **attributes)
        )
        return name

    def store(self, array: NDArray | np.generic) -> str:
        """Add an array to the network and return its name."""
        name = f"courtside/constant/{len(self.initializers)}"
        array = np.ascontiguousarray(array).reshape(np.shape(array))
        self.initializers.append(numpy_helper.from_array(array, name))
        return name

    def shape(self, index: int, rank: int | None = None) -> tuple[int, ...]:
        """Return the shape that the TFLite file states, with `rank` dimensions if given."""
        shape = self.graph.tensors[index].shape
        if rank is not None and len(shape) != rank:
            raise ValueError(f"a tensor of shape {shape} where {rank} dimensions are needed")
        return shape

    def constant(self, index: int, kind: type, rank: int) -> NDArray:
        """Return a constant's values; `kind` is np.float32 or np.integer."""
        values = self.constants.get(index)
        if values is None or not np.issubdtype(values.dtype, kind) or values.ndim != rank:
            found = "no constant" if values is None else f"{values.dtype} of shape {values.shape}"
            raise ValueError(f"{found} where {rank}-d constant {kind.__name__} is needed")
        return values

    def channels_first(self, index: int) -> str:
        """Return the ONNX name of an image, or of a constant to be combined with images."""
        if index not in self.first:
            if index in self.constants:
                values = self.constant(index, np.float32, len(self.shape(index)))
                values = values.reshape((1,) * (IMAGE_RANK - values.ndim) + values.shape)
                self.first[index] = self.store(values.transpose(TO_FIRST))
            else:
                self.shape(index, IMAGE_RANK)
                name = self.channels_last(index)
                self.first[index] = self.add("Transpose", [name], perm=TO_FIRST)
        return self.first[index]

    def channels_last(self, index: int) -> str:
        """Return the ONNX name of a tensor in the layout of the TFLite file."""
        if index not in self.last:
            if index in self.constants:
                rank = len(self.shape(index))
                self.last[index] = self.store(self.constant(index, np.float32, rank))
            elif index in self.first:
                self.last[index] = self.add("Transpose", [self.first[index]], perm=TO_LAST)
            else:
                raise ValueError(f"tensor {index} used before it is made")
        return self.last[index]

    def take(self, index: int, *, images: bool) -> str:
        """Return the ONNX name of a tensor, channels first if the operator is on images."""
        return self.channels_first(index) if images else self.channels_last(index)

    def finish(self, operator: Operator, name: str, *, images: bool = True) -> None:
        """Record an ONNX name as the result of an operator, channels first if on images."""
        activation = operator.options.get("fused_activation_function", "NONE")
        if activation == "RELU":
            name = self.add("Relu", [name])
        elif activation == "RELU6":
            name = self.add("Clip", [name, self.store(np.float32(0)), self.store(np.float32(6))])
        elif activation != "NONE":
            raise ValueError(f"fused activation {activation} (converted are RELU, RELU6)")
        index = operator.outputs[0]
        if self.graph.tensors[index].dtype != np.float32:
            raise ValueError(f"a result of type {self.graph.tensors[index].dtype}, not float32")
        expected = self.shape(index)
        if images:
            expected = tuple(self.shape(index, IMAGE_RANK)[axis] for axis in TO_FIRST)
        (self.first if images else self.last)[index] = name
        self.results.append((operator, name, expected))
