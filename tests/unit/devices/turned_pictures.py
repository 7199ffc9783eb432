"""Pictures of a camera that turns, from mathematics: a far wall seen through a lens, noise, a person."""

import cv2
import numpy as np
from scipy.spatial.transform import Rotation

SIZE = 1280, 720
K = np.array([[960.0, 0, 637.0], [0, 960.0, 364.0], [0, 0, 1]])
DIST = np.array([-0.12, 0.03, 1e-3, -2e-3, 0.004])
CENTRE = (np.array(SIZE) - 1) / 2
WALL_PX = 900.0  # of the wall's picture per unit of the z = 1 plane
REACH = 1.0  # of the wall from its middle, on the z = 1 plane


def wall(seed, contrast=12.0):
    """Return a wall's picture, weak in contrast, with detail of two sizes."""
    side = round(2 * REACH * WALL_PX)
    noise = np.random.default_rng(seed).standard_normal((side, side)).astype(np.float32)
    parts = [cv2.GaussianBlur(noise, (0, 0), sigma) for sigma in (3, 12)]
    image = 120 + contrast * sum(part / part.std() for part in parts) / 1.4
    return np.dstack([np.clip(image, 0, 255).astype(np.uint8)] * 3)


class Turning:
    """A camera before a wall."""

    def __init__(self, seed=0):
        self.wall = wall(seed)
        x, y = np.meshgrid(*(np.arange(length, dtype=np.float32) for length in SIZE))
        seen = cv2.undistortPoints(np.stack([x, y], axis=-1).reshape(-1, 1, 2), K, DIST)[:, 0]
        self.directions = np.column_stack([seen, np.ones(len(seen), np.float32)])

    def picture(self, vector):
        """Return the picture after a turn by a rotation vector (camera as it is from as it was)."""
        rotation = Rotation.from_rotvec(vector).as_matrix().astype(np.float32)
        x, y, z = (self.directions @ rotation).T
        middle = REACH * WALL_PX
        places = [(middle + WALL_PX * part / z).reshape(SIZE[::-1]) for part in (x, y)]
        return cv2.remap(self.wall, *places, cv2.INTER_CUBIC, borderMode=cv2.BORDER_REFLECT)


def undistorted(xy):
    """Return where pixels (N, 2) look, on the z = 1 plane, to rounding."""
    often = cv2.TERM_CRITERIA_COUNT, 100, 0
    return cv2.undistortPoints(xy[:, None], K, DIST, criteria=often)[:, 0]


def true_movement(vector):
    """Return shift (2,) px of the centre's content and its turn there in degrees, by OpenCV's projection."""
    arms = np.array([[0, 0], [0.5, 0], [-0.5, 0], [0, 0.5], [0, -0.5]])
    seen = undistorted(CENTRE + arms)
    rotated = np.column_stack([seen, np.ones(5)]) @ Rotation.from_rotvec(vector).as_matrix().T
    moved = cv2.projectPoints(rotated[:, None], np.zeros(3), np.zeros(3), K, DIST)[0][:, 0]
    across, down = moved[1] - moved[2], moved[3] - moved[4]
    turn = np.arctan2(across[1] - down[0], across[0] + down[1])
    return moved[0] - CENTRE, np.degrees(turn)


class Grain:
    """Noise: each picture takes another window of one field."""

    def __init__(self, sigma, seed=0):
        self.rng = np.random.default_rng(seed)
        shape = SIZE[1] + 64, SIZE[0] + 64, 3
        self.field = (sigma * self.rng.standard_normal(shape, dtype=np.float32)).astype(np.int16)

    def added(self, picture):
        top, left = self.rng.integers(0, 65, 2)
        part = self.field[top : top + SIZE[1], left : left + SIZE[0]]
        return cv2.add(picture, part, dtype=cv2.CV_8U)
