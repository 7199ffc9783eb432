"""Where people could have been exchanged, and how sure it is that they were not."""

import numpy as np
import pytest

from courtside.reconstruction.association import identity
from courtside.reconstruction.association.appearance import Looks
from courtside.reconstruction.association.candidates import Candidates

TIMES = np.arange(60) * 0.1


def followed(paths, pieces, missing=()):
    """Return people on paths (K, N, 2) whose rows in one camera are of the pieces (K, N)."""
    count, n = paths.shape[:2]
    at = np.arange(count * n).reshape(count, n)
    xyz = np.concatenate([paths, np.ones((count, n, 1))], axis=2).reshape(-1, 3)
    made = Candidates(
        instant=np.tile(np.arange(n), count),
        xyz=xyz,
        direction=np.zeros_like(xyz),
        row=np.zeros((len(xyz), 1), int),
        sigma_m=np.full(len(xyz), 0.03),
        view_cost=np.zeros((len(xyz), 1)),
    )
    chosen = at.copy()
    for person, instants in missing:
        chosen[person, instants] = -1
    alone = np.full((count, n), -1)
    return identity.Followed(chosen, alone, made, np.asarray(pieces).reshape(-1, 1))


def lines(gap_m):
    """Return two people who pass each other."""
    x = np.linspace(-3, 3, 60)
    return np.stack([np.stack([x, 0 * x], axis=1), np.stack([-x, 0 * x + gap_m], axis=1)])


CUT = np.where(np.arange(60) < 30, 0, 1)
WHOLE = np.zeros(60, int)


def sizes(first, second, bones=4):
    """Return lengths (2, N, B) of two people, before and after the middle of the take."""
    found = np.empty((2, 60, bones))
    for person, size in enumerate((first, second)):
        found[person] = np.where(np.arange(60) < 30, size[0], size[1])[:, None]
    return found


def test_who_meets_nobody_has_no_doubts():
    people = followed(lines(3.0), [CUT, CUT + 5])
    assert identity.doubts(people, TIMES, sizes((1, 1), (1, 1))).shape == (0, 5)
    assert identity.confidence(np.zeros((0, 5)), 2).tolist() == [1, 1]


def test_a_tracklet_that_goes_through_a_meeting_makes_it_sure():
    people = followed(lines(0.3), [WHOLE, CUT + 5])
    found = identity.doubts(people, TIMES, sizes((1, 1), (1, 1)))
    assert found[:, 0].tolist() == [0, 1]
    assert found[:, 3].tolist() == [1, 0]
    assert found[0, 4] == identity.CARRIED > found[1, 4]
    assert found[1, 4] == pytest.approx(identity.MOTION)  # equal sizes say nothing
    start_s, stop_s = found[0, 1:3]
    assert start_s < TIMES[29] < stop_s and stop_s - start_s < 1.0


def test_sizes_say_whether_two_were_exchanged():
    people = followed(lines(0.3), [CUT, CUT + 5])
    kept = identity.doubts(people, TIMES, sizes((0.4, 0.4), (0.36, 0.36)))
    exchanged = identity.doubts(people, TIMES, sizes((0.4, 0.36), (0.36, 0.4)))
    assert kept[:, 4].min() > identity.MOTION > 0.7 > exchanged[:, 4].max()
    unknown = identity.doubts(people, TIMES, np.full((2, 60, 4), np.nan))
    assert unknown[:, 4].tolist() == pytest.approx([identity.MOTION] * 2)


def test_a_gap_is_a_doubt_with_who_could_be_there():
    missing = [(0, np.arange(20, 32))]
    found = identity.doubts(
        followed(lines(2.0), [CUT, CUT + 5], missing), TIMES, sizes((1, 1), (1, 1))
    )
    assert found[:, :4].tolist() == [[0, pytest.approx(1.9), pytest.approx(3.2), 1]]
    far = identity.doubts(
        followed(lines(40.0), [CUT, CUT + 5], missing), TIMES, sizes((1, 1), (1, 1))
    )
    assert far[0, 3] == -1


def found_again(gap_s, away_m, size=1.0, beside=(), looks=None):
    """Return the probability that who is found again at a distance is the same person."""
    last = 20 + round(gap_s * 10)
    x = np.where(np.arange(60) < last, 0.0, away_m)
    paths = np.stack([np.stack([x, 0 * x], axis=1), *beside])
    after = np.where(np.arange(60) < last, 1.0, size)[:, None] * [0.25, 0.28, 0.4, 0.42]
    lengths_m = np.stack([after, *(np.full_like(after, 0.35) for _ in beside)])
    pieces = np.arange(len(paths))[:, None] * 10 + np.where(np.arange(60) < last, 0, 1)
    people = followed(paths, pieces, [(0, np.arange(21, last))])
    return identity.doubts(people, TIMES, lengths_m, looks)[0, 4]


def test_a_stranger_may_come_after_a_long_gap_or_far_away():
    assert found_again(0.6, 0.5) > 0.95
    assert found_again(1.0, 1.0) > 0.9
    assert found_again(1.5, 6.0) < 0.9 and found_again(3.5, 1.0, np.nan) < 0.9
    near, far = ([found_again(gap, away) for gap in (0.6, 1.0, 1.5, 2.0)] for away in (0.5, 3.0))
    assert near == sorted(near, reverse=True)
    assert (np.array(far) < near).all()


def test_the_own_bones_say_whether_a_stranger_came():
    """Found again after a gap with bones a quarter shorter, as a child instead of an adult."""
    assert found_again(1.0, 1.0, 0.75) < 0.5 and found_again(3.5, 3.0, 0.75) < 0.2
    assert found_again(3.5, 3.0, 0.95) > 0.8
    assert found_again(1.0, 1.0, np.nan) < found_again(1.0, 1.0)


def test_the_same_bones_at_the_same_place_raise_no_question_after_any_gap():
    """Bones of one person differ by 1 % (median of development takes), those of two by 10 %."""
    assert min(found_again(gap, 0.0, 0.98) for gap in (0.6, 1.5, 2.5, 3.5)) > 0.9
    assert max(found_again(gap, 3.0, 0.9) for gap in (0.6, 1.5, 2.5, 3.5)) < 0.7


def test_a_stranger_may_come_while_somebody_else_is_there():
    beside = [np.tile([3.0, 3.0], (60, 1))]
    assert found_again(3.5, 3.0, np.nan, beside) < 0.9
    assert found_again(3.5, 3.0, 0.75, beside) < 0.2
    assert found_again(0.6, 0.5, beside=beside) > 0.9


def test_who_is_seen_elsewhere_throughout_a_gap_is_not_who_comes_back():
    far, lost = np.tile([6.0, 6.0], (60, 1)), np.tile([6.0, 6.0], (60, 1))
    lost[25:45] = np.nan
    passing = far.copy()
    passing[35] = 1.5, 0.0
    alone = found_again(3.5, 0.5, np.nan)
    assert found_again(3.5, 0.5, np.nan, [far]) == alone
    assert found_again(3.5, 0.5, np.nan, [lost]) < alone - 0.02
    assert found_again(3.5, 0.5, np.nan, [passing]) < alone - 0.02


def dressed(off, spread):
    """Return the looks of one person whose clothes change by `off` in the middle of the take."""
    worn = np.where(TIMES[:, None] < 4.0, 50.0, 50.0 + off) * np.ones((1, 1, 6))
    return Looks([worn], np.arange(60), np.full(6, 3.0), np.full(6, spread))


def test_the_clothes_say_whether_a_stranger_came():
    """After 3.5 s far away, with bones that say little."""
    unknown = found_again(3.5, 3.0, 0.95)
    same, other = (found_again(3.5, 3.0, 0.95, looks=dressed(off, 15.0)) for off in (3.0, 30.0))
    assert same > 0.9 > unknown > 0.8 > 0.6 > other
    # Where people dress alike, clothes say nothing.
    assert found_again(3.5, 3.0, 0.95, looks=dressed(3.0, 0.0)) == pytest.approx(unknown)


def test_confidence_is_the_product_over_doubts():
    rows = np.array([[0, 1, 2, 1, 0.9], [0, 3, 4, 1, 0.8], [1, 1, 2, 0, 0.5]])
    assert identity.confidence(rows, 3) == pytest.approx([0.72, 0.5, 1.0])
