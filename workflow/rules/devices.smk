"""Devices beside the fixed cameras, or alone: mocopi, depth cameras, single videos, Nuitrack.

Inputs: recordings of devices. Outputs: results/{session}/takes/{take}/ devices, sync.
Steps: import_device, export_device (of inertial suits), export_source (of others), extract_colour,
convert_landmarks, lift_depth, select_person (of the fixed cameras), fit_source (the skeletal model,
to any but these), detect_events (whatever happens to the clocks), synchronise_devices.
"""


rule import_device:
    input:
        recording=lambda w: whole(device_of(w).file),
        files=lambda w: recordings.inside(device_of(w).file),
        skeleton_yaml=of_job(devices.skeleton_file),
    output:
        motion_npz=paths.DEVICE,
    log:
        "results/{session}/logs/import_device/{take}.{device}.log",
    params:
        code=code("import_device.py"),
        kind=lambda w: device_of(w).kind,
        unit=lambda w: device_of(w).unit,
        angles=lambda w: device_of(w).angles,
    script:
        "../scripts/import_device.py"


rule export_device:
    input:
        device_npz=of_job(devices.exported),
        skeleton_yaml=of_job(devices.skeleton_file),
    output:
        trc_path=paths.part(paths.DEVICE_EXPORT, suffix="trc"),
        c3d_path=paths.part(paths.DEVICE_EXPORT, suffix="c3d"),
        csv_path=paths.part(paths.DEVICE_EXPORT, suffix="csv"),
        bvh_path=paths.part(paths.DEVICE_EXPORT, suffix="bvh"),
        glb_path=paths.part(paths.DEVICE_EXPORT, suffix="glb"),
    log:
        "results/{session}/logs/export_device/{take}.{device}.log",
    params:
        code=code("export_device.py"),
        person=lambda w: take_of(w).person_of_devices,
    script:
        "../scripts/export_device.py"


rule export_source:
    input:
        device_npz=of_job(devices.exported_source),
        skeleton_yaml=of_job(devices.source_skeleton),
    output:
        bvh_path=paths.part(paths.SOURCE_EXPORT, suffix="bvh"),
        glb_path=paths.part(paths.SOURCE_EXPORT, suffix="glb"),
    log:
        "results/{session}/logs/export_source/{take}.{source}.{model}.log",
    wildcard_constraints:
        source=rf"(?!cameras\.){NAME}(?<!-corrected)",
    params:
        code=code("export_source.py"),
        person=lambda w: take_of(w).person_of_devices,
    script:
        "../scripts/export_source.py"


rule extract_colour:
    input:
        recording=lambda w: whole(device_of(w).file),
        files=lambda w: recordings.inside(device_of(w).file),
    output:
        video=paths.COLOUR_VIDEO,
        frames_csv=paths.COLOUR_FRAMES,
        camera_toml=paths.COLOUR_CAMERA,
    log:
        "results/{session}/logs/extract_colour/{take}.{device}.log",
    benchmark:
        "results/{session}/benchmarks/extract_colour/{take}.{device}.tsv"
    params:
        code=code("extract_colour.py"),
        step=step("extract_colour"),
    script:
        "../scripts/extract_colour.py"


rule convert_landmarks:
    input:
        pose2d_npz=paths.part(paths.POSE2D, camera="{device}"),
        frames_csv=of_job(devices.colour_frames),
    output:
        device_npz=paths.RGB_SOURCE,
    log:
        "results/{session}/logs/convert_landmarks/{take}.{device}.{model}.log",
    params:
        code=code("convert_landmarks.py"),
        source=lambda w: f"{w.device}-rgb",
    script:
        "../scripts/convert_landmarks.py"


rule lift_depth:
    input:
        recording=lambda w: whole(device_of(w).file),
        files=lambda w: recordings.inside(device_of(w).file),
        pose2d=paths.part(paths.POSE2D, camera="{device}"),
        frames=of_job(devices.colour_frames),
        skeleton=of_job(Job.skeleton_file),
    output:
        device_npz=paths.DEPTH_SOURCE,
    log:
        "results/{session}/logs/lift_depth/{take}.{device}.{model}.log",
    benchmark:
        "results/{session}/benchmarks/lift_depth/{take}.{device}.{model}.tsv"
    params:
        code=code("lift_depth.py"),
        source=lambda w: f"{w.device}-depth",
        step=step("lift_depth"),
    script:
        "../scripts/lift_depth.py"


rule select_person:
    input:
        pose3d_npz=of_job(devices.fused),
    output:
        device_npz=paths.CAMERA_SOURCE,
    log:
        "results/{session}/logs/select_person/{take}.{model}.log",
    params:
        code=code("select_person.py"),
        person=lambda w: take_of(w).person_of_devices,
    script:
        "../scripts/select_person.py"


rule fit_source:
    input:
        device_npz=of_job(lambda job: devices.source(job).file),
        skeleton_yaml=of_job(devices.source_skeleton),
    output:
        joints_npz=paths.FITTED_SOURCE,
        motion_npz=paths.SOURCE_MOTION,
        angles_csv=paths.SOURCE_ANGLES,
    log:
        "results/{session}/logs/fit_source/{take}.{source}.{model}.log",
    benchmark:
        "results/{session}/benchmarks/fit_source/{take}.{source}.{model}.tsv"
    wildcard_constraints:
        source=f"(?!cameras/){NAME}",
    params:
        code=code("fit_source.py"),
        step=of_job(devices.fitting),
    script:
        "../scripts/fit_source.py"


rule detect_events:
    input:
        device_npz=of_job(devices.source_files, corrected=False),
    output:
        events_json=paths.EVENTS,
        wrists_csv=paths.part(paths.WRISTS, clocks="events"),
        events_csv=paths.OWN_EVENTS,
    log:
        "results/{session}/logs/detect_events/{take}.{model}.log",
    params:
        code=code("detect_events.py"),
    script:
        "../scripts/detect_events.py"


rule synchronise_devices:
    input:
        device_npz=of_job(devices.source_files, corrected=False),
        events_json=paths.EVENTS,
    output:
        sync_json=paths.DEVICE_CLOCKS,
        wrists_csv=paths.part(paths.WRISTS, clocks="devices"),
        events_csv=paths.DEVICE_EVENTS,
        checks_csv=paths.DEVICE_CHECKS,
    log:
        "results/{session}/logs/synchronise_devices/{take}.{model}.log",
    params:
        code=code("synchronise_devices.py"),
        devices=of_job(devices.clocks, corrected=False),
        stated=of_job(devices.stated_clocks),
        step=step("synchronise_devices"),
    script:
        "../scripts/synchronise_devices.py"
