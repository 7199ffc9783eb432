"""The report: one HTML file of all that the study found, for a coach to read. Made only when asked for.

Inputs: measures, figures, checks, qualities of all sessions. Outputs: results/report.html.
Steps: build_report.
"""


rule build_report:
    input:
        files=lambda w: report_files(reported_study()),
        assets=sorted(ASSETS.glob("[pr]*")),
    output:
        html=REPORT,
    log:
        "results/run/logs/build_report/all.log",
    params:
        code=code("build_report.py"),
        study=lambda w: reported_study(),
    script:
        "../scripts/build_report.py"
