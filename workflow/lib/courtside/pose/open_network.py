"""The code that runs a network, by its decoder's name in `models.yaml` or `detectors.yaml`."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from courtside.pose.blazepose import N_JOINTS, BlazePoseDetector, BlazePoseLandmarks
from courtside.pose.detector import LandmarkNetwork, PersonDetector, Region
from courtside.pose.networks.boxes import BoxDetector
from courtside.pose.networks.inputs import Input
from courtside.pose.networks.one_stage import OneStage
from courtside.pose.networks.session import CPU, Network
from courtside.pose.networks.top_down import HeatMaps, Maps, SimCC, TopDown, check_joints
from courtside.records.keypoints import skeleton
from courtside.study.errors import StrPath

TRIED = ((480, 640, 3), Region(320, 240, 300))  # an empty picture, and a place in it
ONE_STAGE = ("rtmo", "yolo-pose")


def person_detector(
    onnx_path: StrPath,
    *,
    decoder: str,
    input: Mapping[str, Any] | None = None,
    outputs: Sequence[str] | None = None,
    providers: Sequence[str] = CPU,
    **limits: Any,
) -> PersonDetector:
    """Open a person detector as `config/detectors.yaml` declares it.

    `limits` are those of its class. An `InputError` if the file is no such network.
    """
    if decoder == "blazepose":
        return BlazePoseDetector(onnx_path, outputs=outputs, providers=providers, **limits)
    given = Input(**(input or {}))
    network = Network(onnx_path, given.shape, outputs=outputs, providers=providers)
    return BoxDetector(network, given, decoder=decoder, **limits)


def landmark_network(
    onnx_path: StrPath,
    joints: Sequence[str],
    *,
    decoder: str,
    input: Mapping[str, Any] | None = None,
    outputs: Sequence[str] | None = None,
    providers: Sequence[str] = CPU,
    **options: Any,
) -> LandmarkNetwork:
    """Open a landmark network for the joints of its skeleton, as `config/models.yaml` declares it.

    `options` are those of its decoder. An `InputError` if the file is no such network, or has
    another number of joints than its skeleton.
    """
    pairs = skeleton.mirror(joints) if options.pop("flip_test", False) else None
    if decoder == "blazepose":
        check_joints(onnx_path, N_JOINTS, len(joints))
        return BlazePoseLandmarks(onnx_path, outputs=outputs, providers=providers, pairs=pairs)
    how = dict(input or {})
    padding = how.pop("padding", None)
    given = Input(**how)
    network = Network(onnx_path, given.shape, outputs=outputs, providers=providers)
    if decoder in ONE_STAGE:
        return OneStage(network, given, decoder=decoder, n_joints=len(joints), **options)
    trunk = [at for at, joint in enumerate(joints) if joint.endswith(("_shoulder", "_hip"))]
    return TopDown(
        network,
        given,
        _maps(decoder, len(joints), given, **options),
        n_joints=len(joints),
        presence_joints=trunk,
        padding=padding,
        pairs=pairs,
    )


def _maps(
    decoder: str,
    n_joints: int,
    given: Input,
    *,
    split: float = 2.0,
    full_score: float = 1.0,
    cells: str = "corner",
    refine: str = "parabola",
) -> Maps:
    if decoder == "simcc":
        return SimCC(n_joints, given.size, split, full_score)
    return HeatMaps(n_joints, given.layout, cells, refine)


def try_out(network: PersonDetector | LandmarkNetwork) -> None:
    """Run a network on an empty picture: an `InputError` if its outputs are not as declared."""
    shape, region = TRIED
    image = np.zeros(shape, np.uint8)
    if hasattr(network, "detect"):
        network.detect(image)
    if hasattr(network, "estimate"):
        network.estimate(image, region)
