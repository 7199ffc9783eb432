"""Settings of a virtual gymnasium and its cameras: easy (`rich`) or hard (`plain`)."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Preset:
    """The settings in which one kind of virtual session differs from another.

    Attributes
    ----------
    name : str
    posters_per_m : float
        Posters along each metre of wall.
    n_gear : int
        Boxes, benches, bags and mats that are drawn for the floor; those in the way are left out.
    contrast : float
        Factor on every texture except the court's lines, about its own mean colour; 1: a well-lit
        old hall.
    n_scuffs : int
        Scuff marks on the floor.
    gloss : float
        Share of light that the floor reflects when seen from above, 0..1; much more at grazing
        angles.
    same_windows : bool
        Whether all windows show the same picture in the same spacing.
    noise_sigma : float
        Standard deviation of the sensor's noise, 8-bit levels.
    crf : int
        Constant rate factor of the H.264 coding; lower is better.
    readout_s : float
        Time from the first to the last row of the rolling shutter.
    exposure_s : float
    jitter_scale : float
        Factor on the hand movements of the walked camera; 1: a careful walker.
    stabiliser_px : float
        Standard deviation of the principal point's shift by a stabiliser, px at 1280 px width.
    focal_spread : float
        Relative standard deviation of the focal length between cameras of one model.
    principal_point_px : float
        Standard deviation of the principal point between them, per axis, px at 1280 px width.
    k1_spread, k2_spread, p_spread : float
        Standard deviations of the distortion coefficients; `p_spread` of p1 and p2.
    n_people : int
        Bystanders who walk about while the walk is filmed.
    line_sigma_m : float
        Standard deviation of each painted line's displacement.
    post_foot_sigma_m, post_tip_sigma_m : float
        Standard deviations of a post's foot from its nominal place, and of its tip from above the
        foot, per axis.
    click_sigma_px_at_3840, click_bias_px_at_3840 : float
        Standard deviations per axis of single clicks, and of the error that all clicks of one
        person share; px at a longer side of 3840 px.
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


# ASSUME: both sets of values were chosen as a good and a bad case of real halls and phone cameras;
# no source is recorded.
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
