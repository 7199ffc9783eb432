"""Names that cameras and recorders give, and names that only look like them."""

from datetime import datetime

import pytest

from courtside.drafting import device_names

MOMENT = datetime(2024, 1, 2, 10, 11, 12)


@pytest.mark.parametrize(
    ("stem", "mark", "begun"),
    [
        ("VID_20240102_101112", "vid_20240102_101112", MOMENT),
        ("PXL_20240102_101112345", "pxl_20240102_101112345", MOMENT),
        ("20240102_101112", "20240102_101112", MOMENT),
        ("2024-01-02 10-11-12", "2024-01-02 10-11-12", MOMENT),
        ("2024-01-02_10-11-12", "2024-01-02_10-11-12", MOMENT),
        ("WIN_20240102_10_11_12_Pro", "win_20240102_10_11_12_pro", MOMENT),
        ("DJI_20240102101112_0001_D", "dji_20240102101112_0001_d", MOMENT),
        ("DJI_0001", "dji_0001", None),
        ("VID-20240102-WA0001", "vid-20240102-wa0001", None),
        (
            "WhatsApp Video 2024-01-02 at 10.11.12",
            "whatsapp video 2024-01-02 at 10.11.12",
            None,
        ),
        ("DSCF0001", "dscf0001", None),
        ("P1000123", "p1000123", None),
        ("IMG_E0123", "img_e0123", None),
        ("IMG_1234", "img_1234", None),
        ("MVI_0007", "mvi_0007", None),
        ("GX010123", "gx010123", None),
        ("GOPR0123", "gopr0123", None),
        ("C0001", "c0001", None),
        ("VID_20241399_996112", "", None),  # no moment
    ],
)
def test_counters_and_moments(stem, mark, begun):
    found = device_names.read(stem)
    assert (found.mark if found else "", found.begun if found else None) == (mark, begun)


def test_words_of_the_user_stand_around():
    found = device_names.read("serve left_GX020123 again")
    assert (found.before, found.after, found.chapter) == ("serve left_", " again", 2)
    assert device_names.read("GP010123").chapter == 2


def test_qualisys_says_camera_and_serial_number():
    found = device_names.read("Serve 1_Miqus_3_23087")
    assert (found.before, found.camera, found.serial) == ("Serve 1_", "miqus3", "23087")
    assert found.mark == ""


@pytest.mark.parametrize(
    "stem",
    [
        "cam01",
        "c01",
        "smash1_left",
        "IMG",
        "gx12",
        "2024",
        "take_2024_01",
        "GX0101234x",
        "P01_0123",
    ],
)
def test_usual_names_are_nobodys(stem):
    assert device_names.read(stem) is None
