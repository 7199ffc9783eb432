"""Take a camera's shake out of its keypoints: 2D, cameras, shake -> steadied 2D keypoints."""

from courtside.geometry import camera as cameras
from courtside.reconstruction import camera_shake
from courtside.records.cameras import shake_table
from courtside.records.keypoints import keypoints
from courtside.study.execution.script import run


def main(pose2d_npz, cameras_toml, shake_csv, steadied_npz, *, camera):
    known = {one.name: one for one in cameras.read_toml(cameras_toml)}
    view, table = keypoints.read_2d(pose2d_npz), shake_table.read(shake_csv)
    keypoints.write_2d(steadied_npz, camera_shake.steady(view, known[camera], table))


if __name__ == "__main__":
    run(main, snakemake)
