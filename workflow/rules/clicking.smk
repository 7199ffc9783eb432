"""Clicking court points: a page to do it on, and where the points probably are.

Inputs: static pictures, court; cameras and clicks where there are some. Outputs: results/{session}/pages/clicking.html,
results/{session}/calibration/{calibration}/proposals.csv.
Steps: propose_court_points, build_clicking_page.
"""


rule propose_court_points:
    input:
        cameras="results/{session}/calibration/{calibration}/cameras.toml",
        pictures=each_fixed("results/{session}/static/{camera}.png"),
        court=lambda w: court_file(session_of(w)),
    output:
        proposals="results/{session}/calibration/{calibration}/proposals.csv",
    log:
        "results/{session}/logs/propose_court_points/{calibration}.log",
    params:
        code=code("propose_court_points.py"),
        cameras=lambda w: list(session_of(w).cameras),
        step=step("propose_court_points"),
    script:
        "../scripts/propose_court_points.py"


rule build_clicking_page:
    input:
        pictures=each_fixed("results/{session}/static/{camera}.png"),
        court=lambda w: court_file(session_of(w)),
        clicks=lambda w: session_of(w).court_points or [],
        proposals=proposals_file,
        assets=sorted(ASSETS.glob("[cp]*")),
    output:
        page="results/{session}/pages/clicking.html",
    log:
        "results/{session}/logs/build_clicking_page/all.log",
    params:
        code=code("build_clicking_page.py"),
        settings=clicking_settings,
    script:
        "../scripts/build_clicking_page.py"
