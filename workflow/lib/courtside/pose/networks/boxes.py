"""Persons as upright boxes: YOLOX, and networks that suppress overlapping boxes themselves.

YOLOX: Ge et al. 2021, its exported grid decoded here. The others, such as RTMDet as mmdeploy
exports it, give boxes (`dets`: left, top, right, bottom, score) and classes (`labels`).
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from courtside.pose import detector
from courtside.pose.detector import Region
from courtside.pose.networks import inputs
from courtside.pose.networks.inputs import Input
from courtside.pose.networks.session import Network

STRIDES = (8, 16, 32)  # of YOLOX's three grids, px
OVERLAP = 0.45  # boxes that overlap more (intersection over union) are one person: YOLOX's own
BOX = 4  # numbers of a box


class BoxDetector:
    """A person detector whose decoder is "yolox" or "end-to-end".

    Persons are of the class `person_class`, at least as sure as `min_score`, 0 to 1, and as high as
    `min_height` px of the network's input.
    """

    def __init__(
        self,
        network: Network,
        given: Input,
        *,
        decoder: str,
        person_class: int = 0,
        min_score: float = 0.3,
        min_height: float = 16,
    ) -> None:
        self.network, self.given = network, given
        self.decode = {"yolox": self._yolox, "end-to-end": self._end_to_end}[decoder]
        self.person_class, self.min_score, self.min_height = person_class, min_score, min_height
        self.side_px = max(given.size)

    def detect(self, image: NDArray) -> list[Region]:
        """Return the regions of all persons in a (H, W, 3) uint8 BGR picture, best first."""
        window = inputs.letterbox(image.shape, self.given.size, centred=False)
        patch = window.cut(image, inputs.PADDING)
        box, score = self.decode(self.network.run(self.given.tensor(patch)))
        kept = chosen(box, score, self.min_score, self.min_height)
        corners = window.to_picture(box[kept].reshape(-1, 2, 2) / self.given.size)
        return [detector.around_box(low, high) for low, high in corners]

    def _yolox(self, outputs: Sequence[NDArray]) -> tuple[NDArray, NDArray]:
        found, grid = outputs[0], cells(self.given.size)
        fits = found.ndim == 3 and found.shape[:2] == (1, len(grid))
        if not fits or found.shape[2] <= BOX + 1 + self.person_class:
            raise self.network.fault(
                f"YOLOX's grid (1, {len(grid)}, 5 + classes), without suppression", found.shape
            )
        rows = found[0].astype(float)
        x_y, stride = grid[:, :2], grid[:, 2:]
        middle = (rows[:, :2] + x_y) * stride
        half = np.exp(np.clip(rows[:, 2:4], -20, 20)) * stride / 2
        return np.hstack([middle - half, middle + half]), rows[:, 4] * rows[
            :, 5 + self.person_class
        ]

    def _end_to_end(self, outputs: Sequence[NDArray]) -> tuple[NDArray, NDArray]:
        shapes = [one.shape for one in outputs]
        fits = shapes[0][:1] == (1,) and len(shapes[0]) == 3 and shapes[0][2] == BOX + 1
        fits = fits and len(outputs) <= 2 and all(s == shapes[0][:2] for s in shapes[1:])
        if not fits:
            raise self.network.fault("boxes (1, N, 5) and perhaps classes (1, N)", shapes)
        rows = outputs[0][0].astype(float)
        if len(outputs) == 2:
            rows = rows[outputs[1][0] == self.person_class]
        return rows[:, :BOX], rows[:, BOX]


def cells(size: Sequence[int]) -> NDArray:
    """Return column, row and stride of each cell of YOLOX's grids, (N, 3)."""
    found = []
    for stride in STRIDES:
        rows, columns = np.mgrid[: size[1] // stride, : size[0] // stride]
        same = np.full(rows.size, stride)
        found.append(np.stack([columns.ravel(), rows.ravel(), same], axis=1))
    return np.concatenate(found).astype(float)


def chosen(box: NDArray, score: NDArray, min_score: float, min_height: float) -> list[int]:
    """Return the indices of boxes (N, 4), left, top, right, bottom, that are persons, best first.

    Of boxes that overlap, the one with the best score is kept.
    """
    high = (box[:, 3] - box[:, 1] >= min_height) & (box[:, 2] > box[:, 0])
    rest = np.flatnonzero((score >= min_score) & high & np.isfinite(box).all(axis=1))
    rest = rest[np.argsort(-score[rest], kind="stable")]
    kept: list[int] = []
    while len(rest):
        kept.append(int(rest[0]))
        rest = rest[overlap(box[rest[0]], box[rest]) <= OVERLAP]
        rest = rest[rest != kept[-1]]
    return kept


def overlap(one: NDArray, many: NDArray) -> NDArray:
    """Return intersection over union of one box with boxes (N, 4): left, top, right, bottom."""
    low, high = np.maximum(one[:2], many[:, :2]), np.minimum(one[2:], many[:, 2:])
    shared = np.prod(np.clip(high - low, 0, None), axis=1)
    area = np.prod(many[:, 2:] - many[:, :2], axis=1)
    return shared / (np.prod(one[2:] - one[:2]) + area - shared)
