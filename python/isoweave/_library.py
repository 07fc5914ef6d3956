"""The C interface (isoweave/isoweave.h) by ctypes, and its statuses as exceptions."""

from __future__ import annotations

import ctypes
import json
import os
import pathlib
from ctypes import POINTER, c_char_p, c_double, c_float, c_int32, c_int64, c_size_t, c_uint32, c_uint64, c_void_p
from typing import Any

ABI_VERSION = 1


class IsoweaveError(Exception):
    """The base of all errors of isoweave but of bad arguments, which are plain ``ValueError``."""


class BadInput(IsoweaveError, ValueError):
    """A volume or mesh that cannot be found, opened, understood or read to its end."""


class CannotWrite(IsoweaveError, OSError):
    """An output that cannot be created, written, or represented in its format."""


class OverMemory(IsoweaveError, MemoryError):
    """More memory than was given (``memory=``), or than there is."""


class DeviceError(IsoweaveError, RuntimeError):
    """No usable device, or the device failed."""


class Stopped(IsoweaveError):
    """A progress callback returned False, or a sink asked to stop. No file is left behind."""


class Struct(ctypes.Structure):
    """A struct of the C interface, which begins with its size."""

    def __init__(self, **members: Any) -> None:
        super().__init__(struct_size=ctypes.sizeof(self), **members)


class Result(Struct):
    # The texts are pointers, as ctypes would lose those of c_char_p before they are freed.
    _fields_ = [("struct_size", c_size_t), ("message", c_void_p), ("report", c_void_p)]


class VolumeInfo(Struct):
    _fields_ = [
        ("struct_size", c_size_t),
        ("dims", c_int64 * 3),
        ("type", c_int32),
        ("space", c_int32),
        ("spacing", c_double * 3),
        ("origin", c_double * 3),
        ("direction", c_double * 9),
        ("slope", c_double),
        ("intercept", c_double),
        ("unit", c_char_p),
        ("path", c_char_p),
    ]


class OpenOptions(Struct):
    _fields_ = [
        ("struct_size", c_size_t),
        ("raw", c_char_p),
        ("spacing", POINTER(c_double)),
        ("origin", POINTER(c_double)),
        ("dataset", c_char_p),
        ("series", c_char_p),
        ("level", POINTER(c_int64)),
        ("channel", POINTER(c_int64)),
        ("time", POINTER(c_int64)),
        ("no_external", c_int32),
        ("reserved", c_int32),
    ]


ReadSlices = ctypes.CFUNCTYPE(c_int32, c_void_p, c_int64, c_int64, c_void_p)


class Source(Struct):
    _fields_ = [("struct_size", c_size_t), ("context", c_void_p), ("read", ReadSlices), ("held_bytes", c_uint64)]


class MeshArrays(Struct):
    _fields_ = [
        ("struct_size", c_size_t),
        ("vertices", c_uint64),
        ("triangles", c_uint64),
        ("points", c_void_p),
        ("corners", c_void_p),
        ("normals", c_void_p),
        ("values", c_void_p),
        ("offset", c_double * 3),
        ("unit", c_char_p),
        ("space", c_char_p),
    ]


class CompareOptions(Struct):
    _fields_ = [
        ("struct_size", c_size_t),
        ("samples", c_uint64),
        ("threads", c_int32),
        ("distances", POINTER(c_float)),
    ]


class SimplifyOptions(Struct):
    _fields_ = [
        ("struct_size", c_size_t),
        ("error", c_char_p),
        ("levels", c_char_p),
        ("max_distance", c_char_p),
        ("triangles", c_uint64),
        ("ratio", c_double),
        ("quality", c_int32),
        ("drop_specks", c_int32),
        ("min_component", c_uint64),
        ("largest", c_int32),
        ("reserved", c_int32),
    ]


class MeshOptions(Struct):
    _fields_ = [
        ("struct_size", c_size_t),
        ("iso", c_double),
        ("simplify", POINTER(SimplifyOptions)),
        ("inside_below", c_int32),
        ("open", c_int32),
        ("smooth", c_int32),
        ("normals", c_int32),
        ("space", c_int32),
        ("values", c_void_p),
        ("extractor", c_int32),
        ("reserved", c_int32),
    ]


class CProgress(Struct):
    _fields_ = [
        ("struct_size", c_size_t),
        ("layer", c_int64),
        ("layers", c_int64),
        ("voxels", c_uint64),
        ("live_triangles", c_uint64),
        ("final_triangles", c_uint64),
        ("bytes", c_uint64),
    ]


TellProgress = ctypes.CFUNCTYPE(c_int32, c_void_p, POINTER(CProgress))


class Run(Struct):
    _fields_ = [
        ("struct_size", c_size_t),
        ("threads", c_int32),
        ("device", c_int32),
        ("slab", c_int64),
        ("memory", c_uint64),
        ("stop", c_void_p),
        ("context", c_void_p),
        ("progress", TellProgress),
        ("checkpoint", c_char_p),
        ("checkpoint_seconds", c_double),
        ("checkpoint_layers", c_int64),
        ("resume", c_int32),
        ("reserved", c_int32),
    ]


class Piece(Struct):
    _fields_ = [
        ("struct_size", c_size_t),
        ("vertices", c_uint64),
        ("triangles", c_uint64),
        ("points", c_void_p),
        ("normals", c_void_p),
        ("values", c_void_p),
        ("corners", c_void_p),
        ("offset", c_double * 3),
    ]


AppendPiece = ctypes.CFUNCTYPE(c_int32, c_void_p, POINTER(Piece))
FinishMesh = ctypes.CFUNCTYPE(c_int32, c_void_p)


class CSink(Struct):
    _fields_ = [("struct_size", c_size_t), ("context", c_void_p), ("append", AppendPiece), ("finish", FinishMesh)]


class Output(Struct):
    _fields_ = [
        ("struct_size", c_size_t),
        ("path", c_char_p),
        ("sink", POINTER(CSink)),
        ("mesh", c_void_p),
        ("compress", c_int32),
        ("label", c_char_p),
        ("iso", c_double),
    ]


_HANDLE = c_void_p
_OUT = POINTER(c_void_p)
_RESULT = POINTER(Result)

# The calls that return a status and take a result as their last argument, and what else they take.
_CALLS: dict[str, list[Any]] = {
    "iw_open_volume": [c_char_p, POINTER(OpenOptions), _OUT],
    "iw_volume_in_memory": [POINTER(VolumeInfo), c_void_p, c_size_t, _OUT],
    "iw_volume_from_source": [POINTER(VolumeInfo), POINTER(Source), _OUT],
    "iw_crop_volume": [_HANDLE, POINTER(c_int64), POINTER(c_int64), _OUT],
    "iw_downsample_volume": [_HANDLE, c_int64, _OUT],
    "iw_get_volume_info": [_HANDLE, POINTER(VolumeInfo)],
    "iw_read_slices": [_HANDLE, c_int64, c_int64, c_void_p, c_size_t],
    "iw_histogram": [_HANDLE, c_void_p],
    "iw_find_labels": [_HANDLE, c_void_p],
    "iw_mesh_from_arrays": [POINTER(MeshArrays), _OUT],
    "iw_read_mesh": [c_char_p, c_int32, _OUT],
    "iw_get_mesh_arrays": [_HANDLE, POINTER(MeshArrays)],
    "iw_write_mesh": [_HANDLE, c_char_p, c_int32],
    "iw_check_mesh": [_HANDLE, c_int32, c_int32],
    "iw_compare_meshes": [_HANDLE, _HANDLE, POINTER(CompareOptions)],
    "iw_mesh_volume": [_HANDLE, POINTER(MeshOptions), POINTER(Run), POINTER(Output), c_size_t],
    "iw_mesh_labels": [_HANDLE, POINTER(MeshOptions), POINTER(Run), POINTER(Output), c_size_t],
    "iw_mesh_isos": [_HANDLE, POINTER(MeshOptions), POINTER(Run), POINTER(Output), c_size_t],
    "iw_simplify_mesh": [_HANDLE, POINTER(SimplifyOptions), POINTER(Run), POINTER(Output), c_size_t],
    "iw_forecast": [_HANDLE, POINTER(MeshOptions), POINTER(Run)],
}


def _load() -> ctypes.CDLL:
    folder = pathlib.Path(__file__).resolve().parent
    path = os.environ.get("ISOWEAVE_LIBRARY") or str(folder / "libisoweave_c.so")
    try:
        library = ctypes.CDLL(path)
    except OSError as error:
        raise ImportError(f"{path}: expected the library of isoweave, found {error}") from error
    library.iw_abi_version.restype = c_uint32
    if library.iw_abi_version() != ABI_VERSION:
        raise ImportError(f"{path}: expected interface {ABI_VERSION}, found {library.iw_abi_version()}")
    library.iw_version.restype = c_char_p
    library.iw_result_clear.argtypes = [_RESULT]
    library.iw_result_clear.restype = None
    library.iw_stop_new.restype = c_void_p
    for name in ("iw_stop_set", "iw_stop_free", "iw_free_volume", "iw_free_mesh"):
        getattr(library, name).argtypes = [c_void_p]
        getattr(library, name).restype = None
    for name, arguments in _CALLS.items():
        getattr(library, name).argtypes = [*arguments, _RESULT]
        getattr(library, name).restype = c_int32
    return library


library = _load()
version: str = library.iw_version().decode()

_ERRORS: dict[int, type[Exception]] = {
    1: RuntimeError,
    2: ValueError,
    3: BadInput,
    4: CannotWrite,
    5: OverMemory,
    6: DeviceError,
    130: Stopped,
}


def error_of(status: int, message: str) -> Exception:
    """The exception for a status of the C interface, or for an exit code of the command line, which are the same."""
    return _ERRORS.get(status, RuntimeError)(message)


def call(name: str, *arguments: Any) -> Any:
    """Makes a call, and returns its report as Python objects; None where it has none."""
    result = Result()
    status = getattr(library, name)(*arguments, ctypes.byref(result))
    try:
        message = ctypes.string_at(result.message).decode(errors="replace") if result.message else ""
        report = ctypes.string_at(result.report) if result.report else b"null"
    finally:
        library.iw_result_clear(ctypes.byref(result))
    if status != 0:
        raise error_of(status, message)
    return json.loads(report)


def encoded(text: str | None) -> bytes | None:
    """A text for the C interface; None stays None."""
    return None if text is None else os.fsencode(text)


class Handle:
    """An object of the C interface, freed with this one."""

    def __init__(self, pointer: int | None, free: str) -> None:
        self.pointer = pointer
        self._free = getattr(library, free)

    def __del__(self) -> None:
        if self.pointer:
            self._free(self.pointer)
            self.pointer = None


def made(name: str, free: str, *arguments: Any) -> tuple[Handle, Any]:
    """Makes a call whose last argument but the result is a new object, and returns that and the report."""
    pointer = c_void_p()
    report = call(name, *arguments, ctypes.byref(pointer))
    return Handle(pointer.value, free), report
