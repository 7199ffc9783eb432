"""How wrong the world is: what real halls and cameras do and the estimator does not know of."""

from collections.abc import Mapping
from dataclasses import dataclass, fields

STRONGEST = 2.0


@dataclass(frozen=True)
class World:
    """Strength of each effect: 0 is off, 1 realistic, 2 twice as much.

    Attributes
    ----------
    lens : float
        Terms of all lenses that no calibration here estimates, `cameras.lens_errors`.
    breathing : float
        The walked camera's focal length changes with its focus, `cameras.walk_path.BREATH`.
    stabiliser : float
        A stabiliser bends the rows of the walk's frames, `cameras.row_warp`; none without one.
    shutter : float
        Each camera has a readout time of its own, `rendering.lamps.readout`.
    flicker : float
        Lamps flicker and cameras adapt their exposure, `rendering.lamps`.
    court : float
        Lines and posts stand off the court's file, `hall.painted_lines.misplacement`.
    hall : float
        Size, colours and patterns of the hall, `hall.look`.
    drift : float
        Tripods creep between the pictures of the empty court and the end of a take,
        `cameras.camera_shake.CREEP_PX`.
    """

    lens: float = 0.0
    breathing: float = 0.0
    stabiliser: float = 0.0
    shutter: float = 0.0
    flicker: float = 0.0
    court: float = 0.0
    hall: float = 0.0
    drift: float = 0.0

    def __post_init__(self) -> None:
        for effect in EFFECTS:
            strength = getattr(self, effect)
            if not isinstance(strength, int | float) or not 0 <= strength <= STRONGEST:
                raise ValueError(
                    f"expected a strength of world.{effect} in 0..{STRONGEST:g}, found {strength!r}"
                )


EFFECTS = tuple(field.name for field in fields(World))


def build(world: "World | Mapping[str, float]") -> World:
    """Return a world from {effect: strength}; a `ValueError` if an effect is unknown."""
    if isinstance(world, World):
        return world
    strange = sorted(set(world) - set(EFFECTS))
    if strange:
        raise ValueError(f"expected effects of {list(EFFECTS)}, found {strange}")
    return World(**world)
