"""Draw detections and reprojected skeletons on pictures of the videos.

Reads 2D keypoints, people, clocks, 3D keypoints and videos; writes figure and CSV.
"""

from courtside.figures.style import picture_crops, style
from courtside.figures.take import overlay
from courtside.reconstruction import camera_shake
from courtside.records.keypoints import keypoints, skeleton
from courtside.study.execution.script import run


def main(paths, pdf, png, csv, *, n_frames, blur_faces):
    joints, points = skeleton.read(paths.skeleton), keypoints.read_3d(paths.pose3d)
    files = paths.cameras, paths.pose2d, paths.people, paths.sync, paths.shake, paths.videos
    seen = camera_shake.read_as_filmed(*files, wanted=points.cameras)
    shown = overlay.frames(points, n_frames)

    def picture(one, frame):
        return picture_crops.at_frame(one, points, frame, joints, hidden=blur_faces)[0]

    images = [[picture(one, frame) for one in seen] for frame in shown]
    drawing = overlay.draw(points, seen, shown, images, joints)
    style.save(drawing, overlay.table(points, seen, shown, joints), pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
