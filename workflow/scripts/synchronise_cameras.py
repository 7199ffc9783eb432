"""Find one take's camera clocks: 2D keypoints of every camera -> offset and drift of each."""

from courtside.geometry import camera as cameras
from courtside.records.devices import clocks as sync
from courtside.records.keypoints import keypoints
from courtside.study.execution import log
from courtside.study.execution.script import run
from courtside.synchronisation import cameras as camera_sync


def main(cameras_toml, pose2d_npz, sync_json, *, synchronised, stated, trim_s, **options):
    views = [keypoints.read_2d(path) for path in pose2d_npz]
    known = None
    if cameras_toml:
        known = {camera.name: camera for camera in cameras.read_toml(cameras_toml)}
        for view, path in zip(views, pose2d_npz, strict=True):
            cameras.check_size(known[view.camera], tuple(map(int, view.size)), path)
    clocks = camera_sync.of_take(views, known, synchronised=synchronised, stated=stated, **options)
    report(clocks)
    for camera, clock in clocks.items():
        if clock.doubt:
            log.tell(f"{camera}: {clock.doubt}", sync_json)
    used = {view.camera: view.time_s[[0, -1]] for view in views}
    usable = all(clock.usable for clock in clocks.values())
    if trim_s and usable and (line := sync.little_shared(used, clocks)):
        log.tell(line, sync_json)
    sync.write(sync_json, views[0].camera, clocks)


def report(clocks):
    for camera, clock in clocks.items():
        log.logger.info(
            "%s: %s, offset %.1f ms, drift %.0f ppm, uncertain by %.1f ms = %.0f mm of a %.0f m/s "
            "wrist; %s",
            camera,
            clock.status,
            1e3 * clock.offset_s,
            clock.drift_ppm,
            1e3 * clock.uncertainty_s,
            1e3 * clock.uncertainty_s * sync.WRIST_M_S,
            sync.WRIST_M_S,
            clock.note,
        )


if __name__ == "__main__":
    run(main, snakemake)
