"""Draw where the network places joints in two layouts: errors per joint, videos -> figure, CSV."""

import pandas as pd

from courtside.figures.badminton import fig05
from courtside.figures.style import picture_crops, style
from courtside.pose import privacy
from courtside.records import tables
from courtside.records.keypoints import keypoints, skeleton
from courtside.study.execution.script import run


def main(paths, pdf, png, csv, *, layouts, sources, blur_faces):
    joints = skeleton.read(paths.skeleton)
    rows = pd.concat([tables.read(path, "a table of errors") for path in paths.errors])
    files = {
        tuple(source): pair
        for source, *pair in zip(sources, paths.pose2d, paths.videos, strict=True)
    }
    chosen, images = fig05.examples(rows, layouts), []
    for example in chosen:
        pose2d, film = files[example["session"], example["take"], example["camera"]]
        view, at = keypoints.read_2d(pose2d), example["frame_idx"]
        persons = [fig05.person_of(example, view)]
        near = privacy.around(view.time_s, view.xy, at)
        image = picture_crops.read(
            film, view.time_s[at], persons, joints, others=near, hidden=blur_faces
        )
        images.append(image)
    shares = fig05.table(rows, layouts)
    drawing = fig05.draw(shares, layouts, chosen, images, joints.bones)
    style.save(drawing, shares, pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
