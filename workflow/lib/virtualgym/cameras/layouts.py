"""Places and lenses of the fixed cameras of a virtual session."""

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.court.court import Court
from courtside.geometry.camera import Camera, look_at
from virtualgym.presets import Preset

# ASSUME: a phone's main camera and places as in a large hall; where no source stands, none is
# recorded.
FOCAL_WIDTHS = 0.875  # focal length in picture widths: 60 degrees across
LENS = np.array([-0.045, 0.011, 1e-4, 1e-4, 0.0])  # k1 k2 p1 p2 k3
AIM_M = 1.3  # height at the court's centre at which cameras are aimed
ROLL_DEG = 0.3  # a tripod levelled by eye
SQUARE_ON_M = 21.0  # layout a: distance from the court's centre
BEHIND_M = 18.0  # layout b: from the court's centre to the line on which the cameras stand
BESIDE_M = 20.0  # layout b: between neighbouring cameras
VIEW = 0.5  # tangent of the half angle of view that the court may fill
CORNER_DEG = 62.0  # layout corners: of the cameras from behind the court, seen from its centre
HEIGHTS_M = {
    "side": 1.9,
    "back": 2.1,
    "oblique": 1.9,
    "mirror": 2.0,
    "front": 2.2,
    "left": 2.9,
    "right": 2.7,
    "far-right": 2.8,
    "far-left": 3.0,
    "stand_left": 6.5,
    "stand_right": 8.0,
    "stand_far_right": 5.5,
    "stand_far_left": 7.2,
    "near_left": 1.4,
    "near_back": 2.6,
    "near_right": 1.1,
    "near_front": 3.2,
}
STANDS_M = {  # layout stands: (x, y) from the court's centre
    "stand_left": (-11.0, -13.0),
    "stand_right": (12.0, -12.0),
    "stand_far_right": (12.0, 10.0),
    "stand_far_left": (-10.0, 11.5),
}
NEAR_M = {  # layout near: (x, y) from the middle of the near half
    "near_left": (-7.0, -2.0),
    "near_back": (3.0, -8.0),
    "near_right": (7.5, 1.5),
    "near_front": (-3.5, 7.5),
}
LAYOUTS = {  # in the order in which a walk passes them
    "a": ("side", "back"),
    "b": ("oblique", "back"),
    "b-mirror": ("oblique", "back", "mirror"),
    "b-mirror-front": ("oblique", "back", "mirror", "front"),
    "corners": ("left", "right"),
    "four-corners": ("left", "right", "far-right", "far-left"),
    "stands": tuple(STANDS_M),
    "near": tuple(NEAR_M),
}


def fixed_cameras(
    layout: str,
    court: Court,
    size_px: tuple[int, int],
    preset: Preset,
    rng: np.random.Generator,
    *,
    baseline_deg: float | None = None,
    zoom: float = 1.0,
) -> list[Camera]:
    """Set up the fixed cameras of a layout.

    Parameters
    ----------
    layout : str
        A key of `LAYOUTS`. In "a" two cameras look along the world's x (`side`) and y (`back`). In
        "b" one stands straight behind the court (`back`), one beside it on a line parallel to x
        (`oblique`); then the mirror image of that one (`mirror`); then one that faces the players.
        In "corners" two stand high to the left and the right behind the court, 124 degrees apart;
        "four-corners" adds their mirror images behind the other half.
        In "stands" four look down from the stands of a hall, 5.5 to 8 m high. In "near" four stand
        7 to 9 m around the middle of the near half, at which they are aimed.
    court : Court
    size_px : (int, int)
        Width and height of the pictures.
    preset : Preset
        Gives the spread of the lenses.
    rng : numpy.random.Generator
    baseline_deg : float or None
        For layout "a" only: the angle between the cameras, seen from the court's centre, instead of
        90; `back` stays where it is.
    zoom : float
        Focal length over that with which the court fills about half of the picture.

    Returns
    -------
    fixed : list of Camera
        In the order in which a walk passes them.

    Raises
    ------
    ValueError
        If the layout is unknown, or an angle is given for another layout than "a".
    """
    if layout not in LAYOUTS:
        raise ValueError(f"expected a layout of {sorted(LAYOUTS)}, found {layout!r}")
    if baseline_deg is not None and (layout != "a" or not 0 < baseline_deg <= 180):
        raise ValueError(
            f"expected baseline_deg in 0..180 for layout a, found {baseline_deg}, {layout}"
        )
    centre, places = court_centre(court), _places(layout, court, baseline_deg)
    aim = centre + np.array([*_aim(layout, court), AIM_M])
    made = []
    for name in LAYOUTS[layout]:
        matrix, dist = lens(size_px, preset, rng)
        matrix[[0, 1], [0, 1]] *= zoom
        place = centre + np.array([*places[name], HEIGHTS_M[name]])
        roll_deg = rng.uniform(-ROLL_DEG, ROLL_DEG)
        pose = look_at(place, aim, -np.radians(roll_deg))
        made.append(Camera(name, size_px, matrix, dist, pose))
    return made


def court_centre(court: Court) -> NDArray:
    """Return the centre of the court on the floor, (3,) m."""
    return np.array([court.size_m[0] / 2, court.size_m[1] / 2, 0.0])


def lens(
    size_px: tuple[int, int], preset: Preset, rng: np.random.Generator
) -> tuple[NDArray, NDArray]:
    """Draw the lens of one camera at random; `size_px` is (width, height).

    Returns
    -------
    K : (3, 3) float
        Px.
    dist : (5,) float
        k1 k2 p1 p2 k3.
    """
    width, height = size_px
    draws = rng.standard_normal(7)
    focal_px = FOCAL_WIDTHS * width * (1 + preset.focal_spread * draws[0])
    shift_px = preset.principal_point_px * width / 1280 * draws[1:3]
    spreads = np.array([preset.k1_spread, preset.k2_spread, preset.p_spread, preset.p_spread])
    matrix = np.array(
        [
            [focal_px, 0, (width - 1) / 2 + shift_px[0]],
            [0, focal_px, (height - 1) / 2 + shift_px[1]],
            [0, 0, 1],
        ]
    )
    return matrix, LENS + np.append(spreads * draws[3:], 0.0)


def _places(
    layout: str, court: Court, baseline_deg: float | None
) -> dict[str, tuple[float, float]]:
    """Return (x, y) m of each camera, from the court's centre."""
    short, long = sorted(court.size_m)
    # From here the court fills no more than VIEW, whichever side it is seen from.
    needed_m = short / 2 + long / 2 / VIEW
    if layout == "a":
        away_m = max(SQUARE_ON_M, needed_m)
        angle = np.radians(270 - (90 if baseline_deg is None else baseline_deg))
        return {
            "side": (away_m * np.cos(angle), away_m * np.sin(angle)),
            "back": (0.0, -away_m),
        }
    if layout in ("corners", "four-corners"):
        away_m, angle = max(SQUARE_ON_M, needed_m), np.radians(CORNER_DEG)
        across, behind = away_m * np.sin(angle), -away_m * np.cos(angle)
        near = {"left": (-across, behind), "right": (across, behind)}
        return near | {"far-right": (across, -behind), "far-left": (-across, -behind)}
    if layout == "stands":
        return STANDS_M
    if layout == "near":
        return {name: tuple(np.add(_aim(layout, court), xy)) for name, xy in NEAR_M.items()}
    away_m = BEHIND_M + max(0.0, needed_m - SQUARE_ON_M)
    return {
        "oblique": (-BESIDE_M, -away_m),
        "back": (0.0, -away_m),
        "mirror": (BESIDE_M, -away_m),
        "front": (0.0, away_m),
    }


def _aim(layout: str, court: Court) -> tuple[float, float]:
    """Return (x, y) m of the point at which the cameras are aimed, from the court's centre."""
    return (0.0, -max(court.size_m) / 4) if layout == "near" else (0.0, 0.0)
