"""Export one take as a Pose2Sim project: cameras, 2D, people, clocks, 3D -> folder."""

from courtside.exports import pose2sim
from courtside.geometry import camera as cameras
from courtside.reconstruction import resampling
from courtside.records.cameras import footage
from courtside.records.keypoints import keypoints, skeleton
from courtside.study.execution.script import run


def main(paths, folder):
    points = keypoints.read_3d(paths.pose3d)
    seen = footage.read(paths.cameras, paths.pose2d, paths.people, paths.sync)
    views = {
        one.camera.name: resampling.resample(one.view, points.time_s, one.clock) for one in seen
    }
    used = [camera for camera in cameras.read_toml(paths.cameras) if camera.name in views]
    pose2sim.write_project(folder, used, views, points, skeleton=skeleton.read(paths.skeleton).name)


if __name__ == "__main__":
    run(main, snakemake)
