"""2D keypoints of each camera.

Inputs: a take's videos, networks, backgrounds. Outputs: results/{session}/takes/{take}/pose2d/.
Steps: detect_pose.
"""


rule detect_pose:
    input:
        video=video_of,
        background=background_file,
        detector="results/networks/{model}/detector.onnx",
        landmarks="results/networks/{model}/landmarks.onnx",
        skeleton=skeleton_file,
    output:
        pose2d="results/{session}/takes/{take}/pose2d/{model}/{camera}.npz",
    log:
        "results/{session}/logs/detect_pose/{take}.{model}.{camera}.log",
    benchmark:
        "results/{session}/benchmarks/detect_pose/{take}.{model}.{camera}.tsv"
    params:
        code=code("detect_pose.py"),
        step=step("detect_pose"),
        redetect=lambda w: not STUDY.models[w.model].tracking,
        decoder=lambda w: STUDY.models[w.model].decoder_options(),
        trim_s=trimmed,
        max_people=followed,
    script:
        "../scripts/detect_pose.py"
