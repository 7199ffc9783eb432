"""Figures of a take: detections, skeletons, measures, and their reliability.

Inputs: 2D and 3D keypoints, cameras, videos. Outputs: results/{session}/takes/{take}/figures/.
Steps: draw_overlay, draw_skeletons, draw_reprojection, draw_visibility, draw_kinematics,
draw_footwork, draw_rally, draw_strokes, draw_shake.
"""


rule draw_overlay:
    input:
        pose3d=paths.POSE3D,
        pose2d=of_job(takes.each_camera, paths.POSE2D),
        shake=of_job(takes.shake),
        people=paths.PEOPLE,
        sync=paths.CAMERA_CLOCKS,
        cameras=paths.CAMERAS,
        videos=lambda w: list(take_of(w).videos.values()),
        skeleton=of_job(Job.skeleton_file),
    output:
        **figure("overlay"),
    log:
        "results/{session}/logs/draw_overlay/{take}.{calibration}.{fusion}.{model}.log",
    params:
        code=code("draw_overlay.py"),
        step=step("draw_overlay"),
        blur_faces=of_job(takes.blur_faces),
    script:
        "../scripts/draw_overlay.py"


rule draw_skeletons:
    input:
        pose3d_npz=paths.POSE3D,
        cameras_toml=paths.CAMERAS,
        skeleton_yaml=of_job(Job.skeleton_file),
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
        pose3d_npz=paths.POSE3D,
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
        pose3d=paths.POSE3D,
        pose2d=of_job(takes.each_camera, paths.POSE2D),
        people=paths.PEOPLE,
        sync=paths.CAMERA_CLOCKS,
        cameras=paths.CAMERAS,
        skeleton=of_job(Job.skeleton_file),
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
        frames_csv=paths.FRAME_MEASURES,
        summary_csv=paths.MEASURES,
        court_yaml=of_job(Job.court_file),
    output:
        **figure("kinematics"),
    log:
        f"results/{{session}}/logs/draw_kinematics/{paths.OF_FUSED}.log",
    params:
        code=code("draw_kinematics.py"),
    script:
        "../scripts/draw_kinematics.py"


rule draw_footwork:
    input:
        contacts_npz=paths.CONTACTS,
        steps_csv=paths.STEPS,
        events_csv=paths.FOOT_EVENTS,
        court_yaml=of_job(Job.court_file),
    output:
        **figure("footwork"),
    log:
        f"results/{{session}}/logs/draw_footwork/{paths.OF_FUSED}.log",
    params:
        code=code("draw_footwork.py"),
    script:
        "../scripts/draw_footwork.py"


rule draw_rally:
    input:
        strokes_csv=paths.STROKES,
        events_csv=paths.FOOT_EVENTS,
        pose3d_npz=of_job(takes.measured),
    output:
        **figure("rally"),
    log:
        f"results/{{session}}/logs/draw_rally/{paths.OF_FUSED}.log",
    params:
        code=code("draw_rally.py"),
    script:
        "../scripts/draw_rally.py"


rule draw_strokes:
    input:
        strokes_csv=paths.STROKES,
        pose3d_npz=of_job(takes.measured),
    output:
        **figure("strokes"),
    log:
        f"results/{{session}}/logs/draw_strokes/{paths.OF_FUSED}.log",
    params:
        code=code("draw_strokes.py"),
    script:
        "../scripts/draw_strokes.py"


rule draw_shake:
    input:
        cameras=paths.CAMERAS,
        shake=of_job(takes.each_camera, paths.SHAKE),
        pose3d=paths.POSE3D,
    output:
        **figure("shake"),
        text_path=paths.SHAKE_TEXT,
    log:
        f"results/{{session}}/logs/draw_shake/{paths.OF_FUSED}.log",
    params:
        code=code("draw_shake.py"),
    script:
        "../scripts/draw_shake.py"
