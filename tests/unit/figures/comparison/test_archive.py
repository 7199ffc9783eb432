"""The figure of past and present shows every measure, its band, and the marks of mixtures."""

import numpy as np
import pandas as pd
from matplotlib.colors import to_hex

from courtside.figures.comparison import archive
from courtside.statistics import longitudinal

VALUES = pd.DataFrame(
    [
        ("p1", "speed", "m/s", "a", 0, "net", "file", "", 3, "t1+t2+t3", 2.0, 0.1),
        ("p1", "speed", "m/s", "b", 1, "net", "file", "", 3, "t1+t2+t3", 2.5, 0.1),
        ("p1", "speed", "m/s", "c", 2, "other", "file", "", 1, "t1", 2.4, np.nan),
        ("p1", "knee", "degrees", "a", 0, "net", "file", "", 1, "t1", 90.0, np.nan),
    ],
    columns=longitudinal.VALUES,
)
CHANGES = pd.DataFrame(
    [
        ("speed", "b", 0.5, 0.2, 4, "real", ""),
        ("speed", "c", 0.4, 0.25, 4, "mixed", "model: net -> other"),
    ],
    columns=["measure", "session", "change", "detectable", "freedom", "verdict", "mixed"],
)


def test_changes_stand_beside_the_values_they_belong_to():
    rows = archive.table(VALUES, CHANGES)
    assert rows["verdict"].tolist() == ["first", "real", "mixed", "first"]
    assert rows["change"].tolist()[1:3] == [0.5, 0.4]
    assert np.isnan(rows["change"][0])
    assert rows["mixed"].tolist() == ["", "", "model: net -> other", ""]
    for name in ("person", "takes", "value"):
        assert rows[name].tolist() == VALUES[name].tolist()


def test_bands_reach_as_far_as_the_smallest_detectable_change():
    drawing = archive.draw(archive.table(VALUES, CHANGES), "p1")
    speed = drawing.axes[0]
    assert speed.get_title() == "speed (m/s)"
    assert drawing.axes[1].get_title() == "knee (degrees)"
    faces = [(c, c.get_facecolor()) for c in speed.collections]
    (band,) = [c for c, face in faces if len(face) and to_hex(face[0]) == archive.BAND]
    low, high = band.get_datalim(speed.transData).intervaly
    np.testing.assert_allclose([low, high], [1.8, 2.2])


def test_the_legend_names_only_verdicts_that_occur():
    drawing = archive.draw(archive.table(VALUES, CHANGES), "p1")
    words = [text.get_text() for text in drawing.legends[0].get_texts()]
    assert words == [archive.LOOKS[name][3] for name in ("first", "real", "mixed")]
