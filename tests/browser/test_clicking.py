"""The clicking page by a robot that sees only the screen: it looks for dots, clicks, and saves."""

import base64
import json
import re

import cv2
import numpy as np
import pytest

from browser.waiting import FORBIDDEN, next_frames, ready, reload, second_tab, until
from courtside.geometry import camera as projection
from courtside.pages import page as pages
from courtside.pages.clicking import page as clicking_page
from courtside.records.cameras import clicks
from fixtures.cameras import court_pictures

pytestmark = pytest.mark.browser
TARGETS = {"court_points.csv": "data/hall/court_points.csv"}
DOTTED = ("p01", "p03", "p07", "p08", "p12", "p17")  # whose dots lie apart from others


def encoded(image):
    return cv2.imencode(".png", image)[1].tobytes()


@pytest.fixture(scope="module")
def court():
    return court_pictures.badminton()


@pytest.fixture(scope="module")
def views():
    return court_pictures.pair()


@pytest.fixture(scope="module")
def pictures(court, views):
    return {c.name: encoded(court_pictures.draw(c, court, noise=2, dots=True)) for c in views}


@pytest.fixture
def make(court, views, pictures, tmp_path):
    """Return `make(clicks=..., proposals=...)`: the path of a page.

    Each argument is a dictionary by camera and point.
    """

    def made(name="page", session="hall", more=(), **given):
        frames = [
            clicking_page.Frame(
                camera=c.name,
                size=c.size,
                image=pictures[c.name],
                **{key: by_camera.get(c.name, {}) for key, by_camera in given.items()},
            )
            for c in views
        ]
        path = tmp_path / f"{name}.html"
        built = clicking_page.build(session, court, [*frames, *more], targets=TARGETS)
        pages.write(path, built)
        return path

    return made


def truth(court, views, camera):
    (view,) = [view for view in views if view.name == camera]
    xy = projection.project(view, court.xyz)
    inside = ((xy > 3) & (xy < np.array(view.size) - 4)).all(axis=1)
    return {p: xy[n] for n, p in enumerate(court.points) if inside[n]}


def screen(page):
    """Return what the picture's part of the screen shows, (H, W, 3) BGR, without the magnifier."""
    if page.get_attribute("#loupe-toggle", "aria-pressed") == "true":
        page.click("#loupe-toggle")
    next_frames(page)
    shot = page.locator("#view").screenshot()
    return cv2.imdecode(np.frombuffer(shot, np.uint8), cv2.IMREAD_COLOR)


def dots(image):
    """Return the middles of green discs on the screen, (n, 2) px, weighted by their green."""
    blue, green, red = np.moveaxis(image.astype(float), -1, 0)
    excess = np.clip(green - np.maximum(blue, red), 0, 160)
    n, labels, stats, _ = cv2.connectedComponentsWithStats((excess > 60).astype(np.uint8))
    found = []
    for label in range(1, n):
        rows, columns = np.nonzero(cv2.dilate((labels == label).astype(np.uint8), np.ones((3, 3))))
        weight = excess[rows, columns]
        if stats[label, cv2.CC_STAT_AREA] >= 4:
            found.append([np.average(columns, weights=weight), np.average(rows, weights=weight)])
    return np.array(found)


def move(page, at):
    box = page.locator("#view").bounding_box()
    page.mouse.move(box["x"] + at[0], box["y"] + at[1])


def click_dot(page, near, zoom):
    """Zoom in on a place of the whole picture on the screen and click the dot nearest to it."""
    page.click("#whole")
    at = dots(screen(page))
    at = at[np.argmin(np.linalg.norm(at - near, axis=1))]
    for _ in range(40):
        if int(page.inner_text("#zoom").rstrip("×").split(".")[0]) >= zoom:
            break
        move(page, at)
        page.mouse.wheel(0, -300)
        found = dots(screen(page))
        at = found[np.argmin(np.linalg.norm(found - at, axis=1))]
    move(page, at)
    page.mouse.down()
    page.mouse.up()


def choose(page, point):
    page.click(f'#list [data-point="{point}"]')


def saved(page, tmp_path, name="court_points"):
    with page.expect_download() as waiting:
        page.click(f"#save-{name}")
    path = tmp_path / waiting.value.suggested_filename
    waiting.value.save_as(path)
    return path


def marked(page):
    """Return what the page would save, by camera and point."""
    rows = [row.split(",") for row in page.input_value("#text").splitlines()[1:]]
    return {(row[0], row[1]): (float(row[3]), float(row[4])) for row in rows}


def test_clicks_come_back_to_half_a_pixel(open_page, make, court, views, tmp_path):
    page = open_page(make())
    true = truth(court, views, "back")
    screen(page)
    found = []
    for zoom in (9, 17):
        for point in DOTTED:
            choose(page, point)
            page.keyboard.press("Delete")  # so that no mark of before hides the dot
            page.click("#whole")
            width = page.locator("#view").bounding_box()
            scale = min(width["width"] / 960, width["height"] / 540)
            margin = np.array([width["width"] - 960 * scale, width["height"] - 540 * scale]) / 2
            click_dot(page, true[point] * scale + margin, zoom)
        read = clicks.read(saved(page, tmp_path), ["back", "oblique"], court.points)
        assert np.isnan(read["oblique"]).all()
        found.append(read["back"][court.indices(DOTTED)])
    exact = np.array([true[point] for point in DOTTED])
    error = np.linalg.norm(found - exact, axis=-1)
    again = np.linalg.norm(found[1] - found[0], axis=-1)
    print(
        f"error px: {error.max(axis=1)}, "
        f"repeated: {np.median(again):.2f}, at most {again.max():.2f}"
    )
    assert error.max() <= 0.5
    assert again.max() <= 0.5


def test_undo_redo_nudge_hide_and_delete(open_page, make):
    page = open_page(make())
    box = page.locator("#view").bounding_box()
    page.mouse.click(box["x"] + 200, box["y"] + 300)
    first = marked(page)["back", "p01"]
    for key in ("ArrowRight", "Shift+ArrowDown", "ArrowUp", "Shift+ArrowLeft"):
        page.keyboard.press(key)
    moved = marked(page)["back", "p01"]
    np.testing.assert_allclose(np.subtract(moved, first), (-0.9, 0.9), atol=2e-3)
    page.keyboard.press("Control+z")
    page.keyboard.press("Control+z")
    np.testing.assert_allclose(marked(page)["back", "p01"], np.add(first, (0.1, 1)), atol=2e-3)
    page.keyboard.press("Control+y")
    page.keyboard.press("Control+Shift+z")
    assert marked(page)["back", "p01"] == moved
    page.keyboard.press("h")
    assert marked(page) == {}
    assert "not visible" in page.inner_text("#chosen-state")
    page.keyboard.press("h")
    assert "not marked" in page.inner_text("#chosen-state")
    page.click("#undo")
    page.click("#undo")
    page.keyboard.press("Delete")
    assert marked(page) == {}
    for _ in range(20):
        page.keyboard.press("Control+z")
    assert marked(page) == {}
    assert page.is_disabled("#undo")
    for _ in range(5):
        page.click("#redo")
    assert marked(page)["back", "p01"] == moved


def test_a_narrow_screen_opens_at_the_top(open_page, make):
    page = open_page(make(), width=400, height=850)
    assert page.evaluate("scrollY") == 0
    assert page.locator("h1").bounding_box()["y"] >= 0
    choose(page, "p18")  # far down the list
    page.keyboard.press("b")
    page.evaluate("scrollTo(0, 0)")
    page.keyboard.press("n")
    assert page.evaluate("scrollY") == 0


def test_the_keyboard_alone_places_a_point(open_page, make):
    page = open_page(make())
    page.focus("#view")
    page.keyboard.press("2")
    for key in ("n", "n", "b", "Space", "Shift+ArrowUp"):
        page.keyboard.press(key)
    ((camera, point), (x, y)), *rest = marked(page).items()
    assert (camera, point, rest) == ("oblique", "p02", [])
    assert (x, y) == pytest.approx((479.5, 268.5), abs=1)


def test_a_table_of_the_workflow_is_loaded_and_saved_as_it_was(open_page, make, court, tmp_path):
    rng = np.random.default_rng(3)
    given = {c: rng.uniform(0, 500, (18, 2)) for c in ("back", "oblique")}
    given["back"][4] = np.nan
    path = tmp_path / "earlier.csv"
    clicks.write(path, given, court.points)
    page = open_page(make())
    page.set_input_files("#chooser", path)
    until(page, "document.getElementById('message').textContent.startsWith('Loaded 35')")
    again = saved(page, tmp_path)
    assert again.name == "court_points.csv"
    read = clicks.read(again, ["back", "oblique"], court.points)
    for camera in given:
        np.testing.assert_array_equal(read[camera], given[camera])
    page.click("#undo")
    assert marked(page) == {}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("a,b\n1,2\n", "expected the columns camera,point,frame_idx,x_px,y_px, found a,b"),
        ("camera,point,frame_idx,x_px,y_px\nfront,p01,0,1,2\n", 'no picture of camera "front"'),
        ("camera,point,frame_idx,x_px,y_px\nback,p99,0,1,2\n",
         'line 2: the court has no point "p99"'),
        ("camera,point,frame_idx,x_px,y_px\nback,p01,0,99999,-50\n",
         "line 2: expected a place in the picture of 960 x 540 px, found 99999, -50"),
        ("camera,point,frame_idx,x_px,y_px\nback,p01,0,one,2\n", 'x_px as a number, found "one"'),
        ("camera,point,frame_idx,x_px,y_px\n\nback,p01,0,1\n", "line 3: expected 5 cells, found 4"),
        ("camera,point,frame_idx,x_px,y_px\nback,p01,0,1,2\nback,p01,0,1,2\n",
         "line 3: p01 is there twice"),
    ],
)  # fmt: skip
def test_a_table_that_is_none_changes_nothing(open_page, make, tmp_path, text, words):
    path = tmp_path / "odd.csv"
    path.write_text(text)
    page = open_page(make(clicks={"back": {"p01": (5.0, 6.0)}}))
    page.set_input_files("#chooser", path)
    page.wait_for_selector("#message.bad")
    message = page.inner_text("#message")
    assert words in message and "\n" not in message and message.startswith("odd.csv: ")
    assert marked(page) == {("back", "p01"): (5.0, 6.0)}


def clicked(court, views, rng, wrong=None, points=None):
    """Return clicks of the first camera with 0.2 px of scatter; one of them 9 px off."""
    made = {p: xy + rng.normal(0, 0.2, 2) for p, xy in truth(court, views, "back").items()}
    if wrong:
        made[wrong] = made[wrong] + (0, 9)
    return {"back": {p: xy.tolist() for p, xy in made.items() if points is None or p in points}}


@pytest.mark.parametrize("wrong", ["p01", "p06", "p13", "p18"])
def test_the_point_that_fits_worst_is_named(open_page, make, court, views, wrong):
    rng = np.random.default_rng(1)
    page = open_page(make(clicks=clicked(court, views, rng, wrong)))
    until(page, "document.getElementById('fit').textContent")  # once the picture is there
    message = page.inner_text("#fit")
    assert f"Look again at {wrong}:" in message
    off = float(re.search(r"([\d.]+) px from where", message).group(1))
    assert 7 < off < 14
    assert page.locator("#list .worst").count() == 1


def test_good_clicks_are_not_blamed_and_the_rest_is_foretold(open_page, make, court, views):
    known = ("p01", "p02", "p03", "p04", "p07", "p12", "p16", "p17", "p18")
    given = clicked(court, views, np.random.default_rng(2), points=known)
    page = open_page(make(clicks=given))
    assert "Look again" not in page.inner_text("#fit")
    assert "9 points fit a camera with a lens to 0." in page.inner_text("#fit")
    size = json.dumps(views[0].size)
    points = json.dumps(
        [{"name": p, "xyz": court.xyz[court.points.index(p)].tolist(), "xy": given["back"][p]}
         for p in known]
    )  # fmt: skip
    wanted = json.dumps(court.xyz.tolist())
    found = page.evaluate(
        f"(() => {{ const f = clickFit.fit({points}, {size}); return {wanted}.map(f.project); }})()"
    )
    exact = projection.project(views[0], court.xyz)
    assert np.linalg.norm(np.array(found) - exact, axis=1).max() < 1.2


def test_four_floor_points_give_a_view_and_five_a_residual(open_page, make, court, views):
    floor = ("p01", "p02", "p03", "p16", "p08")
    given = clicked(court, views, np.random.default_rng(2), points=floor)
    page = open_page(make(clicks=given))
    assert "5 floor points fit a flat floor" in page.inner_text("#fit").replace(
        "points", "floor points"
    )
    choose(page, "p08")
    page.keyboard.press("Delete")
    assert "one more tells" in page.inner_text("#fit")
    page.keyboard.press("g")  # goes to where it is expected
    page.keyboard.press("Space")
    error = np.subtract(marked(page)["back", "p08"], truth(court, views, "back")["p08"])
    assert np.linalg.norm(error) < 2.5


def test_proposals_wait_for_a_key(open_page, make, court, views):
    true = truth(court, views, "back")
    hollow = {p: {"x": true[p][0], "y": true[p][1], "sigma_px": 0.3} for p in ("p01", "p04", "p05")}
    page = open_page(make(proposals={"back": hollow}))
    assert marked(page) == {}
    assert "proposed, ±0.3 px" in page.inner_text("#chosen-state")
    page.keyboard.press("Enter")  # the first shows it from near
    assert marked(page) == {} and "Look at p01" in page.inner_text("#message")
    page.keyboard.press("Enter")
    assert list(marked(page)) == [("back", "p01")]
    choose(page, "p04")
    page.keyboard.press("Enter")
    assert page.inner_text("#chosen-name") == "p05"
    page.keyboard.press("h")
    page.keyboard.press("n")
    page.keyboard.press("Enter")
    assert "no proposal for p06" in page.inner_text("#message")
    found = marked(page)
    assert set(found) == {("back", "p01"), ("back", "p04")}
    for (_, point), xy in found.items():
        np.testing.assert_allclose(xy, true[point], atol=1e-3)


@pytest.mark.parametrize("first", ["p01", "p16"])
def test_one_mark_says_which_end_of_the_court_is_meant(open_page, make, court, views, first):
    true = truth(court, views, "back")
    turned = {"p01": "p16", "p02": "p03", "p04": "p07", "p05": "p06"}
    turned |= {other: name for name, other in turned.items()}
    hollow = {p: {"x": true[p][0], "y": true[p][1], "sigma_px": 0.3} for p in turned if p in true}
    hollow = {p: {**place, "either": True} for p, place in hollow.items()}
    page = open_page(make(proposals={"back": hollow}, clicks={"back": {first: true["p01"]}}))
    assert "not which end" in page.inner_text("#message")
    choose(page, "p04" if first == "p01" else "p07")
    page.keyboard.press("Enter")
    page.keyboard.press("Enter")
    found = marked(page)["back", "p04" if first == "p01" else "p07"]
    np.testing.assert_allclose(found, true["p04"], atol=1e-3)
    page = open_page(make(name="unmarked", proposals={"back": hollow}))
    choose(page, "p04")
    page.keyboard.press("Enter")
    assert "no proposal for p04" in page.inner_text("#message") and marked(page) == {}


def test_work_is_kept_by_the_browser_and_can_be_forgotten(open_page, make):
    page = open_page(make())
    page.keyboard.press("Space")
    kept = marked(page)
    reload(page)
    assert marked(page) == kept and "is here again" in page.inner_text("#message")
    page.click("#help summary")
    page.click("#afresh")
    reload(page)
    assert marked(page) == {}


def test_each_table_counts_as_unsaved_until_it_is_saved(open_page, make, pictures, tmp_path):
    frame = {"size": (960, 540), "image": pictures["back"], "take": "smash1", "camera": "back"}
    page = open_page(make(more=[clicking_page.Frame(frame_idx=12, **frame)]))
    waiting = {}
    for tab in ("smash1 back 12", "back"):
        page.click(f"#tabs button:has-text('{tab}') >> nth=0")
        page.keyboard.press("Space")
        waiting[tab] = page.inner_text("#where")
    saved(page, tmp_path)
    assert "Not saved yet" not in page.inner_text("#where")
    page.click("text=smash1 back 12")
    waiting["after"] = page.inner_text("#where")
    reload(page)
    assert "Not saved yet" not in page.inner_text("#where")
    page.click("text=smash1 back 12")
    until(page, "document.querySelector('#tabs [aria-selected=true]').innerText.includes('smash')")
    waiting["restored"] = page.inner_text("#where")
    assert all("Not saved yet" in words for words in waiting.values())


def test_other_clicks_or_another_session_start_of_their_own(open_page, make):
    page = open_page(make())
    page.keyboard.press("Space")
    for other in (make("other", clicks={"back": {"p02": (1, 2)}}), make("third", session="gym")):
        page.goto(other.as_uri())
        ready(page)
        assert ("back", "p01") not in marked(page)


def test_without_storage_the_page_still_works(open_page, make):
    page = open_page(make())
    page.add_init_script(FORBIDDEN)
    reload(page)
    page.keyboard.press("Space")
    assert list(marked(page)) == [("back", "p01")]


def test_ends_of_rackets_are_clicked_on_frames_of_takes(open_page, make, pictures, tmp_path):
    frame = {"size": (960, 540), "image": pictures["back"], "take": "smash1", "camera": "back"}
    more = [clicking_page.Frame(frame_idx=at, **frame) for at in (12, 90)]
    page = open_page(make(more=more))
    page.click("text=smash1 back 90")
    page.keyboard.press("Space")
    page.keyboard.press("n")
    page.keyboard.press("Space")
    page.keyboard.press("ArrowRight")
    path = saved(page, tmp_path, "racket")
    rows = path.read_text().splitlines()
    assert rows[0] == "take,camera,frame_idx,end,x_px,y_px"
    assert [row.split(",")[:4] for row in rows[1:]] == [
        ["smash1", "back", "90", end] for end in ("top", "butt")
    ]
    page.keyboard.press("Control+z")
    page.set_input_files("#chooser", path)
    until(page, "document.getElementById('message').textContent.startsWith('Loaded 2')")
    assert page.input_value("#text") == path.read_text()
    assert page.is_hidden("#drawings")


def test_dragging_moves_the_picture_and_clicks_nothing(open_page, make):
    page = open_page(make())
    before = dots(screen(page))
    box = page.locator("#view").bounding_box()
    page.mouse.move(box["x"] + 300, box["y"] + 250)
    page.mouse.down()
    page.mouse.move(box["x"] + 340, box["y"] + 280, steps=4)
    page.mouse.up()
    after = dots(screen(page))
    assert marked(page) == {}
    moved = after[np.argmin(np.linalg.norm(after - before[0] - (40, 30), axis=1))] - before[0]
    np.testing.assert_allclose(moved, (40, 30), atol=1)


def test_two_fingers_zoom_and_one_taps(open_page, make):
    page = open_page(make(), width=400, height=800, has_touch=True)
    box = page.locator("#view").bounding_box()
    session = page.context.new_cdp_session(page)

    def touch(kind, *places):
        points = [
            {"x": box["x"] + x, "y": box["y"] + y, "id": n} for n, (x, y) in enumerate(places)
        ]
        session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    touch("touchStart", (150, 200))
    touch("touchStart", (150, 200), (200, 200))
    for step in range(1, 11):
        touch("touchMove", (150 - 10 * step, 200), (200 + 10 * step, 200))
    touch("touchEnd")
    next_frames(page)
    zoom = float(page.inner_text("#zoom").rstrip("×"))
    assert zoom == pytest.approx(400 / 960 * 5, rel=0.1)
    assert marked(page) == {}
    page.touchscreen.tap(box["x"] + 100, box["y"] + 200)
    assert list(marked(page)) == [("back", "p01")]


@pytest.mark.parametrize("width", [400, 1280])
def test_nothing_is_wider_than_the_window(open_page, make, width):
    page = open_page(make(), width=width)
    assert page.evaluate("document.documentElement.scrollWidth") <= width


def test_the_page_is_light_without_its_pictures(make, pictures):
    path = make()
    held = sum(len(base64.b64encode(picture)) for picture in pictures.values())
    assert path.stat().st_size - held < 200_000


def test_a_file_of_one_camera_leaves_the_marks_of_the_others(open_page, make, tmp_path):
    given = {"back": {"p01": (5.0, 6.0), "p02": (7.0, 8.0)}, "oblique": {"p01": (1.0, 2.0)}}
    page = open_page(make(clicks=given))
    path = tmp_path / "one.csv"
    path.write_text("camera,point,frame_idx,x_px,y_px\noblique,p02,0,10,-5\n")  # 5 px: not exact
    page.set_input_files("#chooser", path)
    until(page, "document.getElementById('message').textContent.startsWith('Loaded 1 row of')")
    assert "marks of oblique. Those of back stay." in page.inner_text("#message")
    of_back = {("back", point): xy for point, xy in given["back"].items()}
    assert marked(page) == {**of_back, ("oblique", "p02"): (10.0, -5.0)}
    reload(page)
    page.click("#undo")
    assert marked(page) == {**of_back, ("oblique", "p01"): (1.0, 2.0)}
    path.write_text("camera,point,frame_idx,x_px,y_px\n")
    page.set_input_files("#chooser", path)
    until(page, "document.getElementById('message').textContent.includes('nothing has changed')")
    assert len(marked(page)) == 3


def test_a_page_in_two_tabs_keeps_the_marks_of_the_first_to_change_it(open_page, make):
    one = open_page(make())
    two = second_tab(one.context, one.url)
    one.keyboard.press("Space")
    until(two, "document.getElementById('unkept').textContent.includes('reload before you go on')")
    two.keyboard.press("n")
    two.keyboard.press("Space")
    assert two.is_visible("#unkept") and not one.is_visible("#unkept")
    reload(one)
    assert list(marked(one)) == [("back", "p01")]
    one.click("#help summary")
    one.click("#afresh")
    one.keyboard.press("h")  # and keeps on where its work was deleted
    assert not one.is_visible("#unkept")


def test_a_browser_that_keeps_nothing_says_so_and_asks_before_marks_are_lost(
    open_page, make, tmp_path
):
    page = open_page(make())
    page.add_init_script(FORBIDDEN)
    reload(page)
    asked = []
    page.on("dialog", lambda dialog: (asked.append(dialog.type), dialog.accept()))
    page.keyboard.press("Space")
    assert "This browser keeps nothing: save" in page.inner_text("#unkept")
    saved(page, tmp_path)
    reload(page)
    assert asked == []
    page.click("#view")
    reload(page)
    assert asked == ["beforeunload"]


def test_arrows_change_the_tab_where_it_has_the_focus_and_move_no_mark(open_page, make):
    page = open_page(make(clicks={"back": {"p01": (100.0, 50.0)}}))
    chosen = "document.querySelector('#tabs [aria-selected=true]').innerText.split(' ')[0]"
    page.click('#list [data-point="p01"]')
    page.focus("#tabs button >> nth=0")
    for key, camera in (
        ("ArrowRight", "oblique"),
        ("ArrowRight", "back"),
        ("ArrowLeft", "oblique"),
    ):
        page.keyboard.press(key)
        until(
            page,
            f"{chosen} === '{camera}' && document.activeElement.innerText.startsWith('{camera}')",
        )
    page.keyboard.press("ArrowLeft")
    page.keyboard.press("ArrowDown")
    page.focus("#zoom-in")
    page.keyboard.press("ArrowRight")
    assert marked(page) == {("back", "p01"): (100.0, 50.0)}
    page.keyboard.press("Enter")
    assert page.evaluate("document.activeElement.id") == "zoom-in"
    page.click("#zoom-in")  # with the mouse: keys go to the picture again
    page.keyboard.press("ArrowRight")
    assert marked(page) == {("back", "p01"): (100.1, 50.0)}
