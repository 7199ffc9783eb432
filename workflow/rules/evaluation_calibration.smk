"""Calibrations of virtual sessions against their truth. Only this file and evaluation_takes.smk read truth.

Inputs: ties, truth. Outputs: results/{session}/evaluation/, results/figures/calibration.csv.
Steps: evaluate_calibration (one structure from motion), evaluate_known (calibration from known points alone),
evaluate_racket (the length of a racket), tabulate_calibration.
"""


rule evaluate_calibration:
    input:
        ties_npz=f"{VARIANT}/ties.npz",
        summary_json=f"{VARIANT}/summary.json",
        truth_npz="results/virtual/{session}/truth.npz",
        court_yaml=lambda w: court_file(session_of(w)),
    output:
        errors_csv="results/{session}/evaluation/{mapper}-n{n_images}-o{offset}.csv",
    log:
        "results/{session}/logs/evaluate_calibration/{mapper}-n{n_images}-o{offset}.log",
    benchmark:
        "results/{session}/benchmarks/evaluate_calibration/{mapper}-n{n_images}-o{offset}.tsv"
    params:
        code=code("evaluate_calibration.py"),
        step=lambda w: evaluation_parameters(
            w,
            labels={"mapper": w.mapper, "n_bridging": w.n_images, "offset": w.offset},
            keys=["click_sigma_px", "click_bias_px", "click_loss"],
        ),
    script:
        "../scripts/evaluate_calibration.py"


rule evaluate_known:
    input:
        truth_npz="results/virtual/{session}/truth.npz",
        court_yaml=lambda w: court_file(session_of(w)),
        lens_toml=every_lens_file,
    output:
        errors_csv="results/{session}/evaluation/known.csv",
    log:
        "results/{session}/logs/evaluate_known/all.log",
    params:
        code=code("evaluate_known.py"),
        step=lambda w: evaluation_parameters(w, labels={}, keys=["click_sigma_px"]),
        cameras=lambda w: list(session_of(w).cameras),
    script:
        "../scripts/evaluate_known.py"


rule evaluate_racket:
    input:
        ties_npz=lambda w: [
            f"results/{w.session}/sfm/{variant}/ties.npz" for variant in racket_models(w.session)
        ],
        truth_npz="results/virtual/{session}/truth.npz",
        court_yaml=lambda w: court_file(session_of(w)),
    output:
        lengths_csv="results/{session}/evaluation/racket.csv",
    log:
        "results/{session}/logs/evaluate_racket/all.log",
    benchmark:
        "results/{session}/benchmarks/evaluate_racket/all.tsv"
    params:
        code=code("evaluate_racket.py"),
        step=racket_parameters,
    script:
        "../scripts/evaluate_racket.py"


rule tabulate_calibration:
    input:
        errors_csv=every_error(tabulated()),
    output:
        table_csv="results/figures/calibration.csv",
    log:
        "results/figures/logs/tabulate_calibration/all.log",
    params:
        code=code("tabulate_calibration.py"),
        n_reference=40,
    script:
        "../scripts/tabulate_calibration.py"
