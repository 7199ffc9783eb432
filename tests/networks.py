"""Converted pose networks for tests: fetched once by the smoke study or the study itself."""

from functools import cache
from pathlib import Path

import pytest

from courtside.pose import tflite_onnx

ROOT = Path(__file__).parents[1]
MODULES = "results/external/mediapipe/mediapipe/modules"
PLACES = [ROOT / MODULES, ROOT / "tests" / "smoke" / MODULES]
OUTPUTS = ["Identity", "Identity_1", "Identity_3", "Identity_4"]


def tflite(member):
    """Return the path of a fetched network, or skip the test."""
    for place in PLACES:
        if (place / member).is_file():
            return place / member
    pytest.skip(f"{member} is not fetched yet: run `snakemake` or the smoke tests first")


@cache
def _folder():
    import tempfile

    return Path(tempfile.mkdtemp(prefix="courtside-networks-"))


def detector_onnx():
    """Return BlazePose's person detector as ONNX."""
    return _converted("pose_detection/pose_detection.tflite", None)


def landmarks_onnx():
    """Return BlazePose's landmark network as ONNX."""
    return _converted("pose_landmark/pose_landmark_full.tflite", OUTPUTS)


def _converted(member, outputs):
    source = tflite(member)
    target = _folder() / f"{source.stem}.onnx"
    if not target.is_file():
        tflite_onnx.convert(source, target, outputs=outputs)
    return target
