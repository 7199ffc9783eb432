"""Detect the people in one camera during one take: video -> 2D keypoints."""

import itertools

import cv2
import numpy as np

from courtside.pose import foreground, open_network, tracking, tracklets
from courtside.pose.clothing import Clothing
from courtside.pose.search import Search, middle
from courtside.records.keypoints import keypoints, skeleton
from courtside.study.execution import log
from courtside.study.execution.script import run
from courtside.video import images, reader


def main(
    paths, pose2d_npz, *, camera, model, person_detector, decoder, providers, trim_s, has_static,
    **options,
):  # fmt: skip
    cv2.setNumThreads(1)
    joints = skeleton.read(paths.skeleton).joints
    start_s, stop_s = trim_s or (None, None)
    info = reader.probe(paths.video, stop_s=stop_s)
    frames = reader.frames(paths.video, start_s=start_s, stop_s=stop_s)
    frames = log.progress(frames, info.n_frames if not trim_s else None, f"{camera}: frames")
    landmarks = open_network.landmark_network(
        paths.landmarks, joints, providers=providers, **decoder
    )
    detector = landmarks  # of one stage
    if person_detector:
        detector = open_network.person_detector(
            paths.detector, providers=providers, **person_detector
        )
    options["clothing"] = Clothing(joints)
    track, shown = follow(frames, (detector, landmarks), paths.background, **options)
    track, doubt = tracking.limited(track, model, decoder.get("full_score", 1))
    if doubt:
        log.tell(f"{camera}: {doubt}", "config/README.md, Your own network")
    if shown:
        report(f"{camera}: {paths.background}", shown, has_static)
    found = keypoints.Keypoints2D(
        camera=camera,
        model=model,
        joints=np.array(joints),
        size=np.array(info.size),
        time_s=track.time_s,
        xy=track.xy,
        score=track.score,
        reason=track.reason,
        xyz_in_body=track.xyz_in_body,
        clothing=track.clothing,
    )
    keypoints.write_2d(pose2d_npz, found)


def follow(
    frames, networks, background, *, n_wanted, extra_people, min_difference, clothing, **how
):
    """Return the `Track`, and the poses of people whom the background itself shows."""
    if not background:
        return tracking.track_person(frames, *networks, **how), []
    empty = images.read(background)
    changed = foreground.Foreground(empty, min_difference)
    time_s, first = next(frames)
    frames, max_people = itertools.chain([(time_s, first)], frames), n_wanted + extra_people
    track = tracklets.track_people(
        frames, *networks, changed, max_people=max_people, clothing=clothing, **how
    )
    search = Search(*networks, changed, how["min_presence"])
    return track, search.behind(empty, first, track.xy[:, 0])


def report(picture, shown, has_static):
    places = ", ".join(f"({x:.0f}, {y:.0f})" for x, y in map(middle, shown))
    found = f"{picture} shows people, around {places} px, who are found all the same"
    if not has_static:
        log.logger.info("%s: they hardly move, and the picture is made of the take", found)
        return
    log.logger.warning(
        "%s; film the `static` of the camera without people: clicks and bridging images use it",
        found,
    )


if __name__ == "__main__":
    run(main, snakemake)
