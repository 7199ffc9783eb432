"""Bad recordings and clicks through the scripts of the calibration: each ends in one clear line.

Single faults of videos and photos are in tests/unit/devices, of the court's shape in
tests/unit/geometry.
"""

import json
import logging
import shutil
import sys
from importlib import import_module
from pathlib import Path
from types import SimpleNamespace

import cv2
import numpy as np
import pandas as pd
import pytest
import yaml

from courtside.calibration.court import court as court_files
from courtside.calibration.court import quality
from courtside.calibration.records import tie_points
from courtside.geometry import camera as camera_models
from courtside.geometry.camera import project
from courtside.records.cameras import clicks
from courtside.records.truth import session_truth
from courtside.study.errors import InputError
from courtside.study.execution import log
from virtualgym.session import clicks as clicking
from virtualgym.session import session as capture

ROOT = Path(__file__).parents[1]
SCRIPTS = ROOT / "workflow" / "scripts"

CONFIG = yaml.safe_load((ROOT / "config" / "config.yaml").read_text())
COURTS = ROOT / "config" / "courts"
BADMINTON = COURTS / "badminton.yaml"
COURT = court_files.read(BADMINTON)
CAMERAS = ["side", "back"]
SETTINGS = capture.Settings(
    preset="plain", layout="a", seed=11, walk_seed=11, size_px=(480, 270), walk_frames=24
)
N_IMAGES = 12
CLICKING = {
    k: CONFIG["adjust_network"][k] for k in ("click_sigma_px", "click_bias_px", "click_loss")
}


def run(script, *files, **options):
    """Run a script of the workflow as its rule does."""
    if str(SCRIPTS) not in sys.path:
        sys.path.insert(0, str(SCRIPTS))
    import_module(script).main(*files, **options)


class Session:
    """Files of one session, in the places that the rules give them."""

    def __init__(self, folder):
        self.folder = folder
        self.static = {camera: folder / "static" / f"{camera}.png" for camera in CAMERAS}
        self.frames = {"walk": folder / "frames" / "walk.csv"}
        self.summary, self.ties = folder / "sfm" / "summary.json", folder / "ties.npz"
        for name in ("static", "frames", "sfm"):
            (folder / name).mkdir(parents=True, exist_ok=True)

    def extract(self, **changes):
        options = {**CONFIG["extract_features"], "first_octave": -1, **changes}
        database, table = self.folder / "sfm" / "features.db", self.folder / "sfm" / "features.csv"
        pictures = list(self.static.values()), list(self.frames.values())
        names = {"cameras": list(self.static), "walks": list(self.frames)}
        run("extract_features", *pictures, database, table, **names, threads=1, **options)

    def match(self):
        sfm = self.folder / "sfm"
        features = sfm / "features.db", sfm / "features.csv"
        found = sfm / "matches.db", sfm / "matches.csv"
        files = *features, list(self.frames.values()), *found
        run("match_images", *files, walks=list(self.frames), **CONFIG["match_images"])

    def map(self, mapper="global", n_images=N_IMAGES):
        sfm = self.folder / "sfm"
        options = {key: CONFIG["map_images"][key] for key in ("rule", "seed")}
        options["attempts"] = CONFIG["map_images"]["attempts"][mapper]
        made = {"mapper": mapper, "n_images": n_images, "offset": 0, **options}
        frames = list(self.frames.values())
        files = sfm / "matches.db", sfm / "features.csv", frames, self.summary
        run("map_images", *files, walks=list(self.frames), **made)

    def adjust(self, points, court=BADMINTON, out=None):
        out = out or self.ties
        run(
            "adjust_network",
            self.summary,
            self.folder / "sfm" / "matches.db",
            points,
            court,
            out,
            cameras=CAMERAS,
            **CONFIG["adjust_network"],
        )
        return tie_points.read(out)


@pytest.fixture(scope="module")
def good(tmp_path_factory):
    """Film the session once and take it as far as a model."""
    folder = tmp_path_factory.mktemp("recordings")
    capture.simulate(SETTINGS, COURT, folder / "film")
    made = Session(folder / "good")
    for camera, png in made.static.items():
        source = folder / "film" / f"{camera}.mp4"
        run("extract_static", source, png, None, camera=camera, **CONFIG["extract_static"])
    walk = folder / "film" / "walk.mp4", folder / "good" / "frames" / "walk", made.frames["walk"]
    run("extract_frames", *walk, every_frame=1)
    made.extract()
    made.match()
    made.map()
    return made


@pytest.fixture(scope="module")
def clicked(good):
    path = good.folder.parent / "film" / "court_points.csv"
    return clicks.read(path, CAMERAS, list(COURT.points))


@pytest.fixture(scope="module")
def real(good):
    return session_truth.read(good.folder.parent / "film" / "truth.npz")


@pytest.fixture
def tampered(good, tmp_path):
    """Return a copy of the session's pictures, for other features."""
    made = Session(tmp_path / "session")
    for name in ("static", "frames"):
        shutil.copytree(good.folder / name, made.folder / name, dirs_exist_ok=True)
    return made


def written(tmp_path, marked, court=COURT):
    clicks.write(tmp_path / "points.csv", marked, court.points)
    return tmp_path / "points.csv"


def calibrated(good, tmp_path, marked, court=BADMINTON):
    """Return what the default calibration says: its warnings, or the message of its error."""
    points = written(tmp_path, marked, court_files.read(court))
    good.adjust(points, court, tmp_path / "ties.npz")
    out = [tmp_path / name for name in ("cameras.toml", "covariance.npz", "quality.json")]
    files = tmp_path / "ties.npz", points, court, *out
    try:
        run("calibrate_cameras", *files, calibration="sfm", **CLICKING)
    except InputError as error:
        return SimpleNamespace(error=str(error), warnings=[], is_written=out[0].exists())
    quality = json.loads(out[2].read_text())
    return SimpleNamespace(error="", warnings=quality["warnings"], is_written=out[0].exists())


def aligned(good, tmp_path, marked, name):
    """Return what a comparison method says, after `calibrated` with the same clicks."""
    points, record = written(tmp_path, marked), tmp_path / "ties.npz"
    out = tmp_path / "aligned.toml", tmp_path / "aligned.json"
    run("align_cameras", record, points, BADMINTON, *out, calibration=name, **CLICKING)
    return json.loads(out[1].read_text())["warnings"]


def resected(good, tmp_path, marked, name="known18", court=BADMINTON, lenses=()):
    points = written(tmp_path, marked, court_files.read(court))
    out = tmp_path / "known.toml", tmp_path / "known.json"
    sigma = {"click_sigma_px": CLICKING["click_sigma_px"]}
    files = points, court, list(good.static.values()), list(lenses)
    names = {"cameras": list(good.static), "calibration": name}
    run("resect_cameras", *files, *out, **names, step=sigma)
    return json.loads(out[1].read_text())["warnings"]


def assert_says(line, parts):
    assert "\n" not in line and "expected" in line and "found" in line, line
    assert [part for part in parts if part not in line] == [], line


def only(marked, use):
    return {camera: np.where(use[:, None], xy, np.nan) for camera, xy in marked.items()}


def named(*points):
    return np.isin(COURT.points, points)


def test_good_recordings_and_clicks_say_nothing(good, clicked, tmp_path):
    found = calibrated(good, tmp_path, clicked)
    assert (found.error, found.warnings, found.is_written) == ("", [], True)
    assert aligned(good, tmp_path, clicked, "sim3-n12") == []
    assert resected(good, tmp_path, clicked) == []


def test_a_lens_of_another_picture_size_is_refused(good, clicked, tmp_path):
    for name in CAMERAS:
        lens = camera_models.plain(name, (960, 540), 1.0)
        camera_models.write_toml(tmp_path / f"{name}.toml", [lens], source="chessboard")
    lenses = [tmp_path / f"{name}.toml" for name in CAMERAS]
    with pytest.raises(InputError) as error:
        resected(good, tmp_path, clicked, "known18-board", lenses=lenses)
    assert_says(str(error.value), ["960x540 px", "camera side", "480x270"])


def test_exchanged_camera_files_are_recognised(good, clicked, tmp_path):
    """As when the two static recordings are exchanged: pictures and clicks are each other's."""
    marked = {"side": clicked["back"].copy(), "back": clicked["side"].copy()}
    found = calibrated(good, tmp_path, marked)
    parts = ["cameras side and back:", "the camera files may be exchanged", "correct their names"]
    assert_says(found.error, parts)
    assert not found.is_written
    (warning,) = aligned(good, tmp_path, marked, "paper-n12")
    assert_says(warning, parts)
    marked["back"][COURT.indices(["p01"])] = np.nan
    with pytest.raises(InputError, match="the camera files may be exchanged"):
        aligned(good, tmp_path, marked, "paper-n12")


def mirrored(marked):
    left_for_right = COURT.xyz * [-1, 1, 1] + [6.1, 0, 0]
    other = [np.linalg.norm(COURT.xyz - place, axis=1).argmin() for place in left_for_right]
    return {camera: xy[other] for camera, xy in marked.items()}


def test_mirrored_points_make_a_left_handed_world(good, clicked, tmp_path):
    found = calibrated(good, tmp_path, mirrored(clicked))
    assert_says(found.error, ["mirror", "exchange the names of the left and right points in all"])
    assert not found.is_written
    with pytest.raises(InputError, match="the points are mirrored; exchange the names"):
        resected(good, tmp_path, mirrored(clicked))


def test_points_on_one_line_are_refused(good, clicked, tmp_path):
    marked = only(clicked, named("p01", "p04", "p10", "p06", "p03"))
    found = calibrated(good, tmp_path, marked)
    assert_says(found.error, ["court points:", "found 5", "all on one line", "click more points"])
    with pytest.raises(InputError, match=r"camera side: expected 8 clicked points .* found 5;"):
        resected(good, tmp_path, marked)


@pytest.mark.parametrize("cameras", [["side"], []])
def test_clicks_in_fewer_than_two_cameras_are_refused(good, clicked, tmp_path, cameras):
    marked = {c: xy if c in cameras else np.full_like(xy, np.nan) for c, xy in clicked.items()}
    found = calibrated(good, tmp_path, marked)
    assert_says(found.error, ["found 0 that two cameras see;", "in two cameras or more each"])


@pytest.mark.parametrize("points", [COURT.xyz[:, 2] == 0, named("p01", "p02", "p03", "p16")])
def test_points_on_the_floor_alone_leave_heights_weak(good, clicked, tmp_path, points):
    found = calibrated(good, tmp_path, only(clicked, points))
    assert found.error == "" and found.is_written
    *others, warning = sorted(found.warnings, key=lambda line: "all lie on the floor" in line)
    assert "all lie on the floor: heights are several times less certain" in warning
    # Four points cannot show a wrong one among them, which is told besides.
    assert ["six or more" in line for line in others] == [True] * int(np.sum(points) < 6)
    assert "click points above it too" in warning and "\n" not in warning


@pytest.mark.parametrize("name", ["tennis", "rectangle-10x5"])
def test_clicks_of_another_court_are_refused(good, clicked, tmp_path, name):
    path = COURTS / f"{name}.yaml"
    other = court_files.read(path)
    marked = {
        camera: np.stack([xy[COURT.points.index(p)] for p in other.points])
        for camera, xy in clicked.items()
    }
    size = f"{other.size_m[0]:g} m by {other.size_m[1]:g} m"
    found = calibrated(good, tmp_path, marked, path)
    assert_says(found.error, [f"near those of {name} ({size})", "give the right court file"])
    named = r"^camera (side|back): expected .* check the names of"
    with pytest.raises(InputError, match=named) as caught:
        resected(good, tmp_path, marked, f"known{len(other.points)}", path)
    assert_says(str(caught.value), [])


@pytest.mark.parametrize("seed", [0, 1])
def test_line_centres_are_recognised(good, real, tmp_path, seed):
    drawn = {"n_draws": 1, "seed": seed, "preset": "plain", "session": "centres"}
    drawn["strength"] = 0.25  # half a line is 0.1 to 0.8 px in such small pictures
    centres = real.court_xyz + court_files.to_line_centres(COURT)
    found = calibrated(
        good, tmp_path, next(clicking.clicks_of_persons(real.cameras, COURT, centres, **drawn))
    )
    (warning,) = found.warnings
    assert "line centres seem to be clicked; click the edges" in warning and found.error == ""
    found = calibrated(
        good,
        tmp_path,
        next(clicking.clicks_of_persons(real.cameras, COURT, real.court_xyz, **drawn)),
    )
    assert found.warnings == []


def test_a_wrong_click_is_named(good, clicked, tmp_path):
    marked = {camera: xy.copy() for camera, xy in clicked.items()}
    marked["back"][COURT.indices(["p06"])] += (12, 9)
    (warning,) = calibrated(good, tmp_path, marked).warnings
    assert_says(warning, ["camera back: point p06:", "click it again or delete it"])


@pytest.mark.parametrize(("off_px", "named"), [(1.2, False), (8.0, True)])
def test_points_alone_call_a_click_wrong_beyond_what_persons_scatter(
    good, real, tmp_path, off_px, named
):
    """Also where all others are exact: one in hundreds of clicks is four sigmas, 1.2 px, off."""
    marked = {camera.name: project(camera, real.court_xyz) for camera in real.cameras}
    marked["back"][COURT.indices(["p06"]), 0] += off_px
    messages = resected(good, tmp_path, marked)
    assert [line[:24] for line in messages] == ["camera back: point p06: "] * named


def test_of_a_doubtful_map_nothing_else_is_said(good, clicked, tmp_path, monkeypatch):
    """Neither of a wrong click nor of a mirrored court: the map cannot tell."""
    marked = {camera: xy.copy() for camera, xy in clicked.items()}
    marked["back"][COURT.indices(["p06"])] += (12, 9)
    monkeypatch.setattr(quality, "SUPPORTED", 1.0)
    found = calibrated(good, tmp_path, mirrored(clicked))
    assert_says(found.error, ["map doubtful:", "take more bridging images"])
    assert not found.is_written
    found = calibrated(good, tmp_path, marked)
    (warning,) = found.warnings
    assert_says(warning, ["map doubtful:", "100 % or more", ".png", "take more bridging images"])
    assert found.error == "" and found.is_written
    marked["back"][COURT.indices(["p01"])] = np.nan
    with pytest.raises(InputError, match="map doubtful:"):
        aligned(good, tmp_path, marked, "paper-n12")


def test_cameras_in_one_place_of_the_map_are_told_beside_other_faults(
    good, clicked, tmp_path, monkeypatch
):
    monkeypatch.setattr(quality, "ONE_PLACE", 2.0)
    (warning,) = calibrated(good, tmp_path, clicked).warnings
    assert_says(warning, [f"{CAMERAS[0]} and {CAMERAS[1]}", "in two places of the map"])
    found = calibrated(good, tmp_path, mirrored(clicked))
    assert_says(found.error, ["mirror image; exchange the names", "in two places of the map"])


def noise(size=SETTINGS.size_px, seed=0):
    rng = np.random.default_rng(seed)
    rough = rng.normal(size=(size[1], size[0], 3))
    smooth = cv2.GaussianBlur(rough, (0, 0), 2)
    return np.clip(128 + 40 * smooth / smooth.std(), 0, 255).astype(np.uint8)


def outcome_of(session, good, mappers=("global",)):
    points = good.folder.parent / "film" / "court_points.csv"
    for mapper in mappers:
        session.map(mapper)
        record = session.adjust(points)
        with pytest.raises(InputError) as caught:
            out = [session.folder / name for name in ("c.toml", "c.npz", "q.json")]
            files = session.ties, points, BADMINTON, *out
            run("calibrate_cameras", *files, calibration="sfm", **CLICKING)
        assert str(caught.value) == record.outcome
        yield record.outcome


def test_a_walk_that_never_sees_one_camera_names_it(good, tampered):
    cv2.imwrite(str(tampered.static["back"]), noise())
    tampered.extract(first_octave=0)
    tampered.match()
    for outcome in outcome_of(tampered, good, ("global", "incremental")):
        assert_says(outcome, ["back", "in common with the walk", "film the walk from close beside"])
        assert outcome.startswith("camera") and "back" in outcome.split(":")[0]


def test_pictures_without_common_features_are_a_fault_of_the_walk(good, tampered):
    for at, path in enumerate(sorted((tampered.folder / "frames" / "walk").glob("*.png"))):
        cv2.imwrite(str(path), noise(seed=at))
    tampered.extract(first_octave=0, max_features=300)
    tampered.match()
    for outcome in outcome_of(tampered, good, ("global", "incremental")):
        assert_says(outcome, ["walk:", "images that overlap", "film slower", "gear in view"])


def test_more_images_than_the_walk_has_are_refused(good):
    with pytest.raises(InputError) as caught:
        good.map(n_images=30)
    assert_says(str(caught.value), ["walk: expected at least 30 usable frames, found 24 of 24"])


def test_a_walk_in_the_dark_is_refused(tmp_path):
    """A video, which unlike photos may hold single dark frames."""
    path = str(tmp_path / "walk.avi")
    writer = cv2.VideoWriter(path, cv2.VideoWriter.fourcc(*"MJPG"), 10, (160, 96))
    for _ in range(6):
        writer.write(np.full((96, 160, 3), 5, np.uint8))
    writer.release()
    with pytest.raises(InputError) as caught:
        run("extract_frames", path, tmp_path / "walk", tmp_path / "walk.csv", every_frame=1)
    assert_says(str(caught.value), ["walk.avi:", "found all 6 dark", "film the walk again"])
    assert not (tmp_path / "walk.csv").exists()


def test_the_first_guess_of_a_focal_length_is_told(tmp_path, caplog):
    made = Session(tmp_path / "session")
    for path in made.static.values():
        cv2.imwrite(str(path), noise((160, 96)))
    (made.folder / "frames" / "walk").mkdir()
    cv2.imwrite(str(made.folder / "frames" / "walk" / "000000.png"), noise((160, 96)))
    row = {"frame_idx": 0, "time_s": 0.0, "name": "000000.png", "sharpness": 1.0, "kept": 1}
    pd.DataFrame([{**row, "reason": "", "photo": "a.jpg"}]).to_csv(made.frames["walk"], index=False)
    with caplog.at_level(logging.INFO, log.logger.name):
        made.extract(focal_factor=0.8)
    messages = [line for line in caplog.messages if "focal length" in line]
    assert messages == [
        f"{group}: focal length not known, first guess 0.8 of its pictures' longer side"
        for group in (*CAMERAS, "walk")
    ]
