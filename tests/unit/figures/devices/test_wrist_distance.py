"""The wrists' distance: rows of sources, zooms of claps, candidates with their reasons."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from courtside.events import detect
from courtside.figures.devices import wrist_distance
from courtside.records import tables
from fixtures import drawings
from fixtures.recordings import device_takes

HELD_M = 0.08


def wrists(offsets, claps_s=(3.0,), rate_hz=50.0):
    """Return wrists 1.5 m apart that close within 0.5 s before each clap and are held 0.5 s."""
    time_s = np.arange(0, 12, 1 / rate_hz)
    parts = []
    for source, offset in offsets.items():
        apart = np.full(time_s.shape, 1.5)
        for at in claps_s:
            closing = np.interp(time_s - at, [-0.5, 0, 0.5, 1.0], [1.5, HELD_M, HELD_M, 1.5])
            apart = np.minimum(apart, closing)
        own = time_s + offset
        about = {"source": source, "time_s": own, "own_time_s": own, "distance_m": apart}
        parts.append(pd.DataFrame(about))
    return pd.concat(parts, ignore_index=True)


def event(source, name, time_s, number=np.nan, why=""):
    return {
        "source": source,
        "event": name,
        "number": number,
        "time_s": time_s,
        "own_time_s": time_s,
        "uncertainty_s": 0.01 if name == "clap" else np.nan,
        "used": name != "none",
        "why": why,
    }


def spell(source, start_s=1.0, stop_s=2.0, number=1):
    return [
        event(source, f"tpose_{w}", t, number) for w, t in (("start", start_s), ("stop", stop_s))
    ]


TWO = {"cameras": 0.0, "mocopi": 0.0}
EVENTS = pd.DataFrame(
    [
        *spell("mocopi"),
        event("mocopi", "clap", 3.02, 1),
        event("mocopi", "none", 9.0, why="the arms are bent"),
        *spell("cameras"),
        event("cameras", "clap", 3.0, 1),
    ]
)


def test_claps_of_all_sources_share_a_panel_and_a_candidate_has_its_own():
    rows = wrist_distance.table(wrists(TWO, (3.0, 9.0)), EVENTS)
    claps = rows[rows["event"] == "clap"]
    assert claps["panel"].tolist() == [1, 1] and claps["source"].tolist() == ["cameras", "mocopi"]
    other = rows[rows["event"] == "none"].iloc[0]
    assert (other["panel"], other["note"]) == (2, "a")
    np.testing.assert_allclose(claps["floor_m"], HELD_M)
    assert rows.loc[rows["event"].str.startswith("tpose"), "panel"].isna().all()


def test_contacts_bands_and_distances_are_drawn_at_the_tables_values():
    distances = wrists(TWO, (3.0, 9.0))
    drawing = wrist_distance.draw(distances, wrist_distance.table(distances, EVENTS))
    drawing.draw_without_rendering()
    above, zooms, notes = drawing.subfigs
    assert [axis.get_title(loc="left") for axis in above.axes] == ["cameras", "mocopi"]
    own = distances[distances["source"] == "mocopi"]
    line = above.axes[1].lines[0]
    np.testing.assert_array_equal(line.get_xydata(), own[["time_s", "distance_m"]])
    band = above.axes[1].patches[0].get_bbox()
    assert (band.x0, band.x1) == (1.0, 2.0)
    first, second = (axis for axis in zooms.axes if axis.axison)
    assert first.get_title() == "clap 1, 3.01 s: within 20 ms"
    assert second.get_title() == "9.00 s: no clap (a)"
    contact = first.patches[0].get_bbox()
    assert (contact.x0, contact.x1) == pytest.approx((-10 - 16.45, -10 + 16.45))
    assert notes.texts[0].get_text() == "a (mocopi, 9.00 s): the arms are bent"


def test_sources_of_one_colour_are_told_apart_in_the_panels():
    kinds = {"cameras": "inertial", "mocopi": "inertial"}
    distances = wrists(TWO, (3.0, 9.0))
    events = wrist_distance.table(distances, EVENTS)
    above, zooms, _ = wrist_distance.draw(distances, events, kinds=kinds).subfigs
    named = [axis.get_legend().legend_handles[0].get_marker() for axis in above.axes]
    marked = [line.get_marker() for line in zooms.axes[0].lines]
    assert named == [marker for marker in marked if marker != "None"]
    assert len(set(named)) == 2


def test_without_clocks_each_source_is_shown_by_itself():
    distances = wrists({"cameras": 0.0, "mocopi": 0.1})
    events = wrist_distance.table(distances, EVENTS, aligned=False)
    claps = events[events["event"] == "clap"]
    assert claps["panel"].nunique() == 2
    drawing = wrist_distance.draw(distances, events, aligned=False)
    above, zooms, _ = drawing.subfigs
    assert "not synchronised" in above.axes[-1].get_xlabel()
    shared = above.axes[0].get_shared_x_axes().joined(*above.axes)
    assert not shared
    assert {axis.get_title() for axis in zooms.axes if axis.axison} >= {
        "clap 1, cameras, 3.00 s",
        "clap 1, mocopi, 3.02 s",
    }


def test_a_take_without_events_states_the_reason(tmp_path):
    why = "mocopi: expected a T-pose, found none; film one before the clap"
    events = pd.DataFrame([event("mocopi", "none", np.nan, why=why)])
    distances = wrists({"mocopi": 0.0})
    for name, rows in (("w", distances), ("e", events)):
        rows.to_csv(tmp_path / f"{name}.csv", index=False)
    distances, events = wrist_distance.read(tmp_path / "w.csv", tmp_path / "e.csv")
    drawing = wrist_distance.draw(distances, wrist_distance.table(distances, events), aligned=False)
    drawing.draw_without_rendering()
    assert len(drawing.subfigs) == 2
    assert drawing.subfigs[1].texts[0].get_text() == why


@pytest.mark.parametrize("aligned", [True, False])
def test_the_label_of_one_source_is_not_cut_off(aligned):
    own, events = wrists({"mocopi": 0.0}), pd.DataFrame([spell("mocopi")[0]])
    rows = wrist_distance.table(own, events, aligned=aligned)
    assert drawings.cut(wrist_distance.draw(own, rows, aligned=aligned)) == []


def test_reading_keeps_text_and_empty_reasons(tmp_path):
    for name, rows in (("w", wrists(TWO)), ("e", EVENTS)):
        rows.to_csv(tmp_path / f"{name}.csv", index=False)
    distances, events = wrist_distance.read(tmp_path / "w.csv", tmp_path / "e.csv")
    assert events["why"].tolist() == EVENTS["why"].tolist()
    assert len(distances) == len(wrists(TWO))


def test_sources_called_by_digits_keep_their_names(tmp_path):
    for name, rows in (("w", wrists({"01": 0.0})), ("e", pd.DataFrame([event("01", "clap", 1.0)]))):
        rows.to_csv(tmp_path / f"{name}.csv", index=False)
    for rows in wrist_distance.read(tmp_path / "w.csv", tmp_path / "e.csv"):
        assert set(rows["source"]) == {"01"}


def test_many_candidates_do_not_crowd_out_a_late_clap():
    events = [event("mocopi", "none", 0.5 + 0.6 * at, why="the arms are bent") for at in range(30)]
    events = pd.DataFrame([*events, event("mocopi", "clap", 30.0, 1)])
    distances = wrists({"mocopi": 0.0})
    rows = wrist_distance.table(distances, events)
    assert rows.loc[rows["event"] == "none", "note"].tolist()[25:28] == ["z", "aa", "ab"]
    drawing = wrist_distance.draw(distances, rows)
    titles = [axis.get_title() for axis in drawing.subfigs[1].axes]
    assert len(titles) == 9 and any(title.startswith("clap 1, 30.00 s") for title in titles)
    assert drawing.subfigs[2].texts[0].get_text().endswith("and 12 more, in the CSV")


def test_candidates_by_the_hundred_have_letters_of_their_own():
    """Hands that often come together, one time in a row: more than a to zz."""
    many = [event("mocopi", "none", 0.02 * at, why="the arms are bent") for at in range(703)]
    rows = wrist_distance.table(wrists({"mocopi": 0.0}), pd.DataFrame(many))
    assert rows["note"].iloc[[0, 25, 26, 701, 702]].tolist() == ["a", "z", "aa", "zz", "aaa"]
    assert rows["note"].is_unique


@pytest.mark.parametrize(("aligned", "panels"), [(True, [1, 2, 3, 1]), (False, [1, 3, 4, 2])])
def test_events_share_a_panel_to_half_a_second_from_the_first(aligned, panels):
    times = [("cameras", 3.0), ("cameras", 3.6), ("cameras", 4.2), ("mocopi", 3.4)]
    events = pd.DataFrame([event(source, "clap", time_s, 1) for source, time_s in times])
    rows = wrist_distance.table(wrists(TWO), events, aligned=aligned)
    assert rows["panel"].tolist() == panels


def test_times_of_a_clock_that_counts_from_1970_are_read_as_they_were_written(tmp_path):
    rng = np.random.default_rng(3)
    truth = device_takes.truth(3)
    motion = device_takes.device(rng, truth)
    motion = replace(motion, time_s=motion.time_s + 1715151474.88)
    tables.write(tmp_path / "wrists.csv", detect.wrists([motion]))
    tables.write(tmp_path / "events.csv", detect.events(detect.detect([motion])))
    found, events = wrist_distance.read(tmp_path / "wrists.csv", tmp_path / "events.csv")
    np.testing.assert_allclose(found["time_s"], motion.time_s, rtol=0, atol=1e-4)
    claps = events.loc[events["event"] == "clap", "own_time_s"]
    true = [truth[2][f"clap_{number}"] + 1715151474.88 for number in (1, 2)]
    np.testing.assert_allclose(claps, true, rtol=0, atol=0.05)
