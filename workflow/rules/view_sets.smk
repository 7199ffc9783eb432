"""Two, three, four cameras, and the rules that join them: what each is worth.

Inputs: 3D keypoints by set of cameras and rule, truth of virtual takes. Outputs: results/{session}/evaluation/takes/,
results/{session}/takes/{take}/views/, results/figures/.
Steps: evaluate_fusions (paired differences with intervals), draw_three_cameras, compare_views (real takes),
tabulate_players, draw_clock_errors.
"""

PAIRS = [  # ours first
    ("two-robust", "two-dlt"),
    ("three-robust", "three-dlt"),
    ("three-robust", "halfbody"),
    ("all-robust", "all-dlt"),
    ("all-robust", "all-unsteady"),
    ("two-robust", "two-unsteady"),
]


rule evaluate_fusions:
    input:
        pose3d=lambda w: [
            f"results/{w.session}/takes/{w.take}/{w.stage}/{w.calibration}/{fusion}/{w.model}.npz"
            for fusion in every_fusion(w)
        ],
        truth=TRUE_TAKE,
    output:
        gains="results/{session}/evaluation/takes/{take}/gains/{stage}.{calibration}.{model}.csv",
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


rule draw_three_cameras:
    input:
        errors=["results/{session}/evaluation/takes/{take}/errors/{calibration}.{model}.csv"],
        kinematics=lambda w: [
            f"results/{w.session}/evaluation/takes/{w.take}/kinematics/{w.calibration}/{fusion}/{w.model}.csv"
            for fusion in every_fusion(w)
        ],
    output:
        **drawn(
            f"{TAKE}/figures/three_cameras.{{calibration}}.{{model}}",
            "three_cameras",
            ("{session}", "{take}"),
            {"figure": "three cameras", "calibration": "{calibration}", "network": "{model}"},
        ),
    log:
        "results/{session}/logs/draw_three_cameras/{take}.{calibration}.{model}.log",
    params:
        code=code("draw_three_cameras.py"),
        cameras=lambda w: {name: session_of(w).fused_cameras(name) for name in every_fusion(w)},
    script:
        "../scripts/draw_three_cameras.py"


rule compare_views:
    input:
        pose3d=lambda w: [
            f"results/{w.session}/takes/{w.take}/pose3d/{w.calibration}/{fusion}/{w.model}.npz"
            for fusion in every_fusion(w)[::-1]
        ],
    output:
        distances=f"{TAKE}/views/{{calibration}}.{{model}}.csv",
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
        table="results/figures/players.csv",
    log:
        "results/figures/logs/tabulate_players/all.log",
    params:
        code=code("tabulate_players.py"),
    script:
        "../scripts/tabulate_players.py"


rule draw_clock_errors:
    input:
        errors=lambda w: evaluations_of_takes("clocks"),
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
