"""Joint centres by landmarks of the skin: of limbs made for it, and of all bodies of the gym."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import sparse

from fixtures.people import mannequin
from virtualgym.body import joint_centres, makehuman, shapes

# A limb hangs down from its upper joint, is bent a little at the middle one, and bends forwards.
BONES = tuple(
    bone + suffix
    for suffix in (".L", ".R")
    for hinge in joint_centres.HINGES.values()
    for bone in hinge[:3]
)
SIDES = (".L", ".R")
LENGTH_M, ROUND, N_RINGS = 0.4, 48, 86
ABOVE_M = 0.05  # a limb's skin begins so far above its upper joint
HALF_DEPTH_M = 0.04
HALF_WIDTH_M = {"upperleg01": 0.05, "upperarm01": 0.035}
X_M = {"upperleg01": 0.12, "upperarm01": 0.5}
HIP_M = 0.18  # half the width over the trochanters
TALL_M = 1.6
CAP_M = 0.87  # a shoulder's skin is flat there, above the arm that begins at 0.8


def tube(x, top, half_width, middle):
    """Return vertices and triangles of a limb whose cross-sections are ellipses about `middle`."""
    turn = np.linspace(0, 2 * np.pi, ROUND, endpoint=False)
    levels = np.linspace(top + ABOVE_M, top - 2 * LENGTH_M, N_RINGS)
    rings = [
        np.column_stack(
            [x + half_width * np.cos(turn), np.full(ROUND, y), middle + HALF_DEPTH_M * np.sin(turn)]
        )
        for y in levels
    ]
    at = np.arange(N_RINGS - 1)[:, None] * ROUND + np.arange(ROUND)
    beside = np.arange(N_RINGS - 1)[:, None] * ROUND + np.roll(np.arange(ROUND), -1)
    triangles = [[at, beside, at + ROUND], [beside, beside + ROUND, at + ROUND]]
    return np.concatenate(rings), np.concatenate(
        [np.stack(corners, axis=-1).reshape(-1, 3) for corners in triangles]
    )


@pytest.fixture(scope="module")
def limbs():
    """Return a figure of four limbs whose middle joints are 15 mm in front of their middles."""
    # Points over the trochanters and the crown, for the height, with a triangle of their own.
    vertices = [np.array([[HIP_M, 0.79, 0.0], [-HIP_M, 0.79, 0.0], [0, TALL_M, 0]])]
    triangles, heads = [np.array([[0, 1, 2]])], {}
    for suffix, sign in ((".L", 1), (".R", -1)):
        for above, at, below, _ in joint_centres.HINGES.values():
            x, top = sign * X_M[above], 0.8
            points, faces = tube(x, top, HALF_WIDTH_M[above], middle=0.01)
            triangles.append(faces + sum(map(len, vertices)))
            vertices.append(points)
            if above == "upperarm01":
                cap = np.array([[-0.1, 0, -0.1], [0.1, 0, -0.1], [0, 0, 0.2]])
                triangles.append(np.array([[0, 1, 2]]) + sum(map(len, vertices)))
                vertices.append(cap + np.array([x, CAP_M, 0]))
            places = [[x, top, 0.01], [x, top - LENGTH_M, 0.025], [x, top - 2 * LENGTH_M, 0.01]]
            heads |= dict(zip((above + suffix, at + suffix, below + suffix), places, strict=True))
    skin, points = np.concatenate(triangles), np.concatenate(vertices)
    places = np.array([heads[bone] for bone in BONES], dtype=float)
    return makehuman.Figure(
        vertices=points,
        triangles=skin,
        is_eye=np.zeros(len(skin), bool),
        bones=BONES,
        parents=np.full(len(BONES), -1),
        heads=places,
        tails=places,
        weights=sparse.csr_matrix((len(points), len(BONES))),
    )


def test_a_hinge_is_in_the_middle_of_where_the_limb_is_widest(limbs):
    found = joint_centres.anatomical(limbs)
    for _, at, _, _ in joint_centres.HINGES.values():
        for suffix in (".L", ".R"):
            rig = limbs.head(at + suffix)
            np.testing.assert_allclose(found.head(at + suffix), [rig[0], rig[1], 0.01], atol=5e-4)


def test_hips_are_a_quarter_of_the_trochanters_distance_inside_and_7_6_mm_less(limbs):
    found = joint_centres.anatomical(limbs)
    for suffix, sign in ((".L", 1), (".R", -1)):
        rig = limbs.head("upperleg01" + suffix)
        expected = [sign * (HIP_M / 2 + 0.0076), rig[1]]
        np.testing.assert_allclose(found.head("upperleg01" + suffix)[:2], expected, atol=1e-9)


def test_hips_are_two_fifths_of_the_depth_of_the_body_behind_its_front(limbs):
    found = joint_centres.anatomical(limbs)
    for suffix in (".L", ".R"):
        front, back = 0.01 + HALF_DEPTH_M, 0.01 - HALF_DEPTH_M
        expected = 0.6 * front + 0.4 * back
        assert found.head("upperleg01" + suffix)[2] == pytest.approx(expected, abs=5e-4)


def test_shoulders_lie_on_the_line_of_the_arm_48_mm_of_a_body_of_1_75_m_below_the_skin(limbs):
    found = joint_centres.anatomical(limbs)
    for suffix, sign in ((".L", 1), (".R", -1)):
        deep = CAP_M - 0.048 / 1.75 * TALL_M
        expected = [sign * X_M["upperarm01"], deep, 0.01]
        np.testing.assert_allclose(found.head("upperarm01" + suffix), expected, atol=5e-4)


def test_other_joints_stay(limbs):
    found = joint_centres.anatomical(limbs)
    for bone in ("foot.L", "wrist.R"):
        np.testing.assert_array_equal(found.head(bone), limbs.head(bone))
    assert found.vertices is limbs.vertices


def bend_deg(figure, bones):
    above, at, below = (figure.head(f"{bone}.L") for bone in bones)
    thigh, shank = at - above, below - at
    return np.degrees(np.arccos(thigh @ shank / np.linalg.norm(thigh) / np.linalg.norm(shank)))


def hip_deg(figure):
    """Return how far a hip is in front of the line from shoulder to knee, seen from the side."""
    bones = ("upperarm01.L", "upperleg01.L", "lowerleg01.L")
    shoulder, hip, knee = (figure.head(bone)[1:] for bone in bones)
    (down, ahead), (further, along) = hip - shoulder, knee - hip
    return np.degrees(np.arctan2(ahead, -down) - np.arctan2(along, -further))


@pytest.mark.parametrize("name", shapes.BODIES)
def test_upper_arms_have_the_share_of_the_height_that_those_of_people_have(name):
    figure, shape = mannequin.figure(name), shapes.BODIES[name]
    upper = [figure.head("upperarm01" + side) - figure.head("lowerarm01" + side) for side in SIDES]
    of_people = {"m": 281.7 / 1741, "f": 275.1 / 1735}[shape.sex]  # de Leva 1996, table 4
    share = np.linalg.norm(upper, axis=1) / shape.height_m / of_people
    assert (np.abs(share - 1) < 0.085).all()  # the rig's: 0.87 to 0.94


@pytest.mark.parametrize("name", shapes.BODIES)
def test_bodies_stand_with_nearly_straight_knees_and_hips_as_people_have_them(name, monkeypatch):
    shape = replace(shapes.BODIES[name], seed=99)  # not from the cache
    figure = shapes.figure(mannequin.folder(), shape)
    monkeypatch.setattr(joint_centres, "anatomical", lambda given: given)
    rig = shapes.figure(mannequin.folder(), replace(shape, seed=98))
    leg = joint_centres.HINGES["knee"][:3]
    assert bend_deg(figure, leg) < min(6, bend_deg(rig, leg) - 2)
    assert abs(hip_deg(figure)) < 5
    # 16.7 cm in the model of a man of 1.80 m (Delp et al. 1990).
    apart_m = np.linalg.norm(figure.head("upperleg01.L") - figure.head("upperleg01.R"))
    assert 0.16 < apart_m < 0.21
    for bone in figure.bones:
        left = bone.endswith(".L")
        if left and bone[:-2] in ("upperleg01", "lowerleg01", "lowerarm01"):
            other = figure.head(bone[:-1] + "R")
            np.testing.assert_allclose(figure.head(bone) * [-1, 1, 1], other, atol=3e-3)
