"""Cameras and sizes of pictures against the calibration file, and against each other."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import combinations
from pathlib import Path

from courtside.calibration import file_formats
from courtside.calibration.file_check import stated, verdict
from courtside.calibration.records import covariance
from courtside.geometry import camera as geometry
from courtside.geometry import camera_fields, picture_size
from courtside.geometry.camera import Camera
from courtside.records.cameras import clicks
from courtside.study.configuration.sessions import Session
from courtside.study.errors import InputError

# ASSUME: an exchange that leaves so small a part of the disagreement is its cause, whatever else
# is wrong with the file.
EXPLAINED = 5.0

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
        read = file_formats.read(path, session.calibration_unit)
        known = {camera.name: camera for camera in read}
    except InputError as error:
        yield from error.lines
        return
    yield from _other_covariance(session)
    names = session.calibration_camera_names()
    missing = [
        ours if ours == theirs else f"{theirs!r} (camera {ours})"
        for ours, theirs in names.items()
        if theirs not in known
    ]
    if missing:
        yield (
            f"cameras: expected {', '.join(missing)} in {path}, found "
            f"{', '.join(known) or 'no camera'}; give each its `name_in_calibration`, or calibrate "
            "it"
        )
    try:
        there = _named(
            session, {o: known[theirs] for o, theirs in names.items() if theirs in known}
        )
        file_formats.check_apart(path, list(there.values()), session.calibration_unit)
        stated.check(path, list(there.values()))
        shown = {name: _shown(session, name, camera) for name, camera in there.items()}
        yield from _exchanged_by_points(session, shown) if not missing else ()
    except InputError as error:
        yield from error.lines
        return
    if not mixed:
        yield from _wrong_sizes(there, shown, sizes)


def _other_covariance(session: Session) -> Iterator[str]:
    """Yield a fault if the covariance beside a calibration file is not of the session's cameras."""
    path = session.file_covariance
    if path is None or not Path(path).exists():  # the study makes it
        return
    try:
        known = covariance.read(path).cameras
    except InputError as error:
        yield from error.lines
        return
    if missing := [name for name in session.cameras if name not in known]:
        yield (
            f"{path}: expected the covariance of cameras {', '.join(missing)}, found that of "
            f"{', '.join(known)}; it lies beside {session.calibration_file}, whose errors it "
            "states: put that of the same calibration there, or remove it"
        )


def _named(session: Session, known: Mapping[str, Camera]) -> dict[str, Camera]:
    """Return the cameras of a file under the session's names, with what it replaces of them."""
    points_px = session.calibration_override.get("principal_point_px", {})
    ours = [replace(camera, name=name) for name, camera in known.items()]
    return {c.name: c for c in file_formats.with_principal_points(ours, points_px)}


def _shown(session: Session, name: str, camera: Camera) -> Camera:
    """Return the camera of a session as its videos should show it."""
    ours = session.cameras[name]
    cropped = geometry.crop(camera, ours.crop_px) if ours.crop_px else camera
    return geometry.scaled(cropped, ours.scale) if ours.scale != 1 else cropped


def _exchanged_by_points(session: Session, shown: Mapping[str, Camera]) -> Iterator[str]:
    """Yield the two cameras whose exchange makes clicked points at rest agree, if they do not.

    Whatever else may be wrong with the file is judged later, with more to judge by
    (`calibration.file_check`).
    """
    path, cameras = session.static_points, list(shown.values())
    if path is None or not Path(path).is_file():
        return
    seen = verdict.Seen(clicks.read_static(path, list(shown))[1])
    limit_px = verdict.LARGEST["static"] * max(max(camera.size) for camera in cameras)
    off_px = seen.px(cameras).get("static", 0)
    if off_px <= limit_px:
        return
    found: dict[tuple[str, str], float] = {}
    for one, other in combinations(range(len(cameras)), 2):
        swapped = list(cameras)
        swapped[one], swapped[other] = cameras[other], cameras[one]
        found[cameras[one].name, cameras[other].name] = seen.px(swapped)["static"]
    pair = min(found, key=lambda names: found[names], default=None)
    if pair and found[pair] <= max(limit_px, off_px / EXPLAINED):
        one_name, other_name = pair
        yield (
            f"cameras {one_name} and {other_name}: expected points at rest ({path}) where the "
            f"calibration puts them, found them {off_px:.0f} px off, and "
            f"{found[pair]:.1f} px with these cameras exchanged; exchange their videos, or their "
            "`name_in_calibration`"
        )


def _mixed(sizes: Sizes) -> Iterator[str]:
    for name, files in sizes.items():
        by_size: dict[str, str] = {}
        for path, size in files.items():
            by_size.setdefault(camera_fields.times(size), path)
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
        expected = camera_fields.times(shown[name].size)
        declared = "" if shown[name].size == calibrated else " as the session file declares"
        at = f"{path}: expected {expected} px{declared}"
        at += "" if declared else f", the size that camera {name} was calibrated at"
        other = _exchanged(name, wrong, shown)
        advice = picture_size.advice(calibrated, size)
        if other:
            advice = f"cameras {name} and {other} seem to be exchanged: exchange their videos"
        elif declared and size != calibrated:
            advice = f"of the calibrated {camera_fields.times(calibrated)} px {advice}"
        yield f"{at}, found {camera_fields.times(size)}; {advice}"


def _exchanged(
    name: str, wrong: Mapping[str, tuple[int, int]], shown: Mapping[str, Camera]
) -> str | None:
    """Return the one camera whose picture has the size expected here, and the other way round."""
    others = [o for o in wrong if wrong[o] == shown[name].size and wrong[name] == shown[o].size]
    return others[0] if len(others) == 1 else None
