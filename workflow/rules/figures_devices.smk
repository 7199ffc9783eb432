"""Figures of devices: the thesis's, and what it could not show.

Inputs: body motions, events, errors. Outputs: results/{session}/takes/{take}/figures/,
results/figures/.
Steps: draw_wrist_distance, draw_wrist_arcs, draw_skeleton_plates, draw_source_errors,
draw_thesis_fig3, draw_smoothness.
"""


rule draw_wrist_distance:
    input:
        wrists_csv=paths.WRISTS,
        events_csv=of_job(devices.events),
    output:
        **device_figure("wrist_distance.{clocks}", "wrist_distance"),
    log:
        "results/{session}/logs/draw_wrist_distance/{take}.{clocks}.{model}.log",
    wildcard_constraints:
        clocks="devices|events",
    params:
        code=code("draw_wrist_distance.py"),
        aligned=lambda w: w.clocks == "devices",
        kinds=of_job(devices.kinds),
    script:
        "../scripts/draw_wrist_distance.py"


rule draw_wrist_arcs:
    input:
        paths_csv=paths.part(paths.ARCS, what="paths"),
        distortion_csv=paths.part(paths.ARCS, what="distortion"),
        truth_csv=of_job(Job.true_file, paths.TRUE_PATHS),
    output:
        **device_figure("wrist_arcs", "wrist_arcs"),
    log:
        "results/{session}/logs/draw_wrist_arcs/{take}.{model}.log",
    params:
        code=code("draw_wrist_arcs.py"),
        kinds=of_job(devices.kinds),
    script:
        "../scripts/draw_wrist_arcs.py"


rule draw_skeleton_plates:
    input:
        body_npz=of_job(devices.bodies),
        skeleton_yaml=of_job(devices.plates),
        derived_yaml=CONFIG / paths.DERIVED_JOINTS_YAML,
    output:
        **device_figure("skeleton_plates", "skeleton_plates"),
    log:
        "results/{session}/logs/draw_skeleton_plates/{take}.{model}.log",
    params:
        code=code("draw_skeleton_plates.py"),
        skeletons=of_job(devices.skeletons),
        kinds=of_job(devices.kinds),
    script:
        "../scripts/draw_skeleton_plates.py"


rule draw_source_errors:
    input:
        errors_csv=paths.SOURCE_ERRORS,
        angles_csv=paths.SOURCE_ANGLE_ERRORS,
        parts_csv=paths.ERROR_PARTS,
    output:
        **device_figure("source_errors", "source_errors"),
    log:
        "results/{session}/logs/draw_source_errors/{take}.{model}.log",
    params:
        code=code("draw_source_errors.py"),
        kinds=of_job(devices.kinds),
    script:
        "../scripts/draw_source_errors.py"


rule draw_thesis_fig3:
    input:
        paths_csv=lambda w: devices.thesis_file(STUDY, "paths"),
        distortion_csv=lambda w: devices.thesis_file(STUDY, "distortion"),
        truth_csv=lambda w: devices.thesis_truth(STUDY),
    output:
        **study_figure("thesis_fig3_{number}", "thesis_fig3", ("single view", "thesis")),
    log:
        "results/figures/logs/draw_thesis_fig3/{number}.log",
    wildcard_constraints:
        number="1|2",
    params:
        code=code("draw_thesis_fig3.py"),
        source=lambda w: STUDY.parameters["draw_thesis_fig3"]["sources"][int(w.number) - 1],
        kinds=devices.all_kinds(STUDY),
    script:
        "../scripts/draw_thesis_fig3.py"


rule draw_smoothness:
    input:
        distortion_csv=[
            one.file(paths.ARCS, what="distortion") for one in targets.devices.device_takes(STUDY)
        ],
        errors_csv=targets.devices.every_true_file(STUDY, paths.SOURCE_ERRORS),
        truth_csv=targets.devices.every_true_file(STUDY, paths.TRUE_DISTORTION),
    output:
        **study_figure("smoothness", "smoothness", ("single view", "sources")),
    log:
        "results/figures/logs/draw_smoothness/all.log",
    params:
        code=code("draw_smoothness.py"),
        labels=[one.labels for one in targets.devices.device_takes(STUDY)],
        kinds=devices.all_kinds(STUDY),
    script:
        "../scripts/draw_smoothness.py"
