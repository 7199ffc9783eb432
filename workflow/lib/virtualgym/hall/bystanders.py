"""Bystanders who walk about while the walk is filmed: boxes for limbs, in textured clothes."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import CubicSpline

from courtside.calibration.court.court import Court
from virtualgym.hall.quads import Quad, box

# ASSUME: paths, gait and sizes chosen to look like people; nothing of bystanders is measured.
CORNERS = 8  # of the loop that a person walks
REACH = 0.55, 0.85  # of a corner from its zone's middle; below 1, as the spline may swing beyond
BESIDE_M = 0.9, 4.0  # from a court's side line: the strip where people walk beside it
OFF_NET_M = 0.7  # distance from the net of those on the court
SPEEDS_M_S = 0.5, 1.3
HEIGHTS_M = 1.58, 1.92
STRIDE = 0.78  # metres of a stride (two steps) per metre of height
HIP_SWING, KNEE_BEND, ARM_SWING, ELBOW_BEND = 0.42, 0.55, 0.35, 0.4  # radians at USUAL_M_S
USUAL_M_S = 1.2
TEXELS = 48
# Limbs, in body heights: thickness in the walking direction, width, length; then the joints'
# heights.
TORSO, HEAD = (0.11, 0.21, 0.33), (0.115, 0.09, 0.145)
UPPER_ARM, FOREARM = (0.055, 0.055, 0.175), (0.045, 0.045, 0.24)
THIGH, SHANK, FOOT = (0.085, 0.08, 0.25), (0.065, 0.065, 0.235), (0.15, 0.055, 0.035)
HIP_AT, SHOULDER_AT, CHEST_AT = 0.52, 0.82, 0.84
HIP_ASIDE, SHOULDER_ASIDE = 0.052, 0.135


@dataclass(frozen=True, eq=False)
class Person:
    """A person who walks round a closed loop at a constant speed.

    Attributes
    ----------
    route : scipy.interpolate.CubicSpline
        Metres along the loop -> (x, y) in the world, metres; periodic.
    speed_m_s : float
    start_m : float
        Position along the loop at time 0.
    height_m : float
    clothes : dict of str to (h, w, 3) uint8
        BGR textures: shirt, trousers, skin, hair, shoe.
    """

    route: CubicSpline
    speed_m_s: float
    start_m: float
    height_m: float
    clothes: dict[str, np.ndarray]

    def place(self, time_s: float) -> NDArray:
        """Return the person's place on the floor, (2,) m."""
        return self.route(self._along_m(time_s))

    def quads(self, time_s: float) -> list[Quad]:
        """Return the person's surfaces at a time."""
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

    def _leg(self, drawn: "_Body", side: int, phase: float, vigour: float) -> None:
        hip = HIP_SWING * vigour * np.sin(phase)
        knee = KNEE_BEND * vigour * max(0.0, np.cos(phase))  # bent while the leg swings forward
        end = drawn.hang(THIGH, (0, side * HIP_ASIDE, HIP_AT), hip, self.clothes["trousers"])
        end = drawn.hang(SHANK, end, hip - knee, self.clothes["trousers"])
        drawn.hang(FOOT, (end[0] + 0.03, end[1], end[2]), 0.0, self.clothes["shoe"])

    def _arm(self, drawn: "_Body", side: int, phase: float, vigour: float) -> None:
        shoulder = ARM_SWING * vigour * np.sin(phase)
        top = (0, side * SHOULDER_ASIDE, SHOULDER_AT)
        end = drawn.hang(UPPER_ARM, top, shoulder, self.clothes["shirt"])
        drawn.hang(FOREARM, end, shoulder + ELBOW_BEND * vigour, self.clothes["skin"])

    def _along_m(self, time_s: float) -> float:
        return self.start_m + self.speed_m_s * time_s


class _Body:
    """Boxes in a person's own frame: forward, left, up, in body heights."""

    def __init__(self, frame: NDArray, place: NDArray, height_m: float) -> None:
        self.frame, self.origin, self.height_m = frame, place, height_m
        self.quads: list[Quad] = []

    def hang(
        self,
        size: tuple[float, float, float],
        top: ArrayLike,
        turn: float,
        textures: NDArray | list[NDArray],
    ) -> NDArray:
        """Add a box that hangs by its top's middle, swung forward; return its lower end."""
        deep, wide, long = size
        cos, sin = np.cos(turn), np.sin(turn)
        up = np.array([-sin, 0.0, cos])
        edges = np.array([[deep * cos, 0.0, deep * sin], [0.0, wide, 0.0], long * up])
        end = np.array(top) - long * up
        corner = end - (edges[0] + edges[1]) / 2
        world = (self.height_m * np.vstack([corner, edges])) @ self.frame
        self.quads += box(self.origin + world[0], world[1:], textures)
        return end


def plan(n_people: int, court: Court, rng: np.random.Generator) -> list[Person]:
    """Return people who walk about on and beside a court.

    Each keeps to one half of the court, so that nobody crosses the net, or to the strip on one
    side.
    """
    zones = _zones(court)
    return [
        _person(middle, half, rng)
        for middle, half in (zones[at % len(zones)] for at in range(n_people))
    ]


def quads(people: list[Person], time_s: float) -> list[Quad]:
    """Return the surfaces of all people at a time, `extra` of `hall_renderer.Renderer.render`."""
    # ASSUME: nobody moves while one picture is read out. The error is 2 cm, and no place is
    # measured.
    return [quad for person in people for quad in person.quads(time_s)]


def _zones(court: Court) -> list[tuple[NDArray, NDArray]]:
    """Return middle (2,) and half size (2,) m of each person's zone, in the order of use."""
    (short, long), (near, far) = court.size_m, BESIDE_M
    half = np.array([short / 2, long / 4 - OFF_NET_M / 2])
    strip = np.array([(far - near) / 2, long / 2])
    return [
        (np.array([short / 2, half[1]]), half),
        (np.array([-(near + far) / 2, long / 2]), strip),
        (np.array([short / 2, long - half[1]]), half),
        (np.array([short + (near + far) / 2, long / 2]), strip),
    ]


def _person(middle: NDArray, half: NDArray, rng: np.random.Generator) -> Person:
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


def _clothes(rng: np.random.Generator) -> dict[str, NDArray]:
    skin = np.array([120, 150, 200]) * rng.uniform(0.4, 1.1)
    return {
        "shirt": _printed(rng),
        "trousers": _cloth(rng.uniform(20, 200, 3), rng),
        "skin": _cloth(skin, rng),
        "hair": _cloth(np.full(3, rng.uniform(15, 90)), rng),
        "shoe": _cloth(rng.uniform(20, 230, 3), rng),
    }


def _cloth(colour: ArrayLike, rng: np.random.Generator) -> NDArray:
    """Return one colour with folds."""
    folds = cv2.resize(rng.standard_normal((6, 4)), (TEXELS, TEXELS), interpolation=cv2.INTER_CUBIC)
    image = np.asarray(colour) + 14 * folds[..., None]
    return np.clip(image, 0, 255).astype(np.uint8)


def _printed(rng: np.random.Generator) -> NDArray:
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
