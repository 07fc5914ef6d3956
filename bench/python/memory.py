"""Peak memory of a mesh of a large zarr array, by the package and by the command line.

    python bench/python/memory.py [GIGABYTES]

Writes an array of 16-bit samples, 1024 x 1024 along x and y, into the current folder, meshes it to a file by both in
processes of their own, and prints the peaks that the system counted for them, and the digests.
"""

import multiprocessing
import os
import pathlib
import shutil
import subprocess
import sys

PACKAGE = """
import sys, zarr, isoweave
array = zarr.open(sys.argv[1], mode="r")
print(isoweave.mesh(array, 1000, out=sys.argv[2]).digest)
"""
IMPORTS = "import zarr, isoweave, numpy; print('no run')"


def write(path: pathlib.Path, slices: int) -> None:
    import numpy as np
    import zarr

    array = zarr.create_array(str(path), shape=(slices, 1024, 1024), chunks=(16, 256, 256), dtype="u2")
    x, y = np.arange(1024)[None, None, :] * (np.pi / 64), np.arange(1024)[None, :, None] * (np.pi / 64)
    for first in range(0, slices, 16):
        z = np.arange(first, min(first + 16, slices))[:, None, None] * (np.pi / 64)
        gyroid = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
        array[first : first + 16] = (1000 + 300 * gyroid).astype("u2")


def measure(name: str, *command: str) -> None:
    """Runs a command, and prints the peak of its process."""
    child = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    said = child.stdout.read().strip().splitlines()[-1]
    _, status, usage = os.wait4(child.pid, 0)
    if status != 0:
        sys.exit(f"{name}: {said}")
    print(f"{name:<24}{usage.ru_maxrss * 1024 / 1e6:8.0f} MB   {said}", flush=True)


def main() -> None:
    slices = int(float(sys.argv[1]) * 512) if len(sys.argv) > 1 else 2048
    path = pathlib.Path("memory.zarr")
    shutil.rmtree(path, ignore_errors=True)
    # In a process of its own: what the system counts as the peak of a process begins with that of the one that starts it.
    writer = multiprocessing.get_context("spawn").Process(target=write, args=(path, slices))
    writer.start()
    writer.join()
    measure("imports alone", sys.executable, "-c", IMPORTS)
    measure("isoweave mesh", sys.executable, "-m", "isoweave", "mesh", str(path), "--iso", "1000", "-o", "cli.ply")
    measure("isoweave.mesh(zarr)", sys.executable, "-c", PACKAGE, str(path), "package.ply")


if __name__ == "__main__":
    main()
