"""Metric skeletons and the files that other programs open.

Inputs: 2D keypoints, cameras. Outputs: results/{session}/takes/{take}/ sync, people, pose3d, pose3d_filtered,
pose3d_corrected, kinematics.
Steps: synchronise_cameras, associate_people, triangulate (raw, always kept), filter_motion, correct_joints,
export_take, measure_kinematics.
"""

TAKE = "results/{session}/takes/{take}"
FUSED = "{calibration}/{fusion}/{model}"
OF_FUSED = "{take}.{calibration}.{fusion}.{model}"


rule synchronise_cameras:
    input:
        cameras_toml="results/{session}/calibration/{calibration}/cameras.toml",
        pose2d_npz=each_camera(f"{TAKE}/pose2d/{{model}}/{{camera}}.npz"),
    output:
        sync_json=f"{TAKE}/sync/{{calibration}}/cameras.{{model}}.json",
    log:
        "results/{session}/logs/synchronise_cameras/{take}.{calibration}.{model}.log",
    benchmark:
        "results/{session}/benchmarks/synchronise_cameras/{take}.{calibration}.{model}.tsv"
    params:
        code=code("synchronise_cameras.py"),
        step=step("synchronise_cameras"),
        synchronised=lambda w: take_of(w).synchronised,
        stated=lambda w: stated_clocks(w, take_of(w).videos),
    script:
        "../scripts/synchronise_cameras.py"


rule associate_people:
    input:
        cameras="results/{session}/calibration/{calibration}/cameras.toml",
        pose2d=each_camera(f"{TAKE}/pose2d/{{model}}/{{camera}}.npz"),
        sync=f"{TAKE}/sync/{{calibration}}/cameras.{{model}}.json",
        skeleton=skeleton_file,
        court=lambda w: court_file(session_of(w)) or [],
    output:
        people_npz=f"{TAKE}/people/{{calibration}}/{{model}}.npz",
    log:
        "results/{session}/logs/associate_people/{take}.{calibration}.{model}.log",
    benchmark:
        "results/{session}/benchmarks/associate_people/{take}.{calibration}.{model}.tsv"
    params:
        code=code("associate_people.py"),
        persons=lambda w: list(take_of(w).subjects),
    script:
        "../scripts/associate_people.py"


rule triangulate:
    input:
        cameras="results/{session}/calibration/{calibration}/cameras.toml",
        covariance=camera_covariance_file,
        pose2d=each_camera(f"{TAKE}/pose2d/{{model}}/{{camera}}.npz"),
        sync=f"{TAKE}/sync/{{calibration}}/cameras.{{model}}.json",
        people=f"{TAKE}/people/{{calibration}}/{{model}}.npz",
        shake=shake_files,
        skeleton=skeleton_file,
    output:
        pose3d_npz=f"{TAKE}/pose3d/{FUSED}.npz",
    log:
        f"results/{{session}}/logs/triangulate/{OF_FUSED}.log",
    benchmark:
        f"results/{{session}}/benchmarks/triangulate/{OF_FUSED}.tsv"
    wildcard_constraints:
        fusion=f"(?!trc){NAME}",
    params:
        code=code("triangulate.py"),
        step=step("triangulate"),
        persons=lambda w: list(take_of(w).subjects),
        fusion=fusion_options,
    script:
        "../scripts/triangulate.py"


rule filter_motion:
    input:
        raw_npz=f"{TAKE}/pose3d/{FUSED}.npz",
        skeleton_yaml=skeleton_file,
    output:
        filtered_npz=f"{TAKE}/pose3d_filtered/{FUSED}.npz",
    log:
        f"results/{{session}}/logs/filter_motion/{OF_FUSED}.log",
    params:
        code=code("filter_motion.py"),
        step=step("filter_motion"),
    script:
        "../scripts/filter_motion.py"


rule correct_joints:
    input:
        filtered_npz=f"{TAKE}/pose3d_filtered/{FUSED}.npz",
        offsets_csv=lambda w: CONFIG / "joint_offsets" / f"{w.model}.csv",
    output:
        corrected_npz=f"{TAKE}/pose3d_corrected/{FUSED}.npz",
    log:
        f"results/{{session}}/logs/correct_joints/{OF_FUSED}.log",
    params:
        code=code("correct_joints.py"),
        sex_of=sex_of,
    script:
        "../scripts/correct_joints.py"


rule export_take:
    input:
        pose3d_npz=exported,
    output:
        trc_path=f"{TAKE}/{{stage}}/{FUSED}.{{person}}.trc",
        c3d_path=f"{TAKE}/{{stage}}/{FUSED}.{{person}}.c3d",
        csv_path=f"{TAKE}/{{stage}}/{FUSED}.{{person}}.csv",
    log:
        "results/{session}/logs/export_take/{take}.{stage}.{calibration}.{fusion}.{model}.{person}.log",
    params:
        code=code("export_take.py"),
    script:
        "../scripts/export_take.py"


rule measure_kinematics:
    input:
        raw_npz=f"{TAKE}/pose3d/{FUSED}.npz",
        skeleton_yaml=skeleton_file,
        derived_yaml=CONFIG / "derived_joints.yaml",
    output:
        frames_csv=f"{TAKE}/kinematics/{FUSED}.frames.csv",
        summary_csv=f"{TAKE}/kinematics/{FUSED}.summary.csv",
        cutoffs_csv=f"{TAKE}/kinematics/{FUSED}.cutoffs.csv",
    log:
        f"results/{{session}}/logs/measure_kinematics/{OF_FUSED}.log",
    benchmark:
        f"results/{{session}}/benchmarks/measure_kinematics/{OF_FUSED}.tsv"
    params:
        code=code("measure_kinematics.py"),
        step=step("measure_kinematics"),
        sex_of=sex_of,
    script:
        "../scripts/measure_kinematics.py"
