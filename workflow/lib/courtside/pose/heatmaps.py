"""Networks that give one heat map per joint, such as convolutional pose machines.

Wei et al. 2016, "Convolutional Pose Machines": the family of networks that the badminton study
used.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from courtside.pose import detector
from courtside.pose.detector import Pose, Region
from courtside.study.errors import StrPath

# ASSUME: a body grows by less than this from one frame to the next, head and hands included.
MARGIN = 1.3  # the next region is the joints' extent times this
BLUR = (0.25, 0.5, 0.25)  # binomial: smooths a map before its peak is taken


class HeatmapLandmarks:
    """A landmark network with an (H, W, J) heat map as its only output.

    Black and white pixels become the values of `input_range`; `channels` is the channel order of
    its input, "rgb" or "bgr". The mean peak of the `presence_joints` is taken as the confidence
    that a person is there.
    """

    def __init__(
        self,
        onnx_path: StrPath,
        input_range: tuple[float, float],
        channels: str,
        presence_joints: Sequence[int],
    ) -> None:
        self.network = detector.open_network(onnx_path)
        source, target = self.network.get_inputs()[0], self.network.get_outputs()[0]
        self.input_name, self.side_px = source.name, source.shape[1]
        self.n_joints = target.shape[3]
        self.input_range, self.channels = input_range, channels
        self.presence_joints = presence_joints

    def estimate(self, image: NDArray, region: Region) -> Pose:
        """Return the `Pose` of the person in one `Region` of a (H, W, 3) uint8 BGR picture.

        The region is cut out upright: such networks are not trained on rotated persons.
        """
        region = Region(region.x, region.y, region.side)
        patch = detector.cut_out(image, region, self.side_px)
        patch = patch if self.channels == "bgr" else patch[:, :, ::-1]
        low, high = self.input_range
        tensor = patch.astype(np.float32)[None] * ((high - low) / 255) + low
        maps = self.network.run(None, {self.input_name: tensor.astype(np.float32)})[0][0]
        fraction, score = peaks(maps)
        xy = detector.to_picture(fraction, region)
        return Pose(
            xy=xy,
            score=score,
            xyz_in_body=np.full((len(xy), 3), np.nan),
            presence=float(score[self.presence_joints].mean()),
            region=around(xy),
        )


def peaks(maps: NDArray) -> tuple[NDArray, NDArray]:
    """Find the peak of each heat map (H, W, J) to a fraction of a cell, and its value, 0 to 1.

    Peaks (J, 2) are x, y as fractions of the region; a cell's centre lies half a cell in. The
    offset within a cell is the vertex of the parabola through the peak and its neighbours.
    """
    height, width, n_joints = maps.shape
    fraction = np.empty((n_joints, 2))
    smooth = _smooth(_smooth(maps, axis=0), axis=1)
    for joint in range(n_joints):
        row, column = divmod(int(np.argmax(smooth[..., joint])), width)
        x = column + _vertex(smooth[row, :, joint], column)
        y = row + _vertex(smooth[:, column, joint], row)
        fraction[joint] = (x + 0.5) / width, (y + 0.5) / height
    return fraction, np.clip(maps.max(axis=(0, 1)), 0, 1).astype(float)


def _smooth(maps: NDArray, axis: int) -> NDArray:
    padded = np.concatenate([maps.take([0], axis), maps, maps.take([-1], axis)], axis=axis)
    n = maps.shape[axis]
    return np.asarray(sum(w * padded.take(range(at, at + n), axis) for at, w in enumerate(BLUR)))


def _vertex(line: NDArray, at: int) -> float:
    if not 0 < at < len(line) - 1:
        return 0.0
    before, here, after = (float(line[at + step]) for step in (-1, 0, 1))
    bend = before - 2 * here + after
    return 0.5 * (before - after) / bend if bend < 0 else 0.0


def around(xy: NDArray) -> Region:
    """Return the upright region around joints (J, 2), px."""
    low, high = xy.min(axis=0), xy.max(axis=0)
    side = MARGIN * float((high - low).max())
    x, y = (low + high) / 2
    return Region(float(x), float(y), max(side, 1.0))
