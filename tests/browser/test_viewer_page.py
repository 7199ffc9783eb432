"""The viewer in a real browser: it opens fast, plays, and draws where the numbers say."""

import time
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from browser.waiting import next_frames, told, until
from courtside.calibration.court import court
from courtside.pages import page as pages
from courtside.pages.viewer import layers as viewer_layers
from courtside.pages.viewer import viewer
from courtside.records.keypoints import keypoints
from fixtures.cameras import scene
from fixtures.people import walker

pytestmark = pytest.mark.browser
COURT = Path(__file__).parents[2] / "config" / "courts" / "badminton.yaml"
ROGUE = "p</b><i>1</i>\"&'"
MINUTE, RATE_HZ = 60, 60


def long_take(n_persons=1):
    """Return a Keypoints3D of 60 s at 60 Hz: the walker on a circle, with noise of 3 mm."""
    short = walker.points(n_frames=20, n_persons=n_persons)
    n_frames = MINUTE * RATE_HZ
    angle = np.linspace(0, 20, n_frames)[:, None]
    body = walker.body(20)[0] - walker.body(20)[0, :1] * [1, 1, 0]
    centre = np.stack([3 + 2 * np.cos(angle), 3 + 2 * np.sin(angle), 0 * angle], axis=-1)
    xyz = np.stack([body + centre + [0, 6 * at, 0] for at in range(n_persons)])
    rng = np.random.default_rng(0)
    shape = xyz.shape[:3]
    sigma = 0.01 + 0.005 * rng.random((*shape, 1, 1)) + 0.01 * (np.sin(angle) > 0)[..., None, None]
    errors = keypoints.unknown_errors(xyz) | {
        "covariance_2d": sigma**2 * np.diag([1.0, 4.0, 1.0]),
        "covariance_camera": np.broadcast_to(np.eye(3) * 1e-4, (*shape, 3, 3)),
    }
    return replace(
        short,
        time_s=np.arange(n_frames) / RATE_HZ,
        xyz=xyz + rng.normal(0, 0.003, xyz.shape),
        **errors,
        n_views=np.full(shape, 3),
        reproj_error_px=rng.uniform(1, 9, (*shape, 3)),
        accepted=np.ones((*shape, 3), bool),
        swapped=np.zeros((*shape, 3), bool),
        reason=np.zeros(shape, np.uint8),
        person_id=np.array([ROGUE, "p2"][:n_persons]),
    )


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Return the page of three layers and the points of the first."""
    points = long_take()
    layers = []
    for at, name in enumerate(("raw", "filtered", "corrected")):
        moved = replace(points, xyz=points.xyz + np.array([0, 0, 0.02 * at]))
        layers.append(viewer_layers.of_points(name, moved, walker.SKELETON, shown=at == 0))
    path = tmp_path_factory.mktemp("viewer") / "viewer.html"
    source = viewer.build("A take", layers, scene.ring(4), court.read(COURT))
    pages.write(path, source)
    return path, points


@pytest.fixture
def opened(made, open_page):
    page = open_page(made[0])
    page.evaluate("courtside.viewer.ready")
    return page, made[1]


def picture(page):
    """Return what the canvas shows, (H, W, 3) uint8."""
    png = page.locator("#canvas").screenshot()
    return cv2.imdecode(np.frombuffer(png, np.uint8), cv2.IMREAD_COLOR)


def joint(page, name="left_wrist"):
    found = [one for one in page.evaluate("courtside.viewer.drawn()") if one["joint"] == name]
    return np.array([found[0]["x"], found[0]["y"]])


def at_pixel(image, xy, reach=2):
    x, y = np.round(xy).astype(int)
    return image[y - reach : y + reach + 1, x - reach : x + reach + 1].reshape(-1, 3).astype(int)


def test_a_minute_of_three_layers_is_small_and_opens_within_two_seconds(made, open_page):
    assert made[0].stat().st_size <= 8_000_000
    start = time.monotonic()
    page = open_page(made[0])
    page.evaluate("courtside.viewer.ready")
    assert time.monotonic() - start < 4  # with the browser's own start of a window
    assert page.evaluate("courtside.viewer.opened_ms") < 2000
    state = page.evaluate("courtside.viewer.state()")
    assert (state["n_frames"], state["playing"]) == (3600, False)
    assert [layer["shown"] for layer in state["layers"]] == [True, False, False]


def test_it_opens_at_the_first_frame_that_shows_a_person(open_page, tmp_path):
    points = long_take()
    points.xyz[:, :90] = np.nan
    layer = viewer_layers.of_points("raw", points, walker.SKELETON, shown=True)
    path = tmp_path / "viewer.html"
    pages.write(path, viewer.build("A take", [layer], scene.ring(4), court.read(COURT)))
    page = open_page(path)
    page.evaluate("courtside.viewer.ready")
    assert page.evaluate("courtside.viewer.state()")["frame"] == 90
    assert len(page.evaluate("courtside.viewer.drawn()")) == len(points.joints)
    page.keyboard.press("Home")
    next_frames(page)
    assert page.evaluate("courtside.viewer.drawn()") == []


def test_the_clock_tells_the_time_alone(open_page, tmp_path):
    late = long_take()
    later = replace(late, time_s=late.time_s + 1)  # the page begins before these frames
    names = {"raw": later, "filtered": late}
    layers = [viewer_layers.of_points(n, one, walker.SKELETON) for n, one in names.items()]
    path = tmp_path / "viewer.html"
    pages.write(path, viewer.build("A take", layers))
    page = open_page(path)
    page.evaluate("courtside.viewer.ready")
    assert page.evaluate("courtside.viewer.state()")["frame"] > 0
    assert page.inner_text("#clock") == "1.000 s"


def test_positions_and_covariances_are_the_inputs(opened):
    page, points = opened
    ask = "([person, joint, frame]) => courtside.viewer.NAME('raw', person, joint, frame)"
    for name in ("nose", "right_heel"):
        j = points.joints.tolist().index(name)
        for frame in (0, 1, 1799, 3599):
            xyz = page.evaluate(ask.replace("NAME", "position"), [ROGUE, name, frame])
            assert np.abs(np.array(xyz) - points.xyz[0, frame, j]).max() <= 0.00051
            found = np.array(page.evaluate(ask.replace("NAME", "covariance"), [ROGUE, name, frame]))
            true = points.covariance_2d[0, frame, j] + points.covariance_camera[0, frame, j]
            assert np.abs(found - true).max() < 0.08 * np.abs(true).max()
            px = page.evaluate(ask.replace("NAME", "reprojection_px"), [ROGUE, name, frame])
            errors = points.reproj_error_px[0, frame, j]
            assert px == pytest.approx(np.sqrt((errors**2).mean()), rel=0.03)


def test_the_slider_moves_the_skeleton(opened):
    page, _ = opened
    before, place = picture(page), joint(page)
    page.locator("#slider").evaluate("s => { s.value = 900; s.dispatchEvent(new Event('input')); }")
    next_frames(page)
    after, moved = picture(page), joint(page)
    assert page.evaluate("courtside.viewer.state()")["time_s"] == pytest.approx(15)
    assert np.linalg.norm(moved - place) > 20
    assert (before != after).any(axis=2).sum() > 500
    # Blue of the left side stands where the joint is said to be, and no longer where it was.
    blue = np.array([0xB2, 0x72, 0x00])
    assert np.abs(at_pixel(after, moved) - blue).max(axis=1).min() < 12
    assert np.abs(at_pixel(before, place) - blue).max(axis=1).min() < 12
    assert np.abs(at_pixel(after, place, 1) - blue).max(axis=1).min() > 40


def test_it_plays_at_the_speed_asked_for_and_pauses(opened):
    page, _ = opened
    for speed in ("0.5", "2"):
        page.select_option("#speed", speed)
        page.evaluate("courtside.viewer.seek(5)")
        before = picture(page)
        started_ms = page.evaluate("performance.now()")
        page.click("#play")
        page.wait_for_timeout(1000)
        assert page.locator("#play").inner_text() == "Pause"
        page.click("#play")
        passed_s = (page.evaluate("performance.now()") - started_ms) / 1000
        state = page.evaluate("courtside.viewer.state()")
        assert not state["playing"]
        assert 0.5 * float(speed) < state["time_s"] - 5 < (passed_s + 0.1) * float(speed)
        assert (picture(page) != before).any()
    next_frames(page)
    assert page.evaluate("courtside.viewer.state()")["time_s"] == state["time_s"]


def test_playing_ends_at_the_end_and_begins_again(opened):
    page, _ = opened
    page.evaluate("courtside.viewer.seek(59.8)")
    page.click("#play")
    until(page, "!courtside.viewer.state().playing")
    assert page.evaluate("courtside.viewer.state()")["frame"] == 3599
    page.click("#play")
    next_frames(page)
    assert page.evaluate("courtside.viewer.state()")["time_s"] < 5


def test_keys_step_and_switch(opened):
    page, _ = opened
    page.locator("#canvas").focus()
    for key, frame in (
        ("End", 3599),
        ("Home", 0),
        ("ArrowRight", 1),
        ("Shift+ArrowRight", 61),
        ("ArrowLeft", 60),
    ):
        page.keyboard.press(key)
        assert page.evaluate("courtside.viewer.state()")["frame"] == frame
    page.keyboard.press("2")
    assert [one["shown"] for one in page.evaluate("courtside.viewer.state()")["layers"]] == [
        True,
        True,
        False,
    ]
    place = joint(page)
    page.keyboard.press("a")
    next_frames(page)
    assert np.linalg.norm(joint(page) - place) > 2
    page.keyboard.press("Space")
    assert page.evaluate("courtside.viewer.state()")["playing"]


def test_a_joint_is_picked_and_read(opened):
    page, points = opened
    page.evaluate("courtside.viewer.seek(10)")
    x, y = joint(page, "right_heel")
    page.locator("#canvas").click(position={"x": float(x), "y": float(y)})
    picked = page.evaluate("courtside.viewer.state()")["picked"]
    assert picked["person"] == ROGUE
    page.locator("#readout table").wait_for()  # drawn with the next picture
    message = page.locator("#readout").inner_text()
    assert ROGUE in message
    j = points.joints.tolist().index(picked["joint"])
    xyz = points.xyz[0, 600, j]
    for name, value in zip("xyz", xyz, strict=True):
        row = page.locator("#readout tr", has=page.get_by_text(f"{name} (m)", exact=True))
        assert float(row.locator("td").first.inner_text()) == pytest.approx(value, abs=0.0011)
    total = points.covariance_2d[0, 600, j] + points.covariance_camera[0, 600, j]
    row = page.locator("#readout tr", has=page.get_by_text("σ (mm)", exact=True))
    sigma = float(row.locator("td").first.inner_text())
    assert sigma == pytest.approx(1000 * np.sqrt(np.trace(total)), rel=0.03)
    before = picture(page)
    page.select_option("#magnified", "20")
    next_frames(page)
    assert (picture(page) != before).any(axis=2).sum() > 300


def test_errors_are_coloured_with_a_legend(opened):
    page, points = opened
    page.select_option("#colour", "sigma")
    next_frames(page)
    legend = page.locator("#legend").inner_text()
    assert "mm" in legend and "keypoints and cameras" in legend
    end = page.evaluate("courtside.viewer.state()")["scale_end"]
    sigma = 1000 * np.sqrt(
        np.trace(points.covariance_2d + points.covariance_camera, axis1=-2, axis2=-1)
    )
    assert 0.8 * np.percentile(sigma, 95) < end < 2.6 * np.percentile(sigma, 95)
    page.select_option("#colour", "distance")
    page.locator("#layers input").nth(2).check()
    next_frames(page)
    assert "distance from raw (mm)" in page.locator("#legend").inner_text()
    # `corrected` lies 40 mm above `raw`: the scale ends at the next round number.
    assert page.evaluate("courtside.viewer.state()")["scale_end"] == 50


@pytest.mark.parametrize("up_deg", [-30, 0, 20, 40])
def test_through_a_camera_the_eye_stands_where_it_stands_and_looks_its_way(opened, up_deg):
    page, _ = opened
    up = np.radians(up_deg)
    camera = {"centre": [1.0, -6.0, 0.4], "forward": [0, np.cos(up), np.sin(up)], "focal": 0.9}
    look = """([camera, points]) => {
      const eye = new Eye();
      eye.through(camera, [0, 4, 1.2]);
      const found = [eye.place, eye.forward];
      eye.turn(0.1, 0);
      eye.fit(points);
      return [...found, eye.forward];
    }"""
    place, forward, after = page.evaluate(look, [camera, [[0, 0, 0], [1, 1, 2]]])
    np.testing.assert_allclose(place, camera["centre"], atol=1e-9)
    np.testing.assert_allclose(forward, camera["forward"], atol=1e-9)
    assert after[2] < 0.2  # by hand it does not look up from below the floor


DISTANCES = """async () => {
  const unpacked = courtside.data("layers").map((one) => Layer.unpack(one, [0, 0, 0], 0));
  const [first, other] = await Promise.all(unpacked);
  return other.time_s.map((_, frame) => other.distanceMm(first, 0, 0, frame));
}"""


def circling(time_s, missing=()):
    """Return a layer whose joint goes round at 6 m/s."""
    angle = 10 * np.asarray(time_s)
    xyz = np.stack([0.6 * np.cos(angle), 0.6 * np.sin(angle), 1 + 0 * angle], axis=-1)
    xyz[list(missing)] = np.nan
    shape = ["right_wrist"], [], np.array(["p1"])
    return viewer_layers.Layer(f"{len(time_s)}", *shape, np.asarray(time_s), xyz[None, :, None])


def test_the_same_motion_at_two_rates_is_at_no_distance(open_page, tmp_path):
    first = circling(np.arange(120) / 30, missing=[60])
    other = circling(0.004 + np.arange(239) / 60)
    path = tmp_path / "viewer.html"
    pages.write(path, viewer.build("A take", [first, other]))
    page = open_page(path)
    page.evaluate("courtside.viewer.ready")
    found = np.array(page.evaluate(DISTANCES), float)
    beside = (other.time_s > 59 / 30) & (other.time_s < 61 / 30)
    assert np.isnan(found[beside]).all() and 3 <= beside.sum() <= 4
    known = found[~beside & (other.time_s <= first.time_s[-1])]
    assert known.max() < 10  # mm; the chord of a thirtieth of a second lies 8.3 mm off the circle


def test_a_distance_needs_no_neighbour_on_a_frame_and_bridges_no_gap(open_page, tmp_path):
    times_s = np.delete(np.arange(60) / 30, [20, 21, 22])
    first, other = circling(times_s, missing=[40]), circling(np.arange(60) / 30)
    path = tmp_path / "viewer.html"
    pages.write(path, viewer.build("A take", [replace(first, name="first"), other]))
    page = open_page(path)
    page.evaluate("courtside.viewer.ready")
    found = np.array(page.evaluate(DISTANCES), float)
    assert np.flatnonzero(np.isnan(found)).tolist() == [20, 21, 22, 43]
    assert np.nanmax(found) == 0


@pytest.mark.parametrize("width", [400, 1280])
def test_numbers_of_four_methods_are_in_sight(open_page, tmp_path, width):
    names = ("d415-depth", "d415-rgb", "mocopi", "mocopi-corrected")
    points = walker.points(n_frames=20)
    layers = [viewer_layers.of_points(name, points, walker.SKELETON) for name in names]
    path = tmp_path / "viewer.html"
    pages.write(path, viewer.build("A take", layers))
    page = open_page(path, width=width)
    page.evaluate("courtside.viewer.ready")
    page.select_option("#joint", "nose")
    next_frames(page)
    wide = "(one) => [one.scrollWidth, one.clientWidth, one.querySelectorAll('thead th').length]"
    needed, given, columns = page.locator("#readout").evaluate(wide)
    assert needed <= given and columns == 1 + len(names)


def luminance(colour):
    rgb = np.array(colour.removeprefix("rgb(").removesuffix(")").split(","), float) / 255
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    return float(linear @ [0.2126, 0.7152, 0.0722])


def test_the_scale_of_errors_grows_lighter_from_end_to_end(opened):
    page, _ = opened
    found = [luminance(page.evaluate("(value) => shade(value, 60)", at)) for at in range(61)]
    assert (np.diff(found) > 0).all()
    assert found[-1] > 5 * found[0]  # also apart in grey print


def test_several_methods_are_told_apart(opened):
    page, _ = opened
    swatch = page.locator("#layers .swatch").first
    assert page.evaluate("courtside.viewer.state()")["colour"] == "side"
    assert not swatch.is_visible()
    page.locator("#layers input").nth(1).check()
    next_frames(page)
    assert page.evaluate("courtside.viewer.state()")["colour"] == "layer"
    assert page.locator("#colour").input_value() == "layer" and swatch.is_visible()
    assert page.locator("#legend .swatch").count() == 2
    page.select_option("#colour", "side")
    page.locator("#layers input").nth(0).uncheck()
    page.locator("#layers input").nth(2).check()
    page.select_option("#colour", "side")
    next_frames(page)
    assert "filtered: thick; corrected: thin, dashed" in page.locator("#legend").inner_text()


def test_every_switch_works_and_a_layer_can_be_switched_off(opened):
    page, _ = opened
    for view in ("hall", "above", "x", "y", "camera c2", "all"):
        before = picture(page)
        page.select_option("#view", view)
        next_frames(page)
        assert (picture(page) != before).any(), view
    for name in ("#cameras", "#names", "#follow"):
        page.locator(name).click()
    page.select_option("#trail", "Infinity")
    page.locator("#layers input").first.uncheck()
    next_frames(page)
    assert page.evaluate("courtside.viewer.drawn()") == []


def test_the_chosen_person_is_followed_without_a_joint(open_page, tmp_path):
    layer = viewer_layers.of_points("raw", long_take(2), walker.SKELETON)
    path = tmp_path / "viewer.html"
    pages.write(path, viewer.build("A take", [layer], scene.ring(4), court.read(COURT)))
    page = open_page(path)
    page.evaluate("courtside.viewer.ready")
    page.check("#follow")
    middle = page.locator("#canvas").bounding_box()["width"] / 2
    for chosen, other in ((ROGUE, "p2"), ("p2", ROGUE)):
        page.select_option("#person", chosen)
        next_frames(page)
        drawn = page.evaluate("courtside.viewer.drawn()")
        x = {
            who: np.mean([one["x"] for one in drawn if one["person"] == who])
            for who in (chosen, other)
        }
        assert abs(x[chosen] - middle) < 60 < abs(x[other] - middle)


def test_the_hand_turns_moves_and_zooms(opened):
    page, _ = opened
    area = page.locator("#canvas").bounding_box()
    x, y = area["x"] + 100, area["y"] + 100
    places = [joint(page)]
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 60, y + 20, steps=4)
    page.mouse.up()
    next_frames(page)
    places.append(joint(page))
    page.mouse.wheel(0, -300)
    told(page, lambda: np.linalg.norm(joint(page) - places[-1]) > 3)
    places.append(joint(page))
    steps = np.linalg.norm(np.diff(places, axis=0), axis=1)
    assert steps.min() > 3


@pytest.mark.parametrize("width", [400, 1280])
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_it_fits_the_window(made, open_page, width, scheme):
    page = open_page(made[0], width=width, color_scheme=scheme)
    page.evaluate("courtside.viewer.ready")
    page.select_option("#joint", "nose")
    for box in page.locator("#layers input").all():
        box.check()
    next_frames(page)
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert picture(page).std() > 5


def test_on_paper_the_picture_is_light_and_has_the_proportions_of_its_place(made, open_page):
    page = open_page(made[0], color_scheme="dark")
    page.evaluate("courtside.viewer.ready")
    page.select_option("#view", "above")
    floor = "canvas.getContext('2d').getImageData(canvas.width / 2, canvas.height / 2, 1, 1).data"
    page.set_viewport_size({"width": 700, "height": 900})
    page.emulate_media(media="print")
    next_frames(page)
    assert page.evaluate(f"Math.max(...Array.from({floor}).slice(0, 3))") > 200
    shape = "canvas.width / canvas.height / (canvas.clientWidth / canvas.clientHeight)"
    assert page.evaluate(shape) == pytest.approx(1, abs=0.01)


def test_a_browser_too_old_is_told_so(made, browser):
    page = browser.new_page()
    page.add_init_script("delete window.DecompressionStream")
    page.goto(made[0].as_uri())
    page.wait_for_selector("#message:visible")
    assert "too old" in page.locator("#message").inner_text()
    page.close()
