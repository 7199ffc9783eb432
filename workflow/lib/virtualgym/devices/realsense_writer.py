"""Write recordings in the ROS 1 format of RealSense cameras' program: file version 3, `.bag`."""

import itertools
import math
from collections.abc import Iterable, Mapping
from typing import Any

import lz4.frame  # comes with rosbags
import numpy as np
from numpy.typing import NDArray
from rosbags.rosbag1 import Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from scipy.spatial.transform import Rotation

from courtside.geometry.camera import Camera
from courtside.study.errors import StrPath
from courtside.study.execution.files import atomic

STATIC_NS = 1  # time in the recording of everything constant
STREAM_INFO = "uint32 fps\nstring encoding\nbool is_recommended\n"
Frame = tuple[float, NDArray | None, NDArray | None]  # time_s, colour, depth
CLOCK = "Hardware Clock"
LENS = "Brown Conrady"
# The camera's program reads this LZ4 only: independent blocks of 1 MiB and a checksum.
PACKING = {
    "block_size": lz4.frame.BLOCKSIZE_MAX1MB,
    "block_linked": False,
    "content_checksum": True,
    "store_size": False,
}
DEPTH, COLOUR = "/device_0/sensor_0/Depth_0", "/device_0/sensor_1/Color_0"

MODEL, SERIAL = "Intel RealSense D415", "000000000000"  # as a camera names itself


def write(
    path: StrPath,
    colour: Camera,
    depth: Camera,
    colour_from_depth: NDArray,
    depth_unit_m: float,
    frames: Iterable[Frame],
    *,
    baseline_m: float = math.nan,
    rate_hz: int = 30,
) -> int:
    """Write colour and depth as a recording that `courtside` and the camera's own program read.

    The file appears under its name only when whole. `colour_from_depth` (3, 4) is in metres,
    `depth_unit_m` the metres of one step of depth. Frames are the time on the camera's clock in
    seconds, not before 0; colour (H, W, 3) as BGR; depth (h, w), 0 where there is none. None is a
    lost frame: its number is missing. `baseline_m` is between the imagers that depth comes from,
    not written if NaN; `rate_hz` is nominal. Return the number of frames.

    Raises
    ------
    ValueError
        If there is no frame, or a picture has not its camera's size and type.

    Notes
    -----
    Pictures are compressed (LZ4) without loss. One is in memory at a time.
    """
    frames = iter(frames)
    first = next(frames, None)
    if first is None:
        raise ValueError(f"{path}: expected at least one frame, found none")
    with atomic(path) as temporary:
        writer = Writer(temporary)
        writer.set_compression(Writer.CompressionFormat.LZ4)
        writer.compressor = lambda chunk: lz4.frame.compress(chunk, **PACKING)
        with writer:
            messages = _Messages(writer)
            _describe(messages, baseline_m, depth_unit_m)
            _stream(messages, DEPTH, depth, "mono16", rate_hz, np.eye(3, 4))
            _stream(messages, COLOUR, colour, "rgb8", rate_hz, colour_from_depth)
            count = 0
            for count, frame in enumerate(itertools.chain([first], frames), start=1):
                _frame(messages, count, frame, (colour, depth), first[0])
    return count


class _Messages:
    """Writes messages of any type to any topic."""

    def __init__(self, writer: Writer) -> None:
        self.writer = writer
        self.connections: dict[str, Any] = {}
        self.store = get_typestore(Stores.ROS1_NOETIC)
        self.store.register(get_types_from_msg(STREAM_INFO, "realsense_msgs/msg/StreamInfo"))

    def make(self, kind: str, **values: Any) -> Any:
        return self.store.types[kind](**values)

    def put(self, topic: str, kind: str, time_ns: int = STATIC_NS, **values: Any) -> None:
        if topic not in self.connections:
            self.connections[topic] = self.writer.add_connection(topic, kind, typestore=self.store)
        raw = self.store.serialize_ros1(self.make(kind, **values), kind)
        self.writer.write(self.connections[topic], time_ns, raw)

    def put_pairs(self, topic: str, pairs: Mapping[str, object], time_ns: int = STATIC_NS) -> None:
        for key, value in pairs.items():
            self.put(topic, "diagnostic_msgs/msg/KeyValue", time_ns, key=key, value=str(value))

    def header(self, number: int = 0, time_s: float = 0.0, frame: str = "") -> Any:
        seconds, nanoseconds = divmod(round(time_s * 1e9), 10**9)
        stamp = self.make("builtin_interfaces/msg/Time", sec=seconds, nanosec=nanoseconds)
        return self.make("std_msgs/msg/Header", seq=number, stamp=stamp, frame_id=frame)


def _describe(messages: _Messages, baseline_m: float, depth_unit_m: float) -> None:
    messages.put("/file_version", "std_msgs/msg/UInt32", data=3)
    messages.put_pairs("/device_0/info", {"Name": MODEL, "Serial Number": SERIAL})
    messages.put_pairs("/device_0/sensor_0/info", {"Name": "Stereo Module"})
    messages.put_pairs("/device_0/sensor_1/info", {"Name": "RGB Camera"})
    options = {"Depth Units": (depth_unit_m, "Number of meters represented by a single depth unit")}
    if np.isfinite(baseline_m):
        baseline_mm = 1000 * baseline_m
        options["Stereo Baseline"] = (baseline_mm, "Distance in mm between the stereo imagers")
    for name, (value, description) in options.items():
        topic = f"/device_0/sensor_0/option/{name}"
        messages.put(f"{topic}/value", "std_msgs/msg/Float32", data=float(value))
        messages.put(f"{topic}/description", "std_msgs/msg/String", data=description)


def _stream(
    messages: _Messages,
    stream: str,
    camera: Camera,
    encoding: str,
    rate_hz: int,
    from_depth: NDArray,
) -> None:
    messages.put(
        f"{stream}/info",
        "realsense_msgs/msg/StreamInfo",
        fps=rate_hz,
        encoding=encoding,
        is_recommended=False,
    )
    region = messages.make(
        "sensor_msgs/msg/RegionOfInterest",
        x_offset=0,
        y_offset=0,
        height=0,
        width=0,
        do_rectify=False,
    )
    messages.put(
        f"{stream}/info/camera_info",
        "sensor_msgs/msg/CameraInfo",
        header=messages.header(),
        height=camera.size[1],
        width=camera.size[0],
        distortion_model=LENS,
        D=np.array(camera.dist),
        K=camera.K.ravel(),
        R=np.zeros(9),
        P=np.zeros(12),
        binning_x=0,
        binning_y=0,
        roi=region,
    )
    _place(messages, stream, from_depth)


def _place(messages: _Messages, stream: str, from_depth: NDArray) -> None:
    turn = Rotation.from_matrix(from_depth[:, :3]).as_quat()
    messages.put(
        f"{stream}/tf/0",
        "geometry_msgs/msg/Transform",
        translation=messages.make(
            "geometry_msgs/msg/Vector3",
            **dict(zip("xyz", map(float, from_depth[:, 3]), strict=True)),
        ),
        rotation=messages.make(
            "geometry_msgs/msg/Quaternion", **dict(zip("xyzw", map(float, turn), strict=True))
        ),
    )


def _frame(
    messages: _Messages, number: int, frame: Frame, cameras: tuple[Camera, Camera], start_s: float
) -> None:
    time_s, bgr, depth = frame
    colour_camera, depth_camera = cameras
    time_ns = STATIC_NS + 1 + max(round((time_s - start_s) * 1e9), 0)
    if depth is not None:
        _check(depth, (*depth_camera.size[::-1],), np.uint16)
        stored = np.ascontiguousarray(depth, dtype="<u2").view(np.uint8)
        _picture(messages, DEPTH, (number, time_s, time_ns), stored, depth.shape, "mono16")
    if bgr is not None:
        _check(bgr, (*colour_camera.size[::-1], 3), np.uint8)
        stored = np.ascontiguousarray(bgr[..., ::-1])
        _picture(messages, COLOUR, (number, time_s, time_ns), stored, bgr.shape, "rgb8")


def _check(picture: NDArray, shape: tuple[int, ...], kind: type) -> None:
    if picture.shape != shape or picture.dtype != kind:
        raise ValueError(
            f"expected pictures {shape} {np.dtype(kind)}, found {picture.shape} {picture.dtype}"
        )


def _picture(
    messages: _Messages,
    stream: str,
    when: tuple[int, float, int],
    stored: NDArray,
    shape: tuple[int, ...],
    encoding: str,
) -> None:
    number, time_s, time_ns = when
    messages.put(
        f"{stream}/image/data",
        "sensor_msgs/msg/Image",
        time_ns,
        header=messages.header(number, time_s, "0"),
        height=shape[0],
        width=shape[1],
        encoding=encoding,
        is_bigendian=0,
        step=stored.size // shape[0],
        data=stored.ravel(),
    )
    about = {
        "system_time": f"{1e3 * time_s:.6f}",
        "timestamp_domain": CLOCK,
        "Frame Counter": number,
        "Frame Timestamp": round(1e6 * time_s),
    }
    messages.put_pairs(f"{stream}/image/metadata", about, time_ns)
