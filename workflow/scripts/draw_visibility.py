"""Draw scores and views over time: 2D, people, clocks, 3D -> figure, CSV."""

from courtside.figures.style import style
from courtside.figures.take import visibility
from courtside.reconstruction import resampling
from courtside.records.devices import clocks as sync
from courtside.records.keypoints import keypoints, people, skeleton
from courtside.study.execution.script import run


def main(paths, pdf, png, csv):
    points, who = keypoints.read_3d(paths.pose3d), people.read(paths.people)
    _, clocks = sync.read(paths.sync)
    views = [who.assigned(keypoints.read_2d(path)) for path in paths.pose2d]
    views = [resampling.nearest(view, points.time_s, clocks[view.camera])[0] for view in views]
    rows = visibility.table(points, views)
    style.save(visibility.draw(rows, skeleton.read(paths.skeleton)), rows, pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
