"""Networks that place the joints of one person in a crop: heat maps, or SimCC lines.

Heat maps: convolutional pose machines (Wei et al. 2016), HRNet, ViTPose. SimCC (Li et al. 2022),
one line of bins for x and one for y per joint: RTMPose. Crops are upright, since such networks are
not trained on rotated persons; they are cut as mmpose and rtmlib do.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from courtside.pose import detector
from courtside.pose.detector import LandmarkNetwork, Pose, Region
from courtside.pose.networks import peaks
from courtside.pose.networks.inputs import Input, Window
from courtside.pose.networks.session import Network
from courtside.study.errors import InputError, StrPath

# ASSUME: a body grows by less than this from one frame to the next, head and hands included.
MARGIN = 1.3  # the next region is the joints' extent times this
BOX_OF_JOINTS = 1.25  # a person's box is the joints' extent times this, as in rtmlib's tracking
CONFIDENT = 0.3  # joints below this score do not count for it, if others do
ENOUGH = 4  # ASSUME: so many confident joints show a person's extent
WIDTH_SHARE = 0.5  # ASSUME: width of an upright person, in heights, where only a circle is known


@dataclass(frozen=True)
class HeatMaps:
    """One heat map per joint, (1, J, H, W), or (1, H, W, J) where the input is nhwc.

    The `cells` "centre": a cell's centre lies half a cell in; "corner": cell 0 lies at the crop's
    first pixel, and cells are as far apart as the sizes' quotient (mmpose's MSRA maps); "udp": the
    first and the last cell lie at the crop's first and last pixel (Huang et al. 2020).
    """

    n_joints: int
    layout: str
    cells: str
    refine: str  # "parabola" or "dark"

    @property
    def ends_inside(self) -> bool:
        """Whether the crop ends in the middle of the last pixel."""
        return self.cells == "udp"

    def read(self, network: Network, outputs: Sequence[NDArray]) -> list[NDArray]:
        """Return the maps, (H, W, J)."""
        maps = outputs[0]
        if maps.ndim != 4 or len(maps) != 1 or not maps.size:
            raise network.fault("heat maps of one picture, 4 dimensions", maps.shape)
        maps = maps[0].transpose(1, 2, 0) if self.layout == "nchw" else maps[0]
        check_joints(network.path, maps.shape[2], self.n_joints)
        return [maps]

    def mirror(self, arrays: Sequence[NDArray]) -> float:
        """Return where cells change places."""
        width = arrays[0].shape[1]
        return float(sum(self._fraction(np.array([[0, 0], [width - 1, 0]]), arrays[0])[:, 0]))

    def mirrored(self, arrays: Sequence[NDArray], pairs: Sequence[int]) -> list[NDArray]:
        """Return the maps with left and right exchanged."""
        return [arrays[0][:, ::-1][..., pairs]]

    def place(self, arrays: Sequence[NDArray]) -> tuple[NDArray, NDArray]:
        """Return the joints and their scores."""
        (maps,) = arrays
        cells = peaks.dark(maps) if self.refine == "dark" else peaks.parabola(maps)
        return self._fraction(cells, maps), peaks.values(maps)

    def _fraction(self, cells: NDArray, maps: NDArray) -> NDArray:
        size = np.array([maps.shape[1], maps.shape[0]])
        if self.cells == "centre":
            return (cells + 0.5) / size
        return cells / (size - 1 if self.cells == "udp" else size)


@dataclass(frozen=True)
class SimCC:
    """One line of bins for x and one for y per joint, (1, J, N) each; `split` bins per pixel.

    Heights of peaks are scores as shares of `full_score`. Some networks have no highest one: what
    exceeds 1 is kept, for `tracking.limited` to see.
    """

    n_joints: int
    size: Sequence[int]  # of the input, px
    split: float
    full_score: float
    ends_inside = False

    def read(self, network: Network, outputs: Sequence[NDArray]) -> list[NDArray]:
        """Return the lines, (J, N) for x and for y."""
        shapes = [one.shape for one in outputs]
        if len(outputs) != 2 or any(len(shape) != 3 or shape[0] != 1 for shape in shapes):
            raise network.fault("two outputs of shape (1, joints, bins): SimCC's x and y", shapes)
        for shape in shapes:
            check_joints(network.path, shape[1], self.n_joints)
        wanted = [round(side * self.split) for side in self.size]
        if [shape[2] for shape in shapes] != wanted:
            raise network.fault(
                f"{wanted} bins for x and y (input.size times `split`)", [s[2] for s in shapes]
            )
        return [one[0] for one in outputs]

    def mirror(self, arrays: Sequence[NDArray]) -> float:
        """Return where bins change places."""
        return (arrays[0].shape[1] - 1) / arrays[0].shape[1]

    def mirrored(self, arrays: Sequence[NDArray], pairs: Sequence[int]) -> list[NDArray]:
        """Return the lines with left and right exchanged."""
        return [arrays[0][pairs][:, ::-1], arrays[1][pairs]]

    def place(self, arrays: Sequence[NDArray]) -> tuple[NDArray, NDArray]:
        """Return the joints, and the lower peak of their two lines as the score."""
        found = [peaks.lines(one) for one in arrays]
        fraction = [bins / one.shape[1] for (bins, _), one in zip(found, arrays, strict=True)]
        height = np.minimum(found[0][1], found[1][1])
        return np.stack(fraction, axis=1), np.maximum(height, 0) / self.full_score


# The outputs of a network as arrays that can be averaged, and what they mean.
Maps = HeatMaps | SimCC


def check_joints(path: StrPath, found: int, wanted: int) -> None:
    """Raise an `InputError` if a network has another number of joints than its skeleton."""
    if found != wanted:
        raise InputError(
            f"{path}: expected {wanted} joints as in its skeleton, found {found}; "
            "correct `skeleton` in config/models.yaml"
        )


class TopDown(LandmarkNetwork):
    """A landmark network whose outputs are maps of one person.

    The person's box times `padding`, brought to the input's aspect, is the crop; without `padding`
    it is the square of the region itself. With the index of each joint's other side in `pairs`,
    the mirrored crop is looked at too, and the maps are averaged. The mean score of the
    `presence_joints` is the confidence that a person is there.
    """

    def __init__(
        self,
        network: Network,
        given: Input,
        maps: Maps,
        *,
        n_joints: int,
        presence_joints: Sequence[int],
        padding: float | None = None,
        pairs: Sequence[int] | None = None,
    ) -> None:
        self.network, self.given, self.maps = network, given, maps
        self.n_joints, self.presence_joints = n_joints, presence_joints
        self.padding, self.pairs = padding, pairs

    def estimate_each(self, image: NDArray, regions: Sequence[Region]) -> list[Pose]:
        """Return the `Pose` of the person in each `Region` of a (H, W, 3) uint8 BGR picture."""
        windows = [self._window(region) for region in regions]
        looks = self._run([window.cut(image) for window in windows])
        if self.pairs is not None:
            pairs = zip(windows, looks, strict=True)
            again = self._run([w.cut(image, mirror=self.maps.mirror(look)) for w, look in pairs])
            again = [self.maps.mirrored(look, self.pairs) for look in again]
            looks = [
                [(a + b) / 2 for a, b in zip(*both, strict=True)]
                for both in zip(looks, again, strict=True)
            ]
        return [self._pose(*pair) for pair in zip(looks, windows, strict=True)]

    def _pose(self, arrays: Sequence[NDArray], window: Window) -> Pose:
        fraction, score = self.maps.place(arrays)
        xy = window.to_picture(fraction)
        return Pose(
            xy=xy,
            score=score,
            xyz_in_body=np.full((len(xy), 3), np.nan),
            presence=float(np.minimum(score[self.presence_joints], 1).mean()),
            region=around(xy) if self.padding is None else around_person(xy, score),
        )

    def _run(self, patches: Sequence[NDArray]) -> list[list[NDArray]]:
        found = self.network.run_each([self.given.tensor(patch) for patch in patches])
        return [self.maps.read(self.network, outputs) for outputs in found]

    def _window(self, region: Region) -> Window:
        size, inside = self.given.size, self.maps.ends_inside
        if self.padding is None:
            return Window(region.x, region.y, region.side, region.side, size, inside)
        width, height = (side * self.padding for side in box_of(region))
        aspect = size[0] / size[1]
        width, height = max(width, height * aspect), max(height, width / aspect)
        return Window(region.x, region.y, width, height, size, inside)


def box_of(region: Region) -> tuple[float, float]:
    """Return width and height of the upright box of a region's person, px.

    Without a box, a person stands along the turned region, and is half as wide as high.
    """
    if region.box is not None:
        return region.box
    height = region.side / detector.SIDE_OF_BOX
    along, across = abs(np.cos(region.angle_rad)), abs(np.sin(region.angle_rad))
    box = (height * (across + WIDTH_SHARE * along), height * (along + WIDTH_SHARE * across))
    return float(box[0]), float(box[1])


def around(xy: NDArray) -> Region:
    """Return the upright region around joints (J, 2), px."""
    low, high = xy.min(axis=0), xy.max(axis=0)
    side = MARGIN * float((high - low).max())
    x, y = (low + high) / 2
    return Region(float(x), float(y), max(side, 1.0))


def around_person(xy: NDArray, score: NDArray) -> Region:
    """Return the region of the person with joints (J, 2) px and scores (J,), with its box."""
    confident = score >= CONFIDENT
    xy = xy[confident] if confident.sum() >= ENOUGH else xy
    low, high = xy.min(axis=0), xy.max(axis=0)
    more = (high - low) * (BOX_OF_JOINTS - 1) / 2 + 0.5  # never empty
    return detector.around_box(low - more, high + more)
