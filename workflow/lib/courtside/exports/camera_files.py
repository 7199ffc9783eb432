"""The cameras of a session for other programs: EasyMocap's two files and a COLMAP model.

`cameras.toml` itself is what Pose2Sim and aniposelib read.
"""

from collections.abc import Sequence

from courtside.calibration.foreign import colmap, easymocap
from courtside.geometry.camera import Camera
from courtside.study.errors import StrPath
from courtside.study.execution.files import atomic_folder

FORMS = {"easymocap": easymocap.texts, "colmap": colmap.texts}


def write(folder: StrPath, cameras: Sequence[Camera]) -> None:
    """Write a folder with one folder for each program, in metres; one that is there is replaced."""
    with atomic_folder(folder) as made:
        for program, texts in FORMS.items():
            (made / program).mkdir()
            for name, text in texts(cameras).items():
                (made / program / name).write_text(text, encoding="utf-8", newline="\n")
