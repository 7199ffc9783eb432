"""Draw the metric skeletons in the hall: 3D keypoints, cameras -> figure, CSV."""

from courtside.figures.style import style
from courtside.figures.take import skeletons
from courtside.geometry import camera
from courtside.records.keypoints import keypoints, skeleton
from courtside.study.execution.script import run


def main(pose3d_npz, cameras_toml, skeleton_yaml, pdf, png, csv):
    points = keypoints.read_3d(pose3d_npz)
    found = [c for c in camera.read_toml(cameras_toml) if c.name in points.cameras]
    drawing = skeletons.draw(points, found, skeleton.read(skeleton_yaml))
    style.save(drawing, skeletons.table(points), pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
