"""Devices of their own beside the fixed cameras, or alone: mocopi, depth cameras, single videos, Nuitrack.

Inputs: recordings of devices. Outputs: results/{session}/takes/{take}/ devices, sync.
Steps: import_device, extract_colour, convert_landmarks, lift_depth, select_person (of the fixed cameras),
synchronise_devices, list_events (whatever happens to the clocks).
"""


rule import_device:
    input:
        recording=lambda w: whole(device_of(w).file),
        files=lambda w: inside(device_of(w).file),
        skeleton_yaml=device_skeleton,
    output:
        motion_npz=f"{TAKE}/devices/{{device}}.npz",
    log:
        "results/{session}/logs/import_device/{take}.{device}.log",
    params:
        code=code("import_device.py"),
        kind=lambda w: device_of(w).kind,
    script:
        "../scripts/import_device.py"


rule extract_colour:
    input:
        recording=lambda w: whole(device_of(w).file),
        files=lambda w: inside(device_of(w).file),
    output:
        video=f"{TAKE}/devices/{{device}}.mp4",
        frames_csv=f"{TAKE}/devices/{{device}}.frames.csv",
        camera_toml=f"{TAKE}/devices/{{device}}.toml",
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
        pose2d_npz=f"{TAKE}/pose2d/{{model}}/{{device}}.npz",
        frames_csv=lambda w: colour_file(w, "frames.csv"),
    output:
        device_npz=f"{TAKE}/devices/{{device}}-rgb.{{model}}.npz",
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
        files=lambda w: inside(device_of(w).file),
        pose2d=f"{TAKE}/pose2d/{{model}}/{{device}}.npz",
        frames=lambda w: colour_file(w, "frames.csv"),
        skeleton=skeleton_file,
    output:
        device_npz=f"{TAKE}/devices/{{device}}-depth.{{model}}.npz",
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
        pose3d_npz=fused_file,
    output:
        device_npz=f"{TAKE}/devices/cameras.{{model}}.npz",
    log:
        "results/{session}/logs/select_person/{take}.{model}.log",
    params:
        code=code("select_person.py"),
        person=worn_by,
    script:
        "../scripts/select_person.py"


rule synchronise_devices:
    input:
        device_npz=lambda w: source_files(w, corrected=False),
    output:
        sync_json=f"{TAKE}/sync/devices.{{model}}.json",
        wrists_csv=f"{TAKE}/sync/devices.{{model}}.wrists.csv",
        events_csv=f"{TAKE}/sync/devices.{{model}}.events.csv",
        checks_csv=f"{TAKE}/sync/devices.{{model}}.checks.csv",
    log:
        "results/{session}/logs/synchronise_devices/{take}.{model}.log",
    params:
        code=code("synchronise_devices.py"),
        devices=lambda w: clock_owners(w, corrected=False),
        stated=lambda w: stated_clocks(w, take_of(w).devices),
        step=step("synchronise_devices"),
    script:
        "../scripts/synchronise_devices.py"


rule list_events:
    input:
        device_npz=lambda w: source_files(w, corrected=False),
    output:
        wrists_csv=f"{TAKE}/sync/events.{{model}}.wrists.csv",
        events_csv=f"{TAKE}/sync/events.{{model}}.csv",
    log:
        "results/{session}/logs/list_events/{take}.{model}.log",
    params:
        code=code("list_events.py"),
    script:
        "../scripts/list_events.py"
