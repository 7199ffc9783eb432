"""Burn detections, 3D skeleton and time into a camera's video.

Reads video, 2D keypoints, people, clocks and 3D keypoints; writes MP4.
"""

from courtside.exports import overlay_video
from courtside.figures.style import style
from courtside.reconstruction import camera_shake
from courtside.records.keypoints import keypoints, skeleton
from courtside.study.execution import log
from courtside.study.execution.script import run
from courtside.video import reader, writer

COLOURS = style.DETECTED_BGR, style.REPROJECTED_BGR, style.REJECTED_BGR


def main(paths, mp4, *, camera, blur_faces, trim_s, crf, effort, keep_background):
    (one,) = camera_shake.read_as_filmed(
        paths.cameras, [paths.pose2d], paths.people, paths.sync, paths.shake
    )
    points, joints = keypoints.read_3d(paths.pose3d), skeleton.read(paths.skeleton)
    track = overlay_video.track(one, points, joints)
    start_s, stop_s = trim_s or (None, None)
    info, times_s = reader.probe(paths.video, stop_s=stop_s), None
    if info.variable_rate:
        times_s = reader.frame_times(paths.video, stop_s=stop_s)
        times_s = times_s[times_s >= (start_s or 0)]
    frames = reader.frames(paths.video, start_s=start_s, stop_s=stop_s)
    drawn = overlay_video.pictures(
        frames, track, colours=COLOURS, hide_faces=blur_faces, keep_background=keep_background
    )
    pictures = log.progress(drawn, len(track.own_s), f"{camera}: frames")
    writer.write_video(mp4, pictures, info.rate_hz, crf=crf, effort=effort, times_s=times_s)


if __name__ == "__main__":
    run(main, snakemake)
