"""A mesh by the workers of a Dask cluster, which see the volume and a folder: ``isoweave.distributed.mesh``.

The tasks are those of ``isoweave plan``. Dask carries their numbers, and nothing of the volume or of the mesh.
"""

from __future__ import annotations

import json
import os
import pathlib
import shutil
import tempfile
from contextlib import closing, contextmanager
from dataclasses import dataclass
from time import sleep
from typing import TYPE_CHECKING, Any, Callable, Iterator, Protocol, Sequence, Union, overload

import numpy as np

from . import _library as c
from ._options import Length, length
from ._outputs import level_reports
from ._program import run
from ._report import Report
from ._run import Teller, teller
from ._volume import Roi, ranges_of

try:
    import distributed
except ImportError as error:
    raise ImportError("isoweave.distributed: expected Dask's package distributed (pip install distributed), found none") from error

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._settings import PlanSettings

PathLike = Union[str, "os.PathLike[str]"]


class Stored(Protocol):
    """An array or a group of zarr, which lies in a store."""

    @property
    def store(self) -> Any: ...

    @property
    def path(self) -> str: ...


@dataclass(frozen=True)
class TaskProgress:
    """How far the tasks of a run are."""

    task: int
    """Tasks that are done."""
    tasks: int
    """Tasks in all."""

    def _steps(self) -> tuple[int, int, str]:
        return self.task, self.tasks, "task"

    def _line(self) -> str:
        return f"task {self.task} of {self.tasks}"


def _work_on(task: int, folder: str, threads: int) -> None:
    """Works on a task, in a worker of Dask, for as long as the client wants it."""
    worker = distributed.get_worker()
    key = worker.get_current_task()

    def wanted() -> bool:
        known = worker.state.tasks.get(key)
        return known is not None and known.state == "executing"

    # The program of a worker that was killed may still be at work on this task.
    run("work", folder, f"--task={task}", "--wait", f"--threads={threads or 'all'}", "--quiet", wanted=wanted)


def _work_on_all(client: Any, folder: str, threads: int, told: Teller) -> None:
    """Works on all tasks. The ones of a stage take what the ones of the stage before have left."""
    stages = [stage["tasks"] for stage in json.loads(run("status", folder, "--json"))["stages"]]
    done = 0
    for count in stages:
        tasks = client.map(_work_on, range(done, done + count), folder=folder, threads=threads, pure=False)
        try:
            for task in distributed.as_completed(tasks):
                task.result()
                done += 1
                if told.tell(TaskProgress(done, sum(stages))) is False:
                    raise c.Stopped("isoweave.distributed.mesh: stopped by progress")
        except BaseException:
            client.cancel(tasks)
            raise


def _plan_in(folder: str) -> dict[str, Any]:
    """The plan without the error up to which tasks decide everything: it is lower where it was too high for a number."""
    plan: dict[str, Any] = json.loads(pathlib.Path(folder, "plan.json").read_bytes())
    del plan["head_start"]
    return plan


def _all_done(folder: str) -> bool:
    stages = json.loads(run("status", folder, "--json"))["stages"]
    return all(stage["done"] == stage["tasks"] for stage in stages)


def _plan(options: Sequence[str], folder: str, scratch: str) -> None:
    """Plans the mesh in a folder, or compares the plan that is there."""
    plan = pathlib.Path(folder, "plan.json")
    made = os.path.join(scratch, "plan") if plan.exists() else folder
    run("plan", *options, f"--output={made}", "--quiet")
    if _plan_in(made) != _plan_in(folder):
        raise c.BadInput(f"{plan}: expected the plan of the same mesh, found that of another")


def _collect(folder: str, out: str, compress: bool, scratch: str) -> Report:
    report = pathlib.Path(scratch, "report.json")
    run("collect", folder, f"--output={out}", f"--report={report}", "--quiet", *["--compress"] * compress)
    return Report(json.loads(report.read_bytes()))


def _collect_if_done(folder: str, out: str, compress: bool, scratch: str) -> Report | None:
    """Collects the tasks; nothing where some are left, also as they have gone too far for a number of triangles."""
    try:
        return _collect(folder, out, compress, scratch)
    except c.BadInput:
        if _all_done(folder):
            raise
    return None


@contextmanager
def _task_folder(folder: PathLike | None, out: str) -> Iterator[str]:
    """The folder of the tasks: the one that is named, or one beside the mesh that vanishes."""
    if folder is not None:
        yield os.path.abspath(folder)
        return
    parent, name = os.path.split(out)
    if not os.path.isdir(parent):
        raise c.CannotWrite(f"{out}: expected a folder to write it into, found none")
    temporary = tempfile.mkdtemp(prefix=f"{name}.", suffix=".tasks", dir=parent)
    try:
        yield temporary
    finally:
        # Workers that have been stopped may still be writing to it, for as long as one of their tasks takes to notice.
        for _ in range(50):
            shutil.rmtree(temporary, ignore_errors=True)
            if not os.path.exists(temporary):
                break
            sleep(0.2)
        else:
            raise c.CannotWrite(f"{temporary}: cannot be removed")


def _numbers(values: Any) -> str | None:
    return None if values is None else ",".join(repr(float(value)) for value in np.ravel(values))


def _length(value: Length | None) -> str | None:
    return None if value is None else os.fsdecode(length(value) or b"")


def _ranges(roi: Roi | None) -> str | None:
    """As the command line has them: along x, y, z."""
    if roi is None:
        return None
    ends = [(part.start, part.stop) for part in reversed(ranges_of(roi))]
    return ",".join(":".join("" if end is None else str(end) for end in pair) for pair in ends)


# The stores of zarr 3 and 2 that are folders.
_FOLDER_STORES = ("LocalStore", "DirectoryStore", "NestedDirectoryStore")


def _path_of(volume: Any) -> str:
    """The path at which all workers find a volume."""
    if isinstance(volume, (str, os.PathLike)):
        return os.path.abspath(volume)
    store: Any = getattr(volume, "store", volume)
    kind = type(store).__name__
    if kind in _FOLDER_STORES:
        root: str | os.PathLike[str] = store.root if hasattr(store, "root") else store.path
        return os.path.abspath(pathlib.Path(root, str(volume.path)))
    raise TypeError(f"volume: expected a path or a zarr array in a folder, which all workers see, found {kind}: save it first")


@overload
def mesh(
    volume: PathLike | Stored, level: float | None = None, *, out: PathLike, **settings: Unpack[PlanSettings]
) -> Report: ...
@overload
def mesh(
    volume: PathLike | Stored,
    level: float | None = None,
    *,
    lods: Sequence[Length],
    out: PathLike,
    **settings: Unpack[PlanSettings],
) -> list[Report]: ...
def mesh(
    volume: PathLike | Stored, level: float | None = None, *, out: PathLike, client: Any = None, folder: PathLike | None = None,
    blocks: int = 512, threads: int = 1, error: Length | None = None, lods: Sequence[Length] = (),
    triangles: int | None = None, ratio: float | None = None, quality: str = "normal", specks: str = "keep", inside: str = "above", closed: bool = True, smooth: int = 0, extractor: str = "cubes",
    normals: str | None = None, space: str | None = None, spacing: Any = None, origin: Any = None, raw: str | None = None,
    dataset: str | None = None, series: str | None = None, channel: int | None = None, time: int | None = None,
    external: bool = True, roi: Roi | None = None, step: int | None = None, compress: bool = False,
    progress: bool | Callable[[TaskProgress], Any] | None = None,
) -> Any:
    """The mesh of :func:`isoweave.mesh`, bit for bit, by the workers of a Dask cluster.

    Workers need this package, and see the volume and the folder under the same paths as the client.

    Args:
        volume: a path, or an array or a group of zarr in a local folder, which is read by its path: spacing and origin are
            those of its metadata (OME-Zarr). Streams that are packed as a whole, such as ``.nii.gz``, are refused.
        level: the value at the surface. None: Otsu's threshold.
        out: the mesh file, which the client writes; with ``lods``, ``a.ply`` becomes ``a_lod0.ply``, ...
        client: a ``distributed.Client``. None: the current one.
        folder: where the tasks leave their files. It is kept, and a call with the same volume and options goes on in it.
            None: a folder beside ``out``, which is removed however the run ends.
        blocks: cells along each side of a task's block; 128 at least.
        threads: of each task, whose worker may run several tasks at a time. 0: one for each processor.
        raw, dataset, series, external: as :func:`isoweave.open_volume`.
        error, lods, triangles, ratio, quality, specks, inside, closed, smooth, extractor, normals, space, spacing, origin, channel, time, roi,
            step, compress: as :func:`isoweave.mesh`. There is no "dual" extractor, and nothing negative in ``roi``.
        progress: True: a bar of tqdm, or one line on standard error. A function that gets a :class:`TaskProgress` after every
            task; False from it stops the run.

    To a number of triangles, the client ends the mesh by itself, in 350 bytes for each triangle of 1.5 times the number.

    Returns:
        A :class:`Report`; a list of them with ``lods``, finest first.

    Raises:
        As :func:`isoweave.mesh`; on Ctrl-C, and where ``progress`` stops the run, the tasks of all workers stop as well.
        distributed.KilledWorker: where several workers have died of the same task.
    """
    values: dict[str, Any] = {
        "iso": _numbers(level) or "auto", "blocks": blocks, "error": _length(error),
        "lods": ",".join(_length(each) or "" for each in lods) or None, "triangles": triangles,
        "ratio": None if ratio is None else repr(float(ratio)), "quality": quality, "specks": specks,
        "inside": inside, "smooth": smooth or None, "extractor": extractor, "normals": normals or "none", "space": space,
        "spacing": _numbers(spacing), "origin": _numbers(origin), "raw": raw, "dataset": dataset, "series": series,
        "channel": channel, "time": time, "roi": _ranges(roi), "step": step,
    }
    options = [_path_of(volume), *(f"--{name}={value}" for name, value in values.items() if value is not None)]
    options += ["--open"] * (not closed) + ["--no-external"] * (not external)
    client = distributed.get_client() if client is None else client
    path = os.path.abspath(out)
    with tempfile.TemporaryDirectory() as scratch, _task_folder(folder, path) as tasks:
        _plan(options, tasks, scratch)
        # A wrong `out` is refused before any task is done.
        while (report := _collect_if_done(tasks, path, compress, scratch)) is None:
            with closing(teller(progress)) as told:
                _work_on_all(client, tasks, threads, told)
    return level_reports(report, len(lods)) if lods else report
