"""Where the fixed cameras are, and the court points clicked for that.

Inputs: a calibration made elsewhere, or ties from structure from motion and clicked court points,
or these alone.
Outputs: results/{session}/calibration/{calibration}/, results/{session}/pages/clicking.html.
Steps: import_cameras (`file`); checks of a file: check_videos (whether each video is of its camera),
check_court (by painted lines), check_cameras (by static points and people);
calibrate_cameras (`sfm-n40`, the default), align_cameras (`paper-n40`, `paper-global-n40`,
`sim3-n40`),
calibrate_lens and resect_cameras (`known18`, `known8-board`, `dlt18`), resect_together (`known`:
all points, all cameras), calibrate_boards (`board`), calibrate_wand (`wand`),
calibrate_from_people (`people`: nothing else), refine_cameras (`file-people` and the like);
propose_court_points (where the points probably are), find_court (the same without a click),
build_clicking_page; export_cameras (for EasyMocap and COLMAP, by request).
"""


rule import_cameras:
    input:
        calibration_path=lambda w: whole(session_of(w).calibration_file),
        files=of_job(calibration.file_parts),
        covariance_npz=of_job(calibration.file_covariance),
        court_yaml=of_job(calibration.court_of_file),
    output:
        cameras_toml=paths.part(paths.CAMERAS, calibration="file"),
        quality_json=paths.part(paths.CALIBRATION_QUALITY, calibration="file"),
    log:
        "results/{session}/logs/import_cameras/file.log",
    params:
        code=code("import_cameras.py"),
        names=lambda w: session_of(w).calibration_camera_names(),
        crops_px=of_job(calibration.crops_px),
        scales=of_job(calibration.scales),
        override=lambda w: session_of(w).calibration_override,
        unit=lambda w: session_of(w).calibration_unit,
    script:
        "../scripts/import_cameras.py"


rule check_cameras:
    input:
        calibration_path=lambda w: whole(session_of(w).calibration_file),
        files=of_job(calibration.file_parts),
        cameras_toml=paths.part(paths.CAMERAS, calibration="file"),
        static_csv=lambda w: session_of(w).static_points or [],
        seen=files_of(calibration.checked, "pose2d", "sync", "people"),
    output:
        check_json=paths.part(paths.CALIBRATION_CHECK, suffix="json"),
        check_csv=paths.part(paths.CALIBRATION_CHECK, suffix="csv"),
    log:
        "results/{session}/logs/check_cameras/file.log",
    params:
        code=code("check_cameras.py"),
        names=lambda w: session_of(w).calibration_camera_names(),
        override=lambda w: session_of(w).calibration_override,
        unit=lambda w: session_of(w).calibration_unit,
        takes=of_job(calibration.checked),
    script:
        "../scripts/check_cameras.py"


rule check_videos:
    input:
        cameras_toml=paths.part(paths.CAMERAS, calibration="file"),
        pictures=files_of(calibration.halls, "pictures"),
    output:
        check_json=paths.part(paths.VIDEO_CHECK, suffix="json"),
        check_csv=paths.part(paths.VIDEO_CHECK, suffix="csv"),
    log:
        "results/{session}/logs/check_videos/file.log",
    # Before detection: what is wrong with cameras is told early, also where a later step fails.
    priority: 50
    params:
        code=code("check_videos.py"),
        halls=of_job(calibration.halls),
    script:
        "../scripts/check_videos.py"


rule check_court:
    input:
        calibration_path=lambda w: whole(session_of(w).calibration_file),
        files=of_job(calibration.file_parts),
        cameras_toml=paths.part(paths.CAMERAS, calibration="file"),
        court_yaml=of_job(Job.court_file),
        proposals_csv=paths.part(paths.FOUND_COURT, part="proposals.csv"),
    output:
        check_json=paths.part(paths.COURT_CHECK, suffix="json"),
        check_csv=paths.part(paths.COURT_CHECK, suffix="csv"),
    log:
        "results/{session}/logs/check_court/file.log",
    priority: 50  # likewise
    params:
        code=code("check_court.py"),
        names=lambda w: session_of(w).calibration_camera_names(),
        override=lambda w: session_of(w).calibration_override,
        unit=lambda w: session_of(w).calibration_unit,
    script:
        "../scripts/check_court.py"


rule calibrate_cameras:
    input:
        ties_npz=of_job(calibration.ties),
        clicks_csv=lambda w: session_of(w).court_points or [],
        court_yaml=of_job(Job.court_file),
        pictures=of_job(calibration.line_pictures),
    output:
        cameras_toml=paths.CAMERAS,
        covariance_npz=paths.CAMERA_COVARIANCE,
        quality_json=paths.CALIBRATION_QUALITY,
    log:
        "results/{session}/logs/calibrate_cameras/{calibration}.log",
    wildcard_constraints:
        calibration="sfm-n[0-9]+(-o[0-2])?(-lines)?",
    params:
        code=code("calibrate_cameras.py"),
        search=of_job(calibration.line_search),
        step=of_job(calibration.clicks),
    script:
        "../scripts/calibrate_cameras.py"


rule align_cameras:
    input:
        ties_npz=of_job(calibration.ties),
        clicks_csv=lambda w: session_of(w).court_points,
        court_yaml=of_job(Job.court_file),
    output:
        cameras_toml=paths.CAMERAS,
        quality_json=paths.CALIBRATION_QUALITY,
    log:
        "results/{session}/logs/align_cameras/{calibration}.log",
    wildcard_constraints:
        calibration="(sim3|paper|paper-global)-n[0-9]+(-o[0-2])?",
    params:
        code=code("align_cameras.py"),
        step=of_job(calibration.clicks),
    script:
        "../scripts/align_cameras.py"


rule calibrate_lens:
    input:
        files=of_job(calibration.boards),
    output:
        lens_toml=paths.LENS,
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
        court_yaml=of_job(Job.court_file),
        static_png=of_job(calibration.each_fixed, paths.STATIC),
        lens_toml=of_job(calibration.lenses),
    output:
        cameras_toml=paths.CAMERAS,
        quality_json=paths.CALIBRATION_QUALITY,
    log:
        "results/{session}/logs/resect_cameras/{calibration}.log",
    wildcard_constraints:
        calibration="(dlt|known)[0-9]+(-board)?",
    params:
        code=code("resect_cameras.py"),
        step=of_job(calibration.clicks),
        cameras=lambda w: list(session_of(w).cameras),
    script:
        "../scripts/resect_cameras.py"


rule resect_together:
    input:
        clicks_csv=lambda w: session_of(w).court_points,
        court_yaml=of_job(Job.court_file),
        pictures=of_job(calibration.of_full_size),
    output:
        cameras_toml=paths.CAMERAS,
        covariance_npz=paths.CAMERA_COVARIANCE,
        quality_json=paths.CALIBRATION_QUALITY,
    log:
        "results/{session}/logs/resect_together/{calibration}.log",
    wildcard_constraints:
        calibration="known",
    params:
        code=code("resect_together.py"),
        step=of_job(calibration.clicks),
        cameras=lambda w: list(session_of(w).cameras),
        placed=lambda w: session_of(w).placed,
    script:
        "../scripts/resect_together.py"


rule calibrate_boards:
    input:
        files=of_job(calibration.board_files),
        lens_tomls=of_job(calibration.board_lenses),
        pictures=of_job(calibration.board_pictures),
    output:
        cameras_toml=paths.CAMERAS,
        covariance_npz=paths.CAMERA_COVARIANCE,
        quality_json=paths.CALIBRATION_QUALITY,
    log:
        "results/{session}/logs/calibrate_boards/{calibration}.log",
    wildcard_constraints:
        calibration="board",
    params:
        code=code("calibrate_boards.py"),
        given=lambda w: session_of(w).board,
        names=lambda w: session_of(w).calibration_camera_names(),
    script:
        "../scripts/calibrate_boards.py"


rule calibrate_wand:
    input:
        files=of_job(calibration.wand_files),
        lens_tomls=of_job(calibration.wand_lenses),
        pictures=of_job(calibration.wand_pictures),
        clicks_csv=lambda w: session_of(w).court_points or [],
        court_yaml=of_job(Job.court_file),
    output:
        cameras_toml=paths.CAMERAS,
        covariance_npz=paths.CAMERA_COVARIANCE,
        quality_json=paths.CALIBRATION_QUALITY,
    log:
        "results/{session}/logs/calibrate_wand/{calibration}.log",
    wildcard_constraints:
        calibration="wand",
    params:
        code=code("calibrate_wand.py"),
        given=lambda w: session_of(w).wand,
        names=lambda w: session_of(w).calibration_camera_names(),
        placed=lambda w: session_of(w).placed,
        weights=of_job(calibration.clicks),
    script:
        "../scripts/calibrate_wand.py"


rule calibrate_from_people:
    input:
        files=files_of(calibration.placing, "pose2d"),
        lens_tomls=of_job(calibration.known_lenses),
        offsets=of_job(calibration.joint_offsets),
        static=lambda w: session_of(w).known_lengths and session_of(w).static_points or [],
    output:
        cameras_toml=paths.CAMERAS,
        covariance_npz=paths.CAMERA_COVARIANCE,
        quality_json=paths.CALIBRATION_QUALITY,
    log:
        "results/{session}/logs/calibrate_from_people/{calibration}.log",
    wildcard_constraints:
        calibration="people",
    params:
        code=code("calibrate_from_people.py"),
        names=lambda w: list(session_of(w).cameras),
        takes=of_job(calibration.placing),
        known_lengths=lambda w: list(session_of(w).known_lengths),
        clicks=of_job(calibration.clicks),
        views=step("triangulate"),
        clock_step=step("synchronise_cameras"),
    script:
        "../scripts/calibrate_from_people.py"


rule export_cameras:
    input:
        cameras_toml=paths.CAMERAS,
    output:
        folder=directory(paths.CAMERA_EXPORT),
    log:
        "results/{session}/logs/export_cameras/{calibration}.log",
    params:
        code=code("export_cameras.py"),
    script:
        "../scripts/export_cameras.py"


rule refine_cameras:
    input:
        cameras=of_job(calibration.of_base, paths.CAMERAS),
        covariance=of_job(calibration.base_covariance),
        calibration=lambda w: whole(of_job(calibration.base_file)(w)),
        files=of_job(calibration.base_parts),
        clicks=of_job(calibration.unused_clicks),
        court=of_job(Job.court_file),
        static=lambda w: session_of(w).static_points or [],
        skeleton=of_job(takes.first_skeleton),
        offsets=of_job(calibration.joint_offsets),
        seen=files_of(calibration.refining, "pose2d", "sync", "people"),
    output:
        cameras_toml=paths.CAMERAS,
        covariance_npz=paths.CAMERA_COVARIANCE,
        quality_json=paths.CALIBRATION_QUALITY,
        table_csv=paths.REFINEMENT,
        knocks_csv=paths.KNOCKS,
    log:
        "results/{session}/logs/refine_cameras/{calibration}.log",
    wildcard_constraints:
        calibration="[a-z0-9-]+-people",
    params:
        code=code("refine_cameras.py"),
        names=lambda w: session_of(w).calibration_camera_names(),
        override=lambda w: session_of(w).calibration_override,
        unit=lambda w: session_of(w).calibration_unit,
        takes=of_job(calibration.refining),
        weights=of_job(calibration.clicks),
        views=step("triangulate"),
        stated=of_job(calibration.stated),
    script:
        "../scripts/refine_cameras.py"


rule propose_court_points:
    input:
        cameras_toml=paths.CAMERAS,
        pictures=of_job(calibration.each_fixed, paths.STATIC),
        court_yaml=of_job(Job.court_file),
    output:
        proposals_csv=paths.COURT_PROPOSALS,
    log:
        "results/{session}/logs/propose_court_points/{calibration}.log",
    params:
        code=code("propose_court_points.py"),
        names=lambda w: list(session_of(w).cameras),
        step=step("propose_court_points"),
    script:
        "../scripts/propose_court_points.py"


rule find_court:
    input:
        pictures=of_job(calibration.of_hall),
        court_yaml=of_job(Job.court_file),
    output:
        proposals_csv=paths.part(paths.FOUND_COURT, part="proposals.csv"),
        found_json=paths.part(paths.FOUND_COURT, part="found.json"),
    log:
        "results/{session}/logs/find_court/all.log",
    priority: 50  # for check_court
    params:
        code=code("find_court.py"),
        names=lambda w: list(session_of(w).cameras),
        step=step("propose_court_points"),
    script:
        "../scripts/find_court.py"


rule build_clicking_page:
    input:
        pictures=of_job(calibration.each_fixed, paths.STATIC),
        court_yaml=of_job(Job.court_file),
        clicks_csv=lambda w: session_of(w).court_points or [],
        proposals_csv=of_job(calibration.proposals),
        assets=sorted(ASSETS.glob("[cp]*")),
    output:
        page_html=paths.CLICKING_PAGE,
    log:
        "results/{session}/logs/build_clicking_page/all.log",
    params:
        code=code("build_clicking_page.py"),
        step=of_job(calibration.clicking),
    script:
        "../scripts/build_clicking_page.py"
