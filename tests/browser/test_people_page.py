"""The page on which persons are named: names, splits, joins, as the workflow reads them."""

import cv2
import numpy as np
import pytest

from browser.waiting import until
from courtside.pages import page as pages
from courtside.pages.people import page as people_page
from courtside.pages.people.strips import Shot
from courtside.records.keypoints import sightings
from fixtures.people import named_takes

pytestmark = pytest.mark.browser
PICTURE = cv2.imencode(".jpg", np.full((60, 30, 3), 120, np.uint8))[1].tobytes()
COLUMNS = [5, 15, 25, 35, 45, 55]
OTHER = ["run", "a", "c0", "1", "2", "3", "", ""]


@pytest.fixture
def opened(open_page, tmp_path):
    """Return `opened(named=..., rows=...)`: the page of two people whom two cameras see."""

    def made(n_people=2, n_cameras=2, **given):
        take = named_takes.take(n_people, n_cameras=n_cameras)
        shots = [
            Shot(
                k,
                column,
                f"c{c}",
                0.1 * at + 0.5 * c,
                named_takes.place_px(k, c),
                120.0 + c,
                PICTURE,
            )
            for k in range(n_people)
            for column, at in enumerate(COLUMNS)
            for c in range(n_cameras)
        ]
        words = {"session": "hall", "take": "walk", "subjects": ["a", "b"], "target": "data/p.csv"}
        columns = dict.fromkeys(range(n_people), COLUMNS)
        built = people_page.build(words, take.found, take.seen, columns, shots, **given)
        pages.write(tmp_path / "people.html", built)
        return open_page(tmp_path / "people.html")

    return made


def saved(page, tmp_path):
    with page.expect_download() as waiting:
        page.click("#save")
    path = tmp_path / "people.csv"
    waiting.value.save_as(path)
    return path, sightings.read(path, "walk", ["a", "b"], ["c0", "c1"])


def name(page, person, subject, part=0):
    page.select_option(f"article[data-person={person}] select >> nth={part}", subject)


def test_a_name_is_saved_with_two_pixels_of_the_largest_view(opened, tmp_path):
    page = opened()
    assert "a, b" in page.inner_text("#missing")
    assert page.locator("article").count() == 2
    assert page.locator("article img").count() == 24
    name(page, "person-2", "a")
    _, found = saved(page, tmp_path)
    assert [(one.subject, one.camera, one.time_s) for one in found] == [
        ("a", "c1", 1.0),
        ("a", "c1", 6.0),
    ]
    assert {one.xy for one in found} == {named_takes.place_px(1, 1)}
    assert page.inner_text("#missing") == "Not named yet: b."
    assert "data/p.csv" in page.inner_text("#message")


def test_twelve_people_are_found_by_number_on_the_floor_and_in_the_largest_pictures(opened):
    page = opened(n_people=12, n_cameras=8)
    assert page.locator("#floor .label").all_text_contents() == [str(k + 1) for k in range(12)]
    shown = "article[data-person=person-9] tbody th"
    assert page.locator(shown).all_inner_texts() == ["c4", "c5", "c6", "c7"]  # the largest, above
    page.check("#all")
    assert page.locator(shown).all_inner_texts() == [f"c{k}" for k in range(8)]
    page.locator("#floor .label").nth(8).click()
    until(page, "Math.abs(document.getElementById('person-9').getBoundingClientRect().top) < 2")
    name(page, "person-9", "a")
    assert page.locator("#floor .label").all_text_contents()[8] == "a"
    options = page.locator("article[data-person=person-1] option").all_inner_texts()
    assert options == ["no subject", "a (also person-9)", "b"]


def test_pictures_of_few_cameras_need_no_choice(opened):
    page = opened(n_cameras=4)
    assert page.locator("article img").count() == 2 * 6 * 4
    assert not page.is_visible("#all")


def test_a_split_saves_its_bounds_by_the_clock_of_the_camera(opened, tmp_path):
    page = opened()
    page.click("article[data-person=person-1] >> text=Split here >> nth=2")
    name(page, "person-1", "a")
    name(page, "person-1", "b", part=1)
    _, found = saved(page, tmp_path)
    bounds = {one.subject: (one.from_s, one.to_s) for one in found}
    assert bounds == {"a": (0.5, 3.5), "b": (3.5, 6.5)}  # c1 is 0.5 s ahead
    assert page.inner_text("#missing") == "Every subject has a person."
    page.fill("article[data-person=person-1] input", "3.2")
    page.keyboard.press("Tab")
    bounds = {one.subject: (one.from_s, one.to_s) for one in saved(page, tmp_path)[1]}
    assert bounds == {"a": (0.5, 3.7), "b": (3.7, 6.5)}
    page.fill("article[data-person=person-1] input", "99")
    page.keyboard.press("Tab")
    assert "begins after the one before" in page.inner_text("#message")
    page.click("text=Join to the part before")
    _, found = saved(page, tmp_path)
    assert {(one.subject, one.from_s) for one in found} == {("a", None)}


def test_names_given_before_and_those_of_other_takes_are_kept(opened, tmp_path):
    named = [
        {"person": 0, "subject": "b", "time_s": 1.0, "from_s": None, "to_s": None},
        {"person": 1, "subject": "a", "time_s": 1.0, "from_s": None, "to_s": 3.0},
        {"person": 1, "subject": "b", "time_s": 5.0, "from_s": 3.0, "to_s": None},
    ]
    page = opened(named=named, rows=[OTHER])
    path, found = saved(page, tmp_path)
    assert sightings.of_other_takes(path, "walk", ["walk", "run"]) == [OTHER]
    assert [one.subject for one in found] == ["b", "b", "a", "a", "b", "b"]
    assert found[2].to_s == 3.5
    name(page, "person-1", "")
    assert [one.subject for one in saved(page, tmp_path)[1]] == ["a", "a", "b", "b"]
    page.reload()  # the browser keeps the work
    assert page.input_value("article[data-person=person-1] select") == ""
    page.click("#afresh")
    assert page.input_value("article[data-person=person-1] select") == "b"


def test_a_part_that_nobody_named_stays_unnamed(opened, tmp_path):
    page = opened(named=[{"person": 0, "subject": "a", "time_s": 3.0, "from_s": 2.0, "to_s": 4.0}])
    _, found = saved(page, tmp_path)
    assert [(one.subject, one.from_s, one.to_s) for one in found] == [("a", 2.5, 4.5)] * 2


def test_a_file_of_other_takes_can_be_loaded(opened, tmp_path):
    page = opened()
    path = tmp_path / "loaded.csv"
    head = ",".join([*sightings.COLUMNS, *sightings.BOUNDS])
    path.write_text(f"{head}\nrun,a,c0,1,2,3,,\nwalk,b,c0,1,2,3,,\n")
    page.set_input_files("#chooser", path)
    until(page, "document.getElementById('message').textContent.includes('other takes')")
    assert sightings.of_other_takes(saved(page, tmp_path)[0], "walk", ["walk", "run"]) == [OTHER]
    path.write_text("camera,point\n")
    page.set_input_files("#chooser", path)
    until(page, "document.getElementById('message').className.includes('bad')")
    assert "loaded.csv: expected the columns" in page.inner_text("#message")
