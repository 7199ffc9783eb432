"""Draw the chain from pictures to measures: 2D, 3D keypoints, videos, measures -> figure, CSV."""

from courtside.calibration.court import court as court_files
from courtside.evaluation import round_trip
from courtside.figures.badminton import fig09
from courtside.figures.style import picture_crops, stick_figure, style
from courtside.reconstruction import camera_shake
from courtside.records import tables
from courtside.records.keypoints import derived_joints, keypoints, skeleton
from courtside.study.execution.script import run


def main(paths, pdf, png, csv, *, n_frames, start_s, blur_faces, session, take):
    joints, points = skeleton.read(paths.skeleton), keypoints.read_3d(paths.pose3d)
    files = paths.cameras, paths.pose2d, paths.people, paths.sync, paths.shake, paths.videos
    seen = camera_shake.read_as_filmed(*files, wanted=points.cameras)
    figure = stick_figure.stick(joints, derived_joints.read(paths.derived))
    stated = f"draw_stroke.takes.{session}/{take}"
    frames = round_trip.span(points, n_frames, start_s, stated).frames
    frame = (frames.start + frames.stop - 1) // 2
    images = {
        one.camera.name: picture_crops.at_frame(one, points, frame, joints, hidden=blur_faces)[0]
        for one in seen
    }
    court = court_files.read(paths.court) if paths.get("court") else None
    rows, cameras = fig09.table(points, seen, frame, figure), [one.camera for one in seen]
    measured = tables.read(paths.measures, "a table of measures")
    drawing = fig09.draw(rows, images, points, cameras, figure, measured, court)
    style.save(drawing, rows, pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
