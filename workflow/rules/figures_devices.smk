"""Figures of devices: the thesis's, and what it could not show.

Inputs: body motions, events, errors. Outputs: results/{session}/takes/{take}/figures/, results/figures/.
Steps: draw_wrist_distance, draw_wrist_arcs, draw_skeleton_plates,
draw_source_errors, draw_thesis_fig3, draw_smoothness.
"""


rule draw_wrist_distance:
    input:
        wrists_csv=f"{TAKE}/sync/{{clocks}}.{{model}}.wrists.csv",
        events_csv=events_file,
    output:
        **device_figure("wrist_distance.{clocks}", "wrist_distance"),
    log:
        "results/{session}/logs/draw_wrist_distance/{take}.{clocks}.{model}.log",
    wildcard_constraints:
        clocks="devices|events",
    params:
        code=code("draw_wrist_distance.py"),
        aligned=lambda w: w.clocks == "devices",
        kinds=kinds_of,
    script:
        "../scripts/draw_wrist_distance.py"


rule draw_wrist_arcs:
    input:
        paths_csv=f"{TAKE}/body/arcs.{{model}}.paths.csv",
        distortion_csv=f"{TAKE}/body/arcs.{{model}}.distortion.csv",
        truth_csv=lambda w: true_arcs(w, "paths"),
    output:
        **device_figure("wrist_arcs", "wrist_arcs"),
    log:
        "results/{session}/logs/draw_wrist_arcs/{take}.{model}.log",
    params:
        code=code("draw_wrist_arcs.py"),
        kinds=kinds_of,
    script:
        "../scripts/draw_wrist_arcs.py"


rule draw_skeleton_plates:
    input:
        body_npz=body_files_of,
        skeleton_yaml=plate_skeletons,
        derived_yaml=CONFIG / "derived_joints.yaml",
    output:
        **device_figure("skeleton_plates", "skeleton_plates"),
    log:
        "results/{session}/logs/draw_skeleton_plates/{take}.{model}.log",
    params:
        code=code("draw_skeleton_plates.py"),
        skeletons=lambda w: {s: skeleton for s, (_, skeleton, _) in sources_of(w).items()},
        kinds=kinds_of,
    script:
        "../scripts/draw_skeleton_plates.py"


rule draw_source_errors:
    input:
        errors_csv="results/{session}/evaluation/takes/{take}/sources/{model}.errors.csv",
        parts_csv="results/{session}/evaluation/takes/{take}/sources/{model}.parts.csv",
    output:
        **device_figure("source_errors", "source_errors"),
    log:
        "results/{session}/logs/draw_source_errors/{take}.{model}.log",
    params:
        code=code("draw_source_errors.py"),
        kinds=kinds_of,
    script:
        "../scripts/draw_source_errors.py"


rule draw_thesis_fig3:
    input:
        paths_csv=lambda w: thesis_file(w, "paths"),
        distortion_csv=lambda w: thesis_file(w, "distortion"),
        truth_csv=thesis_truth,
    output:
        **drawn(
            "results/figures/thesis_fig3_{number}",
            "thesis_fig3",
            ("single view", "thesis"),
            {"figure": "thesis_fig3_{number}"},
        ),
    log:
        "results/figures/logs/draw_thesis_fig3/{number}.log",
    wildcard_constraints:
        number="1|2",
    params:
        code=code("draw_thesis_fig3.py"),
        source=lambda w: STUDY.parameters["draw_thesis_fig3"]["sources"][int(w.number) - 1],
        kinds=all_kinds(),
    script:
        "../scripts/draw_thesis_fig3.py"


rule draw_smoothness:
    input:
        distortion_csv=[row["distortion"] for row in smoothed_takes()],
        errors_csv=[row["errors"] for row in smoothed_takes() if row["errors"]],
        truth_csv=[row["truth"] for row in smoothed_takes() if row["truth"]],
    output:
        **drawn(
            "results/figures/smoothness",
            "smoothness",
            ("single view", "sources"),
            {"figure": "smoothness"},
        ),
    log:
        "results/figures/logs/draw_smoothness/all.log",
    params:
        code=code("draw_smoothness.py"),
        labels=[row["labels"] for row in smoothed_takes()],
        kinds=all_kinds(),
    script:
        "../scripts/draw_smoothness.py"
