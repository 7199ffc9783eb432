"""Takes of virtual sessions against their truth.

Only this file and evaluation_calibration.smk read truth.

Inputs: 2D and 3D keypoints, clocks, truth of takes.
Outputs: results/{session}/evaluation/takes/, results/{session}/takes/{take}/table1/.
Steps: evaluate_take, evaluate_clocks, evaluate_kinematics, evaluate_sources, evaluate_body_frames,
evaluate_detection, evaluate_round_trip (table 1), evaluate_fusions (paired differences with
intervals); of development sessions, asked for by name: evaluate_joint_offsets,
evaluate_skin_depths.
"""


rule evaluate_take:
    input:
        pose3d=of_job(evaluation.skeletons),
        truth=paths.TRUE_TAKE,
    output:
        errors=paths.ERRORS,
    log:
        "results/{session}/logs/evaluate_take/{take}.{calibration}.{model}.log",
    params:
        code=code("evaluate_take.py"),
        labels=of_job(evaluation.skeleton_labels),
    script:
        "../scripts/evaluate_take.py"


rule evaluate_clocks:
    input:
        sync=paths.CAMERA_CLOCKS,
        truth=paths.TRUE_TAKE,
    output:
        errors=paths.CLOCK_ERRORS,
    log:
        "results/{session}/logs/evaluate_clocks/{take}.{calibration}.{model}.log",
    params:
        code=code("evaluate_clocks.py"),
        labels=lambda w: dict(w.items()),
    script:
        "../scripts/evaluate_clocks.py"


rule evaluate_kinematics:
    input:
        frames=paths.FRAME_MEASURES,
        summary=paths.MEASURES,
        derived=paths.derived_joints(CONFIG),
        truth=paths.TRUE_TAKE,
    output:
        errors=paths.MEASURE_ERRORS,
    log:
        "results/{session}/logs/evaluate_kinematics/{take}.{calibration}.{fusion}.{model}.log",
    params:
        code=code("evaluate_kinematics.py"),
        labels=lambda w: dict(w.items()),
        sex_of=of_job(takes.sexes),
    script:
        "../scripts/evaluate_kinematics.py"


rule evaluate_sources:
    input:
        bodies=of_job(devices.bodies),
        truth=paths.TRUE_TAKE,
        derived=paths.derived_joints(CONFIG),
    output:
        errors=paths.SOURCE_ERRORS,
        parts=paths.ERROR_PARTS,
        paths=paths.TRUE_PATHS,
        distortion=paths.TRUE_DISTORTION,
    log:
        "results/{session}/logs/evaluate_sources/{take}.{model}.log",
    params:
        code=code("evaluate_sources.py"),
        labels=lambda w: dict(w.items()),
        person=of_job(devices.person),
        step=step("measure_arcs"),
    script:
        "../scripts/evaluate_sources.py"


rule evaluate_body_frames:
    input:
        bodies=of_job(devices.bodies, corrected=False),
        frames=of_job(devices.bodies, paths.BODY_FRAME, corrected=False),
        truth=paths.TRUE_TAKE,
        derived=paths.derived_joints(CONFIG),
    output:
        errors=paths.BODY_FRAME_ERRORS,
    log:
        "results/{session}/logs/evaluate_body_frames/{take}.{model}.log",
    params:
        code=code("evaluate_body_frames.py"),
        labels=lambda w: dict(w.items()),
        person=of_job(devices.person),
        owners=of_job(devices.clocks, corrected=False),
    script:
        "../scripts/evaluate_body_frames.py"


rule evaluate_joint_offsets:
    input:
        pose3d=of_job(
            takes.every_take, paths.POSE3D_FILTERED, calibration="known18", fusion="all-robust"
        ),
        truth=of_job(evaluation.true_takes),
    output:
        offsets=paths.JOINT_OFFSETS,
    log:
        "results/{session}/logs/evaluate_joint_offsets/{model}.log",
    params:
        code=code("evaluate_joint_offsets.py"),
        sex_of=of_job(takes.sexes),
        about=lambda w, output: evaluation.estimated_by(w.session, output.offsets),
    script:
        "../scripts/evaluate_joint_offsets.py"


rule evaluate_skin_depths:
    input:
        lifted=of_job(takes.every_take, paths.DEPTH_SOURCE),
        truth=of_job(evaluation.true_takes),
    output:
        depths=paths.SKIN_DEPTHS,
    log:
        "results/{session}/logs/evaluate_skin_depths/{device}.{model}.log",
    params:
        code=code("evaluate_skin_depths.py"),
        about=lambda w, output: evaluation.estimated_by(w.session, output.depths),
        step=step("lift_depth"),
    script:
        "../scripts/evaluate_skin_depths.py"


rule evaluate_detection:
    input:
        pose2d=of_job(takes.each_camera, paths.POSE2D),
        take_truth=paths.TRUE_TAKE,
        truth=paths.TRUTH,
        skeleton=of_job(Job.skeleton_file),
    output:
        errors=paths.DETECTION_ERRORS,
    log:
        "results/{session}/logs/evaluate_detection/{take}.{model}.log",
    params:
        code=code("evaluate_detection.py"),
        labels=lambda w: dict(w.items()),
    script:
        "../scripts/evaluate_detection.py"


rule evaluate_round_trip:
    input:
        pose3d=of_job(evaluation.round_trip_skeletons),
        cameras=paths.CAMERAS,
        pose2d=of_job(takes.each_camera, paths.POSE2D),
        sync=paths.CAMERA_CLOCKS,
        skeleton=of_job(Job.skeleton_file),
        derived=paths.derived_joints(CONFIG),
        truth=of_job(evaluation.true_take),
    output:
        rows=paths.ROUND_TRIP,
    log:
        "results/{session}/logs/evaluate_round_trip/{take}.{calibration}.{model}.log",
    params:
        code=code("evaluate_round_trip.py"),
        step=of_job(evaluation.round_trip),
    script:
        "../scripts/evaluate_round_trip.py"


rule evaluate_fusions:
    input:
        pose3d=of_job(takes.every_fused, paths.SKELETONS),
        truth=paths.TRUE_TAKE,
    output:
        gains=paths.GAINS,
    log:
        "results/{session}/logs/evaluate_fusions/{take}.{stage}.{calibration}.{model}.log",
    params:
        code=code("evaluate_fusions.py"),
        fusions=of_job(takes.every_fusion),
        pairs=of_job(evaluation.pairs),
        labels=of_job(evaluation.chosen, ("session", "take", "stage", "calibration", "model")),
    script:
        "../scripts/evaluate_fusions.py"
