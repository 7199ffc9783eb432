"""Draw one frame's detections and reprojected skeleton: 2D, 3D keypoints, videos -> figure, CSV."""

import numpy as np

from courtside.evaluation import round_trip
from courtside.figures.badminton import fig11
from courtside.figures.style import stick_figure, style
from courtside.pose import privacy
from courtside.reconstruction import camera_shake
from courtside.records.cameras import footage, shake_table
from courtside.records.keypoints import derived_joints, keypoints, skeleton
from courtside.study.execution.script import run
from courtside.video import reader


def main(paths, pdf, png, csv, *, limit_torso, n_frames, start_s, blur_faces):
    joints, points = skeleton.read(paths.skeleton), keypoints.read_3d(paths.pose3d)
    seen = footage.read(
        paths.cameras,
        paths.pose2d,
        paths.people,
        paths.sync,
        paths.videos,
        wanted=points.cameras,
    )
    seen = camera_shake.put_back(seen, shake_table.read_all(paths.shake))
    limbs, figure = (
        joints.groups["limbs"],
        stick_figure.stick(joints, derived_joints.read(paths.derived)),
    )
    frames = round_trip.span(points, n_frames, start_s).frames
    cameras = [one.camera for one in seen]
    limit = fig11.disagreements(points, cameras, limbs, limit_torso)
    frame = fig11.choose(limit[0], frames)
    rows = fig11.table(points, seen, limbs, joints.mirror(), frame, limit)
    images, detected, reprojected = {}, {}, {}
    for one in seen:
        at = one.frame_at(points.time_s[frame])
        both = one.view.xy[:, at], one.reprojected(points, at)
        _, image = reader.read_frame(one.video, one.view.time_s[at])
        if blur_faces:
            everyone = np.concatenate(both)
            image = privacy.hide(image, everyone, joints.bone_indices(), figure.faces_of(*both))
        name = one.camera.name
        images[name], detected[name], reprojected[name] = image, *map(figure.of, both)
    drawing = fig11.draw(rows, images, detected, reprojected, figure, limit_torso)
    style.save(drawing, rows, pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
