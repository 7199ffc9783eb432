"""A mass in pounds is told before any job."""

from dataclasses import replace

import pytest

from courtside.study.configuration.sessions import Study, Subject
from courtside.validation import bodies


@pytest.mark.parametrize(
    ("mass_kg", "height_m", "words"),
    [
        (70.0, 1.75, None),
        (154.3, 1.75, "expected 12 to 40 kg/m2, found 50 (154.3 kg at 1.75 m): check mass_kg and "
         "height_m; if it is in pounds, write 70.0"),
        (31.8, 1.75, "expected 12 to 40 kg/m2, found 10 (31.8 kg at 1.75 m): check mass_kg and "
         "height_m"),
        (154.3, None, None),
    ],
)  # fmt: skip
def test_a_mass_that_does_not_go_with_the_height_is_told(mass_kg, height_m, words):
    said = list(bodies.remarks({"p": Subject(height_m=height_m, mass_kg=mass_kg)}))
    assert said == ([f"subjects.p: {words}"] if words else [])


def test_other_consent_of_a_person_in_another_session_is_told(hall):
    one = hall.session()
    alike = replace(one, name="other")
    assert list(bodies.unlike([one, alike])) == []
    less = replace(alike, subjects={"p1": replace(one.subjects["p1"], consent=("analysis",))})
    (line,) = bodies.unlike([one, less])
    assert line.startswith(
        "p1: consent differs between sessions (hall: [analysis, pictures], other: [analysis])"
    )


@pytest.mark.parametrize(
    ("key", "there", "words"),
    [
        ("height_m", (1.65, 1.75), "(hall: 1.65, other: 1.75)"),
        ("height_m", (1.65, 1.67), None),  # another shoe
        ("mass_kg", (60.0, 82.0), "(hall: 60.0, other: 82.0)"),
        ("mass_kg", (60.0, 66.0), None),  # half a year
        ("sex", ("m", "f"), "(hall: m, other: f)"),
        ("sex", ("m", None), None),
    ],
)
def test_another_body_of_a_person_in_another_session_is_told(hall, key, there, words):
    one = hall.session()
    sessions = [
        replace(one, name=name, subjects={"p1": replace(one.subjects["p1"], **{key: value})})
        for name, value in zip(("hall", "other"), there, strict=True)
    ]
    said = list(bodies.unlike(sessions))
    advice = "correct it, or, if these are two persons, give one another pseudonym"
    told = [f"p1: {key} differs between sessions {words}: {advice}"]
    assert said == (told if words else [])


def test_a_remark_on_a_body_names_the_file(hall):
    hall.content["subjects"]["p1"] = {"height_m": 1.75, "mass_kg": 154.3}
    faults, (remark,) = hall.said()
    assert faults == []
    assert ".yaml: subjects.p1: expected 12 to 40 kg/m2" in remark


def test_a_session_without_the_person_who_is_compared_is_told(hall):
    one = hall.session()
    step = {"subject": "p1", "sessions": ["hall", "other", "unknown"], "takes": ["serve"]}

    def said(**others):
        sessions = {"hall": one, **others}
        return list(bodies.compared(Study(sessions, {}, {}, {"compare_sessions": step}, file="f")))

    alike = replace(one, name="other")
    assert said() == said(other=alike) == []
    (line,) = said(other=replace(alike, takes={"lob": one.takes["lob"]}))
    assert line == (
        "f: compare_sessions: expected a take of p1 whose name begins with serve in each session, "
        "found none in other; archive.csv has no change, only first values; correct the names, or "
        "the list of sessions"
    )
