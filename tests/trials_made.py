"""Made-up evaluation tables, as the evaluations write them, with numbers that can be worked out by hand."""

import pandas as pd

from courtside.evaluation import calibration

ABOUT = {
    "n_images": 12,
    "n_fixed_registered": 2,
    "n_points3d": 900,
    "reprojection_px": 0.7,
    "tie_residual_px": 0.9,
}


def structure(
    errors_cm, *, session="plain-a", mapper="global", n_bridging=10, offset=0, **settings
):
    """Return the rows of one structure from motion.

    `errors_cm`: by (method, clicks, in-sample), the volume error of each draw; a number instead of a
    dict means so many draws without a result. X_o/Y_o errors are twice, expected errors half as large.
    """
    failed = isinstance(errors_cm, int)
    labels = {"session": session, "preset": "plain", "layout": "a", **settings}
    labels |= {"mapper": mapper, "n_bridging": n_bridging, "offset": offset, **ABOUT}
    labels["n_registered"] = 6 if failed else 12
    labels["neighbour_deg_median"] = None if failed else 90 / (n_bridging + 1)
    labels["neighbour_deg_max"] = None if failed else 120 / (n_bridging + 1)
    if failed:
        outcome = "camera back: expected 20 points, found 3; film again"
        return table([{**labels, "draw": draw, "outcome": outcome} for draw in range(errors_cm)])
    return table([{**labels, **row} for row in trials(errors_cm)])


def known(errors_cm, *, session="plain-a", **settings):
    """Return the rows of calibration from known points; None is a draw without a result."""
    labels = {"session": session, "preset": "plain", "layout": "a", **settings}
    return table([{**labels, **row} for row in trials(errors_cm)])


def trials(errors_cm):
    for (method, n_clicks, in_sample), values in errors_cm.items():
        for draw, value in enumerate(values):
            row = {"draw": draw, "method": method, "n_clicks": n_clicks, "in_sample": in_sample}
            if value is None:
                yield row | {"outcome": "too few points"}
                continue
            row |= {"outcome": "", "volume_rms_cm": value, "xy_cm": 2 * value}
            if method == "sfm":
                row |= {"coverage50": 0.4, "coverage90": 0.8, "coverage95": 0.9}
                row["predicted_volume_cm"] = value / 2
            yield row


def table(rows):
    made = pd.DataFrame(rows)
    first = [name for name in made if name not in calibration.COLUMNS]
    return made.reindex(columns=[*first, *calibration.COLUMNS])
