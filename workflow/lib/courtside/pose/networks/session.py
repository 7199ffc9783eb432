"""ONNX files in onnxruntime: execution providers, checks, runs. Every fault is one line.

An execution provider is what runs a network: the processor, a graphics card. onnxruntime goes on
with the processor where another one does not open; here that is an error.
"""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import onnx
import onnxruntime
from numpy.typing import NDArray

from courtside.pose.networks import batches
from courtside.study.errors import InputError, StrPath, reading
from courtside.study.execution import files

CPU = ("cpu",)
PROVIDERS = {  # onnxruntime's name, and the package that brings it
    "cpu": ("CPUExecutionProvider", "onnxruntime"),
    "cuda": ("CUDAExecutionProvider", "onnxruntime-gpu"),
    "coreml": ("CoreMLExecutionProvider", "onnxruntime for macOS"),
    "openvino": ("OpenVINOExecutionProvider", "onnxruntime-openvino"),
    "directml": ("DmlExecutionProvider", "onnxruntime-directml"),
}
# With TF32, cuda's default, joints lay up to 0.3 px of 256 from those of the processor, without it
# up to 0.0002 px (measured on an NVIDIA H200).
OPTIONS = {"cuda": {"use_tf32": "0"}}
ENTRY = "correct its entry in config/models.yaml or config/detectors.yaml"
EXPORT = "export it again as one ONNX file of standard operators"


def check_providers(names: Sequence[str], where: str = "detect_pose.providers") -> None:
    """Raise an `InputError`, one line each, for providers that the installed package lacks."""
    there = onnxruntime.get_available_providers()
    lacking = [name for name in names if PROVIDERS[name][0] not in there]
    known = [name for name, (full, _) in PROVIDERS.items() if full in there]
    if lacking:
        raise InputError(
            *(
                f"{where}: expected the execution provider {name}, found {known} in onnxruntime "
                f"{onnxruntime.__version__}; install {PROVIDERS[name][1]} in place of onnxruntime, "
                f"or leave out {name}"
                for name in lacking
            )
        )


def open_session(
    path: StrPath, providers: Sequence[str] = CPU, content: bytes | None = None
) -> onnxruntime.InferenceSession:
    """Open an ONNX file, or its changed `content`, for inference, on one thread of the processor.

    That is fastest when several files are processed in parallel: idle threads of onnxruntime spin.
    `providers` are tried in order for each operator; the processor comes last. An `InputError` if
    one of them does not open, or the file is none that onnxruntime can run.
    """
    check_providers(providers)
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = options.inter_op_num_threads = 1
    options.log_severity_level = 3
    wanted = [(PROVIDERS[name][0], OPTIONS.get(name, {})) for name in providers]
    with reading(path, "a network that onnxruntime can run", EXPORT, kinds=(Exception,)):
        session = onnxruntime.InferenceSession(content or str(path), options, providers=wanted)
    found = session.get_providers()
    lacking = [name for name in providers if PROVIDERS[name][0] not in found]
    if lacking:
        raise InputError(
            f"{path}: expected to run it by {', '.join(lacking)} (detect_pose.providers), found "
            f"only {found}; install the driver and libraries that {PROVIDERS[lacking[0]][1]} "
            f"needs, or leave out {lacking[0]}"
        )
    return session


class Network:
    """An open network with one picture as its only input.

    `outputs` are the names of what is computed, all by default; `shape` is that of the input.
    `resizable` says that `batches.of_size` applies to the file. Several pictures are computed at
    once where the first provider is not the processor and the network can: on the processor that
    saves nothing, and the results would depend on their number.
    """

    def __init__(
        self,
        path: StrPath,
        shape: Sequence[int],
        *,
        outputs: Sequence[str] | None = None,
        providers: Sequence[str] = CPU,
        resizable: bool = False,
    ) -> None:
        self.path, self.providers = path, providers
        self.session = open_session(path, providers)
        self.input_name = self._input(list(shape))
        self._of_count: dict[int, onnxruntime.InferenceSession] = {}
        self.at_once = providers[0] != "cpu" and (resizable or self._open())
        there = [one.name for one in self.session.get_outputs()]
        self.outputs = list(outputs or there)
        missing = [name for name in self.outputs if name not in there]
        if missing:
            raise InputError(f"{path}: expected the outputs {missing}, found {there}; {ENTRY}")

    def _input(self, shape: list[int]) -> str:
        found = [(one.type, one.shape) for one in self.session.get_inputs()]
        # A size that the file leaves open is a name or None.
        fits = len(found) == 1 and found[0][0] == "tensor(float)" and len(found[0][1]) == len(shape)
        fixed = zip(found[0][1], shape, strict=False) if fits else ()
        if not fits or any(isinstance(one, int) and one != wanted for one, wanted in fixed):
            raise InputError(
                f"{self.path}: expected one input, tensor(float) of shape {shape}, found {found}; "
                f"{ENTRY}, or export the network so"
            )
        return str(self.session.get_inputs()[0].name)

    def _open(self) -> bool:
        """Return whether the file leaves the number of pictures open."""
        return not isinstance(self.session.get_inputs()[0].shape[0], int)

    def run(self, tensor: NDArray) -> list[NDArray]:
        """Return the outputs for one float32 input."""
        return self._outputs(self.session, tensor)

    def run_each(self, tensors: Sequence[NDArray]) -> list[list[NDArray]]:
        """Return the outputs for each of several inputs, each as `run` returns them."""
        count = len(tensors)
        if count < 2 or not self.at_once:
            return [self.run(tensor) for tensor in tensors]
        found = self._outputs(self._session(count), np.concatenate(tensors))
        if any(len(one) != count for one in found):
            raise self.fault(f"outputs for {count} pictures at once", [one.shape for one in found])
        return [[one[at : at + 1] for one in found] for at in range(count)]

    def _session(self, count: int) -> onnxruntime.InferenceSession:
        if self._open():
            return self.session
        if count not in self._of_count:
            content = batches.of_size(self.path, count)
            self._of_count[count] = open_session(self.path, self.providers, content)
        return self._of_count[count]

    def _outputs(self, session: onnxruntime.InferenceSession, tensor: NDArray) -> list[NDArray]:
        with reading(self.path, "a network that runs", EXPORT, kinds=(Exception,)):
            return session.run(self.outputs, {self.input_name: tensor})

    def fault(self, expected: str, found: object) -> InputError:
        """Return the error that says what its outputs are instead."""
        return InputError(f"{self.path}: expected {expected}, found {found}; {ENTRY}")


def check_file(path: StrPath, sha256: str) -> None:
    """Raise an `InputError` if a file has another checksum or reads data from other files.

    It has to be checked before it is opened: onnxruntime reads what it names.
    """
    with reading(path, "an ONNX file", "put it there"):
        found = files.sha256(path)
    if found != sha256:
        raise InputError(
            f"{path}: expected sha256 {sha256}, found {found}; bring the file that is meant, or "
            f"{ENTRY}"
        )
    with reading(path, "an ONNX file", EXPORT, kinds=(Exception,)):
        model = onnx.load_model(str(path), format="protobuf", load_external_data=False)
        outside = [one for one in _tensors(model) if one.data_location == onnx.TensorProto.EXTERNAL]
        places = sorted(
            {e.value for one in outside for e in one.external_data if e.key == "location"}
        )
    if outside:
        raise InputError(
            f"{path}: expected all its data inside, found {len(outside)} tensors in "
            f"{places[:3]}; {EXPORT}"
        )


def _tensors(model: Any) -> Iterator[Any]:
    """Yield every stored tensor of a model, those of its functions and inner graphs as well."""
    graphs, nodes = [model.graph], [n for function in model.functions for n in function.node]
    for training in model.training_info:
        graphs += [training.initialization, training.algorithm]
    while graphs or nodes:
        for graph in graphs:
            yield from graph.initializer
            yield from (part for s in graph.sparse_initializer for part in (s.values, s.indices))
        nodes += [node for graph in graphs for node in graph.node]
        attributes = [attribute for node in nodes for attribute in node.attribute]
        for one in attributes:
            yield from (one.t, *one.tensors)
            sparse = [one.sparse_tensor, *one.sparse_tensors]
            yield from (part for s in sparse for part in (s.values, s.indices))
        graphs, nodes = [g for a in attributes for g in (a.g, *a.graphs) if g.ByteSize()], []
