"""Takes of virtual sessions against their truth: with evaluation.smk and racket.smk, the only rules that read it.

Inputs: 3D keypoints, clocks, truth of takes. Outputs: results/{session}/evaluation/takes/.
Steps: evaluate_take, evaluate_clocks, evaluate_joint_offsets (of development sessions, asked for by name).
"""

TRUE_TAKE = "results/virtual/{session}/takes/{take}/truth.npz"


rule evaluate_take:
    input:
        pose3d=f"{TAKE}/{{stage}}/{FUSED}.npz",
        truth=TRUE_TAKE,
    output:
        errors=f"results/{{session}}/evaluation/takes/{{take}}/{{stage}}/{FUSED}.csv",
    log:
        "results/{session}/logs/evaluate_take/{take}.{stage}.{calibration}.{fusion}.{model}.log",
    params:
        code=code("evaluate_take.py"),
        labels=lambda w: dict(w.items()),
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


rule evaluate_joint_offsets:
    input:
        pose3d=lambda w: every_take_file(w, "pose3d_filtered/known18/all-robust/{model}.npz"),
        truth=lambda w: [
            f"results/virtual/{w.session}/takes/{take}/truth.npz" for take in session_of(w).takes
        ],
    output:
        offsets="results/{session}/evaluation/joint_offsets.{model}.csv",
    log:
        "results/{session}/logs/evaluate_joint_offsets/{model}.log",
    params:
        code=code("evaluate_joint_offsets.py"),
        about=lambda w: (
            f"Estimated on session {w.session} by: snakemake --config sessions=[{w.session}] variations=[] -- "
            f"results/{w.session}/evaluation/joint_offsets.{w.model}.csv"
        ),
    script:
        "../scripts/evaluate_joint_offsets.py"
