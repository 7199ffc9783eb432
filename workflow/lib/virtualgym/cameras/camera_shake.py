"""Cameras that should stand still and do not: a tripod that trembles, and one that somebody knocks."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import BarycentricInterpolator
from scipy.spatial.transform import Rotation

from courtside.geometry import camera as cameras

WAVES = 7  # of a tremor, per axis
WAVES_HZ = 0.5, 8.0
NODES = 16  # per axis: a small turn moves the picture so evenly that this is exact to 1e-4 px


@dataclass(frozen=True)
class Shake:
    """How a fixed camera moves: it turns about its centre, which stays.

    Attributes
    ----------
    tremor_px : float
        Root mean square of the picture's movement, per axis, px.
    knock_s : float or None
        When the camera is knocked, on the reference clock.
    knock_deg : float
        By how much the knock turns it, for good, about an axis that is drawn at random.
    """

    tremor_px: float = 0.0
    knock_s: float | None = None
    knock_deg: float = 0.0

    def __post_init__(self):
        if min(self.tremor_px, self.knock_deg) < 0 or (self.knock_deg > 0) == (
            self.knock_s is None
        ):
            raise ValueError(
                "expected tremor_px >= 0, and knock_s with knock_deg > 0 or neither, found "
                f"{self.tremor_px}, {self.knock_s}, {self.knock_deg}"
            )


class Shaking:
    """The movement of one camera.

    Parameters
    ----------
    shake : Shake
    camera : courtside.geometry.camera.Camera
        As it stands before.
    rng : numpy.random.Generator
    """

    def __init__(self, shake, camera, rng):
        self.shake, self.camera = shake, camera
        self._hz = np.exp(rng.uniform(*np.log(WAVES_HZ), (2, WAVES)))
        self._phase = rng.uniform(0, 2 * np.pi, (2, WAVES))
        strength = rng.uniform(0.3, 1.0, (2, WAVES)) / np.sqrt(self._hz)  # slow waves are large
        strength *= np.sqrt(2 / (strength**2).sum(axis=1, keepdims=True))
        # About the axis down the picture moves across, about the other it moves up and down.
        self._turn = strength * shake.tremor_px / np.diag(camera.K)[1::-1, None]
        axis = rng.standard_normal(3)
        self._knock = np.radians(shake.knock_deg) * axis / np.linalg.norm(axis)

    def still_from_shaken(self, time_s):
        """Return the rotation (3, 3) from the camera's axes at a time to its axes before."""
        wave = np.sin(2 * np.pi * self._hz * time_s + self._phase)
        turn = Rotation.from_rotvec([*(self._turn * wave).sum(axis=1), 0.0])
        if self.shake.knock_s is not None and time_s >= self.shake.knock_s:
            turn = Rotation.from_rotvec(self._knock) * turn
        return turn.as_matrix()

    def camera_at(self, time_s):
        """Return the camera as it stands at a time."""
        return turned(self.camera, self.still_from_shaken(time_s))

    def reach_px(self):
        """Return how far the picture moves at most, whole px."""
        angle = np.hypot(*np.abs(self._turn).sum(axis=1)) + np.linalg.norm(self._knock)
        # Nothing is farther from the centre than the corner, where the picture moves the most.
        corner = np.hypot(*self.camera.size) / 2 / np.diag(self.camera.K)[:2].min()
        return int(np.ceil(1.2 * angle * np.diag(self.camera.K).max() * (1 + corner**2)))


def turned(camera, still_from_shaken):
    """Return a camera after a turn about its centre, by a rotation (3, 3)."""
    pose = still_from_shaken.T @ camera.cam_from_world
    return replace(camera, cam_from_world=pose)


class Warp:
    """Where each pixel of a turned camera looks in a picture that it took before.

    Parameters
    ----------
    camera : courtside.geometry.camera.Camera
        The lens and the size of the pictures wanted.
    before : courtside.geometry.camera.Camera
        The same lens, as the picture that there is has it: perhaps wider.
    """

    def __init__(self, camera, before):
        self.size = camera.size
        self.before = replace(before, cam_from_world=np.eye(3, 4))
        nodes = -np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES)
        places = [(nodes + 1) / 2 * length - 0.5 for length in camera.size]
        seen = cameras.undistort(camera, np.stack(np.meshgrid(*places), axis=-1))
        self._seen = np.concatenate([seen, np.ones((NODES, NODES, 1))], axis=-1)
        self._across, self._down = (
            BarycentricInterpolator(place, np.eye(NODES))(np.arange(length)).astype(np.float32)
            for place, length in zip(places, camera.size, strict=True)
        )

    def places(self, still_from_shaken):
        """Return the px (2, H, W) float32 of the picture before that each pixel sees.

        Parameters
        ----------
        still_from_shaken : (3, 3) float
        """
        xy = cameras.project(self.before, self._seen @ still_from_shaken.T).astype(np.float32)
        return np.stack([self._down @ xy[..., axis] @ self._across.T for axis in (0, 1)])
