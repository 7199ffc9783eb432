import numpy as np
import pytest
from rosbags.highlevel import AnyReader
from rosbags.rosbag1 import Reader

from courtside.devices.realsense import recording
from courtside.geometry.camera import Camera
from fixtures.recordings import aligned_depth
from fixtures.recordings.depth_recordings_made import (
    BASELINE_M,
    COLOUR,
    DEPTH,
    PLACED,
    UNIT_M,
    frames,
    write_bag,
)
from fixtures.recordings.real_data import REAL, needs_real
from virtualgym.devices import realsense_writer

IMAGES = ("/device_0/sensor_0/Depth_0/image/data", "/device_0/sensor_1/Color_0/image/data")


@pytest.fixture(scope="module")
def bag(tmp_path_factory):
    return write_bag(tmp_path_factory.mktemp("bag_writer") / "a.bag")


@pytest.fixture
def sdk():
    return pytest.importorskip("pyrealsense2", reason="the camera's software is not installed")


def test_rosbags_reads_what_was_written(bag):
    with AnyReader([bag]) as reader:
        wanted = [c for c in reader.connections if c.topic in IMAGES]
        found = {topic: [] for topic in IMAGES}
        for connection, _, raw in reader.messages(connections=wanted):
            found[connection.topic].append(reader.deserialize(raw, connection.msgtype))
    for k, (time_s, bgr, depth) in enumerate(frames()):
        stored, colour = (found[topic][k] for topic in IMAGES)
        assert colour.data.reshape(bgr.shape)[..., ::-1].tobytes() == bgr.tobytes()
        assert stored.data.view("<u2").reshape(depth.shape).tobytes() == depth.tobytes()
        assert colour.header.stamp.sec + 1e-9 * colour.header.stamp.nanosec == pytest.approx(time_s)
        assert (colour.encoding, stored.encoding) == ("rgb8", "mono16")


@needs_real
def test_topics_and_types_are_those_of_a_real_recording(bag):
    real = REAL / "realsense" / "single_depth_color_640x480.bag"
    with Reader(bag) as made, Reader(real) as reference:
        known = {c.topic: (c.msgtype, c.digest) for c in reference.connections}
        for connection in made.connections:
            assert known[connection.topic] == (connection.msgtype, connection.digest)
        assert {c.topic for c in made.connections} > {
            t for t in known if "option" not in t and "info" in t
        }


def test_reading_back_gives_the_same(bag):
    found = recording.read(bag)
    assert np.abs(found.colour_from_depth - PLACED).max() < 1e-12
    assert found.baseline_m == pytest.approx(BASELINE_M)


@pytest.mark.parametrize(
    ("made", "message"),
    [
        ([], "expected at least one frame"),
        (
            [(0.0, frames()[0][1][:-1], frames()[0][2])],
            f"expected pictures .* found .{len(frames()[0][1]) - 1}, ",
        ),
        ([(0.0, frames()[0][1].astype(float), frames()[0][2])], "expected .* found .* float64"),
        ([(0.0, frames()[0][1], frames()[0][2].astype(np.int32))], "expected .* found .* int32"),
    ],
    ids=["none", "size", "colour", "depth"],
)
def test_what_is_no_frame_is_refused(tmp_path, made, message):
    with pytest.raises(ValueError, match=message):
        write_bag(tmp_path / "a.bag", made)
    assert list(tmp_path.iterdir()) == []


def played(rs, path):
    """Return (pictures of depth, of colour, aligned depth) as the camera's software plays them."""
    settings, pipeline, found = rs.config(), rs.pipeline(), []
    settings.enable_device_from_file(str(path), repeat_playback=False)
    pipeline.start(settings).get_device().as_playback().set_real_time(False)
    align = rs.align(rs.stream.color)
    try:
        while True:
            several = pipeline.wait_for_frames(2000)
            pair = (several.get_depth_frame(), several.get_color_frame())
            number = pair[0].get_frame_number()
            pictures = [np.asanyarray(frame.get_data()).copy() for frame in pair]
            aligned = np.asanyarray(align.process(several).get_depth_frame().get_data()).copy()
            found.append((number, *pictures, aligned))
    except RuntimeError:  # the end of the file
        pipeline.stop()
    return found


def test_the_camera_s_own_software_reads_it(sdk, bag):
    device = sdk.context().load_device(str(bag))
    streams = {p.stream_name(): p for s in device.query_sensors() for p in s.get_stream_profiles()}
    for name, camera in (("Color", COLOUR), ("Depth", DEPTH)):
        lens = streams[name].as_video_stream_profile().get_intrinsics()
        assert (lens.width, lens.height) == camera.size
        assert np.allclose([lens.fx, lens.fy], np.diag(camera.K)[:2])
        assert np.allclose([lens.ppx, lens.ppy], camera.K[:2, 2])
        assert np.allclose(lens.coeffs, camera.dist)
    placed = streams["Depth"].get_extrinsics_to(streams["Color"])
    assert np.allclose(np.reshape(placed.rotation, (3, 3)).T, PLACED[:, :3], atol=1e-6)
    assert np.allclose(placed.translation, PLACED[:, 3])
    assert device.query_sensors()[0].as_depth_sensor().get_depth_scale() == pytest.approx(UNIT_M)
    found = played(sdk, bag)
    assert len(found) >= 3
    for number, depth, colour, _ in found:
        _, bgr, depth_made = frames()[number - 1]
        assert np.array_equal(depth, depth_made)
        assert np.array_equal(colour[..., ::-1], bgr)


def test_the_camera_s_own_software_converts_it(sdk, bag, tmp_path):
    path = tmp_path / "a.db3"
    sdk.context().convert_bag_to_db3(str(bag), str(path))
    found = recording.read(path)
    assert np.allclose(found.colour_from_depth, PLACED, atol=2e-6)
    assert found.depth_unit_m == UNIT_M
    for (_, image), (_, steps), (_, bgr, depth) in zip(
        found.colour_frames(), found.depth_frames(), frames(), strict=True
    ):
        assert np.array_equal(image, bgr)
        assert np.array_equal(steps, depth)


def test_the_camera_s_own_software_aligns_alike(sdk, tmp_path):
    """Its aligned depth keeps the depth camera's z: here both cameras look the same way."""
    rest, size = np.eye(3, 4), (320, 240)
    depth = Camera("d", size, [[200, 0, 159.2], [0, 200, 119.7], [0, 0, 1]], np.zeros(5), rest)
    colour = Camera("c", size, [[310, 0, 160.8], [0, 310, 120.4], [0, 0, 1]], np.zeros(5), rest)
    apart = np.column_stack([np.eye(3), [0.015, 0, 0]])
    x, y = np.meshgrid(np.arange(320), np.arange(240))
    steps = (2500 + 2 * x + y).astype(np.uint16)
    steps[60:160, 120:200] = 1200  # something in front
    steps[200:210, 50:60] = 0
    black = np.zeros((240, 320, 3), np.uint8)
    made = [(k / 30, black, steps) for k in range(3)]
    path = tmp_path / "a.bag"
    realsense_writer.write(path, colour, depth, apart, 0.001, made)
    theirs = played(sdk, path)[0][3]
    ours = aligned_depth.align(steps * 0.001, depth, colour, apart)
    both = (theirs > 0) & np.isfinite(ours)
    # They let a depth pixel cover whole pixels at its rim, we those whose centre it covers.
    assert both.sum() > 0.97 * np.isfinite(ours).sum()
    off = np.abs(theirs[both] * 0.001 - ours[both])
    assert np.median(off) < 0.003
    assert (off < 0.01).mean() > 0.97
