"""Derived joints: the table that ships, weights by hand, covariances by simulation."""

from pathlib import Path

import numpy as np
import pytest

from courtside.records.keypoints import derived_joints, missing_reason, skeleton
from courtside.study.errors import InputError
from fixtures.people import walker

CONFIG = Path(__file__).parents[4] / "config"
TABLE = derived_joints.read(CONFIG / "derived_joints.yaml")


@pytest.mark.parametrize(
    "path", sorted((CONFIG / "skeletons").glob("*.yaml")), ids=lambda p: p.stem
)
def test_every_skeleton_of_the_study_has_every_derived_joint(path):
    joints = skeleton.read(path).joints
    for name in TABLE.joints:
        weights = TABLE.weights(path.stem, name, joints)
        assert weights.sum() == pytest.approx(1.0)
        assert (weights >= 0).all()


def test_joints_of_one_definition_are_comparable_and_others_are_not():
    assert TABLE.comparable("blazepose33", "rig", "neck")
    assert TABLE.comparable("cpm14", "rig", "mid_hip")
    assert not TABLE.comparable("blazepose33", "cpm14", "neck")
    assert not TABLE.comparable("cpm14", "rig", "head_centre")


def test_the_neck_lies_halfway_between_the_shoulders():
    record = walker.points(n_persons=2)
    xyz, _, _, reason = derived_joints.of(record, TABLE, "blazepose33", "neck")
    left, right = (
        record.xyz[:, :, list(record.joints).index(f"{s}_shoulder")] for s in ("left", "right")
    )
    np.testing.assert_allclose(xyz, (left + right) / 2)
    assert (reason == missing_reason.OK).all()


def test_a_missing_part_is_missing_with_its_reason():
    record = walker.points()
    at = list(record.joints).index("left_hip")
    record.xyz[0, 7, at], record.reason[0, 7, at] = np.nan, missing_reason.ONE_VIEW
    other = list(record.joints).index("right_hip")
    record.reason[0, [7, 8], other] = missing_reason.INTERPOLATED
    xyz, _, _, reason = derived_joints.of(record, TABLE, "blazepose33", "pelvis_thorax")
    assert np.isnan(xyz[0, 7]).all()
    assert np.isfinite(np.delete(xyz[0], 7, axis=0)).all()
    assert reason[0, 7] == missing_reason.ONE_VIEW
    assert reason[0, 8] == missing_reason.INTERPOLATED


def test_the_covariance_is_the_spread_of_the_weighted_mean():
    rng = np.random.default_rng(0)
    roots = rng.normal(0, 0.01, (3, 3, 3))
    covariance = roots @ roots.transpose(0, 2, 1)
    weights = np.array([0.2, 0.0, 0.8])
    draws = np.einsum("jkl,njl->njk", roots, rng.normal(size=(200_000, 3, 3)))
    ok = np.zeros((len(draws), 3), dtype=np.uint8)
    mean, stated, _ = derived_joints.combine(
        draws, np.broadcast_to(covariance, (len(draws), 3, 3, 3)), ok, weights
    )
    scale = np.trace(stated[0])
    np.testing.assert_allclose(np.cov(mean.T), stated[0], atol=0.01 * scale)


def test_an_error_common_to_all_joints_does_not_average_out():
    record = walker.points()
    common = np.diag([4e-4, 1e-4, 9e-4])
    record.covariance_camera[:] = common
    camera = derived_joints.of(record, TABLE, "blazepose33", "neck")[2]
    np.testing.assert_allclose(camera[0, 0], common)


def test_appending_keeps_what_was_there():
    record = walker.points()
    longer = derived_joints.append(record, TABLE, "blazepose33", ["neck", "mid_hip", "left_knee"])
    assert longer.joints.tolist() == [*record.joints.tolist(), "neck", "mid_hip"]
    np.testing.assert_array_equal(longer.xyz[:, :, :33], record.xyz)
    shoulder = [list(record.joints).index(f"{side}_shoulder") for side in ("left", "right")]
    np.testing.assert_array_equal(
        longer.n_views[..., 33], record.n_views[..., shoulder].min(axis=-1)
    )
    for key in (
        "covariance_2d",
        "covariance_camera",
        "covariance_network",
        "offset",
        "outlier",
        "reproj_error_px",
        "accepted",
        "swapped",
        "reason",
    ):
        assert getattr(longer, key).shape[2] == 35


def test_faults_are_one_line(tmp_path):
    with pytest.raises(InputError, match=r"'neck'.*expected a definition for skeleton 'other'"):
        TABLE.weights("other", "neck", [])
    with pytest.raises(InputError, match="missing: \\['left_shoulder'"):
        TABLE.weights("blazepose33", "neck", ["left_hip"])
    path = tmp_path / "table.yaml"
    path.write_text("definitions: {a: {means: x, weights: {b: 0.5}}}\njoints: {}\n")
    with pytest.raises(
        InputError, match=r"definitions.a: expected weights that sum to 1, found 0.5"
    ):
        derived_joints.read(path)
    path.write_text("definitions: {a: {means: x, weights: {b: 1}}}\njoints: {neck: {rig: c}}\n")
    with pytest.raises(InputError, match=r"joints.neck.rig: expected one of \['a'\], found 'c'"):
        derived_joints.read(path)
    path.write_text("definitions: [1]\njoints: {}\n")
    with pytest.raises(InputError, match="definitions: expected keys and values"):
        derived_joints.read(path)
