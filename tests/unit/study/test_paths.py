"""Files have the names that users, pages and documents know."""

import re
from pathlib import Path

import pytest

from courtside.study import paths

RULES = Path(__file__).parents[3] / "workflow" / "rules"
KNOWN = {
    "session": "gym",
    "take": "rally",
    "camera": "left",
    "model": "net",
    "calibration": "sfm-n40",
    "fusion": "all-robust",
    "person": "p1",
    "suffix": "trc",
    "stage": "pose3d_filtered",
    "device": "d415",
    "source": "d415-depth",
    "what": "paths",
    "mapper": "global",
    "n_images": 40,
    "offset": 0,
    "figure": "overlay",
}


@pytest.mark.parametrize(
    ("pattern", "path"),
    [
        (paths.CAMERAS, "results/gym/calibration/sfm-n40/cameras.toml"),
        (paths.TIES, "results/gym/sfm/global-n40-o0/ties.npz"),
        (paths.SFM_ERRORS, "results/gym/evaluation/global-n40-o0.csv"),
        (paths.POSE2D, "results/gym/takes/rally/pose2d/net/left.npz"),
        (
            paths.POSE2D_STEADIED,
            "results/gym/takes/rally/pose2d_steadied/sfm-n40/net/left.npz",
        ),
        (
            paths.FITTED_SOURCE,
            "results/gym/takes/rally/pose3d_ik/devices/d415-depth/net.npz",
        ),
        (
            paths.SOURCE_MOTION,
            "results/gym/takes/rally/motion/devices/d415-depth/net.npz",
        ),
        (paths.POSE3D, "results/gym/takes/rally/pose3d/sfm-n40/all-robust/net.npz"),
        (
            paths.SKELETONS,
            "results/gym/takes/rally/pose3d_filtered/sfm-n40/all-robust/net.npz",
        ),
        (paths.EXPORT, "results/gym/takes/rally/pose3d_filtered/sfm-n40/all-robust/net.p1.trc"),
        (paths.MEASURES, "results/gym/takes/rally/kinematics/sfm-n40/all-robust/net.summary.csv"),
        (paths.SOURCE, "results/gym/takes/rally/devices/d415-depth.net.npz"),
        (paths.DEPTH_SOURCE, "results/gym/takes/rally/devices/d415-depth.net.npz"),
        (paths.ARCS, "results/gym/takes/rally/body/arcs.net.paths.csv"),
        (paths.TRUE_TAKE, "results/virtual/gym/takes/rally/truth.npz"),
        (
            paths.TAKE_FIGURE,
            "results/gym/takes/rally/figures/overlay.sfm-n40.all-robust.net",
        ),
        (paths.VIEWER, "results/gym/takes/rally/pages/viewer.net.html"),
    ],
)
def test_a_pattern_filled_is_the_file(pattern, path):
    assert pattern.format(**KNOWN) == path


def test_no_two_patterns_are_the_same_file():
    apart = {name: value for name, value in vars(paths).items() if isinstance(value, str)}
    apart = {name: value for name, value in apart.items() if value.startswith("results/")}
    assert len(apart) > 80
    assert len(set(apart.values())) == len(apart)


def test_a_model_of_colmap_is_five_files_of_one_folder():
    found = [Path(pattern.format(**KNOWN)) for pattern in paths.MODEL]
    assert {path.parent.as_posix() for path in found} == {"results/gym/sfm/global-n40-o0"}
    names = ["cameras.bin", "images.bin", "points3D.bin", "rigs.bin", "frames.bin"]
    assert [path.name for path in found] == names


def test_a_pattern_can_be_filled_in_part():
    assert paths.part(paths.LENS, session="gym") == "results/gym/calibration/lens/{camera}.toml"
    assert paths.part("{a}/{b}", b="{c}") == "{a}/{c}"


def test_a_figure_has_three_formats():
    assert paths.formats(["x", "y"]) == ["x.pdf", "x.png", "x.csv", "y.pdf", "y.png", "y.csv"]


def test_the_files_in_settings_are_those_of_some_keys_each_once():
    one = {"sync": "s", "pose2d": ["a", "b"], "pictures": {"left": "c", "right": "a"}}
    settings = [one, {"sync": "s", "pose2d": [], "pictures": {}, "take": "rally"}, one]
    assert paths.files_in(settings, "pose2d", "sync", "pictures") == ["a", "b", "s", "c"]
    assert (
        paths.files_in([{"court": "", "truth": [], "table": None}], "court", "truth", "table") == []
    )
    with pytest.raises(KeyError):
        paths.files_in(settings, "unknown")


def test_files_of_the_configuration_exist():
    config = Path(__file__).parents[3] / "config"
    found = [
        config / paths.COURT_YAML.format(court="badminton"),
        config / paths.SKELETON_YAML.format(skeleton="mocopi27"),
        config / paths.OFFSETS_CSV.format(model="blazepose-full"),
        config / paths.DERIVED_JOINTS_YAML,
        config / paths.PUBLISHED_CSV.format(table="badminton_tab01"),
        config / paths.PLAN_YAML.format(plan="plain-a"),
        config / paths.SESSION_YAML.format(session="plain-a"),
    ]
    assert [path for path in found if not path.is_file()] == []


def test_the_names_of_all_figures_and_tables_of_a_study_are_taken():
    rules = "".join(path.read_text("utf-8") for path in sorted(RULES.glob("*.smk")))
    drawn = set(re.findall(r'study_figure\(\s*"(\w+)"', rules))
    assert 'study_figure("thesis_fig3_{number}"' in rules
    drawn |= {"thesis_fig3_1", "thesis_fig3_2"}
    tables = {re.fullmatch(r"results/figures/(\w+)\.csv", str(v)) for v in vars(paths).values()}
    drawn |= {found[1] for found in tables if found}
    assert {"networks", "ways"} <= drawn
    assert set(paths.TAKEN_FIGURES) == drawn
