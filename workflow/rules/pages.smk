"""Pages and videos: naming of people, verdicts, viewers, overlay videos, Pose2Sim projects.

Inputs: 3D keypoints of all stages, devices, cameras, videos. Outputs: results/{session}/pages/,
results/{session}/takes/{take}/pages/, videos/, pose2sim/.
Steps: build_people_page, build_quality_page, build_viewer, export_overlay_video, export_pose2sim.
"""


rule build_people_page:
    input:
        found=of_job(pages.first_way, paths.FOUND_PEOPLE),
        cameras=of_job(pages.first_way, paths.CAMERAS),
        pose2d=of_job(pages.first_keypoints),
        sync=of_job(pages.first_way, paths.CAMERA_CLOCKS),
        skeleton=of_job(takes.first_skeleton),
        court=of_job(Job.court_file),
        videos=lambda w: list(take_of(w).videos.values()),
        people_csv=of_job(takes.people_csv),
        assets=sorted(ASSETS.glob("[cp]*")),
    output:
        page_html=paths.PEOPLE_PAGE,
    log:
        "results/{session}/logs/build_people_page/{take}.log",
    priority: 1  # before name_people: where names are missing, the page is there
    params:
        code=code("build_people_page.py"),
        session=lambda w: w.session,
        take=lambda w: w.take,
        takes=of_job(pages.known_takes),
        subjects=lambda w: list(take_of(w).subjects),
        stated=of_job(takes.sightings),
        target=of_job(pages.people_target),
        pin=of_job(Job.demand, "pictures"),  # an error without consent; faces are always hidden
    script:
        "../scripts/build_people_page.py"


rule build_quality_page:
    input:
        files=files_of(pages.judged_takes, "quality", "people", "skeleton", "pose2d", "videos"),
        of_cameras=lambda w: report_page.files(report_page.cameras(session_of(w))),
        assets=sorted(ASSETS.glob("[pqr]*")),
    output:
        page_html=paths.QUALITY_PAGE,
    log:
        "results/{session}/logs/build_quality_page/all.log",
    params:
        code=code("build_quality_page.py"),
        session=lambda w: w.session,
        takes=of_job(pages.judged_takes),
        cameras=lambda w: report_page.cameras(session_of(w)),
    script:
        "../scripts/build_quality_page.py"


rule build_viewer:
    input:
        files=files_of(pages.layers, "file"),
        skeletons=of_job(pages.skeleton_files),
        cameras=of_job(pages.viewed_cameras),
        court=of_job(pages.viewed_court),
        clocks=of_job(devices.take_clocks),
        assets=sorted(ASSETS.glob("[pv]*")),
    output:
        html=paths.VIEWER,
    log:
        "results/{session}/logs/build_viewer/{take}.{model}.log",
    params:
        code=code("build_viewer.py"),
        title=lambda w: f"{w.session}, {w.take}",
        layers=of_job(pages.layers),
    script:
        "../scripts/build_viewer.py"


rule export_overlay_video:
    input:
        pose3d=paths.POSE3D,
        pose2d=paths.POSE2D,
        shake=of_job(takes.shake),
        people=paths.PEOPLE,
        sync=paths.CAMERA_CLOCKS,
        cameras=paths.CAMERAS,
        video=lambda w: take_of(w).videos[w.camera],
        skeleton=of_job(Job.skeleton_file),
    output:
        mp4=paths.OVERLAY_VIDEO,
    log:
        f"results/{{session}}/logs/export_overlay_video/{paths.OF_FUSED}.{{camera}}.log",
    benchmark:
        f"results/{{session}}/benchmarks/export_overlay_video/{paths.OF_FUSED}.{{camera}}.tsv"
    params:
        code=code("export_overlay_video.py"),
        step=of_job(pages.overlay),
        blur_faces=of_job(takes.blur_faces),
        trim_s=lambda w: take_of(w).trim_s,
    script:
        "../scripts/export_overlay_video.py"


rule export_pose2sim:
    input:
        pose3d=of_job(takes.exported),
        pose2d=of_job(takes.keypoints_2d),
        people=paths.PEOPLE,
        sync=paths.CAMERA_CLOCKS,
        cameras=paths.CAMERAS,
        skeleton=of_job(Job.skeleton_file),
    output:
        folder=directory(paths.POSE2SIM),
    log:
        f"results/{{session}}/logs/export_pose2sim/{paths.OF_FUSED}.log",
    params:
        code=code("export_pose2sim.py"),
    script:
        "../scripts/export_pose2sim.py"
