"""Dress a body: which triangles are cloth, shoe, hair or skin, and how thick the cloth is."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from virtualgym.body import mesh
from virtualgym.body.makehuman import Figure
from virtualgym.body.pose_bones import BONES, Skeleton
from virtualgym.body.shapes import Shape

# ASSUME: thicknesses, borders and colours chosen to look like sports clothes; no source is
# recorded.
OFF_M = {  # distance of the cloth from the skin
    "shirt": 0.010,
    "trim": 0.010,
    "shorts": 0.015,
    "sock": 0.003,
    "shoe": 0.007,
    "sole": 0.007,
}
HAIR_M = 0.011
# Where they begin or end, as fractions of upper arm, thigh, shank and shank.
SLEEVE, SHORTS_END, SOCK_START, SHOE_START = 0.55, 0.6, 0.72, 0.93
HEM_M = 0.03  # below the hip joints
SOLE_M = 0.018
SKINS = {  # BGR at full light, varied by the seed
    "caucasian": (150, 175, 222),
    "asian": (140, 178, 220),
    "african": (62, 82, 122),
}
# Only the first for origins other than caucasian.
HAIRS = ((24, 26, 32), (40, 62, 92), (70, 120, 165))
SHIRTS = (
    ((50, 45, 205), (240, 240, 240)),
    ((190, 95, 30), (235, 235, 235)),
    ((60, 150, 45), (30, 30, 30)),
    ((230, 230, 230), (180, 60, 40)),
    ((40, 190, 235), (60, 40, 30)),
    ((150, 60, 130), (230, 220, 235)),
    ((30, 120, 235), (40, 40, 40)),
    ((170, 160, 30), (240, 240, 240)),
    ((225, 150, 90), (60, 40, 40)),
    ((170, 110, 235), (90, 30, 60)),
)
SHORTS = ((45, 40, 35), (95, 45, 25), (225, 225, 225), (40, 40, 110))
SHOES = ((240, 240, 240), (60, 60, 230), (220, 160, 40), (50, 50, 50))
SOLES = ((60, 200, 240), (230, 230, 230), (70, 70, 70))
EYE_WHITE, IRIS, LIPS = (225, 230, 232), (45, 55, 70), (110, 105, 175)
MODELLED_M = 1.8  # body height for which the places in `_face` hold
IRIS_DEEP_M = 0.0022
TORSO = ("root", "spine", "clavicle")


@dataclass(frozen=True, eq=False)
class _Places:
    """For each triangle of the bare body: its centre, and the bone with the largest weight."""

    middle: np.ndarray
    bone: np.ndarray
    heads: dict[str, np.ndarray]

    def on(self, *names: str) -> NDArray:
        held = [at for at, bone in enumerate(BONES) if bone.startswith(names)]
        return np.isin(self.bone, held)

    def share(self, start: str, end: str) -> NDArray:
        """Return where each triangle is along a limb's bone, 0 at its start to 1; both sides."""
        along = np.zeros(len(self.middle))
        for suffix in (".L", ".R"):
            first, last = self.heads[start + suffix], self.heads[end + suffix]
            mine = (self.middle[:, 0] > 0) == (suffix == ".L")
            way = (last - first) / ((last - first) @ (last - first))
            along[mine] = (self.middle[mine] - first) @ way
        return along


def dress(
    figure: Figure, skeleton: Skeleton, weights: NDArray, shape: Shape
) -> tuple[NDArray, NDArray]:
    """Dress a bare body.

    Parameters
    ----------
    figure : Figure
    skeleton : Skeleton
    weights : (V, B) float
        Skinning weights of `pose_bones.BONES`.
    shape : Shape

    Returns
    -------
    vertices : (V, 3) float
        Rest pose, with cloth and hair pushed off the skin; nothing is below the bare soles.
    colours : (F, 3) uint8
        BGR.
    """
    corners = figure.triangles
    quads = corners.reshape(-1, 6)  # MakeHuman's faces are two triangles each; keep them whole
    held = np.repeat(weights[quads].sum(axis=1).argmax(axis=1), 2)
    middle = np.repeat(figure.vertices[quads].mean(axis=1), 2, axis=0)
    places = _Places(middle, held, skeleton.heads)
    cloth = _regions(places)
    palette = _palette(shape)
    colours = np.empty((len(corners), 3))
    colours[:] = palette["skin"]
    pushed = np.zeros(len(figure.vertices))
    for name, where in cloth.items():
        colours[where] = palette[name]
        touched = np.unique(corners[where])
        pushed[touched] = np.maximum(pushed[touched], OFF_M[name])
    hair = _face(colours, figure, places, palette)
    touched = np.unique(corners[hair])
    pushed[touched] = HAIR_M
    pushed[np.unique(corners[figure.is_eye])] = 0
    vertices = figure.vertices + pushed[:, None] * mesh.normals(figure.vertices, figure.skin)
    vertices[:, 1] = np.maximum(vertices[:, 1], np.minimum(figure.vertices[:, 1], 0.0))
    return vertices, np.clip(colours, 0, 255).astype(np.uint8)


def _regions(places: _Places) -> dict[str, NDArray]:
    """Return the triangles of each piece of cloth, (F,) bool by name; later ones lie on top."""
    height = places.middle[:, 1]
    hips = places.heads["upperleg01.L"][1]
    torso = places.on(*TORSO)
    thigh, shank = places.share("upperleg01", "lowerleg01"), places.share("lowerleg01", "foot")
    arm = places.share("upperarm01", "lowerarm01")
    above = height > hips - HEM_M
    neck = places.heads["neck01"]
    collar = neck[1] - 0.3 * (places.middle[:, 2] - neck[2])  # lower in front
    shirt = places.on(*TORSO, "upperleg", "neck01", "neck02") & above & (height < collar)
    shirt |= places.on("upperarm") & (arm < SLEEVE)
    band = torso & (np.abs(height - places.heads["spine01"][1] - 0.02) < 0.04)
    foot = places.on("foot", "toe") | (places.on("lowerleg") & (shank > SHOE_START))
    return {
        "shorts": places.on(*TORSO, "upperleg") & (thigh < SHORTS_END) & ~above,
        "shirt": shirt,
        "trim": shirt & (band | (places.on("upperarm") & (arm > SLEEVE - 0.12))),
        "sock": places.on("lowerleg") & (shank > SOCK_START),
        "shoe": foot,
        "sole": foot & (height < SOLE_M),
    }


def _face(
    colours: NDArray, figure: Figure, places: _Places, palette: dict[str, ArrayLike]
) -> NDArray:
    """Paint eyes, brows, lips and hair in place; return which triangles carry hair, (F,) bool."""
    eye, size = figure.head("eye.L"), figure.height_m / MODELLED_M
    across = np.abs(places.middle[:, 0]) / size
    up, ahead = ((places.middle[:, axis] - eye[axis]) / size for axis in (1, 2))
    head = places.on("head") & ~figure.is_eye
    brow = head & (across > 0.014) & (across < 0.046) & (up > 0.016) & (up < 0.022)
    brow &= ahead > -0.02
    lips = head & (across < 0.022) & (np.abs(up + 0.068) < 0.006) & (ahead > 0.01)
    colours[brow], colours[lips] = palette["hair"], LIPS
    colours[figure.is_eye] = EYE_WHITE
    front = places.middle[figure.is_eye, 2].max() - IRIS_DEEP_M
    colours[figure.is_eye & (places.middle[:, 2] > front)] = IRIS
    line = 0.052 + 0.55 * np.clip(ahead + 0.035, -0.14, 0) - np.where(ahead < -0.10, 0.05, 0)
    ears = (across > 0.073) & (up < 0.02)
    hair = head & (up > line) & ~ears
    colours[hair] = palette["hair"]
    return hair


def _palette(shape: Shape) -> dict[str, ArrayLike]:
    """Choose colours by the shape's seed; the shorts differ most from shirt and skin."""
    rng = np.random.default_rng(shape.seed)
    shirt, trim = SHIRTS[shape.seed % len(SHIRTS)]
    skin = np.array(SKINS[shape.origin]) * rng.uniform(0.85, 1.05)
    shorts = max(
        (SHORTS[at] for at in rng.permutation(len(SHORTS))[:3]),
        key=lambda colour: min(_apart(colour, shirt), _apart(colour, skin)),
    )
    return {
        "skin": skin,
        "hair": HAIRS[rng.integers(len(HAIRS)) if shape.origin == "caucasian" else 0],
        "shirt": shirt,
        "trim": trim,
        "shorts": shorts,
        "sock": (232, 232, 232),
        "shoe": SHOES[rng.integers(len(SHOES))],
        "sole": SOLES[rng.integers(len(SOLES))],
    }


def _apart(first: ArrayLike, second: ArrayLike) -> float:
    return float(np.linalg.norm(np.subtract(first, second)))
