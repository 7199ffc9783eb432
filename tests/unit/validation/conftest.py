"""A session of two takes by three fixed cameras, with a calibration: all as it should be."""

import shutil
from pathlib import Path

import cv2
import numpy as np
import pytest
import yaml

from courtside.geometry import camera as geometry
from courtside.geometry.camera import Camera
from courtside.study.configuration import session_files
from courtside.study.configuration.sessions import Study
from courtside.study.errors import InputError
from courtside.validation import check
from courtside.validation.remembered import Remembered
from fixtures.recordings import rooms_filmed

CAMERAS = {"left": 1, "right": 2, "back": 3}  # and the rooms that they see
PARAMETERS = yaml.safe_load(Path("config/config.yaml").read_text(encoding="utf-8"))


class Hall:
    """The session's content, its files, and what a check of them says."""

    def __init__(self, root):
        self.root = root
        self.content = {
            "description": "a hall",
            "court": "none",
            "subjects": {"p1": {}},
            "cameras": {name: {} for name in CAMERAS},
            "calibration": {"file": str(root / "cameras.toml")},
            "takes": {},
        }
        for take in ("serve", "lob"):
            videos = {name: str(root / take / f"{name}.mp4") for name in CAMERAS}
            self.content["takes"][take] = {"videos": videos, "synchronised": True}
        self.calibrate(rooms_filmed.SIZE)

    def calibrate(self, size, apart=1, **sizes):
        cameras = []
        for at, name in enumerate(CAMERAS):
            width, height = sizes.get(name, size)
            matrix = np.array([[300.0, 0, width / 2], [0, 300, height / 2], [0, 0, 1]])
            pose = np.hstack([np.eye(3), [[apart * at], [0], [0]]])
            cameras.append(Camera(name, (width, height), matrix, np.zeros(5), pose))
        geometry.write_toml(self.root / "cameras.toml", cameras, source="test")

    def around(self):
        """Calibrate cameras that look at one place from three sides, and return them."""
        cameras = []
        for at, name in enumerate(CAMERAS):
            turn = cv2.Rodrigues(np.array([0, 0.5 * (at - 1) + 0.1, 0.0]))[0]
            pose = np.hstack([turn, [[0.0], [0.2 * at], [8.0]] - turn @ [[0.0], [0.0], [8.0]]])
            matrix = np.array([[300.0 + 20 * at, 0, 160], [0, 300 + 20 * at, 90], [0, 0, 1]])
            cameras.append(Camera(name, rooms_filmed.SIZE, matrix, np.zeros(5), pose))
        geometry.write_toml(self.root / "cameras.toml", cameras, source="test")
        return cameras

    def video(self, camera, take="serve"):
        return Path(self.content["takes"][take]["videos"][camera])

    def film(self, camera, take="serve", room=None, **options):
        seed = CAMERAS[camera] if room is None else room
        return rooms_filmed.film(self.video(camera, take), seed, **options)

    def exchange(self, one, other, takes=("serve",)):
        for take in takes:
            videos = self.content["takes"][take]["videos"]
            videos[one], videos[other] = videos[other], videos[one]

    def session(self):
        return session_files.session("hall", "config/sessions/hall.yaml", self.content, PARAMETERS)

    def said(self):
        """Return (faults, remarks) of a check."""
        study = Study({"hall": self.session()}, {}, {}, PARAMETERS)
        try:
            return [], check.check(study, Remembered(self.root / "looks.json"))
        except InputError as error:
            return error.lines, []

    def fault(self):
        """Return the only fault."""
        faults, _ = self.said()
        assert len(faults) == 1, faults
        return faults[0]


@pytest.fixture(scope="session")
def films(tmp_path_factory):
    """Return a folder with the films of the session, to be copied."""
    made = Hall(tmp_path_factory.mktemp("films"))
    for take, start in (("serve", 0), ("lob", 7)):
        for camera in CAMERAS:
            made.film(camera, take, start=start)
    return made.root


@pytest.fixture
def hall(films, tmp_path):
    shutil.copytree(films, tmp_path, dirs_exist_ok=True)
    return Hall(tmp_path)
