"""Formats that one rule hands to the next: npz records and tables."""

import numpy as np
import pandas as pd

from courtside.calibration.bundle import selection
from courtside.calibration.court import joint_adjustment
from courtside.calibration.records import covariance as camera_covariance
from courtside.calibration.records import tie_points
from courtside.calibration.records.support import Support
from courtside.pages.viewer import layers
from courtside.records import footwork, study_table, tables
from courtside.records import strokes as stroke_tables
from courtside.records.cameras import frame_table, frame_times, shake_table
from courtside.records.devices import device_motion
from courtside.records.keypoints import body_motion, keypoints, people, sightings
from courtside.records.truth import session_truth as truth
from courtside.records.truth import take_truth
from courtside.sfm import grid
from fixtures.cameras import networks_made, scene
from fixtures.people import found, walker
from fixtures.people.bodies_made import body
from fuzz.format import Format, require

RNG = np.random.default_rng(0)


def points(folder):
    """Write 3D keypoints."""
    keypoints.write_3d(folder / "points.npz", walker.points(6, n_persons=2))


def views(folder):
    """Write 2D keypoints."""
    view = walker.views(walker.points(6), scene.ring(1))[0]
    keypoints.write_2d(folder / "view.npz", view)


def motion(folder):
    """Write the motion of a device."""
    made = device_motion.of_person(walker.points(6), walker.points(6).person_id[0])
    device_motion.write(folder / "motion.npz", made)


def read_layer(path):
    """Read a device's motion as the page of a take does."""
    return layers.read(path, "suit", walker.SKELETON, person="p1")


def persons(folder):
    """Write who is which tracklet."""
    index = {"left": np.array([[0, 0, 2, 2, -1], [1, -1, 0, 0, 0]]), "right": np.zeros((2, 3), int)}
    people.write(folder / "people.npz", found.people(index))


def bodies(folder):
    """Write a motion in body axes."""
    made = body(np.arange(5) / 30, RNG.normal(size=(5, 2, 3)), ["left_wrist", "head"])
    body_motion.write(folder / "body.npz", made)


def covariance(folder):
    """Write the covariance of two cameras."""
    root = np.random.default_rng(1).normal(size=(38, 38))
    made = camera_covariance.of_network(["a", "b"], root @ root.T)
    camera_covariance.write(folder / "covariance.npz", made)


def tied(folder):
    """Write what structure from motion says of two cameras."""
    made = networks_made.make(2, 8)
    fixed = networks_made.fixed_cameras(made)
    sizes = tuple(camera.size for camera in fixed)
    known = selection.marginalise(made, [0, 1])
    record = tie_points.Record(
        outcome="", fault="", sfm_cameras=fixed, n_points_seen=[8, 5],
        ties=joint_adjustment.Ties(("side", "back"), sizes, known),
        images=np.array(["static/side.png", "static/back.png", "frames/walk/000000.png"]),
        centres=np.arange(9.0).reshape(3, 3), xyz=np.ones((4, 3)), residual_px=0.4, n_maps=(2, 2),
        support=Support(0.9, "a", 0.8, ("a", "b"), 0.7),
    )  # fmt: skip
    tie_points.write(folder / "ties.npz", record)


def session_truth(folder):
    """Write the truth of a virtual session."""
    poses = np.array([camera.cam_from_world for camera in scene.ring(4)])
    matrix = np.array([[1000.0, 0, 640], [0, 1000, 360], [0, 0, 1]])
    walk = truth.Walk(np.arange(4) / 3, matrix, np.zeros(5), poses, np.ones((4, 2)))
    truth.write(folder / "truth.npz", scene.ring(3), {"walk1": walk}, ["p01"], np.zeros((1, 3)))


def of_take(folder):
    """Write the truth of a virtual take."""
    device = take_truth.DeviceTruth("rgbd", "p1", 0.0, 0.0, 0.0, np.eye(3, 4))
    made = take_truth.TakeTruth(
        time_s=np.arange(5) / 30, joints=np.array(["left_wrist", "head"]),
        person_id=np.array(["p1"]), xyz=np.zeros((1, 5, 2, 3)), racket=np.ones((1, 5, 2, 3)),
        offset_s={"a": 0.0, "b": 0.4}, drift_ppm={"a": 0.0, "b": -35.0},
        events={"p1": {"hit": 1.2}},
        shaken={"b": np.zeros((7, 3, 4))}, devices={"d": device},
    )  # fmt: skip
    take_truth.write(folder / "truth.npz", made)


def frames(folder):
    """Write a table of extracted frames."""
    rows = {
        "frame_idx": [0, 6, 12, 18], "time_s": [0.0, 0.2, 0.4, np.nan],
        "sharpness": [100.5, 20.25, 99.0, 1.0], "name": [f"{k:06d}.png" for k in (0, 6, 12, 18)],
        "kept": [True, False, False, True], "reason": ["", "blurred", "duplicate", ""],
        "photo": ["", "", "", "IMG 4, 2.jpg"],
    }  # fmt: skip
    frame_table.write(folder / "walk.csv", pd.DataFrame(rows))


def read_frames(path):
    """Read a table of frames as the choice of images does."""
    found = frame_table.read(path)
    require(found["kept"].dtype == bool, "kept")
    return grid.read({"walk": path})


def device_times(folder):
    """Write times of a device's frames."""
    made = frame_times.FrameTimes(np.array([12.0, 12.033, 12.1]), np.array([5, 6, 8]))
    frame_times.write(folder / "frames.csv", made)


def read_times(path):
    """Read times of frames and what follows from them."""
    found = frame_times.read(path)
    return found.rate_hz


def shake(folder):
    """Write a table of shake."""
    rows = {key: [0.0, 1.0, 2.0] for key in shake_table.DECIMALS}
    shake_table.write(folder / "shake.csv", pd.DataFrame(rows))


def contacts(folder):
    """Write contacts of feet."""
    chance = np.array([[[1.0, 0.5], [0.25, np.nan]]])
    feet, floor = np.array(footwork.FEET), np.full((1, 2, 2), 0.05)
    points = np.stack([chance, chance], axis=-1)
    made = footwork.Contacts(np.array(["p1"]), feet, np.array([0.0, 0.1]), chance, points, floor)
    footwork.write_contacts(folder / "contacts.npz", made)


def stances(folder):
    """Write stances."""
    rows = [("p1", "left", "stand", *[np.nan] * 2, 0.5, 0.01, 0.0, 2.0, 1.25, -2.5, 0.01, 0.95)]
    rows += [("p1", "left", "lunge", 0.75, 0.02, *[np.nan] * 2, 0.0, 2.0, 1.5, -2.75, 0.01, 0.875)]
    table = pd.DataFrame(rows, columns=list(footwork.STEP_COLUMNS))
    footwork.write_steps(folder / "steps.csv", table)


def foot_events(folder):
    """Write events of feet."""
    rows = [("p1", "split_step", "both", 0.5, 0.01, 0.75, 0.02, 1.5, -2.75, 0.875)]
    table = pd.DataFrame(rows, columns=list(footwork.EVENT_COLUMNS))
    footwork.write_events(folder / "events.csv", table)


def strokes(folder):
    """Write strokes."""
    rows = [("p1", 1.25, 0.02, "right", "found", True, 2.125, 1.5, -2.75, 5.5, 1.0)]
    tables.write(folder / "strokes.csv", pd.DataFrame(rows, columns=stroke_tables.STROKE_COLUMNS))


def reactions(folder):
    """Write reactions."""
    rows = [("p2", "p1", 1.0, 1.0, 1.15, 1.35, 0.15, 0.02, 0.35, 0.03, 0.2, 0.02)]
    tables.write(
        folder / "reactions.csv", pd.DataFrame(rows, columns=stroke_tables.REACTION_COLUMNS)
    )


def named(folder):
    """Write names of people as their page saves them."""
    head = ",".join([*sightings.COLUMNS, *sightings.BOUNDS])
    rows = ["walk,p1,left,0.5,100,200,,", "walk,p2,right,1.5,30.5,20,1,2", "run,p1,left,1,1,1,,"]
    (folder / "people.csv").write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")


def read_named(path):
    """Read names of one take, and all rows as their page does."""
    found = sightings.read(path, "walk", ["p1", "p2"], ["left", "right"])
    return found, sightings.every_row(path, ["walk", "run"])


def measured(folder):
    """Write the table of a study."""
    values = {name: ["a", "b"] for name in study_table.COLUMNS}
    values |= {name: [1.5, np.nan] for name in study_table.NUMBERS}
    tables.write(folder / "study.csv", pd.DataFrame(values))


RECORDS = {
    "points-npz": (points, keypoints.read_3d),
    "views-npz": (views, keypoints.read_2d),
    "motion-npz": (motion, read_layer),
    "people-npz": (persons, people.read),
    "body-npz": (bodies, body_motion.read),
    "covariance-npz": (covariance, camera_covariance.read),
    "ties-npz": (tied, tie_points.read),
    "contacts-npz": (contacts, footwork.read_contacts),
    "truth-npz": (session_truth, truth.read),
    "take-truth-npz": (of_take, take_truth.read),
}
FORMATS = [Format(name, 350, make, read) for name, (make, read) in RECORDS.items()]
FORMATS += [
    Format("people-csv", 600, named, read_named),
    Format("frames-csv", 600, frames, read_frames),
    Format("frame-times-csv", 500, device_times, read_times),
    Format("shake-csv", 500, shake, shake_table.read),
    Format("steps-csv", 300, stances, footwork.read_steps),
    Format("foot-events-csv", 300, foot_events, footwork.read_events),
    Format("study-csv", 500, measured, study_table.read),
    Format("strokes-csv", 300, strokes, stroke_tables.read),
    Format("reactions-csv", 300, reactions, stroke_tables.read_reactions),
]
