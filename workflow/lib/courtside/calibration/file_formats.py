"""Read cameras calibrated elsewhere, choosing the reader by what a file or folder holds."""

import codecs
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from courtside.calibration.foreign import (
    colmap,
    easymocap,
    forms,
    opencap,
    opencv,
    optitrack,
    qualisys,
    vicon,
    xml_fields,
)
from courtside.geometry import camera as camera_files
from courtside.geometry import camera_fields
from courtside.geometry.camera import Camera
from courtside.study.errors import InputError, StrPath, about, reading

LARGEST_BYTES = 1 << 24  # ASSUME: far above any calibration: a larger file is another one
APART_M = (0.1, 150.0)  # ASSUME: of the two cameras of a hall that are farthest apart
UNIT_STATED = re.compile(r"(?m)(?:^|[{,])\s*<?[\"']?unit[\"']?\s*[=:>]")
CORRECT_UNIT = (
    "if its lengths have another unit, correct the one that the file states or, where it states "
    "none, write `unit: mm` (or cm, in, ft) under calibration in the session file"
)
FARTHEST_M = 300.0  # ASSUME: no hall is larger: a camera farther away is in mm or cm
OPENCV_SUFFIXES = (".yml", ".yaml", ".xml")
# What to do with files that are recognised and not read.
OF_THEIA = (
    "give the calibration that Theia3D was given (.qca.txt or .xcp), or film the board again: its "
    "own form does not say in which direction its cameras look"
)
OF_MOTIVE = (
    "save the calibration itself with Motive 3.2 or newer (File > Save Calibration), which makes "
    "an .mcal file"
)
IN_OUR_TOML = (
    "export it in one of these, or write it as TOML, a table for each camera with name, size, "
    "matrix, distortions, rotation (from the world to the camera) and translation"
)
MUST_STATE = (
    "write `unit: m` under calibration in the session file if the model was scaled to metres (or "
    "mm, cm, in, ft), with z up and the floor at z = 0; else scale it first"
)

# Cameras; the unit of their lengths that a session may replace: "" if the session must state it,
# None where the file or its format states it.
Found = tuple[list[Camera], str | None]


def read(path: StrPath, unit: str | None = None) -> list[Camera]:
    """Read the cameras of a calibration, choosing the reader by what the file or folder holds.

    It is one of `foreign.forms.FORMS`; a folder holds EasyMocap's two files, a COLMAP model,
    OpenCap's pickles, or files of OpenCV, one camera each. Cameras are in the file's order under
    the file's names, in metres, with the file's world frame (of OptiTrack and OpenCap turned so
    that z is up). `unit` is that of its lengths where the file does not state one; where nobody
    does, that of the program, and m. Raises `InputError` if the form is not known, the unit is
    stated twice or has to be and is not, or a camera is incomplete, impossible or named twice.
    """
    path = Path(path)
    found, replaceable = _found(path)
    if unit is not None and replaceable is None:
        raise InputError(
            f"{path}: expected no `unit` under calibration in the session file, because the file "
            f"or its format states it, found {unit!r}; remove it from the session file"
        )
    if replaceable is not None:
        if not (unit or replaceable):
            raise InputError(
                f"{path}: expected a COLMAP model of a stated scale, found one without; "
                f"{MUST_STATE}"
            )
        metres = camera_fields.unit_in_metres(f"{path}: unit", unit or replaceable)
        scale = np.array([1, 1, 1, metres])
        found = [replace(c, cam_from_world=c.cam_from_world * scale) for c in found]
    for camera in camera_fields.check_distinct(path, found):
        far_m = float(np.linalg.norm(camera.centre_in_world))
        if far_m > FARTHEST_M:
            raise InputError(
                f"{path}: camera {camera.name}: expected it within {FARTHEST_M:g} m of the world's "
                f"origin, found {far_m:.0f} m{_correct_unit(unit, far_m)}"
            )
    return found


def _correct_unit(unit: str | None, found_m: float) -> str:
    """Return what to do about an impossible length, if a session has stated the `unit` or not."""
    if unit is None:
        return f"; {CORRECT_UNIT}"
    stated = f" with `unit: {unit}` of the session file; correct it"
    in_m = f", or remove it: in m it would be {found_m / camera_fields.METRES[unit]:.3g} m"
    return stated + in_m * (unit != "m")


def check_apart(path: StrPath, cameras: Sequence[Camera], unit: str | None = None) -> None:
    """Raise `InputError` if the cameras of a session are no plausible distance apart.

    `unit` is that of the file's lengths, where the session states it.
    """
    if len(cameras) < 2:
        return
    centres = np.array([camera.centre_in_world for camera in cameras])
    apart_m = float(np.linalg.norm(centres[:, None] - centres, axis=-1).max())
    if not APART_M[0] <= apart_m <= APART_M[1]:
        raise InputError(
            f"{path}: expected cameras {APART_M[0]:g} to {APART_M[1]:g} m apart, found "
            f"{apart_m:.3g} m between the farthest{_correct_unit(unit, apart_m)}"
        )


def rename(path: StrPath, found: Iterable[Camera], names: Mapping[str, str]) -> list[Camera]:
    """Pick the cameras of a session from a calibration, under the session's names, in their order.

    `names` maps the name in the session to the name in the calibration at `path`. Raises
    `InputError` if it has no such camera, or two cameras of the session are the same one.
    """
    by_name = {camera.name: camera for camera in found}
    for ours, theirs in names.items():
        if theirs not in by_name:
            raise InputError(
                f"{path}: camera {ours}: expected {theirs!r} in the calibration, found "
                f"{', '.join(by_name)}; give the camera its `name_in_calibration` in the session "
                "file"
            )
        if list(names.values()).count(theirs) > 1:
            raise InputError(
                f"{path}: camera {ours}: expected a camera of its own in the calibration, found "
                f"{theirs!r} given to another as well; correct the session file"
            )
    return [replace(by_name[theirs], name=ours) for ours, theirs in names.items()]


def known_lenses(
    path: StrPath | None, names: Mapping[str, str], tomls: Iterable[StrPath]
) -> dict[str, Camera]:
    """Return the known lenses by camera: of a calibration at `path`, else of the study's `tomls`.

    `names` are as for `rename`. Poses in the calibration, and their unit, do not matter.
    """
    if path is not None:
        found = camera_fields.check_distinct(path, _found(Path(path))[0])
        with about("lenses"):
            return {lens.name: lens for lens in rename(path, found, names)}
    return {lens.name: lens for toml in tomls for lens in camera_files.read_toml(toml)}


def read_session(
    path: StrPath, names: Mapping[str, str], override: Mapping[str, Any], unit: str | None = None
) -> list[Camera]:
    """Read the cameras of a session from a file, with the numbers that its `calibration` replaces.

    `names` are as of `rename`; `override` may hold `principal_point_px`.
    """
    found = rename(path, read(path, unit), names)
    return with_principal_points(found, override.get("principal_point_px", {}))


def with_principal_points(
    found: Iterable[Camera], principal_point_px: Mapping[str, Sequence[float]]
) -> list[Camera]:
    """Replace the principal points (x, y) px of some cameras, by their names.

    They are of the calibrated picture, before it is cropped. Raises `InputError` if one lies
    outside it.
    """
    replaced = []
    for camera in found:
        if camera.name not in principal_point_px:
            replaced.append(camera)
            continue
        x, y = principal_point_px[camera.name]
        if not (0 <= x < camera.size[0] and 0 <= y < camera.size[1]):
            raise InputError(
                f"camera {camera.name}: expected principal_point_px inside the calibrated "
                f"{camera_fields.times(camera.size)} px, found {[float(x), float(y)]}; correct it "
                "in the session file"
            )
        matrix = [[camera.K[0, 0], 0, x], [0, camera.K[1, 1], y], [0, 0, 1]]
        replaced.append(replace(camera, K=np.array(matrix)))
    return replaced


def _bytes(path: Path) -> bytes:
    with reading(path, f"a file, {forms.FORMS}", "check it"):
        if path.stat().st_size > LARGEST_BYTES:
            raise InputError(
                f"{path}: expected a calibration, found {path.stat().st_size} bytes; give the "
                "right file"
            )
        return path.read_bytes()


def _text(path: Path) -> str:
    data = _bytes(path)
    wide = data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)) or data[1:2] == b"\0"
    try:
        # Motive writes .mcal in UTF-16, with or without its mark.
        return data.decode("utf-16" if wide else "utf-8-sig")
    except UnicodeDecodeError:
        if b"\0" in data:
            found = "no text, as in a video or a picture", "give the calibration file"
        else:
            found = "text of another encoding", "save it as UTF-8"
        raise forms.refused(path, *found) from None


def _found(path: Path) -> Found:
    return _in_folder(path) if path.is_dir() else _in_file(path)


def _in_folder(path: Path) -> Found:
    if any((path / file).is_file() for file in easymocap.FILES):
        easymocap.check_both(path)
        first, second = (_text(path / file) for file in easymocap.FILES)
        return easymocap.read(path, (first, second)), "m"
    model = colmap.files(path)
    if model:
        binary = model[0].suffix == ".bin"
        return colmap.read(path, [_bytes(file) for file in model], binary=binary), ""
    pickles = opencap.files(path)
    if pickles:
        return [opencap.read(p, _bytes(p), name) for name, p in pickles.items()], None
    files = sorted(file for file in path.iterdir() if file.suffix.lower() in OPENCV_SUFFIXES)
    if not files:
        raise forms.refused(path, "a folder without them", "give one of these")
    texts = [_text(file) for file in files]
    found = [c for file, text in zip(files, texts, strict=True) for c in opencv.read(file, text)]
    return found, _unit_of(*texts)


def _in_file(path: Path) -> Found:
    if path.name in easymocap.FILES or (path.name in colmap.NAMES and colmap.files(path.parent)):
        return _in_folder(path.parent)
    if path.suffix in opencap.SUFFIXES:
        return [opencap.read(path, _bytes(path), path.stem)], None
    if path.suffix.lower() == ".cal":
        raise forms.refused(path, "a file of older Motive (.cal), which is closed", OF_MOTIVE)
    text = _text(path)
    start = text.lstrip()[:2000]
    if start.startswith("%YAML") or "<opencv_storage" in start:
        return opencv.read(path, text), _unit_of(text)
    if start.startswith("<"):
        return _read_xml(path, text), None
    if start.startswith("Format Version,"):
        raise forms.refused(path, "a take of OptiTrack Motive (.csv), without lenses", OF_MOTIVE)
    return _read_toml(path, text)


def _unit_of(*texts: str) -> str | None:
    """Return m, which a session may replace, or None where a text states a unit."""
    return None if any(UNIT_STATED.search(text) for text in texts) else "m"


def _read_xml(path: Path, text: str) -> list[Camera]:
    root = xml_fields.parse(path, text)
    if root.tag == "Cameras" or path.suffix.lower() == ".xcp":
        found = vicon.read(path, root)
    elif next(root.iter(optitrack.LENS), None) is not None or path.suffix.lower() == ".mcal":
        found = optitrack.read(path, root)
    elif qualisys.is_theia(root):
        raise forms.refused(path, "a calibration of Theia3D, its sensors in px", OF_THEIA)
    else:
        found = qualisys.read(path, root)
    ours = path.suffix.lower() in (".xcp", ".mcal") or qualisys.is_one(root)
    if found or ours:
        return found
    tag = f"XML of <{camera_fields.short(root.tag)}> without cameras of these"
    if "theia" in text.lower():
        raise forms.refused(path, f"{tag}, as of Theia3D", OF_THEIA)
    raise forms.refused(path, tag, IN_OUR_TOML)


def _read_toml(path: Path, text: str) -> Found:
    try:
        with reading(path, f"{forms.FORMS} (read as TOML)", "check it"):
            content = camera_fields.toml(text)
    except InputError:
        suffix = camera_fields.short(path.suffix)
        if suffix.lower() in ("", ".toml"):
            raise
        found = f"a {suffix} file, which is none of these"
        raise forms.refused(path, found, IN_OUR_TOML) from None
    tables, metadata = content.get("cameras", content), content.get("metadata")
    if not isinstance(tables, dict):
        raise InputError(
            f"{path}: expected a table cameras, found {camera_fields.short(tables)}; check it"
        )
    caliscope = {
        key: table
        for key, table in tables.items()
        if isinstance(table, dict) and ("cam_id" in table or "cameras" in content)
    }
    stated = _unit_of(text)
    if caliscope:
        unit = metadata.get("unit", "m") if isinstance(metadata, dict) else "m"
        return _read_caliscope(path, caliscope, camera_fields.unit_in_metres(path, unit)), stated
    freemocap = isinstance(metadata, dict) and "charuco_square_size" in metadata
    # FreeMoCap asks for the size of a square in mm, and writes no unit.
    return camera_files.read_toml(path), "mm" if freemocap and stated else stated


def _read_caliscope(path: Path, tables: Mapping[str, dict], metres: float) -> list[Camera]:
    """Read Caliscope's `[cameras.0]`, and the older `[cam_0]`; it writes metres, and no unit.

    Its `rotation_count` turns pictures on its screen only: the calibration is of the recorded ones.
    """
    found = []
    for key, table in tables.items():
        if not table.get("ignore", False):
            name = table.get("name", f"cam_{table.get('cam_id', key)}")
            found.append(camera_files.build(f"{path}: camera {name}", str(name), table, metres))
    return found
