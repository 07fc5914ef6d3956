"""Runs that are stopped, killed or fail in the middle, and go on."""

from __future__ import annotations

import os
import pathlib
import signal
import subprocess
import sys
from typing import Any

import numpy as np
import pytest
from test_manners import Slow

import isoweave

# A shell that starts the tests in the background has Ctrl-C ignored, which processes inherit.
SCRIPT = """
import signal
import isoweave
from test_manners import Slow

signal.signal(signal.SIGINT, signal.default_int_handler)

def progress(now):
    print(now.layer, flush=True)

isoweave.mesh(Slow(0.008), 0, out="m.ply", checkpoint="run", resume=True, every="16layers", threads=2, progress=progress)
"""


@pytest.fixture(scope="module")
def undisturbed() -> str:
    return isoweave.mesh(Slow(), 0).digest


def end_by(number: int, folder: pathlib.Path) -> int:
    """Sends the signal to a run in the folder when half of its layers are done. Returns how the process ended."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(pathlib.Path(__file__).parent), *sys.path])}
    with subprocess.Popen(
        [sys.executable, "-c", SCRIPT], cwd=folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    ) as run:
        assert run.stdout is not None
        sent = False
        for line in run.stdout:
            if not sent and int(line) > 200:
                run.send_signal(number)
                sent = True
    return run.returncode


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGINT])
def test_runs_that_end_by_a_signal_go_on(number: signal.Signals, undisturbed: str, folder: pathlib.Path) -> None:
    assert end_by(number, folder) == -number
    assert not (folder / "m.ply").exists()
    with pytest.raises(isoweave.CannotWrite, match="resume"):
        isoweave.mesh(Slow(), 0, out=folder / "m.ply", checkpoint=folder / "run")
    report = isoweave.mesh(Slow(), 0, out=folder / "m.ply", checkpoint=folder / "run", resume=True, threads=1)
    assert report.resumed_at > 150
    assert isoweave.check(folder / "m.ply").digest == report.digest == undisturbed
    assert list((folder / "run").iterdir()) == []


def test_runs_whose_source_fails_go_on(undisturbed: str, folder: pathlib.Path) -> None:
    saved: dict[str, Any] = {"out": folder / "m.ply", "checkpoint": folder / "run", "every": "1layers"}
    with pytest.raises(ZeroDivisionError):
        isoweave.mesh(Slow(fail_at=300), 0, **saved)
    with pytest.raises(isoweave.BadInput, match="changed"):
        isoweave.mesh(Slow(), 0.5, resume=True, **saved)
    assert 0 < isoweave.mesh(Slow(), 0, resume=True, **saved).resumed_at <= 300
    assert isoweave.check(folder / "m.ply").digest == undisturbed


def test_resume_begins_where_there_is_nothing(volume: np.ndarray, folder: pathlib.Path) -> None:
    lods = ["0.1vox", "0.5vox"]
    reports = isoweave.mesh(volume, 100, lods=lods, out=folder / "m.glb", checkpoint=folder / "run", resume=True, every=1e9)
    assert [report.resumed_at for report in reports] == [0, 0]
    assert [report.digest for report in reports] == [mesh.digest for mesh in isoweave.mesh(volume, 100, lods=lods)]
    assert "resumed_at" not in isoweave.mesh(volume, 100).report


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"checkpoint": "run"}, "files"),
        ({"resume": True, "out": "m.ply"}, "checkpoint"),
        ({"checkpoint": "run", "out": "m.ply", "level": [60, 100]}, "several iso-values"),
        *(({"checkpoint": "run", "out": "m.ply", "every": every}, "every") for every in (0, "5", "5mins", "1.5layers", "-1h", "")),
    ],
)
def test_refusals(volume: np.ndarray, folder: pathlib.Path, monkeypatch: pytest.MonkeyPatch, options: Any, message: str) -> None:
    monkeypatch.chdir(folder)
    with pytest.raises(ValueError, match=message):
        isoweave.mesh(volume, **{"level": 100, **options})
    assert not (folder / "m.ply").exists()
