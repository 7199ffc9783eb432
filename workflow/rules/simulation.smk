"""Virtual sessions: recordings with exact truth.

Inputs: a session's `virtual` settings, its court, the virtual body. Outputs:
results/virtual/{session}/.
Steps: simulate_session (one rule per session, named after it, because its files are named after its
cameras), simulate_take (likewise, one per take).
"""

for session in STUDY.sessions.values():
    if session.virtual is None:
        continue

    filming = [take for take in session.takes.values() if take.videos]
    backdrops = expand(paths.BACKDROPS, session=session.name) if filming else []

    if session.cameras_and_walks():

        rule:
            name:
                f"simulate_{session.name}"
            input:
                court_yaml=STUDY.court_file(session),
            output:
                videos=expand(paths.RECORDING, session=session.name, name=session.recorded_empty()),
                boards=(
                    directory(paths.VIRTUAL_BOARDS.format(session=session.name))
                    if session.films_boards()
                    else []
                ),
                backdrops_npz=backdrops,
                clicks=paths.VIRTUAL_CLICKS.format(session=session.name),
                truth_npz=paths.TRUTH.format(session=session.name),
            log:
                f"results/virtual/logs/simulate_session/{session.name}.log",
            benchmark:
                f"results/virtual/benchmarks/simulate_session/{session.name}.tsv"
            # As its takes.
            priority: int(max((take.virtual["seconds"] for take in filming), default=0))
            threads: SEVERAL if session.virtual["walk_frames"] > 24 else 1
            resources:
                mem_mb=2000,
            params:
                code=code("simulate_session.py"),
                settings=session.virtual,
                names=session.cameras_and_walks(),
            script:
                "../scripts/simulate_session.py"

    for take in session.takes.values():

        rule:
            name:
                f"simulate_{session.name}.{take.name}"  # no name holds a dot
            input:
                court_yaml=STUDY.court_file(session),
                body_files=recordings.virtual_body(STUDY),
                backdrops_npz=backdrops if take.videos else [],
            output:
                videos=list(take.videos.values()),
                devices=[device.file for device in take.devices.values()],
                racket=paths.RACKET_CLICKS.format(session=session.name, take=take.name),
                truth_npz=paths.TRUE_TAKE.format(session=session.name, take=take.name),
            log:
                f"results/virtual/logs/simulate_take/{session.name}.{take.name}.log",
            benchmark:
                f"results/virtual/benchmarks/simulate_take/{session.name}.{take.name}.tsv"
            priority: int(take.virtual["seconds"])  # the longest first, or they are left to the end
            threads: SEVERAL if take.virtual["seconds"] > 4 else 1
            resources:
                mem_mb=2500,
            params:
                code=code("simulate_take.py"),
                settings=session.virtual,
                take=take.virtual,
            script:
                "../scripts/simulate_take.py"
