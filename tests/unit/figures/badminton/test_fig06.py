"""Paths are drawn in the order of filming; what has no result says so."""

from pathlib import Path

import numpy as np
import pytest

from courtside.calibration.court import court
from courtside.calibration.records.support import Support
from courtside.calibration.records.tie_points import Record
from courtside.figures.badminton import fig06
from courtside.figures.style import style

COURT = court.read(Path(__file__).parents[4] / "config" / "courts" / "badminton.yaml")
IMAGES = ["walk/000020.png", "static/side.png", "walk/000003.png", "static/back.png"]
CENTRES = np.array([[2.0, -9.0, 1.6], [-18, 6.7, 2], [-8, -3, 1.5], [3, -14, 2]])


def record(outcome="", fault=""):
    return Record(
        outcome=outcome,
        fault=fault,
        sfm_cameras=[],
        n_points_seen=np.array([30, 40]),
        ties=None if outcome or fault else object(),
        images=np.array(IMAGES),
        centres=CENTRES,
        xyz=np.random.default_rng(0).uniform(-5, 25, (50, 3)),
        residual_px=0.5,
        n_maps=(2, 2),
        support=Support(0.9, "", 0.8, ("", ""), 0.7),
    )


@pytest.fixture
def rows():
    failed = record(outcome="camera back: expected 20 points, found 3; film again")
    return fig06.table({10: record(), 5: failed, 7: record(fault="points behind")})


def test_images_come_in_the_order_of_filming(rows):
    path = rows[(rows["n_bridging"] == 10) & (rows["kind"] == "bridging")]
    assert path["name"].tolist() == [IMAGES[2], IMAGES[0]]
    np.testing.assert_array_equal(path[["x_m", "y_m", "z_m"]], CENTRES[[2, 0]])
    fixed = rows[rows["kind"] == "fixed"]
    assert set(fixed["name"]) == {IMAGES[1], IMAGES[3]}
    assert (rows["kind"] == "tie").sum() == 50


def test_there_is_a_panel_for_every_number(rows):
    axes = fig06.draw(rows, COURT, {10: 12}).axes
    titles = [axis.get_title() for axis in axes]
    assert titles == ["N = 10: 4 of 12 images", "N = 7: no result", "N = 5: no result"]
    assert "film again" in " ".join(axes[2].texts[0].get_text().split())
    assert "points behind" in axes[1].texts[0].get_text()


def test_the_mapper_is_named(rows):
    assert fig06.draw(rows, COURT, mapper="global").get_suptitle() == "global mapper"
    assert not fig06.draw(rows, COURT).get_suptitle()


def test_all_cameras_are_inside_the_panel(rows):
    axis = fig06.draw(rows, COURT).axes[0]
    (left, right), (low, high) = axis.get_xlim(), axis.get_ylim()
    assert left < CENTRES[:, 0].min()
    assert right > CENTRES[:, 0].max()
    assert low < CENTRES[:, 1].min()
    assert high > COURT.size_m[1]


def test_drawing_twice_gives_the_same_bytes(rows, tmp_path):
    kinds, contents = ("pdf", "png", "csv"), []
    for name in ("one", "two"):
        paths = [tmp_path / f"{name}.{kind}" for kind in kinds]
        style.save(fig06.draw(rows, COURT), rows, *paths)
        contents.append([path.read_bytes() for path in paths])
    assert contents[0] == contents[1]
