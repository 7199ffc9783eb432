"""What takes say together: table 1, networks side by side, a subject over sessions.

Inputs: 3D keypoints, kinematics, truth of virtual takes. Outputs: results/{session}/takes/{take}/table1/,
results/figures/.
Steps: evaluate_round_trip, draw_badminton_tab01, compare_networks, draw_agreement, compare_sessions.
"""


rule evaluate_round_trip:
    input:
        pose3d=lambda w: [
            f"results/{w.session}/takes/{w.take}/pose3d/{w.calibration}/{fusion}/{w.model}.npz"
            for fusion in round_trip_fusions(w)
        ],
        cameras="results/{session}/calibration/{calibration}/cameras.toml",
        pose2d=each_camera(f"{TAKE}/pose2d/{{model}}/{{camera}}.npz"),
        sync=f"{TAKE}/sync/{{calibration}}/cameras.{{model}}.json",
        skeleton=skeleton_file,
        derived=CONFIG / "derived_joints.yaml",
        truth=true_take_file,
    output:
        rows="results/{session}/evaluation/takes/{take}/round_trip/{calibration}.{model}.csv",
    log:
        "results/{session}/logs/evaluate_round_trip/{take}.{calibration}.{model}.log",
    params:
        code=code("evaluate_round_trip.py"),
        step=round_trip_parameters,
    script:
        "../scripts/evaluate_round_trip.py"


rule draw_badminton_tab01:
    input:
        rows="results/{session}/evaluation/takes/{take}/round_trip/{calibration}.{model}.csv",
        published=CONFIG / "published" / "badminton_tab01.csv",
    output:
        **drawn(
            f"{TAKE}/figures/badminton_tab01.{{calibration}}.{{model}}",
            "badminton_tab01",
            ("{session}", "{take}"),
            {"figure": "badminton_tab01", "calibration": "{calibration}", "network": "{model}"},
        ),
    log:
        "results/{session}/logs/draw_badminton_tab01/{take}.{calibration}.{model}.log",
    params:
        code=code("draw_badminton_tab01.py"),
        title=lambda w: f"{w.session}, {w.take}",
    script:
        "../scripts/draw_badminton_tab01.py"


rule compare_networks:
    input:
        measures=[row["summary"] for row in compared_takes()],
        pose3d=[row["pose3d"] for row in compared_takes()],
    output:
        pairs="results/figures/agreement.pairs.csv",
        table="results/figures/agreement.table.csv",
    log:
        "results/figures/logs/compare_networks/all.log",
    params:
        code=code("compare_networks.py"),
        labels=[row["labels"] for row in compared_takes()],
        joint_labels=[row["joint_labels"] for row in compared_takes()],
        networks=STUDY.parameters["compare_networks"]["networks"],
        step={
            key: STUDY.parameters["compare_networks"][key]
            for key in ("left_out", "min_subjects", "min_repeats")
        },
    script:
        "../scripts/compare_networks.py"


rule draw_agreement:
    input:
        pairs="results/figures/agreement.pairs.csv",
        table="results/figures/agreement.table.csv",
    output:
        **drawn(
            "results/figures/agreement",
            "agreement",
            ("players", "networks"),
            {"figure": "agreement"},
        ),
    log:
        "results/figures/logs/draw_agreement/all.log",
    params:
        code=code("draw_agreement.py"),
        networks=STUDY.parameters["compare_networks"]["networks"],
    script:
        "../scripts/draw_agreement.py"


rule compare_sessions:
    input:
        measures=[row["summary"] for row in archived_takes()],
        agreement="results/figures/agreement.table.csv" if compared_takes() else [],
    output:
        **drawn(
            "results/figures/archive", "archive", ("players", "sessions"), {"figure": "archive"}
        ),
    log:
        "results/figures/logs/compare_sessions/all.log",
    params:
        code=code("compare_sessions.py"),
        settings=lambda w: {
            "labels": [row["labels"] for row in archived_takes()],
            **{
                key: STUDY.parameters["compare_sessions"][key]
                for key in ("subject", "measures", "allow_mixed")
            },
        },
    script:
        "../scripts/compare_sessions.py"
