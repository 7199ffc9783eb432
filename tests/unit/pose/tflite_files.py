"""TFLite networks for tests: where real ones lie, how to build small ones, and Google's interpreter."""

from pathlib import Path

import numpy as np
from ai_edge_litert import schema_py_generated as schema
from ai_edge_litert.interpreter import Interpreter, OpResolverType
from flatbuffers import Builder

from real_data import REAL

ROOT = Path(__file__).parents[3]
FETCHED = [
    folder / "results/external/mediapipe/mediapipe/modules"
    for folder in (ROOT, ROOT / "tests/smoke")
]
NETWORKS = (
    "blazepose-lite-0.8.10.2.tflite",
    "cpm-mobile-14.tflite",
    "hourglass-mobile-14.tflite",
    "pose_detection/pose_detection.tflite",
    "pose_landmark/pose_landmark_full.tflite",
)
TYPES = {"float32": 0, "float16": 1, "int32": 2, "int64": 4, "int8": 9}


def find(name):
    """Return where a real network lies, or None."""
    places = [REAL / "models" / name, *(folder / name for folder in FETCHED)]
    return next((place for place in places if place.is_file()), None)


class Network:
    """A small TFLite network, built tensor by tensor and operator by operator."""

    def __init__(self):
        self.model = schema.ModelT()
        self.model.version = 3
        self.model.buffers = [schema.BufferT()]
        self.model.operatorCodes = []
        self.graph = schema.SubGraphT()
        self.graph.tensors, self.graph.operators = [], []
        self.graph.inputs, self.graph.outputs = [], []
        self.model.subgraphs = [self.graph]

    def tensor(self, shape, dtype="float32", values=None, sparsity=None):
        tensor = schema.TensorT()
        tensor.shape, tensor.type, tensor.buffer = list(shape), TYPES[dtype], 0
        tensor.name, tensor.sparsity = f"t{len(self.graph.tensors)}", sparsity
        tensor.hasRank = True
        if values is not None:
            buffer = schema.BufferT()
            buffer.data = np.frombuffer(np.ascontiguousarray(values).tobytes(), np.uint8)
            tensor.buffer = len(self.model.buffers)
            self.model.buffers.append(buffer)
        self.graph.tensors.append(tensor)
        return len(self.graph.tensors) - 1

    def constant(self, values):
        return self.tensor(values.shape, values.dtype.name, values)

    def image(self, *shape):
        self.graph.inputs.append(self.tensor(shape))
        return self.graph.inputs[-1]

    def add(self, kind, inputs, shape, options=None, dtype="float32", **fields):
        code = schema.OperatorCodeT()
        code.builtinCode = getattr(schema.BuiltinOperator, kind)
        code.deprecatedBuiltinCode, code.version = min(code.builtinCode, 127), 1
        self.model.operatorCodes.append(code)
        operator = schema.OperatorT()
        operator.opcodeIndex, operator.inputs = len(self.model.operatorCodes) - 1, list(inputs)
        operator.outputs = [self.tensor(shape, dtype)]
        if options:
            operator.builtinOptionsType = getattr(schema.BuiltinOptions, options)
            operator.builtinOptions = getattr(schema, f"{options}T")()
            for name, value in fields.items():
                setattr(operator.builtinOptions, name, value)
        self.graph.operators.append(operator)
        self.graph.outputs = operator.outputs
        return operator.outputs[0]

    def write(self, path):
        builder = Builder()
        builder.Finish(self.model.Pack(builder), b"TFL3")
        path.write_bytes(builder.Output())
        return path


def sparse_rows(dense):
    """Return the stored values and the layout of an array whose last dimension is sparse."""
    rows = dense.reshape(-1, dense.shape[-1])
    sparsity = schema.SparsityParametersT()
    sparsity.traversalOrder, sparsity.dimMetadata = list(range(dense.ndim)), []
    for length in dense.shape[:-1]:
        dimension = schema.DimensionMetadataT()
        dimension.format, dimension.denseSize = schema.DimensionType.DENSE, length
        sparsity.dimMetadata.append(dimension)
    last = schema.DimensionMetadataT()
    last.format = schema.DimensionType.SPARSE_CSR
    last.arraySegmentsType = schema.SparseIndexVector.Uint16Vector
    last.arraySegments = schema.Uint16VectorT()
    last.arraySegments.values = np.r_[0, np.cumsum((rows != 0).sum(1))].astype(np.uint16)
    last.arrayIndicesType = schema.SparseIndexVector.Uint8Vector
    last.arrayIndices = schema.Uint8VectorT()
    last.arrayIndices.values = np.nonzero(rows)[1].astype(np.uint8)
    sparsity.dimMetadata.append(last)
    return rows[rows != 0], sparsity


def interpret(path, values):
    """Run a network in Google's interpreter, with its plain reference kernels, on one thread."""
    interpreter = Interpreter(
        model_path=str(path),
        num_threads=1,
        experimental_op_resolver_type=OpResolverType.BUILTIN_REF,
    )
    interpreter.allocate_tensors()
    interpreter.set_tensor(interpreter.get_input_details()[0]["index"], values)
    interpreter.invoke()
    return {
        detail["name"]: interpreter.get_tensor(detail["index"])
        for detail in interpreter.get_output_details()
    }
