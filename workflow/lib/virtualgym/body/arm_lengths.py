"""Forearms as long as those of people: MakeHuman's women have short ones."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from virtualgym.body import rotations
from virtualgym.body.makehuman import Figure

# The forearms of MakeHuman's women (the seven of `shapes.BODIES`) have 0.132 of their height, those
# of real women 0.1523 (de Leva 1996, table 4: 264.3 of 1735 mm). With short forearms, their span
# would be 0.97 of their height; of real women it is 1.02 (ANSUR II, Gordon et al. 2014). In the
# mean, forearms and span of MakeHuman's men are as those of real men, within 3 and 1 %.
FOREARM = {"m": 1.0, "f": 1.156}


def lengthened(figure: Figure, sex: str) -> Figure:
    """Return the figure with forearms that are longer by `FOREARM` of its sex, "m" or "f".

    Skin and bones are stretched along the forearm; the hand keeps its size. Between two bones the
    skin is blended as it is when a limb bends.
    """
    factor = FOREARM[sex]
    if factor == 1:
        return figure
    stretch = np.tile(np.eye(3), (len(figure.bones), 1, 1))
    shift = np.zeros((len(figure.bones), 3))
    for suffix in (".L", ".R"):
        elbow, wrist = figure.head("lowerarm01" + suffix), figure.head("wrist" + suffix)
        along = rotations.unit_vector(wrist - elbow)
        longer = np.eye(3) + (factor - 1) * np.outer(along, along)
        for at in _from(figure, "lowerarm01" + suffix):
            is_forearm = figure.bones[at].startswith("lowerarm")
            stretch[at] = longer if is_forearm else np.eye(3)
            shift[at] = elbow - longer @ elbow if is_forearm else (factor - 1) * (wrist - elbow)

    def moved(ends: NDArray) -> NDArray:
        return np.einsum("bij,bj->bi", stretch, ends) + shift

    return replace(
        figure,
        vertices=figure.blended(stretch, shift),
        heads=moved(figure.heads),
        tails=moved(figure.tails),
    )


def _from(figure: Figure, bone: str) -> list[int]:
    """Return the indices of a bone and of all bones that hang on it."""
    found = [figure.bones.index(bone)]
    for at, parent in enumerate(figure.parents):  # parents come first
        if parent in found:
            found.append(at)
    return found
