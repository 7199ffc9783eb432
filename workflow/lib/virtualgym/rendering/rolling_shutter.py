"""Moving surfaces as a rolling shutter sees them: each point at the time at which its row is exposed."""

import numpy as np

from courtside.geometry import camera as distortion
from virtualgym.body import mesh

ROUNDS = (
    6  # at most, of finding the row that sees a point: each leaves 2 % of the error at 1000 px/s
)
ENOUGH_PX = 0.05  # no more rounds where the last one changed nothing by more
FAST_M = 0.05  # what goes farther during one picture is followed through five moments
SLACK = (
    0.04  # of the picture's height, within which an athlete is where the middle row's time has it
)
SHADES = np.array(
    [0.14, -0.10, 0.30]
)  # how much brighter a surface is per unit of its outward normal
AMBIENT = 0.76


class Moving:
    """A surface during one picture: every point on a polynomial in time, through three moments or five.

    Parameters
    ----------
    athlete : object
        Its `mesh(time_s)` gives a `mesh.Mesh`, always of the same triangles.
    time_s : float
        The moment in the middle.
    half_s : float
        From there to the first and to the last moment.
    """

    def __init__(self, athlete, time_s, half_s):
        now = athlete.mesh(time_s)
        self.time_s, self.half_s = time_s, half_s
        self.triangles, self.colours = now.triangles, now.colours
        self.vertices = np.asarray(now.vertices, dtype=float)
        self._powers = [self.vertices]
        if half_s > 0:
            places = {0.0: self.vertices}
            places |= {x: _vertices(athlete, time_s + x * half_s) for x in (-1.0, 1.0)}
            if np.abs(places[1.0] - places[-1.0]).max(initial=0.0) > FAST_M:
                places |= {x: _vertices(athlete, time_s + x * half_s) for x in (-0.5, 0.5)}
            through = np.linalg.inv(np.vander(list(places), increasing=True))
            self._powers = np.tensordot(through, list(places.values()), axes=1)

    def at(self, time_s):
        """Return the vertices (V, 3) m at a time, or each at its own (V,)."""
        if len(self._powers) == 1:
            return self.vertices
        since = ((np.asarray(time_s, dtype=float) - self.time_s) / self.half_s)[..., None]
        xyz = self._powers[-1]
        for power in self._powers[-2::-1]:
            xyz = xyz * since + power
        return xyz

    def light(self):
        """Return how light the surface is at each vertex, (V,) float32."""
        normals = mesh.normals(self.vertices, self.triangles)
        return (AMBIENT + normals @ SHADES).astype(np.float32)


def follow(athlete, camera, time_s, readout_s, exposure_s):
    """Return an athlete's surface while the rows that show it are exposed.

    Parameters
    ----------
    athlete : object
        As `Moving` takes it.
    camera : courtside.geometry.camera.Camera
    time_s, readout_s, exposure_s : float
        As `Screen` takes them.

    Returns
    -------
    moving : Moving
    """
    height = camera.size[1]
    rows = shown(camera, _vertices(athlete, time_s))[1]
    low, high = np.clip([np.nanmin(rows, initial=height), np.nanmax(rows, initial=0)], 0, height)
    middle_s = time_s + ((low + high) / 2 / height - 0.5) * readout_s
    half_s = (abs(high - low) / height + SLACK) * readout_s / 2 + exposure_s / 2
    return Moving(athlete, middle_s, half_s)


def _vertices(athlete, time_s):
    return np.asarray(athlete.mesh(time_s).vertices, dtype=float)


class Screen:
    """A moving surface in the pixels of one picture.

    Parameters
    ----------
    moving : Moving
    camera : courtside.geometry.camera.Camera
    time_s : float
        Mid-exposure of the middle row.
    readout_s : float
        Row v is exposed at ((v + 0.5) / H - 0.5) * readout_s.
    exposure_s : float
        Of each row.
    """

    def __init__(self, moving, camera, time_s, readout_s, exposure_s):
        self.moving, self.camera = moving, camera
        self._time_s, self._readout_s = time_s, readout_s
        middle = self._rolled(self._shown(moving.time_s)[1], 0.0)
        self._shape = [middle]
        if exposure_s > 0:
            ends = [self._rolled(middle[1], share * exposure_s) for share in (-0.5, 0.5)]
            self._shape += [ends[1] - ends[0], 2 * (ends[0] + ends[1] - 2 * middle)]

    @property
    def blur_px(self):
        """How far each vertex moves during the exposure, (V,); NaN where the camera sees nothing."""
        if len(self._shape) == 1:
            return np.zeros(self._shape[0].shape[1])
        return np.hypot(*self._shape[1][:2])

    def at(self, share):
        """Return the vertices at a moment of the exposure.

        Parameters
        ----------
        share : float
            -0.5 at its start, 0.5 at its end.

        Returns
        -------
        vertices : (V, 3) float
            Px across, px down, and metres along the camera's axis; NaN where the camera sees nothing.
        """
        if len(self._shape) == 1:
            return self._shape[0].T
        middle, slope, bend = self._shape
        return (middle + share * (slope + share * bend)).T

    def box(self, pad_px):
        """Return the part of the picture that shows the surface, as `Box` has it; None where none does."""
        ends = np.hstack([self.at(share).T[:2] for share in (-0.5, 0.0, 0.5)])
        return bounds(ends.T, self.camera.size, pad_px)

    def _rolled(self, row, later_s):
        """Return what rows see that are exposed so much later than they are, (3, V)."""
        height = self.camera.size[1]
        for _ in range(ROUNDS):
            own_s = self._time_s + ((row + 0.5) / height - 0.5) * self._readout_s + later_s
            seen = self._shown(own_s)
            change_px = np.fmax.reduce(np.abs(seen[1] - row), initial=0.0)
            row = seen[1]
            if change_px < ENOUGH_PX:
                break
        return seen

    def _shown(self, time_s):
        return shown(self.camera, self.moving.at(time_s))


def shown(camera, xyz):
    """Return where a camera sees points, and how far in front of it.

    Parameters
    ----------
    camera : courtside.geometry.camera.Camera
    xyz : (V, 3) float
        World, metres.

    Returns
    -------
    seen : (3, V) float
        Px across and down as `camera.project` has them, to the last bit (NaN where the camera sees
        nothing), and metres along the camera's axis.

    Notes
    -----
    Coordinates stay apart, each in a row of its own: NumPy takes several times as long on pairs and triples.
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
    flat[:] = distortion.distort(camera.dist, flat.T).T
    flat *= np.diag(camera.K)[:2, np.newaxis]
    flat += camera.K[:2, 2:]
    return seen


def bounds(xy, size, pad_px):
    """Return the box of pixels round points, or None where it has none.

    Parameters
    ----------
    xy : (N, 2) float
        Px; NaN is left out.
    size : (int, int)
        Width and height of the picture.
    pad_px : int
        More on each side.

    Returns
    -------
    box : (int, int, int, int) or None
        First column, first row, and one beyond the last of each.
    """
    x, y = np.asarray(xy).T
    known = np.isfinite(x) & np.isfinite(y)
    if not known.any():
        return None
    ends = [(part.min(), part.max()) for part in ((x, y) if known.all() else (x[known], y[known]))]
    first, last = np.transpose(ends)
    low = np.clip(np.floor(first) - pad_px, 0, size).astype(int)
    high = np.clip(np.ceil(last) + pad_px + 1, 0, size).astype(int)
    return (*low.tolist(), *high.tolist()) if (high > low).all() else None
