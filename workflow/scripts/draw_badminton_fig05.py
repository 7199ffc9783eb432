"""Draw where the network places joints in two layouts: errors per joint, videos -> figure, CSV."""

import pandas as pd

from courtside.figures.badminton import fig05
from courtside.figures.style import style
from courtside.pose import privacy
from courtside.records.keypoints import keypoints, skeleton
from courtside.study.execution.script import run
from courtside.video import reader


def main(paths, pdf, png, csv, *, layouts, sources, blur_faces):
    joints = skeleton.read(paths.skeleton)
    rows = pd.concat([pd.read_csv(path, dtype={"person": str}) for path in paths.errors])
    files = {
        tuple(source): pair
        for source, *pair in zip(sources, paths.pose2d, paths.videos, strict=True)
    }
    chosen, images = fig05.examples(rows, layouts), []
    face = [joints.index(name) for name in joints.groups["face"]]
    for example in chosen:
        pose2d, film = files[example["session"], example["camera"]]
        view = keypoints.read_2d(pose2d)
        _, image = reader.read_frame(film, view.time_s[example["frame_idx"]])
        if blur_faces:
            persons = view.xy[:, example["frame_idx"]]
            image = privacy.hide(image, persons, joints.bone_indices(), persons[:, face])
        images.append(image)
    shares = fig05.table(rows, layouts)
    drawing = fig05.draw(shares, layouts, chosen, images, joints.bones)
    style.save(drawing, shares, pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
