"""Comparisons over takes: sets of cameras, networks, clocks, a subject over sessions.

Inputs: 3D keypoints, kinematics, errors, truth of virtual takes. Outputs:
results/{session}/takes/{take}/views/, results/figures/.
Steps: compare_views (real takes), tabulate_players, tabulate_angles, draw_clock_errors,
draw_reliability, compare_networks, draw_agreement, evaluate_networks, draw_networks, tabulate_study
(every measure of every take), compare_sessions.
"""


rule compare_views:
    input:
        pose3d_npz=of_job(lambda job: takes.every_fused(job)[::-1]),
    output:
        distances_csv=paths.VIEW_DISTANCES,
    log:
        "results/{session}/logs/compare_views/{take}.{calibration}.{model}.log",
    params:
        code=code("compare_views.py"),
        fusions=of_job(lambda job: job.every_fusion()[::-1]),
        labels=of_job(
            evaluation.chosen, ("session", "take", "calibration", "model"), stage="pose3d"
        ),
    script:
        "../scripts/compare_views.py"


rule tabulate_players:
    input:
        errors=lambda w: targets.takes.evaluations(STUDY, "errors"),
        kinematics=lambda w: targets.takes.evaluations(STUDY, "kinematics"),
        clocks=lambda w: targets.takes.evaluations(STUDY, "clocks"),
        gains=lambda w: targets.takes.evaluations(STUDY, "gains"),
    output:
        table_csv=paths.PLAYERS_TABLE,
    log:
        "results/figures/logs/tabulate_players/all.log",
    params:
        code=code("tabulate_players.py"),
    script:
        "../scripts/tabulate_players.py"


rule tabulate_angles:
    input:
        errors_csv=lambda w: targets.takes.evaluations(STUDY, "angles"),
    output:
        table_csv=paths.ANGLES_TABLE,
    log:
        "results/figures/logs/tabulate_angles/all.log",
    params:
        code=code("tabulate_angles.py"),
    script:
        "../scripts/tabulate_angles.py"


rule draw_clock_errors:
    input:
        errors_csv=lambda w: targets.takes.evaluations(STUDY, "clocks"),
    output:
        **study_figure("clock_errors", "clock_errors", ("players", "clocks"), figure="clocks"),
    log:
        "results/figures/logs/draw_clock_errors/all.log",
    params:
        code=code("draw_clock_errors.py"),
    script:
        "../scripts/draw_clock_errors.py"


rule draw_reliability:
    input:
        counts_csv=lambda w: targets.takes.evaluations(STUDY, "reliability"),
    output:
        **study_figure("reliability", "reliability", ("players", "joints"), figure="joints"),
    log:
        "results/figures/logs/draw_reliability/all.log",
    params:
        code=code("draw_reliability.py"),
    script:
        "../scripts/draw_reliability.py"


rule compare_networks:
    input:
        measures_csv=[row.measures for row in targets.together.compared_takes(STUDY)],
        pose3d_npz=[row.pose3d for row in targets.together.compared_takes(STUDY)],
    output:
        pairs_csv=paths.NETWORK_PAIRS,
        table_csv=paths.NETWORK_AGREEMENT,
    log:
        "results/figures/logs/compare_networks/all.log",
    params:
        code=code("compare_networks.py"),
        labels=[row.labels for row in targets.together.compared_takes(STUDY)],
        joint_labels=[row.joint_labels for row in targets.together.compared_takes(STUDY)],
        networks=STUDY.parameters["compare_networks"]["networks"],
        step={
            key: STUDY.parameters["compare_networks"][key]
            for key in ("left_out", "min_subjects", "min_repeats")
        },
    script:
        "../scripts/compare_networks.py"


rule draw_agreement:
    input:
        pairs_csv=paths.NETWORK_PAIRS,
        table_csv=paths.NETWORK_AGREEMENT,
    output:
        **study_figure("agreement", "agreement", ("players", "networks")),
    log:
        "results/figures/logs/draw_agreement/all.log",
    params:
        code=code("draw_agreement.py"),
        networks=STUDY.parameters["compare_networks"]["networks"],
    script:
        "../scripts/draw_agreement.py"


rule evaluate_networks:
    input:
        errors_csv=[row.errors for row in targets.together.evaluated_takes(STUDY)],
        pose3d_npz=[row.pose3d for row in targets.together.evaluated_takes(STUDY) if row.pose3d],
        truth_npz=evaluation.compared_truths(targets.together.evaluated_takes(STUDY)),
    output:
        table_csv=paths.NETWORK_ERRORS,
    log:
        "results/figures/logs/evaluate_networks/all.log",
    params:
        code=code("evaluate_networks.py"),
        labels=[row.labels for row in targets.together.evaluated_takes(STUDY)],
        skeleton_labels=[
            row.labels for row in targets.together.evaluated_takes(STUDY) if row.pose3d
        ],
        networks=STUDY.parameters["evaluate_networks"]["networks"],
    script:
        "../scripts/evaluate_networks.py"


rule draw_networks:
    input:
        table_csv=paths.NETWORK_ERRORS,
    output:
        **study_figure("networks", "networks", ("players", "networks")),
    log:
        "results/figures/logs/draw_networks/all.log",
    params:
        code=code("draw_networks.py"),
    script:
        "../scripts/draw_networks.py"


rule tabulate_study:
    input:
        files=lambda w: paths.files_in(
            targets.together.tabulated_takes(STUDY), "measures_csv", "quality_csv"
        ),
    output:
        table_csv=paths.STUDY_TABLE,
    log:
        "results/figures/logs/tabulate_study/all.log",
    params:
        code=code("tabulate_study.py"),
        takes=lambda w: targets.together.tabulated_takes(STUDY),
    script:
        "../scripts/tabulate_study.py"


rule compare_sessions:
    input:
        study_csv=paths.STUDY_TABLE,
        agreement_csv=paths.NETWORK_AGREEMENT if targets.together.compared_takes(STUDY) else [],
    output:
        **study_figure("archive", "archive", ("players", "sessions")),
    log:
        "results/figures/logs/compare_sessions/all.log",
    params:
        code=code("compare_sessions.py"),
        step=lambda w: {
            "ways": [
                {**row.labels, "fusion": row.fusion}
                for row in targets.together.archived_takes(STUDY)
            ],
            "networks": STUDY.parameters["compare_networks"]["networks"],
            **{
                key: STUDY.parameters["compare_sessions"][key]
                for key in ("subject", "measures", "allow_mixed")
            },
        },
    script:
        "../scripts/compare_sessions.py"
