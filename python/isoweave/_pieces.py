"""A mesh that is taken piece by piece, while the sweep goes on."""

from __future__ import annotations

import ctypes
import queue
import threading
from typing import Any, Generator, Literal

import numpy as np
import numpy.typing as npt

from . import _library as c
from ._options import Extractor, Length, Quality, mesh_struct, simplify_struct, usual_error
from ._outputs import faces_of, vertices_of
from ._report import Report
from ._run import Runner, RunState
from ._volume import Roi, VolumeLike, level_of, volume_for


class _Pieces:
    """A sink whose pieces are taken by another thread: a few wait at most."""

    def __init__(self, state: RunState) -> None:
        self._state = state
        self._queue: queue.Queue[Any] = queue.Queue(2)
        self._closed = threading.Event()

    def put(self, item: Any) -> None:
        while not self._closed.is_set():
            try:
                return self._queue.put(item, timeout=0.1)
            except queue.Full:
                continue

    def append(self, _context: int | None, told: Any) -> int:
        return self._state.guarded(lambda: self.put((vertices_of(told.contents), faces_of(told.contents))))

    def get(self) -> Any:
        return self._queue.get()

    def close(self) -> None:
        self._closed.set()
        self._state.stop()


def iter_mesh(
    volume: VolumeLike,
    level: float | None = None,
    *,
    error: Length | None = None,
    max_distance: Length | None = None,
    triangles: int | None = None,
    quality: Quality = "normal",
    inside: Literal["above", "below"] = "above",
    closed: bool = True,
    smooth: int = 0,
    extractor: Extractor = "cubes",
    roi: Roi | None = None,
    step: int = 1,
    memory: int | str | None = None,
    threads: int = 0,
    **opening: Any,
) -> Generator[tuple[npt.NDArray[Any], npt.NDArray[np.int64]], None, Report]:
    """The mesh of :func:`mesh` piece by piece, while the sweep goes on: ``for vertices, faces in iter_mesh(...)``.

    Vertices are numbered on from piece to piece; faces refer to any vertices so far. A loop that is left early stops
    the run. Args: as :func:`mesh`; what is left goes to :func:`open_volume`.

    Yields:
        ``(vertices, faces)``: (n, 3) coordinates and (m, 3) int64. The generator returns the report.
    """
    opened = volume_for(volume, roi, step, **opening)
    simplify_options = simplify_struct(
        error=usual_error(error, [triangles, max_distance]), lods=(), max_distance=max_distance, triangles=triangles,
        ratio=None, quality=quality, specks="keep",
    )
    options = mesh_struct(
        simplify_options, iso=level_of(opened, level), inside=inside, closed=closed, smooth=smooth, extractor=extractor
    )
    runner = Runner(threads, "auto", memory, None)
    pieces = _Pieces(runner.state)
    sink = c.CSink(append=c.AppendPiece(pieces.append))
    output = c.Output(sink=ctypes.pointer(sink))

    def run() -> None:
        try:
            facts = opened._finish(
                lambda: runner.call(
                    "iw_mesh_volume", opened._handle.pointer, ctypes.byref(options), runner.pointer(), ctypes.byref(output), 1
                )
            )
            pieces.put(Report(facts))
        except BaseException as failure:
            pieces.put(failure)

    thread = threading.Thread(target=run, name="isoweave")
    thread.start()
    try:
        while True:
            item = pieces.get()
            if isinstance(item, Report):
                return item
            if isinstance(item, BaseException):
                raise item
            yield item
    finally:
        pieces.close()
        thread.join()
