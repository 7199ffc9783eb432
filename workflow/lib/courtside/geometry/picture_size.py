"""How a video's picture is related to the calibrated one, by their sizes alone.

A cut-out keeps the scale, a scaled copy keeps the shape, a turned picture exchanges width and
height. Sizes alone do not tell a cut-out of the same shape from a scaled copy: a scaled copy is the
likelier, since programs offer sizes of one shape.
"""

from collections.abc import Sequence
from dataclasses import dataclass

# ASSUME: a video at least this large in both directions is a cut-out: programs that scale take
# steps of a tenth or more, encoders and lens corrections cut less.
CUT_OUT = 0.95


@dataclass(frozen=True)
class Relation:
    """What was done to the calibrated picture before it became the video's."""

    kind: str  # `same`, `cut out`, `scaled`, `cut out and scaled`, or `turned`
    # Of the cut-out's picture, the place unknown: (0, 0, width, height) px; None where all is kept
    crop_px: tuple[int, int, int, int] | None = None
    scale: float | None = None  # video px per calibrated px; None where it is 1

    @property
    def keys(self) -> str:
        """The keys of a camera that say so, as YAML; empty where none can."""
        keys = []
        if self.crop_px:
            keys.append(f"crop_px: {list(self.crop_px)}")
        if self.scale:
            keys.append(f"scale: {self.scale:g}")
        return ", ".join(keys)


def relation(calibrated: Sequence[int], video: Sequence[int]) -> Relation:
    """Guess how a video of (width, height) px is related to a picture calibrated at another."""
    (full_w, full_h), (w, h) = calibrated, video
    if (w, h) == (full_w, full_h):
        return Relation("same")
    one_side = (w == full_w and h < full_h) or (h == full_h and w < full_w)
    if not one_side and _is_turned(calibrated, video):
        return Relation("turned")
    scale = _scale(calibrated, video)
    if scale is not None:
        return Relation("scaled", scale=scale)
    least, most = sorted((w / full_w, h / full_h))
    if one_side or CUT_OUT <= least < most < 1:
        return Relation("cut out", crop_px=(0, 0, w, h))
    size = (min(full_w, round(w / most)), min(full_h, round(h / most)))
    scale = _scale(size, video) or most
    return Relation("cut out and scaled", crop_px=(0, 0, *size), scale=scale)


def scaled_size(size: Sequence[int], scale: float) -> tuple[int, int]:
    """Return the (width, height) of a scaled picture: whole pixels."""
    width, height = (max(1, round(length * scale)) for length in size)
    return width, height


def advice(calibrated: Sequence[int], video: Sequence[int]) -> str:
    """Return what a user is to do about a video that has not the calibrated size, in words."""
    found = relation(calibrated, video)
    if found.kind == "same":
        return "the video shows all of it: remove `crop_px` and `scale` of this camera"
    if found.kind == "turned":
        return (
            "it is turned by a quarter: export the video turned as it was when it was calibrated, "
            "or calibrate again with pictures turned as the video is"
        )
    if found.kind == "scaled":
        return (
            f"if it is a scaled copy, declare `{found.keys}` for this camera in the session file; "
            "if it is a cut-out, `crop_px: [x, y, width, height]`"
        )
    if found.kind == "cut out":
        _, _, width, height = found.crop_px or (0, 0, *video)
        return (
            f"if it is a cut-out, declare `crop_px: [x, y, {width}, {height}]` for this camera in "
            "the session file, else calibrate at the video's size"
        )
    return (
        f"if it is a cut-out that was scaled, declare `{found.keys}` for this camera in the "
        "session file (x and y of the cut-out put right), else calibrate at the video's size"
    )


def _scale(size: Sequence[int], video: Sequence[int]) -> float | None:
    """Return the shortest decimal by which a size becomes that of a video; None if none does."""
    near = (video[0] + video[1]) / (size[0] + size[1])
    for digits in range(1, 6):
        for each in (round(near, digits), round(video[0] / size[0], digits)):
            if each > 0 and scaled_size(size, each) == tuple(video):
                return each
    return None


def _is_turned(calibrated: Sequence[int], video: Sequence[int]) -> bool:
    """Say whether width and height are exchanged, up to a scale and a narrow strip cut off."""
    (full_w, full_h), (w, h) = calibrated, video
    if (full_w > full_h) == (w > h) or full_w == full_h or w == h:
        return False
    least, most = sorted((w / full_h, h / full_w))
    return least >= CUT_OUT * most
