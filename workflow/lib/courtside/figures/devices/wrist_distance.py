"""The distance of the wrists over time with T-poses and claps, and each clap enlarged."""

import textwrap
from string import ascii_lowercase

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from courtside.events.claps import HELD_S
from courtside.figures.style import bars, source_styles, style
from courtside.records import tables
from courtside.statistics import normal_errors
from courtside.study.errors import StrPath

ROW_MM, TICKS_MM, ZOOM_MM, LINE_MM = 19, 4, 48, 3.4
LABEL_MM = 44  # the rows' common label needs as much
N_COLUMNS, MOST_PANELS, MOST_NOTES = 3, 9, 18
SAME_S = 0.5  # ASSUME: claps of different sources closer than this are one clap
BEFORE_S, AFTER_S = 0.15, 0.3  # shown about a clap
TOP_M = 0.6  # shown of it
TPOSE, NOT = "#dddddd", "#888888"
WRAP = 128
MS = 1000


def read(wrists_csv: StrPath, events_csv: StrPath) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Read wrists and events as `courtside.events.detect` has them."""
    events = tables.read(events_csv, "a table of events")
    why = events["why"].astype(object).where(events["why"].notna(), "").astype(str)
    return tables.read(wrists_csv, "a table of wrists"), events.assign(why=why)


def table(wrists: pd.DataFrame, events: pd.DataFrame, *, aligned: bool = True) -> pd.DataFrame:
    """Add to each event the panel that shows it, and the distance of the held wrists.

    Events are ordered by source and time. `wrists` and `events` are of `courtside.events.detect`;
    if time_s is not `aligned`, on one clock for all sources, each source is shown by itself.
    """
    rows = events.assign(panel=np.nan, floor_m=np.nan, note="")
    place = rows["source"].map({name: at for at, name in enumerate(wrists["source"].unique())})
    rows = rows.iloc[np.lexsort([rows["time_s"], place])].reset_index(drop=True)
    shown = rows[rows["event"].isin(["clap", "none"]) & rows["time_s"].notna()]
    for at, row in shown.iterrows():
        own = wrists[wrists["source"] == row["source"]]
        held = (own["time_s"] - row["time_s"]).between(*HELD_S)
        rows.loc[at, "floor_m"] = own.loc[held, "distance_m"].median()
    for number, members in enumerate(_together(shown, aligned), 1):
        rows.loc[members, "panel"] = number
    missed = shown.index[shown["event"] == "none"]
    rows.loc[missed, "note"] = [_letter(at) for at in range(len(missed))]
    return rows


def draw(
    wrists: pd.DataFrame,
    events: pd.DataFrame,
    *,
    kinds: dict[str, str] | None = None,
    aligned: bool = True,
) -> Figure:
    """Draw the whole take, one row for each source, and below it every clap.

    `wrists` are of `courtside.events.detect`, `events` of `table`, `aligned` as for it, `kinds` as
    for `courtside.figures.style.source_styles.kind_of`.
    """
    looks = source_styles.looks(wrists["source"], kinds)
    notes, panels = _notes(events), _panels(events)
    n_rows = -(-len(panels) // N_COLUMNS)
    row_mm = ROW_MM + (0 if aligned else TICKS_MM)
    rows_mm = max(12 + row_mm * len(looks), LABEL_MM)
    heights = [rows_mm, ZOOM_MM * n_rows, 4 + LINE_MM * len(notes)]
    wanted = [True, n_rows > 0, bool(notes)]
    heights = [height for height, want in zip(heights, wanted, strict=True) if want]
    drawing = style.figure(sum(heights) + 12)
    parts = list(drawing.subfigures(len(heights), 1, height_ratios=heights, squeeze=False).ravel())
    _draw_rows(parts.pop(0), wrists, events, looks, aligned)
    if n_rows:
        _draw_zooms(parts.pop(0), wrists, events, panels, looks, aligned)
    if notes:
        parts.pop(0).text(0.01, 0.98, "\n".join(notes), va="top", fontsize=6.5, linespacing=1.25)
    drawing.legend(handles=_marks(), loc="outside lower center", ncols=5, columnspacing=1.2)
    return drawing


def _together(shown: pd.DataFrame, aligned: bool) -> list[list[int]]:
    """Return lists of the index of simultaneous events."""
    groups: list[list[int]] = []
    latest: dict[str, tuple[float, list[int]]] = {}  # by source: start and members of its last one
    for row in shown.sort_values("time_s", kind="stable").itertuples():
        source = "" if aligned else row.source
        start_s, members = latest.get(source, (-np.inf, []))
        if row.time_s - start_s <= SAME_S:
            members.append(row.Index)
        else:
            groups.append([row.Index])
            latest[source] = row.time_s, groups[-1]
    return groups


def _letter(at: int) -> str:
    """Return a, b ... z, aa, ab ... of 0, 1 ... ."""
    more, letter = divmod(at, 26)
    return (_letter(more - 1) if more else "") + ascii_lowercase[letter]


def _panels(events: pd.DataFrame) -> list[float]:
    """Return the numbers of the panels shown, in order of time; those with a clap have priority."""
    with_clap = set(events.loc[events["event"] == "clap", "panel"])
    numbers = events["panel"].dropna().unique()
    ranked = sorted(numbers, key=lambda number: (number not in with_clap, number))
    return sorted(ranked[:MOST_PANELS])


def _notes(events: pd.DataFrame) -> list[str]:
    """Return lines that say why candidates are not claps, and what is missing."""
    missed = events[events["event"] == "none"]
    lines = []
    for row in missed.head(MOST_NOTES).itertuples():
        note = f"{row.note} ({row.source}, {row.time_s:.2f} s): {row.why}"
        if not np.isfinite(row.time_s):
            note = row.why if row.why.startswith(row.source) else f"{row.source}: {row.why}"
        lines += textwrap.wrap(note, WRAP, subsequent_indent="    ")
    if len(missed) > MOST_NOTES:
        lines.append(f"and {len(missed) - MOST_NOTES} more, in the CSV")
    return lines


def _draw_rows(part, wrists, events, looks, aligned) -> None:
    axes = part.subplots(len(looks), 1, sharex=aligned, squeeze=False)[:, 0]
    top = wrists["distance_m"].max()
    top = 1.25 * top if np.isfinite(top) else 1.0
    for axis, (source, look) in zip(axes, looks.items(), strict=True):
        own = wrists[wrists["source"] == source]
        axis.plot(own["time_s"], own["distance_m"], color=look.colour, linewidth=0.8)
        _draw_events(axis, events[events["source"] == source], look.colour, top)
        axis.set_ylim(0, top)
        axis.set_title(source, loc="left", color=look.colour, pad=2)
        # Its look in the panels below, where sources of one kind have one colour.
        shown = bars.mark(look.colour, marker=look.marker, line=look.line)
        axis.legend(handles=[shown], labels=[""], loc="lower right", bbox_to_anchor=(1, 0.95),
                    borderpad=0, borderaxespad=0, handletextpad=0, handlelength=3)  # fmt: skip
    clock = "on the reference clock" if aligned else "on each source's own clock: not synchronised"
    axes[-1].set_xlabel(f"time (s), {clock}")
    part.supylabel("distance of the wrists (m)", fontsize=8)


def _draw_events(axis: Axes, own, colour: str, top) -> None:
    spells = own.pivot_table(index="number", columns="event", values="time_s")
    if {"tpose_start", "tpose_stop"} <= set(spells):
        for row in spells.dropna(subset=["tpose_start", "tpose_stop"]).itertuples():
            axis.axvspan(row.tpose_start, row.tpose_stop, color=TPOSE, linewidth=0, zorder=0)
    for row in own[own["event"] == "clap"].itertuples():
        axis.axvline(row.time_s, color=colour, linewidth=0.7)
        axis.text(row.time_s, top, f" {row.number:.0f}", va="top", color=colour, fontsize=7)
    for row in own[own["note"] != ""].itertuples():
        axis.axvline(row.time_s, color=NOT, linewidth=0.7, linestyle="--")
        axis.text(row.time_s, top, f" {row.note}", va="top", color=NOT, fontsize=7)


def _draw_zooms(part, wrists, events, panels, looks, aligned) -> None:
    n_rows = -(-len(panels) // N_COLUMNS)
    axes = part.subplots(n_rows, N_COLUMNS, squeeze=False).ravel()
    for axis, panel in zip(axes, panels, strict=False):
        members = events[events["panel"] == panel]
        claps = members[members["event"] == "clap"]
        centre_s = (claps if len(claps) else members)["time_s"].median()
        sources = looks if aligned else dict.fromkeys(members["source"])
        for source in sources:
            _draw_close(axis, wrists[wrists["source"] == source], centre_s, looks[source])
        for row in members.itertuples():
            _draw_contact(axis, row, centre_s, looks[row.source].colour)
        axis.set_xlim(-MS * BEFORE_S, MS * AFTER_S)
        axis.set_ylim(0, TOP_M)
        axis.set_title(_title(members, claps, centre_s, aligned))
    for axis in axes[len(panels) :]:
        axis.set_axis_off()
    for axis in axes[::N_COLUMNS]:
        axis.set_ylabel("distance (m)")
    left = events["panel"].nunique() - len(panels)
    also = f" ({left} more times at which the hands come together are not shown)" if left else ""
    part.supxlabel(
        f"time from the contact, their median where there are several (ms){also}", fontsize=8
    )


def _draw_close(axis: Axes, own, centre_s, look) -> None:
    near = own[(own["time_s"] - centre_s).between(-BEFORE_S, AFTER_S)]
    time_ms = MS * (near["time_s"] - centre_s)
    axis.plot(time_ms, near["distance_m"], look.line, color=look.colour, linewidth=0.8)
    axis.plot(time_ms, near["distance_m"], look.marker, color=look.colour, markersize=2.2)


def _draw_contact(axis: Axes, row, centre_s, colour: str) -> None:
    at = MS * (row.time_s - centre_s)
    if row.event == "clap":
        reach = MS * normal_errors.WITHIN_90 * row.uncertainty_s
        axis.axvspan(at - reach, at + reach, color=colour, alpha=0.15, linewidth=0, zorder=0)
        axis.axvline(at, color=colour, linewidth=0.9)
        held = at + MS * np.array(HELD_S)
        axis.plot(held, [row.floor_m] * 2, color=colour, linewidth=2.2, alpha=0.6)
    else:
        axis.axvline(at, color=colour, linewidth=0.7, linestyle="--")


def _title(members: pd.DataFrame, claps: pd.DataFrame, centre_s: float, aligned: bool) -> str:
    when = f"{centre_s:.2f} s" if aligned else f"{members['source'].iloc[0]}, {centre_s:.2f} s"
    if claps.empty:
        return f"{when}: no clap ({', '.join(members['note'])})"
    numbers = "/".join(f"{number:.0f}" for number in sorted(set(claps["number"])))
    spread = f": within {MS * np.ptp(claps['time_s']):.0f} ms" if len(claps) > 1 else ""
    return f"clap {numbers}, {when}{spread}"


def _marks() -> list:
    return [
        Patch(color=TPOSE, label="T-pose"),
        bars.mark(style.MIDDLE, marker="", line="-", label="clap: contact"),
        Patch(color=style.MIDDLE, alpha=0.2, label="its 90 % interval"),
        Line2D([], [], color=style.MIDDLE, alpha=0.6, linewidth=2.2, label="held, median"),
        bars.mark(NOT, marker="", line="--", label="hands together, no clap (letters)"),
    ]
