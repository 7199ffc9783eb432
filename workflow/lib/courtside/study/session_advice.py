"""What goes with a drafted session: a study of it alone, and what its user should look at."""

from courtside.study.session_draft import MARK

SHORT_S = 15  # in shorter takes the clocks of cameras are seldom found


def write_study(path, session, takes):
    """Write a study of one session alone, with videos of its takes; one that is there is left as it is.

    Parameters
    ----------
    path : Path
        config/<session>.yaml.
    session : str
        A name.
    takes : iterable of str

    Returns
    -------
    line : str
        What was done.
    """
    filmed = ", ".join(f"{session}/{take}" for take in takes)
    lines = [
        f"# The study of {session} alone; what is not said here is as in config.yaml.",
        f"sessions: [{session}]",
        "plans: []",
        "variations: []",
        f"export_overlay_video: {{takes: [{filmed}]}} # videos with the skeletons drawn in",
    ]
    try:
        with path.open("x", encoding="utf-8") as stream:
            stream.write("\n".join(lines) + "\n")
    except FileExistsError:
        return f"Left {path} as it is: name {session} among its `sessions`."
    return f"Wrote {path}."


def to_check(guess, path, court_points, study):
    """List what a user should look at after drafting, in order.

    Parameters
    ----------
    guess : courtside.study.session_guess.Guess
    path : str or Path
        Of the draft.
    court_points : str
        Where clicked court points are expected.
    study : str or Path
        The study that names the session.

    Returns
    -------
    lines : list of str
    """
    lines = [f"Look at {path}: every line with `{MARK}`, and what stands under `not used`."]
    lines += [f"Odd: {line}" for line in _odd(guess)]
    if guess.calibration is None and guess.court_points is None and guess.cameras:
        lines.append(
            f"Court points: the first run makes a page to click them on, for {court_points}."
        )
    if not guess.walks and guess.calibration is None:
        lines.append("No walk was found: the cameras will rest on clicked court points alone.")
    lines.append(
        f"`snakemake -n -q rules --configfile {study}` checks it and counts what will be made."
    )
    lines.append(f"`snakemake --configfile {study}` makes it.")
    return lines


def _odd(guess):
    """Yield what a user may want to know of sizes, rates and lengths."""
    for camera in guess.cameras:
        films = [take[camera] for take in guess.takes.values() if camera in take]
        sizes = sorted({r.size for r in [*films, *filter(None, [guess.static.get(camera)])]})
        if len(sizes) > 1:
            yield f"camera {camera} has pictures of {' and '.join(f'{w}x{h}' for w, h in sizes)} pixels"
    for name, take in guess.takes.items():
        yield from _odd_take(name, take)
    for recording in [
        *guess.walks.values(),
        *(r for t in guess.takes.values() for r in t.values()),
    ]:
        if recording.note:
            yield f"{recording.path}: {recording.note}"


def _odd_take(name, take):
    rates = {round(r.rate_hz or 0) for r in take.values()}
    if len(rates) > 1:
        yield f"take {name} has videos of {' and '.join(map(str, sorted(rates)))} Hz"
    lengths = [r.duration_s for r in take.values()]
    if max(lengths) > 2 * min(lengths):
        yield f"take {name} has videos whose lengths differ more than twofold"
    if len(lengths) > 1 and min(lengths) < SHORT_S:
        yield (
            f"take {name} is {min(lengths):.1f} s long: in less than {SHORT_S} s the clocks of cameras are "
            "seldom found; say `synchronised: true` if they share one"
        )
