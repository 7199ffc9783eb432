"""Courtside: every figure and table of the study, from raw recordings."""

import gc

from snakemake import cli
from snakemake.utils import min_version

min_version("9.27.1")

# A plan has millions of objects, and all stay: the usual garbage collection takes a seventh of the
# time.
gc.freeze()
gc.set_threshold(200_000, 20, 20)


include: "workflow/rules/common.smk"
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
    # On one machine, job starts per second are not limited: to limit them, Snakemake 9.27 looks at
    # all ready jobs each second for every job that it has started (minutes in the default study).
    if workflow.local_exec:
        workflow.scheduler.job_rate_limiter = None
    BEFORE.update(run.states(workflow))


onsuccess:
    files.delete_unfinished("results")
    record_provenance()
    verdicts, n_failed = run.verdicts(workflow)
    print(
        end_of_run(n_failed),
        *run.unsure(workflow, REPOSITORY, BEFORE),
        *run.waiting_for_clicks(STUDY),
        *run.left_out(STUDY),
        *asked(run.lost_pictures, STUDY),
        *REMARKS,
        *asked(run.warnings, STUDY),
        *verdicts,
        sep="\n",
        file=sys.stderr,
    )
    if n_failed:
        sys.exit(1)


onerror:
    files.delete_unfinished("results")
    unsure = run.unsure(workflow, REPOSITORY, BEFORE)
    told = [end_of_run(), *unsure, *REMARKS, *asked(run.warnings, STUDY)]
    print(*told, sep="\n", file=sys.stderr)
    record_provenance(tried)


rule all:
    input:
        targets.calibration.every_calibration(STUDY),
        targets.calibration.every_file_check(STUDY),
        targets.calibration.every_photo_model(STUDY),
        targets.calibration.every_evaluation(STUDY),
        targets.takes.every_check(STUDY),
        targets.takes.every_export(STUDY),
        targets.takes.every_figure(STUDY),
        targets.takes.every_shake(STUDY),
        targets.takes.every_kinematics(STUDY),
        targets.takes.every_footwork(STUDY),
        targets.takes.every_stroke(STUDY),
        targets.takes.every_verdict(STUDY),
        targets.takes.every_comparison_of_views(STUDY),
        targets.together.every_players_figure(STUDY),
        targets.together.every_study_table(STUDY),
        targets.devices.every_device_export(STUDY),
        targets.devices.every_source_angle(STUDY),
        targets.devices.every_device_figure(STUDY),
        targets.devices.every_body_frame(STUDY),
        targets.pages.every_clicking_page(STUDY),
        targets.pages.every_people_page(STUDY),
        targets.pages.every_quality_page(STUDY),
        targets.pages.every_viewer(STUDY),
        targets.pages.every_overlay_video(STUDY),
        targets.pages.every_plan(STUDY),
        targets.calibration.every_study_figure(STUDY),


rule report:
    input:
        rules.all.input,
        rules.build_report.output,


# Snakemake's own line on a file that no rule makes does not say what was expected. It hands the
# targets over only once this file is read.
if workflow.is_main_process and "snakemake" in sys.argv[0]:
    wanted = cli.get_argument_parser().parse_known_args(sys.argv[1:])[0].targets
    unmade = targets.names.faults(wanted, workflow.rules, STUDY, rules.all.input)
    if unmade:
        sys.exit("\n".join(f"Error: {line}" for line in unmade))
