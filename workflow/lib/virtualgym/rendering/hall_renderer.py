"""Pictures of a virtual hall, by ray casting with exact geometry."""

import numpy as np

from virtualgym.rendering import rays, sensor, shading, textured_quads

NEAR_M = 0.1  # the middle of the hall is taken to be no nearer than this
GRIDS = 4  # cameras whose ray grids are kept


class Renderer:
    """A scene made ready for pictures.

    Parameters
    ----------
    scene : virtualgym.hall.hall.Scene
    """

    def __init__(self, scene):
        self.scene = scene
        self.surfaces = textured_quads.Surfaces(scene.quads)
        self._grids, self._extra = {}, None

    def render(
        self, camera, *, twist=None, readout_s=0.0, exposure_s=0.0, extra=None, noise=0.0, rng=None
    ):
        """Take a picture.

        Parameters
        ----------
        camera : courtside.geometry.camera.Camera
            Its pose is that at mid-exposure of the middle row.
        twist : ((3,) float, (3,) float) or None
            How the camera moves. First its angular velocity w in its own frame, rad/s: after a short time t,
            world_from_cam = world_from_cam(0) exp([w t]x), so that positive w about y (down) turns the view
            to the right. Then the velocity of its centre in the world, m/s.
        readout_s : float
            Rolling shutter: row v is exposed at ((v + 0.5) / H - 0.5) * readout_s.
        exposure_s : float
            Of each row, for motion blur.
        extra : list of surfaces.Quad or None
            More of the scene for this picture only, such as people.
        noise : float
            Of the sensor, standard deviation in 8-bit levels.
        rng : numpy.random.Generator or None
            For the noise.

        Returns
        -------
        picture : (H, W, 3) uint8
            BGR; the first pixel's centre is at (0, 0).
        """
        xy = self._grid(camera)
        seen = rays.of_camera(camera, xy, twist, readout_s)
        parts = [self.surfaces]
        if extra:
            self._extra = textured_quads.Surfaces(extra, earlier=self._extra)
            parts.append(self._extra)
        picture = shading.Exposure(self.scene, parts, seen).picture()
        return sensor.develop(
            picture,
            xy,
            motion_px=self._motion_px(camera, twist, exposure_s),
            noise=noise,
            rng=rng,
        )

    def _grid(self, camera):
        key = (camera.name, camera.size, camera.K.tobytes(), camera.dist.tobytes())
        if key not in self._grids:
            while len(self._grids) >= GRIDS:
                self._grids.pop(next(iter(self._grids)))
            self._grids[key] = rays.grid(camera)
        return self._grids[key]

    def _motion_px(self, camera, twist, exposure_s):
        """Return how far the picture moves during the exposure."""
        if twist is None or exposure_s <= 0:
            return 0.0, 0.0
        # ASSUME: everything moves as the middle of the hall does; roll and parallax are left out.
        middle = np.mean(self.scene.room_m, axis=0) * [1, 1, 0.2]
        angular, velocity = (np.asarray(part, dtype=float) for part in twist)
        rotation = camera.cam_from_world[:, :3]
        at = rotation @ middle + camera.cam_from_world[:, 3]
        rate = -np.cross(angular, at) - rotation @ velocity
        depth = max(at[2], NEAR_M)
        focal = np.diag(camera.K)[:2]
        return tuple(focal * (rate[:2] - at[:2] / depth * rate[2]) / depth * exposure_s)
