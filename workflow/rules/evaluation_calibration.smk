"""Calibrations of virtual sessions against their truth.

Only this file and evaluation_takes.smk read truth.

Inputs: ties, truth. Outputs: results/{session}/evaluation/, results/figures/calibration.csv.
Steps: evaluate_calibration (one structure from motion), evaluate_known (calibration from known
points alone), evaluate_racket (the length of a racket), tabulate_calibration.
"""


rule evaluate_calibration:
    input:
        ties=paths.TIES,
        summary=paths.SFM_SUMMARY,
        truth=paths.TRUTH,
        court=of_job(Job.court_file),
    output:
        errors=paths.SFM_ERRORS,
    log:
        "results/{session}/logs/evaluate_calibration/{mapper}-n{n_images}-o{offset}.log",
    benchmark:
        "results/{session}/benchmarks/evaluate_calibration/{mapper}-n{n_images}-o{offset}.tsv"
    params:
        code=code("evaluate_calibration.py"),
        settings=of_job(evaluation.sfm_errors),
    script:
        "../scripts/evaluate_calibration.py"


rule evaluate_known:
    input:
        truth=paths.TRUTH,
        court=of_job(Job.court_file),
        lenses=of_job(evaluation.lenses),
    output:
        errors=paths.KNOWN_ERRORS,
    log:
        "results/{session}/logs/evaluate_known/all.log",
    params:
        code=code("evaluate_known.py"),
        settings=of_job(evaluation.known_errors),
        cameras=lambda w: list(session_of(w).cameras),
    script:
        "../scripts/evaluate_known.py"


rule evaluate_racket:
    input:
        ties=of_job(evaluation.racket_ties),
        truth=paths.TRUTH,
        court=of_job(Job.court_file),
    output:
        lengths=paths.RACKET_LENGTHS,
    log:
        "results/{session}/logs/evaluate_racket/all.log",
    benchmark:
        "results/{session}/benchmarks/evaluate_racket/all.tsv"
    params:
        code=code("evaluate_racket.py"),
        settings=of_job(evaluation.racket),
    script:
        "../scripts/evaluate_racket.py"


rule tabulate_calibration:
    input:
        errors=targets.calibration.every_error(targets.calibration.tabulated(STUDY)),
    output:
        table=paths.CALIBRATION_TABLE,
    log:
        "results/figures/logs/tabulate_calibration/all.log",
    params:
        code=code("tabulate_calibration.py"),
        n_reference=40,
    script:
        "../scripts/tabulate_calibration.py"
