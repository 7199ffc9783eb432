"""The grid of a session's walks: all frames that may bridge, in order, as COLMAP's database names them."""

from dataclasses import dataclass

import numpy as np
import pandas as pd

from courtside.records.cameras import frame_table, image_names
from courtside.sfm import bridging, pairs


@dataclass(frozen=True, eq=False)
class Grid:
    """Frames of all walks, one walk after the other.

    Attributes
    ----------
    walks : (G,) str
    names : (G,) str
        Of the images, from the image root.
    kept : (G,) bool
        Whether a frame may become a bridging image.
    sharpness : (G,) float
    """

    walks: np.ndarray
    names: np.ndarray
    kept: np.ndarray
    sharpness: np.ndarray

    def of_walk(self, walk):
        """Return the names of a walk's usable frames, in order."""
        return tuple(self.names[(self.walks == walk) & self.kept].tolist())

    def choose(self, n_images, offset_idx, rule):
        """Return the names of the bridging images; see `bridging.choose`."""
        usable = np.flatnonzero(self.kept)
        chosen = bridging.choose(
            usable,
            len(self.names),
            n_images,
            offset_idx,
            self.sharpness,
            rule,
            walk=", ".join(dict.fromkeys(self.walks.tolist())),
        )
        return self.names[chosen].tolist()

    def pairs(self, fixed):
        """Return the pairs of images to match.

        Parameters
        ----------
        fixed : sequence of str
            Images of the fixed cameras: they are matched with all others.
        """
        near = [
            (str(self.names[i]), str(self.names[j]))
            for i, j in pairs.pair_list(len(self.names))
            if self.kept[i] and self.kept[j]
        ]
        usable = self.names[self.kept].tolist()
        among = [(a, b) for k, a in enumerate(fixed) for b in fixed[k + 1 :]]
        return near + among + [(a, b) for a in fixed for b in usable]


def read(tables):
    """Read the frame tables of the walks.

    Parameters
    ----------
    tables : dict of str to path
        CSV by walk, as `extract_frames` writes it.

    Returns
    -------
    grid : Grid

    Raises
    ------
    InputError
        If a file is missing or no frame table.
    """
    parts = []
    for walk, path in tables.items():
        table = frame_table.read(path)
        parts.append(
            table.assign(walk=walk, path=[image_names.frame(walk, name) for name in table["name"]])
        )
    whole = (
        pd.concat(parts) if parts else pd.DataFrame(columns=["walk", "path", "kept", "sharpness"])
    )
    return Grid(
        whole["walk"].to_numpy(str),
        whole["path"].to_numpy(str),
        whole["kept"].to_numpy(bool),
        whole["sharpness"].to_numpy(float),
    )
