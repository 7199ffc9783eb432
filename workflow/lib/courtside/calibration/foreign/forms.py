"""The forms that are read, and the one line for those that are not."""

from courtside.study.errors import InputError, StrPath

FORMS = (
    "Qualisys .qca.txt, Vicon .xcp, OptiTrack .mcal, TOML of Pose2Sim, aniposelib, FreeMoCap or "
    "Caliscope, YAML or XML of OpenCV, EasyMocap's intri.yml and extri.yml, a COLMAP model, or "
    "OpenCap .pickle"
)


def refused(path: StrPath, found: str, mend: str) -> InputError:
    """Return the error for a file that was recognised as another form, or as none."""
    return InputError(f"{path}: expected {FORMS}, found {found}; {mend}")
