"""Sources of a take in one body frame: T-pose, unit, clocks; inertial ones corrected by vision.

Inputs: device motions and clocks. Outputs: results/{session}/takes/{take}/ devices (corrected), body.
Steps: correct_inertial, choose_tpose (for all sources of a take), align_bodies, measure_arcs.
"""


rule correct_inertial:
    input:
        bvh_file=lambda w: device_of(w).file,
        skeleton_yaml=CONFIG / "skeletons" / "mocopi27.yaml",
        vision_npz=lambda w: sources_of(w, corrected=False)[vision_of(w)][0],
        sync_json=f"{TAKE}/sync/devices.{{model}}.json",
    output:
        corrected_bvh=f"{TAKE}/devices/{{device}}-corrected.{{model}}.bvh",
        motion_npz=f"{TAKE}/devices/{{device}}-corrected.{{model}}.npz",
        report_json=f"{TAKE}/devices/{{device}}-corrected.{{model}}.json",
    log:
        "results/{session}/logs/correct_inertial/{take}.{device}.{model}.log",
    benchmark:
        "results/{session}/benchmarks/correct_inertial/{take}.{device}.{model}.tsv"
    params:
        code=code("correct_inertial.py"),
        step=correction_parameters,
    script:
        "../scripts/correct_inertial.py"


rule choose_tpose:
    input:
        device_npz=source_files,
        sync_json=f"{TAKE}/sync/devices.{{model}}.json",
    output:
        chosen_json=f"{TAKE}/sync/tpose.{{model}}.json",
    log:
        "results/{session}/logs/choose_tpose/{take}.{model}.log",
    params:
        code=code("choose_tpose.py"),
        step=lambda w: {"devices": clock_owners(w), "stated": list(take_of(w).clocks)},
    script:
        "../scripts/choose_tpose.py"


rule align_bodies:
    input:
        device_npz=lambda w: sources_of(w)[w.source][0],
        sync_json=f"{TAKE}/sync/devices.{{model}}.json",
        chosen_json=f"{TAKE}/sync/tpose.{{model}}.json",
        derived_yaml=CONFIG / "derived_joints.yaml",
    output:
        body_npz=f"{TAKE}/body/{{source}}.{{model}}.npz",
        frame_json=f"{TAKE}/body/{{source}}.{{model}}.json",
    log:
        "results/{session}/logs/align_bodies/{take}.{source}.{model}.log",
    params:
        code=code("align_bodies.py"),
        step=lambda w: {"skeleton": sources_of(w)[w.source][1], "like": clock_source(w)},
    script:
        "../scripts/align_bodies.py"


rule measure_arcs:
    input:
        body_npz=body_files_of,
    output:
        paths_csv=f"{TAKE}/body/arcs.{{model}}.paths.csv",
        distortion_csv=f"{TAKE}/body/arcs.{{model}}.distortion.csv",
    log:
        "results/{session}/logs/measure_arcs/{take}.{model}.log",
    params:
        code=code("measure_arcs.py"),
        step=step("measure_arcs"),
    script:
        "../scripts/measure_arcs.py"
