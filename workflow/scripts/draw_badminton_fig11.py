"""Draw one frame's detections and reprojected skeleton: 2D, 3D keypoints, videos -> figure, CSV."""

from courtside.evaluation import round_trip
from courtside.figures.badminton import fig11
from courtside.figures.style import picture_crops, stick_figure, style
from courtside.reconstruction import camera_shake
from courtside.records.keypoints import derived_joints, keypoints, skeleton
from courtside.study.execution.script import run


def main(paths, pdf, png, csv, *, limit_torso, n_frames, start_s, blur_faces, session, take):
    joints, points = skeleton.read(paths.skeleton), keypoints.read_3d(paths.pose3d)
    files = paths.cameras, paths.pose2d, paths.people, paths.sync, paths.shake, paths.videos
    seen = camera_shake.read_as_filmed(*files, wanted=points.cameras)
    limbs = joints.groups["limbs"]
    figure = stick_figure.stick(joints, derived_joints.read(paths.derived))
    stated = f"draw_stroke.takes.{session}/{take}"
    frames = round_trip.span(points, n_frames, start_s, stated).frames
    cameras = [one.camera for one in seen]
    limit = fig11.disagreements(points, cameras, limbs, limit_torso)
    frame = fig11.choose(limit[0], frames)
    rows = fig11.table(points, seen, limbs, joints.mirror(), frame, limit)
    images, detected, reprojected = {}, {}, {}
    for one in seen:
        name = one.camera.name
        images[name], *both = picture_crops.at_frame(one, points, frame, joints, hidden=blur_faces)
        detected[name], reprojected[name] = map(figure.of, both)
    drawing = fig11.draw(rows, images, detected, reprojected, figure, limit_torso)
    style.save(drawing, rows, pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
