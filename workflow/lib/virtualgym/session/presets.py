"""What a virtual gymnasium and its cameras are like: kind (`rich`) or hostile (`plain`)."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Preset:
    """Everything in which one kind of virtual session differs from another.

    Attributes
    ----------
    name : str
    posters_per_m : float
        Posters along each metre of wall.
    n_gear : int
        Boxes, benches, bags and mats that are tried on the floor; those in the way are left out.
    contrast : float
        Of every texture but the court's lines, against its own mean colour; 1 is a well-lit old hall.
    n_scuffs : int
        Marks on the floor.
    gloss : float
        Share of light that the floor reflects when seen from above, 0..1; much more at grazing angles.
    same_windows : bool
        Whether all windows show the same picture in the same spacing.
    noise_sigma : float
        Of the sensor, in 8-bit levels.
    crf : int
        Quality of H.264 coding, lower is better.
    readout_s : float
        Between the first and the last row of the walked camera's rolling shutter.
    exposure_s : float
        Of the walked camera.
    jitter_scale : float
        Size of the hand's movements against those of a careful walker.
    stabiliser_px : float
        How far a stabiliser moves the principal point, standard deviation, px at 1280 px width.
    focal_spread : float
        Difference between units of one model of camera: focal length, relative standard deviation.
    principal_point_px : float
        The same for the principal point, px at 1280 px width, per axis.
    k1_spread, k2_spread, p_spread : float
        The same for the coefficients of distortion; `p_spread` for p1 and p2.
    n_people : int
        Walking about while the walk is filmed.
    line_sigma_m : float
        How far each painted line is from its place.
    post_foot_sigma_m, post_tip_sigma_m : float
        How far a post's foot is from its place, and its tip from above the foot, per axis.
    click_sigma_px_at_3840, click_bias_px_at_3840 : float
        Scatter of clicks per axis, and of what all clicks of one person have in common; px at 3840 px width.
    """

    name: str
    posters_per_m: float
    n_gear: int
    contrast: float
    n_scuffs: int
    gloss: float
    same_windows: bool
    noise_sigma: float
    crf: int
    readout_s: float
    exposure_s: float
    jitter_scale: float
    stabiliser_px: float
    focal_spread: float
    principal_point_px: float
    k1_spread: float
    k2_spread: float
    p_spread: float
    n_people: int
    line_sigma_m: float
    post_foot_sigma_m: float
    post_tip_sigma_m: float
    click_sigma_px_at_3840: float
    click_bias_px_at_3840: float


RICH = Preset(
    name="rich",
    posters_per_m=0.5,
    n_gear=170,
    contrast=1.0,
    n_scuffs=400,
    gloss=0.05,
    same_windows=False,
    noise_sigma=1.7,
    crf=18,
    readout_s=0.010,
    exposure_s=0.004,
    jitter_scale=0.7,
    stabiliser_px=0.0,
    focal_spread=0.003,
    principal_point_px=3.0,
    k1_spread=0.002,
    k2_spread=0.001,
    p_spread=1e-4,
    n_people=0,
    line_sigma_m=0.003,
    post_foot_sigma_m=0.003,
    post_tip_sigma_m=0.008,
    click_sigma_px_at_3840=0.7,
    click_bias_px_at_3840=0.5,
)
PLAIN = Preset(
    name="plain",
    posters_per_m=0.05,
    n_gear=22,
    contrast=0.4,
    n_scuffs=120,
    gloss=0.13,
    same_windows=True,
    noise_sigma=4.5,
    crf=26,
    readout_s=0.020,
    exposure_s=0.010,
    jitter_scale=1.0,
    stabiliser_px=3.0,
    focal_spread=0.006,
    principal_point_px=6.0,
    k1_spread=0.004,
    k2_spread=0.002,
    p_spread=3e-4,
    n_people=4,
    line_sigma_m=0.003,
    post_foot_sigma_m=0.003,
    post_tip_sigma_m=0.008,
    click_sigma_px_at_3840=0.7,
    click_bias_px_at_3840=0.5,
)
PRESETS = {preset.name: preset for preset in (RICH, PLAIN)}
