"""Converted networks against Google's interpreter, and what the converter refuses."""

import functools

import cv2
import numpy as np
import onnxruntime
import pytest
import tflite

from courtside.pose.conversion import tflite_onnx, tflite_operators
from courtside.study.errors import InputError
from fixtures.recordings.real_data import REAL, needs_real
from fixtures.recordings.tflite_files import NETWORKS, Network, find, interpreter, sparse_rows

# Of the largest magnitude in an output: float32 keeps 6e-8, and the networks add in other orders
# through a hundred layers. The interpreter's own kernels (reference, optimised, XNNPACK) differ
# among themselves by up to 7e-4; the converted networks from the reference ones by 8e-5.
NETWORK_TOLERANCE = 2e-4
# The mask that the deepest one makes of noise, which nobody uses: its own kernels differ by 3.2e-4,
# the converted network by 2.9e-4. Its joints agree to 1.1e-5.
DEEP_TOLERANCE = {"pose_landmark_heavy.tflite": 4e-4}
# Outputs after a sigmoid may be as small as 1e-13, where only absolute differences mean something.
SMALLEST = 1e-6
# One operator: some hundred terms at most are added.
OPERATOR_TOLERANCE = 1e-5


def opened(path):
    """Return a function that runs a converted network; it is opened once."""
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = 1
    session = onnxruntime.InferenceSession(path, options)
    taken, names = session.get_inputs()[0].name, [output.name for output in session.get_outputs()]
    return lambda values: dict(zip(names, session.run(names, {taken: values}), strict=True))


def agree(results, expected, tolerance):
    assert list(results) == list(expected)
    for name, values in expected.items():
        assert results[name].shape == values.shape
        allowed = max(tolerance * np.abs(values).max(), SMALLEST)
        np.testing.assert_allclose(results[name], values, rtol=0, atol=allowed, err_msg=name)


def real_network(name):
    path = find(name)
    if path is None:
        pytest.skip(f"{name} is neither in shared/real nor fetched: see tests/README.md")
    return path


def noise(name, size):
    values = np.random.default_rng(5).random((1, size, size, 3), dtype=np.float32)
    return values * (255 if "mobile" in name else 1)


def photo(name, size):
    image = cv2.imread(str(REAL / "people" / "000000000785.jpg"))
    if image is None:
        pytest.skip(f"no photo in {REAL / 'people'}: see tests/README.md")
    image = cv2.resize(image, (size, size)).astype(np.float32)[None]
    # The 14-joint networks take blue, green, red from 0 to 255; BlazePose red, green, blue to 1.
    return image if "mobile" in name else np.ascontiguousarray(image[..., ::-1]) / 255


SIZES = dict(zip(NETWORKS, (256, 192, 192, 224, 256, 256), strict=True))


@pytest.fixture(scope="module")
def converted_once(tmp_path_factory):
    """Return a function that converts a real network, each only once."""

    @functools.cache
    def convert(path):
        target = tmp_path_factory.mktemp("converted") / "n.onnx"
        tflite_onnx.convert(path, target)
        return target

    return convert


@pytest.mark.parametrize("picture", [noise, photo])
@pytest.mark.parametrize("name", NETWORKS)
def test_a_real_network_computes_what_the_interpreter_does(converted_once, name, picture):
    path = real_network(name)
    values = picture(name, SIZES[name])
    run = opened(converted_once(path))
    results, expected = run(values), interpreter(path)(values)
    agree(results, expected, DEEP_TOLERANCE.get(name, NETWORK_TOLERANCE))
    # The picture must matter: another one moves the results by far more than the tolerance.
    moved = run(1 - values / values.max())
    first = next(iter(expected))
    distance = np.abs(moved[first] - expected[first]).max()
    assert distance > 10 * NETWORK_TOLERANCE * np.abs(expected[first]).max()


def converted(network, tmp_path):
    """Compare a small network of one image with the interpreter, on three random images."""
    path = network.write(tmp_path / "n.tflite")
    tflite_onnx.convert(path, tmp_path / "n.onnx")
    ours, theirs = opened(tmp_path / "n.onnx"), interpreter(path)
    shape = network.graph.tensors[network.graph.inputs[0]].shape
    for seed in range(3):
        # Beyond 6, so that activations cut at both ends.
        values = 8 * np.random.default_rng(seed).standard_normal(shape).astype(np.float32)
        agree(ours(values), theirs(values), OPERATOR_TOLERANCE)


def floats(*shape):
    return np.random.default_rng(9).standard_normal(shape).astype(np.float32)


def window(size, kernel, stride, dilation, same):
    """Return the result's size, from TensorFlow's definition of its two paddings."""
    if same:
        return tuple(-(-length // step) for length, step in zip(size, stride, strict=True))
    return tuple(
        (length - (taps - 1) * spread - 1) // step + 1
        for length, taps, step, spread in zip(size, kernel, stride, dilation, strict=True)
    )


WINDOWS = [
    ((3, 3), (1, 1), (1, 1)),
    ((3, 3), (2, 2), (1, 1)),
    ((2, 5), (1, 1), (1, 1)),
    ((4, 2), (3, 1), (1, 1)),
    ((5, 4), (2, 3), (1, 1)),
    ((3, 2), (1, 1), (2, 3)),
    ((1, 1), (2, 2), (1, 1)),
]


@pytest.mark.parametrize("same", [True, False])
@pytest.mark.parametrize(("kernel", "stride", "dilation"), WINDOWS)
@pytest.mark.parametrize("kind", ["CONV_2D", "DEPTHWISE_CONV_2D", "MAX_POOL_2D"])
def test_windows_give_the_interpreter_s_values(tmp_path, kind, kernel, stride, dilation, same):
    size, channels = (9, 12), 4
    network = Network()
    image = network.image(1, *size, channels)
    fields = {"padding": 0 if same else 1, "strideH": stride[0], "strideW": stride[1]}
    if kind == "MAX_POOL_2D":
        dilation, inputs, out = (1, 1), [image], channels
        options = "Pool2DOptions"
        fields |= {"filterHeight": kernel[0], "filterWidth": kernel[1]}
    elif kind == "CONV_2D":
        out, options = 6, "Conv2DOptions"
        inputs = [
            image,
            network.constant(floats(out, *kernel, channels)),
            network.constant(floats(out)),
        ]
        fields |= {"fusedActivationFunction": 3}
    else:
        out, options = 2 * channels, "DepthwiseConv2DOptions"
        inputs = [image, network.constant(floats(1, *kernel, out))]  # biases may be absent
        fields |= {"fusedActivationFunction": 1, "depthMultiplier": 2}
    if kind != "MAX_POOL_2D":
        fields |= {"dilationHFactor": dilation[0], "dilationWFactor": dilation[1]}
    shape = (1, *window(size, kernel, stride, dilation, same), out)
    network.add(kind, inputs, shape, options, **fields)
    converted(network, tmp_path)


def test_grouped_convolution_gives_the_interpreter_s_values(tmp_path):
    network = Network()
    image = network.image(1, 6, 5, 8)
    inputs = [image, network.constant(floats(6, 3, 3, 4)), network.constant(floats(6))]
    fields = {"padding": 0, "strideH": 1, "strideW": 1}
    network.add("CONV_2D", inputs, (1, 6, 5, 6), "Conv2DOptions", **fields)
    converted(network, tmp_path)


@pytest.mark.parametrize("size", [(8, 12), (7, 9), (1, 1), (2, 3), (4, 6)])
@pytest.mark.parametrize(("corners", "centers"), [(True, False), (False, True), (False, False)])
def test_resizing_gives_the_interpreter_s_values(tmp_path, size, corners, centers):
    network = Network()
    inputs = [network.image(1, 4, 6, 3), network.constant(np.array(size, np.int32))]
    fields = {"alignCorners": corners, "halfPixelCenters": centers}
    network.add("RESIZE_BILINEAR", inputs, (1, *size, 3), "ResizeBilinearOptions", **fields)
    converted(network, tmp_path)


@pytest.mark.parametrize("block", [1, 2, 3])
def test_depth_to_space_gives_the_interpreter_s_values(tmp_path, block):
    network = Network()
    image = network.image(1, 3, 4, 36)
    shape = (1, 3 * block, 4 * block, 36 // block**2)
    network.add("DEPTH_TO_SPACE", [image], shape, "DepthToSpaceOptions", blockSize=block)
    converted(network, tmp_path)


@pytest.mark.parametrize(
    ("shape", "axis"),
    [((2, 3, 4, 5), axis) for axis in range(-4, 4)] + [((1, 3, 4), axis) for axis in range(-3, 3)],
)
def test_concatenation_with_a_constant_gives_the_interpreter_s_values(tmp_path, shape, axis):
    longer = list(shape)
    longer[axis] += 2
    whole = list(shape)
    whole[axis] += longer[axis]
    network = Network()
    inputs = [network.image(*shape), network.constant(floats(*longer))]
    network.add("CONCATENATION", inputs, whole, "ConcatenationOptions", axis=axis)
    converted(network, tmp_path)


@pytest.mark.parametrize("activation", [0, 1, 3])
@pytest.mark.parametrize(
    ("shape", "other"),
    [
        ((1, 3, 4, 5), (1, 3, 4, 5)),
        ((1, 3, 4, 5), (5,)),
        ((1, 3, 4, 5), (4, 1)),
        ((1, 3, 4, 5), ()),
        ((2, 6), (6,)),
        ((2, 1), (2, 6)),
        ((3,), (1, 3, 4, 3)),  # the sum has more dimensions than the image
    ],
)
def test_addition_of_a_constant_gives_the_interpreter_s_values(tmp_path, shape, other, activation):
    network = Network()
    inputs = [network.constant(floats(*other)), network.image(*shape)]
    whole = np.broadcast_shapes(shape, other)
    network.add("ADD", inputs, whole, "AddOptions", fusedActivationFunction=activation)
    converted(network, tmp_path)


@pytest.mark.parametrize("widths", [[[0, 0], [1, 2], [3, 4], [0, 5]], [[1, 0], [0, 2], [0, 1]]])
@pytest.mark.parametrize("dtype", [np.int32, np.int64])
def test_padding_gives_the_interpreter_s_values(tmp_path, widths, dtype):
    shape = (1, 3, 4, 5)[-len(widths) :]
    network = Network()
    inputs = [network.image(*shape), network.constant(np.array(widths, dtype))]
    network.add("PAD", inputs, np.add(shape, np.sum(widths, 1)), "PadOptions")
    converted(network, tmp_path)


def test_layouts_meet_in_one_network(tmp_path):
    """Images go through both layouts: convolved, flattened, reshaped back, joined and returned."""
    network = Network()

    def shape(*lengths):
        return network.constant(np.array(lengths, np.int32))

    image = network.image(1, 4, 6, 3)
    fields = {"padding": 0, "strideH": 1, "strideW": 1}
    weights, biases = network.constant(floats(5, 3, 3, 3)), network.constant(floats(5))
    a = network.add("CONV_2D", [image, weights, biases], (1, 4, 6, 5), "Conv2DOptions", **fields)
    b = network.add("LOGISTIC", [a], (1, 4, 6, 5))
    c = network.add("RESHAPE", [b, shape(1, 6, 4, 5)], (1, 6, 4, 5))
    d = network.add("RELU", [c], (1, 6, 4, 5))
    e = network.add("RESHAPE", [d, shape(1, -1)], (1, 120))
    f = network.add("LOGISTIC", [e], (1, 120))
    g = network.add("RESHAPE", [f, shape(1, 4, 6, 5)], (1, 4, 6, 5))
    network.add("CONCATENATION", [a, g, image], (1, 4, 6, 13), "ConcatenationOptions", axis=3)
    network.graph.outputs = [*network.graph.outputs, a, d, f]
    converted(network, tmp_path)


def test_sparse_half_precision_weights(tmp_path):
    dense = floats(4, 3, 3, 6).astype(np.float16)
    dense[np.random.default_rng(2).random(dense.shape) < 0.7] = 0
    values, layout = sparse_rows(dense)
    network = Network()
    image = network.image(1, 5, 5, 6)
    stored = network.tensor(dense.shape, "float16", values, layout)
    whole = network.add("DENSIFY", [stored], dense.shape, dtype="float16")
    weights = network.add("DEQUANTIZE", [whole], dense.shape)
    biases = network.constant(floats(4))
    fields = {"padding": 0, "strideH": 1, "strideW": 1}
    network.add("CONV_2D", [image, weights, biases], (1, 5, 5, 4), "Conv2DOptions", **fields)
    converted(network, tmp_path)


@pytest.mark.parametrize("length", range(1, 20))
def test_same_padding_is_the_least_that_gives_the_length(length):
    for taps, stride, dilation in np.ndindex(6, 4, 3):
        window, stride, dilation = taps + 1, stride + 1, dilation + 1
        before, after = tflite_operators.same_padding(length, window, stride, dilation)
        # TensorFlow: ceil(length / stride) results; the window's reach decides how far they see.
        results = -(-length // stride)
        seen = (results - 1) * stride + (window - 1) * dilation + 1
        assert 0 <= before <= after <= before + 1
        assert before + after == max(seen - length, 0)


def test_outputs_left_out_change_no_other(converted_once, tmp_path):
    path = real_network("blazepose-lite-0.8.10.2.tflite")
    values = noise(path.name, 256)
    whole, part = converted_once(path), tmp_path / "some"
    tflite_onnx.convert(path, part, outputs=["Identity_4", "Identity"])
    results, expected = opened(part)(values), opened(whole)(values)
    assert list(results) == ["Identity", "Identity_4"]
    agree(results, {name: expected[name] for name in results}, 1e-6)
    assert part.stat().st_size < whole.stat().st_size
    with pytest.raises(InputError, match=r"among Identity, Identity_1, .*, found nonsense"):
        tflite_onnx.convert(path, tmp_path / "none", outputs=["Identity", "nonsense"])
    assert not (tmp_path / "none").exists()


@needs_real
def test_equal_networks_give_equal_bytes(converted_once, tmp_path):
    path = real_network(NETWORKS[0])
    tflite_onnx.convert(path, tmp_path / "again")
    assert (tmp_path / "again").read_bytes() == converted_once(path).read_bytes()


def refused(path, match):
    """Check that one line names file and fault, and that nothing is left behind."""
    target = path.parent / "out" / "n.onnx"
    with pytest.raises(InputError, match=match) as caught:
        tflite_onnx.convert(path, target)
    assert str(caught.value).startswith(str(path))
    assert "\n" not in str(caught.value)
    assert not target.parent.exists()


@needs_real
def test_an_unknown_operator_in_a_real_network_is_named(tmp_path):
    content = bytearray(real_network("cpm-mobile-14.tflite").read_bytes())
    model = tflite.Model.GetRootAs(content, 0)
    for place in range(model.OperatorCodesLength()):
        table = model.OperatorCodes(place)._tab
        at = table.Pos + table.Offset(4)
        if content[at] == tflite.BuiltinOperator.RELU:
            content[at] = tflite.BuiltinOperator.TANH
    path = tmp_path / "n.tflite"
    path.write_bytes(content)
    refused(path, r"found operator \d+ TANH: not one of ADD, .*RESIZE_BILINEAR; use another")


@needs_real
@pytest.mark.parametrize("share", [0.00001, 0.01, 0.3, 0.9, 0.9999])
def test_a_file_cut_short_is_refused(tmp_path, share):
    content = real_network("cpm-mobile-14.tflite").read_bytes()
    path = tmp_path / "n.tflite"
    path.write_bytes(content[: int(share * len(content))])
    refused(path, "expected a (whole )?TFLite")


def small(kind="RELU", shape=(1, 4, 4, 2), options=None, *constants, **fields):
    network = Network()
    image = network.image(1, 4, 4, 2)
    inputs = [image, *(network.constant(np.asarray(values)) for values in constants)]
    network.add(kind, inputs, shape, options, **fields)
    return network


CONV = {"padding": 0, "strideH": 1, "strideW": 1}


@pytest.mark.parametrize(
    ("network", "match"),
    [
        (small("ABS"), "operator 0 ABS: not one of"),
        (
            small("ADD", (1, 4, 4, 2), "AddOptions", floats(2), fusedActivationFunction=4),
            "0 ADD: fused activation TANH",
        ),
        (small("RELU", (1, 4, 4, 3)), r"0 RELU: expected a result of shape \(1, 4, 4, 3\)"),
        (small("LOGISTIC", (1, 4, 4, 2), None, floats(2)), "0 LOGISTIC: 2 inputs"),
        (small("DEQUANTIZE"), "0 DEQUANTIZE: no constant"),
        (small("RESHAPE", (1, 33)), "0 RESHAPE: shape"),
        (
            small(
                "CONV_2D",
                (1, 4, 4, 2),
                "Conv2DOptions",
                floats(2, 3, 3, 2),
                **CONV | {"strideH": 0},
            ),
            r"0 CONV_2D: stride_h stride_w \[0, 1\]",
        ),
        (
            small("CONV_2D", (1, 4, 4, 2), "Conv2DOptions", floats(2, 3, 3, 5), **CONV),
            "0 CONV_2D: weights for 5 channels on an image of 2",
        ),
        (
            small("CONV_2D", (1, 4, 4, 2), "Conv2DOptions", floats(2, 3, 3, 2), floats(3), **CONV),
            "0 CONV_2D: 3 biases for 2 channels",
        ),
        (
            small(
                "CONV_2D", (1, 4, 4, 2), "Conv2DOptions", np.ones((2, 3, 3, 2), np.float16), **CONV
            ),
            "0 CONV_2D: float16 of shape",
        ),
        (
            small(
                "DEPTHWISE_CONV_2D",
                (1, 4, 4, 3),
                "DepthwiseConv2DOptions",
                floats(1, 3, 3, 3),
                **CONV,
            ),
            "0 DEPTHWISE_CONV_2D: weights of shape",
        ),
        (
            small("MAX_POOL_2D", (1, 4, 4, 2), "Pool2DOptions", **CONV),
            r"0 MAX_POOL_2D: filter_height filter_width \[0, 0\]",
        ),
        (
            small(
                "RESIZE_BILINEAR",
                (1, 8, 8, 2),
                "ResizeBilinearOptions",
                np.array([8, 8], np.int32),
                alignCorners=True,
                halfPixelCenters=True,
            ),
            "0 RESIZE_BILINEAR: size .*align_corners True, half_pixel_centers True",
        ),
        (small("DEPTH_TO_SPACE", (1, 8, 8, 1), "DepthToSpaceOptions", blockSize=2), "blocks of 2"),
        (
            small("PAD", (1, 4, 4, 1), "PadOptions", np.array([[0, 0]] * 3 + [[0, -1]])),
            "0 PAD: pad",
        ),
        (small("CONCATENATION", (1, 4, 4, 2), "ConcatenationOptions", axis=4), "axis 4 of 4"),
    ],
)
def test_what_cannot_be_converted_is_named(tmp_path, network, match):
    refused(network.write(tmp_path / "n.tflite"), match)


def test_operators_out_of_order_are_refused(tmp_path):
    network = small()
    network.add("RELU", [1], (1, 4, 4, 2))
    network.graph.operators.reverse()
    refused(network.write(tmp_path / "a.tflite"), "0 RELU: tensor 1 used before it is made")
    network.graph.operators.reverse()
    network.graph.operators[1].outputs = [1]
    refused(network.write(tmp_path / "b.tflite"), "1 RELU: tensor 1 made twice")
    network.graph.operators.pop()
    refused(network.write(tmp_path / "c.tflite"), "output t2, found tensor 2 used before")


def test_integers_at_the_ends_are_refused(tmp_path):
    network = small()
    network.graph.tensors[0].type = 2
    refused(network.write(tmp_path / "a.tflite"), "expected t0 as float32, found int32")
    network = small()
    network.graph.tensors[1].type = 2
    refused(network.write(tmp_path / "b.tflite"), "0 RELU: a result of type int32")


def tables(content):
    """Return the places of all bytes but those of the weights, which may hold any value."""
    model = tflite.Model.GetRootAs(content, 0)
    kept = np.ones(len(content), bool)
    for place in range(model.BuffersLength()):
        buffer = model.Buffers(place)
        if buffer.DataLength() > 64:
            start = buffer._tab.Vector(buffer._tab.Offset(4))
            kept[start : start + buffer.DataLength()] = False
    return np.flatnonzero(kept)


def survive(content, tmp_path, rng, count):
    """Change bytes: each time one line or a network that loads; return how many were refused."""
    path, lines, places = tmp_path / "n.tflite", 0, tables(content)
    for _ in range(count):
        changed = bytearray(content)
        for at in rng.choice(places, rng.integers(1, 6)):
            changed[at] = rng.integers(256)
        path.write_bytes(changed)
        try:
            tflite_onnx.convert(path, tmp_path / "n.onnx")
        except InputError as error:
            assert str(error).startswith(str(path))
            assert "\n" not in str(error)
            lines += 1
        else:
            onnxruntime.InferenceSession(tmp_path / "n.onnx")
    return lines


def mixed():
    """Return a small network of many operators: mostly tables, where flipped bytes matter."""
    network = Network()
    image = network.image(1, 8, 8, 3)
    dense = floats(4, 3, 3, 3).astype(np.float16) * (floats(4, 3, 3, 3) > 0)
    values, layout = sparse_rows(dense)
    stored = network.tensor(dense.shape, "float16", values, layout)
    whole = network.add("DENSIFY", [stored], dense.shape, dtype="float16")
    weights = network.add("DEQUANTIZE", [whole], dense.shape)
    a = network.add("CONV_2D", [image, weights], (1, 8, 8, 4), "Conv2DOptions", **CONV)
    size = network.constant(np.array([16, 16], np.int32))
    b = network.add("RESIZE_BILINEAR", [a, size], (1, 16, 16, 4), "ResizeBilinearOptions")
    c = network.add("DEPTH_TO_SPACE", [b], (1, 32, 32, 1), "DepthToSpaceOptions", blockSize=2)
    fields = {"padding": 0, "strideH": 2, "strideW": 2, "filterHeight": 2, "filterWidth": 2}
    d = network.add("MAX_POOL_2D", [c], (1, 16, 16, 1), "Pool2DOptions", **fields)
    widths = network.constant(np.array([[0, 0], [0, 1], [0, 1], [0, 0]], np.int32))
    e = network.add("PAD", [d, widths], (1, 17, 17, 1), "PadOptions")
    f = network.add("ADD", [e, e], (1, 17, 17, 1), "AddOptions", fusedActivationFunction=1)
    network.add("RESHAPE", [f], (1, 289))
    return network


def test_changed_bytes_give_one_line_or_a_network(tmp_path):
    content = mixed().write(tmp_path / "whole.tflite").read_bytes()
    lines = survive(content, tmp_path, np.random.default_rng(1), 300)
    assert 100 < lines < 300


@pytest.mark.fuzz
@pytest.mark.parametrize("name", NETWORKS)
def test_changed_bytes_in_a_real_network(tmp_path, name):
    content = real_network(name).read_bytes()
    assert survive(content, tmp_path, np.random.default_rng(len(name)), 200) > 20


@pytest.mark.fuzz
@pytest.mark.parametrize("seed", range(5))
def test_many_changed_bytes(tmp_path, seed):
    content = mixed().write(tmp_path / "whole.tflite").read_bytes()
    assert survive(content, tmp_path, np.random.default_rng(seed), 4000) > 1000
