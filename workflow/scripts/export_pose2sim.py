"""Export one take as a Pose2Sim project: cameras, 2D, people, clocks, 3D -> folder."""

from courtside.exports import pose2sim
from courtside.geometry import camera as cameras
from courtside.reconstruction import resampling
from courtside.records.devices import clocks as sync
from courtside.records.keypoints import keypoints, people, skeleton
from courtside.study.execution.script import run


def main(paths, folder):
    points = keypoints.read_3d(paths.pose3d)
    who, (_, clocks) = people.read(paths.people), sync.read(paths.sync)
    views = {}
    for path in paths.pose2d:
        view = who.assigned(keypoints.read_2d(path))
        views[view.camera] = resampling.resample(view, points.time_s, clocks[view.camera])
    used = [camera for camera in cameras.read_toml(paths.cameras) if camera.name in views]
    pose2sim.write_project(folder, used, views, points, skeleton=skeleton.read(paths.skeleton).name)


if __name__ == "__main__":
    run(main, snakemake)
