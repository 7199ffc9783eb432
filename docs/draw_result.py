"""Draw the picture at the top of README.md from the results of the default study.

Nobody was filmed.

`snakemake`, then `python docs/draw_result.py`. Hall and player are simulated, so the truth is
known.
"""

import argparse
import sys
from pathlib import Path

import numpy as np
from matplotlib.patches import Ellipse

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "workflow" / "lib"))

from courtside.calibration.court import court as court_files
from courtside.evaluation import joints as pose_errors
from courtside.figures.style import oblique_view, picture_crops, stick_figure, style
from courtside.records.cameras import footage
from courtside.records.keypoints import derived_joints, keypoints, skeleton
from courtside.records.truth import take_truth
from courtside.statistics import normal_errors
from courtside.study.errors import InputError
from courtside.video import reader

SESSION, TAKE, TIME_S = "players-b", "shot", 2.37
CALIBRATION, FUSION, NETWORK = "sfm-n40-lines", "all-robust", "blazepose-heavy-flip"
LARGE, CLOSE = "front", ("oblique", "back", "mirror")
RADIUS = np.sqrt(normal_errors.ellipsoid(0.9))  # standard deviations
SIGHT = oblique_view.Sight(azimuth_deg=-60.0, elevation_deg=10.0)
TRUE = "#222222"


def main(results, png):
    """Read one moment of the take, draw it, and write the picture."""
    take, films = results / SESSION / "takes" / TAKE, results / "virtual" / SESSION / "takes" / TAKE
    joints = skeleton.read(ROOT / "config" / "skeletons" / "blazepose33.yaml")
    drawn = stick_figure.stick(joints, derived_joints.read(ROOT / "config" / "derived_joints.yaml"))
    points = keypoints.read_3d(take / "pose3d_corrected" / CALIBRATION / FUSION / f"{NETWORK}.npz")
    seen = footage.read(
        results / SESSION / "calibration" / CALIBRATION / "cameras.toml",
        [take / "pose2d" / NETWORK / f"{name}.npz" for name in (LARGE, *CLOSE)],
        take / "people" / CALIBRATION / f"{NETWORK}.npz",
        take / "sync" / CALIBRATION / f"cameras.{NETWORK}.json",
        [films / f"{name}.mp4" for name in (LARGE, *CLOSE)],
        wanted=points.cameras,
    )
    frame = int(np.argmin(np.abs(points.time_s - TIME_S)))
    drawing = style.figure(88)
    left, right = drawing.subfigures(1, 2, width_ratios=(1.3, 1))
    axes = left.subplot_mosaic([[LARGE] * len(CLOSE), list(CLOSE)], height_ratios=(1.15, 1))
    for one in seen:
        show(axes[one.camera.name], one, points, frame, drawn)
    left.suptitle(
        "Joints found in each picture (yellow), skeleton projected back (blue)", fontsize=8
    )
    true = pose_errors.true_places(points, truth := take_truth.read(films / "truth.npz"))[0, frame]
    axis = right.subplots()
    stand(axis, points, frame, drawn)
    compare(axis, drawn, dict(zip(truth.joints.tolist(), true, strict=True)))
    right.suptitle("In metres, with 90 % ellipsoids; black: the truth", fontsize=8)
    drawing.savefig(png, metadata={"Software": None})


def show(axis, one, points, frame, drawn):
    """Show the joints found in a camera's picture, and the skeleton projected back into it."""
    at = one.frame_at(points.time_s[frame])
    _, image = reader.read_frame(one.video, one.view.time_s[at])
    found, back = drawn.of(one.view.xy[:, at]), drawn.of(one.reprojected(points, at))
    height, width = image.shape[:2]
    whole = one.camera.name == LARGE
    part = picture_crops.Box(width / 2, height / 2, width, height)
    picture_crops.show(
        axis, image, part if whole else picture_crops.box(back, (width, height), 0.95)
    )
    size = 0.5 if whole else 1.2
    picture_crops.sticks(
        axis, found, drawn.bones, picture_crops.DETECTED, width=size, dots=not whole
    )
    look = {"width": 0.8 * size, "outline": 0, "dots": False}
    picture_crops.sticks(axis, back, drawn.bones, picture_crops.REPROJECTED, **look)
    axis.set_xlabel(f"camera {one.camera.name}", labelpad=1, fontsize=7)


def stand(axis, points, frame, drawn):
    """Draw the skeleton in space, with the ellipsoids of the limb joints, on the court."""
    xyz, names = points.xyz[0, frame], points.joints.tolist()
    covariance = points.covariance[0, frame]
    onto = SIGHT.seen(np.eye(3))  # (3, 2): the world's axes on the drawing
    for at in [names.index(joint) for joint in drawn.joints if joint in names]:
        values, vectors = np.linalg.eigh(onto.T @ covariance[at] @ onto)
        width, height = 2 * RADIUS * np.sqrt(values)
        angle = np.degrees(np.arctan2(*vectors[::-1, 0]))
        colour = style.side_colour(names[at])
        look = {"facecolor": colour, "alpha": 0.25, "edgecolor": colour, "linewidth": 0.6}
        axis.add_patch(Ellipse(SIGHT.seen(xyz[at]), width, height, angle=angle, **look, zorder=2))
    oblique_view.figures(axis, SIGHT, drawn.of(xyz)[None], drawn)
    low, high = oblique_view.limits(xyz)
    court = court_files.read(ROOT / "config" / "courts" / "badminton.yaml")
    oblique_view.floor(axis, SIGHT, low, high, court)
    oblique_view.finish(axis, SIGHT, low)


def compare(axis, drawn, true):
    """Draw the true limbs."""
    for start, stop in drawn.bones:
        ends = [true.get(drawn.joints[at]) for at in (start, stop)]
        if all(end is not None for end in ends):
            oblique_view.line(axis, SIGHT, np.array(ends), color=TRUE, linewidth=0.7, zorder=5)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument(
        "results",
        type=Path,
        nargs="?",
        default=ROOT / "results",
        help="folder of a default run (default: results)",
    )
    given = parser.parse_args()
    try:
        main(given.results, ROOT / "docs" / "result.png")
    except (InputError, OSError) as error:
        sys.exit(f"Error: {error}")
