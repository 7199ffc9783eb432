"""The figure of networks: what is drawn is what the table says, session by session."""

import numpy as np
import pandas as pd

from courtside.evaluation.tables import networks as evaluated
from courtside.figures.comparison import networks


def made():
    rows = []
    for session, against in (("gym", "truth"), ("hall", "body_25b")):
        for at, network in enumerate(("full", "lite", "heavy")):
            for measure, (unit, series, _) in evaluated.MEASURES.items():
                if against == "truth" or series != "error_3d":
                    value = {"value": 10.0 + at, "value_from": 9.0, "value_to": 13.0}
                    about = {"session": session, "against": against, "network": network}
                    rows.append({**about, "measure": measure, "unit": unit, **value})
    return pd.DataFrame(rows)


def test_every_network_and_session_has_its_mark_and_interval():
    rows = networks.table(made())
    drawing = networks.draw(rows)
    shown = [axis for axis in drawing.axes if axis.get_visible()]
    assert [axis.get_title() for axis in shown] == list(networks.DRAWN.values())
    assert [len(axis.lines) for axis in shown] == [2] * 7
    for axis in shown[:5]:
        for line in axis.lines:
            np.testing.assert_array_equal(np.ravel(line.get_xdata()), [10, 11, 12])
        ends = axis.collections[0].get_segments()
        np.testing.assert_allclose([end[:, 0] for end in ends], [[9, 13]] * 3)
    assert [label.get_text() for label in shown[0].get_yticklabels()] == ["full", "lite", "heavy"]
    words = [text.get_text() for text in drawing.legends[0].get_texts()]
    assert words == ["gym, against truth", "hall, against body_25b"]


def test_recorded_takes_alone_have_no_panels_of_3d_errors():
    rows = networks.table(made().query("session == 'hall'"))
    assert len([axis for axis in networks.draw(rows).axes if axis.get_visible()]) == 5
