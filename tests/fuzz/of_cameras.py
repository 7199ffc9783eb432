"""Formats of calibrations, ours and those of other programs, and of what is clicked in pictures."""

import shutil
import struct

import cv2
import numpy as np
import tomli_w

from courtside.calibration import file_formats
from courtside.calibration.boards import corners
from courtside.calibration.boards.board import Board
from courtside.calibration.court import court
from courtside.calibration.wand import points
from courtside.exports import pose2sim, trc
from courtside.geometry import camera as cameras
from courtside.reconstruction import error_signs, joint_correction, joint_errors
from courtside.records.cameras import click_proposals, clicks
from fixtures.cameras import foreign_files, scene
from fixtures.people import walker
from fixtures.recordings.real_data import REAL
from fuzz.format import Format, require
from fuzz.of_study import CONFIG, copies

ROTATION = cv2.Rodrigues(np.array([1.2, -0.7, 0.4]))[0]
TRANSLATION = np.array([0.3, -0.5, 6.0])
K = np.array([[1500.0, 0.0, 950.0], [0.0, 1490.0, 545.0], [0.0, 0.0, 1.0]])
DIST = np.array([-0.21, 0.06, 0.0011, -0.0023, 0.013])
LEFT = cameras.Camera("left", (1920, 1080), K, DIST, np.column_stack([ROTATION, TRANSLATION]))
RIGHT = cameras.Camera("right", (1280, 720), K, np.zeros(5), np.eye(3, 4))
QUALISYS = """<?xml version="1.0" encoding="UTF-8"?>
<calibration source="x"><results std-dev="1.0"/><cameras>
{}
<camera active="0" serial="off"/>
</cameras></calibration>
"""
QUALISYS_CAMERA = """<camera active="1" calibrated="true" serial="{}" viewrotation="90">
<fov_video left="8" top="4" right="1919" bottom="1087"/>
<transform x="4000.0" y="2000.0" z="1500.0" r11="0.000000" r12="1.000000" r13="0.000000"
 r21="0.000000" r22="0.000000" r23="1.000000" r31="1.000000" r32="0.000000" r33="0.000000"/>
<intrinsic focalLengthU="96000.0" focalLengthV="96064.0" \
centerPointU="61440.0" centerPointV="34816.0"
 skew="0.0" radialDistortion1="-0.05" radialDistortion2="0.14" radialDistortion3="0.003"
 tangentalDistortion1="0.0006" tangentalDistortion2="-0.0004"/>
</camera>"""
COURT = court.read(CONFIG / "courts" / "badminton.yaml")
CAMERAS = ["left", "right"]
WAND_COLUMNS = "camera", "frame", "marker", "x_px", "y_px"
NAMED = {"left": "left", "right": "cam_1"}
BOARD = Board("charuco", (5, 4), 0.1, 0.075, "DICT_4X4_50")


def real(pattern):
    """Return real files, none where they are not."""
    return sorted(REAL.glob(pattern)) if REAL.is_dir() else []


def checked(found):
    """Return cameras, after a look whether they can be one's."""
    require(len({camera.name for camera in found}) == len(found) > 0, "names of cameras")
    for camera in found:
        xy = cameras.project(camera, camera.centre_in_world + camera.cam_from_world[2, :3])
        require(np.isfinite(camera.K).all() and xy.shape == (2,), "a camera that projects nothing")
    return found


def own_toml(folder):
    """Write cameras as the study hands them on."""
    cameras.write_toml(folder / "cameras.toml", [LEFT, RIGHT], source="test")


def other_toml(folder):
    """Write cameras as Caliscope and older aniposelib do; copy real ones."""
    table = {
        "cam_id": 1, "size": [1920, 1080], "matrix": K.tolist(), "distortions": DIST.tolist(),
        "rotation": ROTATION.tolist(), "translation": TRANSLATION.tolist(), "ignore": False,
        "rotation_count": 0, "error": 0.3,
    }  # fmt: skip
    tables = {"1": table, "2": table | {"cam_id": 2, "name": "b"}}
    (folder / "new.toml").write_text(tomli_w.dumps({"cameras": tables}), encoding="utf-8")
    (folder / "old.toml").write_text(tomli_w.dumps({"cam_1": table}), encoding="utf-8")
    for path in [*real("charuco-4cams/c*.toml"), *real("walk-4cams/calibration/*.toml")]:
        shutil.copy(path, folder)


def qualisys(folder):
    """Write a calibration of Qualisys; copy a real one."""
    text = QUALISYS.format("\n".join(map(QUALISYS_CAMERA.format, ("26580", "26581"))))
    (folder / "made.qca.txt").write_text(text, encoding="utf-8")
    for path in real("walk-4cams/calibration/*.txt"):
        shutil.copy(path, folder)


def opencv(suffix):
    """Return a function that writes calibrations of OpenCV."""

    def make(folder):
        values = {
            "image_width": 1920, "image_height": 1080, "camera_matrix": K,
            "distortion_coefficients": DIST.reshape(1, 5), "R": ROTATION, "T": TRANSLATION,
        }  # fmt: skip
        one = cv2.FileStorage(str(folder / f"one{suffix}"), cv2.FILE_STORAGE_WRITE)
        several = cv2.FileStorage(str(folder / f"several{suffix}"), cv2.FILE_STORAGE_WRITE)
        several.write("unit", "cm")
        for storage, names in ((one, [None]), (several, ["left", "right"])):
            for name in names:
                if name:
                    storage.startWriteStruct(name, cv2.FILE_NODE_MAP)
                for key, value in values.items():
                    storage.write(key, value)
                if name:
                    storage.endWriteStruct()
            storage.release()

    return make


def vicon_xcp(folder):
    """Write a calibration of Vicon."""
    text = foreign_files.vicon((3.1e-8, -4e-15, 0), names=("2101", "2102"))
    (folder / "hall.xcp").write_text(text, encoding="utf-8")


def optitrack_mcal(folder):
    """Write calibrations of OptiTrack, in UTF-16 as Motive does, and in UTF-8."""
    text = foreign_files.optitrack((0.1, -0.1, 0, -8e-4, 3e-4))
    (folder / "wide.mcal").write_bytes(text.encode("utf-16"))
    (folder / "narrow.mcal").write_text(text, encoding="utf-8")


def easymocap_folder(folder):
    """Write both files of EasyMocap into a folder."""
    (folder / "hall").mkdir()
    foreign_files.easymocap(folder / "hall")


def opencap_pickle(folder):
    """Write a camera of OpenCap."""
    foreign_files.opencap(folder / "cam00.pickle")


def colmap_folders(folder):
    """Write a COLMAP model as text, and as binary files."""
    (folder / "text").mkdir()
    foreign_files.colmap(folder / "text")
    (folder / "binary").mkdir()
    pose = [0.9, 0.3, -0.3, 0.1, *TRANSLATION]
    lens = struct.pack("<QIiQQ4d", 1, 4, 1, 1920, 1080, 1500, 1490, 950, 545)
    image = struct.pack("<QI7dI", 1, 1, *pose, 4) + b"left.png\0" + struct.pack("<Q2dQ", 1, 1, 2, 3)
    (folder / "binary" / "cameras.bin").write_bytes(lens)
    (folder / "binary" / "images.bin").write_bytes(image)


def board_corners(folder):
    """Write corners of a board in our columns and in Caliscope's."""
    rows = [
        f"{k // 4},{('left', 'cam_1')[k % 2]},{k % 12},{10.5 + k},{20.25 + k}" for k in range(24)
    ]
    text = "\n".join([",".join(corners.OURS), *rows, ""])
    (folder / "ours.csv").write_text(text, encoding="utf-8")
    rows = [f"{k // 4},1,{k % 12},{10.5 + k},{20.25 + k},0.1" for k in range(24)]
    text = "\n".join([",".join([*corners.THEIRS, "frame_time"]), *rows, ""])
    (folder / "theirs.csv").write_text(text, encoding="utf-8")


def read_corners(path):
    """Read corners of a board."""
    names = {"right": "cam_1"} if path.name.startswith("theirs") else NAMED
    found = corners.of_table(path, names, BOARD)
    require(len(found.xy) == len(found.camera) and np.isfinite(found.xy).all(), "corners")
    return found


def wand_points(folder):
    """Write markers of a wand in our columns and in those of DLTdv, Argus and easyWand."""
    rows = [
        f"{('left', 'cam_1')[k % 2]},{k // 4},{'ab'[k // 2 % 2]},{10.5 + k},{20.25 + k}"
        for k in range(24)
    ]
    (folder / "ours.csv").write_text(
        "\n".join([",".join(WAND_COLUMNS), *rows, ""]), encoding="utf-8"
    )
    header = [f"pt{p}_cam{c}_{axis}" for p in (1, 2) for c in (1, 2) for axis in "XY"]
    rows = [",".join(["NaN"] * 4 + [f"{10.5 * k + n}" for n in range(4)]) for k in range(8)]
    (folder / "dltdv.csv").write_text("\n".join([",".join(header), *rows, ""]), encoding="utf-8")
    header = [f"Track {p}_cam_{c}_{axis}" for p in (1, 2) for c in (1, 2) for axis in "xy"]
    (folder / "argus.csv").write_text("\n".join([",".join(header), *rows, ""]), encoding="utf-8")
    (folder / "bare.csv").write_text("\n".join([*rows, ""]), encoding="utf-8")


def read_wand(path):
    """Read markers of a wand."""
    given = {"length_m": 0.5, "points": str(path)}
    if not path.name.startswith("ours"):
        given["program"] = "argus"
    sizes = {"left": (1920, 1080), "right": (1280, 720)}
    found = points.read(given, points.Wand.of(given), NAMED, sizes)
    require(found.xy.shape == (2, len(found.frames), 2, 2), "markers")
    return found


def read_model(path):
    """Read cameras of a COLMAP model in metres."""
    return checked(file_formats.read(path, "m"))


def trcs(folder):
    """Write TRC files; copy the start of a real one."""
    record = walker.points(6, n_persons=2)
    for person in range(2):
        trc.write(folder / f"p{person}.trc", record, person)
    for path in real("walk-4cams/**/*.trc")[:1]:
        lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
        text = "".join(lines[:10]).replace(f"\t{len(lines) - 5}\t", "\t5\t")
        (folder / path.name).write_text(text, encoding="utf-8")


def read_trc(path):
    """Read a TRC file as it is, and as a take of another program."""
    joints, rate_hz, time_s, xyz = trc.read(path)
    require(xyz.shape == (len(time_s), len(joints), 3) and np.isfinite(rate_hz), "shapes")
    return pose2sim.read_takes({"p1": path}, walker.SKELETON, model="theirs")


def clicked(folder):
    """Write court points as people click them."""
    xy = np.arange(2.0 * len(COURT.points)).reshape(-1, 2)
    xy[3] = np.nan
    clicks.write(folder / "points.csv", {"left": xy, "right": xy + 0.25}, COURT.points)


def read_clicks(path):
    """Read court points."""
    found = clicks.read(path, CAMERAS, list(COURT.points))
    require(list(found) == CAMERAS, "cameras")
    require(all(not np.isinf(xy).any() for xy in found.values()), "a place that is none")
    return found


def proposed(folder):
    """Write proposals of court points."""
    head = ",".join(click_proposals.COLUMNS)
    rows = ["left,p01,0,10.5,20.25,0.4,0.9,", "left,p02,0,,,,,hidden", "right,p01,0,1,2,3,0.5,"]
    (folder / "proposals.csv").write_text("\n".join([head, *rows, ""]), encoding="utf-8")


def read_proposals(path):
    """Read proposals."""
    return click_proposals.read(path, CAMERAS, list(COURT.points))


def read_offsets(path):
    """Read joint offsets and subtract them."""
    table, cameras = joint_correction.read(path), scene.ring(3)
    return joint_correction.correct(walker.points(6), table, cameras=cameras)


def read_errors(path):
    """Read a model of joint errors and state them."""
    record = walker.points(6)
    signs = dict.fromkeys(error_signs.NAMES, record.xyz[..., 0])
    return joint_errors.state(record, joint_errors.read(path), signs)


def read_cameras(path):
    """Read cameras of any program."""
    return checked(file_formats.read(path))


def read_own(path):
    """Read cameras as every rule does."""
    return checked(cameras.read_toml(path))


FORMATS = [
    Format("cameras-toml", 1200, own_toml, read_own),
    Format("other-toml", 1000, other_toml, read_cameras),
    Format("qca-txt", 1000, qualisys, read_cameras),
    Format("opencv-yaml", 800, opencv(".yml"), read_cameras),
    Format("opencv-xml", 700, opencv(".xml"), read_cameras),
    Format("vicon-xcp", 600, vicon_xcp, read_cameras),
    Format("optitrack-mcal", 600, optitrack_mcal, read_cameras),
    Format("easymocap-yaml", 600, easymocap_folder, read_cameras),
    Format("opencap-pickle", 800, opencap_pickle, read_cameras),
    Format("colmap-model", 800, colmap_folders, read_model),
    Format("board-corners-csv", 400, board_corners, read_corners),
    Format("wand-points-csv", 600, wand_points, read_wand),
    Format("trc", 1200, trcs, read_trc),
    Format("clicks-csv", 1200, clicked, read_clicks),
    Format("proposals-csv", 400, proposed, read_proposals),
    Format("joint-offsets-csv", 400, copies("config/joint_offsets/*.csv"), read_offsets),
    Format("joint-errors-csv", 400, copies("config/joint_errors/*.csv"), read_errors),
]
