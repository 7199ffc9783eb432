"""A real suit without T-pose and clap becomes files that other programs' readers open."""

import runpy
from pathlib import Path

import ezc3d
import numpy as np
import pandas as pd
import pytest

from courtside.devices import bvh, mocopi
from courtside.exports import trc
from courtside.records.devices import device_motion
from courtside.records.devices.hierarchy import forward
from courtside.records.keypoints import skeleton
from fixtures.recordings.real_data import REAL, needs_real

ROOT = Path(__file__).parents[3]
YAML = ROOT / "config" / "skeletons" / "mocopi27.yaml"


@needs_real
@pytest.mark.parametrize(("name", "rate_hz"), [("jump", 60), ("mocopi-mobile-arm-raise-turn", 50)])
def test_a_real_suit_is_in_every_file_as_it_moved(tmp_path, name, rate_hz):
    motion = mocopi.read(REAL / "mocopi" / f"{name}.bvh", skeleton.read(YAML))
    device_motion.write(tmp_path / "suit.npz", motion)
    script = runpy.run_path(str(ROOT / "workflow" / "scripts" / "export_device.py"))
    files = [tmp_path / f"out.{suffix}" for suffix in ("trc", "c3d", "csv", "bvh", "glb")]
    script["main"](tmp_path / "suit.npz", YAML, *files, person="p1")
    performed = motion.xyz[1:]  # the first row is the rest pose, which nobody performed
    upright = performed[..., [2, 0, 1]] * [-1, 1, 1]  # turned about z: their y is our z
    joints, rate, time_s, xyz = trc.read(files[0])
    assert joints == motion.joints.tolist()
    assert rate == pytest.approx(rate_hz, rel=1e-5)
    np.testing.assert_allclose(time_s, motion.time_s[1:], atol=1e-6)
    assert (xyz[:, joints.index("head"), 2] > xyz[:, joints.index("left_toes"), 2]).mean() > 0.9
    apart = np.linalg.norm(xyz[:, None, :4] - xyz[:, :4, None], axis=-1)
    wanted = np.linalg.norm(upright[:, None, :4] - upright[:, :4, None], axis=-1)
    np.testing.assert_allclose(apart, wanted, atol=2e-6)
    np.testing.assert_allclose(xyz[..., 2], performed[..., 1], atol=1e-6)
    points = ezc3d.c3d(str(files[1]))["data"]["points"][:3].transpose(2, 1, 0)
    np.testing.assert_allclose(points, 1000 * xyz, atol=2e-3)
    rows = pd.read_csv(files[2])
    assert len(rows) == performed[..., 0].size
    assert set(rows["person"]) == {"p1"}
    assert rows["sd_x_mm"].isna().all()  # a suit states no errors
    again = bvh.read(files[3])
    assert again.hierarchy.joints == bvh.read(REAL / "mocopi" / f"{name}.bvh").hierarchy.joints
    np.testing.assert_allclose(forward(again)[0], motion.xyz, atol=1e-4)
