"""Persons that sessions state: an unlikely mass, other words elsewhere, nobody to compare with."""

from collections.abc import Callable, Iterable, Iterator, Mapping

from courtside.study.configuration.sessions import Session, Study, Subject

KG_OF_LB = 0.45359237
# ASSUME: kg/m2 of a body; in pounds, a person of 18 or more kg/m2 seems to have 40 or more.
BODY_KG_M2 = (12.0, 40.0)
# ASSUME: how a person's body, as it is measured again, does not differ from session to session.
OF_THE_BODY: dict[str, Callable[[list], bool]] = {
    "height_m": lambda values: round(max(values) - min(values), 3) > 0.02,
    "mass_kg": lambda values: max(values) > 1.15 * min(values),
    "sex": lambda values: len(set(values)) > 1,
}


def unlike(sessions: Iterable[Session]) -> Iterator[str]:
    """Yield one line for each thing of a person that sessions state differently.

    The same pseudonym is the same person: sessions are compared by it. Who says nothing of consent
    agrees to less; other things are compared where they are stated.
    """
    persons: dict[str, dict[str, Subject]] = {}
    for session in sessions:
        for name, person in session.subjects.items():
            persons.setdefault(name, {})[session.name] = person
    for name, there in persons.items():
        words = {session: person.consent for session, person in there.items()}
        if len({frozenset(each) for each in words.values()}) > 1:
            each = ", ".join(f"{session}: [{', '.join(word)}]" for session, word in words.items())
            yield (
                f"{name}: consent differs between sessions ({each}): who withdraws must be changed "
                "in the file of each session"
            )
        for key, differ in OF_THE_BODY.items():
            yield from _differing(name, key, differ, there)


def _differing(
    name: str, key: str, differ: Callable[[list], bool], there: Mapping[str, Subject]
) -> Iterator[str]:
    """Yield a line if sessions state a person's body so differently that one is wrong."""
    stated = {session: getattr(person, key) for session, person in there.items()}
    stated = {session: value for session, value in stated.items() if value is not None}
    if stated and differ([*stated.values()]):
        each = ", ".join(f"{session}: {value}" for session, value in stated.items())
        yield (
            f"{name}: {key} differs between sessions ({each}): correct it, or, if these are two "
            "persons, give one another pseudonym"
        )


def compared(study: Study) -> Iterator[str]:
    """Yield one line if a session has nothing of the person whom the study compares over sessions.

    Sessions that the study does not run are passed over.
    """
    step = study.parameters["compare_sessions"]
    named = [study.sessions[name] for name in step["sessions"] if name in study.sessions]
    begins = tuple(step["takes"])
    there = [
        session.name
        for session in named
        for take in session.takes.values()
        if take.name.startswith(begins) and step["subject"] in take.subjects
    ]
    missing = [session.name for session in named if session.name not in there]
    if there and missing:
        alone = "; archive.csv has no change, only first values" if len(set(there)) == 1 else ""
        yield (
            f"{study.file}: compare_sessions: expected a take of {step['subject']} whose name "
            f"begins with {' or '.join(begins)} in each session, found none in "
            f"{', '.join(missing)}{alone}; correct the names, or the list of sessions"
        )


def remarks(subjects: Mapping[str, Subject]) -> Iterator[str]:
    """Yield one line for each person whose mass does not go with the height."""
    least, most = BODY_KG_M2
    for name, person in subjects.items():
        if not (person.mass_kg and person.height_m):
            continue
        index = person.mass_kg / person.height_m**2
        if not least <= index <= most:
            kg = f"; if it is in pounds, write {KG_OF_LB * person.mass_kg:.1f}"
            yield (
                f"subjects.{name}: expected {least:.0f} to {most:.0f} kg/m2, found {index:.0f} "
                f"({person.mass_kg:g} kg at {person.height_m:g} m): check mass_kg and "
                f"height_m{kg if index > most else ''}"
            )
