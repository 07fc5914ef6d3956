#!/usr/bin/python3
"""Compares what isoweave reads of HDF5, Zarr 2, N5, NPY, NPZ and TIFF with what h5py, zarr, numcodecs, NumPy and
tifffile wrote.

tests/oracles/arrays.py DUMP_VOLUME    exit status 77 where the packages are not installed
"""

import itertools
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    import h5py
    import numcodecs
    import numpy as np
    import zarr
except ImportError as error:
    print("skipped:", error)
    sys.exit(77)

SHAPE = (11, 13, 17)  # z, y, x
try:
    import tifffile
except ImportError:
    tifffile = None

CHUNKS = [(1, 13, 17), (4, 5, 6), (11, 1, 17), (16, 32, 32)]
HALF = "f2"  # read as float32
TYPES = ["u1", "i1", "u2", "i2", "u4", "i4", "f4", "f8"]


def volume(dtype, shape=SHAPE):
    """Samples that differ, over most of what the type holds; repeated so that every codec has something to do."""
    values = np.arange(int(np.prod(shape)), dtype=np.int64) // 3 * 7919 + 1
    kind = np.dtype(dtype)
    if kind.kind == "f":
        return (values / 16 - 1000).astype(kind).reshape(shape)
    info = np.iinfo(kind)
    return (values % (int(info.max) - int(info.min)) + int(info.min)).astype(kind).reshape(shape)


def halves(order):
    """Halves of all kinds, those of the smallest exponent among them, and what they are as float32."""
    data = (np.arange(int(np.prod(SHAPE)), dtype=np.uint16) * 13 % 0x7C00).view(np.float16).reshape(SHAPE)
    data[::2] *= -1
    return data.astype(order + HALF), data.astype(np.float32)


class Comparison:
    def __init__(self, dump):
        self.dump, self.done, self.failed = dump, 0, 0

    def expect(self, what, path, expected, *options):
        """`expected`: samples [z, y, x]."""
        run = subprocess.run([self.dump, str(path), *options], capture_output=True)
        head, _, samples = run.stdout.partition(b"\n")
        dims = " ".join(str(size) for size in reversed(expected.shape))
        wanted = f"{dims} {expected.dtype.newbyteorder('=').name}".encode()
        same = head == wanted and samples == expected.astype(expected.dtype.newbyteorder("=")).tobytes()
        self.done += 1
        if not same:
            self.failed += 1
            print("FAILED:", what, head, "expected", wanted, run.stderr.decode().strip())


def compare_hdf5(comparison, folder):
    path = folder / "a.h5"
    filters = [{}, {"compression": "gzip"}, {"compression": "lzf"}, {"compression": "gzip", "shuffle": True},
               {"compression": "lzf", "shuffle": True, "fletcher32": True}, {"compression": "szip"},
               {"scaleoffset": 0}]
    for libver, order, dtype in itertools.product(["earliest", "latest"], "<>", TYPES):
        data = volume(order + dtype)
        with h5py.File(path, "w", libver=libver) as file:
            file.create_dataset("deep/contiguous", data=data)
        comparison.expect(f"hdf5 {libver} {order}{dtype}", path, data)
    for chunk, options in itertools.product(CHUNKS[:3], filters):
        data = volume("i2")
        with h5py.File(path, "w", libver="latest") as file:
            file.create_dataset("v", data=data, chunks=chunk, maxshape=(None, 13, 17), **options)
        comparison.expect(f"hdf5 {chunk} {options}", path, data)
    with h5py.File(path, "w") as file:
        dataset = file.create_dataset("v", data=volume("u1", (2, 3) + SHAPE), chunks=(1, 2, 4, 5, 6), compression="lzf")
        for axis, name in enumerate("tczyx"):
            dataset.dims[axis].label = name
        file.create_dataset("mask", data=volume("u1") > 100)
    with h5py.File(folder / "scales.h5", "w") as file:
        dataset = file.create_dataset("v", data=volume("i2").transpose(2, 1, 0))
        for axis, name in enumerate("xyz"):
            file[name] = np.arange(dataset.shape[axis]) * 0.5
            file[name].make_scale(name)
            dataset.dims[axis].attach_scale(file[name])
    comparison.expect("hdf5 scales", folder / "scales.h5", volume("i2"))
    data = volume("u1", (2, 3) + SHAPE)
    comparison.expect("hdf5 5-D", path, data[1, 2], "dataset=v", "time=1", "channel=2")
    comparison.expect("hdf5 bool", path, (volume("u1") > 100).astype("i1"), "dataset=/mask")


def compare_zarr2(comparison, folder):
    codecs = [None, numcodecs.GZip(5), numcodecs.Zlib(5), numcodecs.Zstd(3), numcodecs.LZ4()]
    codecs += [numcodecs.Blosc(cname, 5, shuffle) for cname, shuffle in
               itertools.product(["blosclz", "lz4", "lz4hc", "zlib", "zstd"], [0, 1, 2])]
    number = itertools.count()

    def put(data, **options):
        path = folder / f"{next(number)}.zarr"
        zarr.open(str(path), mode="w", shape=data.shape, dtype=data.dtype, **options)[...] = data
        return path

    for order, dtype in itertools.product("<>", TYPES):
        data = volume(order + dtype)
        comparison.expect(f"zarr {order}{dtype}", put(data, chunks=(4, 5, 6)), data)
    for codec, memory, separator in itertools.product(codecs, "CF", "./"):
        data = volume("i2")
        path = put(data, chunks=(4, 5, 6), compressor=codec, order=memory, dimension_separator=separator)
        comparison.expect(f"zarr {codec} {memory} {separator}", path, data)
    for chunk in CHUNKS:
        data = volume(">f4")
        comparison.expect(f"zarr {chunk}", put(data, chunks=chunk), data)
    data = volume("i2")
    data[:4, :5] = -3
    path = put(data, chunks=(4, 5, 6), fill_value=-3, write_empty_chunks=False)
    assert not (path / "0.0.0").exists()
    comparison.expect("zarr with missing chunks", path, data)
    data = volume("u1", (2,) + SHAPE)
    path = put(data, chunks=(2, 4, 5, 6))
    zarr.open(str(path)).attrs["_ARRAY_DIMENSIONS"] = ["channel", "z", "y", "x"]
    comparison.expect("zarr channel", path, data[1], "channel=1")


def compare_n5(comparison, folder):
    codecs = [None, numcodecs.GZip(5), numcodecs.Zlib(5)]
    codecs += [numcodecs.Blosc(cname, 5, shuffle) for cname, shuffle in itertools.product(["lz4", "zstd"], [0, 1, 2])]
    for n, (codec, dtype) in enumerate(itertools.product(codecs, TYPES)):
        data = volume(dtype)
        group = zarr.open_group(zarr.N5Store(str(folder / f"{n}.n5")), mode="w")
        group.create_dataset("raw", data=data, chunks=(4, 5, 6), compressor=codec)
        comparison.expect(f"n5 {codec} {dtype}", folder / f"{n}.n5", data)
    for n, chunk in enumerate(CHUNKS):
        data = volume("u2")
        group = zarr.open_group(zarr.N5Store(str(folder / f"chunks-{n}.n5")), mode="w")
        group.create_dataset("raw", data=data, chunks=chunk)
        comparison.expect(f"n5 {chunk}", folder / f"chunks-{n}.n5", data)


def compare_halves(comparison, folder):
    for order in "<>":
        data, expected = halves(order)
        np.save(folder / "a.npy", data)
        comparison.expect(f"npy {order}f2", folder / "a.npy", expected)
        np.save(folder / "a.npy", np.asfortranarray(data))
        comparison.expect(f"npy {order}f2 Fortran", folder / "a.npy", expected)
        for write in (np.savez, np.savez_compressed):
            write(folder / "a.npz", first=data, second=data[:, :5], third=data[0])
            comparison.expect(f"npz {order}f2", folder / "a.npz", expected, "dataset=first")
            comparison.expect(f"npz {order}f2", folder / "a.npz", expected[:, :5], "dataset=second")
        for chunk in (None, (4, 5, 6)):
            with h5py.File(folder / "a.h5", "w") as file:
                file.create_dataset("v", data=data, chunks=chunk, compression="gzip" if chunk else None)
            comparison.expect(f"hdf5 {order}f2", folder / "a.h5", expected)
        path = folder / f"{'big' if order == '>' else 'little'}.zarr"
        zarr.open(str(path), mode="w", shape=SHAPE, chunks=(4, 5, 6), dtype=data.dtype)[...] = data
        comparison.expect(f"zarr {order}f2", path, expected)
        path = folder / f"{'big' if order == '>' else 'little'}-fill.zarr"
        zarr.open(str(path), mode="w", shape=SHAPE, chunks=(4, 5, 6), dtype=data.dtype, fill_value=0.1)
        comparison.expect(f"zarr fill {order}f2", path, np.full(SHAPE, np.float16(0.1)).astype(np.float32))
        if tifffile is not None:
            for tile in (None, (16, 16)):
                tifffile.imwrite(folder / "a.tif", data, byteorder=order, tile=tile, photometric="minisblack")
                comparison.expect(f"tiff {order}f2 {tile}", folder / "a.tif", expected)


def main():
    comparison = Comparison(sys.argv[1])
    for compare in [compare_hdf5, compare_zarr2, compare_n5, compare_halves]:
        with tempfile.TemporaryDirectory() as folder:
            compare(comparison, Path(folder))
    print(f"{comparison.done} arrays compared, {comparison.failed} differ")
    sys.exit(1 if comparison.failed else 0)


if __name__ == "__main__":
    main()
