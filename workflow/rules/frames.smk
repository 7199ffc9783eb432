"""Pictures of the fixed cameras without people.

Inputs: videos of a session. Outputs: results/{session}/frames/, takes/{take}/background/.
Steps: extract_frames (of a camera's `static` recording), estimate_background (per take and camera).
"""


rule extract_frames:
    input:
        video=lambda w: session_of(w).cameras[w.camera].static,
    output:
        folder=directory("results/{session}/frames/{camera}"),
        table="results/{session}/frames/{camera}.csv",
    log:
        "results/{session}/logs/extract_frames/{camera}.log",
    benchmark:
        "results/{session}/benchmarks/extract_frames/{camera}.tsv"
    params:
        code=code("extract_frames.py"),
        step=step("extract_frames"),
    script:
        "../scripts/extract_frames.py"


rule estimate_background:
    input:
        source=background_source,
    output:
        png="results/{session}/takes/{take}/background/{camera}.png",
    log:
        "results/{session}/logs/estimate_background/{take}.{camera}.log",
    benchmark:
        "results/{session}/benchmarks/estimate_background/{take}.{camera}.tsv"
    params:
        code=code("estimate_background.py"),
        step=step("estimate_background"),
        trim_s=lambda w: take_of(w).trim_s,
    script:
        "../scripts/estimate_background.py"
