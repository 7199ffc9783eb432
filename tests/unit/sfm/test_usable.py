"""Blurred, dark or duplicate frames are found; motion is measured to a fraction of a pixel."""

import cv2
import numpy as np
import pandas as pd
import pytest

from courtside.sfm import usable


def scene(seed=0, size=(400, 260), sigma=3):
    noise = np.random.default_rng(seed).normal(0, 1, size[::-1])
    smooth = cv2.GaussianBlur(noise, (0, 0), sigma)
    return 120 + 40 * smooth / smooth.std()


def walk(shifts_px, blurs_px=None, noise=1.0, seed=0):
    """Return the table and small pictures of a camera that sees the scene pass by."""
    images, rng = [], np.random.default_rng(seed)
    for shift_px, blur_px in zip(shifts_px, blurs_px or [0] * len(shifts_px), strict=True):
        matrix = np.array([[1, 0, -shift_px - 20], [0, 1, -20.0]])
        image = cv2.warpAffine(scene(), matrix, (320, 180), flags=cv2.INTER_CUBIC)
        if blur_px:
            image = cv2.GaussianBlur(image, (0, 0), blur_px)
        images.append(np.clip(image + rng.normal(0, noise, image.shape), 0, 255).astype(np.uint8))
    sharpness = [cv2.Laplacian(image, cv2.CV_64F).var() for image in images]
    return pd.DataFrame({"sharpness": sharpness}), images


def test_blurred_frames_are_found():
    blurs = [0] * 20
    blurs[5] = blurs[12] = blurs[13] = 4
    table, images = walk(np.arange(20) * 2.0, blurs, noise=0.3)
    kept, why = usable.judge(table, images)
    assert [at for at in range(20) if why[at] == "blurred"] == [5, 12, 13]
    np.testing.assert_array_equal(kept, why == "")


def test_sharp_photos_of_bare_walls_are_kept_and_blurred_ones_are_not():
    """Contrast differs from photo to photo; blur of 2 px of the photo leaves the small picture."""
    fine, coarse = ([scene(at, (1280, 720), sigma) for at in range(12)] for sigma in (2, 12))
    photos = [(one + other) / 2 for one, other in zip(fine, coarse, strict=True)]
    for at in (2, 7, 8):
        photos[at] = 120 + 0.3 * (photos[at] - 120)  # a tenth of the sharpness
    for at in (4, 8):
        photos[at] = cv2.GaussianBlur(photos[at], (0, 0), 2)
    images = [cv2.resize(photo, (320, 180), interpolation=cv2.INTER_AREA) for photo in photos]
    table = pd.DataFrame({"sharpness": [cv2.Laplacian(p, cv2.CV_64F).var() for p in photos]})
    _, why = usable.judge(table, images, photos=True)
    assert {at: why[at] for at in range(12) if why[at]} == {4: "blurred", 8: "blurred"}
    _, why = usable.judge(table, images)  # of a video, whose frames show nearly the same
    assert {at for at in range(12) if why[at] == "blurred"} == {2, 4, 7, 8}


def test_sharpness_is_compared_with_neighbours_not_with_the_whole_walk():
    table, images = walk(np.arange(60) * 1.0)
    falling = table.assign(sharpness=np.geomspace(1000, 20, 60))
    assert usable.judge(falling, images)[0].all()
    falling.loc[30, "sharpness"] *= 0.5
    kept, why = usable.judge(falling, images)
    assert np.flatnonzero(~kept).tolist() == [30] and why[30] == "blurred"


@pytest.mark.parametrize("noise", [0.5, 3.0])
def test_of_a_walker_who_stands_still_one_frame_is_kept(noise):
    shifts = [0, 2, 4, 4, 4.02, 3.98, 4, 6, 8, 8, 10]
    kept, why = usable.judge(*walk(shifts, noise=noise))
    assert np.flatnonzero(why == "duplicate").tolist() == [3, 4, 5, 6, 9]
    np.testing.assert_array_equal(kept, why == "")


def test_frames_of_an_upright_telephone_are_judged_as_those_of_a_level_one():
    table, images = walk([0, 2, 2.2, 4, 4.1, 6])
    upright = [np.rot90(image) for image in images]
    assert usable.judge(table, upright)[1].tolist() == usable.judge(table, images)[1].tolist()


def test_slow_walking_adds_up():
    """Each step is below the limit of 0.16 px, but frames are compared with the last kept one."""
    kept, _ = usable.judge(*walk(np.arange(13) * 0.08, noise=0.5))
    assert kept[0] and 3 <= kept.sum() <= 6


def test_dark_frames_are_found_before_anything_else():
    table, images = walk(np.arange(10) * 2.0)
    for at in (3, 4):
        images[at] = np.full_like(images[at], 6)
        table.loc[at, "sharpness"] = 0.0
    kept, why = usable.judge(table, images)
    assert why.tolist() == ["", "", "", "dark", "dark", "", "", "", "", ""]
    assert kept.sum() == 8


def test_pictures_without_texture_are_no_duplicates():
    rng = np.random.default_rng(0)
    flat = [np.clip(90 + rng.normal(0, 0.5, (180, 320)), 0, 255).astype(np.uint8) for _ in range(3)]
    assert usable.motion_px(flat[0], flat[1]) == np.inf
    assert usable.judge(pd.DataFrame({"sharpness": [1.0] * 3}), flat)[0].all()


@pytest.mark.parametrize("noise", [0.3, 2.0])
@pytest.mark.parametrize("shift_px", [0.1, 0.3, 0.6, 1.0])
def test_small_motions_are_measured(shift_px, noise):
    """The scene has equal slopes along both axes, as the estimate assumes."""
    _, (image, other) = walk([0.0, shift_px], noise=noise)
    assert 0.75 * shift_px - 0.05 < usable.motion_px(image, other) < 1.25 * shift_px + 0.05


def test_different_views_are_no_duplicates():
    """Their flat blocks change as much as the rich ones, which looked like noise without motion."""
    views = [scene(seed)[20:200, 20:340].clip(0, 255).astype(np.uint8) for seed in range(8)]
    kept, why = usable.judge(pd.DataFrame({"sharpness": [100.0] * 8}), views)
    assert kept.all(), why
    assert usable.motion_px(views[0], views[1]) == np.inf


def test_people_do_not_count_as_motion():
    _, (image, other) = walk([0.0, 0.0])
    other[60:180, 40:120] = scene(7)[60:180, 40:120]
    assert usable.motion_px(image, other) < 0.1


def test_judge_wants_one_picture_per_row_and_one_size():
    table, images = walk([0.0, 1.0])
    with pytest.raises(ValueError, match="3 rows, 2 images"):
        usable.judge(pd.DataFrame({"sharpness": [1.0] * 3}), images)
    with pytest.raises(ValueError, match="shapes"):
        usable.judge(table, [images[0], images[1][:90]])
    with pytest.raises(ValueError, match="one size"):
        usable.motion_px(images[0][:5], images[1][:5])
