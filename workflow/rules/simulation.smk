"""Virtual sessions: recordings with exact truth.

Inputs: a session's `virtual` settings, its court. Outputs: results/virtual/{session}/.
Steps: simulate_session (one rule per session, named after it, for its files bear its cameras' names).
"""

for session in STUDY.sessions.values():
    if session.virtual is None:
        continue

    rule:
        name:
            f"simulate_{session.name.replace('-', '_')}"
        input:
            court=court_file(session),
        output:
            videos=[f"results/virtual/{session.name}/{name}.mp4" for name in session.filmed()],
            boards=(
                directory(f"results/virtual/{session.name}/boards")
                if session.films_boards()
                else []
            ),
            clicks=f"results/virtual/{session.name}/court_points.csv",
            truth=f"results/virtual/{session.name}/truth.npz",
        log:
            f"results/virtual/logs/simulate_session/{session.name}.log",
        benchmark:
            f"results/virtual/benchmarks/simulate_session/{session.name}.tsv"
        threads: 2 if session.virtual["walk_frames"] > 24 else 1
        resources:
            mem_mb=2000,
        params:
            code=code("simulate_session.py"),
            settings=session.virtual,
            names=session.filmed(),
        script:
            "../scripts/simulate_session.py"
