"""Read cameras calibrated elsewhere: by Qualisys, Pose2Sim and aniposelib, Caliscope, OpenCV."""

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import cv2
import numpy as np
from numpy.typing import NDArray

from courtside.geometry import camera as camera_files
from courtside.geometry import camera_fields
from courtside.geometry.camera import Camera
from courtside.study.errors import InputError, StrPath, reading

LARGEST_BYTES = 1 << 24  # ASSUME: far above any calibration: a larger file is another one
APART_M = (0.1, 150.0)  # ASSUME: of the two cameras of a hall that are farthest apart
UNIT_STATED = re.compile(r"(?m)^\s*<?[\"']?unit[\"']?\s*[=:>]|<calibration\b")  # Qualisys: mm
STATE_UNIT = (
    "if its lengths are not metres, write `unit: mm` (or cm, in, ft) under calibration in the "
    "session file"
)
FARTHEST_M = 300.0  # ASSUME: no hall is larger: a camera farther away is in mm or cm
NAME = re.compile(r"[a-z0-9][a-z0-9_-]*")
FORMS = "Qualisys .qca.txt, TOML of Pose2Sim, aniposelib or Caliscope, or YAML or XML of OpenCV"
# What to do with files of other programs that are recognised and not read.
BY_POSE2SIM = (
    "convert it with Pose2Sim (calibration_type = 'convert', convert_from = '{}') and give the "
    "TOML file that it writes"
)
BY_EASYMOCAP = (
    BY_POSE2SIM.format("easymocap") + ", or give a TOML file with size, matrix, distortions, "
    "rotation and translation of each camera: the picture's size is not in these files"
)
PAIR = (
    "give each camera with its own camera_matrix, distortion_coefficients, R, T, image_width and "
    "image_height, both placed in the frame of the hall, in one file"
)
# Keys, in small letters, by which the matrices of both cameras of a pair are stored.
STEREO = (
    {"m1", "m2"},
    {"k1", "k2"},
    {"cameramatrix1", "cameramatrix2"},
    {"camera_matrix_1", "camera_matrix_2"},
    {"camera_matrix1", "camera_matrix2"},
    {"camera_matrix_left", "camera_matrix_right"},
    {"left_camera_matrix", "right_camera_matrix"},
    {"k_left", "k_right"},
    {"kl", "kr"},
)
QUALISYS_PER_PX = 64  # see `_from_qualisys`
QUALISYS_TURNS = ("0", "90", "180", "270")
# A Qualisys camera looks along -z with y up, ours along +z with y down.
QUALISYS_CAM_FROM_CAM = np.diag([1.0, -1.0, -1.0])
OPENCV_SUFFIXES = (".yml", ".yaml", ".xml")
OPENCV_KEYS = {  # the first is what `camera.build` calls it
    "matrix": ("camera_matrix", "K"),
    "distortions": ("distortion_coefficients", "dist"),
    "rotation": ("R", "rvec"),
    "translation": ("T", "tvec"),
}


def read(path: StrPath, unit: str | None = None) -> list[Camera]:
    """Read the cameras of a calibration file, choosing the reader by what the file holds.

    It is a Qualisys `.qca.txt`; a TOML file of Pose2Sim, aniposelib or Caliscope; a YAML or XML
    file of OpenCV's FileStorage with one or several cameras; or a folder of such, one camera each.
    Cameras are in the file's order under the file's names, in metres, with the file's world frame.
    `unit` is that of its lengths where the file does not state one; m where nobody does. Raises
    `InputError` if the form is not known, the unit is stated twice, or a camera is incomplete,
    impossible or named twice.
    """
    path = Path(path)
    if path.is_dir():
        files = sorted(file for file in path.iterdir() if file.suffix.lower() in OPENCV_SUFFIXES)
        texts = [_text(file) for file in files]
        pairs = zip(files, texts, strict=True)
        found = [camera for file, text in pairs for camera in _read_opencv(file, text)]
    else:
        texts = [_text(path)]
        found = _reader(texts[0])(path, texts[0])
    if unit is not None:
        found = _in_unit(path, texts, found, unit)
    for camera in camera_fields.check_distinct(path, found):
        far_m = np.linalg.norm(camera.centre_in_world)
        if far_m > FARTHEST_M:
            raise InputError(
                f"{path}: camera {camera.name}: expected it within {FARTHEST_M:g} m of the world's "
                f"origin, found {far_m:.0f} m; {STATE_UNIT}"
            )
    return found


def check_apart(path: StrPath, cameras: Sequence[Camera]) -> None:
    """Raise `InputError` if the cameras of a session are no plausible distance apart."""
    centres = np.array([camera.centre_in_world for camera in cameras])
    apart_m = float(np.linalg.norm(centres[:, None] - centres, axis=-1).max())
    if len(cameras) > 1 and not APART_M[0] <= apart_m <= APART_M[1]:
        raise InputError(
            f"{path}: expected cameras {APART_M[0]:g} to {APART_M[1]:g} m apart, found "
            f"{apart_m:.3g} m between the farthest; {STATE_UNIT}"
        )


def _in_unit(
    path: Path, texts: Sequence[str], cameras: Sequence[Camera], unit: str
) -> list[Camera]:
    """Return cameras whose file states no unit, in metres."""
    if any(UNIT_STATED.search(text) for text in texts):
        raise InputError(
            f"{path}: expected `unit` under calibration in the session file for a file that states "
            "none, found one in the file; remove one of the two"
        )
    metres = camera_fields.unit_in_metres(f"{path}: unit", unit)
    scale = np.array([1, 1, 1, metres])
    return [replace(camera, cam_from_world=camera.cam_from_world * scale) for camera in cameras]


def rename(found: Iterable[Camera], names: Mapping[str, str]) -> list[Camera]:
    """Pick the cameras of a session from a calibration, under the session's names, in their order.

    `names` maps the name in the session to the name in the calibration. Raises `InputError` if the
    calibration has no such camera, two cameras of the session are the same one, or a name cannot be
    a file name of the study.
    """
    by_name = {camera.name: camera for camera in found}
    for ours, theirs in names.items():
        if theirs not in by_name:
            raise InputError(
                f"camera {ours}: expected {theirs!r} in the calibration, found "
                f"{', '.join(by_name)}; give the camera its `name_in_calibration` in the session "
                "file"
            )
        if list(names.values()).count(theirs) > 1:
            raise InputError(
                f"camera {ours}: expected a camera of its own in the calibration, found {theirs!r} "
                "given to another as well; correct the session file"
            )
        if not NAME.fullmatch(ours):
            raise InputError(
                f"camera {ours!r}: expected a name of a-z, 0-9, _ and -, begun with a letter or "
                "digit, found another; rename it in the session file"
            )
    return [replace(by_name[theirs], name=ours) for ours, theirs in names.items()]


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


def _text(path: Path) -> str:
    with reading(path, f"a text file, {FORMS}", "check it"):
        if path.stat().st_size > LARGEST_BYTES:
            raise InputError(
                f"{path}: expected a calibration, found {path.stat().st_size} bytes; give the "
                "right file"
            )
        return path.read_text(encoding="utf-8-sig")


def _reader(text: str) -> Callable[[Path, str], list[Camera]]:
    start = text.lstrip()[:2000]
    if start.startswith("%YAML") or "<opencv_storage" in start:
        return _read_opencv
    if start.startswith("<"):
        return _read_qualisys
    return _read_toml


def _read_toml(path: Path, text: str) -> list[Camera]:
    with reading(path, f"{FORMS} (read as TOML)", "check it"):
        content = camera_fields.toml(text)
    tables = content.get("cameras", content)
    if not isinstance(tables, dict):
        raise InputError(
            f"{path}: expected a table cameras, found {camera_fields.short(tables)}; check it"
        )
    caliscope = {
        key: table
        for key, table in tables.items()
        if isinstance(table, dict) and ("cam_id" in table or "cameras" in content)
    }
    if not caliscope:
        return camera_files.read_toml(path)
    metadata = content.get("metadata")
    unit = metadata.get("unit", "m") if isinstance(metadata, dict) else "m"
    return _read_caliscope(path, caliscope, camera_fields.unit_in_metres(path, unit))


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


def _read_qualisys(path: Path, text: str) -> list[Camera]:
    if re.search(r"<!\s*(DOCTYPE|ENTITY)", text, re.IGNORECASE):
        raise InputError(
            f"{path}: expected plain XML, found a DOCTYPE or ENTITY; export it from QTM again"
        )
    with reading(path, "XML", camera_fields.EXPORT_AGAIN):  # its ParseError is a SyntaxError
        root = ElementTree.fromstring(text)
    if root.tag.lower() == "cameras" or path.suffix.lower() == ".xcp":
        raise _other(path, "cameras of Vicon (.xcp)", BY_POSE2SIM.format("vicon"))
    return [
        _from_qualisys(path, element)
        for element in root.findall("cameras/camera")
        if element.get("active", "1") != "0" and element.get("calibrated", "true") != "false"
    ]


def _from_qualisys(path: Path, element: ElementTree.Element) -> Camera:
    """Turn one <camera> into a camera.

    Lengths on the sensor are in 1/64 px. Distortion is OpenCV's, without a unit; Pose2Sim 0.10
    divides it by 64 too, which chessboard stills of its own demonstration contradict (k1 -0.04, not
    -0.0007).
    """
    name = element.get("serial", "without serial")
    where = f"{path}: camera {name}"
    # ASSUME: viewrotation turns the picture in QTM's windows only; the video file and these numbers
    # are those of the sensor as it is.
    turned = element.get("viewrotation", "0")
    if turned not in QUALISYS_TURNS:
        raise InputError(
            f"{where}: expected viewrotation as one of {', '.join(QUALISYS_TURNS)}, found "
            f"{camera_fields.short(turned)}; {camera_fields.EXPORT_AGAIN}"
        )
    left, top, right, bottom = _attributes(where, element, "fov_video", "left top right bottom")
    focal_u, focal_v, centre_u, centre_v, skew = _attributes(
        where, element, "intrinsic", "focalLengthU focalLengthV centerPointU centerPointV skew"
    )
    # ASSUME: coordinate 0 is the first pixel's centre, as Pose2Sim takes it; were it that pixel's
    # corner, the principal point would move by half a pixel.
    matrix = np.array([[focal_u, skew, centre_u], [0, focal_v, centre_v], [0, 0, 0]])
    matrix = matrix / QUALISYS_PER_PX - [[0, 0, left], [0, 0, top], [0, 0, -1]]
    dist = "radialDistortion1 radialDistortion2 tangentalDistortion1 tangentalDistortion2"
    place = _attributes(where, element, "transform", "r11 r12 r13 r21 r22 r23 r31 r32 r33 x y z")
    rotation = QUALISYS_CAM_FROM_CAM @ place[:9].reshape(3, 3)
    table = {
        "size": (right - left + 1, bottom - top + 1),
        "matrix": matrix,
        "distortions": _attributes(where, element, "intrinsic", f"{dist} radialDistortion3"),
        "rotation": rotation,
        "translation": -rotation @ place[9:],
    }
    return camera_files.build(where, name, table, camera_fields.METRES["mm"])


def _attributes(where: str, element: ElementTree.Element, tag: str, keys: str) -> NDArray:
    child = element.find(tag)
    attributes = {} if child is None else child.attrib
    return np.array(
        [
            camera_fields.numbers(where, f"{tag} {key}", attributes.get(key), ())
            for key in keys.split()
        ]
    )


def _read_opencv(path: Path, text: str) -> list[Camera]:
    with reading(
        path, "a file of OpenCV's FileStorage", "check it", kinds=(cv2.error, SystemError)
    ):
        storage = cv2.FileStorage(text, cv2.FILE_STORAGE_READ | cv2.FILE_STORAGE_MEMORY)
        root = storage.root()
    _check_known(path, list(root.keys()) if root.isMap() else [])
    if _child(root, OPENCV_KEYS["matrix"]) is not None:
        return [_from_opencv(path, root, path.stem, root)]
    maps = [(key, root.getNode(key)) for key in (root.keys() if root.isMap() else ())]
    maps = [(key, node) for key, node in maps if node.isMap() and _child(node, ("data",)) is None]
    if not maps:
        found = ", ".join(root.keys()[:6]) if root.isMap() else "nothing"
        raise _other(path, f"no camera_matrix among: {found or 'nothing'}", "check it")
    return [_from_opencv(path, node, key, root) for key, node in maps]


def _check_known(path: Path, keys: Sequence[str]) -> None:
    """Raise `InputError` for forms that are stored like OpenCV's and are not one camera each."""
    stems = {key.rpartition("_")[0] for key in keys}
    if {"K", "dist"} <= stems or {"R", "T"} <= stems or {"Rot", "T"} <= stems:
        raise _other(path, "cameras of EasyMocap (names, K_..., Rot_...)", BY_EASYMOCAP)
    if any(pair <= {key.lower() for key in keys} for pair in STEREO):
        raise _other(path, f"a stereo pair ({', '.join(keys[:4])} ...)", PAIR)


def _other(path: Path, found: str, mend: str) -> InputError:
    return InputError(f"{path}: expected {FORMS}, found {found}; {mend}")


def _from_opencv(path: Path, node: Any, name: str, root: Any) -> Camera:
    name_node = _child(node, ("name", "camera_name"))
    name = name_node.string() if name_node is not None and name_node.isString() else name
    where = f"{path}: camera {name}"
    table = {ours: _value(_child(node, keys)) for ours, keys in OPENCV_KEYS.items()}
    table["size"] = [_value(_child(node, (key,))) for key in ("image_width", "image_height")]
    unit = _child(node, ("unit",)) or _child(root, ("unit",))
    # ASSUME: metres where the file names no unit; OpenCV has none of its own.
    metres = camera_fields.unit_in_metres(where, "m" if unit is None else _value(unit))
    return camera_files.build(where, name, table, metres)


def _child(node: Any, keys: Sequence[str]) -> Any:
    found = [node.getNode(key) for key in keys] if node.isMap() else []
    return next((child for child in found if not child.empty() and not child.isNone()), None)


def _value(node: Any) -> Any:
    """Return a node of FileStorage as rows of a matrix, list, number or text; else None."""
    if node is None:
        return None
    if node.isSeq():
        return [_value(node.at(index)) for index in range(node.size())]
    if node.isString():
        return node.string()
    if node.isInt() or node.isReal():
        return node.real()
    return _rows(node) if node.isMap() else None


def _rows(node: Any) -> Any:
    """Return a stored matrix as rows, or a vector as a list.

    FileStorage's own method crashes where rows, columns and type do not fit the data.
    """
    columns, data = (_value(_child(node, (key,))) for key in ("cols", "data"))
    if not isinstance(data, list) or not isinstance(columns, float):
        return data
    if columns in (1, len(data)) or columns < 1:
        return data
    return [data[at : at + int(columns)] for at in range(0, len(data), int(columns))]
