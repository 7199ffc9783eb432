"""Comparison of takes of virtual sessions with the truth.

No method reads truth. The simulation does, and evaluations: this file, evaluation_calibration.smk
and evaluate_networks.

Inputs: 2D and 3D keypoints, clocks, truth of takes. Outputs: results/{session}/evaluation/takes/.
Steps: evaluate_take, evaluate_reliability, evaluate_clocks, evaluate_kinematics, evaluate_angles,
evaluate_contacts, evaluate_strokes, evaluate_sources, evaluate_source_angles, evaluate_body_frames,
evaluate_detection, evaluate_round_trip (table 1), evaluate_fusions (paired differences with
intervals); of development sessions, asked for by name: evaluate_joint_offsets,
evaluate_joint_errors, evaluate_skin_depths.
"""


rule evaluate_take:
    input:
        pose3d_npz=of_job(evaluation.skeletons),
        truth_npz=paths.TRUE_TAKE,
    output:
        errors_csv=paths.ERRORS,
    log:
        "results/{session}/logs/evaluate_take/{take}.{calibration}.{model}.log",
    params:
        code=code("evaluate_take.py"),
        labels=of_job(evaluation.skeleton_labels),
    script:
        "../scripts/evaluate_take.py"


rule evaluate_reliability:
    input:
        pose3d=of_job(evaluation.exported_skeletons),
        frames=of_job(evaluation.exported_measures, paths.FRAME_MEASURES),
        summary=of_job(evaluation.exported_measures, paths.MEASURES),
        derived=CONFIG / paths.DERIVED_JOINTS_YAML,
        truth=paths.TRUE_TAKE,
    output:
        counts_csv=paths.RELIABILITY,
    log:
        "results/{session}/logs/evaluate_reliability/{take}.{calibration}.{model}.log",
    params:
        code=code("evaluate_reliability.py"),
        labels=of_job(evaluation.exported_labels),
        sex_of=of_job(takes.sexes),
    script:
        "../scripts/evaluate_reliability.py"


rule evaluate_clocks:
    input:
        sync_json=paths.CAMERA_CLOCKS,
        truth_npz=paths.TRUE_TAKE,
    output:
        errors_csv=paths.CLOCK_ERRORS,
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
        derived=CONFIG / paths.DERIVED_JOINTS_YAML,
        truth=paths.TRUE_TAKE,
    output:
        errors_csv=paths.MEASURE_ERRORS,
    log:
        "results/{session}/logs/evaluate_kinematics/{take}.{calibration}.{fusion}.{model}.log",
    params:
        code=code("evaluate_kinematics.py"),
        labels=of_job(lambda job: {**job.wildcards, "stage": job.stages()[-1]}),
        sex_of=of_job(takes.sexes),
    script:
        "../scripts/evaluate_kinematics.py"


rule evaluate_contacts:
    input:
        skeletons=of_job(takes.measured),
        contacts=paths.CONTACTS,
        steps=paths.STEPS,
        truth=paths.TRUE_TAKE,
    output:
        errors_csv=paths.CONTACT_ERRORS,
    log:
        "results/{session}/logs/evaluate_contacts/{take}.{calibration}.{fusion}.{model}.log",
    params:
        code=code("evaluate_contacts.py"),
        labels=of_job(lambda job: {**job.wildcards, "stage": job.stages()[-1]}),
    script:
        "../scripts/evaluate_contacts.py"


rule evaluate_strokes:
    input:
        strokes_csv=paths.STROKES,
        reactions_csv=paths.REACTIONS,
        events_csv=paths.FOOT_EVENTS,
        pose3d_npz=of_job(takes.measured),
        truth_npz=paths.TRUE_TAKE,
    output:
        errors_csv=paths.STROKE_ERRORS,
        reaction_errors_csv=paths.REACTION_ERRORS,
    log:
        f"results/{{session}}/logs/evaluate_strokes/{paths.OF_FUSED}.log",
    params:
        code=code("evaluate_strokes.py"),
        labels=lambda w: dict(w.items()),
    script:
        "../scripts/evaluate_strokes.py"


rule evaluate_angles:
    input:
        pose3d_npz=of_job(evaluation.skeletons),
        truth_npz=paths.TRUE_TAKE,
    output:
        errors_csv=paths.ANGLE_ERRORS,
    log:
        "results/{session}/logs/evaluate_angles/{take}.{calibration}.{model}.log",
    params:
        code=code("evaluate_angles.py"),
        labels=of_job(evaluation.skeleton_labels),
    script:
        "../scripts/evaluate_angles.py"


rule evaluate_sources:
    input:
        body_npz=of_job(devices.bodies),
        truth_npz=paths.TRUE_TAKE,
        derived_yaml=CONFIG / paths.DERIVED_JOINTS_YAML,
    output:
        errors_csv=paths.SOURCE_ERRORS,
        parts_csv=paths.ERROR_PARTS,
        paths_csv=paths.TRUE_PATHS,
        distortion_csv=paths.TRUE_DISTORTION,
    log:
        "results/{session}/logs/evaluate_sources/{take}.{model}.log",
    params:
        code=code("evaluate_sources.py"),
        labels=lambda w: dict(w.items()),
        person=lambda w: take_of(w).person_of_devices,
        step=step("measure_arcs"),
    script:
        "../scripts/evaluate_sources.py"


rule evaluate_source_angles:
    input:
        device_npz=of_job(devices.compared_sources),
        fitted_npz=of_job(lambda job: list(devices.fitted(job).values())),
        sync_json=paths.DEVICE_CLOCKS,
        truth_npz=paths.TRUE_TAKE,
    output:
        errors_csv=paths.SOURCE_ANGLE_ERRORS,
    log:
        "results/{session}/logs/evaluate_source_angles/{take}.{model}.log",
    params:
        code=code("evaluate_source_angles.py"),
        labels=lambda w: dict(w.items()),
        step=of_job(devices.compared_angles),
    script:
        "../scripts/evaluate_source_angles.py"


rule evaluate_body_frames:
    input:
        body_npz=of_job(devices.bodies),
        frame_json=of_job(devices.bodies, paths.BODY_FRAME),
        truth_npz=paths.TRUE_TAKE,
        derived_yaml=CONFIG / paths.DERIVED_JOINTS_YAML,
    output:
        errors_csv=paths.BODY_FRAME_ERRORS,
    log:
        "results/{session}/logs/evaluate_body_frames/{take}.{model}.log",
    params:
        code=code("evaluate_body_frames.py"),
        labels=lambda w: dict(w.items()),
        person=lambda w: take_of(w).person_of_devices,
        owners=of_job(devices.clocks),
    script:
        "../scripts/evaluate_body_frames.py"


# Of every virtual take of the study. People were found with clicked cameras; what is fitted is
# fitted with the true ones.
FITTED = {
    "files": lambda w: paths.files_in(
        evaluation.fitted_takes(STUDY, w.model),
        *("cameras", "session_truth", "pose2d", "people", "sync", "truth"),
    ),
    "skeleton": of_job(Job.skeleton_file),
}


rule evaluate_joint_offsets:
    input:
        **FITTED,
    output:
        offsets_csv=paths.JOINT_OFFSETS,
    log:
        "results/networks/logs/evaluate_joint_offsets/{model}.log",
    params:
        code=code("evaluate_joint_offsets.py"),
        takes=lambda w: evaluation.fitted_takes(STUDY, w.model),
        about=lambda w, output: evaluation.estimated_by(STUDY.sessions, w.model, output.offsets_csv),
        step=STUDY.parameters["triangulate"],
    script:
        "../scripts/evaluate_joint_offsets.py"


rule evaluate_joint_errors:
    input:
        **FITTED,
        offsets=of_job(takes.known_of_network, paths.OFFSETS_CSV),
    output:
        errors_csv=paths.JOINT_ERRORS,
    log:
        "results/networks/logs/evaluate_joint_errors/{model}.log",
    params:
        code=code("evaluate_joint_errors.py"),
        takes=lambda w: evaluation.fitted_takes(STUDY, w.model),
        about=lambda w, output: evaluation.estimated_by(STUDY.sessions, w.model, output.errors_csv),
        step=STUDY.parameters["triangulate"],
        filtering=STUDY.parameters["filter_motion"],
    script:
        "../scripts/evaluate_joint_errors.py"


rule evaluate_skin_depths:
    input:
        lifted_npz=of_job(takes.every_take, paths.DEPTH_SOURCE),
        truth_npz=of_job(takes.every_take, paths.TRUE_TAKE),
    output:
        depths_csv=paths.SKIN_DEPTHS,
    log:
        "results/{session}/logs/evaluate_skin_depths/{device}.{model}.log",
    params:
        code=code("evaluate_skin_depths.py"),
        about=lambda w, output: evaluation.estimated_by([w.session], w.model, output.depths_csv),
        step=step("lift_depth"),
    script:
        "../scripts/evaluate_skin_depths.py"


rule evaluate_detection:
    input:
        pose2d_npz=of_job(takes.each_camera, paths.POSE2D),
        take_truth_npz=of_job(Job.true_file, paths.TRUE_TAKE),
        truth_npz=of_job(Job.true_file, paths.TRUTH),
        reference_npz=of_job(evaluation.reference),
        skeleton_yaml=of_job(Job.skeleton_file),
    output:
        errors_csv=paths.DETECTION_ERRORS,
    log:
        "results/{session}/logs/evaluate_detection/{take}.{model}.log",
    params:
        code=code("evaluate_detection.py"),
        n_persons=of_job(lambda job: len(job.take.subjects)),
        labels=lambda w: dict(w.items()),
    script:
        "../scripts/evaluate_detection.py"


rule evaluate_round_trip:
    input:
        pose3d_npz=of_job(evaluation.round_trip_skeletons),
        cameras_toml=paths.CAMERAS,
        people_npz=paths.PEOPLE,
        pose2d_npz=of_job(takes.keypoints_2d),
        sync_json=paths.CAMERA_CLOCKS,
        skeleton_yaml=of_job(Job.skeleton_file),
        derived_yaml=CONFIG / paths.DERIVED_JOINTS_YAML,
        truth_npz=of_job(Job.true_file, paths.TRUE_TAKE),
    output:
        rows_csv=paths.ROUND_TRIP,
    log:
        "results/{session}/logs/evaluate_round_trip/{take}.{calibration}.{model}.log",
    params:
        code=code("evaluate_round_trip.py"),
        step=of_job(evaluation.round_trip),
    script:
        "../scripts/evaluate_round_trip.py"


rule evaluate_fusions:
    input:
        pose3d_npz=of_job(takes.every_fused, paths.SKELETONS),
        truth_npz=paths.TRUE_TAKE,
    output:
        gains_csv=paths.GAINS,
    log:
        "results/{session}/logs/evaluate_fusions/{take}.{stage}.{calibration}.{model}.log",
    params:
        code=code("evaluate_fusions.py"),
        fusions=of_job(Job.every_fusion),
        pairs=of_job(evaluation.pairs),
        labels=of_job(evaluation.chosen, ("session", "take", "stage", "calibration", "model")),
    script:
        "../scripts/evaluate_fusions.py"
