"""Sources of a take in one body frame: T-pose, unit, clocks; inertial ones corrected by vision.

Inputs: device motions and clocks. Outputs: results/{session}/takes/{take}/ devices (corrected),
body.
Steps: correct_inertial, align_bodies (at the T-pose that all sources of a take show best),
measure_arcs.
"""


rule correct_inertial:
    input:
        device_npz=paths.DEVICE,
        skeleton_yaml=of_job(devices.skeleton_file),
        vision_npz=of_job(devices.vision_file),
        sync_json=paths.DEVICE_CLOCKS,
    output:
        corrected_bvh=paths.CORRECTED_BVH,
        corrected_glb=paths.CORRECTED_GLB,
        motion_npz=paths.CORRECTED_SOURCE,
        events_json=paths.CORRECTED_EVENTS,
        report_json=paths.CORRECTION_REPORT,
    log:
        "results/{session}/logs/correct_inertial/{take}.{device}.{model}.log",
    benchmark:
        "results/{session}/benchmarks/correct_inertial/{take}.{device}.{model}.tsv"
    params:
        code=code("correct_inertial.py"),
        step=of_job(devices.correction),
    script:
        "../scripts/correct_inertial.py"


rule align_bodies:
    input:
        device_npz=of_job(lambda job: devices.source(job).file),
        sync_json=paths.DEVICE_CLOCKS,
        events_json=of_job(devices.event_files),
        derived_yaml=CONFIG / paths.DERIVED_JOINTS_YAML,
    output:
        body_npz=paths.BODY,
        frame_json=paths.BODY_FRAME,
    log:
        "results/{session}/logs/align_bodies/{take}.{source}.{model}.log",
    params:
        code=code("align_bodies.py"),
        step=of_job(devices.alignment),
    script:
        "../scripts/align_bodies.py"


rule measure_arcs:
    input:
        body_npz=of_job(devices.bodies),
    output:
        paths_csv=paths.part(paths.ARCS, what="paths"),
        distortion_csv=paths.part(paths.ARCS, what="distortion"),
    log:
        "results/{session}/logs/measure_arcs/{take}.{model}.log",
    params:
        code=code("measure_arcs.py"),
        step=step("measure_arcs"),
    script:
        "../scripts/measure_arcs.py"
