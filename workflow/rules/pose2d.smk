"""2D keypoints of each camera, by a network or of another program; 3D keypoints of another program.

Inputs: a take's videos, networks, backgrounds, JSON folders, TRC files, imported cameras. Outputs:
results/{session}/takes/{take}/pose2d/.
Steps: detect_pose, import_pose2d, import_pose3d.
"""


rule detect_pose:
    input:
        video=of_job(recordings.video),
        background=of_job(recordings.background),
        detector=of_job(recordings.network_file, "detector"),
        landmarks=of_job(recordings.network_file, "landmarks"),
        skeleton=of_job(Job.skeleton_file),
    output:
        pose2d_npz=paths.POSE2D,
    log:
        "results/{session}/logs/detect_pose/{take}.{model}.{camera}.log",
    benchmark:
        "results/{session}/benchmarks/detect_pose/{take}.{model}.{camera}.tsv"
    wildcard_constraints:
        model=models_of(imported=False),
    params:
        code=code("detect_pose.py"),
        step=step("detect_pose"),
        redetect=lambda w: not STUDY.models[w.model].tracking,
        person_detector=of_job(recordings.decoder, "detector"),
        decoder=of_job(recordings.decoder, "landmarks"),
        trim_s=of_job(recordings.trim_s),
        n_wanted=of_job(recordings.n_wanted),
        has_static=of_job(recordings.has_static),
    script:
        "../scripts/detect_pose.py"


rule import_pose2d:
    input:
        folder=lambda w: whole(take_of(w).pose2d[w.model][w.camera]),
        files=of_job(recordings.keypoint_files),
        video=lambda w: take_of(w).videos.get(w.camera, []),
        cameras=of_job(recordings.cameras_for_size),
        skeleton=of_job(Job.skeleton_file),
    output:
        pose2d_npz=paths.POSE2D,
    log:
        "results/{session}/logs/import_pose2d/{take}.{model}.{camera}.log",
    wildcard_constraints:
        model=models_of(imported=True),
    params:
        code=code("import_pose2d.py"),
        pin=of_job(recordings.keypoint_listing),
        trim_s=lambda w: take_of(w).trim_s,
        folders=lambda w: take_of(w).pose2d[w.model],
        rate_hz=lambda w: take_of(w).rate_hz,
    script:
        "../scripts/import_pose2d.py"


rule import_pose3d:
    input:
        trc_files=lambda w: list(take_of(w).pose3d[w.model].values()),
        skeleton_yaml=of_job(Job.skeleton_file),
    output:
        pose3d_npz=paths.POSE3D_IMPORTED,
    log:
        "results/{session}/logs/import_pose3d/{take}.{model}.log",
    params:
        code=code("import_pose3d.py"),
        persons=lambda w: list(take_of(w).pose3d[w.model]),
    script:
        "../scripts/import_pose3d.py"
