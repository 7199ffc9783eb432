"""An athlete: a mesh, joints and a racket that belong together at any time."""

from dataclasses import dataclass

import numpy as np
import pytest

from fixtures.people import mannequin
from virtualgym.body import athlete, racket, skinned_body
from virtualgym.body.stance import Stance


@dataclass
class Turning:
    """Someone who turns on the spot, and counts how often it is asked."""

    hand: str = "right"
    has_racket: bool = True
    asked: int = 0

    def stance(self, time_s):
        self.asked += 1
        way = np.array([0.3 * np.cos(time_s), 0.5, 0.6])
        held = way / np.linalg.norm(way) if self.has_racket else None
        stance = mannequin.stance(racket=held, racket_hand=self.hand)
        turn = np.array(
            [[np.cos(time_s), -np.sin(time_s), 0], [np.sin(time_s), np.cos(time_s), 0], [0, 0, 1]]
        )
        turned = {
            name: turn @ getattr(stance, name)
            for name in ("world_from_pelvis", "world_from_thorax", "world_from_head")
        }
        directions = {name: turn @ way for name, way in stance.directions.items()}
        return Stance(**{**vars(stance), **turned, "directions": directions})


def player(**options):
    return athlete.Athlete(mannequin.dressed(), Turning(**options))


@pytest.mark.parametrize("hand", ["left", "right"])
def test_the_racket_is_674_mm_long_and_in_its_hand(hand):
    found = player(hand=hand)
    for time_s in (0.0, 0.7, 2.0):
        top, butt = found.racket(time_s)
        assert np.linalg.norm(top - butt) == pytest.approx(0.674)
        way = found.motion.stance(time_s).racket
        np.testing.assert_allclose((top - butt) / 0.674, way, atol=1e-12)
        joints = dict(zip(skinned_body.JOINTS, found.joints(time_s), strict=True))
        held = butt + racket.HELD_AT_M * way
        assert np.linalg.norm(held - joints[f"rig_{hand}_hand"]) < 0.05
        assert np.linalg.norm(held - joints[f"{hand}_wrist"]) < 0.13


def test_the_mesh_ends_where_top_and_butt_are():
    found = player()
    surface = found.mesh(0.4)
    n_body = len(found.body.rest)
    top, butt = found.racket(0.4)
    vertices = surface.vertices[n_body:]
    along = (vertices - butt) @ (top - butt) / 0.674
    assert along.min() == pytest.approx(0, abs=1e-5) and along.max() == pytest.approx(
        0.674, abs=1e-4
    )
    assert np.linalg.norm(vertices[along > 0.672] - top, axis=1).max() < 0.03
    assert surface.triangles.shape == surface.colours.shape


def test_an_athlete_without_a_racket_has_nan_ends_and_open_hands():
    for found in (
        athlete.Athlete(mannequin.dressed(), Turning(), racket=False),
        player(has_racket=False),
    ):
        assert np.isnan(found.racket(0.0)).all() and found.racket(0.0).shape == (2, 3)
        assert len(found.mesh(0.0).vertices) == len(mannequin.dressed().rest)
        assert found.body is mannequin.dressed()


def test_joints_lie_inside_the_surface_of_their_limbs():
    found = player()
    surface, joints = found.mesh(1.1).vertices, found.joints(1.1)
    for name, joint in zip(skinned_body.JOINTS[:12], joints[:12], strict=True):
        near = surface[np.linalg.norm(surface - joint, axis=1) < 0.16]
        for axis in np.eye(3):
            sides = (near - joint) @ axis
            assert sides.min() < -0.01 < 0.01 < sides.max(), name


def test_one_time_is_posed_once_and_another_anew():
    found = player()
    start = found.motion.asked
    first = found.mesh(0.2).vertices
    found.joints(0.2), found.racket(0.2)
    assert found.motion.asked == start + 1
    assert np.abs(found.mesh(0.5).vertices - first).max() > 0.01
    np.testing.assert_array_equal(found.mesh(0.2).vertices, first)
