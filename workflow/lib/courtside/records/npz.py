"""Read and write npz files whose keys, shapes and types are stated and checked.

Every file holds `format` (what it is, with a version) beside its arrays, and never a pickled
object.
"""

from collections.abc import Callable, Collection, Mapping
from typing import TypeVar, get_type_hints

import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.study.errors import InputError, StrPath, reading, require_type
from courtside.study.execution.files import atomic

# For each key its kind (of `KINDS`) and the names of its dimensions: one name means one length
# throughout the file, a digit string a fixed length.
Spec = Mapping[str, tuple[str, tuple[str, ...]]]
KINDS = {"float": np.floating, "int": np.integer, "bool": np.bool_, "str": np.str_}
Record = TypeVar("Record")


def write(path: StrPath, form: str, spec: Spec, arrays: Mapping[str, ArrayLike]) -> None:
    """Write arrays under their names, after checking them; the file appears only when whole.

    `form` says what the file is, with its version: "courtside keypoints2d 1". A `ValueError` if a
    key of `spec` is missing, another is there, a kind or shape is not as stated, or `time_s` does
    not increase.
    """
    checked = {key: np.asarray(value) for key, value in arrays.items()}
    fault = _fault(spec, checked)
    if fault:
        raise ValueError(f"{path}: {fault}")
    with atomic(path) as temporary, temporary.open("wb") as stream:
        # mypy takes the arrays for allow_pickle, too.
        np.savez_compressed(stream, format=np.array(form), **checked)  # type: ignore[arg-type]


def read(
    path: StrPath,
    form: str,
    spec: Spec | Callable[[Collection[str]], Spec],
    left_out: Collection[str] = (),
) -> dict[str, NDArray]:
    """Read arrays written by `write`: one for each key of `spec`.

    `spec` may be a function that returns it by the keys that the file has. An `InputError` if the
    file is not an npz of this form, or its arrays are not as stated. An array of NaN alone is not
    writable (`unknown`), and those of the keys `left_out` are read as such.
    """
    with (
        reading(path, f"an npz file ({form})"),
        require_type(np.load(path, allow_pickle=False), np.lib.npyio.NpzFile) as stored,
    ):
        found = {key: _lean(np.asarray(stored[key]), key in left_out) for key in stored.files}
    stated = str(found.pop("format", "no format"))
    if stated != form:
        raise InputError(f"{path}: expected format {form!r}, found {stated!r}; make it again")
    fault = _fault(spec(found) if callable(spec) else spec, found)
    if fault:
        raise InputError(f"{path}: {fault}; make it again")
    return found


def unknown(shape: tuple[int, ...]) -> NDArray:
    """Return an array of NaN, not writable, that is one number in memory.

    Of an hour of two persons each covariance that is not known would need 800 MB.
    """
    return np.broadcast_to(np.nan, shape)


def _lean(array: NDArray, left_out: bool) -> NDArray:
    """Return an array, in the form of `unknown` if it is one of NaN alone or left out."""
    if array.dtype != float or array.ndim == 0:
        return array
    return unknown(array.shape) if left_out or np.isnan(array).all() else array


def spec_of(record: type) -> Spec:
    """Return the spec of a dataclass: kind and dimensions of `Annotated[NDArray, "int T J"]`.

    A field of a plain type (str, float) is a value without dimensions.
    """
    found = {}
    for name, hint in get_type_hints(record, include_extras=True).items():
        kind, *dimensions = getattr(hint, "__metadata__", (hint.__name__,))[0].split()
        found[name] = kind, tuple(dimensions)
    return found


def write_record(path: StrPath, form: str, record: object) -> None:
    """Write a dataclass that `spec_of` understands, as `write`."""
    write(path, form, spec_of(type(record)), vars(record))


def read_record(
    path: StrPath, form: str, kind: type[Record], left_out: Collection[str] = ()
) -> Record:
    """Read a dataclass that `write_record` wrote, as `read`."""
    arrays = read(path, form, spec_of(kind), left_out)
    return kind(**{key: value if value.ndim else value.item() for key, value in arrays.items()})


def _fault(spec: Spec, arrays: Mapping[str, NDArray]) -> str | None:
    if set(arrays) != set(spec):
        return f"expected keys {sorted(spec)}, found {sorted(arrays)}"
    lengths: dict[str, int] = {}
    for key, (kind, dimensions) in spec.items():
        array = arrays[key]
        if not np.issubdtype(array.dtype, KINDS[kind]):
            return f"{key}: expected {kind}, found {array.dtype}"
        if not _fits(array.shape, dimensions, lengths):
            known = {name: lengths[name] for name in dimensions if name in lengths}
            return f"{key}: expected shape {dimensions} with {known}, found {array.shape}"
    if "time_s" in spec and not (np.diff(arrays["time_s"]) > 0).all():
        return "time_s: expected times that increase, found others"
    return None


def _fits(shape: tuple[int, ...], dimensions: tuple[str, ...], lengths: dict[str, int]) -> bool:
    if len(shape) != len(dimensions):
        return False
    return all(
        length == (int(name) if name.isdigit() else lengths.setdefault(name, length))
        for length, name in zip(shape, dimensions, strict=True)
    )
