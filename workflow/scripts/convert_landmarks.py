"""Convert the network's own metric body in one camera: 2D keypoints -> one more source's motion."""

from courtside.depth import single_view
from courtside.records.cameras import frame_times
from courtside.records.devices import device_motion
from courtside.records.keypoints import keypoints
from courtside.study.execution import log
from courtside.study.execution.script import run


def main(pose2d_npz, device_npz, frames_csv=None, *, source):
    view = keypoints.read_2d(pose2d_npz)
    if frames_csv:
        view = frame_times.on_device_clock(view, frames_csv)
    person = single_view.main_person(view)
    doubts = single_view.doubt(source, person), single_view.doubt_of_one(source, view)
    for doubt in filter(None, doubts):
        log.tell(doubt, device_npz)
    device_motion.write(device_npz, single_view.landmarks(source, person))


if __name__ == "__main__":
    run(main, snakemake)
