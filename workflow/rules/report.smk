"""The report: one HTML file of all results, for coaches. Made only on request.

Inputs: measures, figures, checks, qualities of all sessions. Outputs: results/report.html.
Steps: build_report.
"""


rule build_report:
    input:
        files=lambda w: report_page.files(report_page.content(STUDY, workflow.rules, CAPTIONS)),
        assets=sorted(ASSETS.glob("[pr]*")),
    output:
        html=paths.REPORT,
    log:
        "results/run/logs/build_report/all.log",
    params:
        code=code("build_report.py"),
        study=lambda w: report_page.content(STUDY, workflow.rules, CAPTIONS),
    script:
        "../scripts/build_report.py"
