"""A TFLite network as plain records: tensors, constants and operators, read from the flatbuffer.

The file comes from outside. The flatbuffer classes check nothing, so every count, index and length
is checked here, and any error they raise on a damaged file becomes one `InputError`.
"""

import dataclasses
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import tflite

from courtside.pose.conversion.tflite_tensors import (
    DAMAGED,
    MAX_NAME_BYTES,
    Tensor,
    entries,
    integers,
    names_of,
    read_tensor,
)
from courtside.study.errors import InputError, StrPath, reading

IDENTIFIER = b"TFL3"  # bytes 4 to 7 of every TFLite file
SCHEMA_VERSION = 3
# Far above any pose network (28 MB, 900 tensors), far below what would fill the memory.
MAX_FILE_BYTES = 1 << 29
MAX_INPUTS = 256

WINDOW = "padding stride_h stride_w fused_activation_function "
# Operators whose options are read: the table that must be there, and the fields taken from it.
OPTIONS = {
    "ADD": ("AddOptions", "fused_activation_function"),
    "CONCATENATION": ("ConcatenationOptions", "axis fused_activation_function"),
    "CONV_2D": ("Conv2DOptions", WINDOW + "dilation_h_factor dilation_w_factor"),
    "DEPTHWISE_CONV_2D": ("DepthwiseConv2DOptions", WINDOW + "dilation_h_factor dilation_w_factor"),
    "DEPTH_TO_SPACE": ("DepthToSpaceOptions", "block_size"),
    "MAX_POOL_2D": ("Pool2DOptions", WINDOW + "filter_height filter_width"),
    "RESIZE_BILINEAR": ("ResizeBilinearOptions", "align_corners half_pixel_centers"),
}


OPERATORS = names_of(tflite.BuiltinOperator)
# Options that are numbers in the file and names here.
ENUMS = {
    "padding": names_of(tflite.Padding),
    "fused_activation_function": names_of(tflite.ActivationFunctionType),
}


@dataclasses.dataclass(frozen=True)
class Operator:
    """An operator: its place in the file, kind, indices of its tensors, and options.

    An omitted input is -1. Options are named as in the schema, enumerations by their names.
    """

    place: int
    kind: str
    inputs: tuple[int, ...]
    outputs: tuple[int, ...]
    options: dict[str, Any]

    def __str__(self) -> str:
        return f"operator {self.place} {self.kind}"


@dataclasses.dataclass(frozen=True, eq=False)
class Graph:
    """A network: file, tensors, operators in running order, and indices of inputs and outputs."""

    path: Path
    tensors: tuple[Tensor, ...]
    operators: tuple[Operator, ...]
    inputs: tuple[int, ...]
    outputs: tuple[int, ...]


def read(path: StrPath) -> Graph:
    """Read a TFLite file.

    Its first and only subgraph is read. Sparse constants become dense; float16 ones stay float16.
    All indices are within range; operators of any kind are listed. Raises `InputError` if the file
    is missing, is no TFLite file, is damaged, or holds a tensor type or sparse layout that is not
    supported.

    Schema: tensorflow/compiler/mlir/lite/schema/schema.fbs.
    """
    path = Path(path)
    content = _content(path)
    advice = "compare its checksum with the source's, or use another network"
    with reading(path, "a whole TFLite network of floats", advice, kinds=DAMAGED):
        return _graph(path, content)


def keep_outputs(graph: Graph, names: Iterable[str]) -> Graph:
    """Remove all outputs but those named, with the operators that only the removed ones need.

    Outputs stay in the file's order, and tensors keep their indices. Raises `InputError` if a name
    is no output of the network, or there is none.
    """
    wanted = set(names)
    there = {graph.tensors[index].name: index for index in graph.outputs}
    if not wanted or not wanted <= set(there):
        unknown = ", ".join(sorted(wanted - set(there))) or "none"
        raise InputError(
            f"{graph.path}: expected outputs among {', '.join(there)}, found {unknown}; "
            "correct the list of outputs"
        )
    outputs = tuple(index for name, index in there.items() if name in wanted)
    needed, kept = set(outputs), []
    for operator in reversed(graph.operators):
        if needed & set(operator.outputs):
            needed |= set(operator.inputs)
            kept.append(operator)
    return dataclasses.replace(graph, operators=tuple(reversed(kept)), outputs=outputs)


def _content(path: Path) -> bytes:
    advice = "correct its name or fetch it again"
    with reading(path, "a TFLite file", advice, kinds=(OSError,)), path.open("rb") as stream:
        head = stream.read(8)
        if head[4:] != IDENTIFIER:
            raise InputError(
                f"{path}: expected a TFLite file, found one that starts {head!r}; {advice}"
            )
        rest = stream.read(MAX_FILE_BYTES)
    if len(rest) == MAX_FILE_BYTES:
        raise InputError(
            f"{path}: expected a network below {MAX_FILE_BYTES} bytes, found more; use a smaller "
            "one"
        )
    return head + rest


def _graph(path: Path, content: bytes) -> Graph:
    model = tflite.Model.GetRootAs(content, 0)
    if model.Version() != SCHEMA_VERSION:
        raise ValueError(f"schema version {model.Version()}, not {SCHEMA_VERSION}")
    if model.SubgraphsLength() != 1:
        raise ValueError(f"{model.SubgraphsLength()} subgraphs, not 1")
    subgraph = model.Subgraphs(0)
    buffers = entries(model, "Buffers")
    tensors = tuple(read_tensor(entry, buffers) for entry in entries(subgraph, "Tensors"))
    kinds = [_kind(code) for code in entries(model, "OperatorCodes")]
    operators = tuple(
        _operator(place, entry, kinds, len(tensors))
        for place, entry in enumerate(entries(subgraph, "Operators"))
    )
    ends = []
    for name in ("Inputs", "Outputs"):
        indices = _indices(subgraph, name, 0, len(tensors))
        if not indices or len({tensors[index].name for index in indices} - {""}) != len(indices):
            raise ValueError(f"{name.lower()} without a name of their own")
        ends.append(indices)
    return Graph(path, tensors, operators, *ends)


def _indices(table: Any, name: str, least: int, count: int) -> tuple[int, ...]:
    indices = integers(table, name, MAX_INPUTS)
    if any(not least <= index < count for index in indices):
        raise ValueError(f"{name.lower()} {indices} outside 0 to {count - 1}")
    return indices


def _kind(code: Any) -> str:
    # Files older than 2020 know only the first field, which holds at most 127.
    number = max(code.BuiltinCode(), code.DeprecatedBuiltinCode())
    if number == tflite.BuiltinOperator.CUSTOM:
        return f"CUSTOM {(code.CustomCode() or b'')[:MAX_NAME_BYTES].decode()}"
    return OPERATORS.get(number, f"of unknown code {number}")


def _operator(place: int, entry: Any, kinds: Sequence[str], count: int) -> Operator:
    if not entry.OpcodeIndex() < len(kinds):
        raise ValueError(f"operator {place} of no listed kind")
    kind = kinds[entry.OpcodeIndex()]
    try:
        inputs, outputs = _indices(entry, "Inputs", -1, count), _indices(entry, "Outputs", 0, count)
        return Operator(place, kind, inputs, outputs, _options(entry, kind))
    except DAMAGED as error:
        raise ValueError(f"operator {place} {kind}: {error}") from None


def _options(entry: Any, kind: str) -> dict[str, Any]:
    if kind not in OPTIONS:
        return {}
    name, fields = OPTIONS[kind]
    stored = entry.BuiltinOptions()
    if stored is None or entry.BuiltinOptionsType() != getattr(tflite.BuiltinOptions, name):
        raise ValueError(f"no {name}")
    table = getattr(tflite, name)()
    table.Init(stored.Bytes, stored.Pos)
    options = {}
    for field in fields.split():
        value = getattr(table, "".join(word.capitalize() for word in field.split("_")))()
        if value not in ENUMS.get(field, (value,)):
            raise ValueError(f"unknown {field} {value}")
        options[field] = ENUMS[field][value] if field in ENUMS else value
    return options
