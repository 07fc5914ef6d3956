"""Where the meshes of a run go: memory, files, sinks."""

from __future__ import annotations

import ctypes
import os
import pathlib
from typing import Any, Callable, Protocol, Sequence, Union

import numpy as np
import numpy.typing as npt

from . import _library as c
from ._mesh import mesh_of_handle
from ._report import Report
from ._run import RunState


class Sink(Protocol):
    """Takes a mesh piece by piece, from one thread at a time. An exception from it ends the run and comes out of it."""

    def vertices(self, xyz: npt.NDArray[Any]) -> Any:
        """More vertices, (n, 3), numbered on from those before. The array may be kept."""

    def faces(self, ijk: npt.NDArray[np.int64]) -> Any:
        """More triangles, (m, 3), over the vertices so far. The array may be kept."""

    def finish(self, report: Report) -> Any:
        """The mesh is complete."""


OutputLike = Union[str, "os.PathLike[str]", Sink, None]


def copy_of(address: int | None, shape: tuple[int, int], dtype: Any) -> npt.NDArray[Any]:
    """A copy of an array of the C interface that lives during a call only."""
    if not address or not shape[0]:
        return np.empty(shape, dtype)
    size = shape[0] * shape[1] * np.dtype(dtype).itemsize
    room = memoryview((ctypes.c_char * size).from_address(address)).cast("B")
    array: npt.NDArray[Any] = np.frombuffer(room, dtype).reshape(shape).copy()
    return array


def vertices_of(piece: Any) -> npt.NDArray[Any]:
    """The vertices of a piece: float32, or float64 where the mesh is far from the origin."""
    points = copy_of(piece.points, (piece.vertices, 3), np.float32)
    offset = np.array(piece.offset)
    return points + offset if offset.any() else points


def faces_of(piece: Any) -> npt.NDArray[np.int64]:
    return copy_of(piece.corners, (piece.triangles, 3), np.int64)


def _sink_struct(sink: Sink, state: RunState) -> c.CSink:
    def append(_context: int | None, told: Any) -> int:
        def work() -> None:
            piece = told.contents
            if piece.vertices:
                sink.vertices(vertices_of(piece))
            if piece.triangles:
                sink.faces(faces_of(piece))

        return state.guarded(work)

    return c.CSink(append=c.AppendPiece(append))


class Outputs:
    """The outputs of one run."""

    def __init__(
        self,
        outputs: Sequence[OutputLike],
        state: RunState,
        compress: bool = False,
        labels: Sequence[int] = (),
        isos: Sequence[float] = (),
    ) -> None:
        self._outputs = outputs
        self.structs = (c.Output * len(outputs))()
        self._keep: list[Any] = []
        for n, output in enumerate(outputs):
            label = c.encoded(str(labels[n])) if labels else None
            struct = c.Output(compress=int(compress), label=label, iso=isos[n] if isos else 0.0)
            if isinstance(output, (str, os.PathLike)):
                struct.path = os.fsencode(output)
            elif output is not None:
                for name in ("vertices", "faces", "finish"):
                    if not callable(getattr(output, name, None)):
                        raise TypeError(f"out: expected a path or a sink with {name}(), found {type(output).__name__}")
                sink = _sink_struct(output, state)
                self._keep.append(sink)
                struct.sink = ctypes.pointer(sink)
            self._keep.append(struct)
            self.structs[n] = struct

    def __len__(self) -> int:
        return len(self._outputs)

    def results(self, reports: Sequence[Report]) -> list[Any]:
        """The meshes in memory; the reports where they are elsewhere, whose sinks are told that they are complete."""
        results: list[Any] = []
        for struct, output, report in zip(self.structs, self._outputs, reports):
            if output is None:
                results.append(mesh_of_handle(c.Handle(struct.mesh, "iw_free_mesh"), report))
                continue
            if not isinstance(output, (str, os.PathLike)):
                output.finish(report)
            results.append(report)
        return results


def level_path(path: str | os.PathLike[str], level: int) -> str:
    """As the command line names it: a.ply becomes a_lod0.ply, a_lod1.ply, ..."""
    return _with_part(path, f"lod{level}")


def iso_path(path: str | os.PathLike[str], iso: float) -> str:
    """As the command line names it: a.ply becomes a_iso10.ply."""
    return _with_part(path, f"iso{repr(iso).removesuffix('.0')}")


def label_path(path: str | os.PathLike[str], label: int) -> str:
    return _with_part(path, f"label{label}")


def _with_part(path: str | os.PathLike[str], part: str) -> str:
    whole = pathlib.Path(path)
    return str(whole.with_name(f"{whole.stem}_{part}{whole.suffix}"))


def outputs_for(
    out: OutputLike | Sequence[OutputLike], count: int, name: Callable[[str | os.PathLike[str], int], str]
) -> list[OutputLike]:
    """An output for each of several meshes, whose files `name` calls by the number of the mesh."""
    if isinstance(out, (list, tuple)):
        if len(out) != count:
            raise ValueError(f"out: expected {count} outputs, found {len(out)}")
        return list(out)
    if out is None:
        return [None] * count
    if isinstance(out, (str, os.PathLike)):
        return [name(out, n) for n in range(count)]
    raise ValueError(f"out: expected a path or a list of {count} sinks, found one sink")


def level_outputs(out: OutputLike | Sequence[OutputLike], levels: int) -> list[OutputLike]:
    """The outputs of a run with so many levels, or with one mesh, where they are 0."""
    if levels == 0 and not isinstance(out, (list, tuple)):
        return [out]  # type: ignore[list-item]
    return outputs_for(out, max(levels, 1), level_path)


def level_reports(report: Report, levels: int) -> list[Report]:
    """The report of each level: the finer ones have their counts, and the last one is that of the run."""
    if levels == 0:
        return [report]
    return [Report({**report, **finer}) for finer in report.get("levels", [])] + [report]
