"""A virtual athlete: a body that moves, with or without a racket."""

from collections.abc import Mapping
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from virtualgym.body import pose_bones
from virtualgym.body import racket as rackets
from virtualgym.body.mesh import Mesh, join
from virtualgym.body.pose_bones import Posed
from virtualgym.body.skinned_body import Body
from virtualgym.body.stance import Stance

KEPT = 1024  # cached times; 20 kB each, so 20 MB per athlete


class Moving(Protocol):
    """A motion: the stance at each time, and the times of named events."""

    @property
    def events(self) -> Mapping[str, float]:
        """Times of named events, s."""
        ...

    def stance(self, time_s: float) -> Stance:
        """Return the pose at a time."""
        ...


class Athlete:
    """A body, its motion and its racket."""

    def __init__(self, body: Body, motion: Moving, racket: bool = True) -> None:
        """Let a body move.

        Parameters
        ----------
        body : Body
        motion : Moving
        racket : bool
            Whether the athlete holds a racket if the motion's stances have one.
        """
        first = motion.stance(0.0)
        self.motion = motion
        self.has_racket = racket and first.racket is not None
        self.hand = first.racket_hand if self.has_racket else None
        self.body = body.gripping(self.hand)
        if self.has_racket:
            self._racket = rackets.build()
            self._grip = pose_bones.grip(body.figure, body.skeleton, first.racket_hand)
            self._wrist = "wrist" + pose_bones.SUFFIX[first.racket_hand]
            self._palm = self.body.skeleton.palms[first.racket_hand]
        self._kept: dict[float, tuple[Stance, Posed]] = {}

    def mesh(self, time_s: float) -> Mesh:
        """Return the surface at a time, world, metres: body, then racket."""
        stance, bones = self._bones(time_s)
        surface = Mesh(self.body.skinned(bones), self.body.triangles, self.body.colours)
        if not self.has_racket:
            return surface
        butt, way = self._butt(stance, bones)
        palm = bones.rotation[self._wrist] @ self._palm
        return join([surface, rackets.place(self._racket, butt, way, palm)])

    def joints(self, time_s: float) -> NDArray:
        """Return the joints (J, 3) of `skinned_body.JOINTS` at a time, world, metres."""
        return self.body.joints(self._bones(time_s)[1])

    def racket(self, time_s: float) -> NDArray:
        """Return top and butt (2, 3) at a time, world, metres; NaN without a racket."""
        if not self.has_racket:
            return np.full((2, 3), np.nan)
        butt, way = self._butt(*self._bones(time_s))
        return np.stack([butt + rackets.LENGTH_M * way, butt])

    def _butt(self, stance: Stance, bones: Posed) -> tuple[NDArray, NDArray]:
        way = np.asarray(stance.racket, dtype=float)
        held = bones.at(self._wrist, self._grip)
        return held - rackets.HELD_AT_M * way, way

    def _bones(self, time_s: float) -> tuple[Stance, Posed]:
        """Return stance and bones, cached for the other cameras that film the same time."""
        if time_s not in self._kept:
            if len(self._kept) == KEPT:
                del self._kept[next(iter(self._kept))]
            stance = self.motion.stance(time_s)
            self._kept[time_s] = stance, pose_bones.pose(self.body.skeleton, stance)
        return self._kept[time_s]
