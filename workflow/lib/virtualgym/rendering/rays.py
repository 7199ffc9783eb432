"""The rays of a picture's pixels, also while the camera moves."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

from courtside.geometry import camera as camera_models
from courtside.geometry import rotations as transforms
from courtside.geometry.camera import Camera
from virtualgym.cameras import chebyshev, row_warp

BAND_RAYS = 1 << 16  # per batch: fits the processor's cache
NODES = 28  # per axis: the lens is smooth, so this interpolation is exact to 1e-9 px


def grid(camera: Camera, row_warp_px: NDArray | None = None) -> NDArray:
    """Return the point (2, H, W) float32 on the z = 1 plane that each pixel's centre sees.

    A stabiliser may have moved the picture's rows, by `row_warp.shifts`.

    Raises
    ------
    ValueError
        If the lens model does not cover the picture.

    Notes
    -----
    `camera.undistort` at Chebyshev nodes, and a polynomial between them.
    """
    xy = np.stack(np.meshgrid(*(chebyshev.nodes(side, NODES) for side in camera.size)), axis=-1)
    if row_warp_px is not None:
        xy += np.moveaxis(row_warp.shifts(row_warp_px, xy[..., 1], camera.size[1]), 0, -1)
    seen = camera_models.undistort(camera, xy)
    if not np.isfinite(seen).all():
        raise ValueError(
            f"camera {camera.name}: expected a lens that fills the picture, found {camera.dist}"
        )
    across, down = (chebyshev.to_pixels(side, NODES) for side in camera.size)
    return np.stack([down @ seen[..., axis] @ across.T for axis in (0, 1)]).astype(np.float32)


@dataclass(frozen=True, eq=False)
class Rays:
    """All rays of one picture.

    Attributes
    ----------
    xy : (2, H, W) float32
        From `grid`.
    eye : (3,) float
        The camera's centre at mid-exposure of the middle row; world, metres.
    velocity : (3,) float or None
        Of the centre, m/s; None if the camera stands still.
    world_from_cam : (H or 1, 3, 3) float32
        Rotation of each row, or of all.
    time_s : (H,) float32
        Exposure time of each row, from that of the middle one.
    steps : (2, 3) float
        Change of a direction in the world per pixel to the right, and per pixel down.
    """

    xy: np.ndarray
    eye: np.ndarray
    velocity: np.ndarray | None
    world_from_cam: np.ndarray
    time_s: np.ndarray
    steps: np.ndarray

    @property
    def moving(self) -> bool:
        """Whether the camera moves during the readout."""
        return self.velocity is not None

    def of_band(self, start: int, stop: int) -> tuple[NDArray, NDArray | None]:
        """Return directions (3, n) and times (n,) or None of all pixels of rows start to stop-1."""
        x, y = self.xy[:, start:stop]
        row = np.arange(start, stop)
        direction = _turn(self._turns(row)[..., None], x, y).reshape(3, -1)
        return direction, self._times(np.repeat(row, x.shape[1]))

    def bands(self) -> Iterator[tuple[slice, NDArray]]:
        """Yield parts of the flattened picture, of whole rows, and directions (3, n) of each."""
        height, width = self.xy.shape[1:]
        rows = max(1, BAND_RAYS // width)
        for start in range(0, height, rows):
            direction, _ = self.of_band(start, min(start + rows, height))
            yield slice(start * width, start * width + direction.shape[1]), direction

    def near(
        self, pixel: NDArray, offsets: Sequence[tuple[float, float]] | NDArray = ((0.0, 0.0),)
    ) -> tuple[Iterator[NDArray], NDArray | None]:
        """Return directions (3, n) for each offset, and times (n,) or None, of some pixels.

        Parameters
        ----------
        pixel : (n,) intp
            Row times width plus column.
        offsets : sequence of (2,) float
            From the pixels' centres, to the right and down, px.

        Returns
        -------
        directions : iterator of (3, n) float32
        time_s : (n,) float32 or None
        """
        width = self.xy.shape[2]
        row, column = np.divmod(pixel, width)
        before, above = np.maximum(column - 1, 0), np.maximum(row - 1, 0)
        after, below = (
            np.minimum(before + 2, width - 1),
            np.minimum(above + 2, self.xy.shape[1] - 1),
        )
        across = (self.xy[:, row, after] - self.xy[:, row, before]) / (after - before)
        down = (self.xy[:, below, column] - self.xy[:, above, column]) / (below - above)
        centre, turn = self.xy[:, row, column], self._turns(row)
        beside = (centre + (dx * across + dy * down).astype(np.float32) for dx, dy in offsets)
        return (_turn(turn, *xy) for xy in beside), self._times(row)

    def halved(self) -> "Rays":
        """Return the rays of a picture of half the size, each the mean of four."""
        height, width = (2 * (length // 2) for length in self.xy.shape[1:])
        xy = self.xy[:, :height, :width]
        left, right = xy[..., ::2], xy[..., 1::2]  # `mean` over two axes takes ten times as long
        four = (left[:, ::2] + right[:, ::2]) + (left[:, 1::2] + right[:, 1::2])
        rows = slice(0, height, 2) if self.moving else slice(None)
        return Rays(
            four / np.float32(4),
            self.eye,
            self.velocity,
            self.world_from_cam[rows],
            self.time_s[:height].reshape(-1, 2).mean(axis=1),
            self.steps * 2,
        )

    def origins(self, time_s: NDArray | None) -> NDArray:
        """Return the origins (n, 3), or (3,) for all, float32, of rays of these times."""
        eye = self.eye.astype(np.float32)
        if time_s is None or self.velocity is None:
            return eye
        start = np.empty((len(time_s), 3), np.float32)
        for axis, speed in enumerate(self.velocity.astype(np.float32)):
            np.add(time_s * speed, eye[axis], out=start[:, axis])
        return start

    def _turns(self, row: NDArray) -> NDArray:
        """Return the rotations (3, 3, n) of rows (n,), or one for all (3, 3, 1)."""
        rotations = self.world_from_cam.transpose(1, 2, 0)
        return rotations[:, :, row] if self.moving else rotations

    def _times(self, row: NDArray) -> NDArray | None:
        return self.time_s[row] if self.moving else None


def of_camera(
    camera: Camera, xy: NDArray, twist: tuple[ArrayLike, ArrayLike] | None, readout_s: float
) -> Rays:
    """Return the rays of a picture.

    Parameters
    ----------
    camera : Camera
        At mid-exposure of the middle row.
    xy : (2, H, W) float32
        From `grid`.
    twist : ((3,) float, (3,) float) or None
        Angular velocity in the camera's own frame, rad/s, and velocity of its centre in the world,
        m/s.
    readout_s : float
        H times the delay from one row to the next.
    """
    world_from_cam = camera.cam_from_world[:, :3].T
    height = xy.shape[1]
    time_s = ((np.arange(height) + 0.5) / height - 0.5) * readout_s
    steps = (world_from_cam[:, :2] / np.diag(camera.K)[:2]).T
    rotation, velocity = world_from_cam[None], None
    if twist is not None and readout_s > 0:
        angular, velocity = (np.asarray(part, dtype=float) for part in twist)
        rotation = world_from_cam @ Rotation.from_rotvec(time_s[:, None] * angular).as_matrix()
    eye = transforms.invert(camera.cam_from_world)[:, 3]
    return Rays(xy, eye, velocity, rotation.astype(np.float32), time_s.astype(np.float32), steps)


def _turn(rotation: NDArray, x: NDArray, y: NDArray) -> NDArray:
    """Rotate rays (x, y, 1) by rotations (3, 3, ...) that broadcast with them; (3, ...)."""
    return np.stack([right * x + down * y + ahead for right, down, ahead in rotation])
