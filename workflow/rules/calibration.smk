"""Where the fixed cameras are, and the court points clicked for that.

Inputs: a calibration made elsewhere, or ties from structure from motion and clicked court points, or these alone.
Outputs: results/{session}/calibration/{calibration}/, results/{session}/pages/clicking.html.
Steps: import_cameras (`file`), calibrate_cameras (`sfm-n40`, the default), align_cameras (`paper-n40`,
`paper-global-n40`, `sim3-n40`), calibrate_lens and resect_cameras (`known18`, `known8-board`, `dlt18`);
propose_court_points (where the points probably are), build_clicking_page.
"""

FOUND = "results/{session}/calibration/{calibration}"


rule import_cameras:
    input:
        calibration_path=lambda w: session_of(w).calibration_file,
    output:
        cameras_toml="results/{session}/calibration/file/cameras.toml",
        quality_json="results/{session}/calibration/file/quality.json",
    log:
        "results/{session}/logs/import_cameras/file.log",
    params:
        code=code("import_cameras.py"),
        names=lambda w: session_of(w).calibration_camera_names(),
        crops_px=lambda w: {
            name: camera.crop_px
            for name, camera in session_of(w).cameras.items()
            if camera.crop_px
        },
    script:
        "../scripts/import_cameras.py"


rule calibrate_cameras:
    input:
        ties_npz=ties_file,
        clicks_csv=lambda w: session_of(w).court_points or [],
        court_yaml=lambda w: court_file(session_of(w)) or [],
    output:
        cameras_toml=f"{FOUND}/cameras.toml",
        covariance_npz=f"{FOUND}/covariance.npz",
        quality_json=f"{FOUND}/quality.json",
    log:
        "results/{session}/logs/calibrate_cameras/{calibration}.log",
    wildcard_constraints:
        calibration="sfm-n[0-9]+(-o[0-2])?",
    params:
        code=code("calibrate_cameras.py"),
        step=click_parameters,
    script:
        "../scripts/calibrate_cameras.py"


rule align_cameras:
    input:
        ties_npz=ties_file,
        clicks_csv=lambda w: session_of(w).court_points,
        court_yaml=lambda w: court_file(session_of(w)),
    output:
        cameras_toml=f"{FOUND}/cameras.toml",
        quality_json=f"{FOUND}/quality.json",
    log:
        "results/{session}/logs/align_cameras/{calibration}.log",
    wildcard_constraints:
        calibration="(sim3|paper|paper-global)-n[0-9]+(-o[0-2])?",
    params:
        code=code("align_cameras.py"),
        step=click_parameters,
    script:
        "../scripts/align_cameras.py"


rule calibrate_lens:
    input:
        files=board_source,
    output:
        lens_toml="results/{session}/calibration/lens/{camera}.toml",
    log:
        "results/{session}/logs/calibrate_lens/{camera}.log",
    params:
        code=code("calibrate_lens.py"),
        images=lambda w: session_of(w).cameras[w.camera].chessboard["images"],
        inner_corners=lambda w: session_of(w).cameras[w.camera].chessboard["inner_corners"],
    script:
        "../scripts/calibrate_lens.py"


rule resect_cameras:
    input:
        clicks_csv=lambda w: session_of(w).court_points,
        court_yaml=lambda w: court_file(session_of(w)),
        static_png=each_fixed("results/{session}/static/{camera}.png"),
        lens_toml=lens_files,
    output:
        cameras_toml=f"{FOUND}/cameras.toml",
        quality_json=f"{FOUND}/quality.json",
    log:
        "results/{session}/logs/resect_cameras/{calibration}.log",
    wildcard_constraints:
        calibration="(dlt|known)[0-9]+(-board)?",
    params:
        code=code("resect_cameras.py"),
        step=click_parameters,
        cameras=lambda w: list(session_of(w).cameras),
    script:
        "../scripts/resect_cameras.py"


rule propose_court_points:
    input:
        cameras_toml="results/{session}/calibration/{calibration}/cameras.toml",
        pictures=each_fixed("results/{session}/static/{camera}.png"),
        court_yaml=lambda w: court_file(session_of(w)),
    output:
        proposals_csv="results/{session}/calibration/{calibration}/proposals.csv",
    log:
        "results/{session}/logs/propose_court_points/{calibration}.log",
    params:
        code=code("propose_court_points.py"),
        names=lambda w: list(session_of(w).cameras),
        step=step("propose_court_points"),
    script:
        "../scripts/propose_court_points.py"


rule build_clicking_page:
    input:
        pictures=each_fixed("results/{session}/static/{camera}.png"),
        court_yaml=lambda w: court_file(session_of(w)),
        clicks_csv=lambda w: session_of(w).court_points or [],
        proposals_csv=proposals_file,
        assets=sorted(ASSETS.glob("[cp]*")),
    output:
        page_html="results/{session}/pages/clicking.html",
    log:
        "results/{session}/logs/build_clicking_page/all.log",
    params:
        code=code("build_clicking_page.py"),
        step=clicking_settings,
    script:
        "../scripts/build_clicking_page.py"
