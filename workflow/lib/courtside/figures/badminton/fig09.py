"""The whole chain on the pictures of one take: detection, triangulation, reprojection, measures.

The counterpart of [Shishido2020, fig 9], which shows the way back: projections triangulated again.
"""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase
from matplotlib.patches import Rectangle
from numpy.typing import NDArray

from courtside.calibration.court.court import Court
from courtside.evaluation import round_trip
from courtside.figures.style import oblique_view, picture_crops, style
from courtside.figures.style.stick_figure import Stick
from courtside.figures.take import kinematics
from courtside.geometry.camera import Camera
from courtside.records.cameras.footage import Footage
from courtside.records.keypoints.keypoints import Keypoints3D

ROW_MM = (30, 43, 58, 43)  # highest rows: pictures, detections, 3D and measures, reprojections
LEGEND: dict = {"loc": "lower left", "bbox_to_anchor": (0, 0.98), "ncols": 3, "fontsize": 7}
LEGEND |= {"borderaxespad": 0, "handlelength": 1.2, "columnspacing": 1.2}
WIDE = 16 / 9
HEAD_MM = 7  # above each row
DEPTH = 0.06  # of a camera's pyramid, of the distance between the cameras
SIGHT = oblique_view.Sight(azimuth_deg=-80, elevation_deg=48)
COLUMNS = [
    "time_s", "camera", "person", "joint", "detected_x_px", "detected_y_px", "x_m", "y_m", "z_m",
    "reprojected_x_px", "reprojected_y_px", "round_trip_mm",
]  # fmt: skip


def table(points: Keypoints3D, footage: list[Footage], frame: int, stick: Stick) -> pd.DataFrame:
    """Return the numbers of every step for one frame of `points`.

    For each camera, person and joint of the figure the detected position in the camera's nearest
    frame, the 3D joint, its projection, and the way it moves when triangulated again.
    """
    time_s, xyz = points.time_s[frame], stick.of(points.xyz[:, frame])
    moved = round_trip.distance_after([one.camera for one in footage], xyz)
    parts = []
    for one in footage:
        both = picture_crops.joints_at(one, points, frame)
        detected, back = (stick.of(xy).reshape(-1, 2) for xy in both)
        columns = {
            "time_s": time_s,
            "camera": one.camera.name,
            "person": np.repeat(points.person_id, len(stick.joints)),
            "joint": np.tile(stick.joints, len(points.person_id)),
            **dict(zip(COLUMNS[4:6], detected.T, strict=True)),
            **dict(zip(COLUMNS[6:9], xyz.reshape(-1, 3).T, strict=True)),
            **dict(zip(COLUMNS[9:11], back.T, strict=True)),
            "round_trip_mm": moved.ravel(),
        }
        parts.append(pd.DataFrame(columns))
    return pd.concat(parts, ignore_index=True)[COLUMNS]


def draw(
    rows: pd.DataFrame,
    images: dict[str, NDArray],
    points: Keypoints3D,
    cameras: list[Camera],
    stick: Stick,
    measured: pd.DataFrame,
    court: Court | None = None,
) -> Figure:
    """Draw the steps of `table` from top to bottom.

    `images` (H, W, 3) are BGR by camera, with faces hidden if asked for; `measured` is of
    `courtside.exports.measures.frames`.
    """
    cell = style.WIDTH_MM / len(images)
    heights = [height + HEAD_MM for height in (min(cell / WIDE, ROW_MM[0]), *ROW_MM[1:])]
    drawing = style.figure(sum(heights))
    parts = drawing.subfigures(4, 1, height_ratios=heights)
    boxes = {
        name: picture_crops.box(
            [_xy(rows, name, "detected"), _xy(rows, name, "reprojected")],
            image.shape[1::-1],
            cell / ROW_MM[1],
        )
        for name, image in images.items()
    }
    _draw_pictures(parts[0], images, boxes)
    _draw_joints(parts[1], rows, images, boxes, stick)
    left, right = parts[2].subfigures(1, 2, width_ratios=(1.25, 1))
    _draw_space(left, rows, points, cameras, stick, court)
    _draw_measures(right, rows.time_s.iloc[0], measured)
    _draw_joints(parts[3], rows, images, boxes, stick, reprojected=True)
    time_s, moved = rows.time_s.iloc[0], rows.round_trip_mm.max()
    again = f"triangulated again: moved {moved:.0e} mm, an identity"
    titles = [
        (parts[0], f"1  Pictures of one moment ({time_s:.2f} s); boxes are enlarged below"),
        (parts[1], "↓  2  Joints in each picture, by the pose network"),
        (left, "↓  3  Triangulated by the calibrated cameras"),
        (right, "→  4  Measured over the take"),
        (parts[3], f"↓  5  Projected back (blue) on the detections (yellow); {again}"),
    ]
    for part, title in titles:
        part.suptitle(title, fontsize=8, ha="left", x=0.01)
    return drawing


def _xy(rows: pd.DataFrame, camera: str, which: str) -> NDArray:
    part = rows[rows.camera == camera]
    xy = part[[f"{which}_x_px", f"{which}_y_px"]].to_numpy()
    return xy.reshape(part.person.nunique(), -1, 2)


def _draw_pictures(
    part: FigureBase, images: dict[str, NDArray], boxes: dict[str, picture_crops.Box]
) -> None:
    axes = part.subplots(1, len(images), squeeze=False)[0]
    for axis, (name, image) in zip(axes, images.items(), strict=True):
        height, width = image.shape[:2] if image.size else (1, WIDE)
        picture_crops.show(axis, image, picture_crops.Box(width / 2, height / 2, width, height))
        box = boxes[name]
        corner = box.x - box.width / 2, box.y - box.height / 2
        look = {"fill": False, "edgecolor": picture_crops.DETECTED, "linewidth": 1.0}
        if image.size:
            axis.add_patch(Rectangle(corner, box.width, box.height, **look))
        axis.set_xlabel(name, labelpad=1)


def _draw_joints(
    part: FigureBase,
    rows: pd.DataFrame,
    images: dict[str, NDArray],
    boxes: dict[str, picture_crops.Box],
    stick: Stick,
    *,
    reprojected: bool = False,
) -> None:
    line = 1.4 if len(images) < 4 else 1.0
    axes = part.subplots(1, len(images), squeeze=False)[0]
    for axis, (name, image) in zip(axes, images.items(), strict=True):
        picture_crops.show(axis, image, boxes[name])
        found, colour = _xy(rows, name, "detected"), picture_crops.DETECTED
        if reprojected:
            back = _xy(rows, name, "reprojected")
            picture_crops.compare(axis, found, back, stick.bones, line)
        else:
            picture_crops.sticks(axis, found, stick.bones, colour, width=line)


def _draw_space(
    part: FigureBase,
    rows: pd.DataFrame,
    points: Keypoints3D,
    cameras: list[Camera],
    stick: Stick,
    court: Court | None,
) -> None:
    hall, close = part.subplots(1, 2, width_ratios=(1.5, 1))
    first = rows[rows.camera == rows.camera.iloc[0]]
    xyz = first[["x_m", "y_m", "z_m"]].to_numpy().reshape(first.person.nunique(), -1, 3)
    _draw_hall(hall, xyz, cameras, stick, court)
    path = stick.of(points.xyz)[:, :, stick.joints.index("neck")]
    _draw_close(close, xyz, path[:, points.time_s <= rows.time_s.iloc[0]], stick, court)


def _draw_measures(part: FigureBase, time_s: float, measured: pd.DataFrame) -> None:
    speed, angle = part.subplots(2, 1, sharex=True)
    own = measured[measured.person == measured.person.iloc[0]]
    for name, colour in kinematics.SPEEDS.items():
        look = {"color": colour, "linewidth": 0.9, "label": kinematics.NAMES[name]}
        speed.plot(own.time_s, own[f"{name}_ground_speed_m_s"], **look)
    for name, colour in kinematics.ANGLES.items():
        label = name.replace("_flexion", "").replace("_", " ")
        angle.plot(own.time_s, own[f"{name}_deg"], color=colour, linewidth=0.9, label=label)
    for axis in (speed, angle):
        axis.axvline(time_s, color="black", linewidth=0.7)
        axis.legend(**LEGEND)
    speed.set(ylabel="ground speed\n(m/s)", ylim=(0, None))
    speed.tick_params(labelbottom=False)
    angle.set(xlabel="time (s)", ylabel="angle\n(degrees)")


def _draw_hall(
    axis: Axes, xyz: NDArray, cameras: list[Camera], stick: Stick, court: Court | None
) -> None:
    corners = oblique_view.limits(xyz)
    if court is not None:
        corners = np.zeros(2), np.asarray(court.size_m)
    oblique_view.floor(axis, SIGHT, *corners, court)
    oblique_view.net(axis, SIGHT, court)
    centres = np.array([camera.centre_in_world for camera in cameras])
    for camera in cameras:
        oblique_view.camera(axis, SIGHT, camera, DEPTH * np.ptp(centres, axis=0).max())
        for neck in xyz[:, stick.joints.index("neck")]:
            ray = np.stack([camera.centre_in_world, neck])
            oblique_view.line(axis, SIGHT, ray, ":", color="#777777", linewidth=0.6)
    oblique_view.figures(axis, SIGHT, xyz, stick)
    axis.set_aspect("equal")
    axis.set_axis_off()


def _draw_close(axis: Axes, xyz: NDArray, path: NDArray, stick: Stick, court: Court | None) -> None:
    sight, corners = oblique_view.Sight(), oblique_view.limits(xyz)
    oblique_view.floor(axis, sight, *corners, court)
    oblique_view.figures(axis, sight, xyz, stick)
    oblique_view.finish(axis, sight, corners[0])
    axis.autoscale_view()
    axis.set_autoscale_on(False)
    for one in path:
        oblique_view.line(axis, sight, one, color=style.CYCLE[2], linewidth=0.8, zorder=2)
        axis.plot([], [], color=style.CYCLE[2], linewidth=0.8, label="path of the neck")
    handles, labels = axis.get_legend_handles_labels()
    axis.legend(handles[:1], labels[:1], loc="upper center", bbox_to_anchor=(0.5, 0), fontsize=6)
