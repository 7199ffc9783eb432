"""Pictures of a virtual hall, by ray casting with exact geometry."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.geometry.camera import Camera
from virtualgym.hall.hall import Scene
from virtualgym.hall.quads import Quad
from virtualgym.rendering import rays, sensor, shading, textured_quads

NEAR_M = 0.1  # least depth of the hall's centre, for the motion blur
GRIDS = 4  # cameras whose ray grids are cached


class Renderer:
    """A scene, ready to be rendered."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.surfaces = textured_quads.Surfaces(scene.quads)
        self._grids: dict[tuple, NDArray] = {}
        self._extra: textured_quads.Surfaces | None = None

    def render(
        self,
        camera: Camera,
        *,
        twist: tuple[ArrayLike, ArrayLike] | None = None,
        readout_s: float = 0.0,
        exposure_s: float = 0.0,
        extra: list[Quad] | None = None,
        noise: float = 0.0,
        rng: np.random.Generator | None = None,
        row_warp_px: NDArray | None = None,
        light: NDArray | None = None,
    ) -> NDArray:
        """Render a picture.

        Parameters
        ----------
        camera : Camera
            Its pose is that at mid-exposure of the middle row.
        twist : ((3,) float, (3,) float) or None
            The camera's angular velocity w in its own frame, rad/s: after a short time t,
            world_from_cam = world_from_cam(0) exp([w t]x), so that positive w about y (down) turns
            the view to the right; and the velocity of its centre in the world, m/s.
        readout_s : float
            Rolling shutter: row v is exposed at ((v + 0.5) / H - 0.5) * readout_s.
        exposure_s : float
            Of each row, for motion blur.
        extra : list of Quad or None
            Additional surfaces for this picture only, such as people.
        noise : float
            Standard deviation of the sensor's noise, 8-bit levels.
        rng : numpy.random.Generator or None
            For the noise.
        row_warp_px : (2, 2) float or None
            How a stabiliser bends the rows, by `row_warp.shifts`.
        light : (H,) float or None
            Factor on the light of each row.

        Returns
        -------
        picture : (H, W, 3) uint8
            BGR; the first pixel's centre is at (0, 0).
        """
        xy = self._grid(camera, row_warp_px)
        seen = rays.of_camera(camera, xy, twist, readout_s)
        parts = [self.surfaces]
        if extra:
            self._extra = textured_quads.Surfaces(extra, earlier=self._extra)
            parts.append(self._extra)
        picture = shading.Exposure(self.scene, parts, seen).picture()
        if light is not None:
            picture *= np.asarray(light, np.float32)[:, None, None]
        return sensor.develop(
            picture,
            xy,
            motion_px=self._motion_px(camera, twist, exposure_s),
            noise=noise,
            rng=rng,
        )

    def _grid(self, camera: Camera, row_warp_px: NDArray | None) -> NDArray:
        warp = b"" if row_warp_px is None else row_warp_px.tobytes()
        key = (camera.name, camera.size, camera.K.tobytes(), camera.dist.tobytes(), warp)
        if key not in self._grids:
            while len(self._grids) >= GRIDS:
                self._grids.pop(next(iter(self._grids)))
            self._grids[key] = rays.grid(camera, row_warp_px)
        return self._grids[key]

    def _motion_px(
        self, camera: Camera, twist: tuple[ArrayLike, ArrayLike] | None, exposure_s: float
    ) -> tuple[float, float]:
        """Return the picture's movement during the exposure, px to the right and down."""
        if twist is None or exposure_s <= 0:
            return 0.0, 0.0
        # ASSUME: everything moves as the hall's centre does; roll and parallax are neglected.
        middle = np.mean(self.scene.room_m, axis=0) * [1, 1, 0.2]
        angular, velocity = (np.asarray(part, dtype=float) for part in twist)
        rotation = camera.cam_from_world[:, :3]
        at = rotation @ middle + camera.cam_from_world[:, 3]
        rate = -np.cross(angular, at) - rotation @ velocity
        depth = max(at[2], NEAR_M)
        focal = np.diag(camera.K)[:2]
        across, down = focal * (rate[:2] - at[:2] / depth * rate[2]) / depth * exposure_s
        return across, down
