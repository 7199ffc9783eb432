"""Extract a depth camera's colour: recording -> video, its frames' times, colour camera."""

from courtside.devices import open_depth
from courtside.geometry import camera
from courtside.records.cameras import frame_times
from courtside.study.execution import log
from courtside.study.execution.script import run
from courtside.video import writer


def main(recording, video, frames_csv, camera_toml, *, device, crf):
    found = open_depth.read(recording, device)
    for remark in found.remarks:
        log.logger.warning("%s: %s", device, remark)
    table = open_depth.colour_times(recording, found)
    pictures = log.progress(found.colour_frames(), len(table.time_s), f"{device}: frames")
    images = (image for _, image in pictures)
    writer.write_video(video, images, table.rate_hz, crf=crf, effort="veryfast")
    frame_times.write(frames_csv, table)
    camera.write_toml(camera_toml, [found.colour], source=f"recorded by {device}")


if __name__ == "__main__":
    run(main, snakemake)
