"""Draw scores and views over time: 2D, people, clocks, 3D -> figure, CSV."""

from courtside.figures.style import style
from courtside.figures.take import visibility
from courtside.records.cameras import footage
from courtside.records.keypoints import keypoints, skeleton
from courtside.study.execution.script import run


def main(paths, pdf, png, csv):
    points = keypoints.read_3d(paths.pose3d)
    seen = footage.read(paths.cameras, paths.pose2d, paths.people, paths.sync)
    scores = {one.camera.name: visibility.scores(one, points.time_s) for one in seen}
    rows = visibility.table(points, scores)
    style.save(visibility.draw(rows, skeleton.read(paths.skeleton)), rows, pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
