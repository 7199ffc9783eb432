"""TFLite operators as ONNX operators, one small function each.

A converter takes the `Writer` and the `Operator`, adds ONNX nodes, and names the result by
`Writer.finish`; it raises `ValueError` for what it cannot express.
"""

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from courtside.pose.conversion.onnx_writer import IMAGE_RANK, TO_FIRST, Writer
from courtside.pose.conversion.tflite_graph import MAX_INPUTS, Operator

MAX_STEP = 1 << 16  # of strides, windows, blocks: beyond any image, within ONNX's integers
Converter = Callable[[Writer, Operator], None]
CONVERTERS: dict[str, tuple[int, int, Converter]] = {}  # by kind: fewest and most inputs, function


def same_padding(length: int, window: int, stride: int, dilation: int) -> tuple[int, int]:
    """Return how many zeros TensorFlow's SAME padding puts before and after one dimension.

    The result then has ceil(length / stride) entries; an odd zero goes after. `dilation` is the
    step between the kernel's taps; all arguments are >= 1.
    """
    reach = (window - 1) * dilation + 1
    total = max((-(-length // stride) - 1) * stride + reach - length, 0)
    return total // 2, total - total // 2


def convert_operator(writer: Writer, operator: Operator) -> None:
    """Add one operator to the ONNX graph, which holds all its inputs.

    Raises `ValueError` if there is no converter for its kind, or it, its inputs or its options are
    not as needed.
    """
    if operator.kind not in CONVERTERS:
        raise ValueError(f"not one of {', '.join(sorted(CONVERTERS))}")
    least, most, function = CONVERTERS[operator.kind]
    if not least <= len(operator.inputs) <= most or len(operator.outputs) != 1:
        raise ValueError(f"{len(operator.inputs)} inputs, {len(operator.outputs)} outputs")
    result = operator.outputs[0]
    if any(result in made for made in (writer.constants, writer.first, writer.last)):
        raise ValueError(f"tensor {result} made twice")
    writer.operator = str(operator)
    function(writer, operator)


def _converts(kind: str, least: int, most: int) -> Callable[[Converter], Converter]:
    """Register the converter of an operator that has `least` to `most` inputs."""

    def register(function: Converter) -> Converter:
        CONVERTERS[kind] = (least, most, function)
        return function

    return register


def _steps(operator: Operator, *names: str) -> list[int]:
    values = [operator.options[name] for name in names]
    if not all(1 <= value <= MAX_STEP for value in values):
        raise ValueError(f"{' '.join(names)} {values}")
    return values


def _window(
    writer: Writer, operator: Operator, kernel: Sequence[int], dilations: Sequence[int]
) -> dict[str, Any]:
    """Return the attributes of an operator that slides a window over an image."""
    lengths = writer.shape(operator.inputs[0], IMAGE_RANK)[1:3]
    strides = _steps(operator, "stride_h", "stride_w")
    pads = [0, 0, 0, 0]
    if operator.options["padding"] == "SAME":
        rows, columns = map(same_padding, lengths, kernel, strides, dilations)
        pads = [rows[0], columns[0], rows[1], columns[1]]
    return {"kernel_shape": kernel, "strides": strides, "pads": pads}


def _convolve(writer: Writer, operator: Operator, weights: NDArray, groups: int) -> None:
    """Convolve an image with weights (channels out, channels in per group, height, width)."""
    if groups < 1 or weights.shape[0] % groups or 0 in weights.shape:
        raise ValueError(f"weights of shape {weights.shape} in {groups} groups")
    inputs = [writer.channels_first(operator.inputs[0]), writer.store(weights)]
    for index in operator.inputs[2:]:
        if index < 0:
            continue
        bias = writer.constant(index, np.float32, 1)
        if len(bias) != len(weights):
            raise ValueError(f"{len(bias)} biases for {len(weights)} channels")
        inputs.append(writer.store(bias))
    dilations = _steps(operator, "dilation_h_factor", "dilation_w_factor")
    window = _window(writer, operator, weights.shape[2:], dilations)
    name = writer.add("Conv", inputs, group=groups, dilations=dilations, **window)
    writer.finish(operator, name)


@_converts("CONV_2D", 2, 3)
def _conv_2d(writer: Writer, operator: Operator) -> None:
    weights = writer.constant(operator.inputs[1], np.float32, IMAGE_RANK).transpose(TO_FIRST)
    channels, per_group = writer.shape(operator.inputs[0], IMAGE_RANK)[3], weights.shape[1]
    if per_group < 1 or channels % per_group:
        raise ValueError(f"weights for {per_group} channels on an image of {channels}")
    _convolve(writer, operator, weights, channels // per_group)


@_converts("DEPTHWISE_CONV_2D", 2, 3)
def _depthwise_conv_2d(writer: Writer, operator: Operator) -> None:
    weights = writer.constant(operator.inputs[1], np.float32, IMAGE_RANK).transpose(3, 0, 1, 2)
    if weights.shape[1] != 1:
        raise ValueError(f"depthwise weights for {weights.shape[1]} channels")
    _convolve(writer, operator, weights, writer.shape(operator.inputs[0], IMAGE_RANK)[3])


@_converts("MAX_POOL_2D", 1, 1)
def _max_pool_2d(writer: Writer, operator: Operator) -> None:
    kernel = _steps(operator, "filter_height", "filter_width")
    window = _window(writer, operator, kernel, (1, 1))
    name = writer.add("MaxPool", [writer.channels_first(operator.inputs[0])], **window)
    writer.finish(operator, name)


@_converts("RESIZE_BILINEAR", 2, 2)
def _resize_bilinear(writer: Writer, operator: Operator) -> None:
    image, target = operator.inputs
    batch, _, _, channels = writer.shape(image, IMAGE_RANK)
    size = writer.constant(target, np.integer, 1).tolist()
    corners, centers = (operator.options[key] for key in ("align_corners", "half_pixel_centers"))
    if len(size) != 2 or min(size) < 1 or (corners and centers):
        raise ValueError(f"size {size}, align_corners {corners}, half_pixel_centers {centers}")
    # Where input pixel i lies on the output: ends on ends; centres on centres; i times the scale.
    mode = "align_corners" if corners else "half_pixel" if centers else "asymmetric"
    sizes = writer.store(np.array([batch, channels, *size], np.int64))
    inputs = [writer.channels_first(image), "", "", sizes]
    name = writer.add("Resize", inputs, mode="linear", coordinate_transformation_mode=mode)
    writer.finish(operator, name)


@_converts("DEPTH_TO_SPACE", 1, 1)
def _depth_to_space(writer: Writer, operator: Operator) -> None:
    (block,) = _steps(operator, "block_size")
    image = operator.inputs[0]
    if writer.shape(image, IMAGE_RANK)[3] % block**2:
        raise ValueError(f"blocks of {block} from an image of shape {writer.shape(image)}")
    # DCR: the channels of the result vary fastest, as TFLite has them.
    name = writer.add("DepthToSpace", [writer.channels_first(image)], blocksize=block, mode="DCR")
    writer.finish(operator, name)


@_converts("ADD", 2, 2)
def _add(writer: Writer, operator: Operator) -> None:
    # A constant may have fewer dimensions: the missing ones lead, as in numpy.
    made = [index for index in operator.inputs if index not in writer.constants]
    images = all(len(writer.shape(index)) == IMAGE_RANK for index in (*made, operator.outputs[0]))
    name = writer.add("Add", [writer.take(index, images=images) for index in operator.inputs])
    writer.finish(operator, name, images=images)


@_converts("CONCATENATION", 1, MAX_INPUTS)
def _concatenation(writer: Writer, operator: Operator) -> None:
    rank, axis = len(writer.shape(operator.outputs[0])), operator.options["axis"]
    if not -rank <= axis < rank:
        raise ValueError(f"axis {axis} of {rank}")
    axis %= rank
    images = rank == IMAGE_RANK
    pieces = [writer.take(index, images=images) for index in operator.inputs]
    name = writer.add("Concat", pieces, axis=TO_FIRST.index(axis) if images else axis)
    writer.finish(operator, name, images=images)


@_converts("PAD", 2, 2)
def _pad(writer: Writer, operator: Operator) -> None:
    image, pads = operator.inputs
    rank = len(writer.shape(image))
    widths = writer.constant(pads, np.integer, 2).astype(np.int64)
    if widths.shape != (rank, 2) or widths.min(initial=0) < 0:
        raise ValueError(f"pad widths {widths.tolist()}")
    images = rank == IMAGE_RANK
    if images:
        widths = widths[list(TO_FIRST)]
    inputs = [writer.take(image, images=images), writer.store(widths.T.reshape(-1))]
    name = writer.add("Pad", inputs, mode="constant")
    writer.finish(operator, name, images=images)


@_converts("RESHAPE", 1, 2)
def _reshape(writer: Writer, operator: Operator) -> None:
    # The target, in an option or a second input, may hold a -1; the result's own shape does not.
    shape = np.array(writer.shape(operator.outputs[0]), np.int64)
    if math.prod(writer.shape(operator.inputs[0])) != math.prod(shape.tolist()):
        raise ValueError(f"shape {shape.tolist()} from {writer.shape(operator.inputs[0])}")
    name = writer.add("Reshape", [writer.channels_last(operator.inputs[0]), writer.store(shape)])
    writer.finish(operator, name, images=False)


@_converts("LOGISTIC", 1, 1)
@_converts("RELU", 1, 1)
def _elementwise(writer: Writer, operator: Operator) -> None:
    kind = {"LOGISTIC": "Sigmoid", "RELU": "Relu"}[operator.kind]
    images = operator.inputs[0] in writer.first
    name = writer.add(kind, [writer.take(operator.inputs[0], images=images)])
    writer.finish(operator, name, images=images)


@_converts("DEQUANTIZE", 1, 1)
@_converts("DENSIFY", 1, 1)
def _fold(writer: Writer, operator: Operator) -> None:
    """Turn a constant into the float32 constant it stands for; reading made it dense."""
    values = writer.constants.get(operator.inputs[0])
    target = writer.graph.tensors[operator.outputs[0]]
    if values is None or values.dtype.kind != "f" or values.shape != target.shape:
        raise ValueError(f"no constant floats of shape {target.shape}")
    writer.constants[operator.outputs[0]] = values.astype(target.dtype)
