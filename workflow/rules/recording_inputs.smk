"""Input functions of rules about recordings: videos, and folders of pictures.

Inputs: the checked configuration. Outputs: none. Steps: which recording, and which part of it, belongs to a job.
"""


def whole(path):
    """Return a recording as an input; of a folder the date says nothing, its files do: see `inside`."""
    return ancient(path) if Path(path).is_dir() else path


def inside(path):
    """Return the files of a folder as inputs, for Snakemake compares files and not folders; nothing for a file."""
    if not Path(path).is_dir():
        return []
    found = (file for file in Path(path).rglob("*") if file.is_file())
    return sorted(str(file) for file in found if not file.name.startswith("."))


def video_of(wildcards):
    """Return the video of a camera of a take, or of a device that films."""
    take = take_of(wildcards)
    if wildcards.camera in take.videos:
        return take.videos[wildcards.camera]
    if take.devices[wildcards.camera].kind == "rgb":
        return take.devices[wildcards.camera].file
    return f"results/{wildcards.session}/takes/{wildcards.take}/devices/{wildcards.camera}.mp4"


def trimmed(wildcards):
    """Return the part of a camera's video that counts; a device's counts as a whole."""
    take = take_of(wildcards)
    return take.trim_s if wildcards.camera in take.videos else None
