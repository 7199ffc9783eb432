"""Two-view geometries: exact matches are all explained, a moved image's and false ones are not."""

from contextlib import closing
from dataclasses import replace

import numpy as np
import pycolmap
import pytest

from courtside.geometry.camera import Camera
from courtside.sfm import database, model, two_views
from fixtures.cameras import sfm_made


@pytest.fixture(scope="module")
def synthetic(tmp_path_factory):
    path = tmp_path_factory.mktemp("synthetic") / "matches.db"
    views = model.views(sfm_made.synthetic(path))
    return path, [view.name for view in views], views


def explained(path, names, views):
    return two_views.explained(two_views.read(path, names), views)


def moved(view: Camera, by: tuple[float, float, float]) -> Camera:
    """Move a camera's centre, in its own frame, by parts of its distance from the origin."""
    pose = view.cam_from_world.copy()
    pose[:, 3] += np.array(by) * np.linalg.norm(pose[:, 3])
    return replace(view, cam_from_world=pose)


def test_exact_matches_are_all_explained_and_the_file_stays(synthetic):
    path, names, views = synthetic
    before = path.read_bytes()
    found = explained(path, names, views)
    assert (found.share, found.image_share, found.pair_share) == (1.0, 1.0, 1.0)
    assert path.read_bytes() == before and [p.name for p in path.parent.iterdir()] == [path.name]


def test_a_misplaced_image_and_its_pairs_are_named(synthetic):
    path, names, views = synthetic
    changed = [moved(views[0], (0.3, 0.2, 0.0)), *views[1:]]
    found = explained(path, names, changed)
    assert found.image == names[0] and found.image_share < 0.5 and names[0] in found.pair
    assert found.pair_share <= found.image_share < found.share < 1
    assert found.share == pytest.approx(1 - (1 - found.image_share) / 3, abs=1e-6)  # 5 of 15 pairs


def test_cameras_behind_what_they_saw_explain_nothing(synthetic):
    """Their epipolar lines are the same: only the depths tell."""
    path, names, views = synthetic
    others = [replace(v, cam_from_world=v.cam_from_world * [1, 1, 1, -1]) for v in views]
    found = explained(path, names, others)  # every baseline the other way round
    assert (found.share, found.pair_share) == (0.0, 0.0)


@pytest.mark.parametrize(
    ("pairs", "joined"),
    [
        (["ab", "bc", "cd"], "abcd"),
        (["ac", "ad"], "acd"),
        (["ab", "ac", "de"], "abc"),  # two pictures of another place match each other
        (["de", "cd", "ab"], "cde"),
        ([], "abcde"),
    ],
)
def test_images_that_matches_join_are_one_group(pairs, joined):
    matches = {tuple(pair): np.zeros((20, 2), int) for pair in pairs}
    found = two_views.joined(two_views.Verified(tuple("abcde"), {}, matches))
    assert "".join(found) == joined


def test_an_image_that_is_not_in_the_map_explains_nothing(synthetic):
    path, names, views = synthetic
    found = explained(path, names, views[1:])
    assert (found.image, found.image_share, found.share) == (names[0], 0.0, pytest.approx(10 / 15))
    assert explained(path, [], []) == (1.0, "", 1.0, ("", ""), 1.0)


def test_pairs_of_few_matches_are_not_judged_alone(synthetic, monkeypatch):
    path, names, views = synthetic
    monkeypatch.setattr(two_views, "PAIR_MATCHES", 151)
    found = explained(path, names, views[1:])
    assert (found.pair, found.pair_share, found.image) == (("", ""), 1.0, names[0])


def test_known_lenses_give_relative_poses_and_drop_false_matches(synthetic, tmp_path):
    path, names, views = synthetic
    spoiled, n_false = tmp_path / "matches.db", 20
    with database.new(spoiled, path) as copy, closing(pycolmap.Database.open(copy)) as opened:
        geometry = opened.read_two_view_geometry(1, 2)
        matches = np.array(geometry.inlier_matches)
        matches[:n_false, 1] = matches[n_false - 1 :: -1, 1]
        geometry.inlier_matches = matches
        opened.delete_two_view_geometry(1, 2)
        opened.write_two_view_geometry(1, 2, geometry)
    before = spoiled.read_bytes()
    with (
        two_views.with_known_lenses(spoiled, names[:3], seed=0) as known,
        closing(pycolmap.Database.open(known)) as opened,
    ):
        cleaned = opened.read_two_view_geometry(1, 2)
        assert opened.read_all_cameras()[0].has_prior_focal_length
        assert opened.read_two_view_geometry(4, 5).config == geometry.config  # not asked for
    assert spoiled.read_bytes() == before
    assert len(matches) - n_false <= len(cleaned.inlier_matches) < len(matches) - n_false // 2
    assert cleaned.config == int(pycolmap.TwoViewGeometryConfiguration.CALIBRATED)
    ids = sorted(range(len(views)), key=lambda at: views[at].name)[:2]
    one, other = (views[at].cam_from_world for at in ids)
    turn = other[:, :3] @ one[:, :3].T
    shift = other[:, 3] - turn @ one[:, 3]
    found = cleaned.cam2_from_cam1
    np.testing.assert_allclose(found.rotation.matrix(), turn, atol=1e-3)
    direction = found.translation / np.linalg.norm(found.translation)
    np.testing.assert_allclose(direction, shift / np.linalg.norm(shift), atol=5e-3)
