"""Whether onnxruntime has the execution providers that a study names, asked before any job."""

from courtside.study.configuration import yaml_files
from courtside.study.configuration.sessions import DEFAULT, Study
from courtside.study.errors import InputError


def check(study: Study) -> None:
    """Raise an `InputError`, one line each, for providers that the installed package lacks."""
    every = study.parameters["detect_pose"]["providers"]
    key = "detect_pose.providers"
    file = yaml_files.file_of(key, study.parameters, study.file, study.folder / DEFAULT)
    named = {f"{file}: {key}": every}
    for session in study.sessions.values():
        own = session.parameters["detect_pose"]["providers"]
        named |= {f"{session.file}: {key}": own} if own != every else {}
    if all(found == ["cpu"] for found in named.values()):
        return
    # Imported here: every command would load onnxruntime, which takes longer than the check.
    from courtside.pose.networks.session import check_providers

    faults: list[str] = []
    for where, found in named.items():
        try:
            check_providers(found, where)
        except InputError as error:
            faults += error.lines
    if faults:
        raise InputError(*faults)
