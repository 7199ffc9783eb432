"""Formats of devices and of other programs' keypoints: BVH, Nuitrack, OpenPose, RealSense."""

import json
import shutil
import warnings

import cv2
import numpy as np

from courtside.devices import bvh, mocopi, nuitrack, open_depth, openpose
from courtside.geometry import camera as cameras
from courtside.records.devices.hierarchy import forward
from courtside.records.keypoints import skeleton
from courtside.records.keypoints.keypoints import Keypoints2D
from courtside.video import writer
from fixtures.people import walker
from fixtures.recordings import depth_recordings_made
from fixtures.recordings.bvh_texts import ARM
from fuzz.format import Format, require
from fuzz.of_cameras import real
from fuzz.of_study import CONFIG

SKELETONS = CONFIG / "skeletons"
MOCOPI = skeleton.read(SKELETONS / "mocopi27.yaml")
NUITRACK = skeleton.read(SKELETONS / "nuitrack19.yaml").joints
COCO = skeleton.read(SKELETONS / "coco17.yaml")
BODY25B = skeleton.read(SKELETONS / "body25b.yaml")
SIZE = (1088, 1920)


def three_rows(path):
    """Return a BVH text cut to three rows."""
    head, found, rows = path.read_text(encoding="utf-8").partition("MOTION\n")
    count, _, rest = rows.partition("\n")
    period, _, rows = rest.partition("\n")
    if not found or len(head) + len(rows) < 10_000:
        return head + found + f"{count}\n{period}\n{rows}" if found else head
    kept = "\n".join(rows.splitlines()[:3])
    return f"{head}MOTION\n{count.split(':')[0]}: 3\n{period}\n{kept}\n"


def bvhs(folder):
    """Write a BVH text with everything that the format has; copy short forms of real ones."""
    (folder / "arm.bvh").write_text(ARM, encoding="utf-8")
    names = (
        "mocopi/*.bvh",
        "mocopi/edge-cases/*.bvh",
        "mocopi/malformed/*.bvh",
        "bvh-walk01/*.bvh",
    )
    for path in [path for pattern in names for path in real(pattern)]:
        (folder / path.name).write_text(three_rows(path), encoding="utf-8")


def read_bvh(path):
    """Read a motion and compute where its joints are; a warning is a fault."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        posed = bvh.read(path)
        xyz, world = forward(posed)
    require(np.isfinite(xyz).all() and np.isfinite(posed.time_s).all(), "numbers that are none")
    turned = world @ np.swapaxes(world, -1, -2)
    require(np.allclose(turned, np.eye(3), atol=1e-6), "rotations that are none")
    return xyz


def suits(folder):
    """Write a mocopi file; copy short forms of real ones."""
    lines, depth = ["HIERARCHY"], 0
    parent = {child: parent for parent, child in MOCOPI.bones}
    names = dict(zip(MOCOPI.joints, MOCOPI.device_names(), strict=True))

    def write(joint):
        nonlocal depth
        pad, kind = "  " * depth, "ROOT" if depth == 0 else "JOINT"
        lines.extend([f"{pad}{kind} {names[joint]}", f"{pad}{{", f"{pad}  OFFSET 1 10 2"])
        channels = "Xposition Yposition Zposition Zrotation Xrotation Yrotation"
        lines.append(f"{pad}  CHANNELS 6 {channels}")
        depth += 1
        children = [child for child in MOCOPI.joints if parent.get(child) == joint]
        for child in children:
            write(child)
        depth -= 1
        if not children:
            lines.extend([f"{pad}  End Site", f"{pad}  {{", f"{pad}    OFFSET 0 5 0", f"{pad}  }}"])
        lines.append(f"{pad}}}")

    write(next(joint for joint in MOCOPI.joints if joint not in parent))
    row = " ".join(["1 10 2 0 15 -5"] * len(MOCOPI.joints))
    lines += ["MOTION", "Frames: 2", "Frame Time: 0.016667", row, row, ""]
    (folder / "made.bvh").write_text("\n".join(lines), encoding="utf-8")
    for path in real("mocopi/*.bvh"):
        (folder / path.name).write_text(three_rows(path), encoding="utf-8")


def read_suit(path):
    """Read a mocopi recording."""
    found = mocopi.read(path, MOCOPI)
    require(found.xyz.shape == (len(found.time_s), 27, 3), "shape")
    return found


def places():
    """Return three skeletons of Nuitrack, (T, J, 3) metres, y up."""
    xyz = np.random.default_rng(0).uniform((-1, -1, 2), (1, 1, 4), (3, len(NUITRACK), 3))
    xyz[:, NUITRACK.index("neck")] = [0.0, 0.8, 3.3]
    xyz[:, NUITRACK.index("waist")] = [0.0, 0.26, 3.38]
    return xyz.round(4)


def called(joint):
    """Return the names of a joint in Nuitrack."""
    return ("left_collar", "right_collar") if joint == "collar" else (joint,)


def nuitrack_json(folder):
    """Write both forms of JSON."""
    frames = []
    for k, xyz in enumerate(places()):
        joints = {
            name: {"real": (1000 * place).tolist(), "confidence": 0.75}
            for joint, place in zip(NUITRACK, xyz, strict=True)
            for name in called(joint)
        }
        stamp = 1715151474879921 + 33333 * k
        frames.append({"timestamp": stamp, "skeletons": [{"user_id": 1} | joints]})
    (folder / "list.json").write_text(json.dumps(frames), encoding="utf-8")
    rows = []
    for frame in frames:
        joints = [
            {"Type": nuitrack.NUMBERS.index(name), "Real": dict(zip("XYZ", j["real"], strict=True))}
            for name, j in frame["skeletons"][0].items()
            if name != "user_id"
        ]
        rows.append({"Timestamp": frame["timestamp"], "Skeletons": [{"ID": 1, "Joints": joints}]})
    text = "\n".join(map(json.dumps, rows))
    (folder / "lines.json").write_text(text, encoding="utf-8")


def nuitrack_csv(folder):
    """Write a table of the recorder."""
    head = ["timestamp", "serial", "id"]
    names = [name for joint in NUITRACK for name in called(joint)]
    head += [f"JOINT_{name.upper()}.{axis}" for name in names for axis in "xyz"]
    lines = [",".join(head)]
    for k, xyz in enumerate(places()):
        cells = [1715151474879921 + 33333 * k, "AS3M", 1]
        for joint, place in zip(NUITRACK, xyz, strict=True):
            cells += [*place] * len(called(joint))
        lines.append(",".join(map(str, cells)))
    (folder / "recorded.csv").write_text("\n".join([*lines, ""]), encoding="utf-8")


def read_nuitrack(path):
    """Read a user's skeleton."""
    found = nuitrack.read(path, NUITRACK, "n")
    require((np.diff(found.time_s) > 0).all(), "times that do not increase")
    require(not np.isinf(found.xyz).any(), "an infinite place")
    return found


def openposes(folder):
    """Write folders of OpenPose's JSON, one person and none, and two."""
    for name, joints in (("coco", COCO), ("body", BODY25B)):
        (folder / name).mkdir()
        n = len(joints.joints)
        one = np.column_stack([100 + 10 * np.arange(n), 50 + 20.0 * np.arange(n), np.full(n, 0.8)])
        for frame, shifts in ((7, [0]), (8, [1, 200]), (10, [])):
            people = [
                {"pose_keypoints_2d": np.add(one, [k, 0, 0]).ravel().tolist()} for k in shifts
            ]
            text = json.dumps({"version": 1.3, "people": people})
            (folder / name / f"cam_{frame:012}_keypoints.json").write_text(text, encoding="utf-8")
    theirs = real("walk-4cams/openpose_body25b/cam1_json/*.json")[:2]
    if theirs:
        (folder / "body25b").mkdir()
        for path in theirs:
            shutil.copy(path, folder / "body25b")


def read_openpose(path):
    """Read a camera's keypoints."""
    joints = COCO if path.name == "coco" else BODY25B
    found = openpose.read(
        path, joints, camera="c", model="theirs", size=SIZE, time_s=np.arange(4) / 30
    )
    require(isinstance(found, Keypoints2D) and not np.isinf(found.xy).any(), "an infinite place")
    return found


def bags(folder):
    """Write a ROS 1 recording; a real one is too large to be read often."""
    depth_recordings_made.write_bag(folder / "a.bag", depth_recordings_made.frames(3))


def plain(image, encoding):
    """Return a picture's message as the camera's program has it, without packing."""
    values = {
        "height": image.shape[0], "width": image.shape[1], "encoding": encoding, "is_bigendian": 0,
        "step": image[0].nbytes, "data": np.frombuffer(image.tobytes(), np.uint8),
    }  # fmt: skip
    return "", "sensor_msgs/msg/Image", values


def packed(image, encoding):
    """Return a packed picture's message."""
    data = cv2.imencode(".png", image)[1].ravel()
    deep = encoding == "mono16"
    head = np.zeros(12 if deep else 0, np.uint8)
    form = "16UC1; compressedDepth png" if deep else "bgr8; png compressed bgr8"
    ending = "/compressedDepth" if deep else "/compressed"
    values = {"format": form, "data": np.concatenate([head, data])}
    return ending, "sensor_msgs/msg/CompressedImage", values


def bases(folder):
    """Write ROS 2 recordings, with plain and with packed pictures."""
    made = depth_recordings_made.frames(2)
    for name, picture in (("plain", plain), ("packed", packed)):
        rows = depth_recordings_made.messages_of_db3(made, picture)
        depth_recordings_made.write_db3(folder / f"{name}.db3", rows)


def depths(folder):
    """Write a folder of colour and depth."""
    made = folder / "recording"
    (made / "depth").mkdir(parents=True)
    found = [depth_recordings_made.COLOUR, depth_recordings_made.DEPTH]
    cameras.write_toml(made / "cameras.toml", found, source="test")
    with (made / "cameras.toml").open("a", encoding="utf-8") as stream:
        stream.write("depth_unit_m = 0.0005\nbaseline_m = 0.05\n")
    frames = depth_recordings_made.frames(3)
    writer.write_video(made / "colour.mp4", [bgr for _, bgr, _ in frames], 30, crf=10)
    for k, (_, _, steps) in enumerate(frames):
        cv2.imwrite(str(made / "depth" / f"{k:04}.png"), steps)
    for name in ("colour", "depth"):
        text = "number,time_s\n7,1.0\n8,1.1\n9,1.2\n"
        (made / f"{name}.csv").write_text(text, encoding="utf-8")


def read_depth(path):
    """Read a recording of colour and depth, all its pictures."""
    found = open_depth.read(path, "d")
    for frames, camera in ((found.colour_frames, found.colour), (found.depth_frames, found.depth)):
        for time_s, picture in frames():
            require(np.isfinite(time_s) and picture.shape[1::-1] == camera.size, "a picture")
    require((np.diff(found.colour_index().time_s) > 0).all(), "times that do not increase")
    return walker.N_JOINTS


FORMATS = [
    Format("bvh", 4000, bvhs, read_bvh),
    Format("mocopi-bvh", 400, suits, read_suit),
    Format("nuitrack-json", 900, nuitrack_json, read_nuitrack),
    Format("nuitrack-csv", 700, nuitrack_csv, read_nuitrack),
    Format("openpose-json", 900, openposes, read_openpose),
    Format("bag", 700, bags, read_depth),
    Format("db3", 600, bases, read_depth),
    Format("depth-folder", 400, depths, read_depth),
]
