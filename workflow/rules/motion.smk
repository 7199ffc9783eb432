"""Metric skeletons and the files that other programs open.

Inputs: 2D keypoints, cameras. Outputs: results/{session}/takes/{take}/pose3d/, pose3d_filtered/.
Steps: triangulate (raw, always kept), filter_motion, export_take.
"""


rule triangulate:
    input:
        cameras="results/{session}/calibration/{calibration}/cameras.toml",
        pose2d=each_camera("results/{session}/takes/{take}/pose2d/{model}/{camera}.npz"),
        skeleton=skeleton_file,
    output:
        pose3d="results/{session}/takes/{take}/pose3d/{calibration}/{fusion}/{model}.npz",
    log:
        "results/{session}/logs/triangulate/{take}.{calibration}.{fusion}.{model}.log",
    benchmark:
        "results/{session}/benchmarks/triangulate/{take}.{calibration}.{fusion}.{model}.tsv"
    wildcard_constraints:
        fusion="all-robust",
    params:
        code=code("triangulate.py"),
        step=step("triangulate"),
        persons=lambda w: take_of(w).subjects,
    script:
        "../scripts/triangulate.py"


rule filter_motion:
    input:
        pose3d="results/{session}/takes/{take}/pose3d/{calibration}/{fusion}/{model}.npz",
        skeleton=skeleton_file,
    output:
        pose3d="results/{session}/takes/{take}/pose3d_filtered/{calibration}/{fusion}/{model}.npz",
    log:
        "results/{session}/logs/filter_motion/{take}.{calibration}.{fusion}.{model}.log",
    params:
        code=code("filter_motion.py"),
        step=step("filter_motion"),
    script:
        "../scripts/filter_motion.py"


rule export_take:
    input:
        pose3d="results/{session}/takes/{take}/{stage}/{calibration}/{fusion}/{model}.npz",
    output:
        trc="results/{session}/takes/{take}/{stage}/{calibration}/{fusion}/{model}.{person}.trc",
        c3d="results/{session}/takes/{take}/{stage}/{calibration}/{fusion}/{model}.{person}.c3d",
        csv="results/{session}/takes/{take}/{stage}/{calibration}/{fusion}/{model}.{person}.csv",
    log:
        "results/{session}/logs/export_take/{take}.{stage}.{calibration}.{fusion}.{model}.{person}.log",
    params:
        code=code("export_take.py"),
    script:
        "../scripts/export_take.py"
