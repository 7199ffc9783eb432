"""Draw detections and reprojected skeletons on pictures of the videos.

Reads 2D keypoints, people, clocks, 3D keypoints and videos; writes figure and CSV.
"""

import numpy as np

from courtside.figures.style import style
from courtside.figures.take import overlay
from courtside.geometry import camera as cameras
from courtside.pose import privacy
from courtside.reconstruction import resampling
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
    panels = [
        [panel(points, known[name], *seen[name], time_s, joints, blur_faces) for name in used]
        for time_s in times_s
    ]
    views = [seen[name][0] for name in used]
    table = overlay.table([known[name] for name in used], views, points, times_s)
    style.save(overlay.draw(panels, times_s, used), table, pdf, png, csv)


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
