"""Take shake and knocks out of a camera's keypoints: 2D, cameras, shake, knocks -> steadied 2D."""

from courtside.geometry import camera as cameras
from courtside.reconstruction import camera_shake
from courtside.records.cameras import knock_table, shake_table
from courtside.records.keypoints import keypoints
from courtside.study.execution.script import run


def main(
    pose2d_npz,
    cameras_toml,
    shake_csv,
    knocks_csv,
    steadied_npz,
    taken_out_csv,
    *,
    take,
    camera,
):
    known = {one.name: one for one in cameras.read_toml(cameras_toml)}
    view = keypoints.read_2d(pose2d_npz)
    table = shake_table.read(shake_csv) if shake_csv else camera_shake.still(view.time_s)
    knocks = knock_table.read(knocks_csv, take, camera) if knocks_csv else []
    table = camera_shake.knocked(known[camera], table, knocks)
    shake_table.write(taken_out_csv, table)
    keypoints.write_2d(steadied_npz, camera_shake.steady(view, known[camera], table))


if __name__ == "__main__":
    run(main, snakemake)
