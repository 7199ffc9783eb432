"""Metric skeletons and the files that other programs open.

Inputs: 2D keypoints, shake, cameras. Outputs: results/{session}/takes/{take}/ pose2d_steadied,
sync, people, pose3d, pose3d_filtered, pose3d_corrected, pose3d_ik, motion, kinematics, footwork,
strokes, quality.csv.
Steps: steady_keypoints (of cameras that shake or were knocked), synchronise_cameras,
associate_people (everybody), name_people (the subjects among them), triangulate (raw, always kept),
filter_motion, correct_joints, fit_skeleton, export_take, export_motion, measure_kinematics,
find_contacts, find_strokes, judge_take.
"""


rule steady_keypoints:
    input:
        pose2d_npz=paths.POSE2D,
        cameras_toml=paths.CAMERAS,
        shake_csv=of_job(takes.measured_shake),
        knocks_csv=of_job(takes.knocks),
    output:
        steadied_npz=paths.POSE2D_STEADIED,
        taken_out_csv=paths.SHAKE_TAKEN_OUT,
    log:
        "results/{session}/logs/steady_keypoints/{take}.{calibration}.{model}.{camera}.log",
    params:
        code=code("steady_keypoints.py"),
        take="{take}",
    script:
        "../scripts/steady_keypoints.py"


rule synchronise_cameras:
    input:
        cameras_toml=paths.CAMERAS,
        pose2d_npz=of_job(takes.keypoints_2d),
    output:
        sync_json=paths.CAMERA_CLOCKS,
    log:
        "results/{session}/logs/synchronise_cameras/{take}.{calibration}.{model}.log",
    benchmark:
        "results/{session}/benchmarks/synchronise_cameras/{take}.{calibration}.{model}.tsv"
    params:
        code=code("synchronise_cameras.py"),
        step=step("synchronise_cameras"),
        synchronised=lambda w: take_of(w).synchronised,
        stated=of_job(lambda job: takes.clocks(job, job.take.cameras)),
        trim_s=lambda w: take_of(w).trim_s,
    script:
        "../scripts/synchronise_cameras.py"


rule associate_people:
    input:
        cameras=paths.CAMERAS,
        pose2d=of_job(takes.keypoints_2d),
        sync=paths.CAMERA_CLOCKS,
        skeleton=of_job(Job.skeleton_file),
        court=of_job(Job.court_file),
    output:
        people_npz=paths.FOUND_PEOPLE,
    log:
        "results/{session}/logs/associate_people/{take}.{calibration}.{model}.log",
    benchmark:
        "results/{session}/benchmarks/associate_people/{take}.{calibration}.{model}.tsv"
    params:
        code=code("associate_people.py"),
        several=lambda w: len(take_of(w).subjects) > 1,
        unit=lambda w: session_of(w).calibration_unit,
    script:
        "../scripts/associate_people.py"


rule name_people:
    input:
        found=paths.FOUND_PEOPLE,
        cameras=paths.CAMERAS,
        pose2d=of_job(takes.keypoints_2d),
        sync=paths.CAMERA_CLOCKS,
        court=of_job(Job.court_file),
        people_csv=of_job(takes.people_csv),
    output:
        people_npz=paths.PEOPLE,
    log:
        "results/{session}/logs/name_people/{take}.{calibration}.{model}.log",
    params:
        code=code("name_people.py"),
        persons=lambda w: list(take_of(w).subjects),
        stated=of_job(takes.sightings),
        take=lambda w: f"{w.session}/{w.take}",
        page=lambda w: targets.pages.people_pages(session_of(w), take_of(w)),
        file=lambda w: session_of(w).file,
    script:
        "../scripts/name_people.py"


rule triangulate:
    input:
        cameras=paths.CAMERAS,
        covariance=of_job(calibration.covariance),
        pose2d=of_job(takes.keypoints_2d),
        sync=paths.CAMERA_CLOCKS,
        people=paths.PEOPLE,
        skeleton=of_job(Job.skeleton_file),
        offsets=of_job(takes.known_of_network, paths.OFFSETS_CSV),
        errors=of_job(takes.known_of_network, paths.ERRORS_CSV),
    output:
        pose3d_npz=paths.POSE3D,
    log:
        f"results/{{session}}/logs/triangulate/{paths.OF_FUSED}.log",
    benchmark:
        f"results/{{session}}/benchmarks/triangulate/{paths.OF_FUSED}.tsv"
    wildcard_constraints:
        fusion=f"(?!trc){NAME}",
    params:
        code=code("triangulate.py"),
        step=step("triangulate"),
        sex_of=of_job(takes.sexes),
        fusion=of_job(takes.fusion),
        recorded=of_job(takes.recorded),
    script:
        "../scripts/triangulate.py"


rule filter_motion:
    input:
        raw_npz=paths.POSE3D,
        skeleton_yaml=of_job(Job.skeleton_file),
    output:
        filtered_npz=paths.POSE3D_FILTERED,
        cutoffs_csv=paths.CUTOFFS,
    log:
        f"results/{{session}}/logs/filter_motion/{paths.OF_FUSED}.log",
    params:
        code=code("filter_motion.py"),
        step=step("filter_motion"),
    script:
        "../scripts/filter_motion.py"


rule correct_joints:
    input:
        raw=paths.POSE3D,
        filtered=paths.POSE3D_FILTERED,
        cameras=paths.CAMERAS,
        cutoffs=paths.CUTOFFS,
        skeleton=of_job(Job.skeleton_file),
        offsets=lambda w: CONFIG / paths.OFFSETS_CSV.format(model=w.model),
    output:
        corrected_npz=paths.POSE3D_CORRECTED,
    log:
        f"results/{{session}}/logs/correct_joints/{paths.OF_FUSED}.log",
    params:
        code=code("correct_joints.py"),
        step=of_job(lambda job: job.some("filter_motion", ["max_gap_s"])),
        sex_of=of_job(takes.sexes),
    script:
        "../scripts/correct_joints.py"


rule fit_skeleton:
    input:
        raw=paths.POSE3D,
        cameras=paths.CAMERAS,
        corrected=paths.POSE3D_CORRECTED,
        contacts=paths.CONTACTS,
        cutoffs=paths.CUTOFFS,
        skeleton=of_job(Job.skeleton_file),
        offsets=lambda w: CONFIG / paths.OFFSETS_CSV.format(model=w.model),
    output:
        joints_npz=paths.POSE3D_IK,
        motion_npz=paths.SKELETAL_MOTION,
        angles_csv=paths.JOINT_ANGLES,
    log:
        f"results/{{session}}/logs/fit_skeleton/{paths.OF_FUSED}.log",
    benchmark:
        f"results/{{session}}/benchmarks/fit_skeleton/{paths.OF_FUSED}.tsv"
    wildcard_constraints:
        calibration=f"(?!{methods.DEVICES}/){NAME}",
    params:
        code=code("fit_skeleton.py"),
        step=of_job(lambda job: job.some("filter_motion", ["max_gap_s"])),
        sex_of=of_job(takes.sexes),
        height_m_of=of_job(takes.stated, "height_m"),
        recorded=of_job(takes.recorded),
    script:
        "../scripts/fit_skeleton.py"


rule export_motion:
    input:
        motion_npz=of_job(takes.exported_motion),
        pose3d_npz=paths.POSE3D_IK,
    output:
        mot_path=paths.part(paths.MODELLED_EXPORT, suffix="mot"),
        osim_path=paths.part(paths.MODELLED_EXPORT, suffix="osim"),
        trc_path=paths.part(paths.MODELLED_EXPORT, suffix="trc"),
        c3d_path=paths.part(paths.MODELLED_EXPORT, suffix="c3d"),
        csv_path=paths.part(paths.MODELLED_EXPORT, suffix="csv"),
        bvh_path=paths.part(paths.MOTION_EXPORT, suffix="bvh"),
        glb_path=paths.part(paths.MOTION_EXPORT, suffix="glb"),
    log:
        f"results/{{session}}/logs/export_motion/{paths.OF_FUSED}.{{person}}.log",
    params:
        code=code("export_motion.py"),
        sex_of=of_job(takes.sexes),
        mass_kg_of=of_job(takes.stated, "mass_kg"),
    script:
        "../scripts/export_motion.py"


rule export_take:
    input:
        pose3d_npz=of_job(takes.exported),
        skeleton_yaml=of_job(Job.skeleton_file),
    output:
        trc_path=paths.part(paths.EXPORT, suffix="trc"),
        c3d_path=paths.part(paths.EXPORT, suffix="c3d"),
        csv_path=paths.part(paths.EXPORT, suffix="csv"),
        bvh_path=paths.part(paths.EXPORT, suffix="bvh"),
        glb_path=paths.part(paths.EXPORT, suffix="glb"),
    log:
        "results/{session}/logs/export_take/{take}.{stage}.{calibration}.{fusion}.{model}.{person}.log",
    wildcard_constraints:
        stage="|".join(paths.STAGES),
    params:
        code=code("export_take.py"),
    script:
        "../scripts/export_take.py"


rule measure_kinematics:
    input:
        skeletons=of_job(takes.measured),
        raw=paths.POSE3D,
        cameras=of_job(calibration.cameras_of_covariance),
        covariance=of_job(calibration.covariance),
        cutoffs=paths.CUTOFFS,
        skeleton=of_job(Job.skeleton_file),
        derived=CONFIG / paths.DERIVED_JOINTS_YAML,
    output:
        frames_csv=paths.FRAME_MEASURES,
        summary_csv=paths.MEASURES,
    log:
        f"results/{{session}}/logs/measure_kinematics/{paths.OF_FUSED}.log",
    benchmark:
        f"results/{{session}}/benchmarks/measure_kinematics/{paths.OF_FUSED}.tsv"
    params:
        code=code("measure_kinematics.py"),
        step=of_job(lambda job: job.some("filter_motion", ["max_gap_s"])),
        stage=of_job(takes.measured_stage),
        sex_of=of_job(takes.sexes),
        recorded=of_job(takes.recorded),
    script:
        "../scripts/measure_kinematics.py"


rule find_contacts:
    input:
        skeletons=of_job(takes.measured),
        cutoffs=paths.CUTOFFS,
        skeleton=of_job(Job.skeleton_file),
        court=of_job(Job.court_file),
    output:
        contacts_npz=paths.CONTACTS,
        steps_csv=paths.STEPS,
        events_csv=paths.FOOT_EVENTS,
        summary_csv=paths.FOOTWORK_MEASURES,
    log:
        f"results/{{session}}/logs/find_contacts/{paths.OF_FUSED}.log",
    params:
        code=code("find_contacts.py"),
    script:
        "../scripts/find_contacts.py"


rule find_strokes:
    input:
        pose3d_npz=of_job(takes.measured),
        events_csv=paths.FOOT_EVENTS,
        court=of_job(Job.court_file),
    output:
        strokes_csv=paths.STROKES,
        reactions_csv=paths.REACTIONS,
    log:
        f"results/{{session}}/logs/find_strokes/{paths.OF_FUSED}.log",
    params:
        code=code("find_strokes.py"),
        hand_of=of_job(takes.stated, "hand"),
    script:
        "../scripts/find_strokes.py"


# A take that failed is judged in each run: none ends as if nothing was wrong.
rule judge_take:
    input:
        files_of(
            takes.judged,
            *("cameras", "quality", "check", "court_check"),
            *("people", "sync", "pose3d", "pose2d", "skeleton"),
        ),
    output:
        quality_csv=paths.QUALITY,
    log:
        "results/{session}/logs/judge_take/{take}.log",
    params:
        code=code("judge_take.py"),
        ways=of_job(takes.judged),
        pin=of_job(takes.failed_before),
    script:
        "../scripts/judge_take.py"
