"""What the persons of a session have agreed to, and what is left out where they have not."""

WORDS = {
    "analysis": "measures, figures and the 3D view of how they moved",
    "export": "files of how they moved for other programs",
    "pictures": "pictures and videos in which they can be seen, faces made unrecognisable",
    "faces": "pictures and videos that show their faces",
}
# Of a recording where nothing is stated: what can be made unrecognisable. How somebody moves cannot, and
# a file of it goes wherever its reader sends it: that has to be agreed to.
UNSTATED = ("analysis", "pictures")
NEEDS = {"export": "analysis", "pictures": "analysis", "faces": "pictures"}


def stated(subject, virtual):
    """Return what a person has agreed to.

    Parameters
    ----------
    subject : dict
        As the session's file has it.
    virtual : bool
        Whether the session is: nobody is there who could object.

    Returns
    -------
    consent : tuple of str
        Words of `WORDS`; empty for somebody who has withdrawn.
    """
    return tuple(subject.get("consent", WORDS if virtual else UNSTATED))


def withdrawn(subjects, virtual):
    """Return the names of those who have not agreed to be measured.

    Parameters
    ----------
    subjects : dict
        As the session's file has them.
    virtual : bool

    Returns
    -------
    names : set of str
    """
    return {
        name
        for name, subject in subjects.items()
        if "analysis" not in stated(subject or {}, virtual)
    }


def refusing(session, take, word):
    """Return the persons of a take who have not agreed to something, in their order.

    Parameters
    ----------
    session : courtside.study.configuration.sessions.Session
    take : courtside.study.configuration.sessions.Take
    word : str
        Of `WORDS`.
    """
    if word not in WORDS:
        raise ValueError(f"expected one of {tuple(WORDS)}, found {word!r}")
    return tuple(name for name in take.subjects if word not in session.subjects[name].consent)


def withheld(takes, subjects):
    """Return the takes of which nothing may be made: those with a person who has not agreed to `analysis`.

    Parameters
    ----------
    takes : dict of str to courtside.study.configuration.sessions.Take
    subjects : dict of str to courtside.study.configuration.sessions.Subject

    Returns
    -------
    withheld : dict of str to tuple of str
        The persons for whose sake, by take. A recording of several persons cannot be measured without one.
    """
    found = {
        name: tuple(who for who in take.subjects if "analysis" not in subjects[who].consent)
        for name, take in takes.items()
    }
    return {name: who for name, who in found.items() if who}


def left_out(session, wanted=("export", "pictures")):
    """Say what is not made of a session for want of consent.

    Parameters
    ----------
    session : courtside.study.configuration.sessions.Session
    wanted : sequence of str
        Words of `WORDS` that are told of, beside `analysis`.

    Returns
    -------
    lines : list of str
        One for each thing left out and each set of persons for whose sake.
    """
    lines = [
        f"nothing is made of {takes}: {persons} not agreed to analysis (consent)"
        for takes, persons in _together(session.withheld)
    ]
    for word in wanted:
        who = {take.name: refusing(session, take, word) for take in session.takes.values()}
        lines += [
            f"no {WORDS[word]} in {takes}: {persons} not agreed to {word} (consent)"
            for takes, persons in _together(who)
        ]
    return lines


def faults(file, content):
    """Return what contradicts itself in what persons have agreed to, one line each.

    Parameters
    ----------
    file : Path
        The session's.
    content : dict
        As its schema allows it.

    Yields
    ------
    fault : str
    """
    virtual = "virtual" in content
    shown = not content.get("blur_faces", not virtual) and bool(content.get("takes"))
    for name, subject in content.get("subjects", {}).items():
        agreed = stated(subject or {}, virtual)
        for word in (w for w in agreed if NEEDS.get(w, w) not in agreed):
            yield (
                f"{file}: subjects.{name}.consent: expected {NEEDS[word]} with {word}, found {list(agreed)}; "
                "add it, or write [] for somebody who has withdrawn"
            )
        if shown and "pictures" in agreed and "faces" not in agreed:
            yield (
                f"{file}: blur_faces: expected `faces` in the consent of {name} to show faces, found "
                f"{list(agreed)}; ask them, or remove blur_faces: false"
            )


def _together(who):
    """Yield takes with the same persons, and these persons, in words; takes without any are left out."""
    for persons in dict.fromkeys(filter(None, who.values())):
        takes = [name for name, others in who.items() if others == persons]
        noun, verb = (
            ("take" if len(takes) == 1 else "takes"),
            ("has" if len(persons) == 1 else "have"),
        )
        yield f"{noun} {', '.join(takes)}", f"{', '.join(persons)} {verb}"
