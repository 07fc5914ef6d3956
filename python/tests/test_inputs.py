"""Every kind of array gives the mesh of the command line."""

from __future__ import annotations

import pathlib
import threading
import time
import weakref
from typing import Any

import numpy as np
import pytest
from conftest import ORIGIN, SPACING

import isoweave
from isoweave import _slices

PLACE: dict[str, Any] = {"spacing": SPACING, "origin": ORIGIN}


def digest(volume: Any, **options: Any) -> str:
    return isoweave.mesh(volume, 100, **{**PLACE, **options}).digest


def test_numpy_is_meshed_in_place(volume: np.ndarray, wanted: str) -> None:
    assert digest(volume) == wanted
    assert np.shares_memory(isoweave.open_volume(volume)._keep, volume)
    fortran = np.asfortranarray(volume.T)
    assert np.shares_memory(isoweave.open_volume(fortran, axes="xyz")._keep, fortran)
    assert digest(fortran, axes="xyz") == wanted


@pytest.mark.parametrize(
    "change",
    [
        lambda v: np.asfortranarray(v),
        lambda v: np.repeat(np.repeat(np.repeat(v, 2, 0), 3, 1), 2, 2)[::2, ::3, ::2],
        lambda v: v[::-1, ::-1, ::-1].copy()[::-1, ::-1, ::-1],
        lambda v: v.astype(">i2"),
        lambda v: v.astype("<u4"),
        lambda v: v.astype(np.int64),
        lambda v: v.astype(np.uint64),
        lambda v: v.astype(np.float16),
        lambda v: v.astype(np.float64),
        lambda v: np.frombuffer(b"x" + v.astype("<f4").tobytes(), "<f4", offset=1).reshape(v.shape),
        lambda v: v.tolist(),
    ],
    ids=["fortran", "strided", "backwards", "big", "uint32", "int64", "uint64", "float16", "float64", "unaligned", "list"],
)
def test_layouts_and_types_do_not_change_the_mesh(volume: np.ndarray, wanted: str, change: Any) -> None:
    assert digest(change(volume)) == wanted


def test_masks_are_volumes(volume: np.ndarray) -> None:
    mask = volume >= 100
    assert isoweave.mesh(mask, 0.5).digest == isoweave.mesh(mask.astype(np.uint8), 0.5).digest


def test_axes_channels_and_times(volume: np.ndarray, wanted: str) -> None:
    stack = np.zeros((2, *volume.shape, 3), np.uint8)
    stack[1, ..., 2] = volume
    assert digest(stack, axes="tzyxc", time=1, channel=2) == wanted
    assert digest(np.moveaxis(stack, 1, 3), axes="tyxzc", time=1, channel=-1) == wanted
    with pytest.raises(ValueError, match="channel"):
        isoweave.mesh(stack, 100, axes="tzyxc", channel=3)
    with pytest.raises(ValueError, match="axes"):
        isoweave.mesh(stack, 100)
    with pytest.raises(ValueError, match="axes"):
        isoweave.mesh(volume, 100, axes="zyy")


def test_memmap(volume: np.ndarray, wanted: str, folder: pathlib.Path) -> None:
    np.save(folder / "v.npy", volume)
    assert digest(np.load(folder / "v.npy", mmap_mode="r")) == wanted
    assert digest(folder / "v.npy") == wanted


class Counting:
    """An array that tells how it is read."""

    def __init__(self, array: np.ndarray, chunk: int = 0) -> None:
        self.array, self.shape, self.dtype = array, array.shape, array.dtype
        self.reads: list[tuple[int, int]] = []
        if chunk:
            self.chunks = (chunk, *array.shape[1:])

    def __getitem__(self, key: Any) -> np.ndarray:
        first, end, _ = key[0].indices(self.shape[0])
        self.reads.append((first, end))
        return self.array[key]


class Tracked(Counting):
    """An array that tells how many of the rows it gave are still held, and fails from a slice on."""

    def __init__(self, array: np.ndarray, chunk: int, fail_at: int = 1 << 30) -> None:
        super().__init__(array, chunk)
        self.fail_at, self.held, self.most_held = fail_at, 0, 0
        self.lock = threading.RLock()

    def __getitem__(self, key: Any) -> np.ndarray:
        row = super().__getitem__(key).copy()
        if key[0].stop > self.fail_at:
            raise ZeroDivisionError("row of zeros")
        with self.lock:
            self.held += 1
            self.most_held = max(self.most_held, self.held)
        weakref.finalize(row, self.given_up)
        return row

    def given_up(self) -> None:
        with self.lock:
            self.held -= 1

    def reader(self) -> _slices.SlabReader:
        return _slices.SlabReader(_slices.slices_of(self, axes=None, channel=None, time=None, scalars=None))


def no_threads_are_left() -> bool:
    return not [thread for thread in threading.enumerate() if thread.name.startswith("isoweave")]


def test_two_rows_are_read_ahead(volume: np.ndarray) -> None:
    tracked = Tracked(volume, chunk=4)
    reader = tracked.reader()
    reader.copy(0, np.empty((1, *volume.shape[1:]), np.uint8))
    until = time.monotonic() + 60
    while len(tracked.reads) < 3 and time.monotonic() < until:
        time.sleep(0.01)
    time.sleep(0.1)  # for a fourth one, which would be wrong
    assert tracked.reads == [(0, 4), (4, 8), (8, 12)]
    assert tracked.held == 3 and reader.held_bytes == 3 * 4 * volume[0].nbytes
    reader.close()
    assert tracked.held == 0 and no_threads_are_left()


@pytest.mark.parametrize("chunk", [1, 4, 11, 30])
def test_three_rows_are_held_at_most(volume: np.ndarray, wanted: str, chunk: int) -> None:
    tracked = Tracked(volume, chunk)
    assert digest(tracked) == wanted
    assert tracked.reads == [(first, min(first + chunk, 30)) for first in range(0, 30, chunk)]
    assert tracked.most_held <= 3 and tracked.held == 0 and no_threads_are_left()


def test_rows_that_fail_ahead_fail_where_they_are_needed(volume: np.ndarray, folder: pathlib.Path) -> None:
    tracked = Tracked(volume, chunk=4, fail_at=8)
    reader = tracked.reader()
    slices = np.empty((8, *volume.shape[1:]), np.uint8)
    reader.copy(0, slices)
    assert np.array_equal(slices, volume[:8])
    with pytest.raises(ZeroDivisionError, match="row of zeros") as raised:
        reader.copy(8, slices)
    assert any(entry.name == "__getitem__" for entry in raised.traceback)
    reader.close()
    with pytest.raises(ZeroDivisionError, match="row of zeros"):
        isoweave.mesh(Tracked(volume, chunk=4, fail_at=16), 100, out=folder / "m.ply")
    assert list(folder.iterdir()) == [] and no_threads_are_left()
    part = isoweave.mesh(Tracked(volume, chunk=4, fail_at=16), 100, roi=np.s_[:16, :, :])
    assert part.digest == isoweave.mesh(volume, 100, roi=np.s_[:16, :, :]).digest


def test_rows_count_in_memory_caps() -> None:
    slices = np.broadcast_to(np.zeros((1, 2000, 2000), np.uint8), (600, 2000, 2000))
    lazy = Counting(slices, chunk=100)
    with pytest.raises(isoweave.OverMemory, match="expected --memory"):
        isoweave.mesh(lazy, 1, memory="1200M")  # three rows are 1.2 GB
    assert lazy.reads == []


def test_chunks_are_read_once_and_in_order(volume: np.ndarray, wanted: str) -> None:
    counting = Counting(volume, chunk=7)
    assert digest(counting) == wanted
    assert counting.reads == [(0, 7), (7, 14), (14, 21), (21, 28), (28, 30)]
    assert no_threads_are_left()


def test_arrays_without_chunks_are_read_in_bounded_parts(
    volume: np.ndarray, wanted: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(_slices, "_ROW_BYTES", 4 * volume[0].nbytes)
    counting = Counting(volume)
    assert digest(counting) == wanted
    assert max(end - first for first, end in counting.reads) == 4


def test_callable(volume: np.ndarray, wanted: str) -> None:
    class Function:
        shape, dtype = volume.shape, volume.dtype

        def __call__(self, first: int, end: int) -> np.ndarray:
            return volume[first:end]

    assert digest(Function()) == wanted


def test_dask(volume: np.ndarray, wanted: str) -> None:
    dask_array = pytest.importorskip("dask.array")
    lazy = dask_array.from_array(volume, chunks=(8, 10, 38))
    assert digest(lazy) == wanted
    assert digest((lazy.astype("float32") * 2) / 2) == wanted
    blocks: list[int] = []

    def seen(block: np.ndarray) -> np.ndarray:
        blocks.append(block.shape[0])
        return block

    digest(lazy.map_blocks(seen, dtype=volume.dtype, meta=np.empty((0, 0, 0), np.uint8)))
    assert sum(blocks) == 4 * volume.shape[0]  # every one of four columns of blocks once


@pytest.mark.parametrize("options", [{"zarr_format": 2}, {"zarr_format": 3}, {"shards": (16, 16, 32)}])
def test_zarr(volume: np.ndarray, wanted: str, folder: pathlib.Path, options: dict[str, Any]) -> None:
    zarr = pytest.importorskip("zarr", minversion="3")
    array = zarr.create_array(str(folder / "v.zarr"), shape=volume.shape, chunks=(8, 16, 16), dtype="u1", **options)
    array[:] = volume
    assert digest(array) == wanted
    assert digest(folder / "v.zarr") == wanted


def test_tensorstore(volume: np.ndarray, wanted: str, folder: pathlib.Path) -> None:
    tensorstore = pytest.importorskip("tensorstore")
    spec = {"driver": "zarr", "kvstore": {"driver": "file", "path": str(folder / "t.zarr")}}
    layout = tensorstore.ChunkLayout(chunk_shape=(8, 16, 16))
    array = tensorstore.open(
        spec, create=True, dtype=tensorstore.uint8, shape=volume.shape, chunk_layout=layout
    ).result()
    array[...] = volume
    assert _slices.slices_of(array, axes=None, channel=None, time=None, scalars=None).chunk == 8
    assert digest(array) == wanted
    assert digest(array.T, axes="xyz") == wanted
    assert digest(tensorstore.array(volume)) == wanted  # without chunks


def test_h5py(volume: np.ndarray, wanted: str, folder: pathlib.Path) -> None:
    h5py = pytest.importorskip("h5py")
    with h5py.File(folder / "v.h5", "w") as file:
        file.create_dataset("ct", data=volume, chunks=(4, 34, 38), compression="gzip")
        assert digest(file["ct"]) == wanted
        file.create_dataset("whole", data=volume)
        assert digest(file["whole"]) == wanted


def test_xarray(volume: np.ndarray, wanted: str) -> None:
    xarray = pytest.importorskip("xarray")
    coords = {
        axis: (axis, origin + spacing * np.arange(size), {"units": "mm"})
        for axis, origin, spacing, size in zip("xyz", ORIGIN, SPACING, volume.shape[::-1])
    }
    array = xarray.DataArray(volume, dims=("z", "y", "x"), coords=coords)
    mesh = isoweave.mesh(array, 100)
    assert (mesh.digest, mesh.unit) == (wanted, "mm")
    assert isoweave.mesh(array.transpose("x", "z", "y"), 100).digest == wanted
    if pytest.importorskip("dask"):
        assert isoweave.mesh(array.chunk({"z": 5}), 100).digest == wanted
    uneven = array.assign_coords(z=np.arange(volume.shape[0]) ** 1.5)
    with pytest.raises(ValueError, match="'z'"):
        isoweave.mesh(uneven, 100)


def rotated() -> np.ndarray:
    """A rotation about z, and a flip."""
    return np.array([[0.6, -0.8, 0.0], [0.8, 0.6, 0.0], [0.0, 0.0, -1.0]])


def test_simpleitk_and_its_file(volume: np.ndarray, wanted: str, folder: pathlib.Path) -> None:
    sitk = pytest.importorskip("SimpleITK")
    image = sitk.GetImageFromArray(volume)
    image.SetSpacing(SPACING)
    image.SetOrigin(ORIGIN)
    assert isoweave.mesh(image, 100).digest == wanted
    image.SetDirection(rotated().ravel().tolist())
    sitk.WriteImage(image, str(folder / "v.nrrd"))
    mesh = isoweave.mesh(image, 100)
    assert mesh.digest == isoweave.mesh(folder / "v.nrrd", 100).digest != wanted
    assert mesh.space == "LPS"


def test_itk(volume: np.ndarray) -> None:
    itk = pytest.importorskip("itk")
    image = itk.image_view_from_array(volume)
    image.SetSpacing(SPACING)
    image.SetOrigin(ORIGIN)
    image.SetDirection(itk.matrix_from_array(rotated()))
    mesh = isoweave.mesh(image, 100)
    assert mesh.digest == isoweave.mesh(volume, 100, **PLACE, direction=rotated(), space="lps").digest
    assert mesh.space == "LPS"


def test_nibabel_and_its_file(volume: np.ndarray, folder: pathlib.Path) -> None:
    nibabel = pytest.importorskip("nibabel")
    affine = np.eye(4)
    affine[:3, :3] = rotated() * SPACING
    affine[:3, 3] = ORIGIN
    affine = affine.astype(np.float32).astype(float)  # as in the file
    image = nibabel.Nifti1Image(np.asfortranarray(volume.T), affine)
    image.header.set_xyzt_units("mm")
    for name in ("v.nii", "v.nii.gz"):
        nibabel.save(image, folder / name)
        loaded = nibabel.load(folder / name)
        mesh = isoweave.mesh(loaded, 100)
        assert mesh.digest == isoweave.mesh(folder / name, 100).digest == isoweave.mesh(image, 100).digest
        assert (mesh.space, mesh.unit) == ("RAS", "mm")
    scaled = nibabel.Nifti1Image(volume.T.astype(np.int16), affine)
    scaled.header.set_slope_inter(0.37, -11.5)
    nibabel.save(scaled, folder / "scaled.nii")
    by_file = isoweave.mesh(folder / "scaled.nii", 25.5)
    assert isoweave.mesh(nibabel.load(folder / "scaled.nii"), 25.5).digest == by_file.digest
    assert by_file.digest != isoweave.mesh(folder / "v.nii", 100).digest


def test_pyvista_extents_and_directions(volume: np.ndarray, wanted: str, folder: pathlib.Path) -> None:
    pyvista = pytest.importorskip("pyvista")
    nz, ny, nx = volume.shape
    grid = pyvista.ImageData(dimensions=(nx, ny, nz), spacing=SPACING, origin=ORIGIN)
    grid.point_data["ct"] = volume.ravel()
    assert isoweave.mesh(grid, 100).digest == wanted
    grid.point_data["other"] = np.zeros(volume.size)
    assert isoweave.mesh(grid, 100, scalars="ct").digest == wanted
    shifted = pyvista.ImageData()
    shifted.SetExtent(2, nx + 1, -3, ny - 4, 5, nz + 4)
    shifted.spacing = SPACING
    shifted.origin = np.array(ORIGIN) - np.array(SPACING) * (2, -3, 5)
    shifted.point_data["ct"] = volume.ravel()
    assert isoweave.mesh(shifted, 100).digest == wanted
    shifted.SetDirectionMatrix(rotated().ravel())
    shifted.save(str(folder / "v.vti"))
    assert isoweave.mesh(shifted, 100).digest == isoweave.mesh(folder / "v.vti", 100).digest
    cells = pyvista.ImageData(
        dimensions=(nx + 1, ny + 1, nz + 1), spacing=SPACING, origin=np.array(ORIGIN) - 0.5 * np.array(SPACING)
    )
    cells.cell_data["ct"] = volume.ravel()
    assert isoweave.mesh(cells, 100).digest == wanted
    assert isoweave.mesh(cells, 100).vertices.mean() == pytest.approx(isoweave.mesh(grid, 100, scalars="ct").vertices.mean())


def test_dlpack(volume: np.ndarray, wanted: str) -> None:
    class Tensor:
        shape, dtype = volume.shape, volume.dtype

        def __dlpack__(self, **options: Any) -> Any:
            return volume.__dlpack__(**options)

        def __dlpack_device__(self) -> Any:
            return volume.__dlpack_device__()

        def __getitem__(self, key: Any) -> Any:
            raise AssertionError("expected the memory itself to be taken, found slices")

    assert digest(Tensor()) == wanted

    class Narrow(Tensor):
        dtype = "bfloat16"  # type: ignore[assignment]

    with pytest.raises(ValueError, match="found bfloat16"):
        digest(Narrow())


def test_what_is_no_volume(volume: np.ndarray) -> None:
    for wrong in (object(), {"a": 1}, "no such file.nrrd", np.zeros((3, 3)), volume.astype(complex), np.zeros((0, 3, 3))):
        with pytest.raises((TypeError, ValueError)) as raised:
            isoweave.mesh(wrong, 100)
        assert "\n" not in str(raised.value)
    with pytest.raises(isoweave.BadInput, match="no such file"):
        isoweave.mesh("no such file.nrrd", 100)
    with pytest.raises(ValueError, match="affine"):
        isoweave.open_volume(volume, affine=np.eye(4), spacing=1)
    with pytest.raises(ValueError, match="path"):
        isoweave.open_volume("v.nrrd", unit="mm")


def test_affine_is_the_volumes(volume: np.ndarray) -> None:
    affine = np.eye(4)
    affine[:3, :3] = rotated() * SPACING
    affine[:3, 3] = ORIGIN
    opened = isoweave.open_volume(volume, affine=affine, unit="um")
    np.testing.assert_allclose(opened.affine, affine, atol=1e-12)
    turned = isoweave.mesh(opened, 100, error=0)
    plain = isoweave.mesh(volume, 100, error=0)
    expected = plain.vertices @ affine[:3, :3].T + affine[:3, 3]
    assert np.abs(np.sort(turned.vertices[:, 2]) - np.sort(expected[:, 2])).max() < 1e-4
    assert turned.unit == "um"
