"""A refined calibration is taken where it is better; the wrong number is named."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.calibration.file_check import faults
from courtside.calibration.people import adjustment, prior, refinement, resection, views
from courtside.calibration.people.held_out import Points
from courtside.calibration.people.views import Limits
from courtside.study.errors import InputError
from fixtures import remembered_calls
from fixtures.cameras import corner_cameras, walkers

TRUE = corner_cameras.four_cameras()
LIMITS = Limits(score=0.05, limit=0.05, fade=0.067)
KNOWN = prior.stated(
    TRUE, rotation_deg=0.3, position_m=0.03, focal_percent=0.5, principal_point_percent=0.3, k1=0.01
)
SEEN = walkers.seen(TRUE, walkers.joints(64))
STATIC = Points(corner_cameras.seen_points(TRUE, 8, 0.5, seed=2))


@pytest.fixture(scope="module", autouse=True)
def adjusted_once():
    """Adjust the same cameras only once: points at rest only judge the result."""
    with remembered_calls.of((adjustment, "refine")):
        yield


def test_disturbed_cameras_are_refined():
    base = walkers.disturbed(TRUE, KNOWN, 1)
    found = refinement.refine(base, KNOWN, SEEN, LIMITS, STATIC)
    words = "cameras refined by people were taken; what the fit did not see: refined, joints better"
    assert found.taken == "refined" and found.line.startswith(f"{words} (")
    assert found.verdicts == {"refined": {"joints": "better", "static": "better"}}
    table = found.table.set_index(["what", "camera"])
    assert table.loc[("static_px", "all"), "refined"] < table.loc[("static_px", "all"), "base"]
    moved = table.loc[("moved_cm", "c0")]
    assert moved["base"] == 0 and 0 < moved["refined"] < 20 and moved["sigma"] > 0
    assert found.covariance.covariance.shape == KNOWN.covariance.shape
    assert np.trace(found.covariance.covariance) < np.trace(KNOWN.covariance)
    assert " thousandths of the height), points at rest better (" in found.line
    off = table.loc[("static_px", "all")]
    assert found.line.endswith(f"({off['base']:.1f} -> {off['refined']:.1f} px)")


def test_good_cameras_are_kept_as_they_are():
    found = refinement.refine(TRUE, KNOWN, SEEN, LIMITS, STATIC)
    assert found.taken == "base" and found.wrong == []
    words = "cameras kept as before; what the fit did not see: refined, joints"
    assert found.line.startswith(words)
    for one, true in zip(found.cameras, TRUE, strict=True):
        np.testing.assert_array_equal(one.K, true.K)
    assert found.covariance is KNOWN


def test_a_mirrored_principal_point_is_named_and_mended():
    base = [faults.mirrored_point(TRUE[0], 0), *TRUE[1:]]
    found = refinement.refine(base, KNOWN, SEEN, LIMITS, STATIC, calibrated=base)
    assert found.taken in ("mended", "refined")
    assert "principal point of camera c0 is mirrored in x" in found.wrong[0]
    assert "did not see: without the faults named, joints better (" in found.line
    assert found.cameras[0].K[0, 2] == pytest.approx(TRUE[0].K[0, 2], abs=6)


def test_bad_input_is_refused_and_cameras_can_be_kept():
    still = walkers.seen(TRUE, walkers.joints(64, still=True))
    with pytest.raises(InputError, match="somebody who moves") as error:
        refinement.refine(TRUE, KNOWN, still, LIMITS, STATIC)
    found = refinement.unchanged(TRUE, KNOWN, str(error.value))
    assert found.taken == "base" and found.cameras == TRUE and found.table.empty
    assert found.line.startswith("cameras kept as before: people: expected somebody who moves")


def test_joints_that_err_alike_all_the_time_are_no_proof_by_themselves():
    base = walkers.disturbed(TRUE, KNOWN, 1)
    assert refinement.refine(base, KNOWN, SEEN, LIMITS, Points()).taken == "refined"
    shift = np.random.default_rng(5).normal(size=(4, 1, 10, 2))
    biased = replace(SEEN, xy=SEEN.xy + 0.008 * SEEN.height_px[:, :, None, None] * shift)
    found = refinement.refine(base, KNOWN, biased, LIMITS, Points())
    assert found.taken == "base" and found.verdicts["refined"]["joints"] == "better"
    assert "click points at rest" in found.line


def test_persons_whom_no_two_cameras_see_take_nobodys_place():
    stays = walkers.seen(TRUE, walkers.joints(320))
    unseen = replace(stays, score=np.full_like(stays.score, np.nan))
    both = views.joined([stays, *[unseen] * 15])
    assert (both.thinned().track == 0).sum() == views.MOST_ROWS
    assert refinement._alone(both, alike=30.0, gain=0.5) == {}


def test_a_small_gain_of_joints_alone_is_how_the_network_errs():
    found = refinement.refine(TRUE, KNOWN, SEEN, LIMITS, Points())
    assert found.taken == "base" and found.cameras == TRUE
    assert "%, expected 5 %; click points" in found.verdicts["refined"]["size of the change"]


def test_a_camera_found_again_is_told_adjusted_and_taken():
    shift = np.array([[0, 0, 0, 0.5], [0, 0, 0, 0], [0, 0, 0, 0]])
    lost, near = (
        replace(TRUE[2], cam_from_world=TRUE[2].cam_from_world + part * shift) for part in (1, 0.1)
    )
    base, again = [*TRUE[:2], lost, TRUE[3]], [*TRUE[:2], near, TRUE[3]]
    known = resection.widened(KNOWN, base, [2])
    found = refinement.refine(base, known, SEEN, LIMITS, Points(), found_again=again)
    assert found.taken == "refined" and found.verdicts["mended"] == {"joints": "better"}
    assert found.wrong[0].startswith("camera c2: expected people in its pictures")
    assert "did not see: with cameras found again, joints better (" in found.line
    off_m = np.linalg.norm(found.cameras[2].centre_in_world - TRUE[2].centre_in_world)
    assert off_m < 0.03
