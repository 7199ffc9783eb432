"""Plans: what they say, and that a plan that cannot be is refused in one line for each fault."""

import pytest
import yaml

from courtside.study.configuration import plans
from courtside.study.errors import InputError
from fixtures.cameras import hall_plan


@pytest.fixture
def content():
    return yaml.safe_load(hall_plan.PLAN.read_text())


def written(tmp_path, content):
    path = tmp_path / "plan.yaml"
    path.write_text(yaml.safe_dump(content))
    return path


def test_the_plan_of_the_study_reads():
    found = plans.read(hall_plan.PLAN)
    assert list(found.cameras) == ["side", "back"]
    assert found.cameras["side"].place_m == (-17.95, 6.7, 1.9)
    assert (found.cameras["side"].focal_px, found.cameras["side"].fov_deg) == (1120, None)
    assert found.walk.way_m[0] == (-17.93, 5.89)
    assert len(found.walk.way_m) == 5
    assert found.n_images == (0, 5, 10, 20, 40, 75)
    assert (found.click_sigma_px, found.target_cm) == (None, None)
    for name, camera in zip(found.cameras, hall_plan.fixed(), strict=True):
        assert found.cameras[name].place_m == pytest.approx(camera.centre_in_world)


def test_what_is_left_out_has_a_default(tmp_path, content):
    del content["texture"], content["walk"]["height_m"], content["walk"]["via_m"]
    content |= {"n_images": [40, 20], "target_cm": 1, "click_sigma_px": 1.5}
    found = plans.read(written(tmp_path, content))
    assert (found.texture, found.walk.height_m, found.n_images) == ("plain", 1.6, (20, 40))
    assert len(found.walk.way_m) == 2
    assert (found.target_cm, found.click_sigma_px) == (1, 1.5)


def test_a_plan_needs_no_walk(tmp_path, content):
    del content["walk"], content["n_images"]
    found = plans.read(written(tmp_path, content))
    assert (found.walk, found.n_images) == (None, (0,))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda c: c.pop("walk"), r"n_images: expected \[0\] without a walk, found \[0, 5, "),
        (lambda c: c.pop("n_images"), "n_images: expected the numbers of bridging images to"),
        (
            lambda c: c["cameras"]["side"].pop("focal_px"),
            "cameras.side: expected .*focal_px or fov_deg",
        ),
        (lambda c: c["walk"].update(fov_deg=60), "walk: expected .*focal_px or fov_deg"),
        (lambda c: c["cameras"].pop("side"), "cameras: expected at least 2 entries"),
        (
            lambda c: c["cameras"]["side"].update(place_m=[-60, 6, 2]),
            "cameras.side.place_m: .*within hall_m",
        ),
        (
            lambda c: c["walk"].update(height_m=9.9, via_m=[[0, 60]]),
            "walk: place 1: .*within hall_m",
        ),
        (lambda c: c["walk"].update(via_m=[c["walk"]["to_m"]]), "twice in a row"),
        (lambda c: c.update(hall_m=[[0, 0, 0], [9, 9, 0.5]]), "hall_m: expected corners"),
        (lambda c: c.update(texture="bare"), "texture: expected one of"),
        (lambda c: c.update(n_images=[20, 20]), "n_images"),
        (lambda c: c.update(targt_cm=1), "did you mean 'target_cm'"),
    ],
)  # fmt: skip
def test_a_plan_that_cannot_be(tmp_path, content, change, message):
    change(content)
    with pytest.raises(InputError, match=message) as caught:
        plans.read(written(tmp_path, content))
    assert all(line.startswith(str(tmp_path)) for line in str(caught.value).splitlines())
