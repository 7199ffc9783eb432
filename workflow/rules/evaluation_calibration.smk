"""Calibrations of virtual sessions against their truth. Only this file and evaluation_takes.smk read truth.

Inputs: ties, truth. Outputs: results/{session}/evaluation/, results/figures/calibration.csv.
Steps: evaluate_calibration (one structure from motion), evaluate_known (calibration from known points alone),
evaluate_racket (the length of a racket), tabulate_calibration.
"""


rule evaluate_calibration:
    input:
        ties=f"{VARIANT}/ties.npz",
        summary=f"{VARIANT}/summary.json",
        truth="results/virtual/{session}/truth.npz",
        court=lambda w: court_file(session_of(w)),
    output:
        errors="results/{session}/evaluation/{mapper}-n{n_images}-o{offset}.csv",
    log:
        "results/{session}/logs/evaluate_calibration/{mapper}-n{n_images}-o{offset}.log",
    benchmark:
        "results/{session}/benchmarks/evaluate_calibration/{mapper}-n{n_images}-o{offset}.tsv"
    params:
        code=code("evaluate_calibration.py"),
        settings=lambda w: evaluation_parameters(
            w,
            labels={"mapper": w.mapper, "n_bridging": w.n_images, "offset": w.offset},
            keys=["click_sigma_px", "click_bias_px", "click_loss"],
        ),
    script:
        "../scripts/evaluate_calibration.py"


rule evaluate_known:
    input:
        truth="results/virtual/{session}/truth.npz",
        court=lambda w: court_file(session_of(w)),
        lenses=every_lens_file,
    output:
        errors="results/{session}/evaluation/known.csv",
    log:
        "results/{session}/logs/evaluate_known/all.log",
    params:
        code=code("evaluate_known.py"),
        settings=lambda w: evaluation_parameters(w, labels={}, keys=["click_sigma_px"]),
        cameras=lambda w: list(session_of(w).cameras),
    script:
        "../scripts/evaluate_known.py"


rule evaluate_racket:
    input:
        ties=lambda w: [
            f"results/{w.session}/sfm/{variant}/ties.npz" for variant in racket_models(w.session)
        ],
        truth="results/virtual/{session}/truth.npz",
        court=lambda w: court_file(session_of(w)),
    output:
        lengths="results/{session}/evaluation/racket.csv",
    log:
        "results/{session}/logs/evaluate_racket/all.log",
    benchmark:
        "results/{session}/benchmarks/evaluate_racket/all.tsv"
    params:
        code=code("evaluate_racket.py"),
        settings=racket_parameters,
    script:
        "../scripts/evaluate_racket.py"


rule tabulate_calibration:
    input:
        errors=every_error(tabulated()),
    output:
        table="results/figures/calibration.csv",
    log:
        "results/figures/logs/tabulate_calibration/all.log",
    params:
        code=code("tabulate_calibration.py"),
        n_reference=40,
    script:
        "../scripts/tabulate_calibration.py"
