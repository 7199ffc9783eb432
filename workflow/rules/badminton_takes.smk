"""Figures 5, 9, 10 and 11 of the badminton paper, drawn from takes.

Inputs: 2D and 3D keypoints, people, clocks, videos, truth of virtual takes.
Outputs: results/figures/badminton_fig05, results/{session}/takes/{take}/figures/.
Steps: evaluate_detection, draw_badminton_fig05, draw_badminton_fig09, draw_badminton_fig10, draw_badminton_fig11.
"""


rule evaluate_detection:
    input:
        pose2d=each_camera(f"{TAKE}/pose2d/{{model}}/{{camera}}.npz"),
        take_truth=TRUE_TAKE,
        truth="results/virtual/{session}/truth.npz",
        skeleton=skeleton_file,
    output:
        errors="results/{session}/evaluation/takes/{take}/detection/{model}.csv",
    log:
        "results/{session}/logs/evaluate_detection/{take}.{model}.log",
    params:
        code=code("evaluate_detection.py"),
        labels=lambda w: dict(w.items()),
    script:
        "../scripts/evaluate_detection.py"


rule draw_badminton_fig05:
    input:
        errors=[f"{folder}/detection/{model}.csv" for folder, model in fig05_evaluations()],
        pose2d=[source["pose2d"] for source in fig05_sources()],
        videos=[source["video"] for source in fig05_sources()],
        skeleton=CONFIG
        / "skeletons"
        / f"{STUDY.models[STUDY.parameters['models'][0]].skeleton}.yaml",
    output:
        **drawn(
            "results/figures/badminton_fig05",
            "badminton_fig05",
            ("players", "detection"),
            {"figure": "badminton_fig05"},
        ),
    log:
        "results/figures/logs/draw_badminton_fig05/all.log",
    params:
        code=code("draw_badminton_fig05.py"),
        layouts=fig05_layouts(),
        sources=[source["name"] for source in fig05_sources()],
        blur_faces=True,
    script:
        "../scripts/draw_badminton_fig05.py"


rule draw_badminton_fig09:
    input:
        unpack(seen_and_made),
        measures=f"{TAKE}/kinematics/{FUSED}.frames.csv",
        court=lambda w: court_file(session_of(w)) or [],
    output:
        **fig_of_take("badminton_fig09"),
    log:
        f"results/{{session}}/logs/draw_badminton_fig09/{OF_FUSED}.log",
    params:
        code=code("draw_badminton_fig09.py"),
        step=stroke,
        blur_faces=blurred,
    script:
        "../scripts/draw_badminton_fig09.py"


rule draw_badminton_fig10:
    input:
        unpack(seen_and_made),
        court=lambda w: court_file(session_of(w)) or [],
    output:
        **fig_of_take("badminton_fig10"),
    log:
        f"results/{{session}}/logs/draw_badminton_fig10/{OF_FUSED}.log",
    params:
        code=code("draw_badminton_fig10.py"),
        step=lambda w: {**stroke(w), "n_instants": 3},
        blur_faces=blurred,
    script:
        "../scripts/draw_badminton_fig10.py"


rule draw_badminton_fig11:
    input:
        unpack(seen_and_made),
    output:
        **fig_of_take("badminton_fig11"),
    log:
        f"results/{{session}}/logs/draw_badminton_fig11/{OF_FUSED}.log",
    params:
        code=code("draw_badminton_fig11.py"),
        step=lambda w: {**stroke(w), "limit_torso": STUDY.parameters["draw_stroke"]["limit_torso"]},
        blur_faces=blurred,
    script:
        "../scripts/draw_badminton_fig11.py"
