"""Comparison of calibrations of virtual sessions with the truth.

No method reads truth. The simulation does, and evaluations: this file, evaluation_takes.smk and
evaluate_networks.

Inputs: ties, truth. Outputs: results/{session}/evaluation/, results/figures/calibration.csv and
ways.csv.
Steps: evaluate_calibration (one structure from motion), evaluate_known (calibration from known
points alone), evaluate_racket (the length of a racket), evaluate_ways (all ways side by side, for
the report), tabulate_calibration.
"""


rule evaluate_calibration:
    input:
        ties_npz=paths.TIES,
        summary_json=paths.SFM_SUMMARY,
        truth_npz=paths.TRUTH,
        court_yaml=of_job(Job.court_file),
    output:
        errors_csv=paths.SFM_ERRORS,
    log:
        "results/{session}/logs/evaluate_calibration/{mapper}-n{n_images}-o{offset}.log",
    benchmark:
        "results/{session}/benchmarks/evaluate_calibration/{mapper}-n{n_images}-o{offset}.tsv"
    params:
        code=code("evaluate_calibration.py"),
        step=of_job(evaluation.sfm_errors),
    script:
        "../scripts/evaluate_calibration.py"


rule evaluate_known:
    input:
        truth_npz=paths.TRUTH,
        court_yaml=of_job(Job.court_file),
        lens_toml=of_job(evaluation.lenses),
    output:
        errors_csv=paths.KNOWN_ERRORS,
    log:
        "results/{session}/logs/evaluate_known/all.log",
    params:
        code=code("evaluate_known.py"),
        step=of_job(evaluation.known_errors),
        cameras=lambda w: list(session_of(w).cameras),
    script:
        "../scripts/evaluate_known.py"


rule evaluate_racket:
    input:
        ties_npz=of_job(evaluation.racket_ties),
        truth_npz=paths.TRUTH,
        court_yaml=of_job(Job.court_file),
    output:
        lengths_csv=paths.RACKET_LENGTHS,
    log:
        "results/{session}/logs/evaluate_racket/all.log",
    benchmark:
        "results/{session}/benchmarks/evaluate_racket/all.tsv"
    params:
        code=code("evaluate_racket.py"),
        step=of_job(evaluation.racket),
    script:
        "../scripts/evaluate_racket.py"


rule evaluate_ways:
    input:
        files=lambda w: paths.files_in(
            evaluation.ways(STUDY), "cameras", "quality", "truth", "court", "skeletons"
        ),
    output:
        table_csv=paths.WAYS_TABLE,
    log:
        "results/figures/logs/evaluate_ways/all.log",
    params:
        code=code("evaluate_ways.py"),
        ways=lambda w: evaluation.ways(STUDY),
    script:
        "../scripts/evaluate_ways.py"


rule tabulate_calibration:
    input:
        errors_csv=targets.calibration.every_error(targets.calibration.tabulated(STUDY)),
    output:
        table_csv=paths.CALIBRATION_TABLE,
    log:
        "results/figures/logs/tabulate_calibration/all.log",
    params:
        code=code("tabulate_calibration.py"),
    script:
        "../scripts/tabulate_calibration.py"
