"""Steadied keypoints: OpenCV's projection of a known camera rotation is undone."""

import logging
import tracemalloc
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation

from courtside.geometry import camera as cameras
from courtside.geometry.camera import Camera
from courtside.reconstruction import camera_shake
from courtside.reconstruction.association import associate
from courtside.records.cameras.footage import Footage
from courtside.records.devices.clocks import Clock
from courtside.records.keypoints import missing_reason
from courtside.records.keypoints.keypoints import Keypoints2D
from courtside.study.errors import InputError
from courtside.synchronisation import cameras as camera_sync
from fixtures.cameras import scene, shaken, sync_takes
from fixtures.people import keypoints_made, stick_figures, walker

SIZE = np.array([1920, 1080])
K = np.array([[1450.0, 0, 985.0], [0, 1440.0, 515.0], [0, 0, 1]])
DIST = np.array([-0.12, 0.03, 1e-3, -2e-3, 0.004])
POSE = np.column_stack([Rotation.from_rotvec([1.2, 0.3, -0.2]).as_matrix(), [0.4, 1.0, 9.0]])
CAMERA = Camera("mirror", SIZE, K, DIST, POSE)
CENTRE = (SIZE - 1) / 2
RATE_HZ = 30.0


def turns(n, seed=0):
    """Return turns of some ten pixels about any axis, (n, 3) radians."""
    return np.random.default_rng(seed).normal(0, 0.006, (n, 3))


def projected(xyz_in_cam):
    """Project points (N, 3) in the camera's axes by OpenCV."""
    return shaken.projected(CAMERA, xyz_in_cam)


def shake(vectors):
    """Return the table of a perfect measurement of rotations, at the picture's centre."""
    return shaken.table(CAMERA, vectors, np.arange(len(vectors)) / RATE_HZ)


def view(vectors, seed=1, joints=12):
    """Return keypoints of points about a court in the shaken and in the still picture."""
    rng = np.random.default_rng(seed)
    shape = 2, len(vectors), joints
    xyz = rng.uniform([-5, -2.5, 5], [5, 2.5, 14], (*shape, 3))
    xyz[..., :2] *= xyz[..., 2:] / 14
    rotation = Rotation.from_rotvec(vectors).as_matrix()
    still = projected(xyz.reshape(-1, 3)).reshape(*shape, 2)
    turned = np.einsum("tij,ptkj->ptki", rotation, xyz)
    names, time_s = [f"j{at}" for at in range(joints)], np.arange(len(vectors)) / RATE_HZ
    xy = projected(turned.reshape(-1, 3)).reshape(*shape, 2)
    return keypoints_made.view(CAMERA, names, time_s, xy, xyz_in_body=turned), still, xyz


def without(table, frames):
    table.loc[frames, ["shift_x_px", "shift_y_px", "rotation_deg", "zoom_percent", "sigma_px"]] = (
        np.nan
    )
    return table


def test_the_turn_is_found_from_what_the_centre_does():
    vectors = turns(200)
    found = camera_shake.camera_turns(CAMERA, without(shake(vectors), [7]))
    assert np.isnan(found[7]).all()
    known = np.arange(200) != 7
    assert np.abs(found - vectors)[known].max() * K[0, 0] < 0.01


def test_keypoints_return_to_the_still_picture():
    vectors = turns(40)
    made, still, xyz = view(vectors)
    assert np.abs(made.xy - still).max() > 10
    made.xy[0, 3, 4], made.score[0, 3, 4], made.reason[0, 3, 4] = (
        np.nan,
        np.nan,
        missing_reason.UNSEEN,
    )
    found = camera_shake.steady(made, CAMERA, shake(vectors))
    assert np.isnan(found.xy[0, 3, 4]).all()
    assert np.nanmax(np.abs(found.xy - still)) < 0.02
    np.testing.assert_allclose(found.xyz_in_body, xyz, atol=1e-4)
    np.testing.assert_array_equal(found.reason, made.reason)
    np.testing.assert_array_equal(found.score, made.score)


KNOCK_PX = 14.0


def test_synchronisation_gets_the_clock_of_the_still_cameras():
    rng = np.random.default_rng(0)
    cameras, clocks = sync_takes.rig(3), [Clock(), Clock(2.31, -120.0), Clock(-3.07, 90.0)]
    people, own_s = [sync_takes.athlete(rng, 15.0)], np.arange(450) / 30
    still, moved, steadied = [], [], []
    for seed, (camera, clock) in enumerate(zip(cameras, clocks, strict=True)):
        still.append(sync_takes.seen(rng, camera, people, own_s, clock))
        vectors = shaken.knock(camera, 450, 200, KNOCK_PX, tremor_px=2, seed=seed)
        moved.append(shaken.view(still[-1], camera, vectors))
        table = shaken.table(camera, vectors, own_s)
        steadied.append(camera_shake.steady(moved[-1], camera, table))
    found = [camera_sync.synchronise(views, cameras) for views in (still, moved, steadied)]
    of = {
        name: [clock[name].from_reference(np.array([0, 15])) for clock in found]
        for name in ("c1", "c2")
    }
    for exact, shaky, steady in of.values():
        assert np.abs(steady - exact).max() < 1e-5
        assert np.abs(shaky - exact).max() > 2e-4


def test_association_gets_the_people_of_the_still_cameras():
    rng = np.random.default_rng(1000)
    time_s = np.arange(120) / 30
    places = np.stack([np.linspace(-2, 2, 120), np.zeros(120)], axis=1)
    people = np.stack([stick_figures.body(way, time_s) for way in (places, -places + [0.0, 0.6])])
    cameras = scene.ring(3, radius_m=20)
    xy, _ = stick_figures.seen(cameras, people, rng)
    found = []
    for shift_px in (0.0, 60.0):
        views = []
        for camera, seen in zip(cameras, xy, strict=True):
            vectors = shaken.knock(camera, 120, 40, shift_px, tremor_px=shift_px / 10)
            still = keypoints_made.view(camera, stick_figures.NAMES, time_s, seen)
            table = shaken.table(camera, vectors, time_s)
            moved = shaken.view(still, camera, vectors)
            views.append((moved, camera_shake.steady(moved, camera, table)))
        found += [
            associate.associate(
                cameras, [view[which].xy for view in views], time_s, trunk=stick_figures.TRUNK
            )
            for which in (0, 1)
        ]
    still, _, moved, steadied = found
    np.testing.assert_array_equal(np.array(steadied.index), np.array(still.index))
    np.testing.assert_allclose(steadied.path, still.path, atol=1e-4)
    assert (np.array(moved.index) != np.array(still.index)).any()


def test_skeletons_reproject_onto_the_persons_in_the_shaken_pictures():
    cameras, record = scene.ring(2, dist=(-0.1, 0.02, 1e-3, 0, 0)), walker.points(12, n_cameras=2)
    record = replace(record, xyz=walker.body(12)[None])
    views = walker.views(record, cameras)
    vectors = shaken.knock(cameras[1], 12, 6, KNOCK_PX, tremor_px=2)
    moved = shaken.view(views[1], cameras[1], vectors)
    seen = [
        Footage(camera, view, Clock(), "")
        for camera, view in zip(cameras, [views[0], moved], strict=True)
    ]
    table = shaken.table(cameras[1], vectors, moved.time_s)
    found = camera_shake.put_back(seen, {cameras[1].name: table})
    assert found[0] is seen[0]
    for frame in range(12):
        drawn = found[1].reprojected(record, frame)
        assert np.abs(drawn - moved.xy[:, frame]).max() < 0.05
    assert np.abs(seen[1].reprojected(record, 9) - moved.xy[:, 9]).max() > 10


def test_an_unknown_turn_is_put_back_as_it_was_taken_out():
    vectors = turns(40)
    made, *_ = view(vectors)
    table = without(shake(vectors), [0, *range(10, 14), *range(20, 32)])
    found = camera_shake.frame_turns(CAMERA, table, made.time_s)
    known = np.isfinite(table.shift_x_px)
    np.testing.assert_allclose(found[known], vectors[known], atol=1e-5)
    taken_out = cameras.turned_back(CAMERA, made.xy, found)
    np.testing.assert_allclose(camera_shake.steady(made, CAMERA, table).xy, taken_out, atol=1e-9)


@pytest.mark.parametrize("hidden", [range(60, 90), range(20), range(100, 120)])
def test_a_knock_does_not_come_back_while_the_background_is_hidden(hidden, caplog):
    """The pose on either side of the gap, or of its one side, is known."""
    vectors = np.outer(np.where(np.arange(120) < 40, 0.2, 1.0), [0.01, -0.01, 0.005])
    made, still, _ = view(vectors)
    assert np.abs(made.xy - still)[:, hidden].max() > 2
    with caplog.at_level(logging.WARNING, logger="courtside"):
        found = camera_shake.steady(made, CAMERA, without(shake(vectors), hidden))
    assert np.abs(found.xy - still).max() < 0.02
    assert f"{len(hidden)} of 120" in caplog.text and "tremor" in caplog.text


def test_a_camera_that_stands_still_changes_nothing():
    made, still, _ = view(np.zeros((5, 3)))
    found = camera_shake.steady(made, CAMERA, shake(np.zeros((5, 3))))
    np.testing.assert_allclose(found.xy, still, atol=1e-6)


def test_gaps_are_bridged_and_long_ones_said(caplog):
    vectors = np.linspace([0, 0, 0], [0.01, -0.01, 0.005], 40)  # an even turn, which a line bridges
    made, still, _ = view(vectors)
    table = without(shake(vectors), [0, *range(10, 14), *range(20, 32)])
    with caplog.at_level(logging.WARNING, logger="courtside"):
        found = camera_shake.steady(made, CAMERA, table)
    assert np.abs(found.xy - still)[:, 1:].max() < 0.02
    assert "mirror" in caplog.text and "13 of 40" in caplog.text


def test_a_take_of_which_nothing_is_known_is_left():
    made, _, _ = view(turns(6))
    found = camera_shake.steady(made, CAMERA, without(shake(turns(6)), range(6)))
    np.testing.assert_array_equal(found.xy, made.xy)


def test_a_part_of_the_take_finds_its_rows_by_time():
    vectors = turns(30)
    made, still, _ = view(vectors)
    part = {name: getattr(made, name) for name in vars(made)}
    fields = ("xy", "score", "reason", "xyz_in_body", "clothing")
    part |= {name: part[name][:, 10:20] for name in fields}
    found = camera_shake.steady(
        Keypoints2D(**part | {"time_s": made.time_s[10:20] + 1e-5}), CAMERA, shake(vectors)
    )
    assert np.abs(found.xy - still[:, 10:20]).max() < 0.02


def test_frames_that_were_not_measured_are_a_fault():
    made, _, _ = view(turns(30))
    with pytest.raises(
        InputError, match=r"camera mirror: expected the shake of every frame"
    ) as error:
        camera_shake.steady(made, CAMERA, shake(turns(20)))
    assert "\n" not in str(error.value)


def test_another_size_is_a_fault():
    made, _, _ = view(turns(3))
    small = Camera("mirror", SIZE // 2, K, DIST, POSE)
    with pytest.raises(InputError, match="camera mirror"):
        camera_shake.steady(made, small, shake(turns(3)))


FOCAL = 1680.0
CAMERA_KNOCKS = Camera(
    "mirror",
    (1920, 1080),
    np.array([[FOCAL, 0, 959.5], [0, FOCAL, 539.5], [0, 0, 1]]),
    np.zeros(5),
    np.column_stack([np.eye(3), [0.0, 0.0, 4.0]]),
)
PLAYER = np.array([0.5, -0.2, 6.0])  # ten metres before it
NOISE_PX = 0.03


def table(n=240, rate_hz=30.0, tremor_px=0.0, seed=0):
    """Return a trembling camera's shake: seven waves per axis of 0.5 to 8 Hz, slow ones large."""
    rng = np.random.default_rng(seed)
    time_s = np.arange(n) / rate_hz
    hz = np.exp(rng.uniform(*np.log([0.5, 8.0]), (2, 7, 1)))
    waves = np.sin(2 * np.pi * (hz * time_s + rng.uniform(0, 1, hz.shape))) / np.sqrt(hz)
    waves *= np.sqrt(2 / (1 / hz).sum(axis=1, keepdims=True))
    shift = tremor_px * waves.sum(axis=1).T + rng.normal(0, NOISE_PX, (n, 2))
    return pd.DataFrame(
        {
            "frame_idx": np.arange(n),
            "time_s": time_s,
            "shift_x_px": shift[:, 0],
            "shift_y_px": shift[:, 1],
            "rotation_deg": rng.normal(0, 0.001, n),
            "zoom_percent": 0.0,
            "n_matches": 150,
            "sigma_px": NOISE_PX,
        }
    )


def knocked(table, frame, x_px=0.0, y_px=0.0, turn_deg=0.0):
    names = ["shift_x_px", "shift_y_px", "rotation_deg"]
    table.loc[table.index >= frame, names] += [x_px, y_px, turn_deg]
    return table


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize(("tremor_px", "size_px"), [(0.05, 1.5), (0.5, 6.0), (2.0, 16.0)])
def test_a_knock_is_found_within_a_frame(tremor_px, size_px, seed):
    shake = knocked(table(tremor_px=tremor_px, seed=seed), 121, 0.6 * size_px, -0.8 * size_px)
    (found,) = camera_shake.find(CAMERA_KNOCKS, shake)
    assert abs(found.time_s - 121 / 30) < 1.5 / 30
    np.testing.assert_allclose(
        found.shift_px, [0.6 * size_px, -0.8 * size_px], atol=0.1 + 1.5 * tremor_px
    )
    assert found.turn_deg == pytest.approx(
        np.degrees(size_px / FOCAL), abs=0.005 + np.degrees(1.5 * tremor_px / FOCAL)
    )


@pytest.mark.parametrize("n", [60, 120, 600])
def test_tremor_is_no_knock(n):
    found = [
        camera_shake.find(CAMERA_KNOCKS, table(n, tremor_px=px, seed=seed))
        for px in (0.0, 0.3, 2.0)
        for seed in range(10)
    ]
    assert sum(map(len, found)) == 0


def test_a_slow_drift_and_a_short_jerk_are_no_knocks():
    drifting = table()
    drifting["shift_y_px"] += 1.5 * drifting.time_s
    jerked = table()
    jerked.loc[100:108, "shift_x_px"] += 20.0
    assert (
        camera_shake.find(CAMERA_KNOCKS, drifting) == camera_shake.find(CAMERA_KNOCKS, jerked) == []
    )


def test_each_of_several_knocks_is_found_also_one_about_the_axis():
    shake = knocked(knocked(knocked(table(600), 150, 9.0), 300, -4.0, 3.0), 450, turn_deg=0.3)
    found = camera_shake.find(CAMERA_KNOCKS, shake)
    assert [round(knock.time_s * 30) for knock in found] == [150, 300, 450]
    assert found[2].turn_deg == pytest.approx(0.3, abs=0.01)
    assert np.hypot(*found[1].shift_px) == pytest.approx(5.0, abs=0.1)


def test_unknown_frames_hide_no_knock_and_make_none():
    shake = knocked(table(), 120, 8.0)
    names = ["shift_x_px", "shift_y_px", "rotation_deg", "zoom_percent", "sigma_px"]
    shake.loc[[*range(30, 50), *range(115, 120)], names] = np.nan
    (found,) = camera_shake.find(CAMERA_KNOCKS, shake)
    assert round(found.time_s * 30) == 120
    shake[names] = np.nan
    assert camera_shake.find(CAMERA_KNOCKS, shake) == []
    assert np.isnan(camera_shake.tremor_px(shake, []))
    (line,) = camera_shake.say(CAMERA_KNOCKS, shake, PLAYER)
    assert "no frame shows enough background" in line


def test_very_short_takes_have_no_knocks():
    for n in (1, 2, 5):
        assert camera_shake.find(CAMERA_KNOCKS, table(n)) == []


def test_tremor_does_not_count_knocks():
    shake = knocked(table(600, tremor_px=0.5), 300, 10.0)
    assert camera_shake.tremor_px(shake, camera_shake.find(CAMERA_KNOCKS, shake)) == pytest.approx(
        0.5, rel=0.1
    )
    assert camera_shake.tremor_px(shake, []) > 2


def test_millimetres_at_the_player_are_pixels_times_depth_over_focal_length():
    shake = table(3).assign(shift_x_px=[3.0, 0.0, np.nan], shift_y_px=[4.0, 0.0, np.nan])
    np.testing.assert_allclose(
        camera_shake.mm_at(CAMERA_KNOCKS, PLAYER, shake), [1000 * 5 * 10 / FOCAL, 0, np.nan]
    )


def test_a_knocked_camera_is_named_in_plain_lines():
    shake = knocked(table(tremor_px=0.2), 120, 12.0, 5.0)
    tremor, knock = camera_shake.say(CAMERA_KNOCKS, shake, PLAYER)
    assert tremor.startswith("camera mirror: trembles by 0.")
    assert knock.startswith(
        "camera mirror: knocked at 4.0 s by 13 px (0.44 deg, 77 mm at the player)"
    )
    assert "leave it out" in knock and "\n" not in knock
    off = table().assign(shift_x_px=3.0, shift_y_px=4.0)
    _, moved = camera_shake.say(CAMERA_KNOCKS, off, PLAYER)
    assert "was 5.0 px off its static picture at the start of the take" in moved
    assert "mm" not in "".join(camera_shake.say(CAMERA_KNOCKS, off, np.full(3, np.nan)))
    assert len(camera_shake.say(CAMERA_KNOCKS, table(), PLAYER)) == 1


def test_a_zoom_that_steady_leaves_in_is_told():
    shake = table(tremor_px=0.2)
    assert "zoom" not in "".join(camera_shake.say(CAMERA_KNOCKS, shake, PLAYER))
    shake.loc[150:, "zoom_percent"] = -0.5
    shake.loc[[10, 40], "zoom_percent"] = 3.0  # two bad frames
    shake.loc[200:210, "zoom_percent"] = np.nan
    _, zoomed = camera_shake.say(CAMERA_KNOCKS, shake, PLAYER)
    assert zoomed.startswith("camera mirror: zoomed by -0.50 % against its static picture at 5 s")
    assert "leave it out" in zoomed and "\n" not in zoomed


def test_a_turn_that_enlarges_the_picture_is_no_zoom():
    """A turn by 3.5 degrees enlarges the picture by 0.27 %, as `fit_turn` finds it."""
    shake = table(tremor_px=0.2)
    shake.loc[150:, "shift_x_px"] += np.radians(3.5) * CAMERA_KNOCKS.K[0, 0]
    shake.loc[150:, "zoom_percent"] = 0.27
    assert "zoom" not in "".join(camera_shake.say(CAMERA_KNOCKS, shake, PLAYER))


def test_knocks_are_added_to_shake():
    vectors, turn = turns(30), np.array([0.004, -0.003, 0.002])
    more = [Rotation.from_rotvec(turn * (at >= 15)) for at in range(30)]
    both = [Rotation.from_rotvec(v) * one for v, one in zip(vectors, more, strict=True)]
    table = without(shake(vectors), [20])
    found = camera_shake.camera_turns(
        CAMERA, camera_shake.knocked(CAMERA, table, [(15 / RATE_HZ, turn)])
    )
    known = np.arange(30) != 20
    expected = np.stack([one.as_rotvec() for one in both])
    assert np.abs(found - expected)[known].max() * K[0, 0] < 0.01
    assert np.isnan(found[20]).all()
    assert camera_shake.knocked(CAMERA, table, []) is table


def test_a_camera_without_shake_moves_by_its_knock_alone():
    still = camera_shake.still(np.arange(30) / RATE_HZ)
    assert not camera_shake.camera_turns(CAMERA, still).any()
    turn = np.array([0.004, -0.003, 0.002])
    made, expected, _ = view(np.outer(np.arange(30) >= 15, turn))
    back = camera_shake.steady(
        made, CAMERA, camera_shake.knocked(CAMERA, still, [(15 / RATE_HZ, turn)])
    )
    np.testing.assert_allclose(back.xy, expected, atol=0.01)


@pytest.mark.parametrize("frames", [(10, 20), (20, 10), (0, 0)])
def test_a_knock_found_in_keypoints_without_another_is_taken_out_after_it(frames):
    """The camera is turned by the product of both: the one found first is the outer one."""
    knocks = [np.radians([3.0, 0, 0]), np.radians([0, 3.0, 0])]
    rows = [np.arange(30) >= frame for frame in frames]
    outer, inner = (Rotation.from_rotvec(np.outer(*one)) for one in zip(rows, knocks, strict=True))
    made, expected, _ = view((outer * inner).as_rotvec())
    times = [frame / RATE_HZ for frame in frames]
    table = camera_shake.still(made.time_s)
    table = camera_shake.knocked(CAMERA, table, list(zip(times, knocks, strict=True)))
    off = np.linalg.norm(camera_shake.steady(made, CAMERA, table).xy - expected, axis=-1)
    assert np.nanmax(off) < 0.01


def test_knocks_of_many_frames_need_little_memory():
    """The windows of a minute at 240 Hz at once are 83 MB, and medians copy them."""
    level = np.random.default_rng(0).normal(size=(240 * 60, 3))
    level[10000:] += 8.0
    tracemalloc.start()
    steps = camera_shake._steps(level, 240, 96)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 150e6
    step = np.median(level[10000:10240], axis=0) - np.median(level[9760:10000], axis=0)
    np.testing.assert_array_equal(steps[10000], step)
