"""Takes of virtual sessions against their truth. Only this file and evaluation_calibration.smk read truth.

Inputs: 2D and 3D keypoints, clocks, truth of takes.
Outputs: results/{session}/evaluation/takes/, results/{session}/takes/{take}/table1/.
Steps: evaluate_take, evaluate_clocks, evaluate_kinematics, evaluate_sources, evaluate_body_frames, evaluate_detection,
evaluate_round_trip (table 1), evaluate_fusions (paired differences with intervals); of development sessions, asked
for by name: evaluate_joint_offsets, evaluate_skin_depths.
"""

PAIRS = [  # ours first
    ("two-robust", "two-dlt"),
    ("three-robust", "three-dlt"),
    ("three-robust", "halfbody"),
    ("all-robust", "all-dlt"),
    ("all-robust", "all-unsteady"),
    ("two-robust", "two-unsteady"),
]


rule evaluate_take:
    input:
        pose3d_npz=lambda w: [
            f"results/{w.session}/takes/{w.take}/{stage}/{w.calibration}/{fusion}/{w.model}.npz"
            for stage, fusion in evaluated(w)
        ],
        truth_npz=TRUE_TAKE,
    output:
        errors_csv="results/{session}/evaluation/takes/{take}/errors/{calibration}.{model}.csv",
    log:
        "results/{session}/logs/evaluate_take/{take}.{calibration}.{model}.log",
    params:
        code=code("evaluate_take.py"),
        labels=lambda w: [
            {**dict(w.items()), "stage": stage, "fusion": fusion} for stage, fusion in evaluated(w)
        ],
    script:
        "../scripts/evaluate_take.py"


rule evaluate_clocks:
    input:
        sync_json=f"{TAKE}/sync/{{calibration}}/cameras.{{model}}.json",
        truth_npz=TRUE_TAKE,
    output:
        errors_csv="results/{session}/evaluation/takes/{take}/clocks/{calibration}.{model}.csv",
    log:
        "results/{session}/logs/evaluate_clocks/{take}.{calibration}.{model}.log",
    params:
        code=code("evaluate_clocks.py"),
        labels=lambda w: dict(w.items()),
    script:
        "../scripts/evaluate_clocks.py"


rule evaluate_kinematics:
    input:
        frames=f"{TAKE}/kinematics/{FUSED}.frames.csv",
        summary=f"{TAKE}/kinematics/{FUSED}.summary.csv",
        derived=CONFIG / "derived_joints.yaml",
        truth=TRUE_TAKE,
    output:
        errors_csv=f"results/{{session}}/evaluation/takes/{{take}}/kinematics/{FUSED}.csv",
    log:
        "results/{session}/logs/evaluate_kinematics/{take}.{calibration}.{fusion}.{model}.log",
    params:
        code=code("evaluate_kinematics.py"),
        labels=lambda w: dict(w.items()),
        sex_of=sex_of,
    script:
        "../scripts/evaluate_kinematics.py"


rule evaluate_sources:
    input:
        body_npz=body_files_of,
        truth_npz=TRUE_TAKE,
        derived_yaml=CONFIG / "derived_joints.yaml",
    output:
        errors_csv="results/{session}/evaluation/takes/{take}/sources/{model}.errors.csv",
        parts_csv="results/{session}/evaluation/takes/{take}/sources/{model}.parts.csv",
        paths_csv="results/{session}/evaluation/takes/{take}/sources/{model}.true_paths.csv",
        distortion_csv="results/{session}/evaluation/takes/{take}/sources/{model}.true_distortion.csv",
    log:
        "results/{session}/logs/evaluate_sources/{take}.{model}.log",
    params:
        code=code("evaluate_sources.py"),
        labels=lambda w: dict(w.items()),
        person=worn_by,
        step=step("measure_arcs"),
    script:
        "../scripts/evaluate_sources.py"


rule evaluate_body_frames:
    input:
        body_npz=lambda w: body_files_of(w, corrected=False),
        frame_json=lambda w: body_files_of(w, "json", corrected=False),
        truth_npz=TRUE_TAKE,
        derived_yaml=CONFIG / "derived_joints.yaml",
    output:
        errors_csv="results/{session}/evaluation/takes/{take}/body_frames/{model}.csv",
    log:
        "results/{session}/logs/evaluate_body_frames/{take}.{model}.log",
    params:
        code=code("evaluate_body_frames.py"),
        labels=lambda w: dict(w.items()),
        person=worn_by,
        owners=lambda w: clock_owners(w, corrected=False),
    script:
        "../scripts/evaluate_body_frames.py"


rule evaluate_joint_offsets:
    input:
        pose3d_npz=lambda w: every_take_file(w, "pose3d_filtered/known18/all-robust/{model}.npz"),
        truth_npz=true_takes,
    output:
        offsets_csv="results/{session}/evaluation/joint_offsets.{model}.csv",
    log:
        "results/{session}/logs/evaluate_joint_offsets/{model}.log",
    params:
        code=code("evaluate_joint_offsets.py"),
        sex_of=sex_of,
        about=lambda w, output: estimated_by(w.session, output.offsets),
    script:
        "../scripts/evaluate_joint_offsets.py"


rule evaluate_skin_depths:
    input:
        lifted_npz=lambda w: every_take_file(w, "devices/{device}-depth.{model}.npz"),
        truth_npz=true_takes,
    output:
        depths_csv="results/{session}/evaluation/skin_depths.{device}.{model}.csv",
    log:
        "results/{session}/logs/evaluate_skin_depths/{device}.{model}.log",
    params:
        code=code("evaluate_skin_depths.py"),
        about=lambda w, output: estimated_by(w.session, output.depths),
        step=step("lift_depth"),
    script:
        "../scripts/evaluate_skin_depths.py"


rule evaluate_detection:
    input:
        pose2d_npz=each_camera(f"{TAKE}/pose2d/{{model}}/{{camera}}.npz"),
        take_truth_npz=TRUE_TAKE,
        truth_npz="results/virtual/{session}/truth.npz",
        skeleton_yaml=skeleton_file,
    output:
        errors_csv="results/{session}/evaluation/takes/{take}/detection/{model}.csv",
    log:
        "results/{session}/logs/evaluate_detection/{take}.{model}.log",
    params:
        code=code("evaluate_detection.py"),
        labels=lambda w: dict(w.items()),
    script:
        "../scripts/evaluate_detection.py"


rule evaluate_round_trip:
    input:
        pose3d_npz=lambda w: [
            f"results/{w.session}/takes/{w.take}/pose3d/{w.calibration}/{fusion}/{w.model}.npz"
            for fusion in round_trip_fusions(w)
        ],
        cameras_toml="results/{session}/calibration/{calibration}/cameras.toml",
        pose2d_npz=each_camera(f"{TAKE}/pose2d/{{model}}/{{camera}}.npz"),
        sync_json=f"{TAKE}/sync/{{calibration}}/cameras.{{model}}.json",
        skeleton_yaml=skeleton_file,
        derived_yaml=CONFIG / "derived_joints.yaml",
        truth_npz=true_take_file,
    output:
        rows_csv="results/{session}/evaluation/takes/{take}/round_trip/{calibration}.{model}.csv",
    log:
        "results/{session}/logs/evaluate_round_trip/{take}.{calibration}.{model}.log",
    params:
        code=code("evaluate_round_trip.py"),
        step=round_trip_parameters,
    script:
        "../scripts/evaluate_round_trip.py"


rule evaluate_fusions:
    input:
        pose3d_npz=lambda w: [
            f"results/{w.session}/takes/{w.take}/{w.stage}/{w.calibration}/{fusion}/{w.model}.npz"
            for fusion in every_fusion(w)
        ],
        truth_npz=TRUE_TAKE,
    output:
        gains_csv="results/{session}/evaluation/takes/{take}/gains/{stage}.{calibration}.{model}.csv",
    log:
        "results/{session}/logs/evaluate_fusions/{take}.{stage}.{calibration}.{model}.log",
    params:
        code=code("evaluate_fusions.py"),
        fusions=every_fusion,
        pairs=lambda w: [pair for pair in PAIRS if set(pair) <= set(every_fusion(w))],
        labels=lambda w: {
            key: w[key] for key in ("session", "take", "stage", "calibration", "model")
        },
    script:
        "../scripts/evaluate_fusions.py"
