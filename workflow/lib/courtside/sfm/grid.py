"""The grid of a session's walks: all frames that may bridge, in order, by their image names."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from courtside.records import tables as records
from courtside.records.cameras import frame_table, image_names
from courtside.sfm import bridging, pairs
from courtside.study.errors import StrPath


@dataclass(frozen=True, eq=False)
class Grid:
    """Frames of all walks, one walk after the other."""

    walks: NDArray  # (G,) str
    names: NDArray  # (G,) str: of the images, from the image root
    kept: NDArray  # (G,) bool: whether a frame may become a bridging image
    sharpness: NDArray  # (G,)
    why: NDArray  # (G,) str: why a frame is not kept, empty if it is
    photos: NDArray  # (G,) str: own file name of a frame that is a photo, empty of a video's

    def of_walk(self, walk: str) -> tuple[str, ...]:
        """Return the names of a walk's usable frames, in order."""
        return tuple(self.names[(self.walks == walk) & self.kept].tolist())

    def choose(self, n_images: int, offset_idx: int, rule: str) -> list[str]:
        """Return the names of the bridging images; see `bridging.choose`."""
        usable, n_grid = np.flatnonzero(self.kept), len(self.names)
        walk = ", ".join(dict.fromkeys(self.walks.tolist()))
        chosen = bridging.choose(
            usable,
            n_grid,
            n_images,
            offset_idx,
            self.sharpness,
            rule,
            walk=walk,
            not_kept=self._not_kept(),
        )
        return self.names[chosen].tolist()

    def _not_kept(self) -> list[str] | None:
        """Return the photos that are not kept, each with the reason; None if some are no photos."""
        if not self.photos.all():
            return None
        lost = zip(self.photos[~self.kept], self.why[~self.kept], strict=True)
        return [f"{photo} is {frame_table.OF_PHOTOS[why]}" for photo, why in lost]

    def called(self, name: str) -> str:
        """Return what to call an image: a photo by its own name, with that of the image."""
        own = self.own_names().get(name)
        return f"{own} ({name})" if own else name

    def own_names(self) -> dict[str, str]:
        """Return the own file names of images that are photos, by image name."""
        every = zip(self.names.tolist(), self.photos.tolist(), strict=True)
        return {name: photo for name, photo in every if photo}

    def pairs(self, fixed: Sequence[str]) -> list[tuple[str, str]]:
        """Return the pairs of images to match: those of the fixed cameras with all others."""
        near = [
            (str(self.names[i]), str(self.names[j]))
            for i, j in pairs.pair_list(len(self.names))
            if self.kept[i] and self.kept[j]
        ]
        usable = self.names[self.kept].tolist()
        among = [(a, b) for k, a in enumerate(fixed) for b in fixed[k + 1 :]]
        return near + among + [(a, b) for a in fixed for b in usable]


def read(tables: Mapping[str, StrPath]) -> Grid:
    """Read the frame tables of the walks: CSV by walk, as `extract_frames` writes it.

    Raises `InputError` if a file is missing or no frame table.
    """
    parts = [pd.DataFrame(columns=["walk", "path", *frame_table.COLUMNS])] if not tables else []
    for walk, path in tables.items():
        table = frame_table.read(path)
        paths = [image_names.frame(walk, name) for name in table["name"]]
        parts.append(table.assign(walk=walk, path=paths))
    whole = pd.concat(parts)
    return Grid(
        whole["walk"].to_numpy(str),
        whole["path"].to_numpy(str),
        whole["kept"].to_numpy(bool),
        whole["sharpness"].to_numpy(float),
        whole["reason"].to_numpy(str),
        whole["photo"].to_numpy(str),
    )


def fixed(path: StrPath, walks: Collection[str]) -> list[str]:
    """Return the images of a table that `extract_features` wrote which are of no walk.

    Names of walks are texts: a walk may be called 3, or null.
    """
    table = records.read(
        path,
        "a table of features",
        lambda table: records.column_fault(table, ["source", "name"], []),
        dtype=str,
        keep_default_na=False,
    )
    return table["name"][~table["source"].isin(walks)].tolist()
