"""The functions of the package."""

from __future__ import annotations

import ctypes
import os
import queue
import threading
from typing import Any, Callable, Generator, Iterable, Literal, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from . import _library as c
from ._mesh import Mesh, MeshLike, mesh_of
from ._options import Length, mesh_struct, simplify_struct
from ._outputs import OutputLike, Outputs, faces_of, label_path, level_paths, vertices_of
from ._report import Check, Comparison, Forecast, Report
from ._run import ProgressLike, Runner, RunState
from ._volume import Triple, Volume, VolumeLike, open_volume

Quality = Literal["fast", "normal", "fine"]
Extractor = Literal["cubes", "trilinear", "tetrahedra", "dual"]
Roi = Iterable["slice | tuple[int | None, int | None]"]


def _volume_for(volume: VolumeLike, roi: Roi | None, step: int, **opening: Any) -> Volume:
    opened = open_volume(volume, **opening)
    if roi is not None:
        opened = opened.crop(roi)
    return opened if step == 1 else opened.downsample(step)


def _usual_error(error: Length | None, stops: Sequence[Any]) -> Length | None:
    """The error where none is named: 0.2 voxels, unless something else says where to stop."""
    return "0.2vox" if error is None and not any(stops) else error


def _level_of(volume: Volume, level: float | None) -> float:
    return volume.suggest_level() if level is None else float(level)


def _outputs_for(out: OutputLike | Sequence[OutputLike], levels: int) -> list[OutputLike]:
    """An output for each level."""
    if isinstance(out, (list, tuple)):
        if len(out) != max(levels, 1):
            raise ValueError(f"out: expected {max(levels, 1)} outputs, found {len(out)}")
        return list(out)
    if levels == 0:
        return [out]  # type: ignore[list-item]
    if out is None:
        return [None] * levels
    if isinstance(out, (str, os.PathLike)):
        return list(level_paths(out, levels))
    raise ValueError("out: expected a path or a list with a sink for each of lods, found one sink")


def _level_reports(report: Report, levels: int) -> list[Report]:
    """The report of each level: the finer ones have their counts, and the last one is that of the run."""
    if levels == 0:
        return [report]
    return [Report({**report, **finer}) for finer in report.get("levels", [])] + [report]


def mesh(
    volume: VolumeLike,
    level: float | None = None,
    *,
    error: Length | None = None,
    triangles: int | None = None,
    ratio: float | None = None,
    max_distance: Length | None = None,
    quality: Quality = "normal",
    inside: Literal["above", "below"] = "above",
    closed: bool = True,
    smooth: int = 0,
    extractor: Extractor = "cubes",
    specks: Literal["keep", "drop"] = "keep",
    largest: bool = False,
    min_component: int = 0,
    normals: Literal[None, "gradient", "quadric"] = None,
    values: VolumeLike | None = None,
    spacing: Triple | float | None = None,
    origin: Triple | None = None,
    direction: npt.ArrayLike | None = None,
    affine: npt.ArrayLike | None = None,
    unit: str | None = None,
    space: Literal[None, "lps", "ras", "index"] = None,
    axes: str | None = None,
    channel: int | None = None,
    time: int | None = None,
    scalars: str | None = None,
    roi: Roi | None = None,
    step: int = 1,
    lods: Sequence[Length] = (),
    out: OutputLike | Sequence[OutputLike] = None,
    compress: bool = False,
    memory: int | str | None = None,
    threads: int = 0,
    device: Literal["auto", "cpu", "cuda"] = "auto",
    progress: ProgressLike = None,
) -> Any:
    """The simplified surface of a volume at a level: bit for bit that of ``isoweave mesh``.

    The volume is read slab by slab, and never as a whole. Arrays are ``(z, y, x)``, everything physical is
    ``(x, y, z)``.

    Args:
        volume: an array, an image, a path, or a :class:`Volume`; see :func:`open_volume`.
        level: the value at the surface. None: Otsu's threshold, from a pass over the volume of its own; the report's
            ``iso`` says which it was.
        error: how far simplification may go: ``"0.2vox"``, ``"50um"``, or a number in the volume's unit; 0: the full
            surface. None: "0.2vox", unless ``triangles``, ``ratio``, ``max_distance`` or ``lods`` says where to stop.
        triangles: stop at this number.
        ratio: stop at this part of the full surface's triangles, which takes a pass over the volume of its own.
        max_distance: a guarantee: no point of the mesh is farther than this from the full surface.
        quality: "fine" costs time and gives the lowest error.
        inside: the side of the level that is inside.
        closed: whether the surface is closed at the border of the volume.
        smooth: passes that take the staircase off a mask, 4 usually; 0: none.
        extractor: "cubes": marching cubes. "trilinear": with the topology of the trilinear interpolant. "tetrahedra":
            marching tetrahedra, three times the triangles. "dual": dual marching cubes, which keeps sharp edges.
        specks: "drop": closed components that have shrunk to a tetrahedron within the error vanish.
        largest: keep the largest component only. Takes a pass over the volume of its own.
        min_component: drop components of fewer triangles before simplification. Likewise.
        normals: "gradient", or "quadric", which simplification keeps as well as the places.
        values: another volume of the same shape, whose values the vertices get.
        spacing, origin, direction, affine, unit, axes, channel, time, scalars: as :func:`open_volume`.
        space: coordinates of the mesh: "lps", "ras", "index" (index times spacing), or None: the volume's own.
        roi: three slices or pairs (first, end) along z, y, x.
        step: make the volume smaller first: means of blocks of step x step x step samples.
        lods: errors of several meshes from one sweep, finest first. Not with error, triangles and ratio.
        out: None: the mesh is returned. A path: it is streamed to that file, which is complete or absent. An object
            with ``vertices``, ``faces`` and ``finish``: see :class:`Sink`. With ``lods``, ``a.ply`` becomes
            ``a_lod0.ply``, ...; or a list of outputs.
        compress: pack a .glb or .precomputed file, with rounding.
        memory: cap on the memory of the process, in bytes or as "2G". A mesh that is returned is not counted.
        threads: 0: one for each processor. Never changes the mesh.
        device: "cuda" for a CUDA device, where this build has one.
        progress: True: a bar of tqdm, or one line on standard error. A function that gets a :class:`Progress` after
            every slab; False from it stops the run.

    Returns:
        A :class:`Mesh`, or with ``lods`` a list of them; with ``out`` a :class:`Report`, or a list of them.

    Raises:
        BadInput: for a volume that cannot be read.
        CannotWrite: where ``out`` cannot be written.
        ValueError: for options out of range or that do not go together.
        OverMemory: where ``memory`` is not enough.
        KeyboardInterrupt: on Ctrl-C, within a slab. No file is left behind.
        Stopped: where ``progress`` returned False.

    >>> import numpy as np
    >>> z, y, x = np.ogrid[-16:16, -16:16, -16:16]
    >>> ball = isoweave.mesh(12.0 - np.sqrt(x * x + y * y + z * z), 0, error="0.3vox")
    >>> vertices, faces = ball
    >>> len(faces) < 1000, bool(isoweave.check(ball))
    (True, True)
    """
    opened = _volume_for(
        volume, roi, step, spacing=spacing, origin=origin, direction=direction, affine=affine, unit=unit, axes=axes,
        channel=channel, time=time, scalars=scalars,
    )
    coloured = None if values is None else _volume_for(values, roi, step)
    simplify_options = simplify_struct(
        error=_usual_error(error, [triangles, ratio, max_distance, lods]), lods=lods, max_distance=max_distance,
        triangles=triangles, ratio=ratio, quality=quality, specks=specks, largest=largest, min_component=min_component,
    )
    options = mesh_struct(
        simplify_options, iso=_level_of(opened, level), inside=inside, closed=closed, smooth=smooth,
        extractor=extractor, normals=normals, space=space, values=coloured,
    )
    runner = Runner(threads, device, memory, progress)
    outputs = Outputs(_outputs_for(out, len(lods)), runner.state, compress)
    results = _mesh_run("iw_mesh_volume", opened, coloured, options, runner, outputs, len(lods))
    return results if lods or isinstance(out, (list, tuple)) else results[0]


def _mesh_run(
    name: str, volume: Volume, values: Volume | None, options: c.MeshOptions, runner: Runner, outputs: Outputs, levels: int
) -> list[Any]:
    def run() -> list[Any]:
        facts = runner.call(
            name, volume._handle.pointer, ctypes.byref(options), runner.pointer(), outputs.structs, len(outputs)
        )
        return outputs.results(_level_reports(Report(facts), levels))

    if values is None:
        return volume._finish(run)  # type: ignore[no-any-return]
    return values._finish(lambda: volume._finish(run))  # type: ignore[no-any-return]


def labels(
    volume: VolumeLike,
    labels: Literal["all"] | Iterable[int] = "all",
    *,
    error: Length = "0.2vox",
    smooth: int = 4,
    extractor: Extractor = "cubes",
    max_distance: Length | None = None,
    quality: Quality = "normal",
    closed: bool = True,
    specks: Literal["keep", "drop"] = "keep",
    normals: Literal[None, "gradient"] = None,
    spacing: Triple | float | None = None,
    origin: Triple | None = None,
    direction: npt.ArrayLike | None = None,
    affine: npt.ArrayLike | None = None,
    unit: str | None = None,
    space: Literal[None, "lps", "ras", "index"] = None,
    axes: str | None = None,
    channel: int | None = None,
    time: int | None = None,
    scalars: str | None = None,
    roi: Roi | None = None,
    out: str | os.PathLike[str] | Callable[[int, Mesh], Any] | None = None,
    threads: int = 0,
    progress: ProgressLike = None,
) -> Mapping[int, Any]:
    """A closed surface for each label of a label map, in one sweep: the meshes of ``isoweave mesh --labels``.

    Args:
        volume: whole numbers; see :func:`open_volume`.
        labels: "all" (but 0, the background), or numbers. One that does not occur gives an empty mesh.
        smooth: passes that take the staircase off; 0: none.
        out: None: the meshes are returned. A path: ``seg.ply`` becomes ``seg_label1.ply``, ... A function: it gets each
            label and its mesh.
        others: as :func:`mesh`.

    Returns:
        A mapping from labels to meshes; to reports with a path; to what the function returned.

    Raises:
        BadInput: for a volume that is no label map, and where no label but 0 occurs.
        ValueError, CannotWrite, KeyboardInterrupt, Stopped: as :func:`mesh`.

    >>> import numpy as np
    >>> cells = np.zeros((20, 20, 20), np.uint8)
    >>> cells[4:10, 4:16, 4:16] = 1
    >>> cells[10:16, 4:16, 4:16] = 2
    >>> sorted(isoweave.labels(cells))
    [1, 2]
    """
    opened = _volume_for(
        volume, roi, 1, spacing=spacing, origin=origin, direction=direction, affine=affine, unit=unit, axes=axes,
        channel=channel, time=time, scalars=scalars,
    )
    wanted = list(opened.find_labels()) if isinstance(labels, str) else [int(label) for label in labels]
    if isinstance(labels, str) and labels != "all":
        raise ValueError(f"labels: expected 'all' or numbers, found {labels!r}")
    if not wanted:
        raise c.BadInput("labels: expected a label other than 0, found none")
    simplify_options = simplify_struct(
        error=error, lods=(), max_distance=max_distance, triangles=None, ratio=None, quality=quality, specks=specks
    )
    options = mesh_struct(
        simplify_options, iso=0.5, closed=closed, smooth=smooth, extractor=extractor, normals=normals, space=space
    )
    runner = Runner(threads, "auto", None, progress)
    to_files = isinstance(out, (str, os.PathLike))
    paths: list[OutputLike] = [label_path(out, label) if to_files else None for label in wanted]  # type: ignore[arg-type]
    outputs = Outputs(paths, runner.state, labels=wanted)

    def run() -> list[Any]:
        facts = runner.call(
            "iw_mesh_labels", opened._handle.pointer, ctypes.byref(options), runner.pointer(), outputs.structs, len(wanted)
        )
        return outputs.results([Report({**facts, **entry}) for entry in facts["labels"]])

    results = dict(zip(wanted, opened._finish(run)))
    return {label: out(label, each) for label, each in results.items()} if callable(out) else results


def simplify(
    mesh: MeshLike,
    *,
    error: Length | None = None,
    triangles: int | None = None,
    ratio: float | None = None,
    max_distance: Length | None = None,
    quality: Quality = "normal",
    specks: Literal["keep", "drop"] = "keep",
    largest: bool = False,
    min_component: int = 0,
    lods: Sequence[Length] = (),
    out: OutputLike | Sequence[OutputLike] = None,
    compress: bool = False,
    threads: int = 0,
    progress: ProgressLike = None,
) -> Any:
    """Simplifies a triangle mesh by the rules of :func:`mesh`: that of ``isoweave simplify``.

    Args:
        mesh: ``(vertices, faces)``, a :class:`Mesh`, a path, or a mesh of PyVista, VTK, trimesh, meshio or Open3D.
        error, triangles, ratio, max_distance, lods: where to stop; one of them at least. A "vox" is here the root of
            twice the mean area of a triangle.
        others: as :func:`isoweave.mesh`.

    Returns:
        As :func:`isoweave.mesh`. Normals of the input are not kept, values are.

    Raises:
        ValueError: also for faces that refer to no vertex.

    >>> import numpy as np
    >>> z, y, x = np.ogrid[-16:16, -16:16, -16:16]
    >>> full = isoweave.mesh(12.0 - np.sqrt(x * x + y * y + z * z), 0, error=0)
    >>> len(isoweave.simplify(full, triangles=500).faces)
    500
    """
    given = mesh_of(mesh)
    options = simplify_struct(
        error=error, lods=lods, max_distance=max_distance, triangles=triangles, ratio=ratio, quality=quality, specks=specks,
        largest=largest, min_component=min_component,
    )
    runner = Runner(threads, "auto", None, progress)
    outputs = Outputs(_outputs_for(out, len(lods)), runner.state, compress)
    handle = given._handle()
    facts = runner.call(
        "iw_simplify_mesh", handle.pointer, ctypes.byref(options), runner.pointer(), outputs.structs, len(outputs)
    )
    results = outputs.results(_level_reports(Report(facts), len(lods)))
    return results if lods or isinstance(out, (list, tuple)) else results[0]


def check(mesh: MeshLike, *, self_intersections: bool = False, threads: int = 0) -> Check:
    """The invariants of a mesh, by its triangles alone: as ``isoweave check``.

    Args:
        mesh: as :func:`simplify`.
        self_intersections: whether to search for triangles that cross, too.

    Returns:
        A report that is True where the mesh is closed, manifold and oriented.
    """
    return Check(mesh_of(mesh)._check(self_intersections, threads))


def compare(
    a: MeshLike, b: MeshLike, *, samples: int = 500_000, per_vertex: bool = False, threads: int = 0
) -> Comparison:
    """Distances between two meshes, both ways, in the unit of `a`: as ``isoweave compare``.

    Args:
        a, b: as :func:`simplify`. Where both say their unit and space, b is brought to those of a.
        samples: points on each mesh, uniform by area.
        per_vertex: whether to find the distance of every vertex of a to b, too: ``.distances``.

    Returns:
        ``mean``, ``rms`` and ``max``, and ``a_to_b``, ``b_to_a`` with the same of each way.
    """
    first, second = mesh_of(a), mesh_of(b)
    distances = np.empty(len(first.vertices), np.float32) if per_vertex else None
    options = c.CompareOptions(samples=samples, threads=threads)
    if distances is not None:
        options.distances = distances.ctypes.data_as(ctypes.POINTER(ctypes.c_float))
    handles = first._handle(), second._handle()
    facts = c.call("iw_compare_meshes", handles[0].pointer, handles[1].pointer, ctypes.byref(options))
    return Comparison({**facts, "distances": distances})


def forecast(
    volume: VolumeLike,
    level: float | None = None,
    *,
    error: Length | None = None,
    triangles: int | None = None,
    max_distance: Length | None = None,
    quality: Quality = "normal",
    inside: Literal["above", "below"] = "above",
    closed: bool = True,
    smooth: int = 0,
    extractor: Extractor = "cubes",
    roi: Roi | None = None,
    step: int = 1,
    threads: int = 0,
    memory: int | str | None = None,
    **opening: Any,
) -> Forecast:
    """What :func:`mesh` would take, from a part of the volume: triangles, bytes and seconds, before the run.

    Args: as :func:`mesh`; what is left goes to :func:`open_volume`.
    """
    opened = _volume_for(volume, roi, step, **opening)
    simplify_options = simplify_struct(
        error=_usual_error(error, [triangles, max_distance]), lods=(), max_distance=max_distance, triangles=triangles,
        ratio=None, quality=quality, specks="keep",
    )
    options = mesh_struct(
        simplify_options, iso=_level_of(opened, level), inside=inside, closed=closed, smooth=smooth, extractor=extractor
    )
    runner = Runner(threads, "auto", memory, None)
    return Forecast(
        opened._finish(
            lambda: runner.call("iw_forecast", opened._handle.pointer, ctypes.byref(options), runner.pointer())
        )
    )


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
    opened = _volume_for(volume, roi, step, **opening)
    simplify_options = simplify_struct(
        error=_usual_error(error, [triangles, max_distance]), lods=(), max_distance=max_distance, triangles=triangles,
        ratio=None, quality=quality, specks="keep",
    )
    options = mesh_struct(
        simplify_options, iso=_level_of(opened, level), inside=inside, closed=closed, smooth=smooth, extractor=extractor
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
