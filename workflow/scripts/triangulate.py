"""Triangulate one take: 2D keypoints of every camera -> 3D keypoints in the world."""

from dataclasses import replace

import numpy as np

from courtside.calibration.records import covariance
from courtside.reconstruction import error_signs, joint_correction, joint_errors, resampling
from courtside.reconstruction import fusion as fusing
from courtside.records import npz
from courtside.records.cameras import footage
from courtside.records.keypoints import keypoints, skeleton
from courtside.study.execution import log
from courtside.study.execution.script import run


def main(paths, pose3d_npz, *, sex_of, fusion, recorded, **options):
    used, rule, joints = fusion["used"], fusion["rule"], skeleton.read(paths.skeleton)
    seen = footage.read(paths.cameras, paths.pose2d, paths.people, paths.sync, sure_clocks=True)
    seen = {one.camera.name: (one.camera, in_picture(one.view), one.clock) for one in seen}
    all_cameras, all_views, all_clocks = zip(*seen.values(), strict=True)
    time_s = resampling.common_times(all_views, all_clocks)
    shared = covariance.read(paths.covariance) if paths.covariance else None

    def fuse(names, rule):
        cameras, views, clocks = zip(*(seen[name] for name in names), strict=True)
        found = fusing.triangulate_take(
            cameras, views, joints, list(sex_of), clocks=clocks, time_s=time_s, rule=rule, **options
        )
        if rule == "robust" and paths.errors:
            xy, score = error_signs.keypoints_used(views, clocks, found, joints)
            signs = error_signs.of_points(cameras, found, xy, score, joints)
            del xy, score  # an hour of them is a gigabyte
            model = joint_errors.read(paths.errors)
            found = joint_errors.state(found, model, signs, recorded=recorded)
            del signs
        report(found)
        if shared:
            found = fusing.with_cameras(found, cameras, shared.of(names).of_columns())
        return found

    halves = [fuse((used[0], side), "dlt") for side in used[1:]] if rule == "halfbody" else []
    points = fusing.merge(*halves, used) if halves else fuse(used, rule)
    if paths.offsets:
        table = joint_correction.read(paths.offsets)
        offset = joint_correction.offsets(points, table, sex_of, all_cameras)
        points = replace(points, offset=offset)
    keypoints.write_3d(pose3d_npz, points)


def in_picture(view):
    """Return keypoints without the network's own metric guess, for the memory of long takes."""
    return replace(view, xyz_in_body=npz.unknown(view.xyz_in_body.shape))


def report(points):
    log.logger.info("missing points: %.1f %%", 100 * np.isnan(points.xyz[..., 0]).mean())
    for at, camera in enumerate(points.cameras):
        error_px, accepted = points.reproj_error_px[..., at], points.accepted[..., at].mean()
        swaps = points.swapped[..., at].any(axis=(0, 2)).sum()
        values = camera, np.nanmedian(error_px), 100 * accepted, swaps
        log.logger.info(
            "%s: reprojected to %.1f px, accepted %.0f %%, sides exchanged %d times", *values
        )


if __name__ == "__main__":
    run(main, snakemake)
