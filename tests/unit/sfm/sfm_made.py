"""Pictures of one textured wall from several places, and matches without error made by COLMAP."""

import cv2
import numpy as np
import pycolmap

from courtside.sfm import database, features

EXTRACTION = {"max_features": 600, "first_octave": 0, "focal_factor": 1.2}
LENS = [
    700.0,
    705.0,
    321.0,
    238.0,
    -0.05,
    0.01,
    1e-3,
    -5e-4,
]  # fx fy cx cy k1 k2 p1 p2, COLMAP's pixels


def texture(seed, size=(480, 360)):
    """Return a grey picture with blobs of all sizes."""
    rng = np.random.default_rng(seed)
    total = np.zeros(size[::-1])
    for sigma in (1.5, 3, 6, 12):
        smooth = cv2.GaussianBlur(rng.normal(size=size[::-1]), (0, 0), sigma)
        total += smooth / smooth.std()
    return np.clip(128 + 35 * total, 0, 255).astype(np.uint8)


def view(at, seed=0, size=(320, 240)):
    """Return the wall seen from place `at`: it slides by and tilts."""
    slant = 2e-4 * at
    matrix = np.array([[1, 0.01 * at, -30.0 - 12 * at], [0, 1, -40 - 3 * at], [slant, 0, 1]])
    return cv2.warpPerspective(texture(seed), matrix, size, flags=cv2.INTER_CUBIC)


def write(folder, pictures):
    """Write pictures by name below a folder."""
    for name, picture in pictures.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        assert cv2.imwrite(str(path), picture)


def wall(folder, count=4):
    """Write views of one wall of two cameras, and one of another wall; return their groups."""
    names = tuple(f"walk/{at:03d}.png" for at in range(count))
    write(folder, {name: view(at) for at, name in enumerate(names)})
    write(folder, {"static/side.png": view(1.5), "static/other.png": view(0, seed=99)})
    fixed = [features.Group(name, (f"static/{name}.png",)) for name in ("side", "other")]
    return [*fixed, features.Group("walk", names)]


def synthetic(path, seed=1, n_points=150, n_images=6):
    """Write a database of exact matches and return the model that it comes from."""
    options = pycolmap.SyntheticDatasetOptions(
        num_rigs=1, num_frames_per_rig=n_images, num_points3D=n_points
    )
    options.camera_width, options.camera_height = 640, 480
    options.camera_model_id, options.camera_params = pycolmap.CameraModelId.OPENCV, LENS
    options.camera_has_prior_focal_length = True
    options.num_points2D_without_point3D = 0
    options.two_view_geometry_has_relative_pose = True
    pycolmap.set_random_seed(seed)
    with database.new(path) as temporary, pycolmap.Database.open(temporary) as opened:
        return pycolmap.synthesize_dataset(options, opened)


def centres(model):
    """Return the places of a model's images by name."""
    return {image.name: image.projection_center() for image in model.images.values()}
