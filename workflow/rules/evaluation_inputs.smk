"""Input functions and parameters of rules that compare takes with their truth.

Inputs: the checked configuration. Outputs: none. Steps: where truth is, what is
compared with it, and what a table was estimated by.
"""

TRUE_TAKE = "results/virtual/{session}/takes/{take}/truth.npz"


def true_takes(wildcards):
    """Return the truth of every take of a session."""
    session = wildcards.session
    return [TRUE_TAKE.format(session=session, take=take) for take in session_of(wildcards).takes]


def evaluated(wildcards):
    """Return (stage, fusion) of the skeletons of a take that are compared with the truth."""
    return list(product(stages_of(wildcards.model), every_fusion(wildcards)))


def estimated_by(session, file):
    """Return a line on where a table of a development session comes from."""
    command = f"snakemake --config sessions=[{session}] variations=[] -- {file}"
    return f"Estimated on session {session} by: {command}"
