"""Associate the tracklets of all cameras of a take: 2D keypoints, cameras, clocks -> people."""

from dataclasses import replace

import numpy as np

from courtside.calibration.court import court
from courtside.reconstruction import resampling
from courtside.reconstruction.association import associate, identity, lengths, scale
from courtside.records.cameras import footage
from courtside.records.keypoints import people, skeleton
from courtside.study.execution import log
from courtside.study.execution.script import run


def main(paths, people_npz, *, several):
    seen = footage.read(paths.cameras, paths.pose2d, None, paths.sync, sure_clocks=several)
    views, clocks = [one.tracklets for one in seen], [one.clock for one in seen]
    joints = skeleton.read(paths.skeleton)
    names = joints.groups["limbs"]
    chosen = [joints.index(name) for name in names]
    limbs = [replace(v, xy=v.xy[:, :, chosen], score=v.score[:, :, chosen]) for v in views]
    time_s = resampling.common_times(views, clocks)
    xy = [resampling.resample(v, time_s, c)[0] for v, c in zip(limbs, clocks, strict=True)]
    trunk = [at for at, name in enumerate(names) if name.endswith(("hip", "shoulder"))]
    scale.check([one.camera for one in seen], xy, names)
    found = associate.associate(
        [one.camera for one in seen],
        xy,
        time_s,
        trunk=trunk,
        mirror=[chosen.index(joints.mirror()[joint]) for joint in chosen],
        court=court.read(paths.court) if paths.get("court") else None,
        bones=lengths.bones(names),
        clothing=[
            resampling.nearest(v, time_s, c)[0].clothing for v, c in zip(views, clocks, strict=True)
        ],
    )
    frames_s = [c.to_reference(v.time_s) for c, v in zip(clocks, views, strict=True)]
    index = {
        view.camera: associate.on_frames(rows, time_s, frame_s)
        for view, rows, frame_s in zip(views, found.index, frames_s, strict=True)
    }
    log.logger.info("%s", found.line())
    ids = np.array([f"person-{at + 1}" for at in range(len(found.placed))])
    sure = identity.confidence(found.doubts, len(ids))
    kept = {key: getattr(found, key) for key in ("placed", "time_s", "path", "doubts")}
    made = people.People(views[0].model, ids, index=index, confidence=sure, **kept)
    people.write(people_npz, made)


if __name__ == "__main__":
    run(main, snakemake)
