"""The true places of a court's lines, posts and net, millimetres off their nominal ones."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.calibration.court.court import Court
from virtualgym.presets import Preset

ON_EDGE_M = 1e-6  # rounding only
POST_M = 0.04  # ASSUME: the Laws of Badminton do not fix a post's width
TAPE_M, NET_DEPTH_M = 0.075, 0.76  # Laws of Badminton, law 1


@dataclass(frozen=True, eq=False)
class Net:
    """A net between two posts that sags between their tips.

    Attributes
    ----------
    feet, tips : (2, 3) float
        Centres of each post's bottom and top face; world, metres.
    sag_m : float
        How much lower the tape is in the middle.
    """

    feet: np.ndarray
    tips: np.ndarray
    sag_m: float

    def tape(self, share: ArrayLike) -> NDArray:
        """Return the tape's upper edge (n, 3) m at fractions (n,) of the way between the tips."""
        share = np.asarray(share, dtype=float)[:, None]
        return (
            self.tips[0]
            + share * (self.tips[1] - self.tips[0])
            - [0, 0, 4 * self.sag_m] * (share * (1 - share))
        )


@dataclass(frozen=True, eq=False)
class PaintedCourt:
    """A court as it was really painted and put up.

    Attributes
    ----------
    lines_m : (L, 4) float
        Painted rectangles: x0 y0 x1 y1.
    court_xyz : (P, 3) float
        The court's named points, in the court's order, metres.
    net : Net or None
    """

    lines_m: np.ndarray
    court_xyz: np.ndarray
    net: Net | None


# ASSUME: how far lines stand off a court's file where nobody measured them, m; rules of badminton
# state no tolerance, and halls are painted with a tape measure.
OFF_M = 0.003, 0.010
N_POSTS = 2


def misplacement(
    court: Court, strength: float, rng: np.random.Generator
) -> tuple[NDArray, NDArray] | None:
    """Draw how far lines (L,) and posts (2, 2) stand off the court's file, m; None at strength 0.

    At strength 1 each line, across its width, and each post, along x and y, is off by 3 to 10 mm.
    """
    if not strength:
        return None

    def drawn(*shape: int) -> NDArray:
        return strength * rng.uniform(*OFF_M, shape) * rng.choice([-1.0, 1.0], shape)

    return drawn(len(court.lines_m)), drawn(N_POSTS, 2)


def paint_court(
    court: Court,
    preset: Preset,
    rng: np.random.Generator,
    off_m: tuple[NDArray, NDArray] | None = None,
) -> PaintedCourt:
    """Paint a court and put up its net, each line and post with an error of its own.

    Each line is displaced across its width; lines that end at it follow it. `off_m` is from
    `misplacement`.
    """
    low = np.minimum(court.lines_m[:, :2], court.lines_m[:, 2:])
    high = np.maximum(court.lines_m[:, :2], court.lines_m[:, 2:])
    across = np.argmin(high - low, axis=1)
    error = rng.normal(0, preset.line_sigma_m, len(low))
    lines_off_m, posts_off_m = (0.0, 0.0) if off_m is None else off_m
    error += lines_off_m
    ends = np.stack([low, high], axis=1)  # line, end, axis
    moved = ends.copy()
    for line in range(len(low)):
        for end in (0, 1):
            for axis in (0, 1):
                moved[line, end, axis] += (
                    error[line]
                    if axis == across[line]
                    else _shift(low, high, across, error, ends[line, end], axis, line)
                )
    xyz = court.xyz.copy()
    for point in np.flatnonzero(court.on_floor):
        for axis in (0, 1):
            xyz[point, axis] += _shift(low, high, across, error, court.xyz[point, :2], axis)
    net = None
    if court.net is not None:
        net = _net(court.net, preset, rng, posts_off_m)
        _move_posts(court.net, court.xyz, net, xyz)
    return PaintedCourt(moved.reshape(-1, 4), xyz, net)


def _shift(
    low: NDArray,
    high: NDArray,
    across: NDArray,
    error: NDArray,
    place: NDArray,
    axis: int,
    besides: int = -1,
) -> float:
    """Return the error along an axis of the line whose edge or middle a place is on; else 0."""
    # A line may end at the far edge of another line.
    slack = 0.6 * (high - low).min(initial=np.inf)
    inside = (place >= low - slack) & (place <= high + slack)
    near = (across == axis) & inside.all(axis=1)
    if besides >= 0:
        near[besides] = False
    if not near.any():
        return 0.0
    edges = np.stack([low[:, axis], (low[:, axis] + high[:, axis]) / 2, high[:, axis]])
    away = np.abs(edges - place[axis]).min(axis=0)
    away[~near] = np.inf
    nearest = np.argmin(away)
    return error[nearest] if away[nearest] < ON_EDGE_M else 0.0


def _net(
    table: dict, preset: Preset, rng: np.random.Generator, off_m: NDArray | float = 0.0
) -> Net:
    feet = np.array([[x, table["y_m"], 0.0] for x in table["x_m"]])
    feet[:, :2] += rng.normal(0, preset.post_foot_sigma_m, (2, 2)) + off_m
    upright = np.array([0, 0, table["post_height_m"]])
    tips = feet + upright + rng.normal(0, preset.post_tip_sigma_m, (2, 3))
    return Net(feet, tips, table["post_height_m"] - table["mid_height_m"])


def _move_posts(table: dict, nominal: NDArray, net: Net, xyz: NDArray) -> None:
    """Move the court's points on posts to the true posts."""
    for post, x in enumerate(table["x_m"]):
        for height, true in ((0.0, net.feet[post]), (table["post_height_m"], net.tips[post])):
            named = np.array([x, table["y_m"], height])
            xyz[np.abs(nominal - named).max(axis=1) < ON_EDGE_M] = true
