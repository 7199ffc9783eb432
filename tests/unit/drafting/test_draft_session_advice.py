"""What a user is told to look at after a draft: what is odd, where clicks go, what to run."""

import yaml

from courtside.drafting import draft
from courtside.drafting import guess as session_guess
from courtside.drafting.guess import Recording
from courtside.study.configuration import configuration


def recording(path, **more):
    parts = tuple(path.removeprefix("data/").rpartition(".")[0].split("/")[1:])
    keys = {"size": (64, 48), "rate_hz": 30.0, "duration_s": 5.0}
    return Recording(path, parts, "video", **(keys | more))


def guessed(*recordings):
    return session_guess.guess(list(recordings))


TAKE = (recording("data/north/a_left.mp4"), recording("data/north/a_right.mp4"))


def test_what_to_check_names_what_is_odd(tmp_path):
    slow = recording("data/north/a_right.mp4", rate_hz=25.0, duration_s=60.0, size=(32, 48))
    static = recording("data/north/right_empty.mp4"), recording("data/north/left_empty.mp4")
    walk = recording("data/north/walk.mp4", note="frames come at irregular times")
    guess = guessed(TAKE[0], slow, *static, walk)
    points = "data/north/court_points.csv"
    lines = draft.to_check(guess, tmp_path / "north.yaml", points, "config/north.yaml")
    said = "\n".join(lines)
    for part in ("camera right has pictures of 32x48 and 64x48", "25 and 30 Hz", "twofold"):
        assert part in said
    assert "walk.mp4: frames come at irregular times" in said
    assert "data/north/court_points.csv" in said
    assert "--configfile config/north.yaml" in said
    assert "No walk" not in said
    lines = draft.to_check(guessed(*TAKE), tmp_path / "north.yaml", "c.csv", "n.yaml")
    assert any(line.startswith("No walk") for line in lines)
    assert [line for line in lines if line.startswith("Odd")] == [
        "Odd: take a is 5.0 s long: in less than 15 s the clocks of cameras are seldom found; "
        "say `synchronised: true` if they share one"
    ]
    long = [recording(r.path, duration_s=15.0) for r in TAKE]
    lines = draft.to_check(guessed(*long), tmp_path / "north.yaml", "c.csv", "n.yaml")
    assert not any(line.startswith("Odd") for line in lines)


def test_a_study_of_the_session_alone_is_written_once(tmp_path):
    path = tmp_path / "north.yaml"
    assert draft.write_study(path, "north", ["a", "b"]) == f"Wrote {path}."
    said = yaml.safe_load(path.read_text())
    assert said == {
        "sessions": ["north"],
        "plans": [],
        "variations": [],
        "export_overlay_video": {"takes": ["north/a", "north/b"]},
    }
    folder = configuration.SCHEMAS.parents[1] / "config"
    config = yaml.safe_load((folder / "config.yaml").read_text())
    videos = config["export_overlay_video"] | said["export_overlay_video"]
    config |= said | {"export_overlay_video": videos}
    assert configuration.schema_faults(config, "config", "north.yaml") == []
    path.write_text("mine")
    assert "name north among its `sessions`" in draft.write_study(path, "north", ["a"])
    assert path.read_text() == "mine"
