"""What cameras see of people in takes, and config.yaml's settings of cameras refined by them."""

import sys

from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))
from courtside.calibration.people.views import Limits
from courtside.reconstruction import common_views, joint_correction
from courtside.study.configuration import yaml_files

CONFIG = yaml_files.read(ROOT / "config" / "config.yaml")
CLICK_KEYS = ("click_sigma_px", "click_bias_px", "click_loss")
WEIGHTS = {key: CONFIG["adjust_network"][key] for key in CLICK_KEYS}
STATED = {key: value for key, value in CONFIG["refine_cameras"].items() if key != "takes"}
LIMITS = Limits.of(CONFIG["triangulate"])


def offsets_of(model):
    """Return the table of a network's joint offsets, None where it has none."""
    path = ROOT / "config" / "joint_offsets" / f"{model}.csv"
    return joint_correction.read(path) if path.exists() else None


def of_takes(session, takes, way, model, names, people="found.npz"):
    """Return what the cameras `names` see in each take of a session's folder of results.

    Without the network's joint offsets, as in the study. `people` is "found.npz" for everybody
    found, "npz" for the named.
    """
    cameras, seen = session / "calibration" / way / "cameras.toml", []
    for take in (session / "takes" / name for name in takes):
        files = {
            "pose2d": [take / "pose2d" / model / f"{name}.npz" for name in names],
            "people": take / "people" / way / f"{model}.{people}",
            "sync": take / "sync" / way / f"cameras.{model}.json",
        }
        seen.append(common_views.of_take(cameras, names, files, offsets_of(model)))
    return seen
