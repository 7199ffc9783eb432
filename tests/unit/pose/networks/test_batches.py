"""A network that states sizes of one picture answers for several as for each alone."""

import numpy as np
import onnxruntime
import pytest

from courtside.pose.networks import batches
from fixtures.recordings import onnx_files


@pytest.fixture
def enlarger(tmp_path):
    """Write a network that enlarges its one picture and lays its values in a row."""
    graph = onnx_files.Graph([1, 3, 8, 8])
    large = graph.add("Resize", "image", "", "", graph.ints(1, 3, 16, 16), mode="linear")
    graph.output(graph.add("Reshape", large, graph.ints(1, -1)), "row")
    return graph.write(tmp_path / "n.onnx")


@pytest.mark.parametrize("count", [1, 2, 5])
def test_several_pictures_give_what_each_gives_alone(enlarger, count):
    pictures = np.random.default_rng(0).random((count, 3, 8, 8), np.float32)
    alone = onnxruntime.InferenceSession(str(enlarger))
    together = onnxruntime.InferenceSession(batches.of_size(enlarger, count))
    (found,) = together.run(None, {"image": pictures})
    expected = [alone.run(None, {"image": one[None]})[0] for one in pictures]
    assert found.shape == (count, 3 * 16 * 16)
    np.testing.assert_array_equal(found, np.concatenate(expected))
