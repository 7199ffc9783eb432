"""Mapping: exact matches give the exact model, the door its measured cameras, noise nothing."""

import sqlite3
from contextlib import ExitStack, closing

import numpy as np
import pycolmap
import pytest
import scipy.io

from courtside.geometry import similarity
from courtside.sfm import database, features, mapping, matching, model
from courtside.study.errors import InputError
from fixtures.cameras import sfm_made
from fixtures.recordings.real_data import REAL, needs_real
from fixtures.study.small_disk import limited_to

DOOR = REAL / "sfm-door"
PAIR = 2147483647  # COLMAP's number of a pair: the smaller id times this, and the other id
both_mappers = pytest.mark.parametrize("mapper", ["global", "incremental"])


@pytest.fixture(scope="module")
def synthetic(tmp_path_factory):
    path = tmp_path_factory.mktemp("synthetic") / "matches.db"
    return path, sfm_made.synthetic(path)


def parameters(folder):
    network, names, _ = model.read(folder)
    return names, network.cam_from_world, network.lens, network.xyz


def assert_placed(found, truth, tolerance):
    """Compare the places of images by name after a similarity, in parts of the longest distance."""
    names = sorted(found)
    ours, theirs = (np.array([places[name] for name in names]) for places in (found, truth))
    span = np.linalg.norm(theirs[:, None] - theirs, axis=-1).max()
    off = similarity.umeyama(ours, theirs).points(ours) - theirs
    assert np.linalg.norm(off, axis=1).max() < tolerance * span


@both_mappers
def test_exact_matches_give_the_exact_model(synthetic, tmp_path, mapper):
    path, truth = synthetic
    before, names = path.read_bytes(), sorted(sfm_made.centres(truth))
    summary = mapping.map_images(path, names, tmp_path / "model", mapper=mapper, seed=0)
    counts = {"n_images": 6, "n_models": 1, "n_registered": 6, "n_points3d": 150}
    named = {"mapper": mapper, "seed": 0, "held": {}, "track_length": 6.0}
    assert summary | counts | named == summary
    assert summary["reprojection_px"] < 1e-3
    found = pycolmap.Reconstruction(str(tmp_path / "model"))
    assert_placed(sfm_made.centres(found), sfm_made.centres(truth), 1e-4)
    assert path.read_bytes() == before and [p.name for p in path.parent.iterdir()] == [path.name]


@both_mappers
def test_images_that_are_not_asked_for_are_as_if_not_there(synthetic, tmp_path, mapper):
    path, truth = synthetic
    names = sorted(sfm_made.centres(truth))[1:5]
    mapping.map_images(path, names, tmp_path / "model", mapper=mapper, seed=0)
    network, found, _ = model.read(tmp_path / "model")
    assert found == names and set(network.image_idx) == {0, 1, 2, 3}


@both_mappers
def test_the_same_seed_gives_the_same_model(synthetic, tmp_path, mapper):
    path, truth = synthetic
    names = sorted(sfm_made.centres(truth))
    for folder in ("a", "b"):
        mapping.map_images(path, names, tmp_path / folder, mapper=mapper, seed=5)
    first, second = (parameters(tmp_path / folder) for folder in ("a", "b"))
    assert first[0] == second[0]
    for ours, theirs in zip(first[1:], second[1:], strict=True):
        np.testing.assert_allclose(ours, theirs, rtol=1e-9, atol=1e-9)


@both_mappers
def test_noise_gives_an_empty_model(tmp_path, mapper):
    names = tuple(f"{at}.png" for at in range(3))
    noise = np.random.default_rng(0).integers(0, 255, (3, 120, 160), dtype=np.uint8)
    sfm_made.write(tmp_path, dict(zip(names, noise, strict=True)))
    group = features.Group("noise", names)
    features.extract(tmp_path / "f.db", tmp_path, [group], **sfm_made.EXTRACTION)
    pairs = [(names[0], names[1]), (names[0], names[2]), (names[1], names[2])]
    assert set(matching.match(tmp_path / "f.db", tmp_path / "m.db", pairs, seed=0).values()) == {0}
    summary = mapping.map_images(
        tmp_path / "m.db", list(names), tmp_path / "model", mapper=mapper, seed=0
    )
    assert (summary["n_images"], summary["n_registered"], summary["n_points3d"]) == (3, 0, 0)
    network, found, sizes = model.read(tmp_path / "model")
    assert found == [] and sizes == [] and len(network.xy) == 0


def test_options_reach_the_mapper(synthetic, tmp_path):
    path, truth = synthetic
    names = sorted(sfm_made.centres(truth))
    options = {"ba_refine_focal_length": False, "ba_refine_extra_params": False}
    mapping.map_images(
        path, names, tmp_path / "kept", mapper="incremental", seed=0, options=options
    )
    lens = model.read(tmp_path / "kept")[0].lens[0]
    np.testing.assert_allclose(lens[0] * lens[1], sfm_made.LENS[0], rtol=1e-12)
    options = {"mapper.init_min_num_inliers": 10**6}
    summary = mapping.map_images(
        path, names, tmp_path / "none", mapper="incremental", seed=0, options=options
    )
    assert summary["n_registered"] == 0


@pytest.mark.parametrize("name", ["mapper.speed", "maper.init_min_num_inliers", "speed"])
def test_an_unknown_option_is_refused(synthetic, tmp_path, name):
    with pytest.raises(InputError, match=rf"map_images\.colmap\.incremental: .* found '{name}'"):
        mapping.map_images(
            synthetic[0], [], tmp_path, mapper="incremental", seed=0, options={name: 1}
        )


@pytest.fixture(scope="module")
def door(tmp_path_factory):
    """Match all pairs of the door's twelve photos."""
    folder = tmp_path_factory.mktemp("door")
    names = tuple(sorted(path.name for path in (DOOR / "images").iterdir()))
    group, root = features.Group("door", names), DOOR / "images"
    extraction = {"max_features": 1500, "first_octave": 0, "focal_factor": 1.2}
    features.extract(folder / "f.db", root, [group], **extraction, threads=2)
    pairs = [(a, b) for at, a in enumerate(names) for b in names[at + 1 :]]
    matching.match(folder / "f.db", folder / "m.db", pairs, seed=0)
    return folder / "m.db", names


def measured_centres(names):
    """Return where the photos were taken, as others found (data.mat: P = K [R t], by picture)."""
    content = scipy.io.loadmat(DOOR / "data.mat")
    assert [str(row[0][0]) for row in content["imnames"].ravel()] == list(names)
    return {
        name: -np.linalg.solve(P[:, :3], P[:, 3])
        for name, P in zip(names, content["P"].ravel(), strict=True)
    }


@needs_real
@both_mappers
def test_the_door_is_mapped_as_others_measured_it(door, tmp_path, mapper):
    path, names = door
    summary = mapping.map_images(path, list(names), tmp_path / "model", mapper=mapper, seed=1)
    assert summary["n_registered"] == 12
    network, found, sizes = model.read(tmp_path / "model")
    assert tuple(found) == names and sizes == [(1296, 1936)]
    pose = network.cam_from_world
    centres = -np.einsum("vji,vj->vi", pose[:, :, :3], pose[:, :, 3])
    assert_placed(dict(zip(found, centres, strict=True)), measured_centres(names), 0.002)
    measured_px = scipy.io.loadmat(DOOR / "data.mat")["P"][0, 0][1, 1]
    assert network.lens[0, 0] == pytest.approx(measured_px, rel=0.025)


@needs_real
def test_the_door_is_mapped_twice_the_same(door, tmp_path):
    path, names = door
    for folder in ("a", "b"):
        mapping.map_images(path, list(names[:5]), tmp_path / folder, mapper="global", seed=1)
    first, second = (parameters(tmp_path / folder) for folder in ("a", "b"))
    assert first[0] == second[0] == list(names[:5])
    for ours, theirs in zip(first[1:], second[1:], strict=True):
        np.testing.assert_allclose(ours, theirs, rtol=1e-9, atol=1e-9)


def spoil(monkeypatch, change):
    """Change what the mapper's attempts find: change(number of the attempt, found) -> found.

    Returned is a list that grows by the (seed, options) of each attempt.
    """
    own, asked = mapping._map, []

    def spoiled(matches_db, images, mapper, seed, options):
        asked.append((seed, options))
        return change(len(asked), own(matches_db, images, mapper, seed, options))

    monkeypatch.setattr(mapping, "_map", spoiled)
    return asked


def test_a_failure_is_tried_again_and_the_best_model_kept(synthetic, tmp_path, monkeypatch):
    """The mapper is made to find nothing, then all images badly placed, then all images."""
    path, truth = synthetic
    names = sorted(sfm_made.centres(truth))

    def unlucky(number, found):
        if number == 1:
            return found._replace(model=pycolmap.Reconstruction(), n_models=0)
        if number == 2:
            for point in found.model.points3D.values():
                point.xyz = point.xyz + np.array([1.0, 0, 0])
            found.model.update_point_3d_errors()
        return found

    asked = spoil(monkeypatch, unlucky)
    options = {"mapper": "global", "seed": 7}
    summary = mapping.map_images(path, names, tmp_path / "a", **options, attempts=5)
    seeds = [seed for seed, _ in asked]
    assert (seeds, summary["seed"], summary["n_registered"]) == ([7, 8, 9, 10], 9, 6)
    assert (summary["n_attempts"], summary["n_agreeing"]) == (4, 2)
    asked.clear()
    summary = mapping.map_images(path, names, tmp_path / "b", **options, attempts=2)
    seeds = [seed for seed, _ in asked]
    assert (seeds, summary["seed"], summary["n_registered"]) == ([7, 8], 8, 6)
    assert summary["reprojection_px"] > mapping.SOUND_PX
    asked.clear()
    assert mapping.map_images(path, names, tmp_path / "c", **options)["n_models"] == 0


def test_a_model_with_an_image_that_sees_nothing_is_no_whole_model(
    synthetic, tmp_path, monkeypatch
):
    path, truth = synthetic

    def blind(number, found):
        if number == 1:
            seen = found.model.images[found.model.reg_image_ids()[0]]
            for at, point in enumerate(seen.points2D):
                if point.has_point3D():
                    found.model.delete_observation(seen.image_id, at)
        return found

    asked = spoil(monkeypatch, blind)
    names, options = sorted(sfm_made.centres(truth)), {"mapper": "global", "seed": 7}
    summary = mapping.map_images(path, names, tmp_path / "a", **options, attempts=5)
    seeds = [seed for seed, _ in asked]
    assert (seeds, summary["seed"], summary["n_registered"]) == ([7, 8, 9], 8, 6)


def bent(found, by):
    """Move the images of a model along one axis, by a share of the way that grows along it."""
    model = found.model
    for at in model.reg_image_ids():
        pose = model.images[at].cam_from_world()
        place = model.images[at].projection_center()
        moved = place * (1 + by * (place[0] > 0))
        model.frames[model.images[at].frame_id].rig_from_world = pycolmap.Rigid3d(
            pose.rotation, -pose.rotation.matrix() @ moved
        )
    return found


def test_models_are_made_until_two_agree(synthetic, tmp_path, monkeypatch):
    """The first model is bent by more than models of one session differ, with perfect pixels."""
    path, truth = synthetic
    monkeypatch.setattr(mapping, "SOUND_PX", np.inf)
    asked = spoil(monkeypatch, lambda number, found: bent(found, 0.2) if number == 1 else found)
    names, options = sorted(sfm_made.centres(truth)), {"mapper": "global", "seed": 7}
    summary = mapping.map_images(path, names, tmp_path / "a", **options, attempts=4)
    assert [seed for seed, _ in asked] == [7, 8, 9]
    assert (summary["n_attempts"], summary["n_agreeing"]) == (3, 2) and summary["seed"] in (8, 9)


def test_models_that_place_one_image_differently_do_not_agree(tmp_path, monkeypatch):
    """The mean over 40 images hardly shows it, but it may be one of the fixed cameras."""
    path = tmp_path / "matches.db"
    names = sorted(sfm_made.centres(sfm_made.synthetic(path, n_points=60, n_images=40)))
    monkeypatch.setattr(mapping, "SOUND_PX", np.inf)

    def elsewhere(number, found):
        """Move one image of the first model by a twentieth of the extent of all."""
        if number == 1:
            places = np.array(list(sfm_made.centres(found.model).values()))
            image = found.model.find_image_with_name(names[0])
            pose = image.cam_from_world()
            moved = image.projection_center() + 0.05 * np.ptp(places, axis=0)
            found.model.frames[image.frame_id].rig_from_world = pycolmap.Rigid3d(
                pose.rotation, -pose.rotation.matrix() @ moved
            )
        return found

    asked = spoil(monkeypatch, elsewhere)
    options = {"mapper": "global", "seed": 7, "attempts": 4}
    summary = mapping.map_images(path, names, tmp_path / "a", **options)
    assert [seed for seed, _ in asked] == [7, 8, 9]
    assert summary["n_agreeing"] == 2 and summary["seed"] in (8, 9)


def test_of_models_that_differ_the_one_with_most_observations_is_kept(
    synthetic, tmp_path, monkeypatch
):
    path, truth = synthetic

    def poorer(number, found):
        for point in list(found.model.points3D)[: 10 * (5 - number)]:
            found.model.delete_point3D(point)
        return bent(found, 0.1 * number)

    monkeypatch.setattr(mapping, "SOUND_PX", np.inf)
    monkeypatch.setattr(mapping, "AGAIN", {})
    asked = spoil(monkeypatch, poorer)
    names, options = sorted(sfm_made.centres(truth)), {"mapper": "global", "seed": 7}
    summary = mapping.map_images(path, names, tmp_path / "a", **options, attempts=3)
    assert [seed for seed, _ in asked] == [7, 8, 9] and summary["seed"] == 9
    assert (summary["n_attempts"], summary["n_agreeing"]) == (3, 1)


def of_another_place(path, own, name):
    """Write a copy of a database in which no match of an image is verified."""
    with database.new(path, own) as temporary:
        at = database.image_ids(temporary)[name]
        with closing(sqlite3.connect(temporary)) as opened:
            for table in ("matches", "two_view_geometries"):
                opened.execute(
                    f"DELETE FROM {table} WHERE pair_id % {PAIR} = {at} OR pair_id / {PAIR} = {at}"
                )
            opened.commit()
    return path


def test_an_image_of_another_place_costs_no_attempts_and_no_agreement(
    synthetic, tmp_path, monkeypatch
):
    own, truth = synthetic
    names = sorted(sfm_made.centres(truth))
    path = of_another_place(tmp_path / "matches.db", own, names[2])
    asked = spoil(monkeypatch, lambda number, found: found)
    summary = mapping.map_images(path, names, tmp_path / "a", mapper="global", seed=7, attempts=6)
    assert (summary["n_images"], summary["n_registered"], len(asked)) == (6, 5, 2)
    assert (summary["n_attempts"], summary["n_agreeing"]) == (2, 2)
    assert summary["unregistered"] == summary["unmatched"] == [names[2]]


@pytest.mark.parametrize(("lost", "agreeing"), [(1, 4), (3, 1)])
def test_maps_of_nearly_the_same_images_are_compared(
    synthetic, tmp_path, monkeypatch, lost, agreeing
):
    """No map has the last image, and all but the first lack some others or none."""
    path, truth = synthetic
    names = sorted(sfm_made.centres(truth))
    monkeypatch.setattr(mapping, "NEARLY", 0.75)

    def partial(number, found):
        for name in names[-1:] if number == 1 else names[-lost:]:
            image = found.model.find_image_with_name(name)
            found.model.deregister_frame(image.frame_id)
        return found

    spoil(monkeypatch, partial)
    summary = mapping.map_images(path, names, tmp_path / "a", mapper="global", seed=7, attempts=4)
    assert (summary["n_registered"], summary["n_attempts"]) == (5, 4)
    assert summary["n_agreeing"] == agreeing


@pytest.mark.parametrize(("mapper", "held"), [("global", True), ("incremental", False)])
def test_from_the_third_attempt_on_lenses_are_held(synthetic, tmp_path, monkeypatch, mapper, held):
    path, truth = synthetic

    def failing(number, found):
        return found._replace(model=pycolmap.Reconstruction()) if number < 4 else found

    monkeypatch.setattr(mapping, "AGAIN", {})
    asked = spoil(monkeypatch, failing)
    names, options = sorted(sfm_made.centres(truth)), {"min_num_matches": 14}
    summary = mapping.map_images(
        path, names, tmp_path / "a", mapper=mapper, seed=0, options=options, attempts=4
    )
    assert summary["n_registered"] == 6
    key = "mapper.bundle_adjustment.refine_extra_params"
    assert [each.get(key, True) for _, each in asked] == [True, True, not held, not held]
    assert all(each["min_num_matches"] == 14 for _, each in asked)
    assert summary["held"] == ({key: False} if held else {})


def test_what_the_user_states_of_lenses_is_never_held(synthetic, tmp_path, monkeypatch):
    path, truth = synthetic
    asked = spoil(
        monkeypatch, lambda number, found: found._replace(model=pycolmap.Reconstruction())
    )
    options = {"mapper.bundle_adjustment.refine_extra_params": True}
    names, folder = sorted(sfm_made.centres(truth)), tmp_path / "a"
    summary = mapping.map_images(
        path, names, folder, mapper="global", seed=0, options=options, attempts=3
    )
    assert summary["held"] == {} and [each for _, each in asked] == [options] * 3


def test_a_model_that_the_disk_cuts_short_is_refused(synthetic, tmp_path, monkeypatch):
    path, truth = synthetic
    names, map_really = sorted(sfm_made.centres(truth)), mapping._map
    with ExitStack() as stack:

        def then_the_disk_is_full(*arguments):
            found = map_really(*arguments)
            stack.enter_context(limited_to(4096))
            return found

        monkeypatch.setattr(mapping, "_map", then_the_disk_is_full)
        with pytest.raises(InputError, match=r"images.bin: expected \d+ bytes, found \d+: free"):
            mapping.map_images(path, names, tmp_path / "cut", mapper="global", seed=0)


@pytest.fixture
def guessed(synthetic, tmp_path, monkeypatch):
    """Return a way to map with `attempts` whose found models are changed, and what was asked."""
    path, truth = synthetic
    names = sorted(sfm_made.centres(truth))
    monkeypatch.setattr(mapping, "SOUND_PX", np.inf)

    def run(change, **options):
        asked = spoil(monkeypatch, change)
        arguments = {"mapper": "global", "seed": 7, "attempts": 2, **options}
        summary = mapping.map_images(path, names, tmp_path / "a", **arguments)
        return summary, asked, pycolmap.Reconstruction(str(tmp_path / "a"))

    return run, truth


def test_a_model_that_explains_too_little_is_mapped_again_with_known_lenses(guessed):
    run, truth = guessed
    summary, asked, found = run(lambda number, found: bent(found, 0.5) if number < 3 else found)
    known = mapping.KNOWN["global"]
    assert asked == [(7, {}), (8, {}), (7, known), (8, known)]
    assert (summary["held"], summary["n_attempts"], summary["n_agreeing"]) == (known, 4, 2)
    assert summary["explained"]["image_share"] > 0.99 and len(summary["explained"]["image"]) > 0
    assert_placed(sfm_made.centres(found), sfm_made.centres(truth), 1e-3)


@pytest.mark.parametrize("gain", [0.0, 1.0])
def test_a_lone_model_replaces_two_that_agree_only_if_it_explains_much_more(
    guessed, monkeypatch, gain
):
    run, _ = guessed
    monkeypatch.setattr(mapping, "LONE_GAIN", gain)
    # The first two agree on a wrong shape. With known lenses the third is right, all others are
    # wrong, each in its own way.
    wrong = {1: 0.5, 2: 0.5, 3: 0.0}
    summary, _, _ = run(lambda number, found: bent(found, wrong.get(number, 0.3 * number)))
    alone = {"held": mapping.KNOWN["global"], "n_agreeing": 1}
    agreed = {"held": {}, "n_agreeing": 2}
    assert {key: summary[key] for key in alone} == (agreed if gain else alone)


def test_a_second_model_that_explains_less_is_not_kept(guessed):
    run, _ = guessed
    summary, asked, _ = run(lambda number, found: bent(found, 0.5 if number < 3 else 2.0))
    assert len(asked) == 6 and summary["held"] == {} and summary["mapper"] == "global"
    assert summary["explained"]["image_share"] < mapping.AGAIN["global"]["incremental"]
    assert (summary["n_attempts"], summary["n_agreeing"]) == (6, 2)


def test_where_known_lenses_do_not_help_the_incremental_mapper_is_tried(guessed):
    run, truth = guessed
    known = mapping.KNOWN["incremental"]
    summary, asked, found = run(lambda number, found: bent(found, 0.5) if number < 5 else found)
    assert [options for _, options in asked[4:]] == [known, known]
    assert (summary["mapper"], summary["held"], summary["n_attempts"]) == ("incremental", known, 6)
    assert_placed(sfm_made.centres(found), sfm_made.centres(truth), 1e-3)


def test_a_model_that_explains_enough_is_not_mapped_again(guessed):
    run, _ = guessed
    summary, asked, _ = run(lambda number, found: found)
    assert asked == [(7, {}), (8, {})] and summary["explained"]["image_share"] == 1.0
    summary, asked, _ = run(lambda number, found: bent(found, 0.5), mapper="incremental")
    assert (
        summary["explained"]["image_share"] < mapping.AGAIN["global"]["incremental"]
        and len(asked) == 2
    )
