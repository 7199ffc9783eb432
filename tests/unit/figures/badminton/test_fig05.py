"""Shares of placed joints against counts by hand, and examples that are what they are called."""

import numpy as np
import pandas as pd
import pytest

from courtside.figures.badminton import fig05
from fixtures.cameras import scene
from fixtures.people import keypoints_made

JOINTS = ["left_shoulder", "right_shoulder", "left_hip", "right_hip", "left_wrist", "right_wrist"]
LAYOUTS = {"a": ("gym-a", "shot", ["side", "back"]), "b": ("gym-b", "shot", ["oblique", "back"])}
PLACE = dict(
    zip(JOINTS, [(90, 80), (110, 80), (93, 120), (107, 120), (70, 130), (130, 130)], strict=True)
)


def made(
    missed, n_frames=30, session="gym-a", cameras=("side", "back"), shift_s=0.0, stroke=(10, 16)
):
    """Return rows in which (camera, frame, joint) of `missed` are off by a torso, others exact."""
    rows = []
    for camera in cameras:
        for frame in range(n_frames):
            for joint in JOINTS:
                x, y = PLACE[joint]
                off = 40.0 * ((camera, frame, joint) in missed)
                rows.append(
                    {
                        "session": session,
                        "take": "shot",
                        "model": "m",
                        "person": "p1",
                        "camera": camera,
                        "frame_idx": frame,
                        "time_s": frame / 30 + shift_s * (camera == cameras[0]),
                        "joint": joint,
                        "x_px": x + off,
                        "y_px": y,
                        "true_x_px": x,
                        "true_y_px": y,
                        "error_torso": off / 40,
                        "found": True,
                        "in_picture": True,
                        "placed": off == 0,
                        "exchanged": False,
                        "in_stroke": stroke[0] <= frame < stroke[1],
                    }
                )
    return pd.DataFrame(rows)


MISSED = {("side", f, "left_wrist") for f in range(6)} | {
    ("back", f, "right_wrist") for f in range(3, 15)
}


def both(missed=MISSED):
    return pd.concat(
        [made(missed), made(set(), session="gym-b", cameras=("oblique", "back", "mirror"))]
    )


def of(shares, layout, camera, joint):
    at = (shares.layout == layout) & (shares.camera == camera) & (shares.joint == joint)
    return shares[at].iloc[0]


def test_shares_are_counts_of_frames():
    shares = fig05.table(both(), LAYOUTS)
    assert of(shares, "a", "side", "left_wrist").share == pytest.approx(24 / 30)
    assert of(shares, "a", "side", "right_wrist").share == 1
    assert of(shares, "a", "side", fig05.ALL).share == pytest.approx(24 / 30)
    assert of(shares, "a", "back", fig05.ALL).share == pytest.approx(18 / 30)
    # Frames 0-14 are missed in one camera or both.
    assert of(shares, "a", fig05.TOGETHER, fig05.ALL).share == pytest.approx(0.5)
    assert of(shares, "b", fig05.TOGETHER, fig05.ALL).share == 1
    assert of(shares, "b", "mirror", fig05.ALL).n_frames == 30


def test_two_takes_of_one_session_count_in_a_layout_each():
    good = made(set()).assign(take="rally")
    rows = pd.concat([made(MISSED), good])
    layouts = {
        name: ("gym-a", take, ["side", "back"]) for name, take in (("a", "shot"), ("b", "rally"))
    }
    shares = fig05.table(rows, layouts)
    for layout, take, share in (("a", "shot", 24 / 30), ("b", "rally", 1.0)):
        found = of(shares, layout, "side", fig05.ALL)
        assert (found["take"], found.n_frames) == (take, 30)
        assert found.share == pytest.approx(share)
    chosen = fig05.examples(rows, layouts)
    assert [one["take"] for one in chosen] == ["shot", "shot", "rally", "rally"]
    assert [one["rows"].placed.all() for one in chosen] == [True, False, True, True]


def test_the_stroke_is_counted_apart():
    shares = fig05.table(both(), LAYOUTS)
    stroke = of(shares, "a", "back", fig05.STROKE)
    assert stroke.n_frames == 6
    assert stroke.share == pytest.approx(1 / 6)
    assert of(shares, "a", "side", fig05.STROKE).share == 1
    calm = fig05.table(both().assign(in_stroke=False), LAYOUTS)
    assert of(calm, "a", "side", fig05.STROKE).n_frames == 0


def test_intervals_hold_the_share_and_know_that_frames_are_alike():
    shares = fig05.table(both(), LAYOUTS)
    assert ((shares.low <= shares.share) & (shares.share <= shares.high)).all()
    certain = of(shares, "b", "back", "left_hip")
    assert certain.n_effective == pytest.approx(30 / (0.2 * 30))


def test_frames_of_a_shifted_camera_are_paired_by_time():
    rows = made(MISSED, shift_s=2 / 30)
    step_s = 1 / 30
    # `side` shows frame k when `back` shows frame k + 2.
    wanted = [frame > 5 and not 3 <= frame + 2 < 15 for frame in range(28)]
    found = fig05.together(rows, ["side", "back"], step_s)
    np.testing.assert_array_equal(found, wanted)


def test_frames_in_which_the_person_leaves_the_picture_do_not_count():
    rows = both()
    rows.loc[
        (rows.camera == "side") & (rows.frame_idx < 6) & (rows.joint == "left_hip"), "in_picture"
    ] = False
    shares = fig05.table(rows, LAYOUTS)
    whole = of(shares, "a", "side", fig05.ALL)
    assert (whole.n_frames, whole.share) == (24, 1.0)


@pytest.mark.parametrize("cut_off", [["side"], ["back"], ["side", "back"]])
def test_cameras_that_never_show_the_whole_person_have_no_frames(cut_off):
    rows = both()
    cut = (rows.session == "gym-a") & rows.camera.isin(cut_off) & (rows.joint == "left_hip")
    shares = fig05.table(rows.assign(in_picture=~cut), LAYOUTS)
    pair = of(shares, "a", fig05.TOGETHER, fig05.ALL)
    assert (pair.n_frames, pair.session, pair.model) == (0, "gym-a", "m") and np.isnan(pair.share)
    shown = set(shares[(shares.layout == "a") & (shares.n_frames > 0)].camera)
    assert shown == {"side", "back"} - set(cut_off)
    fig05.draw(shares, LAYOUTS, [], [], []).draw_without_rendering()


def test_a_layout_without_rows_is_left_out():
    rows = both()
    shares = fig05.table(rows[rows.session == "gym-b"], LAYOUTS)
    assert set(shares.layout) == {"b"}
    fig05.draw(shares, LAYOUTS, [], [], []).draw_without_rendering()


def test_examples_are_of_the_worst_camera_one_good_and_one_bad():
    missed = MISSED | {("back", 20, joint) for joint in JOINTS[2:]}
    chosen = fig05.examples(both(missed), LAYOUTS)
    assert [one["works"] for one in chosen] == [True, False, True, False]
    works, fails = chosen[:2]
    assert works["camera"] == fails["camera"] == "back"
    assert works["rows"].placed.all()
    assert fails["frame_idx"] == 20 and fails["rows"].placed.sum() == 2


def test_an_example_shows_its_own_person_and_nobody_else():
    """A bystander nearby, and one whose joints are not known, stay unrecognisable."""
    rows = both()
    for example in fig05.examples(rows, LAYOUTS):
        own = example["rows"].set_index("joint").loc[JOINTS, ["x_px", "y_px"]].to_numpy()
        xy = np.full((3, 30, len(JOINTS) + 1, 2), np.nan)
        xy[0, :, 1:], xy[2, example["frame_idx"], 1:] = own + 8, own + 1e-5
        view = keypoints_made.view(scene.ring(1)[0], ["nose", *JOINTS], np.arange(30) / 30, xy)
        np.testing.assert_allclose(fig05.person_of(example, view)[0, 1:], own, atol=1e-4)


def test_nobody_found_gives_no_example():
    assert fig05.examples(both().assign(found=False), LAYOUTS) == []


def test_missed_joints_are_ringed_and_joined_to_the_truth():
    rows = both()
    chosen = fig05.examples(rows, LAYOUTS)
    images = [np.zeros((240, 320, 3), np.uint8)] * len(chosen)
    shares = fig05.table(rows, LAYOUTS)
    drawing = fig05.draw(shares, LAYOUTS, chosen, images, [("left_shoulder", "right_shoulder")])
    titles = [axis.get_title() for axis in drawing.axes]
    assert titles[:2] == ["Layout a", "Layout b"] and titles[2].startswith("a: back")
    works, fails = drawing.axes[2:4]
    assert works.get_xlabel() == "6 of 6 placed"
    assert fails.get_xlabel() == "5 of 6 placed"
    tied = [line.get_xydata().tolist() for line in fails.lines if line.get_linestyle() == "--"]
    assert tied == [[[170.0, 130.0], [130.0, 130.0]]]
    rings = [line for line in fails.lines if line.get_markerfacecolor() == "none"]
    np.testing.assert_array_equal(rings[-1].get_xydata(), [[170, 130]])
    drawing.draw_without_rendering()
