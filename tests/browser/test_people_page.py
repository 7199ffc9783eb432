"""The page on which persons are named: names, splits, joins, as the workflow reads them."""

import cv2
import numpy as np
import pytest

from browser.waiting import FORBIDDEN, reload, second_tab, until
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

    def made(n_people=2, n_cameras=2, to="walk", context=None, words=None, **given):
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
        about = {"session": "hall", "take": to, "subjects": ["a", "b"], "target": "data/p.csv"}
        about |= {"takes": ["walk", "run", "jump"], "meet_m": 0.8}
        columns = dict.fromkeys(range(n_people), COLUMNS)
        built = people_page.build(
            {**about, **(words or {})}, take.found, take.seen, columns, shots, **given
        )
        pages.write(tmp_path / f"{to}.html", built)
        if context is None:
            return open_page(tmp_path / f"{to}.html")
        return second_tab(context, (tmp_path / f"{to}.html").as_uri())

    return made


def saved(page, tmp_path, take="walk"):
    with page.expect_download() as waiting:
        page.click("#save")
    path = tmp_path / "people.csv"
    waiting.value.save_as(path)
    return path, sightings.read(path, take, ["a", "b"], ["c0", "c1"])


def file(tmp_path, *rows):
    """Write people.csv; return its path."""
    path = tmp_path / "loaded.csv"
    head = ",".join([*sightings.COLUMNS, *sightings.BOUNDS])
    path.write_text("\n".join([head, *rows]) + "\n")
    return path


def load(page, path, words):
    page.set_input_files("#chooser", path)
    until(page, "words => document.getElementById('message').textContent.includes(words)", words)
    return page.inner_text("#message")


def names(page, n_people=2):
    """Return the names of the first part of each person."""
    selects = [f"article[data-person=person-{k + 1}] select >> nth=0" for k in range(n_people)]
    return [page.input_value(one) for one in selects]


def takes(page):
    """Return the takes of the rows that would be saved."""
    return [row.split(",")[0] for row in page.input_value("#text").splitlines()[1:]]


def heard(page, take):
    """Wait until a page knows rows of a take that another one saved: browsers tell it later."""
    until(page, "take => document.getElementById('text').value.includes(`\n${take},`)", take)


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
    below = "document.getElementById('person-9').getBoundingClientRect().top - "
    below += "document.querySelector('header').getBoundingClientRect().bottom"
    until(page, f"{below} >= 0 && {below} < 10")
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
    until(page, "document.querySelector('article[data-person=person-1] input').value === '3.20'")
    bounds = {one.subject: (one.from_s, one.to_s) for one in saved(page, tmp_path)[1]}
    assert bounds == {"a": (0.5, 3.7), "b": (3.7, 6.5)}
    page.fill("article[data-person=person-1] input", "99")
    page.keyboard.press("Tab")
    until(page, "document.getElementById('message').textContent.includes('the one before')")
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
    assert OTHER in sightings.every_row(path, ["walk", "run"])
    assert [one.subject for one in found] == ["b", "b", "a", "a", "b", "b"]
    assert found[2].to_s == 3.5
    name(page, "person-1", "")
    assert [one.subject for one in saved(page, tmp_path)[1]] == ["a", "a", "b", "b"]
    reload(page)  # the browser keeps the work
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
    assert OTHER in sightings.every_row(saved(page, tmp_path)[0], ["walk", "run"])
    path.write_text("camera,point\n")
    page.set_input_files("#chooser", path)
    until(page, "document.getElementById('message').className.includes('bad')")
    assert "loaded.csv: expected the columns" in page.inner_text("#message")


def test_rows_of_a_loaded_file_outlive_a_reload(opened, tmp_path):
    page = opened()
    load(page, file(tmp_path, "run,a,c0,1,2,3,,", "jump,b,c0,1,2,3,,"), "2 rows of other takes")
    name(page, "person-1", "a")
    reload(page)
    message = page.inner_text("#message")
    assert "is here again" in message and "with 2 rows of other takes" in message
    assert takes(page) == ["run", "jump", "walk", "walk"]


def test_a_file_of_one_take_keeps_what_was_loaded_of_another(opened, tmp_path):
    page = opened(rows=[OTHER])
    assert takes(page) == ["run"]
    load(page, file(tmp_path, "jump,b,c0,1,2,3,,"), "1 row of other takes (jump: 1)")
    load(page, file(tmp_path, "jump,a,c0,1,2,3,,", "jump,b,c0,4,2,3,,"), "jump: 2 in place of 1")
    assert takes(page) == ["run", "jump", "jump"]
    page.click("#undo")
    page.click("#undo")
    assert takes(page) == ["run"]


def test_names_saved_on_the_page_of_one_take_are_in_the_file_of_the_next(opened, tmp_path):
    walk = opened()
    name(walk, "person-1", "a")
    saved(walk, tmp_path)
    assert "2 rows of walk. Put" in walk.inner_text("#message")
    assert "names of other takes by now, load it here" in walk.inner_text("#message")
    run = opened(to="run", context=walk.context)
    heard(run, "walk")
    assert "walk (2 rows saved in this browser" in run.inner_text("#where")
    name(run, "person-2", "b")
    path, found = saved(run, tmp_path, "run")
    assert "2 rows of run, 2 rows of walk. Put" in run.inner_text("#message")
    assert [one.subject for one in found] == ["b", "b"]
    assert [one.subject for one in sightings.read(path, "walk", "ab", ["c0", "c1"])] == ["a", "a"]
    heard(walk, "run")  # and of the first page again
    assert takes(walk) == ["run", "run", "walk", "walk"]


def test_names_saved_before_somebody_changed_the_file_do_not_come_back(opened, tmp_path):
    walk = opened()
    name(walk, "person-1", "a")
    path, _ = saved(walk, tmp_path)
    placed = sightings.every_row(path, ["walk", "run"])
    changed = [["walk", "b", *row[2:]] for row in placed]
    run = opened(to="run", context=walk.context, rows=changed)
    assert takes(run) == ["walk", "walk"] and ",b," in run.input_value("#text")
    run = opened(to="run", context=walk.context, rows=placed)  # as saved
    assert ",a," in run.input_value("#text")
    run = opened(to="run", context=walk.context)  # and deleted in the file since
    assert takes(run) == []


def test_a_fresh_start_forgets_what_other_pages_saved(opened, tmp_path):
    walk = opened()
    name(walk, "person-1", "a")
    saved(walk, tmp_path)
    run = opened(to="run", context=walk.context)
    heard(run, "walk")
    run.click("#afresh")
    assert takes(run) == []
    reload(run)
    assert takes(run) == []
    run.click("#undo")
    assert takes(run) == ["walk", "walk"]


def test_a_file_saved_on_another_computer_brings_its_names_back(opened, tmp_path):
    page = opened()
    page.click("article[data-person=person-1] >> text=Split here >> nth=2")
    name(page, "person-1", "a")
    name(page, "person-2", "b")
    path, before = saved(page, tmp_path)
    text = page.input_value("#text")
    other = opened()  # in a browser that knows nothing
    assert takes(other) == []
    assert "those of the file" in load(other, path, "4 rows of walk")
    assert other.input_value("#text") == text and saved(other, tmp_path)[1] == before
    assert names(other) == ["a", "b"]


def test_rows_of_no_picture_of_the_page_are_left_out_with_a_word(opened, tmp_path):
    page = opened()
    name(page, "person-1", "b")
    words = load(page, file(tmp_path, "walk,a,c0,1,2,3,,", "run,a,c0,1,2,3,,"), "Loaded")
    assert "are left out, for 1 of them is of no picture" in words
    assert names(page) == ["b", ""] and takes(page) == ["run", "walk", "walk"]


@pytest.mark.parametrize(
    ("row", "words"),
    [
        ("smash9,Zoe,camX,1,2,3,,", 'expected a take of walk, run, jump, found "smash9"'),
        ("walk,Zoe,c0,1,2,3,,", 'expected a subject of a, b, found "Zoe"'),
        ("walk,a,camX,1,2,3,,", 'expected a camera of c0, c1, found "camX"'),
        ("run,a,c0,1,,3,,", 'expected x_px as a finite number, found ""'),
        ("run,a,c0,1,2,3,soon,", 'expected from_s as a finite number, found "soon"'),
    ],
)
def test_a_row_that_the_workflow_refuses_is_refused_by_its_line(opened, tmp_path, row, words):
    page = opened()
    found = load(page, file(tmp_path, "jump,b,c0,1,2,3,,", row), ": line 3: ")
    assert words in found and found.startswith("loaded.csv: line 3: ") and takes(page) == []


def test_a_page_in_two_tabs_keeps_the_work_of_the_first_to_change_it(opened):
    one = opened()
    two = second_tab(one.context, one.url)
    name(one, "person-1", "a")
    until(two, "document.getElementById('unkept').textContent.includes('reload before you go on')")
    name(two, "person-2", "b")
    assert two.is_visible("#unkept") and not one.is_visible("#unkept")
    reload(one)
    assert names(one) == ["a", ""]
    asked = []
    two.on("dialog", lambda dialog: (asked.append(dialog.type), dialog.accept()))
    reload(two)
    assert asked == ["beforeunload"]  # for b is not kept
    assert names(two) == ["a", ""] and not two.is_visible("#unkept")


def test_a_browser_that_keeps_nothing_says_so_and_asks_before_names_are_lost(opened, tmp_path):
    page = opened()
    page.add_init_script(FORBIDDEN)
    reload(page)
    asked = []
    page.on("dialog", lambda dialog: (asked.append(dialog.type), dialog.accept()))
    name(page, "person-1", "a")
    assert "This browser keeps nothing: save" in page.inner_text("#unkept")
    saved(page, tmp_path)
    reload(page)
    assert asked == []
    name(page, "person-1", "a")
    reload(page)
    assert asked == ["beforeunload"]


def test_names_splits_joins_and_a_fresh_start_are_undone(opened):
    page = opened()
    name(page, "person-1", "a")
    page.click("article[data-person=person-1] >> text=Split here >> nth=2")
    name(page, "person-1", "b", part=1)
    whole = page.input_value("#text")
    page.click("text=Join to the part before")
    assert page.locator("article select").count() == 2
    page.keyboard.press("Control+z")  # with the focus on a name
    assert page.input_value("#text") == whole
    assert page.inner_text("#message") == "The last change is undone: person-1."
    page.click("#afresh")
    assert names(page) == ["", ""] and "Undo" in page.inner_text("#message")
    reload(page)
    page.click("#undo")
    assert page.input_value("#text") == whole
    for _ in range(3):
        page.keyboard.press("Control+z")
    assert names(page) == ["", ""] and page.is_disabled("#undo")
    page.keyboard.press("Control+z")
    assert "Nothing" in page.inner_text("#message")
    for key in ("y", "Shift+z", "y"):
        page.keyboard.press(f"Control+{key}")
    assert page.input_value("#text") == whole


def test_the_keyboard_alone_chooses_a_name_and_goes_on_from_there(opened):
    page = opened(n_people=12)
    focused = (
        "document.activeElement.getAttribute('aria-label') || document.activeElement.innerText"
    )
    page.focus("article[data-person=person-9] select")
    page.keyboard.press("ArrowDown")
    page.keyboard.press("ArrowDown")
    assert page.input_value("article[data-person=person-9] select") == "b"
    page.keyboard.press("Tab")
    assert page.evaluate(focused) == "Split here"
    page.keyboard.press("Enter")
    assert page.evaluate(focused).startswith("Name of person-9 from 1.")
    page.keyboard.press("Shift+Tab")
    page.keyboard.press("Shift+Tab")
    page.keyboard.type("1.2")
    page.keyboard.press("Tab")
    moved = "document.querySelector('article[data-person=person-9] input').value === '1.20'"
    until(page, moved)  # the page is drawn again after the key
    until(page, "document.activeElement.textContent.startsWith('Join')")
    page.keyboard.press("Enter")
    assert page.evaluate(focused) == "Name of person-9"


def test_a_name_of_two_persons_at_one_time_is_told_with_their_distance(opened):
    page = opened()
    name(page, "person-1", "a")
    assert page.locator(".part .bad").count() == 0
    name(page, "person-2", "a")
    told = page.locator(".part .bad").all_inner_texts()
    assert told == [
        "a is also person-2, 3.0 m away at 0.0 s: correct one of them.",
        "a is also person-1, 3.0 m away at 0.0 s: correct one of them.",
    ]
    assert page.inner_text("#clashes") == "Two persons at one time: a."
    page.click("article[data-person=person-1] >> text=Split here >> nth=2")
    page.click("article[data-person=person-2] >> text=Split here >> nth=2")
    name(page, "person-1", "", part=1)
    name(page, "person-2", "")  # one before the cut, the other after it
    name(page, "person-2", "a", part=1)
    assert page.locator(".part .bad").count() == 0 and page.inner_text("#clashes") == ""


def test_messages_and_saving_stay_in_sight(opened):
    page = opened(n_people=12)
    page.click("article[data-person=person-12] >> text=Split here >> nth=2")
    page.fill("article[data-person=person-12] input", "99")
    page.keyboard.press("Tab")
    until(page, "document.getElementById('message').textContent.includes('the one before')")
    assert page.evaluate("scrollY") > 1000
    for shown in ("#message", "#save", "#undo"):
        assert 0 <= page.locator(shown).bounding_box()["y"] < 200


@pytest.mark.parametrize(("n_people", "length_m"), [(2, 1), (12, 5)])
def test_the_floor_has_a_scale(opened, n_people, length_m):
    page = opened(n_people=n_people)
    assert page.locator("#floor .scale-label").text_content() == f"{length_m} m"
    ends = [float(page.get_attribute("#floor .scale", key)) for key in ("x1", "x2")]
    assert ends[1] - ends[0] == pytest.approx(length_m)
    floor = page.locator("#floor").bounding_box()
    bar = page.locator("#floor .scale").bounding_box()
    assert floor["x"] <= bar["x"] and bar["x"] + bar["width"] <= floor["x"] + floor["width"]
