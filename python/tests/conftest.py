"""What the tests share: volumes, and the command line beside which everything is put."""

from __future__ import annotations

import json
import pathlib
import subprocess
import sys
from typing import Any, Callable

import numpy as np
import pytest

SPACING = (0.5, 0.75, 1.25)
ORIGIN = (3.0, -2.0, 10.0)


def blob(dtype: str = "float32") -> np.ndarray:
    """A dented ball and a small one, in an array whose sides differ: (z, y, x) = (30, 34, 38), about 0 to 200."""
    z, y, x = np.ogrid[0:30, 0:34, 0:38]
    ball = 11.3 - np.sqrt((x - 16.2) ** 2 + 1.1 * (y - 15.1) ** 2 + 0.9 * (z - 14.7) ** 2)
    ball = ball + 0.8 * np.sin(0.7 * x) * np.cos(0.5 * y + 0.3 * z)
    small = 3.1 - np.sqrt((x - 33) ** 2 + (y - 29) ** 2 + (z - 24) ** 2)
    return np.clip(100 + 9 * np.maximum(ball, small), 0, 250).astype(dtype)


@pytest.fixture(scope="session")
def volume() -> np.ndarray:
    return blob("uint8")


def run_cli(*arguments: Any) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "isoweave", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


@pytest.fixture(scope="session")
def cli_report(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., dict[str, Any]]:
    """The report of the command line on a volume, which lies in a raw file."""
    folder = tmp_path_factory.mktemp("cli")

    def report(array: np.ndarray, *options: Any, output: str = "cli.ply") -> dict[str, Any]:
        array = np.ascontiguousarray(array)
        raw = folder / "volume.raw"
        raw.write_bytes(array.tobytes())
        layout = "x".join(map(str, array.shape[::-1])) + f":{array.dtype.name}"
        done = run_cli(
            "mesh", raw, "--raw", layout, "-o", folder / output, "--report", folder / "report.json", "--quiet", *options
        )
        assert done.returncode == 0, done.stderr
        return json.loads((folder / "report.json").read_text())

    return report


@pytest.fixture(scope="session")
def wanted(volume: np.ndarray, cli_report: Callable[..., dict[str, Any]]) -> str:
    """The digest that the command line gives for the volume at its place, at 100, within 0.2 voxels."""
    placed = ["--spacing", ",".join(map(str, SPACING)), "--origin", ",".join(map(str, ORIGIN))]
    return str(cli_report(volume, "--iso", 100, *placed)["digest"])


@pytest.fixture
def folder(tmp_path: pathlib.Path) -> pathlib.Path:
    return tmp_path
