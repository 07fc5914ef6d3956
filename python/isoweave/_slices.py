"""Anything that is an array, read slice by slice: numpy, dask, zarr, h5py, xarray, images of ITK, VTK and nibabel, ..."""

from __future__ import annotations

import sys
import threading
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Any, Callable, Protocol, Sequence

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[Any]

# The sample types of the C interface, in its order.
TYPES = ["uint8", "int8", "uint16", "int16", "uint32", "int32", "uint64", "int64", "float32", "float64"]
_CHANGED = {"bool": "uint8", "float16": "float32"}

_ROW_BYTES = 1 << 25  # of a row, where the array has no chunks
_ROWS_AHEAD = 2


class ArrayLike(Protocol):
    """An object with a shape and a dtype that can be sliced."""

    @property
    def shape(self) -> Sequence[int]: ...

    @property
    def dtype(self) -> Any: ...

    def __getitem__(self, key: Any) -> Any: ...


@dataclass
class Geometry:
    """Where samples lie: origin + direction * (spacing * (i, j, k)); all in the order x, y, z."""

    spacing: tuple[float, ...] = (1.0, 1.0, 1.0)
    origin: tuple[float, ...] = (0.0, 0.0, 0.0)
    direction: tuple[float, ...] = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)  # row-major
    space: str = "unknown"  # "lps", "ras" or "unknown"
    unit: str = ""


@dataclass
class Slices:
    """An array as slices: (z, y, x)."""

    shape: tuple[int, int, int]
    dtype: np.dtype[Any]  # of the samples that read() gives: one of TYPES
    read: Callable[[int, int], Array]  # slices [first, end), of any layout
    chunk: int = 1  # slices that are best read together: a row
    ahead: int = 0  # rows that are read before they are needed
    whole: Array | None = None  # all samples, where they are in memory in the very layout of the C interface
    geometry: Geometry = field(default_factory=Geometry)
    slope: float = 1.0
    intercept: float = 0.0


def _module(thing: Any) -> str:
    return type(thing).__module__.partition(".")[0]


def to_numpy(block: Any) -> Array:
    """A part of an array in the memory of the processor."""
    if isinstance(block, np.ndarray):
        return block
    if hasattr(block, "compute"):  # dask
        return to_numpy(block.compute())
    if hasattr(block, "detach"):  # torch
        return np.asarray(block.detach().cpu().numpy())
    if _module(block) == "cupy":
        return np.asarray(block.get())
    if _module(block) == "tensorstore":
        return np.asarray(block.read().result())
    return np.asarray(block)


def _sample_type(dtype: Any) -> np.dtype[Any]:
    """The sample type that holds all values of a dtype."""
    name = str(getattr(dtype, "numpy_dtype", dtype)).removeprefix("torch.")  # tensorstore's have names of their own
    try:
        native: np.dtype[Any] = np.dtype(name).newbyteorder("=")
    except TypeError:
        raise ValueError(f"volume: expected samples of a type of numpy, found {dtype}") from None
    name = _CHANGED.get(native.name, native.name)
    if name not in TYPES:
        raise ValueError(f"volume: expected integers or floats of at most 64 bits, found {dtype}")
    sample_type: np.dtype[Any] = np.dtype(name)
    return sample_type


def _index(axes: str, channel: int | None, time: int | None, shape: Sequence[int]) -> tuple[list[Any], str]:
    """An index that picks a channel and a time, and the axes that are left."""
    index: list[Any] = []
    for axis, size in zip(axes, shape):
        if axis in "zyx":
            index.append(slice(None))
            continue
        picked = channel if axis == "c" else time
        picked = 0 if picked is None else picked
        if not -size <= picked < size:
            raise ValueError(f"{'channel' if axis == 'c' else 'time'}: expected a number below {size}, found {picked}")
        index.append(picked)
    return index, "".join(axis for axis in axes if axis in "zyx")


def _checked_axes(axes: str, shape: Sequence[int], channel: int | None, time: int | None) -> str:
    if sorted(axes.replace("c", "", 1).replace("t", "", 1)) != ["x", "y", "z"]:
        raise ValueError(f"axes: expected z, y and x in any order, perhaps with c and t, found {axes!r}")
    if len(axes) != len(shape):
        raise ValueError(f"axes: expected {len(axes)} dimensions as in {axes!r}, found shape {tuple(shape)}")
    for name, value, axis in (("channel", channel, "c"), ("time", time, "t")):
        if value is not None and axis not in axes:
            raise ValueError(f"{name}: expected {axis!r} in axes, found {axes!r}")
    return axes


def _contiguous(array: Array, dtype: np.dtype[Any]) -> Array | None:
    """The array where its memory is as the C interface wants it."""
    if array.dtype.name == "bool":
        array = array.view(np.uint8)
    fits = array.dtype == dtype and array.dtype.isnative and array.flags.c_contiguous and array.flags.aligned
    return array if fits else None


def _from_numpy(array: Array, axes: str, channel: int | None, time: int | None) -> Slices:
    axes = _checked_axes(axes, array.shape, channel, time)
    index, left = _index(axes, channel, time, array.shape)
    picked = array[tuple(index)].transpose([left.index(axis) for axis in "zyx"])
    shape = (picked.shape[0], picked.shape[1], picked.shape[2])
    dtype = _sample_type(picked.dtype)
    return Slices(shape, dtype, lambda first, end: picked[first:end], whole=_contiguous(picked, dtype))


def _chunk_of(array: Any, axis: int) -> int:
    """How many slices one row of chunks has along an axis."""
    if _module(array) == "tensorstore":
        return int(array.chunk_layout.read_chunk.shape[axis] or 0)
    chunks = getattr(array, "shards", None) or getattr(array, "chunks", None)
    if chunks is None:
        return 0
    size = chunks[axis]
    return int(size[0] if isinstance(size, tuple) else size)


def _from_slices_of(array: ArrayLike, axes: str, channel: int | None, time: int | None) -> Slices:
    """An array that is read by slicing."""
    axes = _checked_axes(axes, array.shape, channel, time)
    index, left = _index(axes, channel, time, array.shape)
    z = axes.index("z")
    order = [left.index(axis) for axis in "zyx"]

    def read(first: int, end: int) -> Array:
        of_slab = list(index)
        of_slab[z] = slice(first, end)
        slab: Array = to_numpy(array[tuple(of_slab)]).transpose(order)
        return slab

    nz, ny, nx = (int(array.shape[axes.index(axis)]) for axis in "zyx")
    dtype = _sample_type(array.dtype)
    chunk = _chunk_of(array, z) or max(1, _ROW_BYTES // max(1, ny * nx * dtype.itemsize))
    return Slices((nz, ny, nx), dtype, read, chunk, _ROWS_AHEAD)


def _from_callable(function: Any, shape: Any, dtype: Any) -> Slices:
    """A function of (first, end) that returns slices."""
    if len(shape) != 3:
        raise ValueError(f"volume: expected a shape (z, y, x), found {tuple(shape)}")
    nz, ny, nx = (int(size) for size in shape)

    def read(first: int, end: int) -> Array:
        return to_numpy(function(first, end))

    return Slices((nz, ny, nx), _sample_type(dtype), read)


def _numbers(values: Any) -> tuple[float, ...]:
    return tuple(float(value) for value in np.asarray(values, dtype=float).ravel())


def _from_simpleitk(image: Any) -> Slices:
    sitk = sys.modules["SimpleITK"]
    if image.GetDimension() != 3 or image.GetNumberOfComponentsPerPixel() != 1:
        raise ValueError(
            f"volume: expected a 3-D image with one component, found {image.GetDimension()}-D "
            f"with {image.GetNumberOfComponentsPerPixel()}"
        )
    slices = _from_numpy(sitk.GetArrayViewFromImage(image), "zyx", None, None)
    slices.geometry = Geometry(
        _numbers(image.GetSpacing()), _numbers(image.GetOrigin()), _numbers(image.GetDirection()), "lps"
    )
    return slices


def _from_itk(image: Any) -> Slices:
    itk = sys.modules["itk"]
    slices = _from_numpy(np.asarray(itk.array_view_from_image(image)), "zyx", None, None)
    slices.geometry = Geometry(
        _numbers(image.GetSpacing()),
        _numbers(image.GetOrigin()),
        _numbers(itk.array_from_matrix(image.GetDirection())),
        "lps",
    )
    return slices


def geometry_of_affine(affine: Any, space: str, unit: str = "") -> Geometry:
    """The geometry of a matrix from indices (i, j, k) to the world, 4 x 4 or 3 x 4."""
    matrix = np.asarray(affine, dtype=float)
    if matrix.shape not in ((4, 4), (3, 4)):
        raise ValueError(f"affine: expected 4 x 4 or 3 x 4 numbers, found shape {matrix.shape}")
    spacing = np.linalg.norm(matrix[:3, :3], axis=0)
    if not np.all(np.isfinite(matrix)) or not np.all(spacing > 0):
        raise ValueError("affine: expected finite numbers and columns that are not 0")
    direction = matrix[:3, :3] / spacing
    return Geometry(_numbers(spacing), _numbers(matrix[:3, 3]), _numbers(direction), space, unit)


def _from_nibabel(image: Any, time: int | None) -> Slices:
    """Stored samples of an image of nibabel, whose first index is the fastest: x, y, z and perhaps t."""
    stored = image.dataobj
    slope, intercept = 1.0, 0.0
    if hasattr(stored, "slope") and hasattr(stored, "file_like"):
        slope, intercept = float(stored.slope), float(stored.inter)
        stored = type(stored)(stored.file_like, (stored.shape, stored.dtype, stored.offset, 1.0, 0.0))
    axes = "xyzt"[: len(stored.shape)]
    if isinstance(stored, np.ndarray):
        slices = _from_numpy(stored, axes, None, time)
    else:
        slices = _from_slices_of(stored, axes, None, time)
    unit = {"mm": "mm", "micron": "um", "meter": "m"}.get(getattr(image.header, "get_xyzt_units", lambda: ("",))()[0], "")
    slices.geometry = geometry_of_affine(image.affine, "ras", unit)
    slices.slope, slices.intercept = slope, intercept
    return slices


def _vtk_scalars(image: Any, name: str | None) -> tuple[Any, bool]:
    """The scalars of an image, and whether they belong to its points. Points go before cells."""
    for data, at_points in ((image.GetPointData(), True), (image.GetCellData(), False)):
        scalars = data.GetArray(name) if name is not None else data.GetScalars()
        if scalars is None and name is None and data.GetNumberOfArrays() == 1:
            scalars = data.GetArray(0)
        if scalars is not None:
            return scalars, at_points
    raise ValueError(f"volume: expected scalars {name or ''} at the points or cells of the image, found none".replace("  ", " "))


def _from_vtk(image: Any, name: str | None) -> Slices:
    """The scalars of a vtkImageData, also of PyVista's: their memory itself."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    scalars, at_points = _vtk_scalars(image, name)
    if scalars.GetNumberOfComponents() != 1:
        raise ValueError(f"volume: expected scalars with one component, found {scalars.GetNumberOfComponents()}")
    extent = image.GetExtent()
    nx, ny, nz = (extent[2 * a + 1] - extent[2 * a] + (1 if at_points else 0) for a in range(3))
    slices = _from_numpy(vtk_to_numpy(scalars).reshape(nz, ny, nx), "zyx", None, None)
    matrix = image.GetDirectionMatrix()
    direction = np.array([[matrix.GetElement(row, column) for column in range(3)] for row in range(3)])
    spacing = np.array(image.GetSpacing())
    first = np.array(extent[::2]) + (0.0 if at_points else 0.5)  # of the first sample: extents need not begin at 0
    origin = np.array(image.GetOrigin()) + direction @ (spacing * first)
    slices.geometry = Geometry(_numbers(spacing), _numbers(origin), _numbers(direction))
    return slices


def _even_step(name: str, coordinates: Array) -> tuple[float, float]:
    """The first of evenly spaced coordinates, and the step."""
    if len(coordinates) < 2:
        return float(coordinates[0]), 1.0
    steps = np.diff(coordinates.astype(float))
    step = float(coordinates[-1] - coordinates[0]) / (len(coordinates) - 1)
    if step == 0 or np.max(np.abs(steps - step)) > 1e-3 * abs(step):
        raise ValueError(
            f"volume: expected evenly spaced coordinates along {name!r}, found steps of {steps.min()} to {steps.max()}"
        )
    return float(coordinates[0]), step


def _from_xarray(array: Any, axes: str | None, channel: int | None, time: int | None) -> Slices:
    """A DataArray, with the spacing of its coordinates. Its dimensions may be called z, y, x, c and t."""
    names = [str(name) for name in array.dims]
    if axes is None:
        letters = "".join(name.lower() for name in names)
        axes = letters if sorted(letters.replace("c", "").replace("t", "")) == ["x", "y", "z"] else "zyx"
    data = array.variable._data if isinstance(array.variable._data, np.ndarray) else None
    lazy = array.data if data is None and array.chunks is not None else array
    slices = _from_numpy(data, axes, channel, time) if data is not None else _from_slices_of(lazy, axes, channel, time)
    spacing, origin, direction = [1.0] * 3, [0.0] * 3, np.eye(3)
    unit = ""
    for place, axis in enumerate("xyz"):
        name = array.dims[axes.index(axis)]
        if name not in array.coords:
            continue
        origin[place], step = _even_step(str(name), np.asarray(array.coords[name]))
        spacing[place] = abs(step)
        direction[place, place] = np.sign(step)
        unit = str(array.coords[name].attrs.get("units", unit))
    slices.geometry = Geometry(tuple(spacing), tuple(origin), _numbers(direction), unit=unit)
    return slices


def slices_of(
    volume: Any, *, axes: str | None, channel: int | None, time: int | None, scalars: str | None
) -> Slices:
    """Anything that is an array as slices."""
    module = _module(volume)
    order = "zyx" if axes is None else axes
    if isinstance(volume, np.ndarray):
        return _from_numpy(volume, order, channel, time)
    if hasattr(volume, "IsA") and volume.IsA("vtkImageData"):
        return _from_vtk(volume, scalars)
    if module == "SimpleITK":
        return _from_simpleitk(volume)
    if module == "itk" and hasattr(volume, "GetLargestPossibleRegion"):
        return _from_itk(volume)
    if hasattr(volume, "dataobj") and hasattr(volume, "affine"):
        return _from_nibabel(volume, time)
    if module == "xarray":
        return _from_xarray(volume, axes, channel, time)
    if hasattr(volume, "shape") and hasattr(volume, "dtype"):
        if hasattr(volume, "__dlpack_device__") and volume.__dlpack_device__()[0] == 1 and module not in ("dask", "zarr"):
            _sample_type(volume.dtype)  # DLPack has types that numpy has not
            return _from_numpy(np.from_dlpack(volume), order, channel, time)
        if hasattr(volume, "__getitem__"):
            return _from_slices_of(volume, order, channel, time)
        if callable(volume):
            return _from_callable(volume, volume.shape, volume.dtype)
    try:
        array = np.asarray(volume)
    except Exception:
        array = np.asarray(None)
    if array.dtype.kind not in "biuf":
        raise TypeError(f"volume: expected an array, an image or a path, found {type(volume).__name__}")
    return _from_numpy(array, order, channel, time)


class SlabReader:
    """Slices as the C interface asks for them, read by whole rows of chunks, some of them ahead.

    A row is given up before the next one is waited for, so no more are held than one and those ahead.
    """

    def __init__(self, slices: Slices) -> None:
        self._slices = slices
        self._lock = threading.Lock()
        self._rows: dict[int, Array] = {}  # the one that is copied from
        self._ahead: dict[int, Future[Array]] = {}
        self._pool: ThreadPoolExecutor | None = None

    @property
    def held_bytes(self) -> int:
        """The most bytes of rows that are held."""
        slices, (nz, ny, nx) = self._slices, self._slices.shape
        return min(nz, (1 + slices.ahead) * slices.chunk) * ny * nx * slices.dtype.itemsize

    def copy(self, first: int, out: Array) -> None:
        """Copies slices from `first` on into `out`, as many as it has."""
        done = 0
        while done < len(out):
            done += self._copy_of_row(first + done, out[done:])

    def close(self) -> None:
        """Ends the thread that reads ahead, and forgets the rows."""
        with self._lock:
            pool, self._pool = self._pool, None
            self._rows.clear()
            self._ahead.clear()
        if pool is not None:
            pool.shutdown(wait=True, cancel_futures=True)

    def _copy_of_row(self, first: int, out: Array) -> int:
        """Copies slices of one row, and returns how many."""
        row = first // self._slices.chunk
        block = self._row(row)
        begin = first - row * self._slices.chunk
        count = min(len(out), len(block) - begin)
        np.copyto(out[:count], block[begin : begin + count], casting="unsafe")
        return count

    def _bounds(self, row: int) -> tuple[int, int]:
        return row * self._slices.chunk, min((row + 1) * self._slices.chunk, self._slices.shape[0])

    def _read(self, row: int) -> Array:
        first, end = self._bounds(row)
        block = self._slices.read(first, end)
        expected = (end - first, *self._slices.shape[1:])
        if tuple(block.shape) != expected:
            raise ValueError(f"volume: expected slices {first} to {end} of shape {expected}, found {tuple(block.shape)}")
        return block

    def _row(self, row: int) -> Array:
        with self._lock:
            if self._slices.ahead == 0:
                return self._read(row)
            if row not in self._rows:
                self._rows.clear()
                self._ask_for(row)
                self._rows[row] = self._ahead.pop(row).result()
            return self._rows[row]

    def _ask_for(self, row: int) -> None:
        """Has a row read, and those after it; a thread reads them one after the other."""
        end = min(row + 1 + self._slices.ahead, -(-self._slices.shape[0] // self._slices.chunk))
        for other in [other for other in self._ahead if not row <= other < end]:
            self._ahead.pop(other).cancel()
        if self._pool is None:
            self._pool = ThreadPoolExecutor(1, "isoweave-read")
        for wanted in range(row, end):
            if wanted not in self._ahead:
                self._ahead[wanted] = self._pool.submit(self._read, wanted)
