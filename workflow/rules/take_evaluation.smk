"""Takes of virtual sessions against their truth: with evaluation.smk and racket.smk, the only rules that read it.

Inputs: 3D keypoints, clocks, truth of takes. Outputs: results/{session}/evaluation/takes/.
Steps: evaluate_take, evaluate_clocks, evaluate_kinematics, evaluate_sources, evaluate_body_frames; of
development sessions, asked for by name: evaluate_joint_offsets, evaluate_skin_depths.
"""


rule evaluate_take:
    input:
        pose3d=lambda w: [
            f"results/{w.session}/takes/{w.take}/{stage}/{w.calibration}/{fusion}/{w.model}.npz"
            for stage, fusion in evaluated(w)
        ],
        truth=TRUE_TAKE,
    output:
        errors="results/{session}/evaluation/takes/{take}/errors/{calibration}.{model}.csv",
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
        sync=f"{TAKE}/sync/{{calibration}}/cameras.{{model}}.json",
        truth=TRUE_TAKE,
    output:
        errors="results/{session}/evaluation/takes/{take}/clocks/{calibration}.{model}.csv",
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
        errors=f"results/{{session}}/evaluation/takes/{{take}}/kinematics/{FUSED}.csv",
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
        bodies=body_files_of,
        truth=TRUE_TAKE,
        derived=CONFIG / "derived_joints.yaml",
    output:
        errors="results/{session}/evaluation/takes/{take}/sources/{model}.errors.csv",
        parts="results/{session}/evaluation/takes/{take}/sources/{model}.parts.csv",
        paths="results/{session}/evaluation/takes/{take}/sources/{model}.true_paths.csv",
        distortion="results/{session}/evaluation/takes/{take}/sources/{model}.true_distortion.csv",
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
        bodies=lambda w: body_files_of(w, corrected=False),
        frames=lambda w: body_files_of(w, "json", corrected=False),
        truth=TRUE_TAKE,
        derived=CONFIG / "derived_joints.yaml",
    output:
        errors="results/{session}/evaluation/takes/{take}/body_frames/{model}.csv",
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
        pose3d=lambda w: every_take_file(w, "pose3d_filtered/known18/all-robust/{model}.npz"),
        truth=true_takes,
    output:
        offsets="results/{session}/evaluation/joint_offsets.{model}.csv",
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
        lifted=lambda w: every_take_file(w, "devices/{device}-depth.{model}.npz"),
        truth=true_takes,
    output:
        depths="results/{session}/evaluation/skin_depths.{device}.{model}.csv",
    log:
        "results/{session}/logs/evaluate_skin_depths/{device}.{model}.log",
    params:
        code=code("evaluate_skin_depths.py"),
        about=lambda w, output: estimated_by(w.session, output.depths),
        step=step("lift_depth"),
    script:
        "../scripts/evaluate_skin_depths.py"
