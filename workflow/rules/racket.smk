"""The length of a racket by several calibrations: fig 12 of the badminton paper.

Inputs: ties, truth. Outputs: results/{session}/evaluation/racket.csv, results/figures/badminton_fig12.
Steps: evaluate_racket, draw_badminton_fig12.
"""


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


rule draw_badminton_fig12:
    input:
        lengths=[f"results/{name}/evaluation/racket.csv" for name in racket_sessions()],
    output:
        **drawn(
            "results/figures/badminton_fig12",
            "badminton_fig12",
            ("calibration", "racket"),
            {"figure": "badminton_fig12"},
        ),
    log:
        "results/figures/logs/draw_badminton_fig12/all.log",
    params:
        code=code("draw_badminton_fig12.py"),
    script:
        "../scripts/draw_badminton_fig12.py"
