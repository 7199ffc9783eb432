"""The 3D viewer of a take: court, cameras and skeletons of several methods, in one HTML file.

Our own scripts (`assets/viewer_*.js`) draw on a 2D canvas. A take is some hundred lines and dots
without hidden surfaces, and a canvas opens at once and needs no graphics processor. Plotly would
add 4.7 MB to each page; three.js 0.7 MB, and it needs WebGL, which remote desktops and lab
computers often lack.

In the browser `courtside.viewer` gives tests and scripts: `ready` (a promise), `state()` (time,
frame, speed, colours, shown layers, picked joint), `seek(time_s)`, `play()`, `pause()`,
`position(layer, person, joint, frame)` in metres, `covariance(...)` in square metres,
`reprojection_px(...)`, `drawn()` (places of the joints in the canvas, px) and `opened_ms` (from the
start of loading to the first picture).
"""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.court.court import Court
from courtside.geometry import camera as camera_models
from courtside.geometry.camera import Camera
from courtside.pages import page
from courtside.pages.viewer import layers as viewer_layers
from courtside.pages.viewer.layers import Layer

# ASSUME: of all layers; opens at once and fits into e-mail. The rest of the page is about 60 kB.
LARGEST_BYTES = 7_500_000
LEFT, RIGHT, MIDDLE = "#0072B2", "#D55E00", "#666666"  # as in the figures
# Seen on light and dark ground; a take with a suit and a depth camera has seven layers.
LAYER_COLOURS = ["#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#0072B2", "#D55E00", "#888888"]
# ASSUME: length of a camera's pyramid, as a share of its distance and with limits; looks right.
FRUSTUM_SHARE, FRUSTUM_M = 0.06, (0.3, 1.2)
PERCENTILES = (0.5, 99.5)  # of the joints' positions, shown at first: without gross outliers
ROOM_M = 1.0  # of grid around them if there is no court
ASSETS = ("viewer_data.js", "viewer_camera.js", "viewer_draw.js", "viewer_panel.js", "viewer.js")


def build(
    title: str,
    layers: Sequence[Layer],
    cameras: Sequence[Camera] = (),
    court: Court | None = None,
    notes: Sequence[str] = (),
) -> str:
    """Return the page of a take, to be written by `page.write`.

    `layers` are the methods to overlay, in the order of their switches; `ValueError` if there is
    none, or two have one name. Slider and keys step through the frames of the first. Layers larger
    than 7.5 MB in total are thinned to every second, third ... frame, and the page says so.
    Without a court a grid of 1 m is drawn. `notes` are lines below the picture, such as what a
    layer is.
    """
    names = [layer.name for layer in layers]
    if not names or len(set(names)) < len(names):
        raise ValueError(f"expected layers with names that differ, found {names}")
    low, high = _extent(layers)
    middle = (low + high) / 2
    contents, every = _within(layers, middle)
    if every > 1:
        shown_s = layers[0].time_s[::every]
        rate = (len(shown_s) - 1) / (shown_s[-1] - shown_s[0]) if len(shown_s) > 1 else 0.0
        each = f"one frame of {every} is in it, {rate:.2g} per second"
        more = "for all frames of a part, make it a take of its own with trim_s"
        notes = [*notes, f"To keep the page small, {each}; {more}."]
    scene = {
        "middle": middle,
        "low": low,
        "high": high,
        "cameras": _frusta(cameras, middle),
        "court": drawn_court(court) if court else None,
        "grid": [] if court else grid(low, high),
        "colours": {"left": LEFT, "right": RIGHT, "middle": MIDDLE, "layers": LAYER_COLOURS},
        "notes": list(notes),
    }
    return page.build(
        title,
        page.render("viewer.html", title=title, axes=_axes(layers, cameras, court)),
        css=["viewer.css"],
        js=ASSETS,
        data={"scene": scene, "layers": contents},
    )


def _axes(layers: Sequence[Layer], cameras: Sequence[Camera], court: Court | None) -> str:
    """Return in words whose axes the page shows."""
    if court or cameras:
        return f"Axes: those of {'the court' if court else 'the calibration of the cameras'}."
    words = f"Axes: those of {layers[0].name}, turned so that z points up."
    return f"{words} Heights count from its origin, not from the floor."


def _within(layers: Sequence[Layer], middle: NDArray) -> tuple[list[dict], int]:
    every = 1
    while True:
        contents = [viewer_layers.packed(layer, middle, every) for layer in layers]
        size = sum(len(text) for one in contents for text in one.values() if isinstance(text, str))
        if size <= LARGEST_BYTES or all(len(one["time_s"]) < 2 for one in contents):
            return contents, every
        every = max(every + 1, math.ceil(every * size / LARGEST_BYTES))


def _extent(layers: Sequence[Layer]) -> tuple[NDArray, NDArray]:
    """Return the corners low and high (3,) of a box that holds nearly all joints, metres."""
    known = np.concatenate([layer.xyz.reshape(-1, 3) for layer in layers])
    known = known[np.isfinite(known).all(axis=1)]
    if not len(known):
        known = np.array([[0.0, 0.0, 0.0], [1.0, 1.0, 2.0]])
    low, high = np.percentile(known, PERCENTILES, axis=0)
    return low, high


def _frusta(cameras: Sequence[Camera], middle: NDArray) -> list[dict]:
    if not cameras:
        return []
    distances = [np.linalg.norm(camera.centre_in_world - middle) for camera in cameras]
    length_m = float(np.clip(FRUSTUM_SHARE * np.median(distances), *FRUSTUM_M))
    return [frustum(camera, length_m) for camera in cameras]


def frustum(camera: Camera, length_m: float) -> dict:
    """Return the drawing of a camera as a pyramid that reaches `length_m` along its axis.

    `name`; `centre`, `forward` and four `corners` (clockwise from the top left of its picture) in
    the world, metres; `focal` over the picture's shorter side.
    """
    width, height = camera.size
    xy = np.array(
        [[-0.5, -0.5], [width - 0.5, -0.5], [width - 0.5, height - 0.5], [-0.5, height - 0.5]]
    )
    # Where the lens model cannot be inverted, the corners of a camera without distortion.
    pinhole = (xy - camera.K[:2, 2]) / np.diag(camera.K)[:2]
    normalised = camera_models.undistort(camera, xy)
    normalised = np.where(np.isfinite(normalised), normalised, pinhole)
    in_cam = length_m * np.column_stack([normalised, np.ones(4)])
    rotation = camera.cam_from_world[:, :3]
    return {
        "name": camera.name,
        "centre": camera.centre_in_world,
        "forward": rotation[2],
        "corners": in_cam @ rotation + camera.centre_in_world,
        "focal": float(np.diag(camera.K)[:2].mean() / min(camera.size)),
    }


def drawn_court(court: Court) -> dict:
    """Return polygons of floor and lines, and lines of net and posts, in metres."""
    rectangles = np.vstack([[0, 0, *court.size_m], court.lines_m.reshape(-1, 4)])
    floor, *lines = [
        [[x0, y0, 0], [x1, y0, 0], [x1, y1, 0], [x0, y1, 0]]
        for x0, y0, x1, y1 in rectangles.tolist()
    ]
    return {"floor": floor, "lines": lines, "net": _net(court.net) if court.net else []}


def _net(net: dict) -> list[dict]:
    y, (left, right) = net["y_m"], net["x_m"]
    post, mid = net["post_height_m"], net["mid_height_m"]
    middle = (left + right) / 2
    top = [[left, y, post], [middle, y, mid], [right, y, post]]
    posts = [[[x, y, 0], [x, y, post]] for x in (left, right)]
    mesh = [[[x, y, share * z] for x, y, z in top] for share in (0.25, 0.5, 0.75)]
    for x in np.linspace(left, right, 14)[1:-1].tolist():
        height = mid + (post - mid) * abs(x - middle) / (right - middle)
        mesh.append([[x, y, 0], [x, y, height]])
    groups = (([top], 2.5, 0.8), (posts, 3, 0.8), (mesh, 0.7, 0.3))
    return [
        {"points": points, "width": width, "alpha": alpha}
        for lines, width, alpha in groups
        for points in lines
    ]


def grid(low: NDArray, high: NDArray) -> list:
    """Return the lines of a 1 m grid on the floor around a box, two points each, metres."""
    (x0, y0), (x1, y1) = np.floor(low[:2] - ROOM_M).tolist(), np.ceil(high[:2] + ROOM_M).tolist()
    along_y = [[[x, y0, 0], [x, y1, 0]] for x in np.arange(x0, x1 + 0.5).tolist()]
    return along_y + [[[x0, y, 0], [x1, y, 0]] for y in np.arange(y0, y1 + 0.5).tolist()]
