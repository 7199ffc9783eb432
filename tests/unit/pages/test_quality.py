"""The page for quality: its lines, its pictures, and nobody to be recognised."""

import json
import re

import cv2
import numpy as np
import pytest

from courtside.pages import page as pages
from courtside.pages import quality
from courtside.pages.report import report
from courtside.records.keypoints.skeleton import Skeleton
from courtside.study.execution import verdicts
from courtside.video import writer
from fixtures.people import named_takes
from fixtures.study import report_made

SKELETON = Skeleton(
    "made", ("a", "b", "c", "d", "e"), (("a", "c"), ("b", "d")), {}, {"face": ("a", "b")}
)

LIMITS = {"max_shift_px": 1.0, "max_zoom_percent": 0.2}


@pytest.fixture
def rows(tmp_path):
    (tmp_path / "quality.csv").write_text(report_made.VERDICTS)
    return verdicts.read(tmp_path / "quality.csv")


def test_a_camera_has_the_reported_verdict_and_those_that_differ(rows):
    take, camera = quality.lines(rows)
    assert take == ("all", "doubtful", "Camera c1: its clock is off.", ())
    assert camera[:3] == ("c1", "doubtful", "Its clock is off.")
    assert camera.others == ("failed by file all-robust blazepose-full",)
    same = [{**row, "verdict": "doubtful"} for row in rows]
    assert quality.lines(same)[1].others == ()


def test_the_frame_shown_has_most_persons_and_is_nearest_to_the_middle():
    view = named_takes.take(2).seen[0].tracklets
    assert quality.shown_frame(view) == 30
    view.xy[1, 10:] = np.nan
    assert quality.shown_frame(view) == 9
    view.xy[1, :, :2] = np.nan  # three of five joints still show somebody
    assert quality.shown_frame(view) == 9
    view.xy[:] = np.nan
    assert quality.shown_frame(view) == 30


def test_a_picture_hides_face_and_surroundings_and_shows_the_joints(tmp_path):
    width, height = named_takes.SIZE
    image = np.zeros((height, width, 3), np.uint8)
    image[::8] = image[1::8] = image[2::8] = image[3::8] = 255  # survives the smaller size
    video = tmp_path / "c0.mp4"
    frames = [image] * len(named_takes.TIMES)
    writer.write_video(video, frames, named_takes.RATE_HZ, crf=10, effort="ultrafast")
    take = named_takes.take(2)
    view, people = take.seen[0].tracklets, take.found
    people.index["c0"][1] = -1  # the second person is nobody of the take
    found = cv2.imdecode(
        np.frombuffer(quality.thumbnail(view, people, video, SKELETON), np.uint8), cv2.IMREAD_COLOR
    )
    assert found.shape == (160, 320, 3)
    blue, _, red = (found[..., at].astype(float) for at in range(3))
    detail = np.abs(np.diff(found.max(axis=2).astype(float), axis=0))
    x, y = (round(0.4 * value) for value in named_takes.place_px(0))
    other = round(0.4 * named_takes.place_px(1)[0])
    yellow, blueish = red - blue > 80, blue - red > 80
    assert detail[:, 200:].mean() < 12  # surroundings
    assert detail[y - 26 : y - 21, x - 8 : x + 8].mean() < 15  # the face
    assert detail[y - 4 : y + 4, x - 12 : x - 4].mean() > 30  # the body
    assert yellow[y - 24 : y + 24, x - 10 : x + 10].sum() > 20
    assert blueish[y - 24 : y + 24, other - 10 : other + 10].sum() > 20
    assert yellow[:, other - 20 :].sum() == 0
    assert detail[y - 8 : y + 4, other - 4 : other + 4].mean() < 12  # nobody of the take


def test_the_page_says_what_checks_of_the_calibration_found(rows, tmp_path):
    check = tmp_path / "file" / "check.json"
    check.parent.mkdir()
    content = {"warnings": ["the cameras of the file <disagree>"], "remarks": ["cam03: not judged"]}
    check.write_text(json.dumps(content))
    own = check.with_name("quality.json")
    own.write_text(json.dumps({"warnings": [], "covariance": "known"}))
    takes = [{"name": "smash", "lines": quality.lines(rows), "pictures": {}, "left_out": ""}]
    cameras = {"calibration": "file", "others": [], "limits": LIMITS}
    cameras["files"] = {"quality": {"file": own}, "checks": [check]}
    html = quality.build("hall", takes, cameras)
    assert "Calibration: the cameras of the file &lt;disagree&gt;." in html
    assert "For information (1)" in html and "Calibration: cam03: not judged." in html
    assert "<h2>Cameras" not in quality.build("hall", takes)


def test_the_page_and_the_report_say_the_same_of_the_cameras(rows, tmp_path):
    study = report_made.study(tmp_path)
    study["sessions"][0]["takes"] = []
    content = report_made.QUALITY | {"expected_volume_rms_cm": None}  # 2 cm by points left out
    (tmp_path / "quality.json").write_text(json.dumps(content))
    other = tmp_path / "other.json"
    other.write_text(json.dumps({"warnings": ["points are missing"]}))
    files = study["sessions"][0]["files"]
    both = files | {"quality": files["quality"] | {"known18": other}}
    cameras = {"calibration": "sfm-n40", "others": ["known18"], "files": both, "limits": LIMITS}
    html = quality.build("hall", [], cameras)
    mark = (
        r'<span class="light (\w+)"><span aria-hidden="true">(.)</span> (?:Cameras|doubtful)</span>'
    )
    own, listed = html.partition("</h2>")[0], html.partition("</h2>")[2]
    of_report = report.build(study | {"figures": [], "tables": []}).partition("<main>")[2]
    assert re.search(mark, own[own.index("<h2>") :]).groups() == ("doubtful", "▲")
    assert re.search(mark, of_report[of_report.index("<h3") :]).groups() == ("doubtful", "▲")
    sentence = "the median error of clicked points, each aligned to the others, is 2.0 cm"
    said = f"Calibration sfm-n40: {sentence}; the cameras were fitted to these points"
    assert said in listed and said in of_report
    assert listed.index("<h3>Also used: known18</h3>") < listed.index("points are missing")
    assert "points are missing" not in of_report


def test_the_marks_have_the_words_of_the_verdicts():
    light = pages.macro("report_parts.html", "light")
    words = [light(level).rpartition("</span> ")[2] for level in range(len(verdicts.ORDER))]
    assert words == [f"{word}</span>" for word in verdicts.ORDER]


def test_the_page_has_a_row_for_each_line_and_says_why_pictures_are_missing(rows):
    lines = quality.lines(rows)
    takes = [
        {"name": "smash", "lines": lines, "pictures": {"c1": b"jpeg"}, "left_out": ""},
        {"name": "<b>", "lines": lines, "pictures": {}, "left_out": "No pictures: why."},
    ]
    html = quality.build("hall", takes)
    assert html.count("<img ") == 1
    assert 'src="data:image/jpeg;base64,' in html
    assert html.count("<tr><th") == 2 * (1 + 2)
    assert "No pictures: why." in html
    assert "&lt;b&gt;" in html
    assert "failed by file all-robust blazepose-full" in html
