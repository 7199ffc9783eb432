"""Draw detections and reprojected skeletons on pictures: 2D, 3D, videos -> figure, CSV."""

from courtside.devices import video
from courtside.figures import overlay, style
from courtside.geometry import cameras
from courtside.records import keypoints, skeleton
from courtside.study import log


def main(paths, pdf, png, csv, *, n_frames, blur_faces):
    joints = skeleton.read(paths.skeleton)
    points = keypoints.read_3d(paths.pose3d)
    views = [keypoints.read_2d(path) for path in paths.pose2d]
    known = {camera.name: camera for camera in cameras.read_toml(paths.cameras)}
    used = [known[view.camera] for view in views]
    times_s = overlay.chosen_times(points, n_frames)
    panels = [
        [
            overlay.panel(
                video.read_frame(path, view.time_s[overlay.nearest(view, time_s)])[1],
                view.xy[:, overlay.nearest(view, time_s)],
                overlay.reproject(camera, points, time_s),
                points.accepted[:, abs(points.time_s - time_s).argmin(), :, at],
                joints,
                blur_faces,
            )
            for at, (path, view, camera) in enumerate(zip(paths.videos, views, used, strict=True))
        ]
        for time_s in times_s
    ]
    drawing = overlay.draw(panels, times_s, [camera.name for camera in used])
    style.save(drawing, overlay.table(used, views, points, times_s), pdf, png, csv)


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(
        snakemake.input,
        snakemake.output.pdf,
        snakemake.output.png,
        snakemake.output.csv,
        blur_faces=snakemake.params.blur_faces,
        **snakemake.params.step,
    )
