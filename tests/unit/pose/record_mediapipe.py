"""Record what MediaPipe Pose's own Python solution finds, for tests of this project's network code.

Run by hand, never by pytest, in an environment that has MediaPipe 0.10.21 and not this project's
packages (`python benchmarks/peers.py mediapipe` makes it and prints its interpreter):

    PYTHON tests/unit/pose/record_mediapipe.py VIDEOS PHOTO OUTPUT

VIDEOS is the folder with cam01.mp4 .. cam04.mp4 of `walk-4cams`, PHOTO the file of `people`, OUTPUT
the folder of this script. It writes there

- `mediapipe_landmarks.csv`: each picture on its own (static_image_mode=True), seven frames of each
  video and the photo (frame 0);
- `mediapipe_tracking.csv`: cam03 from frame 0 on as one clip (static_image_mode=False), every fifth
  kept;
- `mediapipe_tracking_unsmoothed.csv`: the same with smooth_landmarks=False.

All with model_complexity=1, min_detection_confidence=0.5 and the solution's other defaults. Frames
are decoded in order by cv2.VideoCapture and counted from 0: nothing depends on how well a file
seeks.
"""

import argparse
import csv
from pathlib import Path

import cv2
import mediapipe

VIDEOS = ("cam01", "cam02", "cam03", "cam04")
STATIC_FRAMES = (0, 12, 25, 37, 50, 62, 75)
TRACKED, TRACKED_FRAMES, KEEP_EVERY = "cam03", 100, 5
COLUMNS = (
    "video", "frame_idx", "joint_idx", "x_px", "y_px", "visibility",
    "world_x_m", "world_y_m", "world_z_m",
)  # fmt: skip
HEADER = """\
# MediaPipe Pose {version} (Python solution), {mode}, model_complexity=1, min_detection_confidence=0.5.
# Made by record_mediapipe.py. x_px = x * width and y_px = y * height of its normalised landmarks, unchanged: MediaPipe's
# own convention, with no half-pixel shift. World: metres, origin between the hips, x right, y down, z away from the camera.
# A row with only video and frame_idx: it found nobody in that picture.
"""  # noqa: E501


def frames(path, count):
    """Yield the first `count` BGR frames of a video."""
    capture = cv2.VideoCapture(str(path))
    for frame_idx in range(count):
        found, frame = capture.read()
        if not found:
            raise SystemExit(f"{path}: frame {frame_idx} cannot be decoded, {count} were expected")
        yield frame
    capture.release()


def rows(solution, name, frame_idx, frame):
    """Return the CSV rows of one picture: 33, or one without numbers."""
    found = solution.process(cv2.cvtColor(frame, cv2.COLOR_BGR2RGB))
    if found.pose_landmarks is None:
        return [(name, frame_idx) + ("",) * (len(COLUMNS) - 2)]
    height, width = frame.shape[:2]
    pairs = zip(found.pose_landmarks.landmark, found.pose_world_landmarks.landmark, strict=True)
    table = []
    for joint_idx, (image, world) in enumerate(pairs):
        numbers = (
            image.x * width, image.y * height, image.visibility, world.x, world.y, world.z,
        )  # fmt: skip
        table.append((name, frame_idx, joint_idx, *(f"{number:.4f}" for number in numbers)))
    return table


def pose(static, smooth=True):
    """Return MediaPipe's solution, configured as the header says."""
    return mediapipe.solutions.pose.Pose(
        static_image_mode=static,
        smooth_landmarks=smooth,  # without effect on single pictures
        model_complexity=1,
        min_detection_confidence=0.5,
    )


def static(videos, photo):
    """Return the rows of every picture taken on its own."""
    table = []
    with pose(static=True) as solution:
        for name in VIDEOS:
            for frame_idx, frame in enumerate(
                frames(videos / f"{name}.mp4", STATIC_FRAMES[-1] + 1)
            ):
                if frame_idx in STATIC_FRAMES:
                    table += rows(solution, name, frame_idx, frame)
        table += rows(solution, photo.stem, 0, cv2.imread(str(photo)))
    return table


def tracking(videos, smooth):
    """Return the rows of one clip, in which each frame starts from the one before."""
    table = []
    with pose(static=False, smooth=smooth) as solution:
        for frame_idx, frame in enumerate(frames(videos / f"{TRACKED}.mp4", TRACKED_FRAMES)):
            found = rows(solution, TRACKED, frame_idx, frame)
            if frame_idx % KEEP_EVERY == 0:
                table += found
    return table


def write(path, mode, table):
    """Write one CSV with its commented header."""
    with path.open("w", newline="", encoding="utf-8") as file:
        file.write(HEADER.format(version=mediapipe.__version__, mode=mode))
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        writer.writerows(table)


def main():
    """Record the three files."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name in ("videos", "photo", "output"):
        parser.add_argument(name, type=Path)
    given = parser.parse_args()
    write(
        given.output / "mediapipe_landmarks.csv",
        "static_image_mode=True",
        static(given.videos, given.photo),
    )
    for stem, smooth in (("mediapipe_tracking", True), ("mediapipe_tracking_unsmoothed", False)):
        write(
            given.output / f"{stem}.csv",
            f"static_image_mode=False, smooth_landmarks={smooth}",
            tracking(given.videos, smooth),
        )


if __name__ == "__main__":
    main()
