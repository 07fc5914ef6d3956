"""Where the meshes of a run go: memory, files, sinks."""

from __future__ import annotations

import ctypes
import os
import pathlib
from typing import Any, Protocol, Sequence, Union

import numpy as np
import numpy.typing as npt

from . import _library as c
from ._mesh import Mesh, mesh_of_handle
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
        self, outputs: Sequence[OutputLike], state: RunState, compress: bool = False, labels: Sequence[int] = ()
    ) -> None:
        self._outputs = outputs
        self.structs = (c.Output * len(outputs))()
        self._keep: list[Any] = []
        for n, output in enumerate(outputs):
            struct = c.Output(compress=int(compress), label=c.encoded(str(labels[n])) if labels else None)
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


def level_paths(path: str | os.PathLike[str], levels: int) -> list[str]:
    """Names as those of the command line: a.ply becomes a_lod0.ply, a_lod1.ply, ..."""
    whole = pathlib.Path(path)
    return [str(whole.with_name(f"{whole.stem}_lod{level}{whole.suffix}")) for level in range(levels)]


def label_path(path: str | os.PathLike[str], label: int) -> pathlib.Path:
    whole = pathlib.Path(path)
    return whole.with_name(f"{whole.stem}_label{label}{whole.suffix}")


__all__ = ["Mesh", "OutputLike", "Outputs", "Sink"]
