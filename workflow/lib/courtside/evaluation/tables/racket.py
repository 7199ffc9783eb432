"""Runs of measuring a racket: spreads, differences by run, agreement with the published values."""

from collections.abc import Iterator, Sequence

import numpy as np
import pandas as pd

from courtside.study.errors import StrPath

OURS, FLOOR, REFERENCES = "sfm18", "perfect", ("known8", "dlt8")  # method and number of clicks
ERRORS = ("mean_abs_mm", "std_below_mm", "std_above_mm")
PUBLISHED_MM = {  # [Shishido2020, sec 3.3, fig 12]
    "mean_abs_mm": {"8-point": 12.69, "SfM": 11.86},
    "std_below_mm": {"8-point": 6.21, "SfM": 6.27},
    "std_above_mm": {"8-point": 12.30, "SfM": 8.47},
}
TEXT = ("session", "preset", "layout", "method", "outcome")
QUANTILES = {"p05": 0.05, "p25": 0.25, "median": 0.5, "p75": 0.75, "p95": 0.95}
COLUMNS = (
    *("session", "layout", "quantity", "tip_sigma_px", "way", "reference", "tips", "frame", "n"),
    *(*QUANTILES, "mean", "n_failed", "ratio", "share_as_published", "share_reversed"),
    *("share_as_far", "share_as_far_reversed"),
)


def read(paths: Sequence[StrPath]) -> pd.DataFrame:
    """Read evaluations of a racket, of one or more sessions, into one table.

    No text is missing; `way` is method and number of clicks.
    """
    tables = [pd.read_csv(path, dtype=dict.fromkeys(TEXT, str)) for path in paths]
    rows = pd.concat(tables, ignore_index=True)
    rows["outcome"] = rows["outcome"].fillna("")
    clicks = rows["n_clicks"].astype(int).astype(str)
    rows["way"] = rows["method"] + clicks.where(rows["n_clicks"] > 0, "")
    return rows


def table(rows: pd.DataFrame) -> pd.DataFrame:
    """Return the numbers drawn, from rows of `read`.

    Quantities: those of `ERRORS` and `volume_rms_cm`, for each way; with a `reference` their
    differences by run (`tips` "same": both ways from the same clicks of the racket; "anew": from
    separate clicks); "all three": how often all errors are ordered as published; `length_mm`: the
    run drawn. The way `published` holds the paper's values.
    """
    parts = _published()
    for (session, layout), of in rows.groupby(["session", "layout"], sort=False):
        found = [*_volumes(of), *_lengths(of)]
        for sigma_px in np.unique(of["tip_sigma_px"]):
            part = of[of["tip_sigma_px"] == sigma_px]
            each = [*_spreads(part), *_differences(part)]
            found += [row | {"tip_sigma_px": sigma_px} for row in each]
        parts += [{"session": session, "layout": layout, **row} for row in found]
    whole = pd.DataFrame(parts).reindex(columns=COLUMNS)
    return whole.astype(dict.fromkeys(("frame", "n", "n_failed"), "Int64"))


def _published() -> list[dict]:
    return [
        {"quantity": name, "way": "published", "reference": way, "median": value}
        for name, values in PUBLISHED_MM.items()
        for way, value in values.items()
    ]


def _by_run(part: pd.DataFrame, column: str) -> pd.DataFrame:
    """Return a column of trials as a table of runs by ways."""
    return part.pivot(index="draw", columns="way", values=column)


def _spreads(part: pd.DataFrame) -> Iterator[dict]:
    first = part[~part["again"]]
    for name in ERRORS:
        values = _by_run(first, name)
        for way in values:
            ratio = values[way].mean() / values[FLOOR].mean()
            yield {"quantity": name, "way": way, **_spread(values[way]), "ratio": ratio}


def _volumes(of: pd.DataFrame) -> Iterator[dict]:
    first = of[~of["again"] & (of["tip_sigma_px"] == of["tip_sigma_px"].max())]
    values = _by_run(first, "volume_rms_cm")
    for way in values:
        yield {"quantity": "volume_rms_cm", "way": way, **_spread(values[way])}


def _spread(values: pd.Series) -> dict:
    known = values.dropna()
    found = {name: known.quantile(level) for name, level in QUANTILES.items()}
    return {"n": len(known), **found, "mean": known.mean(), "n_failed": len(values) - len(known)}


def _differences(part: pd.DataFrame) -> Iterator[dict]:
    """Yield the differences of the default to each reference, with the same and other clicks."""
    for tips, again in (("same", False), ("anew", True)):
        for reference in REFERENCES:
            about = {"way": OURS, "reference": reference, "tips": tips}
            off = {}
            for name in ERRORS:
                ours = _by_run(part[~part["again"]], name)[OURS]
                off[name] = ours - _by_run(part[part["again"] == again], name)[reference]
                known = {name: off[name]}
                yield {"quantity": name, **about, **_spread(off[name]), **_shares(known)}
            yield {"quantity": "all three", **about, **_shares(off)}


def _shares(off: dict[str, pd.Series]) -> dict:
    """Return how often runs differ as published: in sign, and at least as far; and reversed."""
    values = pd.DataFrame(off).dropna()
    published = pd.Series({n: PUBLISHED_MM[n]["SfM"] - PUBLISHED_MM[n]["8-point"] for n in off})
    along = values * np.sign(published)
    far = published.abs()
    return {
        "n": len(values),
        "share_as_published": (along > 0).all(axis=1).mean(),
        "share_reversed": (along < 0).all(axis=1).mean(),
        "share_as_far": (along >= far).all(axis=1).mean(),
        "share_as_far_reversed": (along <= -far).all(axis=1).mean(),
    }


def _lengths(of: pd.DataFrame) -> Iterator[dict]:
    """Yield the lengths of one run, by all ways: the run with the median error of the default."""
    sigma_px = of["tip_sigma_px"].max()
    part = of[~of["again"] & (of["tip_sigma_px"] == sigma_px)]
    ours = part[part["way"] == OURS].dropna(subset=["mean_abs_mm"])
    ours = ours.sort_values("mean_abs_mm", kind="stable")
    if ours.empty:
        return
    run = part[part["draw"] == ours["draw"].iloc[(len(ours) - 1) // 2]]
    for name in [column for column in part if column.startswith("length_")]:
        about = {
            "quantity": "length_mm",
            "tip_sigma_px": sigma_px,
            "frame": int(name.split("_")[1]),
        }
        for way, value in zip(run["way"], run[name], strict=True):
            yield {**about, "way": way, "median": value}
