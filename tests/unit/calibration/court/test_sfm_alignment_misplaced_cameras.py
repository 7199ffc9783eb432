"""Exchanged camera files, and cameras at the wrong end, are told from other faults of clicks."""

from functools import partial
from pathlib import Path

import numpy as np
import pytest

from courtside.calibration.court import (
    click_checks,
    court,
    joint_adjustment,
    quality,
    sfm_alignment,
)
from courtside.geometry import camera as cameras
from courtside.geometry import similarity
from courtside.study.errors import InputError
from fixtures.cameras import networks_made
from fixtures.cameras.scene import look_at, opencv_projection

COURT = court.read(Path(__file__).parents[4] / "config" / "courts" / "badminton.yaml")
SFM_FROM_WORLD = similarity.Sim3(0.4, np.eye(3)[[1, 2, 0]], np.array([1.0, 2, 3]))
PLACES = {
    "side": (-18, 6.7, 1.9), "back": (3.05, -14.3, 2.1), "corner": (-9, -7, 5.0),
    "far": (14, 22, 4.0),
}  # fmt: skip


def in_sfm(names):
    matrix = np.array([[1120.0, 0, 639.5], [0, 1120, 359.5], [0, 0, 1]])
    made = [
        cameras.Camera(n, (1280, 720), matrix, np.zeros(5), look_at(PLACES[n], (3.05, 6.7, 1)))
        for n in names
    ]
    return [SFM_FROM_WORLD.camera(camera) for camera in made]


def clicks_of(fixed, noise_px=0.3, xyz=COURT.xyz):
    rng, seen = np.random.default_rng(0), SFM_FROM_WORLD.points(xyz)
    return {c.name: opencv_projection(c, seen) + noise_px * rng.normal(size=(18, 2)) for c in fixed}


@pytest.mark.parametrize(
    ("names", "pair"),
    [
        (("side", "back"), ("side", "back")),
        (("side", "back", "corner"), ("side", "back")),
        (("side", "back", "corner"), ("back", "corner")),
    ],
)
def test_two_exchanged_cameras_are_named(names, pair):
    fixed = in_sfm(names)
    clicks = clicks_of(fixed)
    one, other = pair
    clicks[one], clicks[other] = clicks[other], clicks[one]
    check = partial(click_checks.check, sigma_px=0.3, table=None)
    for refuse in (sfm_alignment.refuse_misplaced_cameras, check):
        with pytest.raises(InputError, match="the camera files may be exchanged") as caught:
            refuse(COURT, fixed, clicks)
        message = str(caught.value)
        assert message.startswith(f"cameras {one} and {other}: expected") and "\n" not in message


def half_a_turn(camera):
    """Return a camera of the model where the court seems to be seen from the other end."""
    turn = np.diag([-1.0, -1, 1])
    about = similarity.Sim3(1.0, turn, np.array([*COURT.size_m, 0.0]))
    return SFM_FROM_WORLD.camera(about.camera(SFM_FROM_WORLD.inverse().camera(camera)))


@pytest.mark.parametrize("wrong", [("far",), ("corner",), ("side", "far")])
def test_cameras_that_the_walk_joined_to_the_wrong_end_are_named(wrong):
    fixed = in_sfm(["side", "back", "corner", "far"])
    clicks = clicks_of(fixed)
    joined = [half_a_turn(one) if one.name in wrong else one for one in fixed]
    with pytest.raises(InputError, match="both ends of the hall look alike") as caught:
        sfm_alignment.refuse_misplaced_cameras(COURT, joined, clicks)
    message = str(caught.value)
    named = set(message.partition(":")[0].replace(",", "").split()[1:])
    others = {one.name for one in fixed} - set(wrong)
    assert named == set(wrong) or (len(wrong) == 2 and named == others)  # relative to each other
    assert "close beside" in message and "\n" not in message


def test_points_named_from_the_other_end_in_one_camera_are_told_as_such():
    fixed = in_sfm(["side", "back", "corner"])
    clicks = clicks_of(fixed)
    clicks["back"] = clicks["back"][np.argsort(COURT.other_end())]
    with pytest.raises(InputError, match=r"camera back: .* named from the other end"):
        sfm_alignment.refuse_misplaced_cameras(COURT, fixed, clicks)


def mirrored(clicks):
    left = COURT.xyz.copy()
    left[:, 0] = 6.1 - left[:, 0]
    other = [int(np.linalg.norm(COURT.xyz - place, axis=1).argmin()) for place in left]
    return {name: xy[other] for name, xy in clicks.items()}


def wrong_click(clicks):
    clicks["back"][5] += 80
    return clicks


def shuffled(clicks):
    order = np.random.default_rng(1).permutation(18)
    return {name: xy[order] for name, xy in clicks.items()}


def few(clicks):
    return {name: np.where(np.arange(18)[:, None] < 2, xy, np.nan) for name, xy in clicks.items()}


@pytest.mark.parametrize("tamper", [dict, mirrored, wrong_click, shuffled, few])
@pytest.mark.parametrize("names", [("side", "back", "corner"), ("side", "back")])
def test_no_other_fault_is_taken_for_an_exchange(tamper, names):
    fixed = in_sfm(names)
    sfm_alignment.refuse_misplaced_cameras(COURT, fixed, tamper(clicks_of(fixed)))


def test_another_court_is_not_taken_for_an_exchange():
    tennis = court.read(Path(__file__).parents[4] / "config" / "courts" / "tennis.yaml")
    fixed = in_sfm(["side", "back"])
    sfm_alignment.refuse_misplaced_cameras(tennis, fixed, clicks_of(fixed))
    with pytest.raises(
        InputError, match=r"tennis \(10.97 m by 23.77 m\).* give the right court file"
    ):
        sfm_alignment.check(tennis, sfm_alignment.reconstruct(fixed, clicks_of(fixed)))


WEIGHTS = {"click_sigma_px": 2.0, "click_bias_px": 0.0, "click_loss": 3.0}


def tied(seed):
    """Return weak ties of two cameras, their true cameras, and right clicks."""
    truth = networks_made.exact_lens_prior(networks_made.make(4, 30, noise_px=1.0))
    rng, names = np.random.default_rng(seed), ("side", "back")
    fixed = networks_made.fixed_cameras(truth, names)
    right = {
        c.name: opencv_projection(c, COURT.xyz) + 0.7 * rng.normal(size=(18, 2)) for c in fixed
    }
    ties, _ = joint_adjustment.condense(
        truth,
        {"side": 0, "back": 1},
        dict.fromkeys(names, networks_made.SIZE),
        right,
        COURT,
        images_per_part=100,
        tie_sigma_px=4.0,
        tie_loss=np.inf,
        click_sigma_px=2.0,
        click_loss=3.0,
        min_angle_deg=0,
        max_error_px=1e3,
        max_points=10**6,
        seed=0,
    )
    return ties, fixed, right


@pytest.mark.parametrize("seed", [0, 1])
def test_cameras_that_the_exchanged_clicks_have_bent_are_judged_after_adjustment(seed):
    """Weak ties leave the cameras to the wrong clicks: the right ones fit only after another."""
    ties, _, right = tied(seed)
    clicks = {"side": right["back"], "back": right["side"]}
    with pytest.raises(InputError, match=r"cameras side and back: .* files may be exchanged"):
        quality.adjust_and_check(COURT, ties, clicks, **WEIGHTS)
    _, checked = quality.adjust_and_check(COURT, ties, right, **WEIGHTS)
    assert checked["warnings"] == []
    assert 0.1 < checked["expected_volume_rms_cm"] < 10 and checked["volume_seen"] == 1


@pytest.mark.parametrize("wrong", ["side", "back"])
def test_of_two_cameras_the_one_named_from_the_other_end_is_told(wrong):
    ties, _, right = tied(0)
    clicks = {**right, wrong: COURT.turned(right[wrong])}
    with pytest.raises(InputError, match=f"^camera {wrong}: .* after half a turn .* alone"):
        quality.adjust_and_check(COURT, ties, clicks, **WEIGHTS)


@pytest.mark.parametrize("names", [("corner", "far"), ("side", "far"), ("back", "far")])
def test_of_two_cameras_that_nothing_bends_either_may_be_named_from_the_other_end(names):
    fixed = in_sfm(names)
    clicks = clicks_of(fixed)
    clicks["far"] = COURT.turned(clicks["far"])
    with pytest.raises(InputError, match=f"^camera {' or '.join(names)}: .* 1 cm off after half"):
        sfm_alignment.refuse_misplaced_cameras(COURT, fixed, clicks)


def test_both_causes_are_told_where_two_cameras_look_alike_from_both_ends():
    fixed = in_sfm(["side", "back"])
    clicks = clicks_of(fixed)
    clicks["back"] = COURT.turned(clicks["back"])
    with pytest.raises(InputError, match=r"may be exchanged; .* side or back alone fits as well"):
        sfm_alignment.refuse_misplaced_cameras(COURT, fixed, clicks)


def test_a_camera_of_whose_points_several_are_of_another_court_is_named():
    """Their own scatter hides each of them: no single click is told."""
    ties, (_, back), right = tied(0)
    other = opencv_projection(back, np.add(COURT.xyz, (8.0, 0, 0)))
    far = COURT.xyz[:, 1] > 9
    clicks = {**right, "back": np.where(far[:, None], other, right["back"])}
    _, checked = quality.adjust_and_check(COURT, ties, clicks, **WEIGHTS)
    (line,) = checked["warnings"]
    assert line.startswith("camera back: expected its clicks to fit the walk")
    assert "points of another court" in line


def test_a_turn_that_leaves_no_other_camera_the_points_is_none():
    """All cameras were clicked on one half of the court: its other end shows nobody's points."""
    fixed = in_sfm(["side", "back", "corner"])
    clicks = clicks_of(fixed)
    clicks["back"] = mirrored(clicks)["back"]
    half = COURT.xyz[:, 1] < 6.7
    clicks = {name: np.where(half[:, None], xy, np.nan) for name, xy in clicks.items()}
    sfm_alignment.refuse_misplaced_cameras(COURT, fixed, clicks)


def beside(fixed, wrong, by_m):
    """Return clicks of which those of some cameras are of a court so far beside the right one."""
    other = clicks_of(fixed, xyz=np.add(COURT.xyz, (*by_m, 0.0)))
    return {**clicks_of(fixed), **{name: other[name] for name in wrong}}


@pytest.mark.parametrize("half", [False, True])
@pytest.mark.parametrize("by_m", [(8.1, 0.0), (-8.1, 0.0)])
@pytest.mark.parametrize("wrong", ["side", "back", "corner"])
def test_a_camera_that_is_clicked_on_the_court_beside_is_named(wrong, by_m, half):
    """With clicks on one half of the court alone, too: its file was blamed, or nothing was told."""
    fixed = in_sfm(["side", "back", "corner"])
    clicks = beside(fixed, [wrong], by_m)
    use = (COURT.xyz[:, 1] < 6.7)[:, None] | (not half)
    clicks = {name: np.where(use, xy, np.nan) for name, xy in clicks.items()}
    for refuse in (
        sfm_alignment.refuse_misplaced_cameras,
        partial(click_checks.check, sigma_px=0.3, table=None),
    ):
        with pytest.raises(InputError, match=rf"^camera {wrong}: expected .* m beside ") as caught:
            refuse(COURT, fixed, clicks)
        said = str(caught.value)
        found = [float(said.partition(f"along {a} ")[2].split(" m")[0]) for a in "xy"]
        np.testing.assert_allclose(found, by_m, atol=0.4)
        assert "click the same court in all cameras" in said and "\n" not in said


@pytest.mark.parametrize("wrong", [("side", "back"), ("back", "far"), ("corner", "far")])
def test_two_of_four_cameras_that_are_clicked_on_the_court_beside_are_told_from_the_others(wrong):
    names = ("side", "back", "corner", "far")
    fixed = in_sfm(names)
    with pytest.raises(InputError, match=r"a court 8\.[01] m beside that of") as caught:
        sfm_alignment.refuse_misplaced_cameras(COURT, fixed, beside(fixed, wrong, (8.1, 0.0)))
    said = str(caught.value)
    others = tuple(name for name in names if name not in wrong)
    either = [f"cameras {', '.join(a)}: " in said and f"of {', '.join(b)} (along" in said
              for a, b in ((wrong, others), (others, wrong))]  # fmt: skip
    assert any(either)  # which of the two courts is meant, nothing tells


def test_cameras_that_the_clicks_beside_have_bent_are_judged_without_these_clicks():
    fixed = in_sfm(["side", "back", "corner"])
    clicks = beside(fixed, ["back"], (8.1, 0.0))
    bent = [cameras.turned(one, (0.01, 0.01, 0.0)) for one in fixed]

    def adjust(used):
        return bent if np.isfinite(used["back"]).any() else fixed

    with pytest.raises(InputError, match=r"^camera back: .* beside that of side, corner .*8\.1 m"):
        sfm_alignment.refuse_misplaced_cameras(COURT, bent, clicks, adjust)


def test_of_two_cameras_the_court_beside_is_among_the_causes():
    fixed = in_sfm(["side", "back"])
    clicks = beside(fixed, ["back"], (8.1, 0.0))
    with pytest.raises(InputError, match=r"or click the same court in all cameras$"):
        click_checks.check(COURT, fixed, clicks, sigma_px=0.3, table=None)


def test_a_single_camera_and_few_clicks_are_not_taken_for_clicks_of_the_court_beside():
    fixed = in_sfm(["side", "back", "corner"])
    clicks = beside(fixed, ["back"], (8.1, 0.0))
    sfm_alignment.refuse_misplaced_cameras(COURT, fixed[:1], clicks)
    sfm_alignment.refuse_misplaced_cameras(COURT, fixed, few(clicks))
    clicks["back"][3:] = np.nan
    sfm_alignment.refuse_misplaced_cameras(COURT, fixed, clicks)
