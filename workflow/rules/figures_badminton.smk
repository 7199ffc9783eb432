"""Figures and the table of the badminton paper, drawn from sessions and takes; figure 8 with three cameras.

Inputs: errors against the truth, 2D and 3D keypoints, people, clocks, videos, truth of virtual takes.
Outputs: results/figures/, results/{session}/figures/, results/{session}/takes/{take}/figures/.
Steps: draw_badminton_fig05, 06, 08 to 12, draw_badminton_tab01, draw_three_cameras.
"""


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


rule draw_badminton_fig06:
    input:
        ties_npz=first_of_each_count("results/{session}/sfm/{variant}/ties.npz"),
        summary_json=first_of_each_count("results/{session}/sfm/{variant}/summary.json"),
        court_yaml=lambda w: court_file(session_of(w)),
    output:
        **drawn(
            "results/{session}/figures/badminton_fig06.{mapper}",
            "badminton_fig06",
            ("calibration", "{session}"),
            {"figure": "badminton_fig06", "mapper": "{mapper}"},
        ),
    log:
        "results/{session}/logs/draw_badminton_fig06/{mapper}.log",
    params:
        code=code("draw_badminton_fig06.py"),
        n_images=lambda w: session_of(w).parameters["sweep"]["n_images"],
    script:
        "../scripts/draw_badminton_fig06.py"


rule draw_badminton_fig08:
    input:
        errors_csv=lambda w: every_error([session_of(w)]),
    output:
        **session_figure("badminton_fig08"),
    log:
        "results/{session}/logs/draw_badminton_fig08/all.log",
    params:
        code=code("draw_badminton_fig08.py"),
    script:
        "../scripts/draw_badminton_fig08.py"


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


rule draw_badminton_fig12:
    input:
        lengths_csv=[f"results/{name}/evaluation/racket.csv" for name in racket_sessions()],
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


rule draw_badminton_tab01:
    input:
        rows_csv="results/{session}/evaluation/takes/{take}/round_trip/{calibration}.{model}.csv",
        published_csv=CONFIG / "published" / "badminton_tab01.csv",
    output:
        **drawn(
            f"{TAKE}/figures/badminton_tab01.{{calibration}}.{{model}}",
            "badminton_tab01",
            ("{session}", "{take}"),
            {"figure": "badminton_tab01", "calibration": "{calibration}", "network": "{model}"},
        ),
    log:
        "results/{session}/logs/draw_badminton_tab01/{take}.{calibration}.{model}.log",
    params:
        code=code("draw_badminton_tab01.py"),
        title=lambda w: f"{w.session}, {w.take}",
    script:
        "../scripts/draw_badminton_tab01.py"


rule draw_three_cameras:
    input:
        errors_csv=["results/{session}/evaluation/takes/{take}/errors/{calibration}.{model}.csv"],
        kinematics_csv=lambda w: [
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
