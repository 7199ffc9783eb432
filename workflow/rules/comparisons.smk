"""What takes say together: sets of cameras, networks side by side, clocks, a subject over sessions.

Inputs: 3D keypoints, kinematics, errors. Outputs: results/{session}/takes/{take}/views/, results/figures/.
Steps: compare_views (real takes), tabulate_players, draw_clock_errors, compare_networks, draw_agreement,
compare_sessions.
"""


rule compare_views:
    input:
        pose3d_npz=lambda w: [
            f"results/{w.session}/takes/{w.take}/pose3d/{w.calibration}/{fusion}/{w.model}.npz"
            for fusion in every_fusion(w)[::-1]
        ],
    output:
        distances_csv=f"{TAKE}/views/{{calibration}}.{{model}}.csv",
    log:
        "results/{session}/logs/compare_views/{take}.{calibration}.{model}.log",
    params:
        code=code("compare_views.py"),
        fusions=lambda w: every_fusion(w)[::-1],
        labels=lambda w: {
            **{key: w[key] for key in ("session", "take", "calibration", "model")},
            "stage": "pose3d",
        },
    script:
        "../scripts/compare_views.py"


rule tabulate_players:
    input:
        errors=lambda w: evaluations_of_takes("errors"),
        kinematics=lambda w: evaluations_of_takes("kinematics"),
        clocks=lambda w: evaluations_of_takes("clocks"),
        gains=lambda w: evaluations_of_takes("gains"),
    output:
        table_csv="results/figures/players.csv",
    log:
        "results/figures/logs/tabulate_players/all.log",
    params:
        code=code("tabulate_players.py"),
    script:
        "../scripts/tabulate_players.py"


rule draw_clock_errors:
    input:
        errors_csv=lambda w: evaluations_of_takes("clocks"),
    output:
        **drawn(
            "results/figures/clock_errors",
            "clock_errors",
            ("players", "clocks"),
            {"figure": "clocks"},
        ),
    log:
        "results/figures/logs/draw_clock_errors/all.log",
    params:
        code=code("draw_clock_errors.py"),
    script:
        "../scripts/draw_clock_errors.py"


rule compare_networks:
    input:
        measures_csv=[row["summary"] for row in compared_takes()],
        pose3d_npz=[row["pose3d"] for row in compared_takes()],
    output:
        pairs_csv="results/figures/agreement.pairs.csv",
        table_csv="results/figures/agreement.table.csv",
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
        pairs_csv="results/figures/agreement.pairs.csv",
        table_csv="results/figures/agreement.table.csv",
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
        measures_csv=[row["summary"] for row in archived_takes()],
        agreement_csv="results/figures/agreement.table.csv" if compared_takes() else [],
    output:
        **drawn(
            "results/figures/archive", "archive", ("players", "sessions"), {"figure": "archive"}
        ),
    log:
        "results/figures/logs/compare_sessions/all.log",
    params:
        code=code("compare_sessions.py"),
        step=lambda w: {
            "labels": [row["labels"] for row in archived_takes()],
            **{
                key: STUDY.parameters["compare_sessions"][key]
                for key in ("subject", "measures", "allow_mixed")
            },
        },
    script:
        "../scripts/compare_sessions.py"
