"""Draw detections and reprojected skeletons on pictures of the videos.

Reads 2D keypoints, people, clocks, 3D keypoints and videos; writes figure and CSV.
"""

import numpy as np

from courtside.figures.style import style
from courtside.figures.take import overlay
from courtside.geometry import camera as cameras
from courtside.pose import privacy
from courtside.reconstruction import camera_shake, resampling
from courtside.records.cameras import shake_table
from courtside.records.devices import clocks as sync
from courtside.records.keypoints import keypoints, people, skeleton
from courtside.study.execution.script import run
from courtside.video import reader


def main(paths, pdf, png, csv, *, n_frames, blur_faces):
    joints, points = skeleton.read(paths.skeleton), keypoints.read_3d(paths.pose3d)
    known = {camera.name: camera for camera in cameras.read_toml(paths.cameras)}
    (_, clocks), who = sync.read(paths.sync), people.read(paths.people)
    seen = {}
    for path, film in zip(paths.pose2d, paths.videos, strict=True):
        view = who.assigned(keypoints.read_2d(path))
        at_times, own_s = resampling.nearest(view, points.time_s, clocks[view.camera])
        seen[view.camera] = at_times, own_s, film
    used = [name for name in points.cameras.tolist() if name in seen]
    times_s = overlay.chosen_times(points, n_frames)
    tables = shake_table.read_all(paths.shake)
    shaken = {
        name: standing(known[name], *seen[name][:2], tables.get(name), times_s) for name in used
    }
    stood = [[shaken[name][at] for name in used] for at in range(len(times_s))]
    panels = [
        [panel(points, camera, *seen[camera.name], time_s, joints, blur_faces) for camera in row]
        for time_s, row in zip(times_s, stood, strict=True)
    ]
    views = [seen[name][0] for name in used]
    table = overlay.table(stood, views, points, times_s)
    style.save(overlay.draw(panels, times_s, used), table, pdf, png, csv)


def standing(camera, view, own_s, table, times_s):
    """Return the camera as it stood in the frames nearest to times."""
    if table is None:
        return [camera] * len(times_s)
    at = [overlay.nearest(view, time_s) for time_s in times_s]
    return [cameras.turned(camera, v) for v in camera_shake.frame_turns(camera, table, own_s[at])]


def panel(points, camera, view, own_s, film, time_s, joints, blur_faces):
    at = overlay.nearest(view, time_s)
    column = points.cameras.tolist().index(camera.name)
    both = view.xy[:, at], overlay.reproject(camera, points, time_s)
    image = reader.read_frame(film, own_s[at])[1]
    if blur_faces:
        face = [joints.index(name) for name in joints.groups["face"]]
        faces = np.concatenate([xy[:, face] for xy in both], axis=1)
        image = privacy.hide(image, np.concatenate(both), joints.bone_indices(), faces)
    return overlay.panel(image, *both, points.accepted[:, at, :, column], joints)


if __name__ == "__main__":
    run(main, snakemake)
