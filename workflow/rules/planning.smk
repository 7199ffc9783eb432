"""Prediction of the calibration error of planned sessions.

Inputs: config/plans/{plan}.yaml. Outputs: results/plans/{plan}/.
Steps: plan_session.
"""


rule plan_session:
    input:
        plan_yaml=CONFIG / paths.PLAN_YAML,
        court_yaml=lambda w: CONFIG / paths.COURT_YAML.format(court=PLANS[w.plan].court),
    output:
        **plan_figure("growth"),
        **plan_figure("map"),
    log:
        "results/plans/logs/plan_session/{plan}.log",
    params:
        code=code("plan_session.py"),
        step={
            "heights_m": STUDY.parameters["draw_error_map"]["heights_m"],
            "adjust": STUDY.parameters["adjust_network"],
        },
    script:
        "../scripts/plan_session.py"
