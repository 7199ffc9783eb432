"""What reruns after a change, what a kill leaves behind, and what a bad configuration says."""

import json
import os
import time
from pathlib import Path

from courtside.study import paths
from smoke.snakemake_runs import ROOT, TINY, edited, planned, run, snakemake

# The real take: all cameras, and two without filter. Two virtual takes: five ways to fuse, and one
# of them with two cameras for table 1.
FUSED, FILTERED = 2 + 2 * 5 + 1, 1 + 2 * 5
FILTER = "filter_motion:\n  max_gap_s: 0.2"  # in config/config.yaml
TAKE_FIGURES = (
    "overlay",
    "skeletons",
    "reprojection",
    "visibility",
    "kinematics",
    "footwork",
    "shake",
)
PAPER_FIGURES = ("badminton_fig09", "badminton_fig10", "badminton_fig11", "badminton_tab01")
DOWNSTREAM_OF_FILTER = {
    "correct_joints": FILTERED,
    "fit_skeleton": 3,  # the exported way in three takes
    "export_motion": 1,
    "measure_kinematics": 7,  # all cameras in three takes, and the four others of the drawn take
    "find_contacts": 3,
    "evaluate_contacts": 2,
    **dict.fromkeys(("find_strokes", "evaluate_strokes", "draw_rally", "draw_strokes"), 2),
    "evaluate_take": 2,
    "evaluate_angles": 2,
    "evaluate_reliability": 2,
    "evaluate_kinematics": 6,
    "tabulate_study": 1,
    "compare_sessions": 1,
    "draw_kinematics": 1,
    "draw_footwork": 1,
    "draw_badminton_fig09": 1,
    "draw_three_cameras": 1,
    "tabulate_players": 1,
    "tabulate_angles": 1,
    "draw_reliability": 1,
    "build_viewer": 3,
}
DOWNSTREAM_OF_3D = {
    **DOWNSTREAM_OF_FILTER,
    "filter_motion": FILTERED,
    "export_take": 3,
    "judge_take": 3,
    "build_quality_page": 2,
    "evaluate_fusions": 4,
    "evaluate_round_trip": 1,
    "evaluate_networks": 1,
    "draw_networks": 1,
    "compare_views": 1,
    "export_overlay_video": 4,
    **{f"draw_{name}": 1 for name in TAKE_FIGURES + PAPER_FIGURES},
}


def test_editing_a_module_reruns_exactly_what_imports_it(kept):
    module = kept / "workflow/lib/courtside/reconstruction/left_right.py"
    with edited(module, "APART = 2.0", "APART = 2.1"):
        assert planned(root=kept) == {"triangulate": FUSED, **DOWNSTREAM_OF_3D}


def test_editing_a_figure_module_reruns_that_figure(kept):
    module = kept / "workflow/lib/courtside/figures/take/visibility.py"
    with edited(module, "Confidence of the network", "Confidence of this network"):
        assert planned(root=kept) == {"draw_visibility": 1}


def test_a_parameter_reruns_its_step_and_what_follows(kept):
    with edited(kept / "config/config.yaml", "max_error_share: 0.05", "max_error_share: 0.06"):
        assert planned(root=kept) == {"triangulate": FUSED, **DOWNSTREAM_OF_3D}


def test_a_filter_parameter_spares_the_triangulation(kept):
    after = {"filter_motion": FILTERED, "export_take": 2, "evaluate_fusions": 2}
    of_sources = {"fit_source": 4, "evaluate_source_angles": 1, "draw_source_errors": 1}
    exported = {"export_motion": 5}  # a take's and its four sources'
    with edited(kept / "config/config.yaml", FILTER, FILTER.replace("0.2", "0.1")):
        assert planned(root=kept) == {**DOWNSTREAM_OF_FILTER, **after, **of_sources, **exported}


def test_another_number_of_images_maps_only_that_number(kept):
    session = kept / "config/sessions/plain-tiny.yaml"
    drawn = ("badminton_fig08", "coverage", "growth")
    with edited(session, "n_images: [12]", "n_images: [12, 16]"):
        assert planned(root=kept) == {
            "map_images": 2,
            "adjust_network": 2,
            "evaluate_calibration": 2,
            "tabulate_calibration": 1,
            "draw_badminton_fig06": 2,
            **{f"draw_{name}": 1 for name in drawn},
        }


def test_a_click_spares_structure_from_motion(kept):
    with edited(kept / "config/config.yaml", "click_sigma_px: 1.75", "click_sigma_px: 1.7"):
        jobs = planned(root=kept)
    assert jobs["adjust_network"] == 2
    assert not {"extract_features", "match_images", "map_images"} & set(jobs)


def test_faults_of_the_configuration_are_single_lines(kept):
    with (
        edited(kept / "config/config.yaml", FILTER, FILTER.replace("gap_s", "gap")),
        edited(kept / "config/sessions/walk-4cams-tiny.yaml", "sex: m", "sex: male"),
    ):
        done = run("-n", root=kept, check=False)
    assert done.returncode != 0
    lines = [
        line for line in (done.stdout + done.stderr).splitlines() if line.startswith("Error: ")
    ]
    assert any("max_gap" in line and "did you mean 'max_gap_s'" in line for line in lines)
    assert "Traceback" not in done.stdout + done.stderr


def test_a_missing_video_is_named_before_any_job(kept):
    session = kept / "config/sessions/walk-4cams-tiny.yaml"
    static = "static: results/external/pose2sim/Pose2Sim/Demo_SinglePerson/videos/cam03.mp4"
    with edited(session, static, "static: data/gym/cam03.mp4"):
        done = run(root=kept, check=False)
    output = done.stdout + done.stderr
    assert done.returncode != 0
    assert "cameras.cam03.static: expected a file" in output
    assert "data/gym/cam03.mp4" in output


def test_inputs_in_the_folder_of_settings_are_told_if_they_were_exchanged(tmp_path):
    plan = next((ROOT / "config" / "plans").glob("*.yaml")).relative_to(ROOT).as_posix()
    inputs = ["config/derived_joints.yaml", plan]
    settings = ["config/config.yaml", "config/models.yaml", "config/sessions/plain-tiny.yaml"]
    later_ns = time.time_ns() + 10**12
    other = {
        Path(os.path.relpath(ROOT / name, tmp_path)).as_posix(): [1, later_ns, "of another file"]
        for name in inputs + settings
    }
    kept = tmp_path / paths.CHECKSUMS
    kept.parent.mkdir(parents=True)
    kept.write_text(json.dumps({"format": 1, "files": other}))
    done = snakemake("-n", "--directory", tmp_path, "--configfile", TINY, root=ROOT)
    said = [line for line in done.stderr.splitlines() if line.startswith("Error: ")]
    assert len(said) == len(inputs), done.stderr
    assert all(any(Path(name).name in line for line in said) for name in inputs)
    assert not any(Path(name).name in done.stderr for name in settings)
