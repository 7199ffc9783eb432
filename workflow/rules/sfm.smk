"""Structure from motion over the fixed cameras and bridging images.

Inputs: static pictures, frames of the walks. Outputs: results/{session}/sfm/.
Steps: extract_features and match_images (once per session, whatever the numbers of images), map_images (one number of
bridging images), adjust_network (with the clicked court points).
"""

VARIANT = "results/{session}/sfm/{mapper}-n{n_images}-o{offset}"


rule extract_features:
    input:
        static_png=each_fixed("results/{session}/static/{camera}.png"),
        frames_csv=each_walk("results/{session}/frames/{walk}.csv"),
        folders=each_walk("results/{session}/frames/{walk}"),
    output:
        features_db="results/{session}/sfm/features.db",
        table_csv="results/{session}/sfm/features.csv",
    log:
        "results/{session}/logs/extract_features/all.log",
    benchmark:
        "results/{session}/benchmarks/extract_features/all.tsv"
    threads: 2
    resources:
        mem_mb=3000,
    params:
        code=code("extract_features.py"),
        step=step("extract_features"),
        cameras=lambda w: list(session_of(w).cameras),
        walks=lambda w: list(session_of(w).walks),
    script:
        "../scripts/extract_features.py"


rule match_images:
    input:
        features_db="results/{session}/sfm/features.db",
        features_csv="results/{session}/sfm/features.csv",
        frames_csv=each_walk("results/{session}/frames/{walk}.csv"),
    output:
        matches_db="results/{session}/sfm/matches.db",
        table_csv="results/{session}/sfm/matches.csv",
    log:
        "results/{session}/logs/match_images/all.log",
    benchmark:
        "results/{session}/benchmarks/match_images/all.tsv"
    resources:
        mem_mb=2000,
    params:
        code=code("match_images.py"),
        step=step("match_images"),
        walks=lambda w: list(session_of(w).walks),
    script:
        "../scripts/match_images.py"


rule map_images:
    input:
        matches_db="results/{session}/sfm/matches.db",
        features_csv="results/{session}/sfm/features.csv",
        frames_csv=each_walk("results/{session}/frames/{walk}.csv"),
    output:
        model=expand(f"{VARIANT}/{{part}}.bin", part=MODEL_PARTS, allow_missing=True),
        summary_json=f"{VARIANT}/summary.json",
    log:
        "results/{session}/logs/map_images/{mapper}-n{n_images}-o{offset}.log",
    benchmark:
        "results/{session}/benchmarks/map_images/{mapper}-n{n_images}-o{offset}.tsv"
    # With one thread the same input gives the same model; the variants of a sweep run side by side.
    threads: 1
    resources:
        mem_mb=1500,
    params:
        code=code("map_images.py"),
        step=map_parameters,
        walks=lambda w: list(session_of(w).walks),
    script:
        "../scripts/map_images.py"


rule adjust_network:
    input:
        model=expand(f"{VARIANT}/{{part}}.bin", part=MODEL_PARTS, allow_missing=True),
        summary_json=f"{VARIANT}/summary.json",
        clicks_csv=lambda w: session_of(w).court_points or [],
        court_yaml=lambda w: court_file(session_of(w)) or [],
    output:
        ties_npz=f"{VARIANT}/ties.npz",
    log:
        "results/{session}/logs/adjust_network/{mapper}-n{n_images}-o{offset}.log",
    benchmark:
        "results/{session}/benchmarks/adjust_network/{mapper}-n{n_images}-o{offset}.tsv"
    threads: 1
    resources:
        mem_mb=1500,
    params:
        code=code("adjust_network.py"),
        step=step("adjust_network"),
        cameras=lambda w: list(session_of(w).cameras),
    script:
        "../scripts/adjust_network.py"
