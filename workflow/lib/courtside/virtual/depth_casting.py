"""How far in front of a camera things are, exactly: rays against the hall and against bodies in motion."""

import numpy as np

from courtside.virtual import casting, exposure, filming, onscreen, rays, sampling

BAND_RAYS = 1 << 16  # at a time
NEAREST_M = 0.1  # surfaces that come nearer are left out
FAR = 1 / NEAREST_M  # greater than the inverse of any depth


def of_hall(renderer, camera):
    """Measure an empty hall.

    Parameters
    ----------
    renderer : courtside.virtual.renderer.Renderer
    camera : courtside.geometry.camera.Camera

    Returns
    -------
    depth_m : (H, W) float32
        Along the camera's axis; inf where nothing is. The net's mesh is too thin to be seen.
    """
    seen = rays.of_camera(camera, rays.grid(camera), None, 0.0)
    view = sampling.View(renderer.surfaces, seen.eye, seen.steps)
    width, height = camera.size
    depth_m = np.empty(height * width, np.float32)
    rows = max(1, BAND_RAYS // width)
    for start in range(0, height, rows):
        direction, _ = seen.of_band(start, min(start + rows, height))
        part = slice(start * width, start * width + direction.shape[1])
        quad = renderer.surfaces.hit(seen.eye.astype(np.float32), np.ascontiguousarray(direction.T))
        away = view.distance(quad, direction, None)
        depth_m[part] = np.where(quad >= exposure.FLOOR, away, np.inf)
    return depth_m.reshape(height, width)


def of_athletes(athletes, camera, time_s, readout_s):
    """Measure moving surfaces, each row of the picture at its own time.

    Parameters
    ----------
    athletes : list
        As `onscreen.Moving` takes them.
    camera : courtside.geometry.camera.Camera
    time_s, readout_s : float
        As `onscreen.Screen` takes them.

    Returns
    -------
    depth_m : (H, W) float32
        Along the camera's axis; inf where none of them is.

    Notes
    -----
    Rays run through the picture, not through space: there rolling shutter and lens are exact at every corner,
    and the inverse of depth is linear on every triangle, so that depth is exact between them, too.
    """
    width, height = camera.size
    depth_m = np.full((height, width), np.inf, np.float32)
    shutter = time_s, readout_s, 0.0
    screens = [
        onscreen.Screen(onscreen.follow(each, camera, *shutter), camera, *shutter)
        for each in athletes
    ]
    for box, group in filming.grouped(screens):
        part = slice(box[1], box[3]), slice(box[0], box[2])
        depth_m[part] = _cast(group, box)
    return depth_m


def _cast(screens, box):
    """Return the depth in a box of the picture, (h, w)."""
    parts, corners, corner = [], [], np.array([*box[:2], 0.0])[:, np.newaxis]
    for screen in screens:
        vertices, triangles = screen.at(0.0).T - corner, screen.moving.triangles
        triangles = triangles[_shown(vertices, triangles)] + sum(part.shape[1] for part in parts)
        vertices[2] = FAR - 1 / np.maximum(vertices[2], NEAREST_M)
        parts.append(vertices)
        corners.append(triangles.T)
    vertices, corners = np.hstack(parts).astype(np.float32), np.hstack(corners)
    corners = corners[:, _met(*casting.spans(vertices, corners))]
    shape = box[3] - box[1], box[2] - box[0]
    row, column = np.indices(shape, np.float32).reshape(2, -1)
    start = np.stack([column, row, np.zeros_like(row)], axis=1)
    along = np.zeros_like(start)
    along[:, 2] = 1
    found = casting.scene(vertices, corners).run(start, along, query="DISTANCE")
    with np.errstate(divide="ignore"):
        depth = np.where(found < FAR, 1 / np.maximum(FAR - found, 1e-9), np.inf)
    return depth.astype(np.float32).reshape(shape)


def _shown(vertices, triangles):
    """Return which triangles of vertices (3, V) are whole before the camera and face it, (F,) bool."""
    (x, y, depth), (a, b, c) = vertices, triangles.T
    with np.errstate(invalid="ignore"):
        seen = np.isfinite(x) & np.isfinite(y) & np.isfinite(depth) & (depth > NEAREST_M)
        # Counter-clockwise seen from outside, but pixels count downwards.
        area = (x[b] - x[a]) * (y[c] - y[a]) - (x[c] - x[a]) * (y[b] - y[a])
    return (area < 0) & seen[a] & seen[b] & seen[c]


def _met(first, last):
    """Return which triangles of these spans (2, F) may meet the ray of a pixel: many are smaller."""
    low, high = np.ceil(first - casting.NEAR_PX), np.floor(last + casting.NEAR_PX)
    return (low <= high).all(axis=0)
