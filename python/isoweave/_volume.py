"""Volumes: arrays, images and files, to be meshed any number of times."""

from __future__ import annotations

import ctypes
import operator
import os
import re
import threading
from typing import Any, Iterable, Sequence, Union

import numpy as np
import numpy.typing as npt

from . import _library as c
from ._run import RunState
from ._slices import TYPES, Geometry, SlabReader, Slices, geometry_of_affine, slices_of

_SPACES = ["unknown", "lps", "ras"]

VolumeLike = Union["Volume", str, "os.PathLike[str]", Any]
Triple = Sequence[float]


def _doubles(values: Any, count: int, name: str) -> Any:
    numbers = np.asarray(values, dtype=float).ravel()
    if numbers.size == 1 and count == 3:
        numbers = np.repeat(numbers, 3)
    if numbers.size != count:
        raise ValueError(f"{name}: expected {count} numbers, found {numbers.size}")
    return (ctypes.c_double * count)(*numbers)


def _optional(number: int | None) -> Any:
    return None if number is None else ctypes.pointer(ctypes.c_int64(number))


Roi = Iterable["slice | tuple[int | None, int | None]"]


def ranges_of(roi: Roi) -> list[slice]:
    """A region as three slices along z, y, x, without steps."""
    try:
        ranges = [part if isinstance(part, slice) else slice(*part) for part in roi]
    except TypeError:
        raise ValueError(f"roi: expected three ranges along z, y, x, found {roi!r}") from None
    if len(ranges) != 3 or any(part.step not in (None, 1) for part in ranges):
        raise ValueError(f"roi: expected three ranges along z, y, x, found {ranges}")
    return ranges


class Volume:
    """A regular grid of samples, read slice by slice by every run anew: never as a whole.

    Arrays are ``(z, y, x)``; ``spacing``, ``origin``, ``direction`` and coordinates are ``(x, y, z)``. Made by
    :func:`isoweave.open_volume` from files, arrays and images; every function that takes a volume makes one from what it
    is given. A volume may be used by several threads.
    """

    def __init__(self, handle: c.Handle, keep: Any = None, reader: SlabReader | None = None) -> None:
        self._handle = handle
        self._keep = keep  # what the C interface refers to
        self._reader = reader
        self._errors = keep.errors if isinstance(keep, _CallbackSource) else _SourceErrors()
        info = c.VolumeInfo()
        self._facts: dict[str, Any] = c.call("iw_get_volume_info", handle.pointer, ctypes.byref(info))
        self._stored = np.dtype(TYPES[info.type])

    @property
    def shape(self) -> tuple[int, int, int]:
        """Numbers of samples along z, y, x."""
        nx, ny, nz = self._facts["dims"]
        return nz, ny, nx

    ndim = 3

    @property
    def dtype(self) -> np.dtype[Any]:
        """The type of the values: that of the samples, or float64 where a slope or intercept scales them."""
        return np.dtype(np.float64) if self._scaled() else self._stored

    @property
    def spacing(self) -> tuple[float, float, float]:
        """Distance of samples along x, y, z, in ``unit``."""
        x, y, z = self._facts["spacing"]
        return x, y, z

    @property
    def origin(self) -> tuple[float, float, float]:
        """Place of the first sample, (x, y, z)."""
        x, y, z = self._facts["origin"]
        return x, y, z

    @property
    def direction(self) -> npt.NDArray[np.float64]:
        """3 x 3 numbers; column a is the direction of axis a (x, y, z), of length 1."""
        return np.array(self._facts["direction"], dtype=np.float64).reshape(3, 3)

    @property
    def affine(self) -> npt.NDArray[np.float64]:
        """4 x 4 numbers that take indices (i, j, k) along x, y, z to the world."""
        matrix = np.eye(4)
        matrix[:3, :3] = self.direction * np.array(self.spacing)
        matrix[:3, 3] = self.origin
        return matrix

    @property
    def space(self) -> str:
        """Meaning of the axes of the world: "lps", "ras" or "unknown"."""
        return str(self._facts["space"])

    @property
    def unit(self) -> str:
        """Unit of length: "mm", "um", "nm", "m", or "" where it is not said."""
        return str(self._facts["unit"])

    @property
    def notes(self) -> list[str]:
        """Things a user should know of the file, one line each."""
        return list(self._facts["notes"])

    def __repr__(self) -> str:
        shape = " x ".join(map(str, self.shape))
        return f"Volume({self._facts['path']}: {shape} (z, y, x), {self._stored}, spacing {self.spacing} {self.unit}".rstrip() + ")"

    def __len__(self) -> int:
        return self.shape[0]

    def __getitem__(self, key: int | slice) -> npt.NDArray[Any]:
        """Values of slices: ``volume[k]`` or ``volume[k0:k1]``, along z only.

        Raises:
            IndexError: for a slice that is not there, and for other indices than of z.
        """
        if isinstance(key, slice):
            first, end, step = key.indices(self.shape[0])
            if step < 1:
                raise IndexError(f"volume: expected steps of at least 1, found {step}")
            return self._read(first, max(first, end))[::step]
        try:
            k = operator.index(key)
        except TypeError:
            raise IndexError(f"volume: expected an index or a slice along z, found {key!r}") from None
        if not -self.shape[0] <= k < self.shape[0]:
            raise IndexError(f"volume: expected a slice below {self.shape[0]}, found {k}")
        k %= self.shape[0]
        result: npt.NDArray[Any] = self._read(k, k + 1)[0]
        return result

    def crop(self, roi: Roi) -> Volume:
        """A part of the volume, at its place in the whole: three slices or pairs (first, end) along z, y, x.

        >>> import numpy as np
        >>> isoweave.open_volume(np.zeros((20, 30, 40), np.uint8)).crop(np.s_[5:, :10, 2:-2]).shape
        (15, 10, 36)
        """
        first, end = [], []
        for part, size in zip(reversed(ranges_of(roi)), reversed(self.shape)):
            begin, stop, _ = part.indices(size)
            first.append(begin)
            end.append(stop)
        box = ctypes.c_int64 * 3
        handle, _ = c.made("iw_crop_volume", "iw_free_volume", self._handle.pointer, box(*first), box(*end))
        return Volume(handle, self._keep, self._reader)

    def downsample(self, step: int) -> Volume:
        """A smaller volume: means of blocks of step x step x step samples. For values, not for labels."""
        handle, _ = c.made("iw_downsample_volume", "iw_free_volume", self._handle.pointer, step)
        return Volume(handle, self._keep, self._reader)

    def histogram(self) -> tuple[npt.NDArray[np.uint64], npt.NDArray[np.float64]]:
        """Counts of the values in 256 equal parts of their range, and the 257 edges, as ``numpy.histogram`` has them.

        Reads the whole volume once. Infinities and NaN are left out.
        """
        facts = self._call("iw_histogram")
        low, high = (1.0, 0.0) if facts["min"] is None else (facts["min"], facts["max"])
        part = np.linspace(0, 1, 257)  # the width of the range may be larger than any float
        return np.array(facts["histogram"], dtype=np.uint64), low * (1 - part) + high * part

    def suggest_level(self) -> float:
        """Otsu's threshold, which parts bright from dark. Reads the whole volume once.

        Raises:
            ValueError: where there are no two different values.
        """
        level = self._call("iw_histogram")["suggested_iso"]
        if level is None:
            raise ValueError("level: expected at least two different values in the volume, found one or none")
        return float(level)

    def find_labels(self) -> dict[int, int]:
        """The labels of a label map but 0, and their numbers of samples. Reads the whole volume once."""
        return {entry["label"]: entry["samples"] for entry in self._call("iw_find_labels")}

    def _call(self, name: str) -> Any:
        state = RunState()
        return self._finish(lambda: state.call(name, self._handle.pointer, state.stop_pointer))

    def _finish(self, work: Any) -> Any:
        """Does the work of a run over this volume. What its source raised in this run comes out as it was."""
        self._errors.begin_run()
        try:
            return work()
        except c.Stopped as stopped:
            error = self._errors.behind(stopped)
            if error is not None:
                raise error from None
            raise
        finally:
            self._errors.end_run()
            if self._reader is not None:
                self._reader.close()

    def _scaled(self) -> bool:
        return bool(self._facts["slope"] != 1 or self._facts["intercept"] != 0)

    def _read(self, first: int, end: int) -> npt.NDArray[Any]:
        out = np.empty((end - first, *self.shape[1:]), self._stored)
        if out.size:
            self._finish(
                lambda: c.call("iw_read_slices", self._handle.pointer, first, end - first, out.ctypes.data, out.nbytes)
            )
        return out * self._facts["slope"] + self._facts["intercept"] if self._scaled() else out


class _SourceErrors:
    """What a source raised in runs that go on, by numbers that the C interface hands from the callback to its run.

    Runs over a volume may go on at the same time, and a run that a source has stopped may end with another error.
    """

    _lock = threading.Lock()
    _last = 0  # the last number of all sources: a run may have two of them

    def __init__(self) -> None:
        self._raised: dict[int, BaseException] = {}
        self._runs = 0

    def begin_run(self) -> None:
        with self._lock:
            self._runs += 1

    def end_run(self) -> None:
        """Forgets what no run can ask for."""
        with self._lock:
            self._runs -= 1
            if self._runs == 0:
                self._raised.clear()

    def keep(self, error: BaseException) -> int:
        with self._lock:
            _SourceErrors._last = number = _SourceErrors._last % 0x7FFFFFFF + 1
            self._raised[number] = error
        return number

    def behind(self, stopped: c.Stopped) -> BaseException | None:
        """What the source raised to stop this run, if it was the source."""
        said = re.search(r"stopped by its source \((\d+)\)$", str(stopped))
        with self._lock:
            return None if said is None else self._raised.pop(int(said[1]), None)


class _CallbackSource:
    """Slices for the C interface from an array that is not in memory as that wants it."""

    def __init__(self, slices: Slices) -> None:
        self.reader = SlabReader(slices)
        self.errors = _SourceErrors()
        shape, dtype = slices.shape[1:], slices.dtype

        def read(_context: int | None, first: int, count: int, out: int) -> int:
            try:
                size = count * shape[0] * shape[1] * dtype.itemsize
                room = memoryview((ctypes.c_char * size).from_address(out)).cast("B")
                self.reader.copy(first, np.frombuffer(room, dtype).reshape(count, *shape))
                return 0
            except BaseException as error:
                return self.errors.keep(error)

        self.struct = c.Source(read=c.ReadSlices(read), held_bytes=self.reader.held_bytes)


def _volume_of_slices(slices: Slices, name: str) -> Volume:
    geometry = slices.geometry
    nz, ny, nx = slices.shape
    if min(slices.shape) < 1:
        raise ValueError(f"volume: expected samples, found shape {slices.shape}")
    info = c.VolumeInfo(
        dims=(nx, ny, nz),
        type=TYPES.index(slices.dtype.name),
        space=_SPACES.index(geometry.space),
        spacing=geometry.spacing,
        origin=geometry.origin,
        direction=geometry.direction,
        slope=slices.slope,
        intercept=slices.intercept,
        unit=c.encoded(geometry.unit),
        path=c.encoded(name),
    )
    if slices.whole is not None:
        array = slices.whole
        handle, _ = c.made(
            "iw_volume_in_memory", "iw_free_volume", ctypes.byref(info), array.ctypes.data, array.nbytes
        )
        return Volume(handle, array)
    source = _CallbackSource(slices)
    handle, _ = c.made("iw_volume_from_source", "iw_free_volume", ctypes.byref(info), ctypes.byref(source.struct))
    return Volume(handle, source, source.reader)


def _set_geometry(
    geometry: Geometry, spacing: Triple | float | None, origin: Triple | None, direction: Any, affine: Any, unit: str | None
) -> Geometry:
    if affine is not None:
        if spacing is not None or origin is not None or direction is not None:
            raise ValueError("affine: expected no spacing, origin and direction beside it")
        geometry = geometry_of_affine(affine, geometry.space, geometry.unit)
    if spacing is not None:
        geometry.spacing = tuple(_doubles(spacing, 3, "spacing"))
        if not all(step > 0 for step in geometry.spacing):
            raise ValueError(f"spacing: expected numbers above 0, found {geometry.spacing}")
    if origin is not None:
        geometry.origin = tuple(_doubles(origin, 3, "origin"))
    if direction is not None:
        geometry.direction = tuple(_doubles(direction, 9, "direction"))
    if unit is not None:
        geometry.unit = unit
    return geometry


def open_volume(
    volume: VolumeLike,
    *,
    dataset: str | None = None,
    level: int | None = None,
    series: str | None = None,
    raw: str | None = None,
    channel: int | None = None,
    time: int | None = None,
    axes: str | None = None,
    scalars: str | None = None,
    spacing: Triple | float | None = None,
    origin: Triple | None = None,
    direction: npt.ArrayLike | None = None,
    affine: npt.ArrayLike | None = None,
    unit: str | None = None,
    external: bool = True,
) -> Volume:
    """Opens a volume file, or takes an array or image, without reading more than the header.

    Args:
        volume: a path of any format of isoweave; or an array: numpy (memmaps and any strides), dask, zarr, h5py,
            tensorstore, xarray; an image of SimpleITK, ITK, nibabel, PyVista or VTK; a tensor of torch, cupy or jax; or
            any object with ``shape``, ``dtype`` and slicing, or that is called as ``f(z0, z1)``.
        dataset: path or name of an array in the file or folder (HDF5, Zarr, N5, VTK, NPZ).
        level: of an image that the file has at several sizes; 0 is the full one.
        series: UID of a DICOM series.
        raw: layout of a headerless file, ``"512x512x300:int16[:big][:skip=N]"`` (x, y, z).
        channel, time: index along those axes, from 0; the first where they are not said.
        axes: order of an array's axes: "z", "y", "x" and perhaps "c" and "t" in any order; "zyx" if not said.
        scalars: name of the scalars of a PyVista or VTK image.
        spacing: distances of samples along x, y, z, or one for all; overrides what the container says.
        origin: place of the first sample (x, y, z).
        direction: 3 x 3 numbers, column a for axis a of x, y, z. Arrays and images only.
        affine: 4 x 4 numbers from indices (i, j, k) to the world, instead of those three. Arrays and images only.
        unit: "mm", "um", "nm" or "m". Arrays and images only.
        external: whether a header may name other files; False for files from strangers.

    Returns:
        A volume, which holds on to the array.

    Raises:
        BadInput: where the file cannot be found or understood.
        ValueError: for options out of range, and for arrays that are no volume.
        TypeError: for objects that are neither arrays nor images nor paths.

    >>> import numpy as np
    >>> isoweave.open_volume(np.zeros((3, 4, 5), np.int16), spacing=(0.5, 0.5, 2)).spacing
    (0.5, 0.5, 2.0)
    """
    if isinstance(volume, Volume):
        given = [dataset, level, series, raw, channel, time, axes, scalars, spacing, origin, direction, affine, unit]
        if any(value is not None for value in given):
            raise ValueError("volume: expected options where the volume is opened, found them beside an open one")
        return volume
    if isinstance(volume, (str, os.PathLike)):
        if any(value is not None for value in (axes, scalars, direction, affine, unit)):
            raise ValueError("axes, scalars, direction, affine and unit go with arrays and images, found a path")
        options = c.OpenOptions(
            raw=c.encoded(raw),
            spacing=None if spacing is None else _doubles(spacing, 3, "spacing"),
            origin=None if origin is None else _doubles(origin, 3, "origin"),
            dataset=c.encoded(dataset),
            series=c.encoded(series),
            level=_optional(level),
            channel=_optional(channel),
            time=_optional(time),
            no_external=0 if external else 1,
        )
        path = os.fsencode(volume)
        return Volume(c.made("iw_open_volume", "iw_free_volume", path, ctypes.byref(options))[0])
    if any(value is not None for value in (dataset, level, series, raw)):
        raise ValueError("dataset, level, series and raw go with paths, found an array")
    slices = slices_of(volume, axes=axes, channel=channel, time=time, scalars=scalars)
    slices.geometry = _set_geometry(slices.geometry, spacing, origin, direction, affine, unit)
    return _volume_of_slices(slices, f"{type(volume).__name__} array")


def volume_for(volume: VolumeLike, roi: Roi | None, step: int, **opening: Any) -> Volume:
    """The volume of a run: a part of it where that is asked for, or a smaller one."""
    opened = open_volume(volume, **opening)
    if roi is not None:
        opened = opened.crop(roi)
    return opened if step == 1 else opened.downsample(step)


def level_of(volume: Volume, level: Any) -> float:
    """The iso-value of a run: Otsu's threshold where none is named."""
    return volume.suggest_level() if level is None else float(level)
