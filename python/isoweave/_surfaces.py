"""What is done with meshes: they are simplified, checked and compared."""

from __future__ import annotations

import ctypes
import os
from typing import TYPE_CHECKING, Any, Literal, Sequence, overload

import numpy as np

from . import _library as c
from ._mesh import Mesh, MeshLike, mesh_of
from ._options import Length, Quality, simplify_struct
from ._outputs import OutputLike, Outputs, Sink, level_outputs, level_reports
from ._report import Check, Comparison, Report
from ._run import ProgressLike, Runner

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._settings import StopSettings


@overload
def simplify(mesh: MeshLike, *, out: None = None, **options: Unpack[StopSettings]) -> Mesh: ...
@overload
def simplify(mesh: MeshLike, *, out: str | os.PathLike[str] | Sink, **options: Unpack[StopSettings]) -> Report: ...
@overload
def simplify(mesh: MeshLike, *, lods: Sequence[Length], out: None = None, **options: Unpack[StopSettings]) -> list[Mesh]: ...
@overload
def simplify(
    mesh: MeshLike, *, lods: Sequence[Length], out: str | os.PathLike[str], **options: Unpack[StopSettings]
) -> list[Report]: ...
@overload
def simplify(
    mesh: MeshLike, *, lods: Sequence[Length] = (), out: list[Any] | tuple[Any, ...], **options: Unpack[StopSettings]
) -> list[Any]: ...
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
    outputs = Outputs(level_outputs(out, len(lods)), runner.state, compress)
    handle = given._handle()
    facts = runner.call(
        "iw_simplify_mesh", handle.pointer, ctypes.byref(options), runner.pointer(), outputs.structs, len(outputs)
    )
    results = outputs.results(level_reports(Report(facts), len(lods)))
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
