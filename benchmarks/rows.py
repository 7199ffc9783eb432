"""What a comparison hands back: one row for each method and amount of work."""

from dataclasses import dataclass

import numpy as np
import pandas as pd

NAN = float("nan")
OURS = "this project"
TIMES = 1, 2, 4, 8  # the work of a comparison: so many times its smallest


@dataclass(frozen=True)
class Row:
    """One method at one amount of work.

    Attributes
    ----------
    comparison, method : str
    ours : bool
    unit : str
        Of work: "point", "frame".
    work : float
        So many of them were worked on.
    times : float
        The work over that of the smallest run of the same comparison.
    cpu_s : float
        Processor time, user and system, all threads and child processes; the least of the repeats.
    limit_s : float
        What the machine needs at least for this work (`LIMIT` of the comparison says of what).
    error_median, error_p95, error_ours_p95 : float
        Error of the method's results; the last of this project's on the same work.
    error_unit : str
    """

    comparison: str
    method: str
    ours: bool
    unit: str
    work: float
    times: float
    cpu_s: float
    limit_s: float = NAN
    error_median: float = NAN
    error_p95: float = NAN
    error_ours_p95: float = NAN
    error_unit: str = ""


def table(rows):
    """Return the rows as a table with what follows from them, in the order of the rows.

    Parameters
    ----------
    rows : list of Row

    Returns
    -------
    table : pandas.DataFrame
        The fields of `Row`, and: `us_per_unit`; `over_ours`, the method's time per unit over this
        project's fastest in the same comparison at the nearest amount of work; `growth`, the time
        over the same method's at its smallest work; `over_limit`, the time over the machine's
        least.
    """
    found = pd.DataFrame([vars(row) for row in rows])
    found["us_per_unit"] = 1e6 * found["cpu_s"] / found["work"]
    found["over_ours"] = [_over_ours(found, row) for row in found.itertuples()]
    first = found.groupby(["comparison", "method"])["cpu_s"].transform("first")
    found["growth"] = found["cpu_s"] / first
    found["over_limit"] = found["cpu_s"] / found["limit_s"]
    return found


def _over_ours(found, row):
    ours = found[(found["comparison"] == row.comparison) & found["ours"]]
    if ours.empty:
        return NAN
    apart = np.abs(np.log(ours["times"] / row.times))
    nearest = ours[apart <= apart.min() + 1e-9]
    return row.us_per_unit / nearest["us_per_unit"].min()


def markdown(found):
    """Return the table as Markdown, a line a method: its largest work, and how its time grew."""
    head = ["comparison", "method", "work", "CPU per unit", "over ours", "growth", "over limit"]
    head += ["error, median / 95 %", "ours on the same, 95 %"]
    lines = ["| " + " | ".join(head) + " |", "|" + " --- |" * len(head)]
    for (comparison, method), group in found.groupby(["comparison", "method"], sort=False):
        last, first = group.iloc[-1], group.iloc[0]
        grown = last["work"] / first["work"]
        cells = [comparison, method, f"{last['work']:.0f} {last['unit']}s", _time(last)]
        cells += [f"{last['over_ours']:.3g}"]
        cells += [f"{last['growth']:.3g} at {grown:.3g}x" if grown > 1 else ""]
        cells += [_number(last["over_limit"])]
        cells += [" / ".join(filter(None, map(_number, last[["error_median", "error_p95"]])))]
        cells[-1] += f" {last['error_unit']}" if cells[-1] else ""
        cells += [_number(last["error_ours_p95"])]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def _number(value):
    return f"{value:.3g}" if np.isfinite(value) else ""


def _time(row):
    us = row["us_per_unit"]
    for factor, unit in ((1e6, "s"), (1e3, "ms")):
        if us >= factor:
            return f"{us / factor:.3g} {unit}"
    return f"{us:.3g} us"
