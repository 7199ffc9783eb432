"""Draw skeletons with trajectories beside the detections.

Reads 2D keypoints, 3D keypoints and videos; writes figure and CSV.
"""

from courtside.calibration.court import court as court_files
from courtside.evaluation import round_trip
from courtside.figures.badminton import fig10
from courtside.figures.style import picture_crops, stick_figure, style
from courtside.reconstruction import camera_shake
from courtside.records.keypoints import derived_joints, keypoints, skeleton
from courtside.study.execution.script import run


def main(paths, pdf, png, csv, *, n_instants, n_frames, start_s, blur_faces, session, take):
    joints, points = skeleton.read(paths.skeleton), keypoints.read_3d(paths.pose3d)
    files = paths.cameras, paths.pose2d, paths.people, paths.sync, paths.shake, paths.videos
    seen = camera_shake.read_as_filmed(*files, wanted=points.cameras)
    figure = stick_figure.stick(joints, derived_joints.read(paths.derived))
    stated = f"draw_stroke.takes.{session}/{take}"
    frames = round_trip.span(points, n_frames, start_s, stated).frames
    shown = fig10.instants(frames, n_instants)

    def picture(one, frame):
        image, detected, _ = picture_crops.at_frame(one, points, frame, joints, hidden=blur_faces)
        return image, figure.of(detected)

    pictures = [{one.camera.name: picture(one, frame) for one in seen} for frame in shown]
    court = court_files.read(paths.court) if paths.get("court") else None
    drawing = fig10.draw(points, figure, frames, shown, pictures, court)
    style.save(drawing, fig10.table(points, figure, frames, shown), pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
