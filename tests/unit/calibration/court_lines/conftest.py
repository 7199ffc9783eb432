"""A court, and the evidence of its lines in a drawn picture of the second of two cameras."""

import pytest

from courtside.calibration.court_lines import evidence, ridges
from fixtures.cameras import court_pictures


@pytest.fixture(scope="module")
def court():
    return court_pictures.badminton()


@pytest.fixture(scope="module")
def seen(court):
    picture = court_pictures.draw(court_pictures.pair()[1], court, noise=3)
    return evidence.fields(ridges.find(picture, "light"))
