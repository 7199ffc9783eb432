"""A small photogrammetric network with exact truth: two fixed cameras and a walk between them."""

from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation

from courtside.calibration.bundle.problem import LENS, Network, residuals
from courtside.geometry.camera import Camera

SIZE = (1280, 720)
LENS_SIGMA = (np.inf, 1e-3, 25.0, 25.0, 0.2, 0.2, 2e-3, 2e-3)


def look_at(centre, aim):
    """Return cam_from_world (3, 4) of a camera at `centre` that looks at `aim`, z up."""
    forward = np.asarray(aim, float) - centre
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, [0, 0, 1])
    right /= np.linalg.norm(right)
    rotation = np.stack([right, np.cross(forward, right), forward])
    return np.column_stack([rotation, -rotation @ centre])


def make(n_walk=6, n_points=60, *, seed=0, noise_px=0.0, flex=False):
    """Return a network at its true state, whose pixels carry noise.

    Images 0 and 1 are the fixed cameras with lenses 0 and 1, the others share lens 2.
    """
    rng = np.random.default_rng(seed)
    angles = np.concatenate([[0, np.pi / 2], np.linspace(0.1, np.pi / 2 - 0.1, n_walk)])
    middle = np.array([3.0, 6.7, 1.0])
    centres = middle + np.stack(
        [-20 * np.cos(angles), -20 * np.sin(angles), 1 + 0.3 * rng.random(len(angles))], axis=1
    )
    pose = np.stack([look_at(centre, middle + rng.normal(size=3)) for centre in centres])
    lens = np.array(
        [[1100 + 10 * k, 1.0, 639.5 + k, 359.5 - k, -0.04, 0.01, 1e-4, -1e-4] for k in range(3)]
    )
    xyz = middle + rng.uniform(-1, 1, (n_points, 3)) * [5, 7, 3]
    n_images = len(pose)
    image_idx = np.repeat(np.arange(n_images), n_points)
    bent = np.zeros((n_images, 5))
    if flex:
        bent[2:] = rng.normal(size=(n_walk, 5)) * [2e-3, 2e-3, 2e-3, 2, 2]
    network = Network(
        cam_from_world=pose,
        flex=bent,
        lens=lens,
        xyz=xyz,
        lens_of_image=np.minimum(np.arange(n_images), 2),
        height_px=np.full(n_images, float(SIZE[1])),
        image_idx=image_idx,
        point_idx=np.tile(np.arange(n_points), n_images),
        xy=np.tile(rng.uniform([0, 0], SIZE, (n_points, 2)), (n_images, 1)),
        sigma_px=np.ones(len(image_idx)),
        loss_scale=np.full(len(image_idx), np.inf),
        flex_sigma=np.zeros((n_images, 5)),
        lens_mean=np.array([[1150, 1, 639.5, 359.5, 0, 0, 0, 0]] * 3),
        lens_sigma=np.tile(LENS_SIGMA, (3, 1)),
        xyz_mean=np.zeros((n_points, 3)),
        xyz_sigma=np.full(n_points, np.inf),
    )
    for _ in range(30):  # the row that a rolling shutter sees a point in depends on the row
        network.xy[...] += residuals(network)
    network.xy[...] += noise_px * rng.standard_normal(network.xy.shape)
    return network


def disturbed(network, seed=1, scale=1.0):
    """Return the network moved away from its state, as structure from motion might give it."""
    rng = np.random.default_rng(seed)
    images = rng.normal(size=(len(network.cam_from_world), 11)) * (
        [3e-3] * 3 + [0.05] * 3 + [0.0] * 5
    )
    lenses = rng.normal(size=(len(network.lens), len(LENS))) * [15, 0, 2, 2, 0.01, 0.005, 0, 0]
    step = scale * np.concatenate([images.ravel(), lenses.ravel()])
    return network.moved(step, scale * 0.1 * rng.normal(size=network.xyz.shape))


def exact_lens_prior(network):
    """Return the network with its lenses' prior about their state, so that nothing pulls it away."""
    return replace(network, lens_mean=network.lens.copy())


def fixed_cameras(network, names=("side", "back")):
    """Return the first images as cameras, for OpenCV's projection."""
    found = []
    for at, name in enumerate(names):
        f, aspect, cx, cy, *dist = network.lens[network.lens_of_image[at]]
        matrix = np.array([[f * aspect, 0, cx], [0, f, cy], [0, 0, 1]])
        found.append(Camera(name, SIZE, matrix, [*dist, 0.0], network.cam_from_world[at]))
    return found


def in_random_frame(network, seed=3):
    """Return the network as structure from motion has it: any frame, any unit."""
    rng = np.random.default_rng(seed)
    turn = Rotation.random(rng=rng).as_matrix()
    scale, shift = rng.uniform(0.1, 0.5), rng.normal(size=3)
    centres = -np.einsum(
        "vji,vj->vi", network.cam_from_world[:, :, :3], network.cam_from_world[:, :, 3]
    )
    rotation = network.cam_from_world[:, :, :3] @ turn.T
    centres = scale * centres @ turn.T + shift
    pose = np.concatenate([rotation, -(rotation @ centres[:, :, None])], axis=2)
    return replace(network, cam_from_world=pose, xyz=scale * network.xyz @ turn.T + shift)
