"""A virtual colour and depth camera: where it stands, what its sensors are, and the frames it takes."""

from dataclasses import dataclass

import numpy as np

from courtside.geometry import camera, rotations
from courtside.virtual import backdrop, depth_casting, depth_errors, filming, layouts

TURN_DEG = (
    0.15,
    -0.2,
    0.1,
)  # of the depth sensor's axes in the colour sensor's: no factory is exact
GRAIN, NOISE = range(2)  # independent streams of random numbers
FIELD, FRAMES = range(2)  # of each


@dataclass(frozen=True)
class DepthCamera:
    """What makes a colour and depth camera, by default Intel's D415 by its sheet [Homma2023, B1].

    Attributes
    ----------
    distance_m : float
        From the player, over the floor.
    height_m : float
        Above the floor.
    azimuth_deg : float
        Round the player, from where they face at first, to their left.
    aim_m : float
        Height on the player's axis at which it looks.
    size_px, depth_size_px : (int, int)
        Width and height of the colour and of the depth frames; the second as the first where None.
    rate_hz : float
        Frames per second by its own clock; colour and depth are taken together.
    fov_deg : (float, float)
        Across and down, of both sensors.
    baseline_m : float
        Between the two imagers whose pictures are matched: depth is as the left one sees it.
    subpixel_px : float
        Standard deviation s of a disparity: depth z scatters by z^2 s / (f b).
    correlation_px : float
        Standard deviation of the window over which errors of depth are alike, as matching blocks makes them.
    depth_unit_m : float
        Of one step of depth.
    range_m : (float, float)
        Beyond it there are holes.
    edge_px : float
        How far from a jump of depth matches may fail.
    edge_holes, holes : float
        Share of the pixels without depth there, and elsewhere; new in each frame.
    colour_from_depth_m : (3,) float
        Place of the depth sensor's centre in the colour sensor's axes.
    readout_s, exposure_s : float
        Of both rolling shutters, as `filming.Film` has them.
    noise_sigma : float
        Of the colour sensor, 8-bit levels.
    subject : str or None
        Whom it looks at; None: the first player.
    """

    distance_m: float = 3.0
    height_m: float = 1.0
    azimuth_deg: float = 0.0
    aim_m: float = 1.0
    size_px: tuple = (640, 360)
    depth_size_px: tuple | None = None
    rate_hz: float = 30.0
    fov_deg: tuple = (69.4, 42.5)
    baseline_m: float = 0.055
    subpixel_px: float = 0.08
    correlation_px: float = 1.5
    depth_unit_m: float = 0.001
    range_m: tuple = (0.3, 10.0)
    edge_px: float = 1.5
    edge_holes: float = 0.5
    holes: float = 0.003
    colour_from_depth_m: tuple = (0.015, 0.0, 0.0)
    readout_s: float = 0.016
    exposure_s: float = 0.006
    noise_sigma: float = 2.0
    subject: str | None = None

    def __post_init__(self):
        for name in ("size_px", "fov_deg", "range_m", "colour_from_depth_m"):
            object.__setattr__(self, name, tuple(getattr(self, name)))
        object.__setattr__(self, "depth_size_px", tuple(self.depth_size_px or self.size_px))
        for name in ("distance_m", "rate_hz", "baseline_m", "depth_unit_m"):
            if not getattr(self, name) > 0:
                raise ValueError(f"expected {name} above 0, found {getattr(self, name)}")
        if not 0 < self.range_m[0] < self.range_m[1]:
            raise ValueError(f"expected range_m as [near, far], found {list(self.range_m)}")

    @property
    def colour_from_depth(self):
        """From the depth sensor's axes to the colour sensor's, (3, 4), metres."""
        turn = rotations.rotation_from_rodrigues(np.radians(TURN_DEG))
        return np.column_stack([turn, self.colour_from_depth_m])

    def errors(self):
        """Return the `depth_errors.DepthErrors`."""
        focal_px = self._focal_px(self.depth_size_px)[0]
        return depth_errors.DepthErrors(
            focal_baseline=focal_px * self.baseline_m,
            subpixel_px=self.subpixel_px,
            correlation_px=self.correlation_px,
            unit_m=self.depth_unit_m,
            range_m=self.range_m,
            edge_px=self.edge_px,
            edge_holes=self.edge_holes,
            holes=self.holes,
        )

    def place(self, name, player):
        """Set it up before a player.

        Parameters
        ----------
        name : str
        player : courtside.virtual.athlete.Athlete
            It looks at where they are at the start of their motion.

        Returns
        -------
        colour, depth : courtside.geometry.camera.Camera
            In the world.
        """
        start = player.motion.stance(0.0)
        middle, ahead = start.pelvis[:2], start.world_from_pelvis[:2, 2]
        angle = np.arctan2(ahead[1], ahead[0]) + np.radians(self.azimuth_deg)
        away = self.distance_m * np.array([np.cos(angle), np.sin(angle)])
        pose = layouts.look_at([*(middle + away), self.height_m], [*middle, self.aim_m])
        depth = self._camera(f"{name}-depth", self.depth_size_px, pose)
        turn, shift = self.colour_from_depth[:, :3], self.colour_from_depth[:, 3]
        moved = np.column_stack([turn @ pose[:, :3], turn @ pose[:, 3] + shift])
        return self._camera(name, self.size_px, moved), depth

    def _focal_px(self, size_px):
        return np.array(size_px) / 2 / np.tan(np.radians(self.fov_deg) / 2)

    def _camera(self, name, size_px, pose):
        across, down = self._focal_px(size_px)
        width, height = size_px
        matrix = np.array([[across, 0, (width - 1) / 2], [0, down, (height - 1) / 2], [0, 0, 1]])
        return camera.Camera(name, size_px, matrix, np.zeros(5), pose)


class Recorder:
    """A camera in a hall, ready to film athletes.

    Parameters
    ----------
    settings : DepthCamera
    colour, depth : courtside.geometry.camera.Camera
        From `DepthCamera.place`.
    renderer : courtside.virtual.renderer.Renderer
        Of the hall.
    athletes : list of athlete.Athlete
    seed : numpy.random.SeedSequence
        Of noise and holes.
    """

    def __init__(self, settings, colour, depth, renderer, athletes, seed):
        self.settings, self.athletes, self._seed = settings, athletes, seed
        hall = backdrop.look(renderer, colour)
        self._film = filming.Film(hall, settings.readout_s, settings.exposure_s)
        self._depth, self._hall_m = depth, depth_casting.of_hall(renderer, depth)
        self._grain = filming.Grain(colour.size, settings.noise_sigma, self._rng(GRAIN, FIELD))
        self._sensor = depth_errors.Sensor(settings.errors(), depth.size, self._rng(NOISE, FIELD))

    def frame(self, index, time_s):
        """Take a frame.

        Parameters
        ----------
        index : int
            Its number, of which noise depends.
        time_s : float
            Mid-exposure of the middle row, on the athletes' clock.

        Returns
        -------
        bgr : (H, W, 3) uint8
        depth : (h, w) uint16
        """
        picture = self._film.picture(self.athletes, time_s)
        bgr = self._grain.added(picture, self._rng(GRAIN, FRAMES, index))
        rng = self._rng(NOISE, FRAMES, index)
        return bgr, self._sensor.measured(self.true_depth_m(time_s), rng)

    def true_depth_m(self, time_s):
        """Return how far in front of the depth sensor everything really is, (h, w) float32; inf: nothing."""
        readout_s = self.settings.readout_s
        bodies = depth_casting.of_athletes(self.athletes, self._depth, time_s, readout_s)
        return np.minimum(bodies, self._hall_m)

    def _rng(self, *key):
        seed = np.random.SeedSequence(self._seed.entropy, spawn_key=(*self._seed.spawn_key, *key))
        return np.random.default_rng(seed)
