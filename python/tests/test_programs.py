"""Programs with a Python inside, where they are installed."""

from __future__ import annotations

import os
import pathlib
import shutil
import subprocess

import numpy as np
import pytest
from conftest import ORIGIN, SPACING

import isoweave


@pytest.mark.skipif(shutil.which("pvpython") is None, reason="needs ParaView")
@pytest.mark.parametrize("extractor", ["cubes", "dual"])
def test_paraview(volume: np.ndarray, extractor: str, wanted: str, folder: pathlib.Path) -> None:
    pyvista = pytest.importorskip("pyvista")
    grid = pyvista.ImageData(dimensions=volume.shape[::-1], spacing=SPACING, origin=ORIGIN)
    grid.point_data["ct"] = volume.ravel()
    grid.save(str(folder / "v.vti"))
    package = pathlib.Path(isoweave.__file__).parent
    script = pathlib.Path(__file__).with_name("paraview_contour.py")
    # ParaView has numpy and VTK of its own.
    environment = {**os.environ, "PYTHONPATH": str(folder), "QT_QPA_PLATFORM": "offscreen"}
    for name in ("isoweave", "isoweave.libs"):
        if (package.parent / name).exists():
            (folder / name).symlink_to(package.parent / name)
    done = subprocess.run(
        ["pvpython", script, package / "paraview_plugin.py", folder / "v.vti", "100", extractor, folder / "surface.vtp"],
        capture_output=True, text=True, env=environment, timeout=120, check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    if extractor != "cubes":
        wanted = isoweave.mesh(volume, 100, extractor=extractor, spacing=SPACING, origin=ORIGIN).digest
    assert isoweave.check(folder / "surface.vtp").digest == wanted, done.stdout + done.stderr
