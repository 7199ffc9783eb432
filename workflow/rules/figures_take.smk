"""Figures of a take: what was seen, what was made of it, and how far to trust it.

Inputs: 2D and 3D keypoints, cameras, videos. Outputs: results/{session}/takes/{take}/figures/.
Steps: draw_overlay, draw_skeletons, draw_reprojection, draw_visibility, draw_kinematics, draw_shake.
"""


rule draw_overlay:
    input:
        pose3d="results/{session}/takes/{take}/pose3d/{calibration}/{fusion}/{model}.npz",
        pose2d=each_camera("results/{session}/takes/{take}/pose2d/{model}/{camera}.npz"),
        people=f"{TAKE}/people/{{calibration}}/{{model}}.npz",
        sync=f"{TAKE}/sync/{{calibration}}/cameras.{{model}}.json",
        cameras="results/{session}/calibration/{calibration}/cameras.toml",
        videos=lambda w: list(take_of(w).videos.values()),
        skeleton=skeleton_file,
    output:
        **figure("overlay"),
    log:
        "results/{session}/logs/draw_overlay/{take}.{calibration}.{fusion}.{model}.log",
    params:
        code=code("draw_overlay.py"),
        step=step("draw_overlay"),
        blur_faces=blurred,
    script:
        "../scripts/draw_overlay.py"


rule draw_skeletons:
    input:
        pose3d_npz="results/{session}/takes/{take}/pose3d/{calibration}/{fusion}/{model}.npz",
        cameras_toml="results/{session}/calibration/{calibration}/cameras.toml",
        skeleton_yaml=skeleton_file,
    output:
        **figure("skeletons"),
    log:
        "results/{session}/logs/draw_skeletons/{take}.{calibration}.{fusion}.{model}.log",
    params:
        code=code("draw_skeletons.py"),
    script:
        "../scripts/draw_skeletons.py"


rule draw_reprojection:
    input:
        pose3d_npz="results/{session}/takes/{take}/pose3d/{calibration}/{fusion}/{model}.npz",
    output:
        **figure("reprojection"),
    log:
        "results/{session}/logs/draw_reprojection/{take}.{calibration}.{fusion}.{model}.log",
    params:
        code=code("draw_reprojection.py"),
    script:
        "../scripts/draw_reprojection.py"


rule draw_visibility:
    input:
        pose3d="results/{session}/takes/{take}/pose3d/{calibration}/{fusion}/{model}.npz",
        pose2d=each_camera("results/{session}/takes/{take}/pose2d/{model}/{camera}.npz"),
        people=f"{TAKE}/people/{{calibration}}/{{model}}.npz",
        sync=f"{TAKE}/sync/{{calibration}}/cameras.{{model}}.json",
        skeleton=skeleton_file,
    output:
        **figure("visibility"),
    log:
        "results/{session}/logs/draw_visibility/{take}.{calibration}.{fusion}.{model}.log",
    params:
        code=code("draw_visibility.py"),
    script:
        "../scripts/draw_visibility.py"


rule draw_kinematics:
    input:
        frames_csv=f"{TAKE}/kinematics/{FUSED}.frames.csv",
        summary_csv=f"{TAKE}/kinematics/{FUSED}.summary.csv",
        court_yaml=lambda w: court_file(session_of(w)) or [],
    output:
        **figure("kinematics"),
    log:
        f"results/{{session}}/logs/draw_kinematics/{OF_FUSED}.log",
    params:
        code=code("draw_kinematics.py"),
    script:
        "../scripts/draw_kinematics.py"


rule draw_shake:
    input:
        cameras="results/{session}/calibration/{calibration}/cameras.toml",
        shake=each_camera(f"{TAKE}/shake/{{camera}}.csv"),
        pose3d=f"{TAKE}/pose3d/{FUSED}.npz",
    output:
        **figure("shake"),
        text_path=f"{TAKE}/figures/shake.{{calibration}}.{{fusion}}.{{model}}.txt",
    log:
        f"results/{{session}}/logs/draw_shake/{OF_FUSED}.log",
    params:
        code=code("draw_shake.py"),
    script:
        "../scripts/draw_shake.py"
