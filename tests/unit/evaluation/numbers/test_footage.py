"""Raw and corrected joints stand side by side, for virtual takes as for real ones."""

from pathlib import Path

from courtside.evaluation.numbers import footage, register, stated

ROOT = Path(__file__).parents[4]


def test_each_reference_is_named_and_has_all_three_stages(source):
    rows = {}
    stands = [one for one in stated.numbers(register.Source(ROOT)) if one.table == footage.TABLE]
    for number in [*footage.corrections(source), *stands]:
        rows.setdefault(number.row, set()).add(number.part.split("_")[0])
    assert len(rows) >= 3
    assert all(" against " in row for row in rows)
    assert all(stages == {"raw", "filtered", "corrected"} for stages in rows.values())


def test_single_joints_and_fewer_cameras_are_shown(source, value):
    found = footage.joints(source)
    assert {n.row.split(",")[0] for n in found} == {"left elbow"}
    assert value(found, "left elbow, `players-a/shot`", "corrected_median").printed == "20"
    (row,) = {n.row for n in footage.views(source)}
    assert row == "`walk-4cams/balancing`: 2 cameras, plain DLT"
    assert value(footage.views(source), row, "exchanged").value == 31
