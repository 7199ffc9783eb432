"""Figures and the table of the badminton paper; its comparison with three cameras.

Inputs: errors against the truth, 2D and 3D keypoints, people, clocks, videos, truth of virtual
takes.
Outputs: results/figures/, results/{session}/figures/, results/{session}/takes/{take}/figures/.
Steps: draw_badminton_fig05, 06, 08 to 12, draw_badminton_tab01, draw_three_cameras.
"""


rule draw_badminton_fig05:
    input:
        errors=figures.fig05_errors(STUDY),
        pose2d=[source["pose2d"] for source in figures.fig05_sources(STUDY)],
        videos=[source["video"] for source in figures.fig05_sources(STUDY)],
        skeleton=STUDY.skeleton_file(STUDY.parameters["models"][0]),
    output:
        **study_figure("badminton_fig05", "badminton_fig05", ("players", "detection")),
    log:
        "results/figures/logs/draw_badminton_fig05/all.log",
    params:
        code=code("draw_badminton_fig05.py"),
        layouts=targets.together.fig05_layouts(STUDY),
        sources=[source["name"] for source in figures.fig05_sources(STUDY)],
        blur_faces=True,
    script:
        "../scripts/draw_badminton_fig05.py"


rule draw_badminton_fig06:
    input:
        ties_npz=of_job(figures.of_each_count, paths.TIES),
        summary_json=of_job(figures.of_each_count, paths.SFM_SUMMARY),
        court_yaml=of_job(Job.court_file),
    output:
        **session_figure(
            "badminton_fig06.{mapper}",
            "badminton_fig06",
            figure="badminton_fig06",
            mapper="{mapper}",
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
        errors_csv=lambda w: targets.calibration.every_error([session_of(w)]),
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
        unpack(of_job(figures.seen_and_made)),
        measures=paths.FRAME_MEASURES,
        court=of_job(Job.court_file),
    output:
        **figure("badminton_fig09"),
    log:
        f"results/{{session}}/logs/draw_badminton_fig09/{paths.OF_FUSED}.log",
    params:
        code=code("draw_badminton_fig09.py"),
        step=of_job(figures.stroke),
        blur_faces=of_job(takes.blur_faces),
    script:
        "../scripts/draw_badminton_fig09.py"


rule draw_badminton_fig10:
    input:
        unpack(of_job(figures.seen_and_made)),
        court=of_job(Job.court_file),
    output:
        **figure("badminton_fig10"),
    log:
        f"results/{{session}}/logs/draw_badminton_fig10/{paths.OF_FUSED}.log",
    params:
        code=code("draw_badminton_fig10.py"),
        step=of_job(figures.stroke, n_instants=3),
        blur_faces=of_job(takes.blur_faces),
    script:
        "../scripts/draw_badminton_fig10.py"


rule draw_badminton_fig11:
    input:
        unpack(of_job(figures.seen_and_made)),
    output:
        **figure("badminton_fig11"),
    log:
        f"results/{{session}}/logs/draw_badminton_fig11/{paths.OF_FUSED}.log",
    params:
        code=code("draw_badminton_fig11.py"),
        step=of_job(figures.stroke, limit_torso=STUDY.parameters["draw_stroke"]["limit_torso"]),
        blur_faces=of_job(takes.blur_faces),
    script:
        "../scripts/draw_badminton_fig11.py"


rule draw_badminton_fig12:
    input:
        lengths_csv=expand(paths.RACKET_LENGTHS, session=targets.calibration.racket_sessions(STUDY)),
    output:
        **study_figure("badminton_fig12", "badminton_fig12", ("calibration", "racket")),
    log:
        "results/figures/logs/draw_badminton_fig12/all.log",
    params:
        code=code("draw_badminton_fig12.py"),
        length_m=STUDY.parameters["evaluate_racket"]["length_m"],
    script:
        "../scripts/draw_badminton_fig12.py"


rule draw_badminton_tab01:
    input:
        rows_csv=paths.ROUND_TRIP,
        published_csv=CONFIG / paths.PUBLISHED_CSV.format(table="badminton_tab01"),
    output:
        **calibrated_figure("badminton_tab01", "badminton_tab01"),
    log:
        "results/{session}/logs/draw_badminton_tab01/{take}.{calibration}.{model}.log",
    params:
        code=code("draw_badminton_tab01.py"),
        title=lambda w: f"{w.session}, {w.take}",
    script:
        "../scripts/draw_badminton_tab01.py"


rule draw_three_cameras:
    input:
        errors_csv=[paths.ERRORS],
        kinematics_csv=of_job(takes.every_fused, paths.MEASURE_ERRORS),
    output:
        **calibrated_figure("three_cameras", "three cameras"),
    log:
        "results/{session}/logs/draw_three_cameras/{take}.{calibration}.{model}.log",
    params:
        code=code("draw_three_cameras.py"),
        cameras=of_job(figures.fused_cameras),
    script:
        "../scripts/draw_three_cameras.py"
