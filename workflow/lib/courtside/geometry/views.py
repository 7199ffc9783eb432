"""Keypoints of several calibrated cameras, and Newton's way to the points that they show."""

import numpy as np

from courtside.geometry import cameras as camera_models
from courtside.geometry import small_matrices


class Views:
    """Keypoints of C cameras on the normalised plane.

    Parameters
    ----------
    cameras : list of Camera, length C
    xy : (C, N, 2) float
        Px, distorted as in the pictures; NaN where unseen.
    weight : (C, N) float
        In px^-2, relative to score 1.
    """

    def __init__(self, cameras, xy, weight):
        self.xy = np.stack(
            [camera_models.undistort(c, points) for c, points in zip(cameras, xy, strict=True)]
        )
        self.weight = np.where(np.isfinite(self.xy).all(axis=-1), weight, 0.0)
        self.xy = np.nan_to_num(self.xy)
        self.matrix = np.stack([camera.cam_from_world for camera in cameras])
        self.focal_px = np.array([(c.K[0, 0] + c.K[1, 1]) / 2 for c in cameras])

    def of(self, at):
        """Return the same views of some of the points only."""
        part = object.__new__(Views)
        part.xy, part.weight = self.xy[:, at], self.weight[:, at]
        part.matrix, part.focal_px = self.matrix, self.focal_px
        return part

    def residuals(self, xyz):
        """Return residuals (C, N, 2) px and points in each camera (C, N, 3) m."""
        rotation, shift = self.matrix[:, :, :3], self.matrix[:, :, 3]
        in_cam = xyz[None] @ rotation.transpose(0, 2, 1) + shift[:, None]
        depth = np.where(np.abs(in_cam[..., 2:]) < 1e-9, 1e-9, in_cam[..., 2:])
        residual = (in_cam[..., :2] / depth - self.xy) * self.focal_px[:, None, None]
        return residual, in_cam

    def normal(self, in_cam, weight, residual=None):
        """Return J'WJ (N, 3, 3), and J'Wr (N, 3) where residuals are given."""
        scale = self.focal_px[:, None] / in_cam[..., 2]
        ratio = in_cam[..., :2] / in_cam[..., 2:]
        rows = self.matrix[:, None, :2, :3] - ratio[..., None] * self.matrix[:, None, 2:3, :3]
        rows = rows * scale[..., None, None]
        weighted = rows * weight[..., None, None]
        flat = rows.transpose(1, 0, 2, 3).reshape(rows.shape[1], -1, 3)
        flat_weighted = weighted.transpose(1, 3, 0, 2).reshape(rows.shape[1], 3, -1)
        square = flat_weighted @ flat
        if residual is None:
            return square, None
        right = residual.transpose(1, 0, 2).reshape(rows.shape[1], -1, 1)
        return square, (flat_weighted @ right)[..., 0]

    def stepped(self, xyz, weight):
        """Return points (N, 3) after a Gauss-Newton step; one whose system is singular stays."""
        residual, in_cam = self.residuals(xyz)
        square, right = self.normal(in_cam, weight, residual)
        return xyz - np.nan_to_num(small_matrices.solve_3x3(square, right))

    def distance(self, xyz):
        """Return how far keypoints are from the projected points, (C, N) px."""
        residual, _ = self.residuals(xyz)
        return np.sqrt(np.einsum("cni,cni->cn", residual, residual))

    def in_front(self, xyz, which):
        """Return which points (N,) are before all those cameras that `which` (C, N) names."""
        _, in_cam = self.residuals(xyz)
        return ((in_cam[..., 2] > 0) | ~which).all(axis=0)
