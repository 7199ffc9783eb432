"""Tensors of a TFLite file: names, shapes, and the values of constants, sparse ones made dense.

The flatbuffer classes check nothing, so counts and lengths are checked here before they are used.
Functions raise `ValueError`, or one of `DAMAGED` on a damaged file; the reader of the file names
it.
"""

import dataclasses
import math
import struct
from collections.abc import Sequence
from typing import Any

import numpy as np
import tflite
from numpy.typing import NDArray

# Far above any pose network (900 tensors), far below what would fill the memory.
MAX_RECORDS = 20_000
MAX_RANK = 8
MAX_NAME_BYTES = 1000
MAX_ELEMENTS = 1 << 24

# What the flatbuffer classes and numpy raise on a damaged file.
DAMAGED = (struct.error, ValueError, IndexError, TypeError, AttributeError, OverflowError)
DTYPES: dict[str, np.dtype] = {
    "FLOAT32": np.dtype("<f4"),
    "FLOAT16": np.dtype("<f2"),
    "INT32": np.dtype("<i4"),
    "INT64": np.dtype("<i8"),
}
INDEX_VECTORS = {
    tflite.SparseIndexVector.Int32Vector: tflite.Int32Vector,
    tflite.SparseIndexVector.Uint16Vector: tflite.Uint16Vector,
    tflite.SparseIndexVector.Uint8Vector: tflite.Uint8Vector,
}


def names_of(enum: type) -> dict[int, str]:
    """Return the names of an enumeration's members by their numbers."""
    return {number: name for name, number in vars(enum).items() if isinstance(number, int)}


TYPES = names_of(tflite.TensorType)


@dataclasses.dataclass(frozen=True, eq=False)
class Tensor:
    """A tensor: its name, shape and type; for a constant its values, else None."""

    name: str
    shape: tuple[int, ...]
    dtype: np.dtype
    data: NDArray | None


def entries(table: Any, name: str) -> list[Any]:
    """Return all tables of a table's vector, such as `Tensors` of a subgraph."""
    count = getattr(table, f"{name}Length")()
    if count > MAX_RECORDS:
        raise ValueError(f"{count} {name.lower()} (at most {MAX_RECORDS})")
    return [getattr(table, name)(place) for place in range(count)]


def integers(table: Any, name: str, most: int) -> tuple[int, ...]:
    """Return the vector `name` of a flatbuffer table; more than `most` entries are damage."""
    count = getattr(table, f"{name}Length")()
    if count > most:
        raise ValueError(f"{count} {name.lower()} (at most {most})")
    return tuple(getattr(table, f"{name}AsNumpy")().tolist()) if count else ()


def read_tensor(entry: Any, buffers: Sequence[Any]) -> Tensor:
    """Read one tensor of a file with these buffers.

    Values stored dense are a view into the file's bytes; float16 stays float16. Raises `ValueError`
    if the tensor's type or sparse layout is not supported, or its parts do not belong together; any
    of `DAMAGED` if they lie outside the file.
    """
    stored = entry.Name() or b""
    if len(stored) > MAX_NAME_BYTES:
        raise ValueError(f"a tensor's name of {len(stored)} bytes")
    name = stored.decode()
    try:
        shape = integers(entry, "Shape", MAX_RANK)
        kind = TYPES.get(entry.Type(), entry.Type())
        if kind not in DTYPES:
            raise ValueError(f"type {kind} (read are {', '.join(DTYPES)})")
        return Tensor(name, shape, DTYPES[kind], _values(entry, shape, DTYPES[kind], buffers))
    except DAMAGED as error:
        raise ValueError(f"tensor {name!r}: {error}") from None


def densify(
    values: NDArray, shape: tuple[int, ...], segments: NDArray, indices: NDArray
) -> NDArray:
    """Make a tensor dense whose last dimension is stored as compressed sparse rows.

    All dimensions of the dense shape but the last, flattened, are the rows. Of the stored values
    (N,), row r has those from `segments[r]` to before `segments[r + 1]`, at places `indices` (N,).
    Raises `ValueError` if the parts do not belong together.
    """
    rows, columns = math.prod(shape[:-1]), shape[-1]
    counts = np.diff(segments)
    if len(segments) != rows + 1 or segments[0] != 0 or (counts < 0).any():
        raise ValueError(f"sparse rows that do not make {rows} rows")
    if not len(values) == len(indices) == segments[-1]:
        raise ValueError(f"{len(values)} values, {len(indices)} indices for {segments[-1]} entries")
    if ((indices < 0) | (indices >= columns)).any():
        raise ValueError(f"a sparse index outside 0 to {columns - 1}")
    dense = np.zeros((rows, columns), values.dtype)
    dense[np.repeat(np.arange(rows), counts), indices] = values
    return dense.reshape(shape)


def _values(
    entry: Any, shape: tuple[int, ...], dtype: np.dtype, buffers: Sequence[Any]
) -> NDArray | None:
    if any(length < 0 for length in shape) or not entry.Buffer() < len(buffers):
        raise ValueError(f"shape {shape}, buffer {entry.Buffer()} of {len(buffers)}")
    buffer = buffers[entry.Buffer()]
    if buffer.DataLength() == 0:
        return None
    if math.prod(shape) > MAX_ELEMENTS:
        raise ValueError(f"a constant of shape {shape} (at most {MAX_ELEMENTS} elements)")
    values = buffer.DataAsNumpy().view(dtype)
    if entry.Sparsity() is not None:
        return densify(values, shape, *_sparse_rows(entry.Sparsity(), shape))
    return values.reshape(shape)


def _sparse_rows(sparsity: Any, shape: tuple[int, ...]) -> tuple[NDArray, NDArray]:
    order = integers(sparsity, "TraversalOrder", 2 * MAX_RANK)
    dimensions = entries(sparsity, "DimMetadata")
    formats = [dimension.Format() for dimension in dimensions]
    dense, rows = tflite.DimensionType.DENSE, tflite.DimensionType.SPARSE_CSR
    expected = [dense] * (len(shape) - 1) + [rows]
    if formats != expected or order != tuple(range(len(shape))) or sparsity.BlockMapLength():
        raise ValueError(
            f"a sparse layout other than rows along the last dimension (dimensions {formats}, "
            f"order {order}, {sparsity.BlockMapLength()} blocked)"
        )
    if tuple(dimension.DenseSize() for dimension in dimensions[:-1]) != shape[:-1]:
        raise ValueError(f"a sparse layout of another shape than {shape}")
    last = dimensions[-1]
    return (
        _index_vector(last.ArraySegmentsType(), last.ArraySegments()),
        _index_vector(last.ArrayIndicesType(), last.ArrayIndices()),
    )


def _index_vector(kind: int, stored: Any) -> NDArray:
    if stored is None or kind not in INDEX_VECTORS:
        raise ValueError(f"sparse indices of unknown type {kind}")
    vector = INDEX_VECTORS[kind]()
    vector.Init(stored.Bytes, stored.Pos)
    return np.asarray(vector.ValuesAsNumpy(), np.int64).reshape(-1)
