"""What the model of joint errors is fitted on: the offset is taken away, all limbs are there."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from courtside.evaluation import error_fit
from courtside.reconstruction import joint_correction, joint_errors
from courtside.records.cameras.footage import Footage
from courtside.records.devices.clocks import Clock
from courtside.records.keypoints.skeleton import JOINTS
from fixtures.cameras import scene
from fixtures.people import true_motion, walker

OPTIONS = {"min_score": 0.05, "min_views": 2, "max_error_px": 10, "fade_px": 13, "fix_sides": False}
OFFSETS = Path(__file__).parents[3] / "config" / "joint_offsets" / "blazepose-full.csv"


def test_errors_are_those_beside_the_known_offset():
    cameras, n_frames = scene.ring(3), 20
    record = replace(walker.points(n_frames), xyz=walker.body(n_frames)[None])
    rng = np.random.default_rng(0)
    views = walker.views(record, cameras)
    for view in views:
        view.xy[...] += rng.normal(0, 1, view.xy.shape)
    table = joint_correction.read(OFFSETS)
    true = record.xyz - np.nan_to_num(joint_correction.offsets(record, table, {"p1": "m"}))
    truth = true_motion.Truth(record.joints, record.person_id, record.time_s, true)
    seen = [Footage(c, view, Clock()) for c, view in zip(cameras, views, strict=True)]
    given = walker.SKELETON, {"p1": "m"}, table, truth, OPTIONS
    columns, error, covariance, weight = error_fit.joints_of(seen, *given)
    n = n_frames * len(JOINTS)
    assert columns.shape == (n, len(joint_errors.SIGNS)) and covariance.shape == (n, 3, 3)
    assert np.median(np.linalg.norm(error, axis=1)) < 0.02  # of noise; offsets are up to 0.1
    assert (weight == error_fit.WEIGHT[3]).all()
    assert (error_fit.joints_of(seen[:2], *given)[3] == error_fit.WEIGHT[2]).all()
    none = *given[:2], None, *given[3:]  # of a network without known offsets
    _, whole, _, _ = error_fit.joints_of(seen, *none)
    assert np.median(np.linalg.norm(whole, axis=1)) > np.median(np.linalg.norm(error, axis=1))
