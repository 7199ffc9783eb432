"""Shake of fixed cameras: a tremor of the tripod, and a knock."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from courtside.geometry import camera as camera_models
from courtside.geometry.camera import Camera
from virtualgym.cameras import chebyshev

# ASSUME: number of sines of a tremor per axis, and their frequencies, for a tripod on a floor.
WAVES = 7
WAVES_HZ = 0.5, 8.0
# ASSUME: how far a tripod creeps between the pictures of the empty court and the take, and again in
# each minute of the take, px at 1280 px width; no source is recorded.
CREEP_PX = 1.0
NODES = 16  # per axis: for small turns the interpolation is exact to 1e-4 px


@dataclass(frozen=True)
class Shake:
    """Rotations of a fixed camera about its centre, which stays.

    Attributes
    ----------
    tremor_px : float
        Root mean square of the picture's movement, per axis, px.
    knock_s : float or None
        Time of the knock on the reference clock.
    knock_deg : float
        Lasting rotation by the knock, about a random axis.
    """

    tremor_px: float = 0.0
    knock_s: float | None = None
    knock_deg: float = 0.0

    def __post_init__(self) -> None:
        if min(self.tremor_px, self.knock_deg) < 0 or (self.knock_deg > 0) == (
            self.knock_s is None
        ):
            raise ValueError(
                "expected tremor_px >= 0, and knock_s with knock_deg > 0 or neither, found "
                f"{self.tremor_px}, {self.knock_s}, {self.knock_deg}"
            )


class Shaking:
    """The movement of one camera from its pose at rest.

    Beside its shake it creeps in a random direction, by `creep` times `CREEP_PX`.
    """

    def __init__(
        self, shake: Shake, camera: Camera, rng: np.random.Generator, creep: float = 0.0
    ) -> None:
        self.shake, self.camera = shake, camera
        slowest, fastest = np.log(WAVES_HZ)
        self._hz = np.exp(rng.uniform(slowest, fastest, (2, WAVES)))
        self._phase = rng.uniform(0, 2 * np.pi, (2, WAVES))
        strength = rng.uniform(0.3, 1.0, (2, WAVES)) / np.sqrt(self._hz)  # slow waves are larger
        strength *= np.sqrt(2 / (strength**2).sum(axis=1, keepdims=True))
        # A turn about the camera's y moves the picture across, one about its x moves it up or down.
        self._turn = strength * shake.tremor_px / np.diag(camera.K)[1::-1, None]
        axis = rng.standard_normal(3)
        self._knock = np.radians(shake.knock_deg) * axis / np.linalg.norm(axis)
        way = rng.uniform(0, 2 * np.pi)
        creep_px = creep * CREEP_PX * camera.size[0] / 1280
        self._creep = creep_px * np.array([np.sin(way), np.cos(way)]) / np.diag(camera.K)[1::-1]

    def still_from_shaken(self, time_s: float) -> NDArray:
        """Return the rotation (3, 3) from the camera's axes at a time to its axes at rest."""
        wave = np.sin(2 * np.pi * self._hz * time_s + self._phase)
        crept = self._creep * (1 + time_s / 60)
        turn = Rotation.from_rotvec([*((self._turn * wave).sum(axis=1) + crept), 0.0])
        if self.shake.knock_s is not None and time_s >= self.shake.knock_s:
            turn = Rotation.from_rotvec(self._knock) * turn
        return turn.as_matrix()

    def camera_at(self, time_s: float) -> Camera:
        """Return the camera at a time."""
        return turned(self.camera, self.still_from_shaken(time_s))

    def reach_px(self, until_s: float = 0.0) -> int:
        """Return an upper limit of the picture's movement up to a time, whole px."""
        angle = np.hypot(*np.abs(self._turn).sum(axis=1)) + np.linalg.norm(self._knock)
        angle += np.linalg.norm(self._creep) * (1 + max(until_s, 0.0) / 60)
        # The picture moves most in its corners, which are farthest from the centre.
        corner = np.hypot(*self.camera.size) / 2 / np.diag(self.camera.K)[:2].min()
        return int(np.ceil(1.2 * angle * np.diag(self.camera.K).max() * (1 + corner**2)))


def turned(camera: Camera, still_from_shaken: NDArray) -> Camera:
    """Return a camera turned about its centre by a rotation (3, 3)."""
    pose = still_from_shaken.T @ camera.cam_from_world
    return replace(camera, cam_from_world=pose)


class Warp:
    """Maps the pixels of a turned camera to a picture that it took before.

    Parameters
    ----------
    camera : Camera
        Lens and size of the new pictures.
    before : Camera
        The same lens with the size of the existing picture, which may be wider.
    """

    def __init__(self, camera: Camera, before: Camera) -> None:
        self.size = camera.size
        self.before = replace(before, cam_from_world=np.eye(3, 4))
        places = np.meshgrid(*(chebyshev.nodes(side, NODES) for side in camera.size))
        seen = camera_models.undistort(camera, np.stack(places, axis=-1))
        self._seen = np.concatenate([seen, np.ones((NODES, NODES, 1))], axis=-1)
        self._across, self._down = (
            chebyshev.to_pixels(side, NODES).astype(np.float32) for side in camera.size
        )

    def places(self, still_from_shaken: NDArray) -> NDArray:
        """Return the place (2, H, W) float32, px of the existing picture, that each pixel sees."""
        xy = camera_models.project(self.before, self._seen @ still_from_shaken.T).astype(np.float32)
        return np.stack([self._down @ xy[..., axis] @ self._across.T for axis in (0, 1)])
