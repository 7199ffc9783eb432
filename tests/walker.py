"""A made-up person who walks, as records, for tests of exports and figures."""

from pathlib import Path

import numpy as np

import scene
from courtside.records.keypoints import missing_reason, skeleton
from courtside.records.keypoints.keypoints import Keypoints2D, Keypoints3D

SKELETON = skeleton.read(Path(__file__).parents[1] / "config" / "skeletons" / "blazepose33.yaml")
N_JOINTS = len(SKELETON.joints)


def body(n_frames):
    """Return (T, 33, 3): a column of joints, left at +y, right at -y, that walks along x."""
    side = np.array(
        [0.2 * (j.startswith("left_") - float(j.startswith("right_"))) for j in SKELETON.joints]
    )
    height = np.linspace(1.7, 0.1, N_JOINTS)
    forward = 0.02 * np.arange(n_frames)[:, None] - 0.4
    swing = 0.1 * np.sin(0.3 * np.arange(n_frames))[:, None] * np.sign(side)
    return np.stack([forward + swing, side + 0 * forward, height + 0 * forward], axis=-1)


def points(n_frames=20, n_persons=1, n_cameras=3):
    """Return a Keypoints3D with one joint missing in frame 3 and one view rejected in frame 5."""
    shape = (n_persons, n_frames, N_JOINTS)
    xyz = np.stack([body(n_frames) + np.array([0, 0.7 * at, 0]) for at in range(n_persons)])
    xyz[:, 3, 4] = np.nan
    accepted = np.ones((*shape, n_cameras), dtype=bool)
    accepted[:, 5, 7, 1], accepted[:, 3, 4] = False, False
    rng = np.random.default_rng(0)
    covariance = np.broadcast_to(np.diag([1e-4, 4e-4, 9e-4]), (*shape, 3, 3)).copy()
    covariance[:, 3, 4] = np.nan
    error_px = rng.uniform(1, 9, (*shape, n_cameras))
    error_px[:, 3, 4] = np.nan
    return Keypoints3D(
        cameras=np.array([f"c{at}" for at in range(n_cameras)]),
        model="blazepose-full",
        joints=np.array(SKELETON.joints),
        person_id=np.array([f"p{at + 1}" for at in range(n_persons)]),
        time_s=np.arange(n_frames) / 50,
        xyz=xyz,
        covariance_2d=covariance,
        covariance_camera=np.full((*shape, 3, 3), np.nan),
        n_views=accepted.sum(axis=-1),
        reproj_error_px=error_px,
        accepted=accepted,
        reason=np.where(np.isnan(xyz[..., 0]), missing_reason.REJECTED, missing_reason.OK).astype(
            np.uint8
        ),
    )


def views(record, cameras, offset_px=(0.0, 0.0)):
    """Return what the cameras of a Keypoints3D see, as Keypoints2D, moved by an offset."""
    n_persons, n_frames = record.xyz.shape[:2]
    made = []
    for camera in cameras:
        flat = np.nan_to_num(record.xyz.reshape(-1, 3), nan=0.5)
        xy = scene.opencv_projection(camera, flat).reshape(n_persons, n_frames, N_JOINTS, 2)
        made.append(
            Keypoints2D(
                camera=camera.name,
                model=record.model,
                joints=record.joints,
                size=np.array(camera.size),
                time_s=record.time_s,
                xy=xy + offset_px,
                score=np.full(xy.shape[:-1], 0.75),
                reason=np.zeros(xy.shape[:-1], np.uint8),
                xyz_in_body=np.full((*xy.shape[:-1], 3), np.nan),
            )
        )
    return made
