"""A photogrammetric network of images, lenses, points and observations, with its derivatives.

Conventions: pixels with the first pixel's centre at (0, 0); world metres; `cam_from_world` maps
world to camera. An image from a moving camera has five more numbers, its *flex*: the rotation of
the camera while the rolling shutter ran from the first to the last row (3, rad, camera frame), and
the shift of the principal point by the image stabiliser (2, px). They are zero for a camera on a
tripod.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.geometry import camera, rotations

LENS = ("f_px", "aspect", "cx_px", "cy_px", "k1", "k2", "p1", "p2")
POSE = ("rx_rad", "ry_rad", "rz_rad", "tx_m", "ty_m", "tz_m")
FLEX = ("wx_rad", "wy_rad", "wz_rad", "shift_x_px", "shift_y_px")
IMAGE = len(POSE) + len(FLEX)
# Fields of `Network` by what they have an entry for; the first of each tells how many there are.
PER_IMAGE = ("cam_from_world", "flex", "lens_of_image", "height_px", "flex_sigma")
PER_LENS = ("lens", "lens_mean", "lens_sigma")
PER_POINT = ("xyz", "xyz_mean", "xyz_sigma")
PER_VIEW = ("xy", "image_idx", "point_idx", "sigma_px", "loss_scale")


@dataclass(frozen=True, eq=False)
class Network:
    """State, observations and prior knowledge of images, lenses and points."""

    cam_from_world: NDArray  # (V, 3, 4)
    flex: NDArray  # (V, 5)
    lens: NDArray  # (L, 8): in the order of `LENS`; focal length f along y, f times aspect along x
    xyz: NDArray  # (N, 3)
    lens_of_image: NDArray  # (V,) int
    height_px: NDArray  # (V,): of the picture: a row is read at (row + 0.5) / height - 0.5
    image_idx: NDArray  # (M,) int: of each observation
    point_idx: NDArray  # (M,) int
    xy: NDArray  # (M, 2): observed px
    sigma_px: (
        NDArray  # (M, 2): standard deviation of an observation along x and y; given (M,): both
    )
    loss_scale: NDArray  # (M,): scale of the Cauchy loss, in the observation's sigmas; inf: no loss
    flex_sigma: NDArray  # (V, 5): prior about 0; 0 keeps a number at 0
    lens_mean: NDArray  # (L, 8): prior
    lens_sigma: NDArray  # (L, 8): inf: unknown; 0: known exactly
    xyz_mean: NDArray  # (N, 3): prior of points
    xyz_sigma: NDArray  # (N,): inf: unknown

    def __post_init__(self) -> None:
        if np.ndim(self.sigma_px) == 1:
            both = np.repeat(np.asarray(self.sigma_px)[:, None], 2, axis=1)
            object.__setattr__(self, "sigma_px", both)
        for first, *others in (PER_IMAGE, PER_LENS, PER_POINT, PER_VIEW):
            object.__setattr__(self, first, np.asarray(getattr(self, first)))
            length = len(getattr(self, first))
            for name in others:
                object.__setattr__(self, name, np.asarray(getattr(self, name)))
                found = len(getattr(self, name))
                if found != length:
                    raise ValueError(f"expected {name} of length {length}, found {found}")

    @property
    def n_columns(self) -> int:
        """Number of image and lens parameters."""
        return IMAGE * len(self.cam_from_world) + len(LENS) * len(self.lens)

    def columns(self) -> NDArray:
        """Return the columns of each observation, (M, 19): those of its image, then of its lens."""
        image = IMAGE * self.image_idx[:, None] + np.arange(IMAGE)
        first = IMAGE * len(self.cam_from_world) + len(LENS) * self.lens_of_image[self.image_idx]
        return np.concatenate([image, first[:, None] + np.arange(len(LENS))], axis=1)

    def over_columns(self, by_camera: NDArray) -> NDArray:
        """Return derivatives by `columns` (M, 2, 19) as those by all columns of the network."""
        whole = np.zeros((len(by_camera), 2, self.n_columns))
        np.put_along_axis(whole, self.columns()[:, None, :].repeat(2, axis=1), by_camera, axis=2)
        return whole

    def moved(self, step: NDArray, step_xyz: NDArray) -> "Network":
        """Return the network after a step of its image and lens parameters, and of its points."""
        images, lenses = np.split(step, [IMAGE * len(self.cam_from_world)])
        images = images.reshape(-1, IMAGE)
        turn = rotations.rotation_from_rodrigues(images[:, :3])
        pose = turn @ self.cam_from_world
        pose[:, :, 3] += images[:, 3:6]
        return replace(
            self,
            cam_from_world=pose,
            flex=self.flex + images[:, 6:],
            lens=self.lens + lenses.reshape(-1, len(LENS)),
            xyz=self.xyz + step_xyz,
        )

    def difference(self, reference: "Network") -> NDArray:
        """Return the step of images and lenses from a reference network to this one."""
        turn = self.cam_from_world[:, :, :3] @ reference.cam_from_world[:, :, :3].transpose(0, 2, 1)
        shift = self.cam_from_world[:, :, 3] - np.einsum(
            "vij,vj->vi", turn, reference.cam_from_world[:, :, 3]
        )
        images = np.concatenate(
            [
                rotations.rodrigues_from_rotation(turn, valid=True),
                shift,
                self.flex - reference.flex,
            ],
            axis=1,
        )
        return np.concatenate([images.ravel(), (self.lens - reference.lens).ravel()])


def without_points(
    cam_from_world: NDArray,
    lens: NDArray,
    height_px: ArrayLike,
    lens_of_image: ArrayLike | None = None,
) -> Network:
    """Return V images without flex, points or prior; by default each has a lens of its own."""
    n_images, nothing = len(cam_from_world), np.zeros(0)
    return Network(
        cam_from_world=cam_from_world,
        flex=np.zeros((n_images, len(FLEX))),
        lens=lens,
        xyz=np.zeros((0, 3)),
        lens_of_image=np.asarray(range(n_images) if lens_of_image is None else lens_of_image, int),
        height_px=np.asarray(height_px, dtype=float),
        image_idx=nothing.astype(int),
        point_idx=nothing.astype(int),
        xy=np.zeros((0, 2)),
        sigma_px=nothing,
        loss_scale=nothing,
        flex_sigma=np.zeros((n_images, len(FLEX))),
        lens_mean=lens,
        lens_sigma=np.full(np.shape(lens), np.inf),
        xyz_mean=np.zeros((0, 3)),
        xyz_sigma=nothing,
    )


def with_points(
    network: Network, xyz: NDArray, image_idx: NDArray, point_idx: NDArray, xy: NDArray
) -> Network:
    """Return a network with other points (N, 3) that have observations but no prior.

    All M observations, `xy` (M, 2) px, have a sigma of 1 px and no loss.
    """
    return replace(
        network,
        xyz=xyz,
        xyz_mean=np.zeros_like(xyz),
        xyz_sigma=np.full(len(xyz), np.inf),
        image_idx=image_idx,
        point_idx=point_idx,
        xy=xy,
        sigma_px=np.ones(len(xy)),
        loss_scale=np.full(len(xy), np.inf),
    )


@dataclass(frozen=True, eq=False)
class Seen:
    """The point of each observation, as its camera sees it."""

    still: NDArray  # (M, 3): in the camera frame at mid-exposure
    in_cam: NDArray  # (M, 3): in the camera frame when its row is read
    normalised: NDArray  # (M, 2): on the plane z = 1
    distorted: NDArray  # (M, 2): the same after lens distortion
    residual: NDArray  # (M, 2): predicted minus observed, px; NaN where it lies behind the image


def see(network: Network) -> Seen:
    """Return the points of all observations as their cameras see them."""
    pose = network.cam_from_world[network.image_idx]
    still = np.einsum("mij,mj->mi", pose[:, :, :3], network.xyz[network.point_idx]) + pose[:, :, 3]
    in_cam = still + rotations.cross(_spin(network), still)
    depth = np.where(in_cam[:, 2:] > 1e-6, in_cam[:, 2:], np.nan)
    normalised = in_cam[:, :2] / depth
    lens = _lens(network)
    distorted = camera.distort(_coefficients(lens), normalised)
    shift = network.flex[network.image_idx, 3:]
    predicted = _focal(lens) * distorted + lens[:, 2:4] + shift
    return Seen(still, in_cam, normalised, distorted, predicted - network.xy)


def residuals(network: Network) -> NDArray:
    """Return predicted minus observed, (M, 2) px; NaN where a point lies behind its image."""
    return see(network).residual


def linearised(network: Network, seen: Seen | None = None) -> tuple[NDArray, NDArray, NDArray]:
    """Return `residuals`, with derivatives by `columns` (M, 2, 19) and by point (M, 2, 3).

    `seen` is what `see` returned for this network, where that is known.
    """
    seen = seen or see(network)
    lens = _lens(network)
    # Of the point in the camera's frame.
    by_place = _focal(lens)[:, :, None] * camera.jacobian_by_place(
        _coefficients(lens), seen.normalised, seen.in_cam[:, 2:]
    )
    # Before the shutter's turn: r @ (I + [spin]) = r + r x spin.
    by_still = by_place + rotations.cross(by_place, _spin(network)[:, None, :])
    rotation = network.cam_from_world[network.image_idx, :, :3]
    by_camera = np.zeros((len(by_still), 2, IMAGE + len(LENS)))
    by_camera[:, :, :3] = rotations.cross(
        seen.still[:, None, :], by_still
    )  # by_still @ -[x]: rows crossed
    by_camera[:, :, 3:6] = by_still
    turned = rotations.cross(seen.still[:, None, :], by_place)
    by_camera[:, :, 6:9] = turned * _row_time(network)[:, None, None]
    by_camera[:, 0, 9] = by_camera[:, 1, 10] = 1.0
    by_camera[:, :, IMAGE:] = _by_lens(lens, seen.normalised, seen.distorted)
    return seen.residual, by_camera, by_still @ rotation


def _by_lens(lens: NDArray, normalised: NDArray, distorted: NDArray) -> NDArray:
    x, y = normalised.T
    square = x * x + y * y
    f, aspect = lens[:, 0], lens[:, 1]
    along = np.zeros((len(lens), 2, len(LENS)))
    along[:, 0, 0], along[:, 1, 0] = aspect * distorted[:, 0], distorted[:, 1]
    along[:, 0, 1] = f * distorted[:, 0]
    along[:, 0, 2] = along[:, 1, 3] = 1.0
    for column, (dx, dy) in enumerate(
        [
            (x * square, y * square),
            (x * square**2, y * square**2),
            (2 * x * y, square + 2 * y * y),
            (square + 2 * x * x, 2 * x * y),
        ],
        start=4,
    ):
        along[:, 0, column], along[:, 1, column] = f * aspect * dx, f * dy
    return along


def _lens(network: Network) -> NDArray:
    """Return the lens of each observation, (M, 8)."""
    return network.lens[network.lens_of_image[network.image_idx]]


def _focal(lens: NDArray) -> NDArray:
    return lens[:, :1] * np.stack([lens[:, 1], np.ones(len(lens))], axis=1)


def _coefficients(lens: NDArray) -> NDArray:
    return np.concatenate([lens[:, 4:], np.zeros((len(lens), 1))], axis=1).T


def _spin(network: Network) -> NDArray:
    return network.flex[network.image_idx, :3] * _row_time(network)[:, None]


def _row_time(network: Network) -> NDArray:
    return (network.xy[:, 1] + 0.5) / network.height_px[network.image_idx] - 0.5
