"""Files against their schemas: every fault of a file, each in one line of plain words."""

import datetime
import re
from pathlib import Path

import pytest
import yaml

from courtside.study.configuration import configuration, schemas
from courtside.study.errors import InputError

CONFIG = schemas.SCHEMAS.parents[1] / "config"
FILES = {
    "court": sorted((CONFIG / "courts").glob("*.yaml")),
    "skeleton": sorted((CONFIG / "skeletons").glob("*.yaml")),
    "derived_joints": [CONFIG / "derived_joints.yaml"],
    "plan": sorted((CONFIG / "plans").glob("*.yaml")),
    "external": [CONFIG / "external.yaml"],
}
KINDS = ("smk", "py")


@pytest.mark.parametrize(
    ("path", "schema"),
    [(path, schema) for schema, paths in FILES.items() for path in paths],
    ids=lambda part: getattr(part, "stem", part),
)
def test_committed_files_are_as_their_schemas_say(path, schema):
    assert schemas.read(path, schema) == yaml.safe_load(path.read_text(encoding="utf-8"))


def test_every_fault_is_one_line(tmp_path):
    content = yaml.safe_load((CONFIG / "courts" / "rectangle-10x5.yaml").read_text())
    content |= {"size": [1, 2], "line_width_m": "wide"}
    content["points"]["p01"]["xyz_m"] = [0, 0]
    path = tmp_path / "mine.yaml"
    path.write_text(yaml.safe_dump(content))
    with pytest.raises(InputError) as caught:
        schemas.read(path, "court")
    unknown, width, place = caught.value.lines
    assert unknown.endswith("found 'size'; did you mean 'size_m'?")
    expected = "line_width_m: expected a number (metres above 0), found 'wide'"
    assert width == f"{path}: {expected}"
    expected = "points.p01.xyz_m: expected at least 3 entries ([x, y, z], metres), found [0, 0]"
    assert place == f"{path}: {expected}"


def test_an_entry_that_repeats_is_named():
    names = ["neck", *(f"joint_{at}" for at in range(40)), "neck"]
    skeleton = {"joints": names, "bones": [], "segments": {}, "groups": {}}
    (line,) = schemas.faults(skeleton, "skeleton", Path("long.yaml"))
    assert line == "long.yaml: joints: expected entries that differ, found 'neck' again"


@pytest.mark.parametrize(
    ("name", "n_faults"),
    [("people", 0), ("sfm-n40-lines", 0), ("sfm-n40-lines-people", 0), ("people-people", 1)],
)
def test_a_session_may_name_calibrations_of_its_own(name, n_faults):
    session = {"court": "none", "cameras": {}, "override": {"calibrations": [name]}}
    found = schemas.faults(session, "session", Path("s.yaml"))
    assert len([line for line in found if "override.calibrations" in line]) == n_faults


@pytest.mark.parametrize(("floor", "n_faults"), [([3.0], 1), ([3.0, 4.0], 0)])
def test_one_frame_of_a_wand_on_the_floor_has_no_plane(floor, n_faults):
    wand = {"length_m": 0.5, "points": "p.csv", "floor": floor}
    session = {"court": "none", "cameras": {}, "wand": wand}
    found = [line for line in schemas.faults(session, "session", Path("s.yaml")) if "floor" in line]
    assert len(found) == n_faults
    assert all("wand.floor: expected at least 2 entries" in line for line in found)


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("height_m", 174, "expected at most 2.5 (metres), found 174"),
        ("height_m", "1.74 m", "expected a number (metres), found '1.74 m'"),
        ("mass_kg", 66000, "expected at most 300 (kilograms), found 66000"),
        ("seen", [], "expected where this person is, as one entry or a list, found []"),
    ],
)
def test_a_fault_of_a_person_states_the_unit(key, value, said):
    session = {"court": "none", "cameras": {}, "subjects": {"p1": {key: value}}}
    found = schemas.faults(session, "session", Path("s.yaml"))
    assert f"s.yaml: subjects.p1.{key}: {said}" in found


@pytest.mark.parametrize(
    ("target", "key", "value", "limit"),
    [
        ("board", "square_m", 54, 1),
        ("board", "marker_m", 40.5, 1),
        ("wand", "length_m", 800, 10),
        ("wand", "middle_m", 200, 10),
    ],
)
def test_a_length_of_a_target_states_the_unit(target, key, value, limit):
    found = schemas.faults({target: {key: value}}, "session", Path("s.yaml"))
    said = f"s.yaml: {target}.{key}: expected at most {limit} (metres), found {value}"
    assert said in found


def test_names_and_kinds_of_values_are_described_in_words():
    session = {"court": "Badminton", "cameras": {}, "takes": {"Take 1": None, "t": {"trim_s": 1}}}
    found = schemas.faults(session, "session", Path("s.yaml"))
    court = "'none' or the name of a file of config/courts, such as badminton"
    assert f"s.yaml: court: expected {court}, found 'Badminton'" in found
    name = (
        "at most 64 lower-case letters, digits, _ and -, begun with a letter or digit; no device "
    )
    name += "of Windows such as con, and none of na, nan, none and null"
    assert f"s.yaml: takes: expected {name}, found 'Take 1'" in found
    assert any("takes.t.trim_s: expected a list ([start, stop] in" in line for line in found)


@pytest.mark.parametrize("name", ["na", "nan", "none", "null"])
def test_no_name_is_read_as_a_missing_value(name):
    session = {"court": "none", "cameras": {name: {}}, "takes": {name: {}}, "subjects": {name: {}}}
    found = schemas.faults(session, "session", Path("s.yaml"))
    for key in ("cameras", "takes", "subjects"):
        (line,) = [line for line in found if line.startswith(f"s.yaml: {key}: expected at most 64")]
        assert line.endswith(f"and none of na, nan, none and null, found {name!r}")
    assert not configuration.NAME.fullmatch(name)
    assert configuration.NAME.fullmatch(f"{name}1")


@pytest.mark.parametrize("found", [20260302, datetime.date(2026, 3, 2), 1.5, False])
def test_text_that_yaml_reads_as_something_else_is_to_be_put_in_quotes(found):
    session = {"court": "none", "cameras": {}, "description": found}
    (line,) = schemas.faults(session, "session", Path("s.yaml"))
    assert line == f"s.yaml: description: expected text, found {found!r}; put it in quotes"
    session["description"] = ["a"]
    (line,) = schemas.faults(session, "session", Path("s.yaml"))
    assert line.endswith("found ['a']")


def test_a_session_overrides_the_steps_that_are_asked_of_it_alone():
    folders = [schemas.SCHEMAS.parent / "rules", schemas.SCHEMAS.parent / "lib" / "courtside"]
    files = [path for folder in folders for path in folder.rglob("*") if path.suffix[1:] in KINDS]
    text = "\n".join(path.read_text(encoding="utf-8") for path in files)
    asked = re.findall(r'\b(?:step|some)\("(\w+)"|session\.parameters\["(\w+)"\]', text)
    asked += re.findall(r'self\.(parameters)\["(\w+)"\]', text)
    steps = yaml.safe_load((CONFIG / "config.yaml").read_text(encoding="utf-8"))
    blocks = {name for name, step in steps.items() if isinstance(step, dict)}
    assert blocks & {name for names in asked for name in names} == blocks - set(schemas.OF_STUDY)
    for name in blocks:
        session = {"court": "none", "cameras": {}, "override": {name: {}}, "description": "a hall"}
        said = schemas.faults(session, "session", Path("s.yaml"))
        assert bool(said) == (name in schemas.OF_STUDY), said


@pytest.mark.parametrize(
    ("step", "takes", "where", "found"),
    [
        ("evaluate_round_trip", {"shot": None}, "takes", "shot"),
        ("draw_stroke", {"players/shot/1": 2.5}, "takes", "players/shot/1"),
        ("draw_three_cameras", ["players/a shot"], "takes.0", "players/a shot"),
    ],
)
def test_takes_of_the_study_are_named_with_their_session(step, takes, where, found):
    config = yaml.safe_load((CONFIG / "config.yaml").read_text(encoding="utf-8"))
    assert schemas.faults(config, "config", "c.yaml") == []
    config[step]["takes"] = takes
    (line,) = schemas.faults(config, "config", "c.yaml")
    assert line == f"c.yaml: {step}.{where}: expected session/take, found {found!r}"


def test_a_calibration_that_takes_are_measured_with_has_the_name_of_one():
    session = {"court": "none", "cameras": {}, "description": "a hall"}
    session["override"] = {"take_calibrations": ["file", "sfm-40"]}
    (line,) = schemas.faults(session, "session", Path("s.yaml"))
    assert line.startswith("s.yaml: override.take_calibrations.1: expected file, known, board")
    assert line.endswith("found 'sfm-40'")


@pytest.mark.parametrize(
    ("key", "said", "line"),
    [
        ("calibration", "c.toml", "calibration: expected keys and values (`{file: PATH}`), found"),
        (
            "walks",
            "w.mp4",
            "walks: expected keys and values (such as `walk1: {video: PATH}`), found",
        ),
        ("subjects", ["p1"], "subjects: expected keys and values (such as `p1: {height_m: 1.74}`)"),
        (
            "walks",
            {"w": {"video": "a", "images": "b"}},
            "walks.w: expected at most 1 entries (either `video` or `images`), found",
        ),
    ],
)
def test_shapes_that_a_newcomer_writes_are_told_with_the_right_one(key, said, line):
    session = {"description": "x", "court": "none", "cameras": {}, key: said}
    (found,) = schemas.faults(session, "session", "s.yaml")
    assert found.startswith(f"s.yaml: {line}")
