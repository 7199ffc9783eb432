"""Small recordings of a colour and depth camera, written as files; used by several tests."""

import sqlite3

import numpy as np
from rosbags.typesys import Stores, get_typestore
from scipy.spatial.transform import Rotation

from courtside.devices.realsense import writer
from courtside.geometry.camera import Camera

AT_REST = np.eye(3, 4)
COLOUR = Camera(
    "colour",
    (48, 32),
    [[40, 0, 23.3], [0, 41, 15.1], [0, 0, 1]],
    [0.05, -0.02, 0.001, -0.001, 0.003],
    AT_REST,
)
DEPTH = Camera("depth", (32, 24), [[25, 0, 15.3], [0, 25, 11.1], [0, 0, 1]], np.zeros(5), AT_REST)
PLACED = np.column_stack(
    [Rotation.from_euler("xyz", [0.01, -0.02, 0.03]).as_matrix(), [0.0147, 0.0002, -0.0005]]
)
UNIT_M = 0.00025
BASELINE_M = 0.055
START_S = 12.0


def frames(n=6, start_s=START_S):
    """Return (time_s, BGR, depth) of frames that differ in every pixel."""
    rng = np.random.default_rng(5)
    width, height = COLOUR.size
    return [
        (
            start_s + k / 30,
            rng.integers(0, 256, (height, width, 3), dtype=np.uint8),
            rng.integers(0, 65536, DEPTH.size[::-1], dtype=np.uint16),
        )
        for k in range(n)
    ]


def write_bag(path, made=None):
    """Write the frames as a `.bag`."""
    device = writer.Device(baseline_m=BASELINE_M)
    made = frames() if made is None else made
    writer.write(path, COLOUR, DEPTH, PLACED, UNIT_M, made, device=device)
    return path


def lens_text(camera, model="Brown Conrady"):
    """Return a lens as the camera's program writes it into a `.db3`."""
    names = ("fx", "ppx", "fy", "ppy")
    values = (camera.K[0, 0], camera.K[0, 2], camera.K[1, 1], camera.K[1, 2])
    text = f"width={camera.size[0]};height={camera.size[1]};"
    text += "".join(f"{name}={value};" for name, value in zip(names, values, strict=True))
    return f"{text}model={model};coeffs=" + ",".join(map(str, camera.dist))


def place_text(placed):
    rotation = ",".join(f"{value:.6f}" for value in placed[:, :3].T.ravel())
    return f"rotation={rotation};translation=" + ",".join(f"{v:.6f}" for v in placed[:, 3])


def messages_of_db3(made, picture):
    """Yield (topic, type, time_ns, values) as version 2.59 of the camera's program records them."""
    depth, colour = "/device_0/sensor_0/Depth_0", "/device_0/sensor_1/Color_0"
    text = "std_msgs/msg/String"
    yield "/file_version", "std_msgs/msg/UInt32", 0, {"data": 4}
    yield f"{depth}/camera_info", text, 0, {"data": lens_text(DEPTH)}
    yield f"{colour}/camera_info", text, 0, {"data": lens_text(COLOUR)}
    units = "/device_0/sensor_0/option/Depth_Units/value"
    yield units, text, 0, {"data": f"{UNIT_M:.6f}"}
    yield f"{depth}/tf/ref_1", text, 0, {"data": place_text(AT_REST)}
    yield f"{colour}/tf/ref_1", text, 0, {"data": place_text(PLACED)}
    for k, (time_s, bgr, steps) in enumerate(made):
        time_ns = round((time_s - made[0][0]) * 1e9) + 1000
        for stream, image, encoding in ((depth, steps, "mono16"), (colour, bgr, "rgb8")):
            ending, kind, values = picture(image, encoding)
            yield f"{stream}/image/data{ending}", kind, time_ns, values
            about = f"Frame number={k + 7};timestamp_domain=Hardware Clock;timestamp={1e3 * time_s:.6f};"
            yield f"{stream}/image/metadata", text, time_ns, {"data": about}


def write_db3(path, messages):
    """Write messages as a ROS 2 recording: the three tables that such files have."""
    store = get_typestore(Stores.ROS2_HUMBLE)
    types = store.types
    stamp = types["builtin_interfaces/msg/Time"](sec=0, nanosec=0)
    header = types["std_msgs/msg/Header"](stamp=stamp, frame_id="")
    base = sqlite3.connect(path)
    base.executescript(
        "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
        "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);"
        "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, "
        "timestamp INTEGER NOT NULL, data BLOB NOT NULL);"
        "CREATE INDEX timestamp_idx ON messages (timestamp ASC);"
    )
    topics = {}
    for topic, kind, time_ns, values in messages:
        if topic not in topics:
            topics[topic] = len(topics) + 1
            base.execute(
                "INSERT INTO topics VALUES(?, ?, ?, 'cdr', '')", (topics[topic], topic, kind)
            )
        extra = {"header": header} if kind.startswith("sensor_msgs") else {}
        raw = bytes(store.serialize_cdr(types[kind](**extra, **values), kind))
        base.execute(
            "INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)",
            (topics[topic], time_ns, raw),
        )
    base.commit()
    base.close()
    return path
