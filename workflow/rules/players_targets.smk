"""What the study makes of takes together: the files that `snakemake` asks for.

Inputs: the checked configuration. Outputs: none. Steps: lists of files, by subject.
"""


def every_comparison_of_views():
    """Return how far sets of cameras are from all of them, in real takes."""
    return [
        f"results/{session.name}/takes/{take}/views/{way}.{model}.csv"
        for session in STUDY.sessions.values()
        if not session.virtual and session.fusions("compared_fusions")
        for take in session.takes
        for way, model in product(session.take_calibrations(), session.parameters["models"])
    ]


def every_players_figure():
    """Return the figures that takes are drawn in together."""
    stems = []
    for session, take in named_takes(STUDY.parameters["evaluate_round_trip"]["takes"]):
        stem = f"results/{session}/takes/{take}/figures/badminton_tab01"
        models = STUDY.sessions[session].parameters["models"]
        ways = STUDY.sessions[session].take_calibrations()
        stems += [f"{stem}.{way}.{model}" for way, model in product(ways, models)]
    for session, take in named_takes(STUDY.parameters["draw_stroke"]["takes"]):
        place, models = STUDY.sessions[session], STUDY.sessions[session].parameters["models"][:1]
        methods = product(place.take_calibrations(), place.fusions(), models)
        folder = f"results/{session}/takes/{take}/figures"
        figures = shown(place, place.takes[take], [f"badminton_fig{n}" for n in ("09", "10", "11")])
        stems += [
            f"{folder}/{figure}.{'.'.join(method)}" for method, figure in product(methods, figures)
        ]
    stems += ["results/figures/badminton_fig05"] if fig05_layouts() else []
    for session, take in named_takes(STUDY.parameters["draw_three_cameras"]["takes"]):
        ways = STUDY.sessions[session].take_calibrations()
        models = STUDY.sessions[session].parameters["models"][:1]
        stem = f"results/{session}/takes/{take}/figures/three_cameras"
        stems += [f"{stem}.{way}.{model}" for way, model in product(ways, models)]
    stems += ["results/figures/clock_errors"] if evaluations_of_takes("clocks") else []
    stems += ["results/figures/agreement"] if compared_takes() else []
    stems += ["results/figures/archive"] if archived_takes() else []
    tables = ["results/figures/players.csv"] if evaluations_of_takes("errors") else []
    return [f"{stem}.{suffix}" for stem in stems for suffix in FORMATS] + tables
