"""Surfaces of the labels of a label map."""

from __future__ import annotations

import ctypes
import os
from typing import TYPE_CHECKING, Any, Callable, Iterable, Literal, Mapping, TypeVar, Union, overload

import numpy.typing as npt

from . import _library as c
from ._mesh import Mesh
from ._options import Extractor, Length, Quality, mesh_struct, simplify_struct, usual_error
from ._outputs import OutputLike, Outputs, label_path
from ._report import Report
from ._run import ProgressLike, Runner
from ._volume import Roi, Triple, VolumeLike, volume_for

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._settings import LabelSettings

Which = Union[Literal["all"], Iterable[int]]
Result = TypeVar("Result")


@overload
def labels(
    volume: VolumeLike, labels: Which = "all", *, out: None = None, **options: Unpack[LabelSettings]
) -> Mapping[int, Mesh]: ...
@overload
def labels(
    volume: VolumeLike, labels: Which = "all", *, out: str | os.PathLike[str], **options: Unpack[LabelSettings]
) -> Mapping[int, Report]: ...
@overload
def labels(
    volume: VolumeLike, labels: Which = "all", *, out: Callable[[int, Mesh], Result], **options: Unpack[LabelSettings]
) -> Mapping[int, Result]: ...
def labels(
    volume: VolumeLike,
    labels: Which = "all",
    *,
    error: Length | None = None,
    triangles: int | None = None,
    ratio: float | None = None,
    max_distance: Length | None = None,
    smooth: int = 4,
    extractor: Extractor = "cubes",
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
        triangles: stop at this number for each label.
        ratio: stop at this part of each label's triangles.
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
    opened = volume_for(
        volume, roi, 1, spacing=spacing, origin=origin, direction=direction, affine=affine, unit=unit, axes=axes,
        channel=channel, time=time, scalars=scalars,
    )
    wanted = list(opened.find_labels()) if isinstance(labels, str) else [int(label) for label in labels]
    if isinstance(labels, str) and labels != "all":
        raise ValueError(f"labels: expected 'all' or numbers, found {labels!r}")
    if not wanted:
        raise c.BadInput("labels: expected a label other than 0, found none")
    simplify_options = simplify_struct(
        error=usual_error(error, [triangles, ratio, max_distance]), lods=(), max_distance=max_distance,
        triangles=triangles, ratio=ratio, quality=quality, specks=specks,
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
