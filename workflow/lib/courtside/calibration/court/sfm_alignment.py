"""Align structure from motion to the court, by the published frame or a robust similarity.

This module also detects exchanged camera files, where the clicks of each of two cameras fit the
pose of the other, cameras turned to the other end of the court, and cameras whose clicks are of
another court beside it.
"""

from collections.abc import Callable, Sequence
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.court.court import ClickedPoints, Court
from courtside.geometry import robust_similarity, triangulation
from courtside.geometry.camera import Camera, undistort
from courtside.geometry.similarity import Sim3
from courtside.study.errors import InputError

# ASSUME: a court whose points are mostly off by more than this part of its length is another court.
MAX_MISFIT = 0.03
MAX_STRETCH = 0.01  # ASSUME: of the ratio of the sides: less can be the clicks' own bias
FLAT = 0.01  # ASSUME: relative to the longest extent: points lower than this all lie on the floor
FITTING = 0.01  # ASSUME: of the court's length: points nearer than this fit
# Of the court's length: structure from motion of 12 small pictures was bent by up to half of this.
MAX_BEND = 0.1
# ASSUME: points must fit this many times better after a change of the clicks of some cameras.
CHANGE_GAIN = 5.0
RIVAL = 2.0  # ASSUME: a change that fits so many times worse than the best one is not the cause
MOST_TURNED = 4  # cameras tried together: there are 40 s of subsets of 16 cameras
FEWEST_MOVED = 4  # ASSUME: clicks of a camera that fit after one shift; fewer may do so by chance
CHECKED = 6  # points among which `click_checks.find_wrong_clicks` finds nearly every wrong click
MOST_SUBSETS = 10000  # of three points each: all of 40 points


def reconstruct(cameras: Sequence[Camera], clicks: ClickedPoints) -> NDArray:
    """Triangulate clicked court points by least squares of the pixel errors.

    The points (P, 3) are in the cameras' frame, of structure from motion or the world; NaN where
    fewer than two cameras have a click or the views do not meet before the cameras that saw them.
    """
    xy = np.stack([np.asarray(clicks[camera.name], float) for camera in cameras])
    return triangulation.triangulate_all(cameras, xy)


def paper_frame(court: Court, xyz_in_sfm: NDArray) -> tuple[Sim3, float]:
    """Find the world frame as the paper does, from the origin and the ends of x and y.

    Also return how far the angle between these sides, as reconstructed, is from 90 degrees.
    Raises `InputError` if one of these points is missing.

    [Shishido2020, eq 2-5]: e_i = (S_i - S_o) / |S_i - S_o| are the rows of R, t = -R S_o,
    D = [R t; 0 1]. They are called orthonormal there and never made so. A camera needs a rotation:
    the nearest one (polar factor of R) replaces R, and D itself is not kept. Where the court's own
    origin is another point than S_o, t moves S_o to its place.

    # ASSUME: S_z, a point on the z axis, is S_o + e_x x e_y: no court point lies above the origin,
    # and the paper does not say how it is found.
    # ASSUME: the scale, "known length over SfM length", is for both sides together, (6.1 + 13.4 m)
    # over the sum of their SfM lengths: the paper names both lengths and one scale. It multiplies R
    # and t.

    Parameters
    ----------
    court : its set "three" names the origin, a point on the x axis and one on the y axis
    xyz_in_sfm : (P, 3) float; reconstructed court points; all three must be there
    """
    names = court.sets["three"]
    places = np.asarray(xyz_in_sfm, float)[court.indices("three")]
    missing = [name for name, place in zip(names, places, strict=True) if np.isnan(place).any()]
    if missing:
        raise InputError(
            f"court points: expected {', '.join(names)} where the rays of two clicks or more meet, "
            f"found no place for {', '.join(missing)}; click them in two cameras or more, or use "
            "another alignment"
        )
    origin, along_x, along_y = places
    sides = np.stack([along_x - origin, along_y - origin])
    lengths = np.linalg.norm(sides, axis=1)
    known = court.xyz[court.indices("three")]
    scale = np.linalg.norm(known[1:] - known[0], axis=1).sum() / lengths.sum()
    e_x, e_y = sides / lengths[:, None]
    e_z = np.cross(e_x, e_y)
    rows = np.stack([e_x, e_y, e_z / np.linalg.norm(e_z)])
    left, _, right = np.linalg.svd(rows)
    world_from_sfm = Sim3(float(scale), left @ right, known[0] - scale * (left @ right) @ origin)
    skew_deg = abs(90 - np.degrees(np.arccos(np.clip(e_x @ e_y, -1, 1))))
    return world_from_sfm, float(skew_deg)


def align(court: Court, xyz_in_sfm: NDArray) -> tuple[Sim3, NDArray]:
    """Find the robust similarity from reconstructed court points to the court.

    Also return which points (P,) bool it accepts. Raises `InputError` if the points are too few,
    collinear or mirrored.
    """
    return robust_similarity.fit(xyz_in_sfm, court.xyz, court.sigma_m)


def check(
    court: Court,
    xyz_in_sfm: NDArray,
    cameras: Sequence[Camera] = (),
    error_modes_m: NDArray | None = None,
) -> list[str]:
    """Check that reconstructed points can be this court, seen the right way round.

    Raises `InputError` if no alignment is possible: too few points, collinear, mirrored, or another
    shape than the court's.

    Parameters
    ----------
    xyz_in_sfm : (P, 3) float; reconstructed court points; NaN where missing
    cameras : those that saw them, in the same frame: they must be above the floor
    error_modes_m : as for `stretch`

    Returns
    -------
    warnings : one line each, without those of `click_checks.check` on single clicks
    """
    world_from_sfm, _ = align(court, xyz_in_sfm)
    _check_size(court, xyz_in_sfm, error_modes_m)
    off_m = misfit_m(court, world_from_sfm, xyz_in_sfm)
    if off_m > MAX_MISFIT * np.max(court.size_m):
        short_m, long_m = court.size_m
        raise InputError(
            f"court points: expected them near those of {court.name} ({short_m:g} m by {long_m:g} "
            f"m), found most {100 * off_m:.0f} cm off after the best alignment; give the right "
            "court file, correct the names of points and cameras in the clicks, or click the same "
            "court in all cameras"
        )
    below = [c.name for c in cameras if world_from_sfm.camera(c).centre_in_world[2] < 0]
    if below:
        raise InputError(
            f"court points: expected the cameras above the floor, found {', '.join(below)} below "
            "it: the points are mirrored; exchange the names of the left and right points in all "
            "cameras, or undo the flip of the videos"
        )
    return _weak(court, np.isfinite(np.asarray(xyz_in_sfm)).all(axis=1))


def misfit_m(court: Court, world_from_sfm: Sim3, xyz_in_sfm: NDArray) -> float:
    """Return the median distance, m, of reconstructed points, NaN where missing, to the court."""
    residual = world_from_sfm.points(xyz_in_sfm) - court.xyz
    return float(np.nanmedian(np.linalg.norm(residual, axis=1)))


def _weak(court: Court, known: NDArray) -> list[str]:
    warnings = []
    if known.sum() < CHECKED:
        warnings.append(
            f"court points: {known.sum()} are seen by two cameras: too few to find a wrong click "
            "among them; click six or more"
        )
    if np.ptp(court.xyz[known, 2]) < FLAT * np.ptp(court.xyz[known], axis=0).max():
        warnings.append(
            "court points: all lie on the floor: heights are several times less certain than on "
            "the floor; click points above it too, such as the tips of the net posts"
        )
    return warnings


def _check_size(court: Court, xyz_in_sfm: NDArray, error_modes_m: NDArray | None) -> None:
    """Raise if the court's two sides have different scales: it is not the court of the file."""
    ratio, sigma = stretch(court, xyz_in_sfm, error_modes_m)
    if abs(np.log(ratio)) > max(MAX_STRETCH, 5 * sigma):
        short_m, long_m = court.size_m
        raise InputError(
            f"court points: expected the sides of {court.name}, {short_m:g} m by {long_m:g} m, "
            f"found {short_m * ratio:.2f} m by {long_m:g} m (or as much in proportion); give the "
            "right court file, click the lines that it names, or click the same court in all "
            "cameras"
        )


def stretch(
    court: Court, xyz_in_sfm: NDArray, error_modes_m: NDArray | None = None
) -> tuple[float, float]:
    """Find whether the reconstructed floor has the court's proportions.

    An affine map from the floor to the points' frame, by least median of squares over subsets of
    three and least squares over those that agree. A similarity would impose the court's
    proportions.

    Parameters
    ----------
    xyz_in_sfm : (P, 3) float; NaN where missing
    error_modes_m : (P, 3, R) float; displacement of points by R independent errors of the cameras,
        each of one standard deviation (`point_covariance.field`). These errors bend all points
        together, which the points' scatter does not show

    Returns
    -------
    ratio : scale along x over that along y: 1 where the proportions are right
    sigma : standard deviation of its logarithm; inf where the floor points are too few to tell
    """
    xyz_in_sfm = np.asarray(xyz_in_sfm, float)
    floor = np.isfinite(xyz_in_sfm).all(axis=1) & court.on_floor
    if floor.sum() < 5:
        return 1.0, np.inf
    design = np.column_stack([np.ones(floor.sum()), court.xyz[floor, :2]])
    agree = _affine_agree(design, xyz_in_sfm[floor])
    used = np.flatnonzero(floor)[agree]
    design, places = design[agree], xyz_in_sfm[used]
    if np.linalg.matrix_rank(design) < 3 or len(design) < 4:
        return 1.0, np.inf
    columns = np.linalg.lstsq(design, places)[0]
    residual = places - design @ columns
    variance = (residual**2).sum() / (residual.size - columns.size)
    lengths = np.linalg.norm(columns[1:], axis=1)
    spread = np.diag(np.linalg.inv(design.T @ design))[1:] * variance
    variance = (spread / lengths**2).sum()
    if error_modes_m is not None:
        moved = np.linalg.pinv(design)[1:] @ error_modes_m[used].transpose(2, 0, 1)
        longer = (moved * columns[1:]).sum(axis=2) / lengths**2  # relative, by error
        variance += ((longer[:, 0] - longer[:, 1]) ** 2).sum()
    return float(lengths[0] / lengths[1]), float(np.sqrt(variance))


def _affine_agree(design: NDArray, places: NDArray) -> NDArray:
    """Return which points (n,) bool agree with the affine map that fits most of them."""
    subsets = robust_similarity.triples(len(design), MOST_SUBSETS)
    spanned = np.abs(np.linalg.det(design[subsets]))
    subsets = subsets[spanned > 0.1 * spanned.max()]
    columns = np.linalg.solve(design[subsets], places[subsets])
    distance = np.linalg.norm(design @ columns - places, axis=-1)
    quorum = (len(design) + 4) // 2 - 1
    middle = np.sort(distance, axis=1)[:, quorum]
    best = np.argmin(middle)
    return distance[best] <= max(4 * middle[best], 1e-9 * np.abs(places).max())


def refuse_misplaced_cameras(
    court: Court,
    cameras: Sequence[Camera],
    clicks: ClickedPoints,
    adjust: Callable[[ClickedPoints], Sequence[Camera]] | None = None,
) -> None:
    """Raise `InputError` if the clicks fit the court only after those of some cameras are changed.

    That is after half a turn of the court for some cameras: they are named from the other end, or
    the ends of the hall look alike and the walk joined the cameras to the wrong one. Or after those
    of two cameras are exchanged: their files may be exchanged. Or, of three cameras or more, once
    the court is moved beside itself for some: they are clicked on another court, or the walk joined
    them to the wrong place. Other faults of the clicks are not looked for.

    Parameters
    ----------
    cameras : in one frame, of structure from motion, which no click has shaped. Adjusted cameras
        have followed their clicks as far as the ties allow: of these a fault is found only where
        the ties withstood it
    adjust : function from clicks to the fixed cameras after a joint adjustment with them. With few
        pictures, structure from motion is bent by more than the scatter of clicks: points that
        this bend can explain are judged after the adjustment
    """
    near_m = FITTING * np.max(court.size_m)
    if not misses_court(court, cameras, clicks):
        return
    off_m = _off_m(court, cameras, clicks, adjust)
    if off_m < near_m:
        return
    most_m = min(near_m, off_m / CHANGE_GAIN)
    found = f"{100 * off_m:.0f} cm off" if np.isfinite(off_m) else "impossible"
    expected = f"expected clicked court points to fit the walk, found them {found}, but"
    line_of = _line_of_two if len(cameras) == 2 else _line_of_several
    line = line_of(court, cameras, clicks, adjust, most_m, expected)
    if line:
        raise InputError(line)


def _line_of_several(
    court: Court,
    cameras: Sequence[Camera],
    clicks: ClickedPoints,
    adjust: Callable[[ClickedPoints], Sequence[Camera]] | None,
    most_m: float,
    expected: str,
) -> str:
    """Return the line on cameras whose clicks fit once some are turned or two exchanged, or ""."""
    pairs = combinations([camera.name for camera in cameras], 2)
    exchanges = {(a, b): {**clicks, a: clicks[b], b: clicks[a]} for a, b in pairs}
    apart_m = [_off_m(court, cameras, one) for one in exchanges.values()]
    turned, after_turn, turned_m = _turned(court, cameras, clicks)
    if turned_m < min(apart_m, default=np.inf):
        better_m = _off_m(court, cameras, after_turn, adjust)
        if better_m < most_m:
            who = f"camera{'s' * (len(turned) > 1)} {', '.join(turned)}"
            return _turned_line(who, ", ".join(turned), expected, better_m)
    for (one, other), exchanged in exchanges.items():
        better_m = _off_m(court, cameras, exchanged, adjust)
        if better_m < most_m:
            return _exchanged_line(one, other, expected, better_m)
    return _line_of_beside(court, cameras, clicks, adjust, expected)


def _line_of_two(
    court: Court,
    cameras: Sequence[Camera],
    clicks: ClickedPoints,
    adjust: Callable[[ClickedPoints], Sequence[Camera]] | None,
    most_m: float,
    expected: str,
) -> str:
    """Return the line on two cameras whose clicks fit once exchanged or once one is turned, or "".

    A change that fits about as well as the best one is told, too: two cameras may look alike from
    both ends.
    """
    one, other = names = [camera.name for camera in cameras]
    exchanged_m = _off_m(court, cameras, {one: clicks[other], other: clicks[one]}, adjust)
    turned_m = dict.fromkeys(names, np.inf)
    for name in names:
        after_turn = {**clicks, name: court.turned(np.asarray(clicks[name], float))}
        if _shared(after_turn, [name]) >= _shared(clicks, [name]) / 2:
            turned_m[name] = _off_m(court, cameras, after_turn, adjust)
    best_m = min(exchanged_m, *turned_m.values())
    if best_m >= most_m:
        return ""
    turned = " or ".join(name for name in names if turned_m[name] <= RIVAL * best_m)
    if exchanged_m > RIVAL * best_m:
        return _turned_line(f"camera {turned}", turned, expected, best_m)
    line = _exchanged_line(one, other, expected, exchanged_m)
    if not turned:
        return line
    turn = f"half a turn of the court in camera {turned} alone fits as well"
    return f"{line}; but {turn}: look whether its points are named from the other end"


def _turned(
    court: Court, cameras: Sequence[Camera], clicks: ClickedPoints
) -> tuple[tuple[str, ...], ClickedPoints, float]:
    """Return the cameras whose clicks fit best after half a turn, these clicks, and their misfit.

    The cameras are half of all at most: then the others are turned. The misfit, m, is that before
    adjustment. It is infinite of a single camera, and where the turn leaves fewer than half of the
    clicks on points that another camera shows: without them any fault would be gone.
    """
    names = [camera.name for camera in cameras]
    if len(names) < 2:
        return (), clicks, np.inf
    after_turn = {name: court.turned(np.asarray(clicks[name], float)) for name in names}
    sizes = range(1, min(len(names) // 2, MOST_TURNED) + 1)
    some = [chosen for size in sizes for chosen in combinations(names, size)]
    tried = [{**clicks, **{name: after_turn[name] for name in chosen}} for chosen in some]
    off_m = [
        _off_m(court, cameras, one) if _shared(one, who) >= _shared(clicks, who) / 2 else np.inf
        for who, one in zip(some, tried, strict=True)
    ]
    best = int(np.argmin(off_m))
    return some[best], tried[best], off_m[best]


def _shared(clicks: ClickedPoints, chosen: Sequence[str]) -> int:
    """Return how many clicks of chosen cameras are of points that another camera shows, too."""
    seen = {name: np.isfinite(np.asarray(xy, float)).all(axis=-1) for name, xy in clicks.items()}
    both = np.sum(list(seen.values()), axis=0) > 1
    return int(sum((seen[name] & both).sum() for name in chosen))


def _line_of_beside(
    court: Court,
    cameras: Sequence[Camera],
    clicks: ClickedPoints,
    adjust: Callable[[ClickedPoints], Sequence[Camera]] | None,
    expected: str,
) -> str:
    """Return the line on cameras whose clicks fit once the court is moved beside itself, or "".

    The cameras are half of all at most: of just half, the others are named as well.
    """
    names = [camera.name for camera in cameras]
    sizes = range(1, min(len(names) // 2, MOST_TURNED) + 1)
    some = [chosen for size in sizes for chosen in combinations(names, size)]
    chosen = min(some, key=lambda one: _beside(court, cameras, clicks, one)[1], default=())
    by_m, off_m = _beside(court, cameras, clicks, chosen, adjust)
    if off_m > MAX_MISFIT * np.max(court.size_m) or np.linalg.norm(by_m) < np.min(court.size_m):
        return ""
    listed, others = ", ".join(chosen), ", ".join(name for name in names if name not in chosen)
    x, y = np.round(by_m, 1) + 0.0
    return (
        f"camera{'s' * (len(chosen) > 1)} {listed}: {expected} {100 * off_m:.0f} cm off on a court "
        f"{np.hypot(x, y):.1f} m beside that of {others} (along x {x:.1f} m, along y {y:.1f} m): "
        "either the clicks are of two courts, or parts of the hall look alike and the walk joined "
        "pictures to the wrong ones; click the same court in all cameras; if you did, film the "
        f"walk without a break until close beside {listed}"
    )


def _beside(
    court: Court,
    cameras: Sequence[Camera],
    clicks: ClickedPoints,
    chosen: Sequence[str],
    adjust: Callable[[ClickedPoints], Sequence[Camera]] | None = None,
) -> tuple[NDArray, float]:
    """Return how far beside the court, (2,) m, the clicks of chosen cameras are, and their misfit.

    The other cameras place the court, adjusted with their clicks alone. The misfit, m, is theirs or
    that of the chosen camera that fits worst after the shift; inf where too few clicks tell.
    """
    theirs = {n: np.full_like(xy, np.nan) if n in chosen else xy for n, xy in clicks.items()}
    try:
        cameras = adjust(theirs) if adjust else cameras
        xyz = reconstruct(cameras, theirs)
        world_from_sfm, _ = align(court, xyz)
    except InputError:
        return np.zeros(2), np.inf
    wrong = [world_from_sfm.camera(camera) for camera in cameras if camera.name in chosen]
    moved = [_level_offsets(court, camera, clicks[camera.name]) for camera in wrong]
    fewest = min(map(len, moved), default=0)
    if np.isfinite(xyz).all(axis=1).sum() < CHECKED or fewest < FEWEST_MOVED:
        return np.zeros(2), np.inf
    by_m = np.median(np.concatenate(moved), axis=0)
    left_m = [float(np.median(np.linalg.norm(one - by_m, axis=1))) for one in moved]
    return by_m, max(misfit_m(court, world_from_sfm, xyz), *left_m)


def _level_offsets(court: Court, camera: Camera, xy: NDArray) -> NDArray:
    """Return how far from its place, (n, 2) m, each clicked point lies at its own height."""
    known = np.isfinite(np.asarray(xy, float)).all(axis=-1)
    normalised = undistort(camera, np.asarray(xy, float)[known])
    rays = np.column_stack([normalised, np.ones(len(normalised))]) @ camera.cam_from_world[:, :3]
    centre, xyz = camera.centre_in_world, court.xyz[known]
    with np.errstate(divide="ignore"):
        depth = (xyz[:, 2] - centre[2]) / rays[:, 2]
    before = np.isfinite(depth) & (depth > 0)
    return (centre + depth[:, None] * rays - xyz)[before, :2]


def _exchanged_line(one: str, other: str, expected: str, off_m: float) -> str:
    return (
        f"cameras {one} and {other}: {expected} {100 * off_m:.0f} cm off with the clicks of the "
        "two exchanged: the camera files may be exchanged; correct their names in the session, or "
        "in the court points"
    )


def _turned_line(who: str, listed: str, expected: str, off_m: float) -> str:
    return (
        f"{who}: {expected} {100 * off_m:.0f} cm off after half a turn of the court there alone: "
        "either the points are named from the other end there, or both ends of the hall look "
        "alike and the walk joined the picture to the wrong one; if the names are right, film the "
        f"walk without a break until close beside {listed}, with bags or posters at one end"
    )


def misses_court(court: Court, cameras: Sequence[Camera], clicks: ClickedPoints) -> bool:
    """Return whether most court points miss the court by more than the scatter of clicks.

    Then the model is bent, or clicks are wrong. Arguments as for `refuse_misplaced_cameras`.
    """
    return _off_m(court, cameras, clicks) >= FITTING * np.max(court.size_m)


def _off_m(court, cameras, clicks, adjust=None):
    """Return `misfit_m` after alignment, inf where the points cannot be aligned."""
    try:
        off_m = _misfit_m(court, cameras, clicks)
        if adjust and off_m <= MAX_BEND * np.max(court.size_m):
            off_m = _misfit_m(court, adjust(clicks), clicks)
    except InputError:
        return np.inf
    return off_m


def _misfit_m(court: Court, cameras: Sequence[Camera], clicks: ClickedPoints) -> float:
    xyz = reconstruct(cameras, clicks)
    world_from_sfm, _ = align(court, xyz)
    return misfit_m(court, world_from_sfm, xyz)
