"""What persons have agreed to, as other rules ask it.

Inputs: the checked configuration. Outputs: none. Steps: which files may be made; the words that say what is left out.
"""

from courtside.study.configuration import consent

PICTURED = (
    "overlay",
    "badminton_fig09",
    "badminton_fig10",
    "badminton_fig11",
)  # with persons in pictures


def agree(session, take, word):
    """Say whether all persons of a take have agreed to something."""
    return not consent.refusing(session, take, word)


def demand(wildcards, word):
    """Stop, with one line, a job for which persons of its take have not agreed to something."""
    take = take_of(wildcards)
    who = consent.refusing(session_of(wildcards), take, word)
    who = [name for name in who if name == wildcards.get("person", name)]
    if who:
        raise WorkflowError(
            f"{session_of(wildcards).file}: expected {word} in the consent of {', '.join(who)} for this file of take "
            f"{take.name}, found none; ask them, or do not ask for the file"
        )


def exported(wildcards):
    """Return the skeletons that a file for other programs is made from, where that is agreed to."""
    demand(wildcards, "export")
    stage = wildcards.get("stage", "pose3d")
    return f"{TAKE}/{stage}/{FUSED}.npz".format(**dict(wildcards.items()))


def blurred(wildcards):
    """Return whether faces are blurred in pictures of a take, where pictures are agreed to."""
    demand(wildcards, "pictures")
    return session_of(wildcards).blur_faces


def shown(session, take, figures):
    """Return those of some figures of a take that show nobody who has not agreed to it."""
    if agree(session, take, "pictures"):
        return figures
    return [name for name in figures if name not in PICTURED]


def left_out():
    """Return one line for each thing that is not made for want of consent, by session."""
    return [
        f"{session.name}: {line}"
        for session in STUDY.sessions.values()
        for line in consent.left_out(session) + remains(session)
    ]


def remains(session):
    """Return one line for each take that was measured before somebody in it withdrew."""
    folders = [f"results/{session.name}/takes/{take}" for take in session.withheld]
    return [f"{folder} was made before: delete it" for folder in folders if Path(folder).exists()]
