"""BlazePose: the person detector and the 33-joint landmark network of MediaPipe Pose.

Source: Bazarevsky et al. 2020, "BlazePose: On-device real-time body pose tracking". The steps
around the networks follow MediaPipe 0.10.21: the joints agree with it to about 2 px. Constants are
its own.
"""

import math
from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from courtside.pose import detector
from courtside.pose.detector import LandmarkNetwork, Pose, Region
from courtside.pose.networks.session import CPU, Network
from courtside.study.errors import StrPath

DETECTOR_SIDE = 224
LANDMARK_SIDE = 256
N_JOINTS = 33
ANCHOR_LAYERS = ((8, 2), (16, 2), (32, 6))  # (stride px, anchors per cell)
SURE_SCORE = 0.5  # from which MediaPipe believes a detection
OVERLAP_MERGED = 0.3  # detections that overlap more (intersection over union) are one person
REGION_MARGIN = 1.25
HEAT_MAP_REACH = 3  # a 7 x 7 window
HEAT_MAP_MIN = 0.5
# Chosen on players-dev: a joint that the picture and its mirror image place so far apart, in sides
# of the region, counts half.
DOUBTED = 0.03

# Landmarks (39, 2) as fractions of the crop; score (33,), presence, and metric joints (33, 3), m.
Seen = tuple[NDArray, NDArray, NDArray, NDArray]


def sigmoid(value: NDArray) -> NDArray:
    """Return the logistic function of an array, without overflow."""
    return 1 / (1 + np.exp(-np.clip(value, -80, 80)))


def anchors() -> NDArray:
    """Return the detector's anchor centres, (2254, 2) float32, as fractions of its input."""
    centres = []
    for stride, per_cell in ANCHOR_LAYERS:
        cells = DETECTOR_SIDE // stride
        y, x = np.mgrid[:cells, :cells]
        grid = np.stack([(x.ravel() + 0.5) / cells, (y.ravel() + 0.5) / cells], axis=1)
        centres.append(np.repeat(grid, per_cell, axis=0))
    return np.concatenate(centres).astype(np.float32)


def region_from_points(centre: NDArray, rim: NDArray) -> Region:
    """Return a person's region from the two points (2,) px that BlazePose gives for it.

    They are the hip centre and a point above it of the circle around the whole person, who stands
    upright in the region, with a margin of a quarter.
    """
    toward = np.asarray(rim) - centre
    angle_rad = math.pi / 2 - math.atan2(-toward[1], toward[0])
    angle_rad -= 2 * math.pi * math.floor((angle_rad + math.pi) / (2 * math.pi))
    side = 2 * float(np.hypot(*toward)) * REGION_MARGIN
    return Region(float(centre[0]), float(centre[1]), side, angle_rad)


class BlazePoseDetector:
    """The person detector of BlazePose (`pose_detection`, converted).

    Detections below the confidence `min_score`, 0 to 1, are dropped. It is low: of standing people
    100 to 300 px high one look in four reaches MediaPipe's 0.5, and three in four 0.2, which one in
    a hundred places without people reaches (crowd-dev). The landmark network judges them.
    """

    side_px = DETECTOR_SIDE

    def __init__(
        self,
        onnx_path: StrPath,
        min_score: float = 0.2,
        *,
        outputs: Sequence[str] | None = None,
        providers: Sequence[str] = CPU,
    ) -> None:
        shape = (1, DETECTOR_SIDE, DETECTOR_SIDE, 3)
        names = outputs or ("Identity", "Identity_1")
        self.network = Network(onnx_path, shape, outputs=names, providers=providers)
        self.min_score = min_score
        self.anchors = anchors()

    def detect(self, image: NDArray) -> list[Region]:
        """Return the regions of all persons in a (H, W, 3) uint8 BGR picture, best first."""
        height, width = image.shape[:2]
        whole = Region(width / 2, height / 2, max(height, width))
        patch = detector.cut_out(image, whole, DETECTOR_SIDE)[:, :, ::-1]
        tensor = patch.astype(np.float32)[None] * (2 / 255) - 1
        boxes, logits = self.network.run(tensor)
        score = sigmoid(logits[0, :, 0])
        kept = np.flatnonzero(score >= self.min_score)
        box = boxes[0, kept].astype(float) / DETECTOR_SIDE
        box += np.concatenate(
            [self.anchors[kept], np.zeros((len(kept), 2)), np.tile(self.anchors[kept], 4)], axis=1
        )
        merged = merge_overlapping(box, score[kept])
        points = [detector.to_picture(row[4:8].reshape(2, 2), whole) for row in merged]
        return [region_from_points(*pair) for pair in points]


def merge_overlapping(box: NDArray, score: NDArray) -> list[NDArray]:
    """Join overlapping detections (N, 4 + K) into their mean, weighted by score (N,), best first.

    A detection is centre x, y, width, height, then anything else to average. Sure detections are
    not averaged with others.
    """
    merged = []
    remaining = np.argsort(-score, kind="stable")
    while len(remaining):
        near = overlap(box[remaining[0]], box[remaining]) > OVERLAP_MERGED
        near[0] = True
        chosen = remaining[near]
        alike = chosen[(score[chosen] >= SURE_SCORE) == (score[chosen[0]] >= SURE_SCORE)]
        merged.append(np.average(box[alike], axis=0, weights=score[alike]))
        remaining = remaining[~near]
    return merged


def overlap(one: NDArray, many: NDArray) -> NDArray:
    """Return intersection over union of one box with (N, 4+) boxes; each is centre and size."""
    low = np.maximum(one[:2] - one[2:4] / 2, many[:, :2] - many[:, 2:4] / 2)
    high = np.minimum(one[:2] + one[2:4] / 2, many[:, :2] + many[:, 2:4] / 2)
    shared = np.prod(np.clip(high - low, 0, None), axis=1)
    return shared / (np.prod(one[2:4]) + np.prod(many[:, 2:4], axis=1) - shared)


class BlazePoseLandmarks(LandmarkNetwork):
    """The landmark network of BlazePose: `pose_landmark_lite`, `_full` or `_heavy`, converted.

    Outputs: Identity (39 x 5 landmarks), Identity_1 (presence), Identity_3 (heat maps), Identity_4
    (39 x 3 metric landmarks), or others named in this order.
    """

    n_joints = N_JOINTS

    def __init__(
        self,
        onnx_path: StrPath,
        *,
        outputs: Sequence[str] | None = None,
        providers: Sequence[str] = CPU,
        pairs: Sequence[int] | None = None,
    ) -> None:
        shape = (1, LANDMARK_SIDE, LANDMARK_SIDE, 3)
        names = outputs or ("Identity", "Identity_1", "Identity_3", "Identity_4")
        self.network = Network(onnx_path, shape, outputs=names, providers=providers, resizable=True)
        self.pairs = pairs

    def estimate_each(self, image: NDArray, regions: Sequence[Region]) -> list[Pose]:
        """Return the `Pose` of the person in each `Region` of a (H, W, 3) uint8 BGR picture."""
        patches = [self._patch(image, region) for region in regions]
        if self.pairs is not None:
            patches += [cv2.flip(patch, 1) for patch in patches]
        looks = [_seen(one) for one in self.network.run_each([_tensor(one) for one in patches])]
        if self.pairs is not None:
            n = len(regions)
            pairs = zip(looks[:n], looks[n:], strict=True)
            looks = [both(one, mirrored(other, self.pairs)) for one, other in pairs]
        return [self._pose(*pair) for pair in zip(looks, regions, strict=True)]

    @staticmethod
    def _patch(image: NDArray, region: Region) -> NDArray:
        patch = detector.cut_out(image, region, LANDMARK_SIDE, cv2.BORDER_REPLICATE)
        return cv2.cvtColor(patch, cv2.COLOR_BGR2RGB)

    @staticmethod
    def _pose(seen: Seen, region: Region) -> Pose:
        fraction, score, presence, xyz = seen
        xy = detector.to_picture(fraction, region)
        xyz[:, :2] = detector.rotate(xyz[:, :2], region.angle_rad)
        return Pose(
            xy=xy[:N_JOINTS],
            score=score,
            xyz_in_body=xyz,
            presence=float(presence),
            region=region_from_points(xy[N_JOINTS], xy[N_JOINTS + 1]),
        )


def _tensor(patch: NDArray) -> NDArray:
    return np.divide(patch, np.float32(255), dtype=np.float32)[None]


def _seen(outputs: Sequence[NDArray]) -> Seen:
    landmarks, presence, heat_maps, metric = outputs
    landmarks = landmarks.reshape(39, 5).astype(float)
    fraction = refine(landmarks[:, :2] / LANDMARK_SIDE, heat_maps[0])
    visible, present = sigmoid(landmarks[:N_JOINTS, 3]), sigmoid(landmarks[:N_JOINTS, 4])
    xyz = metric.reshape(39, 3)[:N_JOINTS].astype(float)
    return fraction, visible * present, presence.ravel()[0], xyz


def mirrored(seen: Seen, pairs: Sequence[int]) -> Seen:
    """Return what was seen in a mirrored crop as it is in the crop; `pairs` as in the class."""
    fraction, score, presence, xyz = seen
    joints = np.asarray(pairs)
    fraction = fraction[np.append(joints, np.arange(N_JOINTS, len(fraction)))]
    across = (LANDMARK_SIDE - 1) / LANDMARK_SIDE - fraction[:, :1]  # pixels change places
    return np.hstack([across, fraction[:, 1:]]), score[joints], presence, xyz[joints] * [-1, 1, 1]


def both(one: Seen, other: Seen) -> Seen:
    """Return the mean of two looks at a person, with lower scores where joints differ."""
    fraction, score, presence, xyz = ((a + b) / 2 for a, b in zip(one, other, strict=True))
    apart = np.linalg.norm(one[0] - other[0], axis=1)[:N_JOINTS]
    return fraction, score / (1 + (apart / DOUBTED) ** 2), presence, xyz


def refine(fraction: NDArray, heat_maps: NDArray) -> NDArray:
    """Move landmarks (J, 2), fractions of the region, to the centre of mass of the heat map around.

    `heat_maps` (H, W, J) are logits. A landmark stays if it lies outside, or no cell nearby reaches
    a probability of one half.
    """
    size = np.array(heat_maps.shape[1::-1])
    refined, cell = fraction.copy(), (fraction * size).astype(int)
    low, high = np.maximum(cell - HEAT_MAP_REACH, 0), np.minimum(cell + HEAT_MAP_REACH + 1, size)
    inside = ((cell >= 0) & (cell < size)).all(axis=1)
    whole = inside & (high - low == 2 * HEAT_MAP_REACH + 1).all(axis=1)
    # Whole windows together; those that the edge cuts, one by one.
    for joints in [np.flatnonzero(whole), *np.flatnonzero(inside & ~whole)[:, None]]:
        if len(joints):
            across, down = high[joints[0]] - low[joints[0]]
            columns = low[joints, :1] + np.arange(across)
            rows = low[joints, 1:] + np.arange(down)
            logits = heat_maps[rows[:, :, None], columns[:, None], joints[:, None, None]]
            weight = sigmoid(logits.astype(float))
            x = columns[:, None] @ weight.sum(axis=1)[:, :, None]
            y = rows[:, None] @ weight.sum(axis=2)[:, :, None]
            centre = np.concatenate([x, y], axis=2)[:, 0] / size
            each = weight.reshape(len(joints), -1)
            sure = each.max(axis=1) >= HEAT_MAP_MIN
            refined[joints[sure]] = (centre / each.sum(axis=1, keepdims=True))[sure]
    return refined
