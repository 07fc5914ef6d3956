"""The surface of a volume, at one level or at several."""

from __future__ import annotations

import ctypes
import os
from typing import TYPE_CHECKING, Any, Literal, Sequence, Union, overload

import numpy as np
import numpy.typing as npt

from . import _library as c
from ._mesh import Mesh
from ._options import Extractor, Length, Quality, mesh_struct, simplify_struct, usual_error
from ._outputs import OutputLike, Outputs, Sink, iso_path, level_outputs, level_reports, outputs_for
from ._report import Report
from ._run import ProgressLike, Runner
from ._volume import Roi, Triple, Volume, VolumeLike, level_of, volume_for

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._settings import MeshSettings

Levels = Union[Sequence[float], "npt.NDArray[Any]"]


@overload
def mesh(volume: VolumeLike, level: float | None = None, *, out: None = None, **options: Unpack[MeshSettings]) -> Mesh: ...
@overload
def mesh(
    volume: VolumeLike, level: float | None = None, *, out: str | os.PathLike[str] | Sink, **options: Unpack[MeshSettings]
) -> Report: ...
@overload
def mesh(
    volume: VolumeLike,
    level: float | None = None,
    *,
    lods: Sequence[Length],
    out: None = None,
    **options: Unpack[MeshSettings],
) -> list[Mesh]: ...
@overload
def mesh(
    volume: VolumeLike,
    level: float | None = None,
    *,
    lods: Sequence[Length],
    out: str | os.PathLike[str],
    **options: Unpack[MeshSettings],
) -> list[Report]: ...
@overload
def mesh(volume: VolumeLike, level: Levels, *, out: None = None, **options: Unpack[MeshSettings]) -> list[Mesh]: ...
@overload
def mesh(
    volume: VolumeLike, level: Levels, *, out: str | os.PathLike[str], **options: Unpack[MeshSettings]
) -> list[Report]: ...
@overload
def mesh(
    volume: VolumeLike,
    level: float | Levels | None = None,
    *,
    lods: Sequence[Length] = (),
    out: list[Any] | tuple[Any, ...],
    **options: Unpack[MeshSettings],
) -> list[Any]: ...
def mesh(
    volume: VolumeLike,
    level: float | Levels | None = None,
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
    checkpoint: str | os.PathLike[str] | None = None,
    resume: bool = False,
    every: float | str = 300,
    progress: ProgressLike = None,
) -> Any:
    """The simplified surface of a volume at a level: bit for bit that of ``isoweave mesh``.

    The volume is read slab by slab, and never as a whole. Arrays are ``(z, y, x)``, everything physical is
    ``(x, y, z)``.

    Args:
        volume: an array, an image, a path, or a :class:`Volume`; see :func:`open_volume`.
        level: the value at the surface. Several: a surface for each, from one reading of the volume, each the mesh of
            its own run. None: Otsu's threshold, from a pass over the volume of its own; the report's ``iso`` says which
            it was.
        error: how far simplification may go: ``"0.2vox"``, ``"50um"``, ``"0.1%"`` of the volume's diagonal, or a
            number in the volume's unit; 0: the full surface. None: "0.2vox", unless ``triangles``, ``ratio``, ``max_distance`` or ``lods`` says where to stop.
            "inf" beside ``max_distance``: the fewest triangles within it; beside a number: no bound.
        triangles: stop at this number.
        ratio: stop at this part of the full surface's triangles.
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
            ``a_lod0.ply``, ..., with several levels ``a_iso10.ply``, ...; or a list of outputs.
        compress: pack a .glb or .precomputed file, with rounding.
        memory: cap on the memory of the process, in bytes or as "2G". A mesh that is returned is not counted.
        threads: 0: one for each processor. Never changes the mesh.
        device: "cuda" for a CUDA device, where this build has one.
        checkpoint: a folder in which the state of the run is saved, with ``out`` a path: a run that is stopped by Ctrl-C,
            or killed, can go on. It is made where it is missing, and a run that is done leaves nothing in it.
        resume: go on from the state in that folder, with the same volume and options, or begin where there is none; the
            report's ``resumed_at`` says at which layer. Without it an unfinished run in the folder is refused.
        every: how often a state is saved: seconds, or as "5min", "2h" or "16layers".
        progress: True: a bar of tqdm, or one line on standard error. A function that gets a :class:`Progress` after
            every slab, in the thread that calls; False from it stops the run.

    Returns:
        A :class:`Mesh`, or with ``lods`` or several levels a list of them; with ``out`` a :class:`Report`, or a list of
        them. Several levels do not go with lods, largest, min_component, values, memory, checkpoint and a device.

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
    >>> [len(each.faces) < 1000 for each in isoweave.mesh(12.0 - np.sqrt(x * x + y * y + z * z), [0, 2, 4])]
    [True, True, True]
    """
    opened = volume_for(
        volume, roi, step, spacing=spacing, origin=origin, direction=direction, affine=affine, unit=unit, axes=axes,
        channel=channel, time=time, scalars=scalars,
    )
    coloured = None if values is None else volume_for(values, roi, step)
    simplify_options = simplify_struct(
        error=usual_error(error, [triangles, ratio, max_distance, lods]), lods=lods, max_distance=max_distance,
        triangles=triangles, ratio=ratio, quality=quality, specks=specks, largest=largest, min_component=min_component,
    )
    isos = _isos(level, lods)
    options = mesh_struct(
        simplify_options, iso=level_of(opened, level) if isos is None else 0.0, inside=inside, closed=closed, smooth=smooth,
        extractor=extractor, normals=normals, space=space, values=coloured,
    )
    runner = Runner(threads, device, memory, progress)
    runner.save_in(checkpoint, resume, every)
    if isos is not None:
        names = outputs_for(out, len(isos), lambda path, n: iso_path(path, isos[n]))
        outputs = Outputs(names, runner.state, compress, isos=isos)
        facts = _run("iw_mesh_isos", opened, coloured, options, runner, outputs)
        return outputs.results([Report({**facts, **entry}) for entry in facts["isos"]])
    outputs = Outputs(level_outputs(out, len(lods)), runner.state, compress)
    facts = _run("iw_mesh_volume", opened, coloured, options, runner, outputs)
    results = outputs.results(level_reports(Report(facts), len(lods)))
    return results if lods or isinstance(out, (list, tuple)) else results[0]


def _isos(level: float | Levels | None, lods: Sequence[Length]) -> list[float] | None:
    """The levels where they are several, or a list of one; None for one."""
    if level is None or np.ndim(level) == 0:
        return None
    if lods:
        raise ValueError("lods: expected one level, found several")
    return [float(each) for each in np.asarray(level)]


def _run(
    name: str, volume: Volume, values: Volume | None, options: c.MeshOptions, runner: Runner, outputs: Outputs
) -> Any:
    def run() -> Any:
        return runner.call(
            name, volume._handle.pointer, ctypes.byref(options), runner.pointer(), outputs.structs, len(outputs)
        )

    return volume._finish(run) if values is None else values._finish(lambda: volume._finish(run))
