"""Evaluations of a racket with chosen errors."""

import pandas as pd

ERRORS = ("mean_abs_mm", "std_below_mm", "std_above_mm")
WAYS = {"dlt8": ("dlt", 8), "known8": ("known", 8), "paper3": ("paper", 3)}
WAYS |= {"sfm8": ("sfm", 8), "sfm18": ("sfm", 18), "perfect": ("perfect", 0)}


def made(errors, *, session="hall", layout="a", sigma_px=1.8, again=False, lengths=(670.0, 678.0)):
    """Return rows of an evaluation: `errors` is a dict of way to a list of three errors (mm) per run.

    None instead of three errors is a run without a calibration.
    """
    rows = []
    for way, runs in errors.items():
        method, n_clicks = WAYS[way]
        for draw, values in enumerate(runs):
            row = {"session": session, "preset": "plain", "layout": layout, "offset": 0}
            row |= {"draw": draw, "tip_sigma_px": sigma_px, "again": again}
            row |= {"method": method, "n_clicks": n_clicks, "outcome": "" if values else "no"}
            if values:
                row |= {"volume_rms_cm": 1.0 + draw, **dict(zip(ERRORS, values, strict=True))}
                row |= {f"length_{at:02}_mm": mm + draw for at, mm in enumerate(lengths, start=1)}
            rows.append(row)
    return pd.DataFrame(rows)
