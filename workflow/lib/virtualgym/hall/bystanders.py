"""People who walk about in the hall while the walk is filmed: boxes for limbs, in textured clothes."""

from dataclasses import dataclass

import cv2
import numpy as np
from scipy.interpolate import CubicSpline

from virtualgym.hall import quads as surfaces

CORNERS = 8  # of the loop that a person walks
REACH = 0.55, 0.85  # how far out of its zone's middle a corner is; a spline may swing beyond
BESIDE_M = 0.9, 4.0  # from a court's side line: the strip where people walk beside it
OFF_NET_M = 0.7  # how far from the net those on the court stay
SPEEDS_M_S = 0.5, 1.3
HEIGHTS_M = 1.58, 1.92
STRIDE = 0.78  # metres of a double step per metre of height
HIP_SWING, KNEE_BEND, ARM_SWING, ELBOW_BEND = 0.42, 0.55, 0.35, 0.4  # radians at usual walking
USUAL_M_S = 1.2
TEXELS = 48
# Limbs, in body heights: thickness along the way, width, length; then the joint's height.
TORSO, HEAD = (0.11, 0.21, 0.33), (0.115, 0.09, 0.145)
UPPER_ARM, FOREARM = (0.055, 0.055, 0.175), (0.045, 0.045, 0.24)
THIGH, SHANK, FOOT = (0.085, 0.08, 0.25), (0.065, 0.065, 0.235), (0.15, 0.055, 0.035)
HIP_AT, SHOULDER_AT, CHEST_AT = 0.52, 0.82, 0.84
HIP_ASIDE, SHOULDER_ASIDE = 0.052, 0.135


@dataclass(frozen=True, eq=False)
class Person:
    """One person, who walks round a closed loop at a constant speed.

    Attributes
    ----------
    route : scipy.interpolate.CubicSpline
        From metres along the loop to its (x, y) in the world, metres; periodic.
    speed_m_s : float
    start_m : float
        Along the loop, at time 0.
    height_m : float
    clothes : dict of str to (h, w, 3) uint8
        BGR textures: shirt, trousers, skin, hair, shoe.
    """

    route: CubicSpline
    speed_m_s: float
    start_m: float
    height_m: float
    clothes: dict

    def place(self, time_s):
        """Return where the person stands, (2,) m."""
        return self.route(self._along_m(time_s))

    def quads(self, time_s):
        """Return the person's surfaces at a time, a list of `quads.Quad`."""
        forward = self.route(self._along_m(time_s), 1)
        forward = np.append(forward / np.linalg.norm(forward), 0.0)
        left = np.array([-forward[1], forward[0], 0.0])
        frame = np.stack([forward, left, [0.0, 0.0, 1.0]])
        phase = 2 * np.pi * self._along_m(time_s) / (STRIDE * self.height_m)
        vigour = min(1.0, self.speed_m_s / USUAL_M_S)
        drawn = _Body(frame, np.append(self.place(time_s), 0.0), self.height_m)
        drawn.hang(TORSO, (0, 0, CHEST_AT), 0.0, self.clothes["shirt"])
        skin, hair = self.clothes["skin"], self.clothes["hair"]
        drawn.hang(HEAD, (0.01, 0, 1.0), 0.0, [hair, skin, hair, hair, hair, skin])
        for side, turn in ((1, phase), (-1, phase + np.pi)):
            self._leg(drawn, side, turn, vigour)
            self._arm(drawn, side, turn + np.pi, vigour)
        return drawn.quads

    def _leg(self, drawn, side, phase, vigour):
        hip = HIP_SWING * vigour * np.sin(phase)
        knee = KNEE_BEND * vigour * max(0.0, np.cos(phase))  # bent while the leg swings forward
        end = drawn.hang(THIGH, (0, side * HIP_ASIDE, HIP_AT), hip, self.clothes["trousers"])
        end = drawn.hang(SHANK, end, hip - knee, self.clothes["trousers"])
        drawn.hang(FOOT, (end[0] + 0.03, end[1], end[2]), 0.0, self.clothes["shoe"])

    def _arm(self, drawn, side, phase, vigour):
        shoulder = ARM_SWING * vigour * np.sin(phase)
        top = (0, side * SHOULDER_ASIDE, SHOULDER_AT)
        end = drawn.hang(UPPER_ARM, top, shoulder, self.clothes["shirt"])
        drawn.hang(FOREARM, end, shoulder + ELBOW_BEND * vigour, self.clothes["skin"])

    def _along_m(self, time_s):
        return self.start_m + self.speed_m_s * time_s


class _Body:
    """Boxes in a person's own frame: forward, left, up, in body heights."""

    def __init__(self, frame, place, height_m):
        self.frame, self.origin, self.height_m = frame, place, height_m
        self.quads = []

    def hang(self, size, top, turn, textures):
        """Hang a box by the middle of its top, its lower end swung forward; return its lower end."""
        deep, wide, long = size
        cos, sin = np.cos(turn), np.sin(turn)
        up = np.array([-sin, 0.0, cos])
        edges = np.array([[deep * cos, 0.0, deep * sin], [0.0, wide, 0.0], long * up])
        end = np.array(top) - long * up
        corner = end - (edges[0] + edges[1]) / 2
        world = (self.height_m * np.vstack([corner, edges])) @ self.frame
        self.quads += surfaces.box(self.origin + world[0], world[1:], textures)
        return end


def plan(n_people, court, rng):
    """Let people walk about on and beside a court.

    Parameters
    ----------
    n_people : int
    court : courtside.calibration.court.court.Court
        Each person keeps to one of its halves, so that nobody crosses the net, or to the strip on one side.
    rng : numpy.random.Generator

    Returns
    -------
    people : list of Person, length n_people
    """
    zones = _zones(court)
    return [_person(*zones[at % len(zones)], rng) for at in range(n_people)]


def quads(people, time_s):
    """Return the surfaces of all people at a time, as `Renderer.render` takes them for `extra`.

    Parameters
    ----------
    people : list of Person
    time_s : float

    Returns
    -------
    quads : list of surfaces.Quad
    """
    # ASSUME: nobody moves while one picture is read out: 2 cm, and nobody's place is ever measured.
    return [quad for person in people for quad in person.quads(time_s)]


def _zones(court):
    """Return middle (2,) and half size (2,) m of where one person walks each, in the order of use."""
    (short, long), (near, far) = court.size_m, BESIDE_M
    half = np.array([short / 2, long / 4 - OFF_NET_M / 2])
    strip = np.array([(far - near) / 2, long / 2])
    return [
        (np.array([short / 2, half[1]]), half),
        (np.array([-(near + far) / 2, long / 2]), strip),
        (np.array([short / 2, long - half[1]]), half),
        (np.array([short + (near + far) / 2, long / 2]), strip),
    ]


def _person(middle, half, rng):
    angles = 2 * np.pi * np.arange(CORNERS + 1) / CORNERS
    reach = rng.uniform(*REACH, CORNERS)
    corners = np.append(reach, reach[0])[:, None] * np.column_stack(
        [np.cos(angles), np.sin(angles)]
    )
    loop = CubicSpline(angles, middle + half * corners[:: rng.choice([-1, 1])], bc_type="periodic")
    fine = loop(np.linspace(0, 2 * np.pi, 400))
    fine[-1] = fine[0]
    along_m = np.append(0.0, np.linalg.norm(np.diff(fine, axis=0), axis=1).cumsum())
    return Person(
        route=CubicSpline(along_m, fine, bc_type="periodic"),
        speed_m_s=rng.uniform(*SPEEDS_M_S),
        start_m=rng.uniform(0, along_m[-1]),
        height_m=rng.uniform(*HEIGHTS_M),
        clothes=_clothes(rng),
    )


def _clothes(rng):
    skin = np.array([120, 150, 200]) * rng.uniform(0.4, 1.1)
    return {
        "shirt": _printed(rng),
        "trousers": _cloth(rng.uniform(20, 200, 3), rng),
        "skin": _cloth(skin, rng),
        "hair": _cloth(np.full(3, rng.uniform(15, 90)), rng),
        "shoe": _cloth(rng.uniform(20, 230, 3), rng),
    }


def _cloth(colour, rng):
    """Return one colour with folds."""
    folds = cv2.resize(rng.standard_normal((6, 4)), (TEXELS, TEXELS), interpolation=cv2.INTER_CUBIC)
    image = np.asarray(colour) + 14 * folds[..., None]
    return np.clip(image, 0, 255).astype(np.uint8)


def _printed(rng):
    """Return a shirt: stripes or a field of another colour, and a number."""
    image = _cloth(rng.uniform(30, 230, 3), rng)
    other = rng.uniform(10, 245, 3).tolist()
    if rng.random() < 0.5:
        for top in range(0, TEXELS, 12):
            image[top : top + 5] = other
    else:
        cv2.rectangle(image, (0, TEXELS // 2), (TEXELS, TEXELS), other, -1)
    number, white = str(rng.integers(2, 99)), (240, 240, 240)
    cv2.putText(image, number, (6, 36), cv2.FONT_HERSHEY_SIMPLEX, 0.9, white, 3, cv2.LINE_AA)
    return image
