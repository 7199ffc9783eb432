"""One table of all ways to calibrate: errors, coverage, registration, paired differences."""

import numpy as np
import pandas as pd

from courtside.figures import trials
from courtside.geometry import court_trials

SEEDS = ["seed", "walk_seed"]  # sessions of one condition that differ in these only are pooled
METHOD = ["method", "mapper", "n_clicks", "in_sample"]
LABELS = ["session", "preset", "layout", "condition"]
# Columns of an evaluation table that are no setting of a varied session.
OTHERS = {
    *LABELS, *METHOD, *court_trials.COLUMNS, "n_bridging", "offset", "draw", "n_registered", "n_images",
    "n_fixed_registered", "n_points3d", "reprojection_px", "tie_residual_px", "neighbour_deg_median",
    "neighbour_deg_max",
}  # fmt: skip


def table(rows, *, n_reference=40):
    """Summarise trials.

    Parameters
    ----------
    rows : pandas.DataFrame
        Of `trials.tidy`.
    n_reference : int
        Number of bridging images that the others are compared with.

    Returns
    -------
    summary : pandas.DataFrame
        One row per session, method, mapper, clicks, in-sample or not, and number of bridging images;
        and one for all sessions of a condition together where they differ in their seeds only (session:
        `all N`). `n` trials with a result, `n_failed` without; of the structures from motion the share
        that led to a result (`solved_share`) and the mean share of registered images
        (`registered_share`); medians and 95 % quantiles; `coverage90` mean; and paired differences of
        the volume error, each as number of pairs, mean, 95 % upper confidence limit of the mean, and 95
        % quantile of the pairs: `vs_reference_...` to `n_reference` images (same draw, offset 0),
        `vs_known_...` to calibration from all known points (same session and draw, scored points left
        out or not alike).
    """
    rows = rows.assign(vs_reference=_to_reference(rows, n_reference), vs_known=_to_known(rows))
    settings = [name for name in rows if name not in OTHERS | {"vs_reference", "vs_known"}]
    keys = [*LABELS, *settings, *METHOD, "n_bridging"]
    groups = [
        {**dict(zip(keys, key, strict=True)), **_row(group)}
        for key, group in rows.groupby(keys, dropna=False, sort=True)
    ]
    pooled = [key for key in keys if key not in ("session", *SEEDS)]
    for key, group in rows[rows["condition"] != ""].groupby(pooled, dropna=False, sort=True):
        count = group["session"].nunique()
        if count > 1:
            groups.append(
                {"session": f"all {count}", **dict(zip(pooled, key, strict=True)), **_row(group)}
            )
    return pd.DataFrame(groups)[list(groups[0])]


def _to_reference(rows, n_reference):
    """Return the differences to the reference number of images; offset 0 only."""
    on = ["session", *METHOD, "draw"]
    first = rows["offset"] == 0
    difference = trials.against(rows, rows[first & (rows["n_bridging"] == n_reference)], on)
    return np.where(first, difference, np.nan)


def _to_known(rows):
    known = rows[rows["method"] == "known"]
    most = known.groupby("session")["n_clicks"].transform("max")
    return trials.against(rows, known[known["n_clicks"] == most], ["session", "in_sample", "draw"])


def _row(group):
    structures = trials.structures(group)
    volume, xy = trials.spread(group["volume_rms_cm"]), trials.spread(group["xy_cm"])
    return {
        "n": int(volume["n"]),
        "n_failed": int(len(group) - volume["n"]),
        "n_structures": len(structures),
        "solved_share": structures["solved_share"].mean(),
        "registered_share": structures["registered_share"].mean(),
        "volume_rms_cm_median": volume["median"],
        "volume_rms_cm_p95": volume["p95"],
        "xy_cm_median": xy["median"],
        "xy_cm_p95": xy["p95"],
        "predicted_volume_cm_median": group["predicted_volume_cm"].median(),
        "coverage90": group["coverage90"].mean(),
        **_differences(group, "vs_reference"),
        **_differences(group, "vs_known"),
    }


def _differences(group, name):
    scene = group["session"]
    if "seed" in group:  # walks through one scene share it; other sessions stand for themselves
        scene = group["seed"].astype(object).where(group["seed"].notna(), scene)
    structure = group["session"] + " " + group["offset"].fillna(0).astype(str)
    found = trials.spread(group[name])
    return {
        f"{name}_n": int(found["n"]),
        f"{name}_mean_cm": group[name].mean(),
        f"{name}_upper_cm": trials.upper_limit(group[name].to_numpy(), scene, structure),
        f"{name}_p95_cm": found["p95"],
    }
