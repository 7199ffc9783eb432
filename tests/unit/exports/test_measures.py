"""The tables of kinematics: their columns are described, their numbers those of the measures."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from courtside.body_model import take
from courtside.exports import measures
from courtside.kinematics import joint_angles, skeleton_filter
from courtside.kinematics import measures as kinematics
from courtside.records.keypoints import derived_joints, missing_reason
from courtside.study import measure_names
from fixtures.people import footwork, moving_model, walker
from fixtures.study import data_dictionary

ROOT = Path(__file__).parents[3]
CONFIG = ROOT / "config"
RESULTS = ROOT / "docs" / "results.md"
TABLE = derived_joints.read(CONFIG / "derived_joints.yaml")


@pytest.fixture(scope="module")
def people():
    time_s, neck = footwork.neck(30, 6, seed=1)
    xyz, _ = footwork.body(neck, time_s)
    record = footwork.record(xyz, time_s, 0.01, 0.0, np.random.default_rng(0))
    record.xyz[0, 50:80, 11], record.reason[0, 50:80, 11] = np.nan, missing_reason.REJECTED
    record.covariance_2d[0, 50:80, 11] = np.nan
    how = kinematics.Filter(np.full(len(walker.SKELETON.joints), 6.0))
    return of_raw(record, how, {"p1": "f"})


def of_raw(record, how, sexes=None):
    smooth = skeleton_filter.smooth(record, how.cutoff_hz, how.order)
    return kinematics.measure(smooth, record, TABLE, "blazepose33", how, sexes)


DESCRIBED = {  # in the data dictionary, docs/results.md
    "frame_idx", "time_s", "person", "POINT_x_m", "POINT_sd_mm", "POINT_speed_m_s",
    "POINT_speed_sd_m_s", "POINT_ground_speed_m_s", "POINT_ground_speed_sd_m_s",
    "POINT_acceleration_m_s2", "POINT_acceleration_sd_m_s2", "POINT_reason", "ANGLE_deg",
    "ANGLE_sd_deg",
}  # fmt: skip


def test_every_column_is_described(people):
    for column in measures.frames(people).columns:
        plain = column.replace("left_", "").replace("right_", "")
        for point in people[0].points:
            plain = plain.replace(f"{point}_", "POINT_", 1) if plain.startswith(point) else plain
        for angle in sorted(joint_angles.DICTIONARY, key=len, reverse=True):
            plain = plain.replace(f"{angle}_", "ANGLE_", 1) if plain.startswith(angle) else plain
        plain = plain.replace("POINT_y_m", "POINT_x_m").replace("POINT_z_m", "POINT_x_m")
        assert plain in DESCRIBED, column
    assert measures.summary(people, "filtered").columns.tolist() == list(measures.SUMMARY_COLUMNS)


def test_a_row_for_every_frame(people):
    rows = measures.frames(people)
    neck = people[0].points["neck"]
    assert len(rows) == 181
    np.testing.assert_allclose(rows[["neck_x_m", "neck_y_m", "neck_z_m"]], neck.position, atol=1e-5)
    np.testing.assert_allclose(
        rows.neck_speed_m_s, np.linalg.norm(neck.velocity, axis=1), atol=1e-4
    )
    np.testing.assert_allclose(
        rows.neck_ground_speed_m_s, np.hypot(*neck.velocity[:, :2].T), atol=1e-4
    )
    assert rows.neck_reason.iloc[60] == "rejected"
    assert np.isnan(rows.neck_speed_m_s.iloc[60])
    assert rows.neck_reason.iloc[10] == "ok"


def test_every_measure_is_described(people):
    found = [*measures.summary(people, "filtered")["measure"], "neck_height_max"]
    dictionary = data_dictionary.Dictionary(RESULTS.read_text(encoding="utf-8"))
    assert dictionary.undescribed(found, data_dictionary.OF_KINEMATICS) == ["neck_height_max"]
    (fault,) = measure_names.unknown("a.yaml", found)
    assert "neck_height_max" in fault


def test_the_summary_is_that_of_the_frames(people):
    rows = measures.summary(people, "filtered").set_index("measure")
    frames = measures.frames(people)
    runs = np.lib.stride_tricks.sliding_window_view(frames.neck_speed_m_s.to_numpy(), 3)
    runs = [runs[:, k] for k in range(3)]
    assert rows.loc["neck_speed_max", "value"] == pytest.approx(
        np.nanmax((runs[0] + runs[1] + runs[2]) / 3), abs=1e-4
    )
    knee = frames.left_knee_flexion_deg
    assert rows.loc["left_knee_flexion_max", "value"] == pytest.approx(knee.max(), abs=0.01)
    assert rows.loc["left_knee_flexion_min", "value"] == pytest.approx(knee.min(), abs=0.01)
    assert rows.loc["neck_distance", "n"] == 181 - 30
    found = rows.loc["mass_distance"]
    measured = rows.loc["mass_distance_measured", "value"]
    gaps = rows.loc["mass_distance_in_gaps"]
    less = rows.loc["mass_distance_noise_bias", "value"]
    assert found.value == pytest.approx(measured - less + gaps.value)
    assert (gaps.n, gaps.value > 0, 0 < gaps.sigma < found.sigma) == (30, True, True)
    seconds = people[0].points["mass"].distance.seconds
    assert rows.loc["mass_speed_mean", "value"] == pytest.approx(found.value / seconds)
    assert rows.loc["mass_speed_mean", "sigma"] == pytest.approx(found.sigma / seconds)
    assert "women" in found.definition
    assert rows["definition"].str.endswith("; filtered joints").all()
    assert not rows.index.duplicated().any()


def test_what_the_cameras_add_stands_beside_what_the_keypoints_add():
    time_s, neck = footwork.neck(30, 4, seed=1)
    xyz, _ = footwork.body(neck, time_s)
    record = footwork.record(xyz, time_s, 0.01, 0.0, np.random.default_rng(0))
    how = kinematics.Filter(np.full(len(walker.SKELETON.joints), 6.0))
    smooth = skeleton_filter.smooth(record, how.cutoff_hz, how.order)

    def rows(field):
        people = kinematics.measure(smooth, record, TABLE, "blazepose33", how, None, field)
        return (
            measures.summary(people, "filtered").set_index("measure"),
            measures.frames(people),
        )

    (known, wide), (unknown, narrow) = rows(lambda xyz: 0.05 * xyz[:, :, None]), rows(None)
    distance = known.loc["neck_distance_measured", "value"]
    assert known.loc["neck_distance", "sigma_camera"] == pytest.approx(0.05 * distance, rel=1e-6)
    assert known.loc["neck_distance", "sigma"] == unknown.loc["neck_distance", "sigma"]
    assert np.isnan(unknown.loc["neck_distance", "sigma_camera"])
    largest = known.loc["neck_speed_max"]
    assert largest.sigma_camera == pytest.approx(0.05 * largest.value, rel=1e-3)
    assert np.isnan(known.loc["neck_acceleration_max", "sigma_camera"])  # common to both ends
    both = np.hypot(narrow.neck_speed_sd_m_s, 0.05 * narrow.neck_speed_m_s)
    np.testing.assert_allclose(wide.neck_speed_sd_m_s, both, atol=2e-4)


@pytest.mark.parametrize(
    ("rate_hz", "n", "edge"), [(12, 1, 1), (20, 2, 1), (30, 3, 1), (60, 6, 2), (240, 24, 8)]
)
def test_a_largest_speed_is_a_mean_over_a_tenth_of_a_second_away_from_gaps(
    people, rate_hz, n, edge
):
    """A bad derivative beside a gap does not count, one in the middle by its share alone."""
    point, steady = people[0].points["neck"], np.full(len(people[0].time_s), 2.0)
    steady[40] = np.nan
    for beside in (slice(edge), slice(40 - edge, 40), slice(41, 41 + edge), slice(-edge, None)):
        steady[beside] = 50.0
    steady[100] = 5.0
    vectors = steady[:, None] * [1.0, 0, 0]
    spread = (np.eye(3) * 0.1**2)[None].repeat(len(steady), axis=0)
    point = replace(point, velocity=vectors, acceleration=vectors, covariance=(spread,) * 3)
    person = replace(
        people[0], time_s=np.arange(len(steady)) / rate_hz, points={"neck": point}, angles={}
    )
    rows = measures.summary([person], "filtered").set_index("measure")
    speed = rows.loc["neck_speed_max"]
    assert speed.value == pytest.approx(2 + 3 / n)
    assert speed.sigma == pytest.approx(np.hypot(0.1, 0.03 * speed.value))
    assert speed.n == len(steady) - 1 - 4 * edge
    assert "largest mean over 0.1 s" in speed.definition


@pytest.mark.parametrize("rate_hz", [10, 15, 20, 30])
def test_a_largest_speed_is_that_of_a_tenth_of_a_second_at_every_frame_rate(rate_hz):
    """Somebody goes 0.6 m forth and back as a pendulum does, once in 1.2 s: at 3.1 m/s at most."""
    time_s, turn = np.arange(9 * rate_hz) / rate_hz, 2 * np.pi / 1.2
    neck = np.column_stack([0.6 * np.sin(turn * time_s), 0 * time_s, 0 * time_s + 1.45])
    record = footwork.record(
        footwork.body(neck, time_s)[0], time_s, 0.006, 0.0, np.random.default_rng(0)
    )
    how = kinematics.Filter(np.full(len(walker.SKELETON.joints), min(6.0, 0.45 * rate_hz)))
    rows = measures.summary(of_raw(record, how), "filtered").set_index("measure")
    speed, true_m_s = rows.loc["neck_speed_max"], 2 * 0.6 * np.sin(turn * 0.05) / 0.1
    assert abs(speed.value - true_m_s) < 1.645 * speed.sigma
    assert speed.value == pytest.approx(true_m_s, rel=0.06)


def test_the_bars_of_a_largest_speed_hold_the_true_one(people):
    """The largest of 10 s at 3 m/s with errors of 0.04 m/s that last 0.2 s, as filtered ones do."""
    rng, held, point = np.random.default_rng(4), [], people[0].points["neck"]
    spread = (np.eye(3)[None].repeat(300, axis=0) * 0.04**2,) * 3
    for _ in range(40):
        errors = np.apply_along_axis(
            lambda one: np.convolve(one, np.full(6, 6**-0.5), "valid"), 0, rng.normal(size=(305, 3))
        )
        found = replace(
            point,
            velocity=[3.0, 0, 0] + 0.04 * errors,
            covariance=spread,
            camera_covariance=tuple(0 * one for one in spread),
        )
        person = replace(people[0], time_s=np.arange(300) / 30, points={"neck": found}, angles={})
        speed = measures.summary([person], "filtered").set_index("measure").loc["neck_speed_max"]
        held.append(abs(speed.value - 3) < 1.645 * speed.sigma)
    assert np.mean(held) > 0.85


@pytest.mark.parametrize("rate_hz", [10, 30, 60])
def test_a_largest_acceleration_is_a_change_of_velocity_over_three_tenths_of_a_second(
    people, rate_hz
):
    """A wrong joint throws the point out and back at once: that is no change of its velocity."""
    time_s = np.arange(4 * rate_hz) / rate_hz
    push = np.clip(time_s - 1, 0, 0.6)  # 5 m/s2 for 0.6 s
    velocity = push[:, None] * [3.0, -4.0, 0]
    velocity[3 * rate_hz] = np.nan
    edge = max(1, round(rate_hz / 30))
    velocity[3 * rate_hz - edge : 3 * rate_hz + edge + 1] += 9.0  # beside a gap
    acceleration = np.gradient(velocity, 1 / rate_hz, axis=0)
    acceleration[rate_hz // 2] += [200.0, 0, 0]
    spread = (np.eye(3) * 0.1**2)[None].repeat(len(velocity), axis=0)
    point = replace(
        people[0].points["neck"],
        velocity=velocity,
        acceleration=acceleration,
        covariance=(spread,) * 3,
        camera_covariance=(0 * spread,) * 3,
    )
    person = replace(people[0], time_s=time_s, points={"neck": point}, angles={})
    row = measures.summary([person], "filtered").set_index("measure").loc["neck_acceleration_max"]
    assert row.value == pytest.approx(5)
    assert row.sigma == pytest.approx(np.hypot(np.sqrt(2) * 0.1 / 0.3, 0.1 * 5))
    assert np.isnan(row.sigma_camera)
    assert row.n == len(time_s) - 1 - 4 * edge
    assert "largest change of velocity over 0.3 s" in row.definition


def test_a_largest_acceleration_does_not_depend_on_when_the_take_began(people):
    """0.3 s at 25 Hz are 7.5 frames."""
    time_s, point = np.arange(100) / 25, people[0].points["neck"]
    velocity = np.sin(8 * time_s)[:, None] * [3.0, -4.0, 0]
    spread = (np.eye(3)[None].repeat(100, axis=0),) * 3
    point = replace(point, velocity=velocity, covariance=spread, camera_covariance=spread)
    values = []
    for start_s in (0.0, 0.37, 7.0, 10.03, 1000.0):
        person = replace(people[0], time_s=start_s + time_s, points={"neck": point}, angles={})
        row = measures.summary([person], "filtered").set_index("measure")
        values.append(row.loc["neck_acceleration_max", "value"])
    np.testing.assert_allclose(values, values[0], rtol=1e-6)


@pytest.mark.parametrize("n", [5, 8])
def test_a_take_shorter_than_a_change_of_velocity_has_no_largest_acceleration(people, n):
    point = people[0].points["neck"]
    short = replace(
        point,
        velocity=point.velocity[:n],
        covariance=tuple(one[:n] for one in point.covariance),
        camera_covariance=tuple(one[:n] for one in point.camera_covariance),
    )
    person = replace(people[0], time_s=people[0].time_s[:n], points={"neck": short}, angles={})
    rows = measures.summary([person], "filtered").set_index("measure")
    assert np.isnan(rows.loc["neck_acceleration_max", "value"])
    assert np.isfinite(rows.loc["neck_speed_max", "value"])


def test_nobody_seen_is_a_table_of_missing_values():
    time_s, neck = footwork.neck(30, 2)
    xyz, _ = footwork.body(neck, time_s)
    record = footwork.record(xyz, time_s, 0.01, 0.0, np.random.default_rng(0))
    record.xyz[:], record.covariance_2d[:], record.reason[:] = np.nan, np.nan, missing_reason.UNSEEN
    how = kinematics.Filter(np.full(len(walker.SKELETON.joints), 6.0))
    people = of_raw(record, how)
    rows = measures.summary(people, "filtered").set_index("measure")
    assert np.isnan(rows.loc["neck_speed_max", "value"])
    assert rows.loc["neck_distance", "n"] == 0
    assert measures.frames(people).neck_speed_m_s.isna().all()


def test_angles_of_a_skeletal_motion_have_a_row_for_each_frame_and_person():
    points = moving_model.points(moving_model.moving(5))
    fitted = take.person(points, 0, dict.fromkeys(moving_model.JOINTS, 8.0), 1.75)
    motion = take.motion(points, {0: fitted})
    rows = measures.angles(motion)
    knee = motion.angles.tolist().index("left_knee_flexion")
    np.testing.assert_allclose(rows["left_knee_flexion_deg"], motion.angle_deg[0, :, knee].round(2))
    assert rows["person"].tolist() == ["a"] * 5
    assert (rows["right_elbow_flexion_sd_deg"] > 0).all()


def test_the_rotation_of_a_pelvis_goes_on_where_a_person_turns_round():
    points = moving_model.points(moving_model.moving(5))
    fitted = take.person(points, 0, dict.fromkeys(moving_model.JOINTS, 8.0), 1.75)
    motion = take.motion(points, {0: fitted})
    names = motion.angles.tolist()
    motion.angle_deg[0, :, names.index("pelvis_rotation")] = np.nan, 170, 179, -179, -170
    motion.angle_deg[0, :, names.index("left_shoulder_plane")] = np.nan, 170, 179, -179, -170
    rows = measures.angles(motion)
    np.testing.assert_allclose(rows["pelvis_rotation_deg"], [np.nan, 170, 179, 181, 190])
    np.testing.assert_allclose(rows["left_shoulder_plane_deg"], [np.nan, 170, 179, -179, -170])
