"""Made-up results trees: what is equal, what is close enough, and what is not."""

import json
import math

import numpy as np
import pytest

from courtside.study.provenance import comparison

POSE = "gym/takes/t/pose3d/file/all/net.npz"
TABLE = "gym/evaluation/errors.csv"


@pytest.fixture
def trees(tmp_path):
    """Return two results folders of the same files."""
    for name in ("here", "there"):
        write(tmp_path / name / POSE, xyz=np.array([[1.0, np.nan, 3.0]]), reason=np.array([0, 2]))
        folder = tmp_path / name / "gym"
        (folder / "evaluation").mkdir()
        (folder / "logs").mkdir()
        (folder / "figures").mkdir()
        (folder / "logs" / "a.log").write_text(name)
        (tmp_path / name / TABLE).write_text("camera,error_cm\nleft,1.0\nright,\n")
        (folder / "figures" / "f.csv").write_text("x\n1.0000\n")
        (folder / "figures" / "f.pdf").write_text("drawing")
        (folder / "video.mp4").write_text("frames")
    return tmp_path / "here", tmp_path / "there"


def write(path, **arrays):
    path.parent.mkdir(parents=True, exist_ok=True)
    np.savez(path, **arrays)


def outcomes(trees):
    return {v.name: v.outcome for v in comparison.compare(*trees) if v.outcome != comparison.EQUAL}


def test_equal_trees_are_bit_equal_and_logs_do_not_count(trees):
    verdicts = comparison.compare(*trees)
    names = {POSE, TABLE, "gym/figures/f.csv", "gym/figures/f.pdf", "gym/video.mp4"}
    assert {v.name for v in verdicts} == names  # logs say when, not what
    assert {v.outcome for v in verdicts} == {comparison.EQUAL}


@pytest.mark.parametrize(
    ("xyz", "reason", "outcome", "largest"),
    [
        ([[1.001, np.nan, 3.0]], [0, 2], comparison.CLOSE, 0.001),
        ([[1.003, np.nan, 3.0]], [0, 2], comparison.DIFFERENT, 0.003),
        ([[1.0, 2.0, 3.0]], [0, 2], comparison.DIFFERENT, 0.0),
        ([[1.0, np.nan, 3.0]], [0, 3], comparison.DIFFERENT, 1.0),
        ([[1.0, np.nan]], [0, 2], comparison.DIFFERENT, math.nan),
    ],
    ids=["1 mm", "3 mm", "a value that was missing", "another reason", "another shape"],
)
def test_arrays_are_close_within_their_tolerance(trees, xyz, reason, outcome, largest):
    write(trees[1] / POSE, xyz=np.array(xyz), reason=np.array(reason))
    (found,) = [v for v in comparison.compare(*trees) if v.name == POSE]
    assert found.outcome == outcome
    np.testing.assert_allclose(found.largest, largest, atol=1e-9)


def test_missing_or_damaged_arrays_are_different(trees):
    write(trees[1] / POSE, xyz=np.array([[1.0, np.nan, 3.0]]))
    assert outcomes(trees) == {POSE: comparison.DIFFERENT}
    (trees[1] / POSE).write_bytes(b"PK not really")
    assert outcomes(trees) == {POSE: comparison.DIFFERENT}


@pytest.mark.parametrize(
    ("text", "outcome"),
    [
        ("camera,error_cm\nleft,1.01\nright,\n", comparison.CLOSE),
        ("camera,error_cm\nleft,1.000\nright,\n", comparison.CLOSE),
        ("camera,error_cm\nleft,1.1\nright,\n", comparison.DIFFERENT),
        ("camera,error_cm\nleft,1.0\nright,0\n", comparison.DIFFERENT),
        ("camera,error_cm\nback,1.0\nright,\n", comparison.DIFFERENT),
        ("camera,error_mm\nleft,1.0\nright,\n", comparison.DIFFERENT),
        ("camera,error_cm\nleft,1.0\n", comparison.DIFFERENT),
    ],
    ids=["close", "digits", "far", "filled", "renamed", "column", "row"],
)
def test_tables_are_close_within_their_tolerance(trees, text, outcome):
    (trees[1] / TABLE).write_text(text)
    assert outcomes(trees) == {TABLE: outcome}


@pytest.mark.parametrize(
    ("content", "outcome"),
    [
        ({"a": [1.0, {"b": None}], "c": True, "d": "x"}, comparison.CLOSE),
        ({"a": [1.00001, {"b": None}], "c": True, "d": "x"}, comparison.CLOSE),
        ({"a": [1.001, {"b": None}], "c": True, "d": "x"}, comparison.DIFFERENT),
        ({"a": [1.0, {"b": 0}], "c": True, "d": "x"}, comparison.DIFFERENT),
        ({"a": [1.0, {"b": None}], "c": False, "d": "x"}, comparison.DIFFERENT),
        ({"a": [1.0, {"b": None}], "c": True, "d": "y"}, comparison.DIFFERENT),
        ({"a": [1.0], "c": True, "d": "x"}, comparison.DIFFERENT),
    ],
)
def test_json_is_close_where_only_numbers_differ_a_little(trees, content, outcome):
    one = {"a": [1.0, {"b": None}], "c": True, "d": "x"}
    (trees[0] / "s.json").write_text(json.dumps(one))
    (trees[1] / "s.json").write_text(json.dumps(content, indent=1))
    assert outcomes(trees) == {"s.json": outcome}


def test_cameras_a_little_apart_are_within_tolerance(trees):
    folder = "gym/calibration/file"
    for tree, value in zip(trees, (1000.0, 1000.5), strict=True):
        (tree / folder).mkdir(parents=True)
        (tree / folder / "cameras.toml").write_text(f"[left]\nmatrix = [[{value}, 0.0]]\n")
    assert outcomes(trees) == {f"{folder}/cameras.toml": comparison.CLOSE}


@pytest.mark.parametrize(
    ("key", "value", "gap"),
    [("translation", 10.0, 0.0105), ("rotation", 1.2, 0.002), ("matrix", 1500.0, 1.5)],
)
def test_cameras_may_be_as_far_apart_as_the_tolerance_says(trees, key, value, gap):
    name = "gym/calibration/file/cameras.toml"
    for by, outcome in ((gap, comparison.CLOSE), (2 * gap, comparison.DIFFERENT)):
        for tree, number in zip(trees, (value, value + by), strict=True):
            (tree / name).parent.mkdir(parents=True, exist_ok=True)
            (tree / name).write_text(f"[left]\n{key} = [{number}, 0.0]\n")
        assert outcomes(trees) == {name: outcome}
    assert "about 1 cm and 2 mrad of a camera 10 m away, 0.1 % of px" in comparison.stated(name)


@pytest.mark.parametrize(
    ("number", "drawing"),
    [
        ("1.0000", comparison.DIFFERENT),
        ("1.0100", comparison.CLOSE),
        ("1.5000", comparison.DIFFERENT),
    ],
    ids=["same numbers", "close numbers", "other numbers"],
)
def test_a_drawing_is_as_close_as_its_numbers(trees, number, drawing):
    (trees[1] / "gym/figures/f.pdf").write_text("other drawing")
    (trees[1] / "gym/figures/f.csv").write_text(f"x\n{number}\n")
    assert outcomes(trees)["gym/figures/f.pdf"] == drawing


@pytest.mark.parametrize(
    ("name", "text", "close", "far"),
    [
        ("net.p1.mot", "time\tarm_flex_r\n0.0\t{}\n", (60.0, 60.1), (60.0, 61.0)),
        ("net.p1.osim", "<Body><mass>{}</mass></Body>", (7.5, 7.501), (7.5, 7.51)),
        ("net.p1.bvh", "MOTION\nFrames: 1\n{} 0\n", (1.0, 1.001), (1.0, 1.1)),
    ],
)
def test_models_and_motions_for_opensim_are_compared_number_by_number(
    trees, name, text, close, far
):
    name = f"gym/takes/t/pose3d_ik/file/all/{name}"
    (trees[0] / name).parent.mkdir(parents=True)
    (trees[1] / name).parent.mkdir(parents=True)
    for numbers, outcome in ((close, comparison.CLOSE), (far, comparison.DIFFERENT)):
        for tree, number in zip(trees, numbers, strict=True):
            (tree / name).write_text(text.format(number))
        assert outcomes(trees) == {name: outcome}


@pytest.mark.parametrize(
    ("name", "outcome"),
    [
        ("gym/video.mp4", comparison.OTHER_BYTES),
        ("virtual/gym/backdrops.npz", comparison.OTHER_BYTES),
        ("networks/a.onnx", comparison.DIFFERENT),
    ],
)
def test_what_nobody_can_read(trees, name, outcome):
    for tree, text in zip(trees, ("weights", "Weights"), strict=True):
        (tree / name).parent.mkdir(parents=True, exist_ok=True)
        (tree / name).write_text(text)
    assert outcomes(trees) == {name: outcome}
    assert (outcome in comparison.FAULTS) == name.startswith("networks")


@pytest.mark.parametrize(
    ("words", "outcome"),
    [
        ("ROOT hips\n1.00001  2", comparison.CLOSE),
        ("ROOT hips 1.1 2", comparison.DIFFERENT),
        ("ROOT Hips 1 2", comparison.DIFFERENT),
        ("ROOT hips 1 2 3", comparison.DIFFERENT),
    ],
)
def test_words_and_numbers(trees, words, outcome):
    for tree, text in zip(trees, ("ROOT hips\n1 2\n", words), strict=True):
        (tree / "suit.bvh").write_text(text)
    assert outcomes(trees) == {"suit.bvh": outcome}


def test_figures_of_run_times_are_not_compared(trees):
    for tree, seconds in zip(trees, ("1", "9"), strict=True):
        (tree / "gym/figures/growth.csv").write_text(f"seconds\n{seconds}\n")
    assert outcomes(trees) == {"gym/figures/growth.csv": comparison.TIMES}


def test_files_that_only_one_tree_has_are_faults(trees):
    (trees[0] / "mine.csv").write_text("x")
    (trees[1] / "yours.csv").write_text("x")
    assert outcomes(trees) == {
        "mine.csv": comparison.ONLY_HERE,
        "yours.csv": comparison.ONLY_THERE,
    }


def test_the_table_states_tolerances_and_names_what_differs(trees):
    (trees[1] / TABLE).write_text("camera,error_cm\nleft,1.01\nright,\n")
    write(trees[1] / POSE, xyz=np.array([[2.0, np.nan, 3.0]]), reason=np.array([0, 2]))
    lines = comparison.table(comparison.compare(*trees))
    cells = {line.split()[0]: line.split()[1:] for line in lines[1:]}
    none = ["0"] * 2
    counts = {name: row[:7] for name, row in cells.items()}
    assert (
        counts
        == {  # bit-equal, close, other bytes, run times, different, only here, only there
            "*/evaluation/*": ["0", "1", *none, "0", *none],
            "*/pose3d*/*": ["0", "0", *none, "1", *none],
            "*/figures/*": ["2", "0", *none, "0", *none],
            "*": ["1", "0", *none, "0", *none],
            f"{POSE}:": lines[-1].split()[1:],
        }
    )
    assert cells["*/evaluation/*"][7:11] == ["0.01", "0.02", "+", "0.02"]
    assert cells["*/pose3d*/*"][7:9] == ["1", "0.002"]
    assert lines[-1] == f"{POSE}: different by up to 1"
    assert len(lines) == 1 + 4 + 1


def test_every_kind_of_result_has_a_tolerance():
    assert comparison.stated("external/x.npz")[1:3] == (0.0, 0.0)
    assert comparison.stated("gym/takes/t/pose3d_filtered/a/b.npz")[1:3] == (0.0, 2e-3)
    assert comparison.stated("provenance-free.csv")[1:3] == (1e-4, 1e-4)


def test_what_rests_on_keypoints_may_differ_as_they_do():
    take = "gym/takes/t"
    rest = ("sync/known/cameras.m.json", "people/known/m.npz", "body/cameras.m.npz")
    rest += ("motion/known/all/m.angles.csv", "motion/known/all/m.npz", "views/known.m.csv")
    for name in ["figures/study.csv", *(f"{take}/{name}" for name in rest)]:
        assert max(comparison.stated(name)[1:3]) >= 2e-3
