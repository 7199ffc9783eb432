"""Export calibrated cameras for other programs: cameras -> folders of EasyMocap and COLMAP."""

from courtside.exports import camera_files
from courtside.geometry import camera
from courtside.study.execution.script import run


def main(cameras_toml, folder):
    camera_files.write(folder, camera.read_toml(cameras_toml))


if __name__ == "__main__":
    run(main, snakemake)
