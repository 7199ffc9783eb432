"""T-poses and claps between rules."""

import json

import pytest

from courtside.records.devices import events
from courtside.records.devices.events import Clap, Events, NoClap, TPose
from courtside.study.errors import InputError

SPELL = TPose(1.0 / 3.0, 2.5, 10, 75, 5.0, 3.25, 0.1, 0.01, 0.02)
REST = TPose(0.0, 0.0, 0, 1, 0.0, 0.0, 0.0, 0.0, 0.0)
SUIT = Events([SPELL], [Clap(3.1, 0.004, 0, 0.1, 2.0, 0.02, False)], [NoClap(9.0, "apart")], REST)
NOTHING = Events([], [], fault="d415-rgb: expected a T-pose, found none")


def test_what_is_written_is_read_in_order(tmp_path):
    events.write(tmp_path / "a.json", {"suit": SUIT, "d415-rgb": NOTHING})
    events.write(tmp_path / "b.json", {"suit-corrected": SUIT})
    found = events.read([tmp_path / "a.json", tmp_path / "b.json"])
    assert found == {"suit": SUIT, "d415-rgb": NOTHING, "suit-corrected": SUIT}
    assert list(found) == ["suit", "d415-rgb", "suit-corrected"]


def test_another_file_is_refused(tmp_path):
    (tmp_path / "a.json").write_text('{"form": "courtside sync 1"}')
    with pytest.raises(InputError, match=r"a\.json: expected a file of form"):
        events.read([tmp_path / "a.json"])


@pytest.mark.parametrize(
    ("key", "value"),
    [("tposes", [{"start_s": 1.0}]), ("claps", [3.0]), ("rest", "none"), ("fault", None)],
)
def test_a_damaged_file_is_refused(tmp_path, key, value):
    events.write(tmp_path / "a.json", {"suit": SUIT})
    content = json.loads((tmp_path / "a.json").read_text())
    content["sources"]["suit"][key] = value
    (tmp_path / "a.json").write_text(json.dumps(content))
    with pytest.raises(InputError, match=r"a\.json: expected T-poses and claps"):
        events.read([tmp_path / "a.json"])


def test_a_text_in_place_of_a_time_is_refused(tmp_path):
    events.write(tmp_path / "a.json", {"suit": SUIT})
    text = (tmp_path / "a.json").read_text()
    (tmp_path / "a.json").write_text(text.replace("3.1", '"3.1"'))
    with pytest.raises(InputError, match="str in place of float"):
        events.read([tmp_path / "a.json"])
