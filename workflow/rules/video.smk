"""Pictures of the fixed cameras without people, and the frames of walks.

Inputs: videos of a session. Outputs: results/{session}/static/, frames/, takes/{take}/ movement,
shake, background.
Steps: extract_static (of a camera's `static` recording), extract_frames (of a walk), check_movement
(of a camera between its static recording and a take), measure_shake (within a take),
estimate_background (of a take whose camera has no static recording).
"""


rule extract_static:
    input:
        video_path=lambda w: session_of(w).cameras[w.camera].static,
    output:
        out_png=paths.STATIC,
        out_csv=paths.STATIC_CHECK,
    log:
        "results/{session}/logs/extract_static/{camera}.log",
    params:
        code=code("extract_static.py"),
        step=step("extract_static"),
    script:
        "../scripts/extract_static.py"


rule extract_frames:
    input:
        video_path=lambda w: whole(session_of(w).walks[w.walk]),
        photos=lambda w: recordings.inside(session_of(w).walks[w.walk]),
    output:
        folder=directory(paths.FRAMES),
        table_csv=paths.FRAME_TABLE,
    log:
        "results/{session}/logs/extract_frames/{walk}.log",
    benchmark:
        "results/{session}/benchmarks/extract_frames/{walk}.tsv"
    params:
        code=code("extract_frames.py"),
        # A virtual walk is filmed on the grid's frames only.
        step=lambda w: {"every_frame": 1} if session_of(w).virtual else step("extract_frames")(w),
    script:
        "../scripts/extract_frames.py"


rule check_movement:
    input:
        static_png=paths.STATIC,
        video_path=lambda w: take_of(w).videos[w.camera],
    output:
        movement_csv=paths.MOVEMENT,
    log:
        "results/{session}/logs/check_movement/{take}.{camera}.log",
    params:
        code=code("check_movement.py"),
        step=step("extract_static"),
        trim_s=lambda w: take_of(w).trim_s,
    script:
        "../scripts/check_movement.py"


rule measure_shake:
    input:
        static_png=paths.STATIC,
        video_path=lambda w: take_of(w).videos[w.camera],
    output:
        shake_csv=paths.SHAKE,
    log:
        "results/{session}/logs/measure_shake/{take}.{camera}.log",
    benchmark:
        "results/{session}/benchmarks/measure_shake/{take}.{camera}.tsv"
    params:
        code=code("measure_shake.py"),
        trim_s=lambda w: take_of(w).trim_s,
    script:
        "../scripts/measure_shake.py"


rule estimate_background:
    input:
        source=lambda w: take_of(w).videos[w.camera],
    output:
        background_png=paths.BACKGROUND,
    log:
        "results/{session}/logs/estimate_background/{take}.{camera}.log",
    benchmark:
        "results/{session}/benchmarks/estimate_background/{take}.{camera}.tsv"
    priority: 50  # for check_videos and check_court
    params:
        code=code("estimate_background.py"),
        step=step("estimate_background"),
        trim_s=lambda w: take_of(w).trim_s,
    script:
        "../scripts/estimate_background.py"
