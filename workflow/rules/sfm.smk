"""Structure from motion over the fixed cameras and bridging images.

Inputs: static pictures, frames of the walks. Outputs: results/{session}/sfm/.
Steps: extract_features and match_images (once per session, whatever the numbers of images),
map_images (one number of bridging images), adjust_network (with the clicked court points).
"""


rule extract_features:
    input:
        static_png=of_job(calibration.each_fixed, paths.STATIC),
        frames_csv=of_job(calibration.each_walk, paths.FRAME_TABLE),
        folders=of_job(calibration.each_walk, paths.FRAMES),
    output:
        features_db=paths.FEATURES,
        table_csv=paths.FEATURE_TABLE,
    log:
        "results/{session}/logs/extract_features/all.log",
    benchmark:
        "results/{session}/benchmarks/extract_features/all.tsv"
    threads: SEVERAL
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
        features_db=paths.FEATURES,
        features_csv=paths.FEATURE_TABLE,
        frames_csv=of_job(calibration.each_walk, paths.FRAME_TABLE),
    output:
        matches_db=paths.MATCHES,
        table_csv=paths.MATCH_TABLE,
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
        matches_db=paths.MATCHES,
        features_csv=paths.FEATURE_TABLE,
        frames_csv=of_job(calibration.each_walk, paths.FRAME_TABLE),
    output:
        model=paths.MODEL,
        summary_json=paths.SFM_SUMMARY,
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
        step=of_job(calibration.mapping),
        walks=lambda w: list(session_of(w).walks),
    script:
        "../scripts/map_images.py"


rule adjust_network:
    input:
        model=paths.MODEL,
        summary_json=paths.SFM_SUMMARY,
        matches_db=paths.MATCHES,
        clicks_csv=lambda w: session_of(w).court_points or [],
        court_yaml=of_job(Job.court_file),
    output:
        ties_npz=paths.TIES,
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
