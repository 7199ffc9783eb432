"""Figures of the calibration study that the paper does not have.

Inputs: ties, errors against the truth, courts, cameras. Outputs: results/figures/, results/{session}/figures/.
Steps: draw_court_points, draw_coverage, draw_growth, draw_error_map, draw_capture.
"""


rule draw_court_points:
    input:
        court_yaml=CONFIG / "courts" / "{court}.yaml",
    output:
        **drawn(
            "results/figures/court_points.{court}",
            "court_points",
            ("calibration", "courts"),
            {"figure": "court points", "court": "{court}"},
        ),
    log:
        "results/figures/logs/draw_court_points/{court}.log",
    params:
        code=code("draw_court_points.py"),
    script:
        "../scripts/draw_court_points.py"


rule draw_coverage:
    input:
        errors_csv=lambda w: every_error([session_of(w)]),
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
        benchmarks_tsv=lambda w: timings(session_of(w)),
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
        cameras_toml=f"{FOUND}/cameras.toml",
        covariance_npz=f"{FOUND}/covariance.npz",
        court_yaml=lambda w: court_file(session_of(w)),
    output:
        **drawn(
            "results/{session}/figures/error_map.{calibration}",
            "error_map",
            ("calibration", "{session}"),
            {"figure": "expected error", "calibration": "{calibration}"},
        ),
    log:
        "results/{session}/logs/draw_error_map/{calibration}.log",
    params:
        code=code("draw_error_map.py"),
        step=step("draw_error_map"),
    script:
        "../scripts/draw_error_map.py"


rule draw_capture:
    input:
        errors_csv=lambda w: every_error(varied(drawn_conditions()[w.condition])),
    output:
        **drawn(
            "results/figures/{condition}",
            "capture",
            ("calibration", "capture conditions"),
            {"figure": "{condition}"},
        ),
    log:
        "results/figures/logs/draw_capture/{condition}.log",
    wildcard_constraints:
        condition="|".join(drawn_conditions()) or "(?!)",  # without conditions, no figure
    params:
        code=code("draw_capture.py"),
        step=lambda w: varied_axes(drawn_conditions()[w.condition]),
    script:
        "../scripts/draw_capture.py"
