"""All ways to calibrate, each alone and refined by people, against truth and on real footage.

    python benchmarks/ways_to_calibrate.py RESULTS --charuco FOLDER [--halls RESULTS] [--seeds 30]

RESULTS are those of a default run. The virtual session `players-b` is calibrated by its walk and
clicks, clicks alone, its court lines, a board, and as a file with errors, in as many draws: of
persons who click, of corners, of the file's errors. Each calibration is refined by the people in
one take. Court lines are found in the one static picture of each camera; which end of the court is
meant, which one click says, is told by the truth. A board is drawn: corners with 0.3 px of noise,
the first board on the floor at a known place. Errors are over the playing volume; `shape` is what
the best similarity leaves; `accepted` are views of limb joints, as in the triangulation.

Court lines are compared with 18 clicks in `LINES` and, with `--halls`, in the sessions of
`other_halls.py`; cameras whose court is not found are clicked in both. Of `walk-4cams` the file as
shipped is refined by the first half of the take and scored by the second. FOLDER has caliscope's
recording of a ChArUco board (`camera_array.toml`, `calibration/extrinsic/xy.csv`). Writes
docs/numbers/ways_to_calibrate.csv; `hall_markers.py` writes the rows of its own recording.
"""

import argparse
import sys
from dataclasses import dataclass, field
from pathlib import Path

import cv2
import numpy as np

import stated
from people_seen import CONFIG, LIMITS, STATED, WEIGHTS, of_takes
from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))

from courtside.calibration import file_formats
from courtside.calibration.boards import adjustment as board_adjustment
from courtside.calibration.boards import corners
from courtside.calibration.boards import quality as board_quality
from courtside.calibration.boards.board import Board
from courtside.calibration.court import court as court_files
from courtside.calibration.court import joint_adjustment, points_alone
from courtside.calibration.court_lines import verdict
from courtside.calibration.file_check import residuals
from courtside.calibration.people import adjustment, held_out, prior, refinement
from courtside.calibration.people import views as people_views
from courtside.calibration.people.held_out import Points
from courtside.calibration.records import covariance, tie_points
from courtside.evaluation import calibration
from courtside.evaluation.numbers.players import NETWORK
from courtside.geometry import camera as camera_models
from courtside.geometry import similarity
from courtside.records.cameras import clicks
from courtside.records.keypoints import skeleton
from courtside.records.truth import session_truth
from courtside.study.configuration import yaml_files
from refined_by_people import disturbed, errors
from virtualgym.session import clicks as clicking

SESSION, TAKE, BASE = "players-b", "footwork", "sfm-n40-lines"
LOOKS = ("plain", "rich")
LINES = ("plain-a", "rich-a", "plain-b", "players-a", "players-b")
LINES_DRAWS = 30
HALLS = tuple(f"hall-{layout}-{look}" for layout in ("a", "b", "corners") for look in LOOKS)
COMMAND = "`python benchmarks/ways_to_calibrate.py`"
MADE = "benchmark", COMMAND
BOARD = {"kind": "chessboard", "squares": [6, 5], "square_m": 0.25}
BOARD_PLACES, CORNER_PX = 60, 0.3  # ASSUME: corners of squares of about 25 px, in a picture at rest
WAYS = {
    "walk": "walk of 40 images and 18 clicks",
    "clicks": "18 clicks, no walk",
    "lines": "court lines",
    "board": "board of 1.5 x 1.25 m",
    "file": "file, off by 0.3 degrees, 3 cm, 0.5 %",
    "file-clicks": "the same file; refined with 18 clicks, too",
}


@dataclass(frozen=True, eq=False)
class Hall:
    """A virtual session with its truth."""

    name: str
    results: Path
    real: session_truth.Truth
    court: court_files.Court

    @property
    def names(self) -> list[str]:
        """Those of its cameras."""
        return [camera.name for camera in self.real.cameras]

    @property
    def sizes(self) -> dict[str, tuple[int, int]]:
        """Width and height of their pictures, px."""
        return {camera.name: camera.size for camera in self.real.cameras}

    def persons(self, n_draws, **changes):
        """Return the court points that drawn persons click; `changes` are of seed or strength."""
        preset = yaml_files.read(ROOT / "config" / "sessions" / f"{self.name}.yaml")["virtual"]
        drawn = {"n_draws": n_draws, "seed": 0, "session": self.name, "preset": preset["preset"]}
        known = self.real.cameras, self.court, self.real.court_xyz
        return list(clicking.clicks_of_persons(*known, **drawn | changes))


def hall(results, name):
    session = yaml_files.read(ROOT / "config" / "sessions" / f"{name}.yaml")
    court = court_files.read(ROOT / "config" / "courts" / f"{session['court']}.yaml")
    truth = session_truth.read(results / "virtual" / name / "truth.npz")
    return Hall(name, results, truth, court)


def of_lines(one):
    """Return by camera court points (P, 2) px, found without a click; None where not found."""
    found, step, court = {}, CONFIG["propose_court_points"], one.court
    half_turn = court.other_end()
    for camera in one.real.cameras:
        image = cv2.imread(str(one.results / one.name / "static" / f"{camera.name}.png"))
        judged, proposed = verdict.examine(image, court, camera.name, **step)
        if judged.outcome != verdict.FOUND:
            found[camera.name] = None
            continue
        xy = proposed.xy
        off = [
            np.nanmedian(np.abs(points - camera_models.project(camera, one.real.court_xyz)))
            for points in (xy, xy[half_turn])
        ]
        found[camera.name] = xy if off[0] <= off[1] else xy[half_turn]
    return found


def together(lines, clicked):
    """Return the points of lines, and clicks in cameras whose court was not found."""
    return {name: clicked[name] if xy is None else xy for name, xy in lines.items()}


def volume_cm(one, marked):
    """Return the error over the volume of cameras from points alone."""
    found = points_alone.calibrate(one.court, marked, one.sizes, **WEIGHTS).solution.cameras
    return calibration.score(found, one.real.cameras, one.court, marked)["volume_rms_cm"]


def compare_lines(one, lines, n_draws):
    """Yield the parts of a row: court lines against clicks, everywhere the same way."""
    persons = one.persons(n_draws)
    by_clicks = np.array([volume_cm(one, marked) for marked in persons])
    n_found = sum(xy is not None for xy in lines.values())
    mixed = persons if n_found < len(lines) else persons[:1]
    by_lines = np.array([volume_cm(one, together(lines, marked)) for marked in mixed])
    yield "found", f"{n_found} of {len(lines)}", "cameras", 1
    yield "found_clicks", f"{np.median(by_clicks):.2f} / {high(by_clicks):.2f}", "cm", n_draws
    if n_found:
        yield "found_lines", f"{np.median(by_lines):.2f}", "cm", len(mixed)
        yield "found_ratio", f"{np.median(by_lines) / np.median(by_clicks):.2f}", "", n_draws


def high(values):
    return np.quantile(values, 0.95)


@dataclass(frozen=True, eq=False)
class Calibrated:
    """Cameras with what is known of them, and the court points that tell of them."""

    cameras: list[camera_models.Camera]
    covariance: covariance.CameraCovariance
    points: Points = field(default_factory=Points)


def calibrate(one, way, seed, clicked, lines, ties):
    """Return the cameras of one way and draw."""
    if way == "walk":
        solved = joint_adjustment.solve_with_factors(ties, clicked, one.court, **WEIGHTS)
    elif way in ("clicks", "lines"):
        clicked = together(lines, clicked) if way == "lines" else clicked
        solved = points_alone.calibrate(one.court, clicked, one.sizes, **WEIGHTS).solution
    elif way == "board":
        return Calibrated(*of_board(one, seed))
    else:
        cameras = disturbed(one.real.cameras, STATED, np.random.default_rng(seed))
        marked = adjustment.court_clicks(one.court, clicked, cameras, **WEIGHTS)
        points = Points(court=marked, fitted=True) if way == "file-clicks" else Points()
        return Calibrated(cameras, prior.stated(cameras, **STATED), points)
    return Calibrated(solved.cameras, solved.named)


def of_board(one, seed):
    """Return cameras from a board that is carried about the court, in the court's frame."""
    random, board = np.random.default_rng(seed), Board.of(BOARD)
    middle = np.array([*one.court.size_m / 2, 0])
    floor = np.column_stack([np.eye(3), middle])
    poses = [floor]
    for _ in range(BOARD_PLACES - 1):
        towards = one.real.cameras[random.integers(len(one.names))].centre_in_world - middle
        z = towards / np.linalg.norm(towards) + random.normal(0, 0.4, 3)
        x = np.cross([0, 0, 1.0], z)
        turn = np.stack([x / np.linalg.norm(x), np.zeros(3), z / np.linalg.norm(z)], axis=1)
        turn[:, 1] = np.cross(turn[:, 2], turn[:, 0])
        place = random.uniform([0, 0, 0.8], [*one.court.size_m, 1.6])
        poses.append(np.column_stack([turn, place]))
    rows = []
    for c, camera in enumerate(one.real.cameras):
        for p, pose in enumerate(poses):
            if (camera.centre_in_world - pose[:, 3]) @ pose[:, 2] <= 0:
                continue  # from behind
            xy = camera_models.project(camera, board.corners @ pose[:, :3].T + pose[:, 3])
            if camera_models.in_picture(camera, xy).all():
                xy = xy + random.normal(0, CORNER_PX, xy.shape)
                rows += [(c, p, k, *place) for k, place in enumerate(xy)]
    table, names = np.array(rows), tuple(f"{p:03d}" for p in range(BOARD_PLACES))
    index = table[:, :3].astype(int).T
    seen = corners.Corners(tuple(one.names), names, one.sizes, *index, table[:, 3:])
    found = board_adjustment.calibrate(board, seen, one.sizes, floor=names[0])
    in_court = similarity.Sim3(1.0, floor[:, :3], floor[:, 3])
    cameras = [in_court.camera(camera) for camera in found.cameras]
    return cameras, found.covariance


def accepted(cameras, seen):
    """Return the share of views of limb joints that the triangulation accepts, %."""
    found = people_views.placed(cameras, seen, LIMITS)
    return 100 * found.accepted[np.nan_to_num(seen.flat()[1]) >= LIMITS.score].mean()


def measured(one, way, n_draws, lines):
    """Return of each draw the errors before and after refinement by people, and whether taken."""
    seen = of_takes(one.results / one.name, [TAKE], BASE, NETWORK, one.names)[0]
    record = tie_points.read(one.results / one.name / "sfm" / "global-n40-o0" / "ties.npz")
    rows = []
    alike = way == "lines" and not any(xy is None for xy in lines.values())
    for seed, clicked in enumerate(one.persons(1 if alike else n_draws)):
        base = calibrate(one, way, seed, clicked, lines, record.ties)
        found = refinement.refine(base.cameras, base.covariance, seen, LIMITS, base.points)
        pair = []
        for cameras, known in (
            (base.cameras, base.covariance),
            (found.cameras, found.covariance),
        ):
            each = errors(cameras, known, one.real, one.court, clicked)
            pair.append([each["volume_rms_cm"], each["shape_cm"], accepted(cameras, seen)])
        rows.append((*pair, found.taken != "base"))
        print(way, seed, np.round(pair, 2).tolist(), found.line, flush=True)
    return rows


def virtual_rows(one, n_draws, lines):
    """Yield (row, part, printed, unit, n) of all ways in the virtual session."""
    for way, words in WAYS.items():
        found = measured(one, way, n_draws, lines)
        n = len(found)
        for at, stage in enumerate(("alone", "refined")):
            volume, shape, share = np.array([row[at] for row in found]).T
            row = f"`{one.name}`: {words}"
            yield row, stage, f"{np.median(volume):.2f} / {high(volume):.2f}", "cm", n
            yield row, f"{stage}_shape", f"{np.median(shape):.2f}", "cm", n
            yield row, f"{stage}_accepted", f"{np.median(share):.1f}", "%", n
        yield row, "refined_taken", f"taken {sum(one[2] for one in found)} of {n}", "", n


def limb_variation(cameras, seen):
    """Return the mean coefficient of variation of eight limb lengths, %."""
    xyz = people_views.placed(cameras, seen, LIMITS).xyz
    xyz, joints = xyz.reshape(len(seen.track), -1, 3), list(skeleton.JOINTS)
    shape = skeleton.read(ROOT / "config" / "skeletons" / "blazepose33.yaml")
    ends = [[joints.index(joint) for joint in pair] for pair in shape.segments.values()]
    length = np.stack([np.linalg.norm(xyz[:, a] - xyz[:, b], axis=1) for a, b in ends])
    return 100 * np.mean(np.nanstd(length, axis=1) / np.nanmean(length, axis=1))


def walk_rows(results):
    """Yield rows of `walk-4cams`: the file as shipped, refined by one half, scored by the other."""
    session = yaml_files.read(ROOT / "config" / "sessions" / "walk-4cams.yaml")
    names = list(session["cameras"])
    path = results.parent / session["calibration"]["file"]
    theirs = file_formats.rename(path, file_formats.read(path), {name: name for name in names})
    crops = {name: (one or {}).get("crop_px") for name, one in session["cameras"].items()}
    base = [camera_models.crop(c, crops[c.name]) if crops[c.name] else c for c in theirs]
    seen = of_takes(results / "walk-4cams", ["balancing"], "file", NETWORK, names)[0]
    half = np.arange(len(seen.track)) < len(seen.track) / 2
    half, other = seen.of(half), seen.of(~half)
    _, static = clicks.read_static(ROOT / "config" / "static_points" / "walk-4cams.csv", names)
    static = np.stack(list(static))
    found = refinement.refine(
        base, prior.stated(base, **STATED), half, LIMITS, Points(static), calibrated=theirs
    )
    print(found.line, *found.wrong, sep="\n")
    row = "`walk-4cams`: file as shipped"
    for stage, cameras in (("alone", base), ("refined", found.cameras)):
        off_px = residuals.rms_px(residuals.Rays(static).residuals(cameras))
        score = held_out.score(lambda *_, c=cameras: c, other, Points(), LIMITS)
        views_ = ", ".join(f"{share:.0f}" for share in score.accepted_percent())
        yield row, stage, f"static points {off_px:.2f} px", "px", static.shape[1]
        yield row, f"{stage}_shape", f"limbs vary by {limb_variation(cameras, other):.1f} %", "%", 8
        yield row, f"{stage}_accepted", views_, "%", len(other.track)
    yield row, "refined_taken", found.taken, "", 1


def charuco_rows(folder):
    """Yield the row of a real board in a man's hands, given lenses, against caliscope's cameras."""
    given = {"kind": "charuco", "squares": [4, 5], "square_m": 0.054, "dictionary": "DICT_4X4_1000"}
    board, theirs = Board.of(given), file_formats.read(folder / "camera_array.toml")
    names = {camera.name: camera.name for camera in theirs}
    table = folder / "calibration" / "extrinsic" / "xy.csv"
    seen = corners.of_table(table, names, board)
    lenses, sizes = {c.name: c for c in theirs}, {c.name: c.size for c in theirs}
    found = board_adjustment.calibrate(board, seen, sizes, lenses=lenses)
    mean, spread, n = board_quality.neighbours_mm(found, seen, board)
    ours, others = (np.array([c.centre_in_world for c in one]) for one in (found.cameras, theirs))
    turned = ours @ similarity.umeyama(ours, others).rotation.T  # the scale is not fitted
    off = turned - turned.mean(axis=0) - (others - others.mean(axis=0))
    off = 1e3 * np.linalg.norm(off, axis=1)
    row = "`charuco-4cams`: its own board, squares of 54 mm"
    yield row, "alone", f"squares {mean:+.2f} mm, sd {spread:.2f} mm", "mm", n
    yield row, "alone_shape", f"cameras {off.max():.1f} mm off the given ones", "mm", len(off)


def rows(results, halls, charuco, n_draws):
    """Yield the rows as docs/make_tables.py reads them."""
    where = dict.fromkeys(LINES, results) | (dict.fromkeys(HALLS, halls) if halls else {})
    for name, folder in where.items():
        one = hall(folder, name)
        lines = of_lines(one)
        found = list(compare_lines(one, lines, LINES_DRAWS))
        print(name, found, flush=True)
        for part, printed, unit, n in found:
            yield ["lines-clicks", f"`{name}`", part, printed, unit, name, n, 0, *MADE]
        if name == SESSION:
            chosen = one, n_draws, lines
    halls_rows = [(SESSION, virtual_rows(*chosen)), ("walk-4cams", walk_rows(results))]
    for name, found in [*halls_rows, ("charuco-4cams", charuco_rows(charuco))]:
        for row, part, printed, unit, n in found:
            yield ["ways", row, part, printed, unit, name, n, 0, *MADE]


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path)
    parser.add_argument("--charuco", type=Path, required=True)
    parser.add_argument("--halls", type=Path)
    parser.add_argument("--seeds", type=int, default=30)
    given = parser.parse_args()
    made = list(rows(given.results, given.halls, given.charuco, given.seeds))
    path = ROOT / stated.FOLDER / "ways_to_calibrate.csv"
    others = stated.of_other_sessions(path, {row[5] for row in made})
    stated.write(path, [*stated.joined(made), *others])
