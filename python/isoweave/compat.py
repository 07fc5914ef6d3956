"""Drop-ins for functions of other packages."""

from __future__ import annotations

from typing import Any, Literal, Sequence

import numpy as np
import numpy.typing as npt

from ._meshing import mesh
from ._options import Length
from ._volume import VolumeLike, open_volume


def marching_cubes(
    volume: VolumeLike,
    level: float | None = None,
    *,
    spacing: Sequence[float] = (1.0, 1.0, 1.0),
    gradient_direction: Literal["descent", "ascent"] = "descent",
    step_size: int = 1,
    error: Length = 0,
    **options: Any,
) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.int32], npt.NDArray[np.float32], npt.NDArray[np.float32]]:
    """``skimage.measure.marching_cubes`` by isoweave: with ``error``, the simplified surface in the same call.

    Everything is in scikit-image's order: ``spacing`` and vertices are those of the array's axes (z, y, x).

    Args:
        volume: as :func:`isoweave.open_volume`; read slab by slab.
        level: the value at the surface; None: the mean of the least and the largest value.
        spacing: distances of samples along the axes of the array.
        gradient_direction: "descent": objects are brighter than what is around them; "ascent": darker.
        step_size: means of blocks of so many samples. scikit-image takes every step_size-th sample.
        error: how far simplification may go, as :func:`isoweave.mesh`; 0: the full surface.
        options: more options of :func:`isoweave.mesh`, such as ``closed=True``. The surface is open at the border of the
            volume without it, as in scikit-image.

    Returns:
        vertices (n, 3) float32, faces (m, 3) int32, normals (n, 3) float32, and values (n,) float32: the level, which is
        where isoweave's vertices lie. As in scikit-image, normals point to the side of smaller values, and faces are
        clockwise seen from outside where the axes of the array are taken for those of a right-handed world.

    >>> import numpy as np
    >>> z, y, x = np.ogrid[-16:16, -16:16, -16:16]
    >>> verts, faces, normals, values = marching_cubes(12.0 - np.sqrt(x * x + y * y + z * z), 0, spacing=(2, 1, 1))
    >>> verts.max(axis=0).round().tolist()
    [56.0, 28.0, 28.0]
    """
    if gradient_direction not in ("descent", "ascent"):
        raise ValueError(f"gradient_direction: expected 'descent' or 'ascent', found {gradient_direction!r}")
    opened = open_volume(volume, spacing=tuple(spacing)[::-1])
    if level is None:
        edges = opened.histogram()[1]
        level = float(0.5 * edges[0] + 0.5 * edges[-1])
    options.setdefault("closed", False)
    inside: Literal["above", "below"] = "above" if gradient_direction == "descent" else "below"
    surface = mesh(
        opened, level, error=error, inside=inside, step=step_size, normals="gradient", space="index", **options
    )
    vertices = np.ascontiguousarray(surface.vertices[:, ::-1], dtype=np.float32)
    faces = np.ascontiguousarray(surface.faces, dtype=np.int32)
    falling = 1 if inside == "above" else -1
    normals = np.ascontiguousarray(falling * surface.normals[:, ::-1], dtype=np.float32)
    return vertices, faces, normals, np.full(len(vertices), level, np.float32)
