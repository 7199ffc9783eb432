"""Which fixed cameras structure from motion placed: counted on networks whose views are known."""

from courtside.calibration.bundle import selection
from courtside.sfm import registration
from fixtures.cameras import networks_made

FIXED = {"side": "static/side.png", "back": "static/back.png"}
IMAGES = [*FIXED.values(), "frames/walk/000000.png", "frames/walk/000001.png"]


def network(n_side=12, n_back=12):
    """Return a network whose fixed images see the first so many of 12 points."""
    made = networks_made.make(2, 12)
    limit = [n_side, n_back, 12, 12]
    seen = [at < limit[v] for v, at in zip(made.image_idx, made.point_idx, strict=True)]
    return selection.select(made, made.xyz[:, 0] < 1e9, seen)


def outcome(made, images=IMAGES, **options):
    return registration.outcome(made, images, FIXED, min_points=10, **options)


def test_placed_cameras_leave_nothing_to_say():
    assert outcome(network()) == ""
    assert outcome(network(10, 10), n_models=3) == ""


def test_points_are_counted_per_image():
    made = network(7, 3)
    assert [registration.n_seen(made, IMAGES, image) for image in IMAGES] == [7, 3, 12, 12]
    assert registration.n_seen(made, IMAGES, "static/gone.png") == 0


def test_a_camera_with_too_few_points_is_named():
    found = outcome(network(n_back=9))
    assert found.startswith(
        "camera back: expected 10 points or more in common with the walk, found 9 points;"
    )
    assert (
        "film the walk from close beside" in found and "\n" not in found and "models" not in found
    )


def test_a_camera_that_is_not_in_the_model_is_named_with_the_separate_models():
    made = network()
    images = ["static/side.png", "frames/walk/000002.png", *IMAGES[2:]]
    found = outcome(made, images, n_models=2)
    assert found.startswith(
        "camera back: expected 10 points or more in common with the walk, found it unreg"
    )
    assert "; the images fall into 2 separate models;" in found


def test_all_lost_cameras_are_named_with_what_each_sees():
    images = ["static/side.png", "frames/walk/000002.png", *IMAGES[2:]]
    found = outcome(network(n_side=4), images)
    assert found.startswith("cameras side, back: expected 10 points or more")
    assert "found 4 points (side), it unregistered (back);" in found
    assert found.endswith("if a static picture shows another place, give the right one")


def test_images_that_a_model_lacks_are_called_by_name_with_the_likely_reason():
    called = {"4.png": "06.jpg (4.png)"}
    names = [f"{at}.png" for at in range(9)]
    alone, others = registration.lost(names, ["4.png"], lambda name: called.get(name, name))
    assert alone == (
        "not in the model: 06.jpg (4.png): no match joins it with the others; leave it out if it "
        "shows another place, or add pictures in between"
    )
    assert others.startswith("not in the model: 0.png, 1.png, 2.png, 3.png, 5.png and 3 more: too")
    assert registration.lost([], ["4.png"], str) == []


def test_a_model_without_images_is_a_fault_of_the_walk():
    found = outcome(network(), [])
    assert (
        found.startswith("walk: expected images that overlap, found no two") and "\n" not in found
    )


def test_where_nothing_was_mapped_a_camera_without_matches_is_the_fault():
    walk = IMAGES[2:]
    found = outcome(network(), [], matched={FIXED["side"], *walk})
    assert found.startswith("camera back: expected 10 points or more in common with the walk, ")
    assert "found no match with any image; film the walk from close beside" in found
    for matched in (set(), set(walk), {*FIXED.values(), *walk}, None):
        assert outcome(network(), [], matched=matched).startswith("walk: expected images that")
