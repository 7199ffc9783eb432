"""A court, and the evidence of its lines in a drawn picture of the second of two cameras."""

import numpy as np
import pytest

from courtside.calibration.court_lines import evidence, floor_frames, ridges, search
from fixtures.cameras import court_pictures


@pytest.fixture(scope="module")
def court():
    return court_pictures.badminton()


@pytest.fixture(scope="module")
def few():
    """Search less widely, to be quick."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(floor_frames, "FOCAL_WIDTHS", np.array([0.75, 0.95, 1.2]))
        patch.setattr(search, "REFINED", 8)
        patch.setattr(search, "SHORTLIST", 500)
        yield patch


@pytest.fixture(scope="module")
def seen(court):
    picture = court_pictures.draw(court_pictures.pair()[1], court, noise=3)
    return evidence.fields(ridges.find(picture, "light"))
