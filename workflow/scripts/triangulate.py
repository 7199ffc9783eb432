"""Triangulate one take: 2D keypoints of every camera -> 3D keypoints in the world."""

import numpy as np

from courtside.calibration.records import covariance
from courtside.geometry import camera as cameras
from courtside.reconstruction import fusion as camera_error
from courtside.reconstruction import resampling
from courtside.records.devices import clocks as sync
from courtside.records.keypoints import keypoints, people, skeleton
from courtside.study.errors import InputError
from courtside.study.execution import log
from courtside.study.execution.script import run


def main(paths, pose3d_npz, *, persons, fusion, **options):
    known = {camera.name: camera for camera in cameras.read_toml(paths.cameras)}
    used, rule = fusion["used"], fusion["rule"]
    views, joints = {}, skeleton.read(paths.skeleton)
    _, clocks = sync.read(paths.sync)
    if fault := sync.fault_line(paths.sync, clocks):
        raise InputError(fault)
    who = people.read(paths.people)
    for path in paths.pose2d:
        view = keypoints.read_2d(path)
        cameras.check_size(known[view.camera], tuple(map(int, view.size)), path)
        views[view.camera] = who.assigned(view)
    time_s = resampling.common_times(list(views.values()), [clocks[name] for name in views])

    shared = covariance.read(paths.covariance) if paths.covariance else None

    def fuse(names, rule):
        own = [known[name] for name in names], [views[name] for name in names]
        clock = [clocks[name] for name in names]
        found = camera_error.triangulate_take(
            *own, joints, persons, clocks=clock, time_s=time_s, rule=rule, **options
        )
        report(found)
        if shared:
            found = camera_error.with_cameras(found, own[0], shared.of(names).of_columns())
        return found

    halves = [fuse((used[0], side), "dlt") for side in used[1:]] if rule == "halfbody" else []
    keypoints.write_3d(
        pose3d_npz, camera_error.merge(*halves, used) if halves else fuse(used, rule)
    )


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
