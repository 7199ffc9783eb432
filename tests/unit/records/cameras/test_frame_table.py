"""The frame table: round trip and faults in one line."""

import numpy as np
import pandas as pd
import pytest

from courtside.records.cameras import frame_table
from courtside.study.errors import InputError

HEADER = "frame_idx,time_s,name,sharpness,kept,reason,photo\n"


def a_table():
    return pd.DataFrame(
        {
            "frame_idx": [0, 6, 12, 18],
            "time_s": [0.0, 0.2, 0.4, np.nan],
            "sharpness": [100.5, 20.25, 99.0, 1.0],
            "name": ["000000.png", "000006.png", "000012.png", "000018.png"],
            "kept": [True, False, False, True],
            "reason": ["", "blurred", "duplicate", ""],
            "photo": ["", "", "", "IMG 4, 2.jpg"],
        }
    )


def test_a_written_table_is_read_exactly(tmp_path):
    path = tmp_path / "frames" / "walk1.csv"
    frame_table.write(path, a_table())
    pd.testing.assert_frame_equal(
        frame_table.read(path), a_table()[list(frame_table.COLUMNS)], check_dtype=False
    )
    assert path.read_text().splitlines()[:3] == [
        HEADER.strip(),
        "0,0.0,000000.png,100.5,1,,",
        "6,0.2,000006.png,20.25,0,blurred,",
    ]
    assert frame_table.read(path)["kept"].dtype == bool


def test_photos_have_no_times_and_all_may_be_kept(tmp_path):
    table = a_table().assign(time_s=np.nan, kept=True, reason="")
    frame_table.write(tmp_path / "photos.csv", table)
    found = frame_table.read(tmp_path / "photos.csv")
    assert found["time_s"].isna().all() and (found["reason"] == "").all() and found["kept"].all()


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "No columns"),
        ("frame_idx,time_s,name\n0,0,a\n", "no column sharpness, kept, reason, photo"),
        (HEADER, "found no frames"),
        (HEADER + "1,0,a,1,1,,\n0,0,b,1,1,,\n", "not each once in order"),
        (HEADER + "0,0,a,1,1,,\n1,0,a,1,1,,\n", "not each once in order"),
        (HEADER + "0,0,a,1,2,,\n", "kept other than 0 and 1"),
        (HEADER + "0,0,a,1,0,ugly,\n", "a reason not of dark, blurred, duplicate"),
        (HEADER + "0,0,a,1,0,,\n", "none beside another"),
        (HEADER + "0,0,a,1,1,blurred,\n", "a reason beside a kept frame"),
        (HEADER + "x,0,a,1,1,,\n1,0,b,1,1,,\n", "a number"),
        (HEADER + "0,0,a,sharp,1,,\n", "a number"),
    ],
)
def test_faults_are_one_line(tmp_path, text, reason):
    path = tmp_path / "walk1.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=reason) as caught:
        frame_table.read(path)
    message = str(caught.value)
    assert message.startswith(f"{path}: expected a frame table") and "\n" not in message


def test_a_missing_table_is_named(tmp_path):
    with pytest.raises(InputError, match=r"walk1\.csv: expected a frame table"):
        frame_table.read(tmp_path / "walk1.csv")


def test_no_faulty_table_is_written(tmp_path):
    with pytest.raises(ValueError, match="reason"):
        frame_table.write(tmp_path / "walk1.csv", a_table().assign(reason="ugly"))
    assert not (tmp_path / "walk1.csv").exists()


@pytest.mark.parametrize("name", ["../a.png", "/a.png", "a/b.png", "a\\b.png", ".."])
def test_a_name_may_not_leave_the_folder(tmp_path, name):
    path = tmp_path / "walk1.csv"
    path.write_text(f"{HEADER}0,0,{name},1,1,\n")
    with pytest.raises(InputError, match=r"walk1\.csv: .*found the name of a file elsewhere"):
        frame_table.read(path)
