"""The scale by stated heights and known lengths: assignment, errors, warnings."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.calibration.people import metric_scale, prior
from courtside.calibration.people.metric_scale import CORRECTED, SEEN, Body
from courtside.geometry import camera as camera_models
from courtside.geometry import triangulation
from courtside.geometry.similarity import Sim3
from courtside.study.errors import InputError
from fixtures.cameras import corner_cameras
from fixtures.people import tracks_made

WALK = tracks_made.persons()
UNITS_PER_M = 0.4  # the unit of these bodies is 2.5 m
TRUE = corner_cameras.four_cameras()
SMALL = [Sim3(UNITS_PER_M, np.eye(3), np.zeros(3)).camera(camera) for camera in TRUE]
LINE = np.array([[-1.0, 1.0, 0.0], [1.0, 1.0, 0.0]])
LINE_XY = np.stack([camera_models.project(camera, LINE) for camera in TRUE])
N_DRAWS = 2000
CLICK_PX = {"click_sigma_px": 2.0, "click_bias_px": 0.0}


def body(height_m, frames=100, first=0.0, last=10.0, take=0, tracklets=(), share=SEEN):
    """Return the body of somebody so tall."""
    length = UNITS_PER_M * share.mean * height_m
    return Body(take, length, frames, first, last, frozenset(tracklets))


def named(heights):
    """Return the heights of the persons of each take by names."""
    return {
        f"t{take}": {f"p{at}": height for at, height in enumerate(own, start=1)}
        for take, own in enumerate(heights, start=1)
    }


def test_a_body_is_as_long_in_every_posture():
    one, other = (metric_scale.length(xyz) for xyz in WALK)
    assert other / one == pytest.approx(tracks_made.SIZES[1] / tracks_made.SIZES[0], rel=0.01)
    assert np.isnan(metric_scale.length(WALK[0, :10]))


def test_heights_give_metres_the_tallest_to_the_longest():
    bodies, heights = [body(1.8), body(1.5), body(1.5, take=1)], [[1.5, 1.8], [1.5]]
    found = metric_scale.by_heights(bodies, named(heights))
    alone = metric_scale.by_heights(bodies[2:], named([[None, 1.8], [1.5]]))
    assert found.metres == pytest.approx(2.5) == alone.metres
    learned = SEEN.sigma / np.sqrt(metric_scale.LEARNED_FROM)
    least = np.hypot(metric_scale.BODIES_SIGMA, learned)
    assert least < found.sigma < alone.sigma
    assert not found.warnings and not found.remarks and not alone.warnings
    (remark,) = alone.remarks
    assert remark.startswith("only one person's height defines the scale; add a second person")


def test_bodies_without_the_network_s_offsets_have_a_share_of_their_own():
    heights = named([[1.8, 1.6]])
    seen, corrected = (
        metric_scale.by_heights([body(1.8, share=share), body(1.6, share=share)], heights, share)
        for share in (SEEN, CORRECTED)
    )
    assert corrected.metres == pytest.approx(seen.metres)
    assert corrected.sigma < 0.95 * seen.sigma


def test_two_tracks_of_one_person_are_not_two_persons():
    """The tracks seen most are both of the first person."""
    bodies = [
        body(1.80, 300, 0, 5),
        body(1.79, 280, 5, 10),
        body(1.60, 90, 0, 2),
        body(1.61, 80, 6, 9),
    ]
    found = metric_scale.by_heights(bodies, named([[1.6, 1.8]]))
    assert found.metres == pytest.approx(2.5, rel=0.01)
    assert not found.warnings


def test_somebody_else_beside_the_persons_has_no_height():
    bodies = [body(1.80, 300), body(1.65, 280), body(1.40, 100)]
    assert metric_scale.by_heights(bodies, named([[1.65, 1.8]])).metres == pytest.approx(
        2.5, rel=0.01
    )


def test_tracks_at_one_time_are_different_persons():
    """Apart in time, both would be of one person, and all would be 9 % longer."""
    tall = [body(1.8, 100, 0, 10), body(1.8, 100, 0, 10)]
    assert metric_scale.by_heights(tall, named([[1.8, 1.8]])).metres == pytest.approx(2.5)
    assert metric_scale.by_heights(tall, named([[1.65, 1.65]])).metres == pytest.approx(
        2.5 * 1.65 / 1.8
    )
    both = [body(1.70, 100, 0, 10), body(1.74, 100, 5, 10), body(1.72, 50, 0, 4)]
    found = metric_scale.by_heights(both, named([[1.74, 1.70]]))
    assert found.metres == pytest.approx(2.5, rel=0.01)


def test_tracks_that_share_a_tracklet_may_be_one_person():
    """One camera exchanged two people: both tracks are of the tall one, the other is not seen."""
    alone = body(1.85, take=1)
    exchanged = [body(1.84, tracklets={(0, 1), (1, 0)}), body(1.86, tracklets={(0, 1), (1, 1)})]
    found = metric_scale.by_heights([*exchanged, alone], named([[1.85, 1.65], [1.85]]))
    assert found.metres == pytest.approx(2.5, rel=0.005)
    (remark,) = found.remarks
    assert remark.startswith("only one person's height defines the scale")


def test_another_assignment_that_agrees_as_well_gives_a_warning():
    """Two bodies at different times and a third: the lower two or the upper two."""
    bodies = [body(1.6, 100, 0, 3), body(1.7, 100, 4, 7), body(1.8, 100, 8, 10)]
    found = metric_scale.by_heights(bodies, named([[1.7, 1.7 * 1.7 / 1.6]]))
    (warning,) = found.warnings
    assert warning.startswith("stated heights: another assignment of heights to persons agrees")


def test_heights_that_contradict_each_other_give_a_warning():
    (warning,) = metric_scale.by_heights([body(1.8), body(1.6)], named([[1.8, 1.7]])).warnings
    assert warning.startswith("stated heights disagree by 6.1 %: if 1.70 m is right, the person of")
    assert "1.80 m is 1.91 m tall" in warning


@pytest.mark.parametrize("stated", [[[1.66], [1.66, 1.84]], [[1.66], [1.66], [1.66, 1.84]]])
def test_a_track_and_a_person_that_are_both_left_over_give_a_warning(stated):
    """The tall person alone, then all of them: the one alone passes for the short one."""
    *alone, last = range(len(stated))
    bodies = [body(1.84, take=at) for at in alone]
    bodies += [body(height, take=last) for height in stated[last]]
    right = named([*([1.84] for _ in alone), stated[last]])
    beside = body(1.5, take=last)  # somebody who is no subject
    for shown in (bodies, [*bodies, beside]):
        found = metric_scale.by_heights(shown, right)
        assert found.metres == pytest.approx(2.5) and not found.warnings
        assert metric_scale.by_heights(shown, named(stated)).warnings
    warning = metric_scale.by_heights(bodies, named(stated)).warnings[-1]
    assert warning.startswith(f"stated heights: take t{last + 1} shows a person of 1.5")
    assert warning.endswith("check the heights, and who is in which take")


def test_many_persons_are_ordered_by_length():
    heights = [1.5 + 0.05 * at for at in range(7)]
    bodies = [body(one) for one in heights[::-1]]
    assert metric_scale.by_heights(bodies, named([heights])).metres == pytest.approx(2.5)


@pytest.mark.parametrize(
    ("heights", "found"),
    [
        ([[None]], "take t1 without the height of p1"),
        ([[1.7, None, None]], "take t1 without the height of p2, p3"),
        ([[1.7, 1.8]], "take t1 with 1 of these tracks for p1, p2"),
        ([[]], "take t1 with 1 of these tracks for nobody"),
        (
            [[None], [1.7]],
            "take t1 without the height of p1; take t2 with 0 of these tracks for p1",
        ),
    ],
)
def test_a_take_that_tells_no_scale_is_named_with_its_persons(heights, found):
    with pytest.raises(InputError, match=f"`height_m` of every person, .* found {found}; state"):
        metric_scale.by_heights([body(1.7)], named(heights))


def test_tracks_without_legs_or_trunk_are_not_counted():
    with pytest.raises(InputError, match="found take t1 with 0 of these tracks for p1;"):
        metric_scale.by_heights([body(np.nan)], named([[1.7]]))


def clicked(noise_px=0.0, seed=0, length_m=2.0, cameras=(0, 1, 2, 3)):
    """Return the line as some of the cameras see it."""
    xy = LINE_XY + noise_px * np.random.default_rng(seed).normal(size=LINE_XY.shape)
    xy[[at for at in range(4) if at not in cameras]] = np.nan
    stated = [{"points": ["left", "right"], "length_m": length_m}]
    (found,) = metric_scale.of_clicks(stated, ["left", "right"], xy, **CLICK_PX)
    return found


def by_length(cameras, known, shape=None):
    """Return the scale from one known length."""
    return metric_scale.by_lengths(cameras, [known], shape)[0][0]


@pytest.mark.parametrize("cameras", [(0, 1), (0, 1, 2, 3)])
def test_a_known_length_gives_metres_as_uncertain_as_its_clicks(cameras):
    assert by_length(SMALL, clicked(cameras=cameras)).metres == pytest.approx(2.5)
    noisy = [clicked(1.0, seed, cameras=cameras) for seed in range(N_DRAWS)]
    metres = 2.0 / lengths([one.xy for one in noisy])
    one = by_length(SMALL, noisy[0])
    assert one.metres == pytest.approx(metres[0])
    expected = np.linalg.norm(
        [np.std(metres / 2.5), metric_scale.KNOWN_SIGMA_M / 2.0, metric_scale.BEND_SIGMA]
    )
    assert one.sigma == pytest.approx(expected, rel=0.05)
    assert one.by == "left to right"


def test_a_length_that_two_of_four_cameras_show_errs_with_these_two():
    rng = np.random.default_rng(5)
    sizes = (
        4 * np.r_[np.tile([1e-3] * 3 + [1e-2] * 3 + [0.0] * 5, 4), np.tile([2.0] + [0.0] * 7, 4)]
    )
    root = rng.normal(size=(len(sizes),) * 2) / np.sqrt(len(sizes)) * sizes[:, None]
    shape = root @ root.T
    known, pair = clicked(cameras=(0, 1)), [*range(22), *range(44, 60)]
    alone = replace(known, xy=known.xy[:2])
    expected = by_length(SMALL[:2], alone, shape[np.ix_(pair, pair)]).sigma
    assert by_length(SMALL, known, shape).sigma == pytest.approx(expected, rel=1e-9)
    assert expected > 1.5 * by_length(SMALL, known).sigma


def lengths(clicks):
    """Return the lengths by the small cameras between both ends (C, 2, 2) px of each line."""
    ends = triangulation.triangulate_all(SMALL, np.concatenate(clicks, axis=1)).reshape(-1, 2, 3)
    return np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)


RACKET_M = 0.674
FIVE = np.array([[[0.3 * k - 0.6, 0.2 * k, z], [0.3 * k - 0.6, 0.2 * k, z + RACKET_M]]
                 for k, z in enumerate((0.0, 0.4, 0.8, 1.2, 0.6))])  # fmt: skip
RACKET_XY = np.stack([camera_models.project(camera, FIVE.reshape(-1, 3)) for camera in TRUE])


def racket(seed, scatter_px, bias_px):
    """Return known lengths of a racket, clicked at several places with these errors."""
    rng = np.random.default_rng(seed)
    names = [f"{end}{k}" for k in range(len(FIVE)) for end in ("top", "butt")]
    xy = RACKET_XY + scatter_px * rng.normal(size=RACKET_XY.shape)
    xy += bias_px * rng.normal(size=(len(TRUE), 1, 2))
    stated = [{"points": [f"top{k}", f"butt{k}"], "length_m": RACKET_M} for k in range(len(FIVE))]
    click = {"click_sigma_px": 2 * scatter_px, "click_bias_px": 2 * bias_px}  # of 3840 px width
    return metric_scale.of_clicks(stated, names, xy, **click)


@pytest.mark.parametrize(("scatter_px", "bias_px"), [(3.0, 0.0), (0.0, 6.0), (3.0, 3.0)])
def test_clicks_of_a_racket_at_several_places_err_together_as_stated(
    monkeypatch, scatter_px, bias_px
):
    """Over many draws the errors of five lengths have the stated covariance."""
    monkeypatch.setattr(metric_scale, "BEND_SIGMA", 0.0)
    monkeypatch.setattr(metric_scale, "KNOWN_SIGMA_M", 0.0)
    draws = [racket(seed, scatter_px, bias_px) for seed in range(N_DRAWS)]
    metres = RACKET_M / lengths([one.xy for draw in draws for one in draw]).reshape(N_DRAWS, -1)
    each, covariance = metric_scale.by_lengths(SMALL, draws[0])
    assert [one.metres for one in each] == pytest.approx(metres[0])
    off = np.log(metres / 2.5)
    largest = np.diag(covariance).max()
    np.testing.assert_allclose(np.cov(off.T), covariance, atol=0.1 * largest)
    assert np.std(off.mean(axis=1)) == pytest.approx(np.sqrt(covariance.mean()), rel=0.05)


def test_a_racket_at_several_places_is_as_certain_as_its_own_length_and_the_bend_allow():
    one, five = (
        metric_scale.find(SMALL, (), named([[None]]), racket(0, 3.0, 0.0)[:n]) for n in (1, 5)
    )
    common = np.hypot(metric_scale.KNOWN_SIGMA_M / RACKET_M, metric_scale.BEND_SIGMA)
    assert common < five.sigma < 0.7 * one.sigma
    assert five.by == "top0 to butt0 and 4 others"
    clicks = np.sqrt(five.sigma**2 - common**2) / np.sqrt(one.sigma**2 - common**2)
    assert clicks == pytest.approx(5**-0.5, abs=0.1)


def test_weights_follow_the_covariance_and_are_not_negative():
    scales = [metric_scale.Scale(metres, sigma, by) for metres, sigma, by in
             ((1.00, 0.02, "a"), (1.01, 0.02, "b"), (1.03, 0.05, "c"))]  # fmt: skip
    apart = metric_scale.combined(scales[:2], np.diag([4e-4, 4e-4]))
    assert apart.metres == pytest.approx(np.sqrt(1.01)) and apart.sigma == pytest.approx(2e-4**0.5)
    alike = metric_scale.combined(scales[:2], 4e-4 * np.array([[1.0, 0.99], [0.99, 1.0]]))
    assert alike.sigma == pytest.approx(0.02, rel=0.01)
    worse = np.array([[4e-4, 9e-4], [9e-4, 25e-4]])
    assert metric_scale.combined([scales[0], scales[2]], worse).metres == pytest.approx(1.0)


def test_the_shape_of_cameras_makes_a_known_length_less_certain():
    loose = prior.stated(
        SMALL, rotation_deg=0.1, position_m=0.01, focal_percent=1, principal_point_percent=1, k1=0
    ).of_columns()
    exact = by_length(SMALL, clicked())
    assert by_length(SMALL, clicked(), loose).sigma > 1.5 * exact.sigma


def test_a_known_length_counts_more_than_heights_and_stands_for_them():
    bodies = [body(1.80), body(1.60)]
    found = metric_scale.find(SMALL, bodies, named([[1.83, 1.63]]), [clicked()])
    assert found.metres == pytest.approx(2.5, rel=0.006)  # heights alone: 1.8 % off
    assert found.by == "left to right, stated heights"
    assert found.sigma < by_length(SMALL, clicked()).sigma
    assert not found.warnings
    without = metric_scale.find(SMALL, bodies, named([[None, 1.6]]), [clicked()])
    assert (without.metres, without.by) == (pytest.approx(2.5), "left to right")
    (warning,) = metric_scale.find(SMALL, bodies, named([[1.9, 1.69]]), [clicked()]).warnings
    assert warning.startswith("stated heights: expected a change of all lengths by 3.9 % at most")
    assert "found +4.7 %; check them against left to right" in warning
    told = metric_scale.find(SMALL, bodies, named([[1.9, 1.6]]), [clicked()]).warnings
    assert any(line.startswith("stated heights disagree by ") for line in told)


def test_heights_of_persons_who_are_not_seen_are_not_needed_beside_a_known_length():
    found = metric_scale.find(SMALL, [body(1.8)], named([[1.8, 1.6]]), [clicked()])
    assert (found.metres, found.by) == (pytest.approx(2.5), "left to right")


def test_a_known_length_without_clicks_is_named():
    with pytest.raises(InputError, match="known length left to right: expected both ends clicked"):
        by_length(SMALL, clicked(cameras=(1,)))
    with pytest.raises(
        InputError, match=r"length a to b: expected clicks of both .* none of b, on"
    ):
        metric_scale.of_clicks([{"points": ["a", "b"]}], ["a"], np.zeros((4, 1, 2)), **CLICK_PX)
