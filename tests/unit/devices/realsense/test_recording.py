import logging
import re
import time

import cv2
import numpy as np
import pytest

from courtside.devices.realsense import recording as realsense
from courtside.study.errors import InputError
from fixtures.recordings.depth_recordings_made import (
    BASELINE_M,
    COLOUR,
    DEPTH,
    PLACED,
    UNIT_M,
    frames,
    messages_of_db3,
    write_bag,
    write_db3,
)
from fixtures.recordings.real_data import REAL, needs_real


def plain(image, encoding):
    """Return a picture as the camera's program records it without compression."""
    stored = image if image.ndim == 2 else image[..., ::-1]
    values = {
        "height": image.shape[0],
        "width": image.shape[1],
        "encoding": encoding,
        "is_bigendian": 0,
        "step": stored[0].nbytes,
        "data": np.ascontiguousarray(stored).view(np.uint8).ravel(),
    }
    return "", "sensor_msgs/msg/Image", values


def packed(image, encoding):
    """Return a picture as the camera's program records it with compression."""
    png = cv2.imencode(".png", image)[1].ravel()
    kind = "sensor_msgs/msg/CompressedImage"
    if encoding == "mono16":
        data = np.concatenate([np.zeros(12, np.uint8), png])
        return "/compressedDepth", kind, {"format": "16UC1; compressedDepth png", "data": data}
    return "/compressed", kind, {"format": "rgb8; png compressed bgr8", "data": png}


def check(recording, made):
    assert np.allclose(recording.colour_from_depth, PLACED, atol=2e-6)
    assert recording.depth_unit_m == UNIT_M
    for found, camera in ((recording.colour, COLOUR), (recording.depth, DEPTH)):
        assert np.array_equal(found.K, camera.K)
        assert np.array_equal(found.dist, camera.dist)
        assert found.size == camera.size
    colour, depth = list(recording.colour_frames()), list(recording.depth_frames())
    assert np.allclose([time_s for time_s, _ in colour], [row[0] for row in made], atol=1e-6)
    assert [time_s for time_s, _ in depth] == [time_s for time_s, _ in colour]
    for (_, image), (_, steps), (_, bgr, depth_made) in zip(colour, depth, made, strict=True):
        assert np.array_equal(image, bgr)
        assert np.array_equal(steps, depth_made)


@needs_real
def test_the_real_recording_has_its_streams_and_lenses():
    path = REAL / "realsense" / "single_depth_color_640x480.bag"
    found = realsense.read(path, "d435")
    assert found.depth.K[0, 0] == pytest.approx(390.43, abs=0.005)
    assert found.colour.K[0, 0] == pytest.approx(613.20, abs=0.005)
    assert np.linalg.norm(found.colour_from_depth[:, 3]) == pytest.approx(0.0143, abs=5e-5)
    assert found.depth_unit_m == 0.001
    assert found.baseline_m == pytest.approx(0.05017, abs=1e-5)
    assert found.remarks == ()
    ((time_s, image),) = found.colour_frames()
    assert image.shape == (480, 640, 3)
    assert time_s == pytest.approx(360.713523)
    times = [time_s for time_s, _ in found.depth_frames()]
    assert times == pytest.approx([360.815089, 360.981765])  # at 6 frames per second
    assert found.colour_index().number.tolist() == [162]


def test_a_bag_is_read_as_it_was_written(tmp_path):
    found = realsense.read(write_bag(tmp_path / "a.bag"))
    check(found, frames())
    assert found.baseline_m == pytest.approx(BASELINE_M)


@pytest.mark.parametrize("picture", [plain, packed])
def test_a_db3_is_read_as_it_was_written(tmp_path, picture):
    path = write_db3(tmp_path / "a.db3", messages_of_db3(frames(), picture))
    found = realsense.read(path)
    check(found, frames())
    assert np.isnan(found.baseline_m)
    assert found.colour_index().number.tolist() == [7, 8, 9, 10, 11, 12]


def test_lost_frames_are_gaps_in_the_numbers(tmp_path, caplog):
    made = [(t, None if k == 2 else bgr, steps) for k, (t, bgr, steps) in enumerate(frames())]
    found = realsense.read(write_bag(tmp_path / "a.bag", made), "cam")
    index = found.colour_index()
    assert np.diff(index.number).tolist() == [1, 2, 1, 1]
    assert np.allclose(index.time_s, [made[k][0] for k in (0, 1, 3, 4, 5)], atol=1e-8)
    assert len(list(found.depth_frames())) == 6
    with caplog.at_level(logging.INFO):
        assert len(list(found.colour_frames())) == 5
    assert "cam: Color_0: 5 frames, 1 missing" in caplog.text


def test_frames_out_of_order_are_left_out(tmp_path):
    made = frames()
    again = [*made[:3], made[1], *made[3:]]
    found = realsense.read(write_bag(tmp_path / "a.bag", again))
    assert len(found.colour_index().time_s) == 6


def stamped(path, times_s, picture=plain):
    """Write a db3 whose frames come one after the other, with these times on the camera's clock."""
    rows = []
    at = {"Depth_0": -1, "Color_0": -1}
    for topic, kind, time_ns, values in messages_of_db3(frames(len(times_s)), picture):
        for stream in at:
            if f"{stream}/image/metadata" in topic and "timestamp=" in values["data"]:
                at[stream] += 1
                own = f"timestamp={1000 * times_s[at[stream]]:.6f}"
                values = {"data": re.sub(r"timestamp=[0-9.]+", own, values["data"])}
        rows.append((topic, kind, time_ns, values))
    return write_db3(path, rows)


def test_a_stray_stamp_costs_one_frame(tmp_path, caplog):
    times_s = 12 + np.arange(40) / 30
    times_s[17] += 3600
    kept = np.delete(np.arange(40), 17)
    made = [(t, bgr, d) for t, (_, bgr, d) in zip(times_s, frames(40), strict=True)]
    for path in (stamped(tmp_path / "a.db3", times_s), write_bag(tmp_path / "a.bag", made)):
        caplog.clear()
        found = realsense.read(path, "cam")
        assert found.colour_index().time_s == pytest.approx(times_s[kept], abs=1e-6)
        assert "cam: Color_0: left out: 1 of 40 frames out of order, the first at 36" in caplog.text
        for (_, image), k in zip(found.colour_frames(), kept, strict=True):
            assert np.array_equal(image, made[k][1])


def test_a_clock_that_was_set_or_restarted_is_named(tmp_path):
    steps = np.arange(40) / 30
    reset = np.where(steps > 1, steps, steps + 500)
    found = realsense.read(stamped(tmp_path / "reset.db3", reset), "cam")
    with pytest.raises(InputError, match=r"Color_0: .* of 40 frames out of order.*was set"):
        found.colour_index()
    for name, stop_s in (("awhile", 0.7), ("on", 9)):
        ahead = steps + 3600.0 * (steps > 0.51) * (steps < stop_s)
        found = realsense.read(stamped(tmp_path / f"{name}.db3", ahead), "cam")
        with pytest.raises(InputError, match=r"Color_0: .* found it at 3600\.5.* none is missing"):
            found.colour_index()
    made = [(500 + t if t < 1 else t, bgr, d) for t, bgr, d in frames(40, start_s=0.0)]
    with pytest.raises(InputError, match=r"frames out of order.*was set"):
        realsense.read(write_bag(tmp_path / "a.bag", made), "cam").colour_index()


def changed_db3(path, change):
    """Write a db3 with messages changed by a function: (topic, values) -> values, None to omit."""
    rows = []
    for topic, kind, time_ns, values in messages_of_db3(frames(2), plain):
        values = change(topic, dict(values))
        if values is not None:
            rows.append((topic, kind, time_ns, values))
    return write_db3(path, rows)


def without(text):
    return lambda topic, values: None if text in topic else values


def replaced(text, data):
    return lambda topic, values: {"data": data} if topic.endswith(text) else values


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (without("Depth_0"), "stream of pictures named Depth"),
        (without("Color_0"), "stream of pictures named Color"),
        (without("camera_info"), "expected its lens"),
        (without("tf/ref"), "expected its place"),
        (replaced("Color_0/camera_info", "width=48;height=32"), "fx ppx fy"),
        (replaced("Color_0/camera_info", "hello"), "expected its lens"),
        (replaced("Color_0/tf/ref_1", "rotation=1,2,3;translation=0,0,0"), "expected its place"),
        (
            replaced("Color_0/tf/ref_1", "rotation=2,0,0,0,2,0,0,0,2;translation=0,0,0"),
            "expected its place",
        ),
        (replaced("Depth_Units/value", "7"), "depth unit"),
    ],
)
def test_what_is_missing_is_named_in_one_line(tmp_path, change, says):
    path = changed_db3(tmp_path / "a.db3", change)
    with pytest.raises(InputError, match=says) as raised:
        realsense.read(path)
    assert str(path) in str(raised.value)
    assert "\n" not in str(raised.value)


def test_the_default_depth_unit_is_remarked(tmp_path):
    found = realsense.read(changed_db3(tmp_path / "a.db3", without("Depth_Units")))
    assert found.depth_unit_m == 0.001
    assert "0.001 m assumed" in found.remarks[0]


def test_streams_of_different_clocks_take_the_recording_s(tmp_path):
    def change(topic, values):
        if "Depth_0/image/metadata" in topic:
            values["data"] = values["data"].replace("Hardware Clock", "System Time")
        return values

    found = realsense.read(changed_db3(tmp_path / "a.db3", change))
    assert "different clocks" in found.remarks[0]
    assert found.colour_index().time_s == pytest.approx([1e-6, 1e-6 + 1 / 30])


def test_a_picture_of_another_size_or_kind_names_its_frame(tmp_path):
    def narrow(topic, values):
        return (
            plain(np.zeros((32, 46, 3), np.uint8), "rgb8")[2]
            if "Color_0/image/data" in topic
            else values
        )

    def strange(topic, values):
        return values | {"encoding": "bayer_rggb8"} if "Color_0/image/data" in topic else values

    for name, change, says in (("a", narrow, "48x32 px"), ("b", strange, "bayer_rggb8")):
        found = realsense.read(changed_db3(tmp_path / f"{name}.db3", change))
        with pytest.raises(InputError, match=says) as raised:
            list(found.colour_frames())
        assert "Color_0 7" in str(raised.value)


def read_all(path):
    try:
        found = realsense.read(path)
        return len(list(found.colour_frames())) + len(list(found.depth_frames()))
    except InputError as error:
        assert "\n" not in str(error)
        return -1


def mutate(rng, content):
    content = bytearray(content)
    way = rng.integers(0, 4)
    if way == 0:
        return bytes(content[: rng.integers(0, len(content))])
    at = int(rng.integers(0, len(content)))
    if way == 1:
        for place in rng.integers(0, len(content), 8):
            content[place] = rng.integers(0, 256)
    elif way == 2:
        content[at : at + 4] = bytes(rng.choice([0, 255], 4).astype(np.uint8))
    else:
        del content[at : at + int(rng.integers(1, 200))]
    return bytes(content)


def mutations(tmp_path, count):
    sources = [write_bag(tmp_path / "a.bag"), tmp_path / "a.db3"]
    write_db3(sources[1], messages_of_db3(frames(2), packed))
    rng, longest, refused = np.random.default_rng(11), 0.0, 0
    for k in range(count):
        source = sources[k % 2]
        path = tmp_path / f"mutated{source.suffix}"
        path.write_bytes(mutate(rng, source.read_bytes()))
        start = time.perf_counter()
        refused += read_all(path) < 0
        longest = max(longest, time.perf_counter() - start)
    return refused, longest


def test_damaged_files_give_a_value_or_one_line(tmp_path):
    refused, longest = mutations(tmp_path, 120)
    assert refused > 40
    assert longest < 5


@pytest.mark.fuzz
def test_many_damaged_files_give_a_value_or_one_line(tmp_path):
    _, longest = mutations(tmp_path, 5000)
    assert longest < 5
