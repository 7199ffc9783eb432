"""Triangulate one take: 2D keypoints of every camera -> 3D keypoints in the world."""

import numpy as np

from courtside.geometry import cameras
from courtside.motion import fusion
from courtside.records import keypoints, skeleton
from courtside.study import log


def main(cameras_toml, pose2d_npz, skeleton_yaml, pose3d_npz, *, persons, **options):
    views = [keypoints.read_2d(path) for path in pose2d_npz]
    known = {camera.name: camera for camera in cameras.read_toml(cameras_toml)}
    used = [known[view.camera] for view in views]
    for camera, view, path in zip(used, views, pose2d_npz, strict=True):
        cameras.check_size(camera, tuple(map(int, view.size)), path)
    points, swapped = fusion.triangulate_take(
        used, views, skeleton.read(skeleton_yaml), persons, **options
    )
    report(points, swapped)
    keypoints.write_3d(pose3d_npz, points)


def report(points, swapped):
    log.logger.info("missing points: %.1f %%", 100 * np.isnan(points.xyz[..., 0]).mean())
    for at, camera in enumerate(points.cameras):
        error_px = points.reproj_error_px[..., at]
        log.logger.info(
            "%s: median reprojection error %.1f px, accepted %.0f %%, left and right exchanged in %d frames",
            camera,
            np.nanmedian(error_px),
            100 * points.accepted[..., at].mean(),
            swapped[at].any(axis=(0, 2)).sum(),
        )


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(
        snakemake.input.cameras,
        snakemake.input.pose2d,
        snakemake.input.skeleton,
        snakemake.output.pose3d,
        persons=snakemake.params.persons,
        **snakemake.params.step,
    )
