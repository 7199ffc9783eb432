"""Persons that sessions state: a mass that does not go with the height, other words elsewhere."""

from collections.abc import Iterable, Iterator, Mapping

from courtside.study.configuration.sessions import Session, Subject

KG_OF_LB = 0.45359237
# ASSUME: kg/m2 of a body; in pounds, a person of 18 or more kg/m2 seems to have 40 or more.
BODY_KG_M2 = (12.0, 40.0)


def unlike(sessions: Iterable[Session]) -> Iterator[str]:
    """Yield one line for each person of several sessions who agrees to less in one of them.

    The same pseudonym is the same person: sessions are compared by it.
    """
    stated: dict[str, dict[str, tuple[str, ...]]] = {}
    for session in sessions:
        for name, person in session.subjects.items():
            stated.setdefault(name, {})[session.name] = person.consent
    for name, words in stated.items():
        if len({frozenset(each) for each in words.values()}) > 1:
            each = ", ".join(f"{session}: [{', '.join(word)}]" for session, word in words.items())
            yield (
                f"{name}: consent differs between sessions ({each}): who withdraws must be changed "
                "in the file of each session"
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
