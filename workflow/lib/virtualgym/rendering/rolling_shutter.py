"""Moving surfaces seen by a rolling shutter: each point at the exposure time of its row."""

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from courtside.geometry import camera as camera_models
from courtside.geometry.camera import Camera
from virtualgym.body import mesh
from virtualgym.body.mesh import Mesh

# Limit of the iteration for the row that sees a point: each leaves 2 % of the error at 1000 px/s.
ROUNDS = 6
ENOUGH_PX = 0.05  # the iteration stops at changes below this
FAST_M = 0.05  # surfaces that move farther during one picture: five moments instead of three
SLACK = 0.04  # margin, in picture heights, for the rows that show an athlete
# ASSUME: light chosen by eye; it changes pictures only.
SHADES = np.array([0.14, -0.10, 0.30])  # added light per unit of the outward normal
AMBIENT = 0.76
Box = tuple[int, int, int, int]  # first column, first row, and one beyond the last of each


class HasMesh(Protocol):
    """Whatever moves: its surface at each time, always of the same triangles."""

    def mesh(self, time_s: float) -> Mesh:
        """Return the surface at a time, world, metres."""
        ...


class Moving:
    """A surface during one picture: each vertex on a polynomial through three or five moments.

    Parameters
    ----------
    athlete : HasMesh
    time_s : float
        The moment in the middle.
    half_s : float
        From there to the first and to the last moment.
    """

    def __init__(self, athlete: HasMesh, time_s: float, half_s: float) -> None:
        now = athlete.mesh(time_s)
        self.time_s, self.half_s = time_s, half_s
        self.triangles, self.colours = now.triangles, now.colours
        self.vertices = np.asarray(now.vertices, dtype=float)
        self._powers: Sequence[NDArray] | NDArray = [self.vertices]
        if half_s > 0:
            places = {0.0: self.vertices}
            places |= {x: _vertices(athlete, time_s + x * half_s) for x in (-1.0, 1.0)}
            if np.abs(places[1.0] - places[-1.0]).max(initial=0.0) > FAST_M:
                places |= {x: _vertices(athlete, time_s + x * half_s) for x in (-0.5, 0.5)}
            through = np.linalg.inv(np.vander(list(places), increasing=True))
            self._powers = np.tensordot(through, list(places.values()), axes=1)

    def at(self, time_s: float | NDArray) -> NDArray:
        """Return the vertices (V, 3) m at one time, or each at its own time (V,)."""
        if len(self._powers) == 1:
            return self.vertices
        since = ((np.asarray(time_s, dtype=float) - self.time_s) / self.half_s)[..., None]
        xyz = self._powers[-1]
        for power in self._powers[-2::-1]:
            xyz = xyz * since + power
        return xyz

    def light(self) -> NDArray:
        """Return the light at each vertex, (V,) float32."""
        normals = mesh.normals(self.vertices, self.triangles)
        return (AMBIENT + normals @ SHADES).astype(np.float32)


def follow(
    athlete: HasMesh, camera: Camera, time_s: float, readout_s: float, exposure_s: float
) -> Moving:
    """Return an athlete's surface while the rows that show it are exposed; times as in `Screen`."""
    height = camera.size[1]
    rows = shown(camera, _vertices(athlete, time_s))[1]
    low, high = np.clip([np.nanmin(rows, initial=height), np.nanmax(rows, initial=0)], 0, height)
    middle_s = time_s + ((low + high) / 2 / height - 0.5) * readout_s
    half_s = (abs(high - low) / height + SLACK) * readout_s / 2 + exposure_s / 2
    return Moving(athlete, middle_s, half_s)


def _vertices(athlete: HasMesh, time_s: float) -> NDArray:
    return np.asarray(athlete.mesh(time_s).vertices, dtype=float)


class Screen:
    """A moving surface in the pixels of one picture.

    Parameters
    ----------
    moving : Moving
    camera : Camera
    time_s : float
        Mid-exposure of the middle row.
    readout_s : float
        Row v is exposed at ((v + 0.5) / H - 0.5) * readout_s.
    exposure_s : float
        Of each row.
    """

    def __init__(
        self, moving: Moving, camera: Camera, time_s: float, readout_s: float, exposure_s: float
    ) -> None:
        self.moving, self.camera = moving, camera
        self._time_s, self._readout_s = time_s, readout_s
        middle = self._rolled(self._shown(moving.time_s)[1], 0.0)
        self._shape = [middle]
        if exposure_s > 0:
            ends = [self._rolled(middle[1], share * exposure_s) for share in (-0.5, 0.5)]
            self._shape += [ends[1] - ends[0], 2 * (ends[0] + ends[1] - 2 * middle)]

    @property
    def blur_px(self) -> NDArray:
        """Path of each vertex during the exposure, (V,); NaN where the camera sees nothing."""
        if len(self._shape) == 1:
            return np.zeros(self._shape[0].shape[1])
        return np.hypot(*self._shape[1][:2])

    def at(self, share: float) -> NDArray:
        """Return the vertices at a moment of the exposure.

        Parameters
        ----------
        share : float
            -0.5 at its start, 0.5 at its end.

        Returns
        -------
        vertices : (V, 3) float
            Px across, px down, and metres along the camera's axis; NaN where the camera sees
            nothing.
        """
        if len(self._shape) == 1:
            return self._shape[0].T
        middle, slope, bend = self._shape
        return (middle + share * (slope + share * bend)).T

    def box(self, pad_px: int) -> Box | None:
        """Return the part of the picture that shows the surface, or None."""
        ends = np.hstack([self.at(share).T[:2] for share in (-0.5, 0.0, 0.5)])
        return bounds(ends.T, self.camera.size, pad_px)

    def _rolled(self, row: NDArray, later_s: float) -> NDArray:
        """Return the vertices (3, V) as seen `later_s` after the exposure of their rows."""
        height = self.camera.size[1]
        for _ in range(ROUNDS):
            own_s = self._time_s + ((row + 0.5) / height - 0.5) * self._readout_s + later_s
            seen = self._shown(own_s)
            change_px = np.fmax.reduce(np.abs(seen[1] - row), initial=0.0)
            row = seen[1]
            if change_px < ENOUGH_PX:
                break
        return seen

    def _shown(self, time_s: float | NDArray) -> NDArray:
        return shown(self.camera, self.moving.at(time_s))


def shown(camera: Camera, xyz: NDArray) -> NDArray:
    """Return where a camera sees points (V, 3) m, and their depth.

    Returns
    -------
    seen : (3, V) float
        Px across and down, bit by bit as from `camera.project` (NaN where the camera sees nothing),
        and metres along the camera's axis.

    Notes
    -----
    Coordinates are separate rows: NumPy takes several times as long on pairs and triples.
    """
    pose = camera.cam_from_world
    seen = np.empty((3, len(xyz)))
    seen[2] = xyz @ pose[2, :3] + pose[2, 3]
    flat, z = seen[:2], xyz @ pose[:, :3].T
    x, y, z = np.add(z.T, pose[:, 3:], out=np.empty(seen.shape))
    with np.errstate(divide="ignore", invalid="ignore"):
        np.divide((x, y), z, out=flat)
        visible = (z > 0) & (np.hypot(*flat) < camera.fold_radius)
    if not visible.all():
        flat[:, ~visible] = np.nan
    flat[:] = camera_models.distort(camera.dist, flat.T).T
    flat *= np.diag(camera.K)[:2, np.newaxis]
    flat += camera.K[:2, 2:]
    return seen


def bounds(xy: NDArray, size: tuple[int, int], pad_px: int) -> Box | None:
    """Return the box of pixels round points with a margin, or None outside of the picture.

    Parameters
    ----------
    xy : (N, 2) float
        Px; NaN is left out.
    size : (int, int)
        Width and height of the picture.
    pad_px : int
        Margin on each side.
    """
    x, y = np.asarray(xy).T
    known = np.isfinite(x) & np.isfinite(y)
    if not known.any():
        return None
    ends = [(part.min(), part.max()) for part in ((x, y) if known.all() else (x[known], y[known]))]
    first, last = np.transpose(ends)
    low = np.clip(np.floor(first) - pad_px, 0, size).astype(int)
    high = np.clip(np.ceil(last) + pad_px + 1, 0, size).astype(int)
    return (int(low[0]), int(low[1]), int(high[0]), int(high[1])) if (high > low).all() else None
