"""Figures of the calibration study that the paper does not have.

Inputs: ties, errors against the truth, courts, cameras. Outputs: results/figures/,
results/{session}/figures/.
Steps: draw_court_points, draw_coverage, draw_growth, draw_error_map, draw_capture, draw_worlds.
"""


rule draw_court_points:
    input:
        court_yaml=CONFIG / paths.COURT_YAML,
    output:
        **study_figure(
            "court_points.{court}",
            "court_points",
            ("calibration", "courts"),
            figure="court points",
            court="{court}",
        ),
    log:
        "results/figures/logs/draw_court_points/{court}.log",
    params:
        code=code("draw_court_points.py"),
    script:
        "../scripts/draw_court_points.py"


rule draw_coverage:
    input:
        errors_csv=lambda w: targets.calibration.every_error([session_of(w)]),
    output:
        **session_figure("coverage"),
    log:
        "results/{session}/logs/draw_coverage/all.log",
    params:
        code=code("draw_coverage.py"),
    script:
        "../scripts/draw_coverage.py"


rule draw_growth:
    input:
        benchmarks_tsv=of_job(figures.timings),
    output:
        **session_figure("growth"),
    log:
        "results/{session}/logs/draw_growth/all.log",
    params:
        code=code("draw_growth.py"),
    script:
        "../scripts/draw_growth.py"


rule draw_error_map:
    input:
        cameras_toml=paths.CAMERAS,
        covariance_npz=of_job(calibration.covariance),
        court_yaml=of_job(Job.court_file),
        base_toml=of_job(calibration.of_base, paths.CAMERAS),
        base_npz=of_job(calibration.base_covariance),
    output:
        **session_figure(
            "error_map.{calibration}",
            "error_map",
            figure="expected error",
            calibration="{calibration}",
        ),
    log:
        "results/{session}/logs/draw_error_map/{calibration}.log",
    params:
        code=code("draw_error_map.py"),
        step=of_job(calibration.error_map),
    script:
        "../scripts/draw_error_map.py"


rule draw_capture:
    input:
        errors_csv=of_job(figures.condition_errors),
    output:
        **study_figure("{condition}", "capture", ("calibration", "capture conditions")),
    log:
        "results/figures/logs/draw_capture/{condition}.log",
    wildcard_constraints:
        # Without conditions, no figure.
        condition="|".join(targets.calibration.drawn_conditions(STUDY)) or "(?!)",
    params:
        code=code("draw_capture.py"),
        step=of_job(figures.condition_axes),
    script:
        "../scripts/draw_capture.py"


rule draw_worlds:
    input:
        errors_csv=of_job(figures.world_errors),
        quality_json=of_job(figures.world_qualities),
    output:
        **study_figure("{condition}", "worlds", ("calibration", "wrong worlds")),
    log:
        "results/figures/logs/draw_worlds/{condition}.log",
    wildcard_constraints:
        condition="|".join(targets.calibration.world_conditions(STUDY)) or "(?!)",
    params:
        code=code("draw_worlds.py"),
    script:
        "../scripts/draw_worlds.py"
