"""One-stage networks: boxes and joints of all persons of a picture at once.

RTMO (Lu et al. 2024), as mmdeploy exports it: `dets` (1, N, 5) and `keypoints` (1, N, J, 3).
YOLO-pose (Maji et al. 2022), as Ultralytics exports YOLOv8-pose: (1, 5 + 3 J, N), without
suppression. Such a network is its own person detector, and looks again at the region of a person
whom it follows.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from courtside.pose import detector
from courtside.pose.detector import LandmarkNetwork, Pose, Region
from courtside.pose.networks import inputs
from courtside.pose.networks.boxes import BOX, chosen
from courtside.pose.networks.inputs import Input, Window
from courtside.pose.networks.session import Network

Found = tuple[NDArray, NDArray, NDArray]  # boxes (N, 4) px, scores (N,), joints (N, J, 3)
NEAR = 0.5  # of the region's side: persons with middles further off are somebody else


class OneStage(LandmarkNetwork):
    """A one-stage network, decoder "rtmo" or "yolo-pose": a detector and a landmark network."""

    def __init__(
        self,
        network: Network,
        given: Input,
        *,
        decoder: str,
        n_joints: int,
        min_score: float = 0.3,
        min_height: float = 16,
    ) -> None:
        self.network, self.given, self.n_joints = network, given, n_joints
        self.decode = {"rtmo": self._rtmo, "yolo-pose": self._yolo_pose}[decoder]
        self.centred = decoder == "yolo-pose"
        self.min_score, self.min_height = min_score, min_height
        self.side_px = max(given.size)

    def detect(self, image: NDArray) -> list[Region]:
        """Return the regions of all persons in a (H, W, 3) uint8 BGR picture, best first."""
        window = inputs.letterbox(image.shape, self.given.size, centred=self.centred)
        box, _, _ = self._look(image, window)
        return [detector.around_box(low, high) for low, high in box.reshape(-1, 2, 2)]

    def estimate(self, image: NDArray, region: Region) -> Pose:
        """Return the `Pose` of the person in the middle of a `Region` of such a picture.

        The confidence that somebody is there is the score of the box, 0 without one.
        """
        scale = region.side / min(self.given.size)
        sides = (scale * self.given.size[0], scale * self.given.size[1])
        box, score, joints = self._look(image, Window(region.x, region.y, *sides, self.given.size))
        centre = np.array([region.x, region.y])
        off = np.linalg.norm((box[:, :2] + box[:, 2:]) / 2 - centre, axis=1)
        nothing = np.full((self.n_joints, 3), np.nan)
        if not len(off) or off.min() > NEAR * region.side:
            xy = np.tile(centre, (self.n_joints, 1))
            return Pose(xy, np.zeros(self.n_joints), nothing, 0.0, region)
        at = int(np.argmin(off))
        return Pose(
            xy=joints[at, :, :2],
            score=np.clip(joints[at, :, 2], 0, 1),
            xyz_in_body=nothing,
            presence=float(min(score[at], 1.0)),
            region=detector.around_box(box[at, :2], box[at, 2:]),
        )

    def _look(self, image: NDArray, window: Window) -> Found:
        """Return what a window shows, in px of the picture, best first."""
        patch = window.cut(image, inputs.PADDING)
        box, score, joints = self.decode(self.network.run(self.given.tensor(patch)))
        kept = chosen(box, score, self.min_score, self.min_height)
        corners = window.to_picture(box[kept].reshape(-1, 2, 2) / self.given.size)
        found = joints[kept]
        found[..., :2] = window.to_picture(found[..., :2] / self.given.size)
        return corners.reshape(-1, BOX), score[kept], found

    def _rtmo(self, outputs: Sequence[NDArray]) -> Found:
        shapes = [one.shape for one in outputs]
        n = shapes[0][1] if len(shapes[0]) == 3 else 0
        if shapes != [(1, n, BOX + 1), (1, n, self.n_joints, 3)]:
            raise self.network.fault(
                f"boxes (1, N, 5) and joints (1, N, {self.n_joints}, 3) as its skeleton has", shapes
            )
        rows, joints = outputs[0][0].astype(float), outputs[1][0].astype(float)
        return rows[:, :BOX], rows[:, BOX], joints

    def _yolo_pose(self, outputs: Sequence[NDArray]) -> Found:
        shape, wanted = outputs[0].shape, BOX + 1 + 3 * self.n_joints
        if len(shape) != 3 or shape[:2] != (1, wanted):
            raise self.network.fault(
                f"(1, {wanted}, N): a box, its score and {self.n_joints} joints of three numbers, "
                "as its skeleton has",
                shape,
            )
        rows = outputs[0][0].T.astype(float)
        middle, half = rows[:, :2], rows[:, 2:BOX] / 2
        joints = rows[:, BOX + 1 :].reshape(-1, self.n_joints, 3)
        return np.hstack([middle - half, middle + half]), rows[:, BOX], joints
