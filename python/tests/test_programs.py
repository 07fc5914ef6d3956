"""Programs with a Python inside, where they are installed."""

from __future__ import annotations

import contextlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
from typing import Iterator

import numpy as np
import pytest
from conftest import ORIGIN, SPACING

import isoweave


PVPYTHON = shutil.which("pvpython")


@pytest.mark.skipif(PVPYTHON is None, reason="needs ParaView")
@pytest.mark.parametrize("extractor", ["cubes", "dual"])
def test_paraview(volume: np.ndarray, extractor: str, wanted: str, folder: pathlib.Path) -> None:
    pyvista = pytest.importorskip("pyvista")
    grid = pyvista.ImageData(dimensions=volume.shape[::-1], spacing=SPACING, origin=ORIGIN)
    grid.point_data["ct"] = volume.ravel()
    grid.save(str(folder / "v.vti"))
    package = pathlib.Path(isoweave.__file__).parent
    script = pathlib.Path(__file__).with_name("paraview_contour.py")
    # ParaView has numpy and VTK of its own, the latter beside its Python.
    modules = pathlib.Path(str(PVPYTHON)).parent.parent / "lib/python3/dist-packages"
    environment = {**os.environ, "PYTHONPATH": f"{modules}:{folder}", "QT_QPA_PLATFORM": "offscreen"}
    for name in ("isoweave", "isoweave.libs"):
        if (package.parent / name).exists():
            (folder / name).symlink_to(package.parent / name)
    done = subprocess.run(
        [str(PVPYTHON), script, package / "paraview_plugin.py", folder / "v.vti", "100", extractor, folder / "surface.vtp"],
        capture_output=True, text=True, env=environment, timeout=120, check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    if extractor != "cubes":
        wanted = isoweave.mesh(volume, 100, extractor=extractor, spacing=SPACING, origin=ORIGIN).digest
    assert isoweave.check(folder / "surface.vtp").digest == wanted, done.stdout + done.stderr


@contextlib.contextmanager
def display() -> Iterator[str]:
    """A display that nobody sees. napari draws with OpenGL, which Qt has not without one."""
    read, write = os.pipe()
    with subprocess.Popen(
        ["Xvfb", "-displayfd", str(write), "-screen", "0", "640x480x24", "-nolisten", "tcp"],
        pass_fds=[write], stderr=subprocess.DEVNULL,
    ) as server:
        os.close(write)
        with os.fdopen(read) as numbers:
            number = numbers.readline().strip()
        try:
            yield f":{number}"
        finally:
            server.terminate()


@pytest.mark.skipif(shutil.which("Xvfb") is None, reason="needs Xvfb")
def test_napari(volume: np.ndarray, folder: pathlib.Path) -> None:
    pytest.importorskip("napari")
    cells = np.zeros((20, 22, 24), np.uint8)
    cells[3:9, 4:18, 5:20], cells[11:17, 4:18, 5:20] = 3, 9
    np.save(folder / "v.npy", volume)
    np.save(folder / "cells.npy", cells)
    script = pathlib.Path(__file__).with_name("napari_surface.py")
    # Without plugins and settings of the user.
    environment = {**os.environ, "QT_QPA_PLATFORM": "offscreen", "NAPARI_CONFIG": "", "HOME": str(folder)}
    with display() as name:
        done = subprocess.run(
            [sys.executable, script, folder / "v.npy", folder / "cells.npy"],
            capture_output=True, text=True, env={**environment, "DISPLAY": name}, timeout=120, check=False,
        )
    assert done.returncode == 0, done.stdout + done.stderr
    found = json.loads(done.stdout.split("FOUND ")[1])
    assert found["slider"] == [0, 255, 127.5]  # those of uint8
    full = isoweave.mesh(volume, 100, error=0, spacing=SPACING)
    assert found["full"] == {"name": "ct at 100", "digest": full.digest, "unit": "micrometer"}
    assert found["farthest"] < 0.1  # a voxel is 10
    dual = isoweave.mesh(volume, 100, error="0.3um", extractor="dual", spacing=SPACING, unit="um")
    assert found["dual"] == dual.digest
    assert found["stopped"] == 0
    assert found["time"] == {"digest": isoweave.mesh(volume, 100, error=0.3, extractor="dual").digest, "place": [7, 0, 0]}
    assert found["labels"]["components"] == found["labels"]["colors"] == 2 and found["labels"]["name"] == "cells surfaces"
    assert found["labels"]["low"] == pytest.approx([2 * 2.5, 3.5, 4.5], abs=0.6)
    assert found["labels"]["high"] == pytest.approx([2 * 16.5, 17.5, 19.5], abs=0.6)
