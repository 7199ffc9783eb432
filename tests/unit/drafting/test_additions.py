"""New takes are written as lines that a session's file, renamed as it may be, takes at its end."""

import pytest
import yaml

from courtside.drafting import additions
from courtside.drafting import guess as session_guess
from courtside.drafting.recordings import Recording
from courtside.study.configuration import schemas
from courtside.study.errors import InputError

SESSION = """\
description: North
court: none
subjects:
  alma: {consent: [analysis, export]}
cameras:
  west: {}
  right: {}
calibration: {file: cameras.toml}
takes:
  serve: # called otherwise, with a camera called otherwise
    videos: {west: ./data/north/a_left.mp4, right: data/north/a_right.mp4}
  b:
    videos: {west: data/north/c_left.mp4, right: data/north/c_right.mp4}
"""


def recordings(*names):
    keys = {"size": (64, 48), "rate_hz": 30.0, "duration_s": 5.0}
    return [Recording(f"data/north/{name}.mp4", (name,), "video", **keys) for name in names]


def said(content, *names):
    films = [f"{take}_{camera}" for take in ("a", *names) for camera in ("left", "right")]
    guess = session_guess.guess(recordings(*films))
    return additions.to_paste(guess, content, path="north.yaml", folder="data/north")


def pasted(text, lines):
    start, end = (at for at, line in enumerate(lines) if not line)
    content = yaml.safe_load(text + "\n".join(lines[start:end]) + "\n")
    assert schemas.faults(content, "session", "north.yaml") == []
    return content


def test_a_new_take_has_the_names_of_the_session_and_leaves_the_rest_as_it_was():
    content = yaml.safe_load(SESSION)
    lines = said(content, "c", "b")
    assert lines[0] == (
        "Left north.yaml as it is. 1 take of data/north is not in it: copy these lines to the end "
        "of its `takes`."
    )
    new = {"videos": {"west": "data/north/b_left.mp4", "right": "data/north/b_right.mp4"}}
    assert pasted(SESSION, lines) == content | {"takes": content["takes"] | {"b_2": new}}
    assert not any("subjects: [" in line or "# guess" in line for line in lines)


def test_who_is_in_a_new_take_of_several_persons_is_a_guess():
    text = SESSION.replace("cameras:", "  bert: {}\ncameras:", 1)
    lines = said(yaml.safe_load(text), "b", "c", "d")
    assert "    subjects: [alma, bert]  # guess: who is in it" in lines
    assert "Look at every line with `# guess:`." in lines
    assert set(pasted(text, lines)["takes"]) == {"serve", "b", "b_2", "d"}


def test_cameras_that_the_session_does_not_have_are_told():
    content = yaml.safe_load(SESSION)
    content["cameras"], content["takes"] = {"right": {}}, {}
    lines = said(content)
    assert lines[2] == "takes:"
    assert "Odd: the session has no camera left: correct the name, or add it to `cameras`." in lines


def test_a_file_that_has_all_takes_is_left_with_advice():
    with pytest.raises(InputError, match="expected no file of that name, or takes in data/north"):
        said(yaml.safe_load(SESSION))


@pytest.mark.parametrize(
    ("content", "found"),
    [
        (SESSION.replace("data/north/", "data/south/"), "one of recordings in data/south"),
        (SESSION.partition("takes:")[0] + "walks: {w: {video: d/w.mp4}}", "one of recordings in d"),
        (SESSION.partition("takes:")[0] + "virtual: {}", "that of a virtual session"),
    ],
)
def test_takes_are_not_poured_into_a_session_of_another_folder(content, found):
    """Two folders may give one name; takes of another day have other cameras."""
    with pytest.raises(InputError) as caught:
        said(yaml.safe_load(content), "b")
    assert str(caught.value) == (
        "north.yaml: expected no file of that name, or one of recordings in data/north, found "
        f"{found} and left it; give this session another name by --name"
    )


def test_new_takes_that_only_the_order_of_files_makes_are_told():
    counted = [("left", 7), ("left", 8), ("right", 12), ("right", 13)]
    films = recordings("a_left", "a_right", *(f"{c}_IMG_{n:04d}" for c, n in counted))
    guess = session_guess.guess(films)
    content = yaml.safe_load(SESSION)
    lines = additions.to_paste(guess, content, path="north.yaml", folder="data/north")
    (line,) = (line for line in lines if line.startswith("Odd"))
    assert "those of take1, take2 were put together in the order of each camera's files" in line
