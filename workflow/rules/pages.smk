"""Pages and videos to look around in: a viewer per take, the skeleton burnt into videos, other programs' projects.

Inputs: 3D keypoints of all stages, devices, cameras, videos. Outputs: results/{session}/takes/{take}/pages/, videos/,
pose2sim/.
Steps: build_viewer, export_overlay_video, export_pose2sim.
"""


rule build_viewer:
    input:
        layers=lambda w: [layer["file"] for layer in viewer_layers(w)],
        skeletons=lambda w: [CONFIG / "skeletons" / f"{name}.yaml" for name in layer_skeletons(w)],
        cameras=viewed_cameras,
        court=viewed_court,
        clocks=device_clocks,
        assets=sorted(ASSETS.glob("[pv]*")),
    output:
        html=f"{TAKE}/pages/viewer.{{model}}.html",
    log:
        "results/{session}/logs/build_viewer/{take}.{model}.log",
    params:
        code=code("build_viewer.py"),
        title=lambda w: f"{w.session}, {w.take}",
        layers=lambda w: [
            {key: value for key, value in layer.items() if key != "file"}
            for layer in viewer_layers(w)
        ],
    script:
        "../scripts/build_viewer.py"


rule export_overlay_video:
    input:
        pose3d=f"{TAKE}/pose3d/{FUSED}.npz",
        pose2d=f"{TAKE}/pose2d/{{model}}/{{camera}}.npz",
        people=f"{TAKE}/people/{{calibration}}/{{model}}.npz",
        sync=f"{TAKE}/sync/{{calibration}}/cameras.{{model}}.json",
        cameras="results/{session}/calibration/{calibration}/cameras.toml",
        video=lambda w: take_of(w).videos[w.camera],
        skeleton=skeleton_file,
    output:
        mp4=f"{TAKE}/videos/{FUSED}.{{camera}}.mp4",
    log:
        f"results/{{session}}/logs/export_overlay_video/{OF_FUSED}.{{camera}}.log",
    benchmark:
        f"results/{{session}}/benchmarks/export_overlay_video/{OF_FUSED}.{{camera}}.tsv"
    params:
        code=code("export_overlay_video.py"),
        step=overlay_parameters,
        blur_faces=blurred,
        trim_s=lambda w: take_of(w).trim_s,
    script:
        "../scripts/export_overlay_video.py"


rule export_pose2sim:
    input:
        pose3d=exported,
        pose2d=each_camera(f"{TAKE}/pose2d/{{model}}/{{camera}}.npz"),
        people=f"{TAKE}/people/{{calibration}}/{{model}}.npz",
        sync=f"{TAKE}/sync/{{calibration}}/cameras.{{model}}.json",
        cameras="results/{session}/calibration/{calibration}/cameras.toml",
        skeleton=skeleton_file,
    output:
        folder=directory(f"{TAKE}/pose2sim/{FUSED}"),
    log:
        f"results/{{session}}/logs/export_pose2sim/{OF_FUSED}.log",
    params:
        code=code("export_pose2sim.py"),
    script:
        "../scripts/export_pose2sim.py"
