"""Frames and rates of the cameras of a take: what is wrong, what is odd, what is usual."""

import numpy as np
import pytest

from courtside.validation import lengths
from courtside.video.glance import Glance

SMALL = np.zeros((54, 96), np.uint8)


def said(synchronised, **cameras):
    """Return (faults, remarks) of cameras given as (frames, Hz)."""
    looks = {c: Glance((64, 48), SMALL, n, rate) for c, (n, rate) in cameras.items()}
    found = lengths.faults, lengths.remarks
    return tuple(list(say(looks, synchronised=synchronised)) for say in found)


@pytest.mark.parametrize("synchronised", [True, False])
@pytest.mark.parametrize(
    "cameras",
    [
        {"left": (600, 60.0), "right": (600, 60.0)},
        {"left": (600, 60.0), "right": (601, 60.0)},
        {"left": (100, 60.0), "right": (100, 59.94)},
        {"left": (600, 60.0), "right": (300, 30.0)},
        {"left": (600, 60.0), "right": (None, None)},
        {"left": (1, None), "right": (1, None)},
        {},
    ],
)
def test_what_is_usual_says_nothing(synchronised, cameras):
    assert said(synchronised, **cameras) == ([], [])


def test_a_wrong_rate_of_synchronised_cameras_is_a_fault():
    (fault,), _ = said(True, left=(600, 60.0), right=(600, 30.0), back=(600, 60.0))
    assert "found 60 Hz (left, back), 30 Hz (right)" in fault
    # 59.94 for 60: after a minute 3.6 frames apart.
    assert len(said(True, left=(3600, 60.0), right=(3600, 59.94))[0]) == 1


def test_unequal_lengths_of_synchronised_cameras_are_remarked():
    faults, (remark,) = said(True, left=(600, 60.0), right=(590, 60.0))
    assert faults == []
    assert "600 frames (left), 590 frames (right)" in remark
    assert said(False, left=(600, 60.0), right=(590, 60.0)) == ([], [])


def test_slow_motion_among_other_cameras_is_remarked():
    faults, (remark,) = said(False, left=(600, 60.0), right=(600, 30.0))
    assert faults == []
    assert "60 Hz (left), 30 Hz (right): does a file state a wrong rate" in remark


def test_irregular_frames_are_not_compared():
    looks = {"left": Glance((64, 48), SMALL, 600, 60.0)}
    looks["right"] = Glance((64, 48), SMALL, 600, 30.0, even=False)
    assert list(lengths.faults(looks, synchronised=True)) == []


def test_videos_too_short_to_find_their_clocks_by_are_named():
    looks = {c: Glance((64, 48), SMALL, n, 12.0) for c, n in (("left", 48), ("back", 24))}
    (fault,) = lengths.too_few(looks)
    assert "expected 30 frames or more" in fault and "found 24 (back)" in fault
    assert not list(lengths.too_few({"left": looks["left"]}))
    assert not list(lengths.too_few({"back": looks["back"]}))  # one camera has no other clock


def looked_at(**more):
    return {"left": Glance((64, 48), SMALL, 300, 30.0, **more)}


@pytest.mark.parametrize(("filmed_hz", "scale"), [(240.0, "0.125"), (2.0, "15")])
def test_a_phone_that_wrote_another_rate_than_it_filmed_is_a_fault(filmed_hz, scale):
    (fault,) = lengths.faults(looked_at(filmed_hz=filmed_hz), synchronised=False)
    assert f"camera left: expected frames at {filmed_hz:g} Hz" in fault
    assert "found 30 Hz in the file" in fault and f"-itsscale {scale} " in fault


@pytest.mark.parametrize("filmed_hz", [30.0, 60.0, None])
def test_a_phone_in_the_dark_films_at_half_the_rate_it_states(filmed_hz):
    assert not list(lengths.faults(looked_at(filmed_hz=filmed_hz), synchronised=False))


def test_pixels_that_are_not_square_are_told():
    (fault,) = lengths.oblong(looked_at(pixel=4 / 3))
    assert "camera left: expected square pixels" in fault and "found pixels 1.333 times" in fault
    assert not list(lengths.oblong(looked_at(pixel=1.001)))


@pytest.mark.parametrize(
    ("more", "what"),
    [
        ({"interlaced": True}, "the video is interlaced"),
        ({"even": False, "late_s": 2.0}, "2.0 s of 10.0 s are gaps between frames"),
    ],
)
def test_what_costs_moments_is_remarked(more, what):
    (remark,) = lengths.remarks(looked_at(**more), synchronised=False)
    assert remark.startswith("camera left: ") and what in remark
    assert not list(lengths.remarks(looked_at(even=False, late_s=0.05), synchronised=False))
