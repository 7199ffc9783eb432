"""Courtside: every figure and table of the study, from raw recordings."""

import gc

from snakemake.utils import min_version

min_version("9.27.1")

# Millions of objects make a plan, and all stay: to look for garbage among them as often as usual takes a seventh of the time.
gc.freeze()
gc.set_threshold(200_000, 20, 20)


include: "workflow/rules/common.smk"
include: "workflow/rules/consent_inputs.smk"
include: "workflow/rules/inputs.smk"
include: "workflow/rules/take_inputs.smk"
include: "workflow/rules/device_inputs.smk"
include: "workflow/rules/recording_inputs.smk"
include: "workflow/rules/targets.smk"
include: "workflow/rules/take_targets.smk"
include: "workflow/rules/players_targets.smk"
include: "workflow/rules/single_view_inputs.smk"
include: "workflow/rules/page_inputs.smk"
include: "workflow/rules/evaluation_inputs.smk"
include: "workflow/rules/stroke_inputs.smk"
include: "workflow/rules/report_inputs.smk"
include: "workflow/rules/report_figures.smk"
include: "workflow/rules/artefacts.smk"
include: "workflow/rules/simulation.smk"
include: "workflow/rules/video.smk"
include: "workflow/rules/sfm.smk"
include: "workflow/rules/calibration.smk"
include: "workflow/rules/planning.smk"
include: "workflow/rules/pose2d.smk"
include: "workflow/rules/skeletons.smk"
include: "workflow/rules/devices.smk"
include: "workflow/rules/body_frame.smk"
include: "workflow/rules/evaluation_calibration.smk"
include: "workflow/rules/evaluation_takes.smk"
include: "workflow/rules/comparisons.smk"
include: "workflow/rules/figures_take.smk"
include: "workflow/rules/figures_devices.smk"
include: "workflow/rules/figures_badminton.smk"
include: "workflow/rules/figures_calibration.smk"
include: "workflow/rules/pages.smk"
include: "workflow/rules/report.smk"
include: "workflow/rules/run.smk"


DIGESTS.save()


report: "workflow/report/study.rst"


onstart:
    files.delete_unfinished("results")
    # On one machine, no limit of job starts per second: to keep it, Snakemake 9.27 looks at all jobs that are
    # ready anew each second for every job that it has started, which cost minutes in the default study.
    if workflow.local_exec:
        workflow.scheduler.job_rate_limiter = None


onsuccess:
    files.delete_unfinished("results")
    record_provenance()
    print(end_of_run(), *waiting_for_clicks(), *left_out(), sep="\n", file=sys.stderr)


onerror:
    files.delete_unfinished("results")
    print(end_of_run(), file=sys.stderr)
    record_provenance()


rule all:
    input:
        every_calibration(),
        every_photo_model(),
        every_evaluation(),
        every_check(),
        every_export(),
        every_figure(),
        every_shake(),
        every_kinematics(),
        every_comparison_of_views(),
        every_players_figure(),
        every_device_figure(),
        every_body_frame(),
        every_clicking_page(),
        every_viewer(),
        every_overlay_video(),
        every_plan(),
        every_study_figure(),


rule report:
    input:
        rules.all.input,
        rules.build_report.output,
