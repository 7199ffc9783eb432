"""A planned session for tests: two cameras and a walk in a hall round a badminton court."""

from pathlib import Path

import numpy as np

from courtside.calibration.court import court
from courtside.calibration.planning import cameras
from courtside.calibration.planning.tie_points import TEXTURES

CONFIG = Path(__file__).parents[1] / "config"
COURT = court.read(CONFIG / "courts" / "badminton.yaml")
PLAN = CONFIG / "plans" / "plain-a.yaml"
SIZE, FOCAL_PX = (1280, 720), 1120.0
CENTRE = np.array([3.05, 6.7, 0.0])
HALL_M = CENTRE + np.array([[-23, -23, 0], [23, 23, 10]])
PLAIN = TEXTURES["plain"]
# What `sfm.model.lens_prior` says of three pictures of this size, written out.
LENS_MEAN = np.tile([1280, 1, 639.5, 359.5, 0, 0, 0, 0], (3, 1)).astype(float)
LENS_SIGMA = np.tile([np.inf, 1e-3, 25.6, 25.6, 0.2, 0.2, 2e-3, 2e-3], (3, 1))
WEIGHTS = {
    "images_per_part": 40,
    "tie_sigma": 2.0,
    "click_sigma_px": 0.7,
    "click_bias_px": 0.5,
    "click_loss": 4.0,
}
THINNING = {"min_angle_deg": 1.5, "max_error_px": 8.0, "max_points": 2000, "seed": 0}


def from_centre(*offset):
    """Return a place by its distance from the court's centre on the floor, m."""
    return CENTRE + np.array(offset)


def fixed():
    """Return two cameras that look along the court's sides."""
    places = {"side": from_centre(-21, 0, 1.9), "back": from_centre(0, -21, 2.1)}
    aim = from_centre(0, 0, 1.3)
    return [
        cameras.camera(name, place, aim, SIZE, focal_px=FOCAL_PX) for name, place in places.items()
    ]


def walked(count, seed=0):
    """Return the images of a walk round the corner, from one camera to the other."""
    angles = np.radians(np.linspace(182.2, 267.8, 5))
    way_m = CENTRE[:2] + 21 * np.column_stack([np.cos(angles), np.sin(angles)])
    aim = from_centre(0, 0, 1.25)
    return cameras.walked_cameras(way_m, count, 1.62, aim, SIZE, seed=seed, focal_px=FOCAL_PX)
