"""Columns of the report's tables in words, with units; the files keep their names.

docs/results.md describes each column; these words say in short what it says.
"""

from collections.abc import Mapping

LABELS = {
    "model": "network",
    "fusion": "cameras and rule",
    "stage": "stage of the skeletons",
}
WALKS = "error less that with 40 pictures"
POINTS = "error less that from all known points"
PAIRS = {
    "n": "pairs",
    "mean_cm": "mean (cm)",
    "upper_cm": "95 % limit of the mean (cm)",
    "p95_cm": "95 % quantile (cm)",
}
CALIBRATION = {
    "preset": "kind of hall",
    "layout": "layout of the cameras",
    "width_px": "width of the pictures (px)",
    "seed": "seed of the hall",
    "walk_seed": "seed of the walk",
    "speed_kmh": "walking speed (km/h)",
    "baseline_deg": "angle between the cameras (degrees)",
    "strength": "strength of the effect",
    "mapper": "way of structure from motion",
    "n_clicks": "clicked points",
    "in_sample": "scored points were clicked",
    "click_strength": "errors of clicks (1: average)",
    "n_bridging": "pictures of the walk",
    "n": "trials with a result",
    "n_failed": "trials without a result",
    "n_structures": "structures from motion",
    "solved_share": "structures with a result (share)",
    "registered_share": "pictures in the structure (share)",
    "volume_rms_cm_median": "RMS error over the court, median (cm)",
    "volume_rms_cm_p95": "RMS error over the court, 95 % quantile (cm)",
    "xy_cm_median": "error of the ends of the court's axes, median (cm)",
    "xy_cm_p95": "error of the ends of the court's axes, 95 % quantile (cm)",
    "predicted_volume_cm_median": "predicted error over the court, median (cm)",
    "coverage90": "points in their 90 % ellipsoids (share)",
    "squared_ratio_median": "squared error over its stated variance, median",
    **{f"vs_reference_{end}": f"{WALKS}: {words}" for end, words in PAIRS.items()},
    **{f"vs_known_{end}": f"{POINTS}: {words}" for end, words in PAIRS.items()},
}
WAYS = {
    "base": "calibration before people refined it",
    "taken": "cameras taken",
    "expected_before_cm": "predicted error over the court, before (cm)",
    "expected_cm": "predicted error over the court (cm)",
    "volume_rms_cm": "true RMS error over the court (cm)",
    "shape_cm": "true RMS error after the best similarity (cm)",
    "accepted_percent": "accepted views of limb joints (%)",
    "n_views": "views of limb joints",
}
GAIN = {
    "median_mm": "median (mm)",
    "p95_mm": "95 % quantile (mm)",
    "paired_median_mm": "same places, median (mm)",
    "paired_p95_mm": "same places, 95 % quantile (mm)",
    "paired_median_from_mm": "same places, median, lower 95 % limit (mm)",
    "paired_median_to_mm": "same places, median, upper 95 % limit (mm)",
    "paired_p95_from_mm": "same places, 95 % quantile, lower 95 % limit (mm)",
    "paired_p95_to_mm": "same places, 95 % quantile, upper 95 % limit (mm)",
}
RULES = {"dlt": "error less that of plain DLT", "halfbody": "error less that of the half-body rule"}
MOVED = {"neck": "neck", "centre": "mean of 14 joints", "mass": "centre of mass"}
PLAYERS = {
    **LABELS,
    "n": "joints",
    "missing_percent": "missing joints (%)",
    "median_mm": "median error (mm)",
    "p95_mm": "95 % quantile of errors (mm)",
    "sigma_mm": "stated standard deviation (mm)",
    "bias_mm": "length of the mean error (mm)",
    "unbiased_median_mm": "median error without the mean error (mm)",
    "unbiased_p95_mm": "95 % quantile without the mean error (mm)",
    "n_large": "joints with errors above 100 mm",
    "coverage_90_large_percent": "large errors in their 90 % ellipsoids (%)",
    "identity_percent": "frames with the right person (%)",
    "worst_joint_median_mm": "median error of the worst joint (mm)",
    "joints_within": "kinds of joints with 80 to 97 % in their 90 % ellipsoids",
    "joints_stated": "kinds of joints with stated errors",
    **{f"coverage_{n}_percent": f"joints in their {n} % ellipsoids (%)" for n in (50, 90, 95)},
    **{
        f"coverage_{n}_{end}_percent": f"the joint with the {end}: in its {n} % ellipsoids (%)"
        for n in (50, 90, 95)
        for end in ("least", "most")
    },
    **{
        f"vs_{rule}_{end}": f"{less}: {words}"
        for rule, less in RULES.items()
        for end, words in GAIN.items()
    },
    "beats_others": "better than the other rules",
    "kinematics_seconds": "time with paths (s)",
    **{
        f"{point}_distance_error_percent": f"path of the {w}, error (%)"
        for point, w in MOVED.items()
    },
    **{
        f"{point}_speed_rmse_m_s": f"speed of the {w}, RMS error (m/s)"
        for point, w in MOVED.items()
    },
    "n_clocks": "clocks searched",
    "n_clocks_found": "clocks found",
    "n_clocks_within": "clocks within their stated 90 %",
    "clock_error_ms": "largest clock error (ms)",
}
ANGLES = {
    **LABELS,
    "n_persons": "persons",
    "n": "frames",
    "bias_deg": "mean error (degrees)",
    "rmse_deg": "RMS error (degrees)",
    "p95_deg": "95 % quantile of errors (degrees)",
    "sigma_deg": "stated standard deviation (degrees)",
    "within_90_percent": "errors within their stated 90 % (%)",
}
TABLES = {"calibration": CALIBRATION, "ways": WAYS, "players": PLAYERS, "angles": ANGLES}


def words(table: str, column: str) -> str:
    """Return the heading of a column; `table` is the name of its file without ending."""
    known: Mapping[str, str] = TABLES.get(table, {})
    return known.get(column, column.replace("_", " "))
