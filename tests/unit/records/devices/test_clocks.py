"""Clocks: their two directions, the file, and the line that stops their silent use."""

import json
import math

import numpy as np
import pytest

from courtside.records.devices import clocks
from courtside.study.errors import InputError

CLOCKS = {
    "a": clocks.Clock(status="reference"),
    "b": clocks.Clock(1.25, -80.0, 0.002, 30.0, "found", "adjusted"),
    "c": clocks.Clock(-0.5, 0.0, math.nan, 100.0, "ambiguous", "periodic", (0.5, 1.5)),
}


def test_a_clock_ahead_and_fast_converts_both_ways():
    clock = clocks.Clock(offset_s=2.0, drift_ppm=100.0)
    # 1000 s later a clock that runs 100 ppm fast has gained 0.1 s on its lead of 2 s.
    np.testing.assert_allclose(clock.from_reference([0.0, 1000.0]), [2.0, 1002.1], atol=1e-9)
    np.testing.assert_allclose(clock.to_reference([2.0, 1002.1]), [0.0, 1000.0], atol=1e-9)


def test_a_clock_that_agrees_changes_no_digit():
    time_s = np.arange(1000) / 29.97
    np.testing.assert_array_equal(clocks.Clock().from_reference(time_s), time_s)
    np.testing.assert_array_equal(clocks.Clock().to_reference(time_s), time_s)


def test_the_file_gives_back_what_was_written(tmp_path):
    clocks.write(tmp_path / "cameras.json", "a", CLOCKS)
    reference, found = clocks.read(tmp_path / "cameras.json")
    assert reference == "a"
    assert found["a"] == CLOCKS["a"]
    assert found["b"] == CLOCKS["b"]
    assert math.isnan(found["c"].uncertainty_s)
    assert found["c"].candidates_s == (0.5, 1.5)
    text = (tmp_path / "cameras.json").read_text()
    assert "NaN" not in text  # other languages' readers refuse it
    assert json.loads(text)["cameras"]["b"]["offset_s"] == 1.25


@pytest.mark.parametrize(
    "text",
    [
        "{",
        "[]",
        '{"form": "other"}',
        '{"form": "courtside sync 1", "reference": "a", "cameras": {}}',
    ],
)
def test_other_files_are_refused_in_one_line(tmp_path, text):
    (tmp_path / "x.json").write_text(text)
    with pytest.raises(InputError, match=r"x\.json: expected") as caught:
        clocks.read(tmp_path / "x.json")
    assert "\n" not in str(caught.value)


def test_a_doubt_is_kept_and_is_not_in_files_without_one(tmp_path):
    path = tmp_path / "clocks.json"
    doubted = clocks.Clock(status="found", doubt="frames are missing")
    clocks.write(path, "a", {"a": clocks.Clock(status="reference"), "b": doubted})
    assert clocks.read(path)[1]["b"] == doubted
    assert path.read_text().count("doubt") == 1


def test_an_impossible_status_in_a_file_is_refused(tmp_path):
    clocks.write(tmp_path / "x.json", "a", CLOCKS)
    text = (tmp_path / "x.json").read_text().replace('"found"', '"perhaps"')
    (tmp_path / "x.json").write_text(text)
    with pytest.raises(InputError, match="perhaps"):
        clocks.read(tmp_path / "x.json")


def test_the_reference_must_be_a_camera(tmp_path):
    with pytest.raises(ValueError, match="reference"):
        clocks.write(tmp_path / "x.json", "z", CLOCKS)


def test_a_doubtful_clock_is_named_with_its_offsets():
    assert not all(clock.usable for clock in CLOCKS.values())
    line = clocks.fault_line("take rally", CLOCKS)
    assert line.startswith("take rally: camera c: expected")
    assert "ambiguous (periodic), possible offsets 0.500, 1.500 s" in line
    assert line.endswith("under clocks of the take, or film a clap that all cameras see")
    sure = {name: CLOCKS[name] for name in "ab"}
    assert all(clock.usable for clock in sure.values())
    assert clocks.fault_line("take rally", sure) == ""
    device = clocks.fault_line("take rally", CLOCKS, "device")
    assert device.startswith("take rally: device c: expected")
    advice = "record a T-pose and a clap of the suit's wearer in view of the cameras"
    assert device.endswith(f"give its offset_s under clocks of the take, or {advice}")


def test_clocks_that_somebody_states_are_used():
    found = clocks.stated({"left": {"offset_s": 1.5, "uncertainty_s": 0.02}})
    assert found["left"].usable
    assert found["left"].to_reference(2.5) == pytest.approx(1.0)
    assert found["left"].uncertainty_s == 0.02


def test_cameras_that_show_few_common_times_are_told_what_would_show_them():
    found = {"a": clocks.Clock(status="reference"), "b": clocks.Clock(-6.0, status="found")}
    used = {"a": (120.0, 130.0), "b": (120.0, 130.0)}
    line = clocks.little_shared(used, found)
    assert "all cameras share 4.00 of 10.00 s" in line
    assert "[114.00, 130.00] lets all show what camera a shows from 120.00 to 130.00 s" in line
    assert clocks.little_shared(used, found | {"b": clocks.Clock(-0.5)}) == ""


def test_a_camera_that_begins_later_is_not_asked_for_pictures_before_it_began():
    """Camera b began 5 s after camera a: it has none of a's first 5 s."""
    found = {"a": clocks.Clock(status="reference"), "b": clocks.Clock(-5.0, status="found")}

    def told(trim_s):
        return clocks.little_shared(dict.fromkeys("ab", trim_s), found)

    assert "[0.00, 8.00] lets all show what camera a shows from 5.00 to 8.00 s" in told((2.0, 8.0))
    for trim_s in ((0.0, 8.0), (1.0, 4.0)):  # stated already, and over before b begins
        assert "end later: camera b begins at 5.00 s of camera a's clock" in told(trim_s)
        assert "lets all show" not in told(trim_s)
