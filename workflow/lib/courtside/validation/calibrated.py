"""Cameras and sizes of pictures against the calibration file, and against each other."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from courtside.calibration import file_formats
from courtside.geometry import camera as geometry
from courtside.geometry import picture_size
from courtside.geometry.camera import Camera
from courtside.study.configuration.sessions import Session
from courtside.study.errors import InputError

Sizes = Mapping[str, Mapping[str, tuple[int, int]]]  # by camera and file: width and height, px


def faults(session: Session, sizes: Sizes) -> Iterator[str]:
    """Yield what is wrong with the cameras of a session, without the name of its file.

    `sizes` of the files that could be read, the static recording first.
    """
    mixed = list(_mixed(sizes))
    yield from mixed
    path = session.calibration_file
    if path is None or not Path(path).exists() or "file" not in session.calibrations():
        return
    try:
        known = {camera.name: camera for camera in file_formats.read(path)}
    except InputError as error:
        yield from error.lines
        return
    names = session.calibration_camera_names()
    missing = [ours for ours, theirs in names.items() if theirs not in known]
    if missing:
        yield (
            f"cameras: expected {', '.join(missing)} in {path}, found "
            f"{', '.join(known) or 'no camera'}; give each its `name_in_calibration`, or calibrate "
            "it"
        )
    there = {ours: known[theirs] for ours, theirs in names.items() if theirs in known}
    try:
        shown = {name: _shown(session, name, camera) for name, camera in there.items()}
    except InputError as error:
        yield from error.lines
        return
    if not mixed:
        yield from _wrong_sizes(there, shown, sizes)


def _shown(session: Session, name: str, camera: Camera) -> Camera:
    """Return the camera of a session as its videos should show it."""
    ours = session.cameras[name]
    cropped = geometry.crop(camera, ours.crop_px) if ours.crop_px else camera
    return geometry.scaled(cropped, ours.scale) if ours.scale != 1 else cropped


def _mixed(sizes: Sizes) -> Iterator[str]:
    for name, files in sizes.items():
        by_size: dict[str, str] = {}
        for path, size in files.items():
            by_size.setdefault(_times(size), path)
        if len(by_size) > 1:
            found = " and ".join(f"{size} px ({path})" for size, path in by_size.items())
            yield (
                f"cameras.{name}: expected pictures of one size in all recordings, found {found}; "
                "export them at one size"
            )


def _wrong_sizes(
    there: Mapping[str, Camera], shown: Mapping[str, Camera], sizes: Sizes
) -> Iterator[str]:
    video = {name: next(iter(sizes[name].items())) for name in shown if sizes.get(name)}
    wrong = {name: size for name, (_, size) in video.items() if size != shown[name].size}
    for name, size in wrong.items():
        path, calibrated = video[name][0], there[name].size
        expected = _times(shown[name].size)
        declared = "" if shown[name].size == calibrated else " as the session file declares"
        at = f"{path}: expected {expected} px{declared}"
        at += "" if declared else f", the size that camera {name} was calibrated at"
        other = _exchanged(name, wrong, shown)
        advice = picture_size.advice(calibrated, size)
        if other:
            advice = f"cameras {name} and {other} seem to be exchanged: exchange their videos"
        elif declared:
            advice = f"of the calibrated {_times(calibrated)} px {advice}"
        yield f"{at}, found {_times(size)}; {advice}"


def _exchanged(
    name: str, wrong: Mapping[str, tuple[int, int]], shown: Mapping[str, Camera]
) -> str | None:
    """Return the one camera whose picture has the size expected here, and the other way round."""
    others = [o for o in wrong if wrong[o] == shown[name].size and wrong[name] == shown[o].size]
    return others[0] if len(others) == 1 else None


def _times(size: Sequence[int]) -> str:
    return f"{size[0]}x{size[1]}"
