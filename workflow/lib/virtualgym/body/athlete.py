"""A virtual athlete: a body that moves, with or without a racket."""

import numpy as np

from virtualgym.body import pose_bones
from virtualgym.body import racket as rackets
from virtualgym.body.mesh import Mesh, join

KEPT = 1024  # times whose bones are kept, 20 kB each


class Athlete:
    """A body, its motion and its racket.

    Attributes
    ----------
    body : virtualgym.body.skinned_body.Body
    motion : object
        Has `stance(time_s)`, a `virtualgym.body.stance.Stance`.
    has_racket : bool
    """

    def __init__(self, body, motion, racket=True):
        """Let a body move.

        Parameters
        ----------
        body : virtualgym.body.skinned_body.Body
        motion : object
        racket : bool
            Held where the motion has one: its stances say in which hand, and how it points.
        """
        first = motion.stance(0.0)
        self.motion = motion
        self.has_racket = racket and first.racket is not None
        self.hand = first.racket_hand if self.has_racket else None
        self.body = body.gripping(self.hand)
        if self.has_racket:
            self._racket = rackets.build()
            self._grip = pose_bones.grip(body.figure, body.skeleton, self.hand)
        self._kept = {}

    def mesh(self, time_s):
        """Return the surface at a time, world, metres, as a `Mesh`: body, then racket."""
        stance, bones = self._bones(time_s)
        surface = Mesh(self.body.skinned(bones), self.body.triangles, self.body.colours)
        if not self.has_racket:
            return surface
        butt, way = self._butt(stance, bones)
        wrist = "wrist" + pose_bones.SUFFIX[self.hand]
        palm = bones.rotation[wrist] @ self.body.skeleton.palms[self.hand]
        return join([surface, rackets.place(self._racket, butt, way, palm)])

    def joints(self, time_s):
        """Return the joints (J, 3) at a time, world, metres, in the order of `skinned_body.JOINTS`."""
        return self.body.joints(self._bones(time_s)[1])

    def racket(self, time_s):
        """Return top and butt (2, 3) at a time, world, metres; NaN without a racket."""
        if not self.has_racket:
            return np.full((2, 3), np.nan)
        butt, way = self._butt(*self._bones(time_s))
        return np.stack([butt + rackets.LENGTH_M * way, butt])

    def _butt(self, stance, bones):
        way = np.asarray(stance.racket, dtype=float)
        held = bones.at("wrist" + pose_bones.SUFFIX[self.hand], self._grip)
        return held - rackets.HELD_AT_M * way, way

    def _bones(self, time_s):
        """Return stance and bones; those of the last times are kept, for several cameras see one time."""
        if time_s not in self._kept:
            if len(self._kept) == KEPT:
                del self._kept[next(iter(self._kept))]
            stance = self.motion.stance(time_s)
            self._kept[time_s] = stance, pose_bones.pose(self.body.skeleton, stance)
        return self._kept[time_s]
