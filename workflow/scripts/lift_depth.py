"""Lift the 2D joints of a depth camera's colour: recording, 2D keypoints -> the device's motion."""

from courtside.depth import lifting, single_view, surfaces
from courtside.devices import open_depth
from courtside.records.cameras import frame_times
from courtside.records.devices import device_motion
from courtside.records.keypoints import keypoints, skeleton
from courtside.study.execution import log
from courtside.study.execution.script import run


def main(paths, device_npz, *, device, source, baseline_m, skin_m=None, beyond_m=None, **sampling):
    recording = open_depth.read(paths.recording, device)
    view = frame_times.on_device_clock(keypoints.read_2d(paths.pose2d), paths.frames)
    person = single_view.main_person(view)
    motion, sigma_m = lifting.lift_take(
        source,
        person,
        log.progress(recording.depth_frames(), None, f"{device}: depth pictures"),
        recording,
        bones=skeleton.read(paths.skeleton).bones,
        baseline_m=open_depth.baseline(recording, baseline_m),
        skin_m=skin_m,
        beyond_m=beyond_m,
        sampling=surfaces.Sampling(**sampling),
    )
    log.logger.info("%s", lifting.summary(motion, sigma_m))
    of_body = lifting.doubt(motion), lifting.size_doubt(motion)
    of_person = single_view.doubt(source, person), single_view.doubt_of_one(source, view)
    for doubt in filter(None, (*of_person, *of_body)):
        log.tell(doubt, device_npz)
    device_motion.write(device_npz, motion)


if __name__ == "__main__":
    run(main, snakemake)
