"""Networks made with known errors, exchanges, gaps and jitter are told apart by just these."""

from dataclasses import dataclass, fields, replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from courtside.evaluation import detection
from courtside.evaluation.tables import networks
from courtside.records.keypoints import skeleton
from courtside.statistics import moving_blocks
from fixtures.people import walker

TORSO_PX = 100.0
CAMERAS = {"one": 0, "two": 7}  # with the frames that each was started before the take


@pytest.fixture(autouse=True)
def _fewer_replicates(monkeypatch):
    monkeypatch.setattr(moving_blocks, "REPLICATES", 100)


def made(off_px, n_frames=120, exchanged=(), gone=(), rate_hz=30):
    """Return rows of `detection.evaluate`: `off_px(rng, shape)` is added to the true joints."""
    rng, parts = np.random.default_rng(3), []
    for camera, early in CAMERAS.items():
        index = pd.MultiIndex.from_product(
            [range(early, early + n_frames), skeleton.JOINTS], names=["frame_idx", "joint"]
        )
        rows = index.to_frame(index=False).assign(person="p1", camera=camera, torso_px=TORSO_PX)
        rows["time_s"] = (rows["frame_idx"] - early) / rate_hz
        off = off_px(rng, (len(rows), 2))
        for at, axis in enumerate("xy"):
            rows[f"true_{axis}_px"] = 500 + 300 * np.sin(rows["time_s"] + at)
            rows[f"{axis}_px"] = rows[f"true_{axis}_px"] + off[:, at]
        frame = rows["frame_idx"] - early
        lost = frame.isin(gone)
        rows.loc[lost, ["x_px", "y_px"]] = np.nan
        rows["error_px"] = np.hypot(*(rows[f"{a}_px"] - rows[f"true_{a}_px"] for a in "xy"))
        rows["error_torso"] = rows["error_px"] / TORSO_PX
        rows["found"], rows["in_picture"], rows["in_stroke"] = ~lost, True, False
        rows["exchanged"] = frame.isin(exchanged)
        rows["placed"] = (rows["error_torso"] < detection.TOLERANCE) & ~rows["exchanged"]
        parts.append(rows)
    return pd.concat(parts, ignore_index=True)[detection.COLUMNS]


def constant(length_px):
    return lambda rng, shape: np.full(shape, length_px) * [0.6, 0.8]


def noise(sigma_px):
    return lambda rng, shape: rng.normal(0, sigma_px, shape)


def measured(pictures, **more):
    take = networks.ComparedTake("gym", "truth", pictures, **more)
    rows = networks.table([take], list(pictures))
    assert list(rows.columns) == networks.COLUMNS
    return rows.set_index(["network", "measure"])


def test_a_known_error_is_found_in_pixels_and_torsos():
    rows = measured({"near": made(constant(5)), "far": made(constant(30))})
    for measure in ("error_median", "error_p95", "error_median_torso", "error_p95_torso"):
        np.testing.assert_allclose(rows.loc[[("near", measure), ("far", measure)], "value"],
                                   [5, 30])  # fmt: skip
    far = rows.loc["far", "error_median"]
    np.testing.assert_allclose(far[["difference", "difference_from", "difference_to"]].tolist(), 25)
    assert np.isnan(rows.loc[("near", "error_median"), "difference"])
    assert rows.loc[("near", "pck"), "value"] == 100 and rows.loc[("far", "pck"), "value"] == 0


def test_jitter_is_the_noise_of_each_axis_and_no_steady_error():
    rows = measured({"still": made(constant(30)), "noisy": made(noise(3.0))})
    assert rows.loc[("still", "jitter"), "value"] < 1e-9
    np.testing.assert_allclose(rows.loc[("noisy", "jitter"), "value"], 3.0, rtol=0.05)
    assert np.isclose(rows.loc[("noisy", "jitter"), "n"], 2 * 118 * 12)


def slow(kept):
    """Return errors of 1 px per axis that keep this share from frame to frame, by joint."""

    def off_px(rng, shape):
        fresh = rng.normal(0, 1, (shape[0] // len(skeleton.JOINTS), len(skeleton.JOINTS), 2))
        fresh[1:] *= np.sqrt(1 - kept**2)
        for at in range(1, len(fresh)):
            fresh[at] += kept * fresh[at - 1]
        return fresh.reshape(shape)

    return off_px


def test_jitter_is_less_than_the_change_from_frame_to_frame_as_its_descriptions_say():
    """Changes have sqrt(2 - 2 kept) px per axis: 1.41 and 0.45."""
    rows = measured({"white": made(slow(0.0)), "slow": made(slow(0.9))})["value"]
    np.testing.assert_allclose(rows["white", "jitter"], 1.0, rtol=0.1)
    assert rows["slow", "jitter"] < 0.32
    for name in ("workflow/report/draw_networks.rst", "docs/measured/networks.md"):
        text = " ".join(Path(name).read_text(encoding="utf-8").split())
        assert "noise of the error, taken as independent from frame to frame" in text


def test_exchanged_and_missing_joints_are_counted_in_the_frames_with_a_truth():
    one = made(constant(1), exchanged=range(30, 60))
    other = made(constant(1), gone=range(90, 120))
    rows = measured({"one": one, "other": other})["value"].unstack("measure")
    np.testing.assert_allclose(rows["exchanged"], [25, 0])
    np.testing.assert_allclose(rows["missing"], [0, 25])
    np.testing.assert_allclose(rows["pck"], [75, 75])


def test_errors_are_of_the_frames_that_all_networks_have():
    hard = made(constant(1))
    late = hard["time_s"] > 2.99
    hard.loc[late, "error_px"] = 500.0
    both = measured({"brave": hard, "timid": made(constant(1), gone=range(90, 120))})
    assert both.loc[("brave", "error_p95"), "value"] == pytest.approx(1)
    assert both.loc[("brave", "error_p95"), "n"] == 2 * 90 * 12
    assert measured({"brave": hard}).loc[("brave", "error_p95"), "value"] == 500


def test_an_interval_holds_a_share_as_wide_as_its_blocks_make_it():
    rows = measured({"one": made(constant(1), n_frames=1200, exchanged=range(300, 600))})
    share = rows.loc[("one", "exchanged")]
    assert share["value_from"] < 25 < share["value_to"] and share["n_blocks"] == 80
    # 80 blocks of one state each
    np.testing.assert_allclose(share["value_to"] - share["value_from"], 19, rtol=0.3)
    short = measured({"one": made(constant(1), n_frames=40)}).loc[("one", "pck")]
    assert short["n_blocks"] == 2 and np.isnan(short["value_from"])


def exchanged_in(takes):
    """Return the share exchanged in takes of 60 frames, each with these frames exchanged."""
    pictures = [{"one": made(constant(1), n_frames=60, exchanged=frames)} for frames in takes]
    every = [networks.ComparedTake("gym", "truth", each) for each in pictures]
    return networks.table(every, ["one"]).set_index("measure").loc["exchanged"]


def test_an_interval_holds_a_share_that_the_last_frames_of_takes_make():
    share = exchanged_in([range(52, 60)] * 5)
    np.testing.assert_allclose(share["value"], 100 * 8 / 60)
    assert share["value_from"] < share["value"] < share["value_to"]


def test_an_interval_is_as_wide_as_takes_differ():
    """One take of five is exchanged as a whole: 4 of 20 blocks."""
    share = exchanged_in([range(60), (), (), (), ()])
    assert share["value"] == 20 and share["n_blocks"] == 20
    np.testing.assert_allclose(share["value_to"] - share["value_from"], 35, rtol=0.3)


def test_a_draw_without_a_known_value_is_left_out():
    """Of five takes, one second has a value: some draws have none of its frames."""
    counts, _ = networks._counts([60] * 5, [30.0] * 5)
    values, frame = np.full(30, 50.0), np.arange(30)
    for percentile in (None, 50):
        drawn = networks._drawn(counts, values, frame, percentile)
        assert np.isnan(drawn).any() and set(drawn[np.isfinite(drawn)]) == {50.0}


def test_frames_of_cameras_are_drawn_together_by_their_time():
    step_s, slot = networks._slots(made(constant(1), n_frames=5))
    assert step_s == pytest.approx(1 / 30)
    assert slot.loc["one"].tolist() == slot.loc["two"].tolist() == [0, 1, 2, 3, 4]


def test_errors_in_space_are_of_the_places_that_all_have_and_takes_are_joined():
    near, far = np.full((1, 60, 12), 20.0), np.full((1, 60, 12), 45.0)
    near[0, :30] = np.nan
    pictures = {"near": made(constant(1)), "far": made(constant(1))}
    space = {"error_3d": {"near": near, "far": far}, "rate_hz_3d": 30.0}
    take = networks.ComparedTake("gym", "truth", pictures, **space)
    plain = networks.ComparedTake("gym", "truth", pictures)
    rows = networks.table([take, plain], list(pictures)).set_index(["network", "measure"])
    in_space = rows.index.get_level_values("measure").str.startswith("error_3d")
    assert in_space.any() and (rows["n_takes"] == np.where(in_space, 1, 2)).all()
    found = rows.loc[("far", "error_3d_median")]
    assert (found["value"], found["difference"], found["n"]) == (45, 25, 30 * 12)
    assert "error_3d_median" not in measured(pictures).loc["near"].index
    one = measured(pictures, error_3d={"far": far}, rate_hz_3d=30.0)["value"].unstack("measure")
    assert one.loc["far", "error_3d_median"] == 45
    assert np.isnan(one.loc["near", "error_3d_median"])


@dataclass
class Truth:
    """What `courtside.evaluation.joints.Truth` has."""

    time_s: np.ndarray
    xyz: np.ndarray
    joints: tuple = walker.SKELETON.joints
    person_id: tuple = ("p2", "p1")


def test_skeletons_are_compared_person_by_person_on_common_frames():
    points = walker.points(n_frames=30, n_persons=2)
    whole = np.nan_to_num(points.xyz, nan=1.0)
    truth = Truth(points.time_s, whole[::-1])
    moved = replace(points, xyz=whole + np.array([0.03, 0.0, 0.04]) * [[[[1]]], [[[2]]]])
    cut = {
        field.name: getattr(moved, field.name)[:, 5:]
        for field in fields(moved)
        if np.shape(getattr(moved, field.name))[:2] == (2, 30)
    }
    late = replace(moved, time_s=moved.time_s[5:], **cut)
    found, rate_hz = networks.errors_3d({"all": moved, "late": late}, truth)
    assert rate_hz == pytest.approx(50)
    np.testing.assert_allclose(found["all"], np.broadcast_to([[[100]], [[50]]], (2, 30, 12)))
    assert np.isnan(found["late"][:, :5]).all()
    np.testing.assert_allclose(found["late"][:, 5:], found["all"][:, 5:])
