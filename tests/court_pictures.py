"""Pictures of a court drawn from its model by plain polygons: what cameras would see, and where exactly."""

import itertools
from pathlib import Path

import cv2
import numpy as np

from courtside.calibration.court import court as courts
from courtside.geometry import camera as cameras

ROOT = Path(__file__).parents[1]
SIZE = (960, 540)
FINE = 8  # drawn so many times larger, then averaged
SHIFT = 4  # bits of sub-pixel precision of the polygons
FLOOR, PAINT, POST, WALL = (84, 132, 172), (226, 232, 236), (62, 58, 52), (150, 170, 180)
DOT = (0, 255, 0)
DOT_PX = 2.5


def badminton():
    return courts.read(ROOT / "config" / "courts" / "badminton.yaml")


def looking(name, centre, target, *, f=900.0, size=SIZE, dist=(-0.04, 0.01, 1e-4, -1e-4, 0)):
    """Return a camera at `centre` that looks at `target`, metres."""
    centre = np.asarray(centre, float)
    forward = np.asarray(target, float) - centre
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, [0, 0, 1.0])
    right /= np.linalg.norm(right)
    rotation = np.array([right, np.cross(forward, right), forward])
    K = np.array([[f, 0, size[0] / 2 + 3], [0, f, size[1] / 2 - 2], [0, 0, 1]])
    pose = np.column_stack([rotation, -rotation @ centre])
    return cameras.Camera(name, size, K, np.array(dist), pose)


def pair(size=SIZE, f=900.0):
    """Return two cameras that see the whole court: from behind it, and from a corner."""
    wide = {"f": f, "size": size}
    return [
        looking("back", (3.4, -9.0, 3.2), (3.05, 6.0, 0.2), **wide),
        looking("oblique", (-5.5, -4.0, 3.0), (3.3, 6.2, 0.1), **wide),
    ]


def draw(camera, court, *, noise=0.0, seed=0, hidden=(), dots=False):
    """Return the picture (H, W, 3) uint8, BGR.

    Parameters
    ----------
    camera : Camera
    court : Court
    noise : float
        Standard deviation, levels.
    seed : int
    hidden : sequence of (x0, y0, x1, y1)
        Mats on the floor, metres, that cover lines.
    dots : bool
        A green disc on each court point.
    """
    width, height = camera.size
    canvas = np.full((height * FINE, width * FINE, 3), WALL, np.uint8)
    _fill(canvas, camera, _rectangle([-3, -3.5, 9.1, 17]), FLOOR)
    for line in court.lines_m:
        _fill(canvas, camera, _rectangle(line), PAINT)
    for mat in hidden:
        _fill(canvas, camera, _rectangle(mat), (90, 60, 60))
    if court.net is not None:
        for x in court.net["x_m"]:
            _post(canvas, camera, x, court.net)
    if dots:
        for xy in cameras.project(camera, court.xyz):
            centre = np.round(((xy + 0.5) * FINE - 0.5) * 2**SHIFT).astype(int).tolist()
            cv2.circle(canvas, centre, int(DOT_PX * FINE * 2**SHIFT), DOT, -1, shift=SHIFT)
    image = cv2.resize(canvas, (width, height), interpolation=cv2.INTER_AREA).astype(float)
    image = cv2.GaussianBlur(image, (0, 0), 0.5)
    image += np.random.default_rng(seed).normal(0, noise, image.shape)
    return np.clip(np.round(image), 0, 255).astype(np.uint8)


def _rectangle(line, steps=60):
    """Return the outline of a rectangle on the floor in many steps, for the lens bends it, (n, 3) m."""
    x0, y0, x1, y1 = line
    corners = np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1], [x0, y0]], float)
    share = np.linspace(0, 1, steps, endpoint=False)[:, None]
    outline = [a + share * (b - a) for a, b in itertools.pairwise(corners)]
    return np.column_stack([np.concatenate(outline), np.zeros(4 * steps)])


def _fill(canvas, camera, xyz, colour):
    xy = cameras.project(camera, xyz)
    xy = xy[np.isfinite(xy).all(axis=1)]
    corners = ((xy + 0.5) * FINE - 0.5) * 2**SHIFT
    cv2.fillPoly(canvas, [np.round(corners).astype(np.int32)], colour, shift=SHIFT)


def _post(canvas, camera, x, net):
    """Draw an upright box of 40 mm as the outline of its silhouette."""
    half = 0.02
    corners = [
        [x + i * half, net["y_m"] + j * half, z]
        for i in (-1, 1)
        for j in (-1, 1)
        for z in (0, net["post_height_m"])
    ]
    xy = cameras.project(camera, np.array(corners))
    outline = cv2.convexHull(((xy + 0.5) * FINE - 0.5).astype(np.float32))[:, 0]
    cv2.fillPoly(canvas, [np.round(outline * 2**SHIFT).astype(np.int32)], POST, shift=SHIFT)
