"""Columns of the report's tables have headings that a reader knows, with units."""

import re
from pathlib import Path

import pytest

from courtside.evaluation.tables import calibration, ways
from courtside.pages.report import columns, figures
from courtside.study.jobs import report_page
from fixtures.study.data_dictionary import Dictionary

DOCUMENT = Path(__file__).parents[4] / "docs" / "results.md"
TOGETHER = "Columns of tables over takes and sessions"
PLACES = {
    "calibration": ["Columns of the evaluation"],
    "players": ["Columns of the evaluation of takes | errors"],
    "angles": ["Columns of the evaluation of takes | angles"],
    "ways": [],
}
LABELS = ("session", "take", "calibration", "model", "fusion", "stage")
SETTINGS = ("condition", "speed_kmh", "stabiliser", "effect", "strength", "seed", "walk_seed")
# Of a default run.
HEADS = {
    "calibration": (
        "session", "preset", "layout", *SETTINGS, "width_px", "method", "mapper", "n_clicks",
        "in_sample", "click_strength", "n_bridging", "n", "n_failed", "n_structures",
        "solved_share", "registered_share", "volume_rms_cm_median", "volume_rms_cm_p95",
        "xy_cm_median", "xy_cm_p95", "predicted_volume_cm_median", "coverage90",
        "squared_ratio_median", "vs_reference_n", "vs_reference_mean_cm", "vs_reference_upper_cm",
        "vs_reference_p95_cm", "vs_known_n", "vs_known_mean_cm", "vs_known_upper_cm",
        "vs_known_p95_cm",
    ),
    "players": (
        *LABELS, "n", "missing_percent", "median_mm", "p95_mm", "sigma_mm", "bias_mm",
        "unbiased_median_mm", "unbiased_p95_mm", "coverage_50_percent", "coverage_90_percent",
        "coverage_95_percent", "n_large", "coverage_90_large_percent", "identity_percent",
        "worst_joint_median_mm", "coverage_50_least_percent", "coverage_95_most_percent",
        "joints_within", "joints_stated", "vs_dlt_median_mm", "vs_dlt_p95_mm",
        "vs_dlt_paired_median_mm", "vs_dlt_paired_p95_mm", "vs_dlt_paired_median_from_mm",
        "vs_dlt_paired_median_to_mm", "vs_dlt_paired_p95_from_mm", "vs_dlt_paired_p95_to_mm",
        "vs_halfbody_median_mm", "vs_halfbody_paired_p95_to_mm", "beats_others",
        "kinematics_seconds", "neck_distance_error_percent", "neck_speed_rmse_m_s",
        "centre_distance_error_percent", "centre_speed_rmse_m_s", "mass_distance_error_percent",
        "mass_speed_rmse_m_s", "n_clocks", "n_clocks_found", "n_clocks_within", "clock_error_ms",
    ),
    "angles": (
        *LABELS, "angle", "n_persons", "n", "bias_deg", "rmse_deg", "p95_deg", "sigma_deg",
        "within_90_percent",
    ),
    "ways": ways.COLUMNS,
}  # fmt: skip
UNITS = {
    "mm": "(mm)",
    "cm": "(cm)",
    "px": "(px)",
    "percent": "(%)",
    "deg": "(degrees)",
    "ms": "(ms)",
    "seconds": "(s)",
    "share": "(share)",
    "kmh": "(km/h)",
    "m_s": "(m/s)",
}


def test_the_tables_of_the_report_are_those_with_words():
    assert {Path(file).stem for file in report_page.TABLES} == set(columns.TABLES) == set(HEADS)


@pytest.mark.parametrize("table", HEADS)
def test_every_column_has_words_and_its_unit(table):
    heads = {column: columns.words(table, column) for column in HEADS[table]}
    assert len(set(heads.values())) == len(heads)
    for column, head in heads.items():
        assert "_" not in head and not re.search(r"\b(p\d\d|vs|n|rmse|deg|dlt)\b", head), head
        parts = column.removesuffix("_median").removesuffix("_p95").split("_")
        ends = {parts[-1], "_".join(parts[-2:])} & set(UNITS)
        assert [unit for unit in map(UNITS.get, ends) if unit not in head] == [], (column, head)


@pytest.mark.parametrize("table", HEADS)
def test_words_are_of_columns_that_the_data_dictionary_describes(table):
    dictionary = Dictionary(DOCUMENT.read_text(encoding="utf-8"))
    places = [f"{TOGETHER} | {table}.csv", ": identify a row", *PLACES[table]]
    assert dictionary.undescribed([*columns.TABLES[table], "volume_rms"], places) == ["volume_rms"]


def test_words_say_what_the_column_holds():
    assert columns.words("players", "vs_dlt_paired_p95_from_mm") == (
        "error less that of plain DLT: same places, 95 % quantile, lower 95 % limit (mm)"
    )
    assert columns.words("angles", "within_90_percent") == "errors within their stated 90 % (%)"
    assert columns.words("angles", "n") == "frames"
    assert columns.words("players", "n") == "joints"
    assert f"with {calibration.N_REFERENCE} pictures:" in columns.words(
        "calibration", "vs_reference_mean_cm"
    )
    assert columns.words("another", "some_column") == "some column"


def test_a_heading_in_words_has_the_name_in_the_file_as_a_tip(tmp_path):
    (tmp_path / "angles.csv").write_text("angle,rmse_deg\nknee_flexion,4.8183\n")
    entry = {"file": tmp_path / "angles.csv", "title": "t", "words": "", "link": "angles.csv"}
    html = figures.table(entry)
    assert "<th scope='col'>angle</th>" in html
    assert "<th scope='col' title=\"rmse_deg\">RMS error (degrees)</th>" in html
