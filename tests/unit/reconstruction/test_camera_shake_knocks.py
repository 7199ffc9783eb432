"""Knocks of a camera: those made are found and named, those not made are not."""

import numpy as np
import pandas as pd
import pytest

from courtside.geometry.camera import Camera
from courtside.reconstruction import camera_shake

FOCAL = 1680.0
CAMERA = Camera(
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
    (found,) = camera_shake.find(CAMERA, shake)
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
        camera_shake.find(CAMERA, table(n, tremor_px=px, seed=seed))
        for px in (0.0, 0.3, 2.0)
        for seed in range(10)
    ]
    assert sum(map(len, found)) == 0


def test_a_slow_drift_and_a_short_jerk_are_no_knocks():
    drifting = table()
    drifting["shift_y_px"] += 1.5 * drifting.time_s
    jerked = table()
    jerked.loc[100:108, "shift_x_px"] += 20.0
    assert camera_shake.find(CAMERA, drifting) == camera_shake.find(CAMERA, jerked) == []


def test_each_of_several_knocks_is_found_also_one_about_the_axis():
    shake = knocked(knocked(knocked(table(600), 150, 9.0), 300, -4.0, 3.0), 450, turn_deg=0.3)
    found = camera_shake.find(CAMERA, shake)
    assert [round(knock.time_s * 30) for knock in found] == [150, 300, 450]
    assert found[2].turn_deg == pytest.approx(0.3, abs=0.01)
    assert np.hypot(*found[1].shift_px) == pytest.approx(5.0, abs=0.1)


def test_unknown_frames_hide_no_knock_and_make_none():
    shake = knocked(table(), 120, 8.0)
    names = ["shift_x_px", "shift_y_px", "rotation_deg", "zoom_percent", "sigma_px"]
    shake.loc[[*range(30, 50), *range(115, 120)], names] = np.nan
    (found,) = camera_shake.find(CAMERA, shake)
    assert round(found.time_s * 30) == 120
    shake[names] = np.nan
    assert camera_shake.find(CAMERA, shake) == []
    assert np.isnan(camera_shake.tremor_px(shake))
    (line,) = camera_shake.say(CAMERA, shake, PLAYER)
    assert "no frame shows enough background" in line


def test_very_short_takes_have_no_knocks():
    for n in (1, 2, 5):
        assert camera_shake.find(CAMERA, table(n)) == []


def test_tremor_does_not_count_knocks():
    shake = knocked(table(600, tremor_px=0.5), 300, 10.0)
    assert camera_shake.tremor_px(shake, camera_shake.find(CAMERA, shake)) == pytest.approx(
        0.5, rel=0.1
    )
    assert camera_shake.tremor_px(shake) > 2


def test_millimetres_at_the_player_are_pixels_times_depth_over_focal_length():
    shake = table(3).assign(shift_x_px=[3.0, 0.0, np.nan], shift_y_px=[4.0, 0.0, np.nan])
    np.testing.assert_allclose(
        camera_shake.mm_at(CAMERA, PLAYER, shake), [1000 * 5 * 10 / FOCAL, 0, np.nan]
    )


def test_a_knocked_camera_is_named_in_plain_lines():
    shake = knocked(table(tremor_px=0.2), 120, 12.0, 5.0)
    tremor, knock = camera_shake.say(CAMERA, shake, PLAYER)
    assert tremor.startswith("camera mirror: trembles by 0.")
    assert knock.startswith(
        "camera mirror: knocked at 4.0 s by 13 px (0.44 deg, 77 mm at the player)"
    )
    assert "leave it out" in knock and "\n" not in knock
    off = table().assign(shift_x_px=3.0, shift_y_px=4.0)
    _, moved = camera_shake.say(CAMERA, off, PLAYER)
    assert "stood 5.0 px off its static picture when the take began" in moved
    assert "mm" not in "".join(camera_shake.say(CAMERA, off, np.full(3, np.nan)))
    assert len(camera_shake.say(CAMERA, table(), PLAYER)) == 1
