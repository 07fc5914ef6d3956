"""Meshes by the workers of a Dask cluster of processes on this machine, some of which are killed."""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import pathlib
import signal
import subprocess
import sys
import threading
import time
from typing import Any, Callable, Iterator

import numpy as np
import pytest
from conftest import ORIGIN, SPACING

import isoweave

distributed = pytest.importorskip("distributed")
psutil = pytest.importorskip("psutil")
zarr = pytest.importorskip("zarr")
cluster_mesh = pytest.importorskip("isoweave.distributed").mesh


@pytest.fixture(scope="module")
def client() -> Iterator[Any]:
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as connected:
            yield connected


@pytest.fixture(scope="module")
def noise(tmp_path_factory: pytest.TempPathFactory) -> str:
    """A volume with a surface everywhere, in a file: a task takes some tenths of a second."""
    path = tmp_path_factory.mktemp("noise") / "noise.npy"
    np.save(path, np.random.default_rng(7).random((60, 56, 52), dtype=np.float32))
    return str(path)


def wait_for(found: Callable[[], Any], seconds: float = 60) -> Any:
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if result := found():
            return result
        time.sleep(0.002)
    raise AssertionError("waited in vain")


def programs(folder: pathlib.Path) -> dict[Any, str]:
    """The processes that work on tasks in a folder, or in one below it, and the numbers of their tasks."""
    found = {}
    for process in psutil.process_iter():
        try:
            words = process.cmdline()
        except psutil.Error:
            continue
        if len(words) > 3 and words[1] == "work" and words[2].startswith(str(folder)):
            found[process] = words[3].removeprefix("--task=")
    return found


def is_locked(path: pathlib.Path) -> bool:
    """Whether somebody has the lock of a file, which may exist before it is locked."""
    with contextlib.suppress(FileNotFoundError), path.open("rb") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            return True
    return False


def suspended(tasks: pathlib.Path) -> Any:
    """A program that holds still while it has the lock of its task, and the task."""
    for program, task in programs(tasks).items():
        with contextlib.suppress(psutil.NoSuchProcess):
            program.suspend()
            if is_locked(tasks / f"{task}.lock") and not (tasks / f"{task}.rest").exists():
                return program, task
            program.resume()
    return None


def is_told_to_end(program: Any) -> bool:
    """Whether SIGTERM waits for a program that holds still."""
    status = pathlib.Path(f"/proc/{program.pid}/status").read_text()
    waiting = next(line for line in status.splitlines() if line.startswith("ShdPnd:"))
    return bool(int(waiting.split()[1], 16) & 1 << (signal.SIGTERM - 1))


def sorted_rows(array: np.ndarray | None) -> np.ndarray:
    """The rows in an order that the order of vertices does not change; none of no array."""
    return np.empty(0) if array is None else array[np.lexsort(array.T)]


class Beside:
    """Work beside the test, whose error is the test's."""

    def __init__(self, work: Callable[[], Any]) -> None:
        self._error: BaseException | None = None

        def guarded() -> None:
            try:
                work()
            except BaseException as error:
                self._error = error

        self._thread = threading.Thread(target=guarded)

    def __enter__(self) -> None:
        self._thread.start()

    def __exit__(self, *_: object) -> None:
        self._thread.join()
        if self._error is not None:
            raise self._error


def test_the_mesh_is_that_of_one_process(client: Any, folder: pathlib.Path, volume: np.ndarray, wanted: str) -> None:
    path = folder / "v.npy"
    np.save(path, volume)
    report = cluster_mesh(path, 100, blocks=30, spacing=SPACING, origin=ORIGIN, out=folder / "m.ply")
    assert isinstance(report, isoweave.Report) and report.digest == wanted == isoweave.check(folder / "m.ply").digest
    assert sorted(os.listdir(folder)) == ["m.ply", "v.npy"]


def test_options(client: Any, folder: pathlib.Path, volume: np.ndarray) -> None:
    path = folder / "v.npy"
    np.save(path, volume)
    for options in (
        {"error": 0.3, "closed": False, "quality": "fine", "normals": "quadric", "spacing": 0.5},
        {"inside": "below", "smooth": 3, "extractor": "tetrahedra", "specks": "drop", "error": "1.5vox"},
        {"roi": np.s_[5:, :20, 2:30], "extractor": "trilinear", "normals": "gradient", "space": "index"},
    ):
        level = None if "roi" in options else 100
        report = cluster_mesh(path, level, blocks=30, client=client, out=folder / "m.ply", **options)
        alone = isoweave.mesh(path, level, out=folder / "alone.ply", **options)
        assert report.digest == alone.digest, options
        found, expected = (isoweave.read_mesh(folder / name).normals for name in ("m.ply", "alone.ply"))
        assert np.array_equal(sorted_rows(found), sorted_rows(expected))
    levels = cluster_mesh(path, 100, lods=["0.1vox", 0.5], blocks=30, step=1, out=folder / "l.ply")
    alone = isoweave.mesh(path, 100, lods=["0.1vox", 0.5])
    assert [level.triangles for level in levels] == [len(mesh.faces) for mesh in alone]
    assert [isoweave.check(folder / f"l_lod{n}.ply").digest for n in range(2)] == [mesh.digest for mesh in alone]


def test_a_number_of_triangles(client: Any, folder: pathlib.Path, noise: str) -> None:
    full = isoweave.mesh(noise, 0.5, error=0, out=folder / "full.ply").triangles
    half: dict[str, Any] = {"triangles": full // 2}
    for stop in (half, {"ratio": 0.6}, {"triangles": 3000, "error": 0.2}):
        report = cluster_mesh(noise, 0.5, blocks=40, out=folder / "m.ply", **stop)
        alone = isoweave.mesh(noise, 0.5, out=folder / "alone.ply", **stop)
        assert (report.digest, report.triangles) == (alone.digest, alone.triangles), stop
    # A forecast is a guess: here the plan has one that leaves too little.
    tasks = folder / "tasks"
    cluster_mesh(noise, 0.5, blocks=40, folder=tasks, out=folder / "m.ply", **half)
    plan = json.loads((tasks / "plan.json").read_bytes())
    for file in tasks.glob("*.rest"):
        file.unlink()
    (tasks / "plan.json").write_text(json.dumps({**plan, "head_start": 10 * plan["head_start"]}))
    again = cluster_mesh(noise, 0.5, blocks=40, folder=tasks, out=folder / "again.ply", **half)
    assert again.digest == isoweave.mesh(noise, 0.5, **half).digest
    assert json.loads((tasks / "plan.json").read_bytes())["head_start"] < 10 * plan["head_start"]


def test_arrays_of_zarr_are_read_by_their_path(
    client: Any, folder: pathlib.Path, volume: np.ndarray, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(folder)
    for format in (2, 3):
        group = zarr.open_group(f"g{format}.zarr", mode="w", zarr_format=format)
        array = group.create_array("scans/first", shape=volume.shape, chunks=(8, 16, 16), dtype="u1")
        array[:] = volume
        wanted = isoweave.mesh(array, 100, out="alone.ply").digest
        assert cluster_mesh(array, 100, blocks=30, out="m.ply").digest == wanted
        assert cluster_mesh(group["scans"], 100, blocks=30, dataset="first", out="m.ply").digest == wanted


def test_progress(client: Any, folder: pathlib.Path, noise: str, capsys: pytest.CaptureFixture[str]) -> None:
    told: list[Any] = []
    cluster_mesh(noise, 0.5, blocks=40, out=folder / "m.ply", progress=told.append)
    assert len(told) > 2 and [now.task for now in told] == list(range(1, len(told) + 1))
    assert {now.tasks for now in told} == {len(told)}
    cluster_mesh(noise, 0.5, blocks=40, out=folder / "m.ply", progress=True)
    assert f"{len(told)}/{len(told)}" in capsys.readouterr().err  # tqdm's
    with pytest.raises(isoweave.Stopped, match="stopped by progress"):
        cluster_mesh(noise, 0.5, blocks=40, out=folder / "stopped.ply", progress=lambda now: now.task < 2)
    assert os.listdir(folder) == ["m.ply"]


def test_a_worker_that_is_killed(client: Any, folder: pathlib.Path, noise: str) -> None:
    """Its program outlives it, holds still, and dies later: the rerun of its task waits for that."""
    workers = client.run(os.getpid)
    tasks = folder / "tasks"

    def kill() -> None:
        program, task = wait_for(lambda: suspended(tasks))
        try:
            assert program.ppid() in workers.values()
            os.kill(program.ppid(), signal.SIGKILL)
            again = wait_for(lambda: [each for each, other in programs(tasks).items() if each != program and other == task])
            time.sleep(0.5)
            assert again[0].is_running() and not (tasks / f"{task}.rest").exists()
        finally:
            program.kill()

    with Beside(kill):
        report = cluster_mesh(noise, 0.5, blocks=40, client=client, folder=tasks, out=folder / "m.ply")
    assert set(client.run(os.getpid).values()) != set(workers.values())
    assert report.digest == isoweave.mesh(noise, 0.5, out=folder / "alone.ply").digest
    assert (tasks / "plan.json").exists()  # a folder that was named stays
    with pytest.raises(isoweave.BadInput, match="plan.json: expected the plan of the same mesh"):
        cluster_mesh(noise, 0.4, blocks=40, folder=tasks, out=folder / "m.ply")
    # A call that goes on has nothing left to do but to collect.
    before = {path: path.stat().st_mtime_ns for path in tasks.glob("*.rest")}
    again = cluster_mesh(noise, 0.5, blocks=40, folder=tasks, out=folder / "again.ply")
    assert again.digest == report.digest and before == {path: path.stat().st_mtime_ns for path in tasks.glob("*.rest")}


def test_control_c_leaves_no_file(client: Any, folder: pathlib.Path, noise: str) -> None:
    def interrupt() -> None:
        wait_for(lambda: list(folder.glob("*/*.lock")))
        os.kill(os.getpid(), signal.SIGINT)

    with Beside(interrupt), pytest.raises(KeyboardInterrupt):
        cluster_mesh(noise, 0.5, blocks=40, client=client, out=folder / "m.ply")
    assert list(folder.iterdir()) == []
    wait_for(lambda: not programs(folder))
    assert client.submit(os.getpid).result() in client.run(os.getpid).values()  # the workers are free


def test_control_c_stops_the_workers(client: Any, folder: pathlib.Path) -> None:
    """A program holds still, so that it is at work for certain when it is told to end. The volume is less than a block."""
    np.save(folder / "v.npy", np.random.default_rng(8).random((96, 96, 96), dtype=np.float32))
    tasks, held = folder / "tasks", []

    def interrupt() -> None:
        held.extend(wait_for(lambda: suspended(tasks)))
        os.kill(os.getpid(), signal.SIGINT)

    with Beside(interrupt), pytest.raises(KeyboardInterrupt):
        cluster_mesh(folder / "v.npy", 0.5, client=client, folder=tasks, out=folder / "m.ply")
    try:
        wait_for(lambda: is_told_to_end(held[0]))
    finally:
        held[0].resume()
    wait_for(lambda: not programs(tasks))
    assert not list(tasks.glob(f"{held[1]}.*"))


def test_errors(client: Any, folder: pathlib.Path, noise: str) -> None:
    out = folder / "m.ply"
    for error, wrong, said in (
        (ValueError, {"error": "0.2furlong"}, "--error"),
        (ValueError, {"extractor": "dual"}, "dual"),
        (ValueError, {"level": [0.4, 0.5]}, "--iso: expected one value"),
        (ValueError, {"roi": np.s_[1:2]}, "roi"),
        (TypeError, {"volume": np.zeros((4, 4, 4))}, "volume: expected a path or a zarr array in a folder, .* found ndarray"),
        (TypeError, {"volume": zarr.ones(shape=(4, 4, 4), store={})}, "found MemoryStore: save it first"),
        (isoweave.BadInput, {"volume": folder / "none.npy"}, "none.npy"),
        (isoweave.CannotWrite, {"out": folder / "none" / "m.ply"}, "m.ply: expected a folder"),
        (isoweave.CannotWrite, {"folder": pathlib.Path(noise).parent}, "expected a new or empty folder"),
    ):
        with pytest.raises(error, match=said) as raised:
            cluster_mesh(**{"volume": noise, "level": 0.5, "out": out, "blocks": 24, "client": client, **wrong})
        assert "\n" not in str(raised.value) and not str(raised.value).startswith("isoweave: ")
    assert list(folder.iterdir()) == []
    with pytest.raises(isoweave.CannotWrite, match="m.xyz"):
        cluster_mesh(noise, 0.5, out=folder / "m.xyz", blocks=40, client=client, folder=folder / "tasks")
    assert sorted(os.listdir(folder / "tasks")) == ["Makefile", "plan.json", "slurm.sh"]  # said before the work


def test_errors_of_workers_come_out_as_they_were(client: Any, folder: pathlib.Path, volume: np.ndarray) -> None:
    path = folder / "v.npy"
    np.save(path, volume)
    tasks, out = folder / "tasks", folder / "m.ply"
    cluster_mesh(path, 100, blocks=30, folder=tasks, out=out)
    (tasks / "0.rest").write_bytes((tasks / "0.rest").read_bytes()[:-1])
    for done in tasks.glob("[1-9]*.rest"):
        done.unlink()
    with pytest.raises(isoweave.BadInput, match=r"0\.rest") as raised:
        cluster_mesh(path, 100, blocks=30, folder=tasks, out=out)
    assert raised.value.__context__ is None


def test_without_dask() -> None:
    program = "import sys; sys.modules['distributed'] = None\nimport isoweave\nimport isoweave.distributed"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    last = done.stderr.strip().splitlines()[-1]
    assert last.startswith("ImportError: isoweave.distributed: expected Dask's package distributed")
