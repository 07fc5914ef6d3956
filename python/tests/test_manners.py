"""How runs behave: stopped, in threads, with exceptions, after a fork."""

from __future__ import annotations

import os
import pathlib
import signal
import subprocess
import sys
import threading
import time
from typing import Any

import numpy as np
import pytest
from conftest import run_cli

import isoweave


class Slow:
    """A volume that takes its time, and may fail at a slice."""

    shape = (400, 24, 24)
    dtype = np.dtype(np.float32)

    def __init__(self, seconds: float = 0.0, fail_at: int = -1) -> None:
        self.seconds, self.fail_at, self.read = seconds, fail_at, 0

    def __call__(self, first: int, end: int) -> np.ndarray:
        time.sleep(self.seconds)
        self.read = end
        if self.fail_at in range(first, end):
            raise ZeroDivisionError("slice of zeros")
        z, y, x = np.mgrid[first:end, 0:24, 0:24]
        return (9 - np.hypot(x - 12, y - 12) + np.sin(z / 5)).astype(np.float32)


def test_exceptions_of_sources_come_out_as_they_were(folder: pathlib.Path) -> None:
    with pytest.raises(ZeroDivisionError, match="slice of zeros") as raised:
        isoweave.mesh(Slow(fail_at=200), 0, out=folder / "m.ply")
    assert any(entry.name == "__call__" for entry in raised.traceback)
    assert list(folder.iterdir()) == []


def test_exceptions_of_progress_and_sinks_come_out_as_they_were(folder: pathlib.Path) -> None:
    class Mine(Exception):
        pass

    def progress(now: isoweave.Progress) -> None:
        raise Mine(now.layers)

    with pytest.raises(Mine):
        isoweave.mesh(Slow(), 0, progress=progress, out=folder / "m.ply")

    class Sink:
        def vertices(self, xyz: np.ndarray) -> None:
            raise Mine("sink")

        faces = finish = vertices

    with pytest.raises(Mine, match="sink"):
        isoweave.mesh(Slow(), 0, out=Sink())
    assert list(folder.iterdir()) == []


class FailsOnce(Slow):
    """A volume whose read of a slice fails once, and says so."""

    def __init__(self, fail_at: int) -> None:
        super().__init__(fail_at=fail_at)
        self.failed = threading.Event()

    def __call__(self, first: int, end: int) -> np.ndarray:
        try:
            return super().__call__(first, end)
        except ZeroDivisionError:
            self.fail_at = -1
            self.failed.set()
            raise


def stop_by_sink_after_source(volume: isoweave.Volume, source: FailsOnce) -> None:
    """A run that its sink ends once the source has failed in a slice that is read ahead."""

    class Mine(Exception):
        pass

    class Sink:
        def vertices(self, xyz: np.ndarray) -> None:
            assert source.failed.wait(30)
            raise Mine

        faces = finish = vertices

    with pytest.raises(Mine):
        isoweave.mesh(volume, 0, error=0, out=Sink())


def test_an_exception_of_a_source_stays_with_its_run() -> None:
    source = FailsOnce(fail_at=14)
    volume = isoweave.open_volume(source)
    stop_by_sink_after_source(volume, source)
    with pytest.raises(isoweave.Stopped):
        isoweave.mesh(volume, 0, progress=lambda now: False)
    assert isoweave.mesh(volume, 0).report.triangles > 0
    assert not volume._errors._raised


def test_an_exception_of_a_source_stays_with_its_run_beside_others() -> None:
    source = FailsOnce(fail_at=14)
    volume = isoweave.open_volume(source)
    waits, may_stop = threading.Event(), threading.Event()
    ends: list[BaseException] = []

    def progress(now: isoweave.Progress) -> bool:
        waits.set()
        return not may_stop.wait(30)

    def run() -> None:
        try:
            isoweave.mesh(volume.crop(np.s_[100:, :, :]), 0, progress=progress)
        except BaseException as error:
            ends.append(error)

    other = threading.Thread(target=run)
    other.start()
    assert waits.wait(30)
    stop_by_sink_after_source(volume, source)
    may_stop.set()
    other.join()
    assert [type(error) for error in ends] == [isoweave.Stopped]


def test_progress_can_stop_a_run(folder: pathlib.Path) -> None:
    told: list[isoweave.Progress] = []

    def progress(now: isoweave.Progress) -> bool:
        told.append(now)
        return len(told) < 2

    with pytest.raises(isoweave.Stopped):
        isoweave.mesh(Slow(), 0, progress=progress, out=folder / "m.ply")
    assert len(told) == 2 and told[1].layer > told[0].layer and list(folder.iterdir()) == []
    told.clear()
    isoweave.mesh(Slow(), 0, progress=told.append)  # None from it goes on
    assert told[-1].layer == told[-1].layers


def test_progress_true_says_something(capfd: pytest.CaptureFixture[str]) -> None:
    isoweave.mesh(Slow(), 0, progress=True)
    assert "isoweave" in capfd.readouterr().err
    isoweave.mesh(Slow(), 0)
    assert capfd.readouterr() == ("", "")


def test_control_c_stops_a_run_and_leaves_no_file(folder: pathlib.Path) -> None:
    slow = Slow(seconds=0.02)
    timer = threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        isoweave.mesh(slow, 0, out=folder / "m.ply")
    timer.join()
    assert 0 < slow.read < Slow.shape[0]
    assert list(folder.iterdir()) == []
    assert not [thread for thread in threading.enumerate() if thread.name.startswith("isoweave")]
    assert isoweave.mesh(Slow(), 0).report.triangles > 0  # the next one is not disturbed


class SlowRows:
    """A volume of chunks that are read ahead, and take their time."""

    shape, chunks = Slow.shape, (4, 24, 24)
    dtype = Slow.dtype

    def __init__(self) -> None:
        self.slow = Slow(seconds=0.05)

    def __getitem__(self, key: tuple[slice, ...]) -> np.ndarray:
        return self.slow(key[0].start, key[0].stop)


def test_control_c_ends_reading_ahead(folder: pathlib.Path) -> None:
    rows = SlowRows()
    timer = threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        isoweave.mesh(rows, 0, out=folder / "m.ply")
    timer.join()
    read = rows.slow.read
    assert 0 < read < rows.shape[0] and list(folder.iterdir()) == []
    assert not [thread for thread in threading.enumerate() if thread.name.startswith("isoweave")]
    time.sleep(0.3)
    assert rows.slow.read == read


def test_leaving_a_loop_stops_the_run() -> None:
    slow = Slow(seconds=0.01)
    for _vertices, _faces in isoweave.iter_mesh(slow, 0, memory="1G"):
        break
    assert slow.read < Slow.shape[0]
    with pytest.raises(ZeroDivisionError):
        list(isoweave.iter_mesh(Slow(fail_at=300), 0))


def test_progress_is_told_in_the_thread_that_asked() -> None:
    told: list[threading.Thread] = []

    def progress(now: isoweave.Progress) -> None:
        told.append(threading.current_thread())

    isoweave.mesh(Slow(), 0, progress=progress)
    assert len(told) > 1 and set(told) == {threading.main_thread()}
    told.clear()
    other = threading.Thread(target=lambda: isoweave.mesh(Slow(), 0, progress=progress))
    other.start()
    other.join()
    assert len(told) > 1 and set(told) == {other}


def test_ctrl_c_in_a_progress_callback(folder: pathlib.Path) -> None:
    slept = []

    def progress(now: isoweave.Progress) -> None:
        if now.layer > 100:
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(5)
            slept.append(now.layer)

    with pytest.raises(KeyboardInterrupt):
        isoweave.mesh(Slow(), 0, out=folder / "m.ply", progress=progress)
    assert not slept and list(folder.iterdir()) == []


def test_two_runs_in_two_threads() -> None:
    volumes = [np.roll(Slow()(0, 60), n, axis=1) for n in range(4)]
    alone = [isoweave.mesh(volume, 0).digest for volume in volumes]
    shared = isoweave.open_volume(Slow())
    expected = isoweave.mesh(shared, 0).digest
    found: dict[Any, str] = {}
    threads = [
        threading.Thread(target=lambda n=n: found.update({n: isoweave.mesh(volumes[n], 0, threads=2).digest}))
        for n in range(4)
    ]
    threads += [
        threading.Thread(target=lambda n=n: found.update({f"shared {n}": isoweave.mesh(shared, 0).digest})) for n in range(2)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert [found[n] for n in range(4)] == alone
    assert found["shared 0"] == found["shared 1"] == expected


def test_the_gil_is_free_during_a_run() -> None:
    counted = 0
    done = threading.Event()

    def count() -> None:
        nonlocal counted
        while not done.is_set():
            counted += 1
            time.sleep(0.0005)

    volume = np.random.default_rng(1).random((90, 90, 90), dtype=np.float32)
    counter = threading.Thread(target=count)
    counter.start()
    isoweave.mesh(volume, 0.5)
    done.set()
    counter.join()
    assert counted > 20  # a run that held the GIL would let it count to 1


def test_memory_caps() -> None:
    volume = np.random.default_rng(1).random((60, 200, 200), dtype=np.float32)
    with pytest.raises(isoweave.OverMemory):
        isoweave.mesh(volume, 0.5, memory="1M")
    with pytest.raises(MemoryError):
        isoweave.mesh(volume, 0.5, memory=1000)
    for wrong in ("much", "2X", -1, 0):
        with pytest.raises(ValueError, match="memory"):
            isoweave.mesh(volume, 0.5, memory=wrong)


@pytest.mark.parametrize(
    "options",
    [
        {"error": "0.2furlong"}, {"error": -1}, {"error": float("nan")}, {"ratio": 2}, {"triangles": 0}, {"quality": "best"},
        {"lods": ["1vox", "0.5vox"]}, {"lods": ["1vox"], "error": 1}, {"triangles": 5, "ratio": 0.5}, {"smooth": 65},
        {"normals": "yes"}, {"device": "abacus"}, {"threads": -1}, {"spacing": (1, 2)}, {"spacing": 0}, {"step": 0},
        {"roi": np.s_[1:2]}, {"roi": np.s_[5:5, :, :]}, {"inside": "left"}, {"space": "mni"}, {"min_component": -1},
    ],
)
def test_wrong_options_are_value_errors_of_one_line(options: dict[str, Any]) -> None:
    with pytest.raises(ValueError) as raised:
        isoweave.mesh(np.zeros((4, 5, 6), np.uint8), 1, **options)
    assert "\n" not in str(raised.value) and not isinstance(raised.value, isoweave.IsoweaveError)


def test_fork() -> None:
    isoweave.mesh(Slow(), 0)
    child = os.fork()
    if child == 0:
        os._exit(0 if isoweave.mesh(Slow()(0, 40), 0).report.triangles > 0 else 1)
    assert os.waitpid(child, 0)[1] == 0


def test_importing_changes_nothing() -> None:
    program = (
        "import os, threading, warnings; warnings.simplefilter('error'); before = dict(os.environ)\n"
        "import isoweave, sys\n"
        "assert dict(os.environ) == before and threading.active_count() == 1\n"
        "assert not any(name in sys.modules for name in ('pyvista', 'vtk', 'dask', 'tqdm'))\n"
        "maps = open('/proc/self/maps').read(); assert 'libtbb' not in maps, maps\n"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_command_line_and_script() -> None:
    assert run_cli("--version").stdout.split()[-1] == isoweave.__version__
    assert run_cli("mesh").returncode == 2
    script = pathlib.Path(sys.executable).parent / "isoweave"
    assert subprocess.run([script, "--version"], capture_output=True, check=False).returncode == 0
