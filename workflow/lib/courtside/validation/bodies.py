"""Bodies that a session states: a mass that does not go with the height."""

from collections.abc import Iterator, Mapping

from courtside.study.configuration.sessions import Subject

KG_OF_LB = 0.45359237
# ASSUME: kg/m2 of a body; in pounds, a person of 18 or more kg/m2 seems to have 40 or more.
BODY_KG_M2 = (12.0, 40.0)


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
