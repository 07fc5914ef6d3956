"""isoweave on PyVista's datasets: ``grid.isoweave.contour(300)``. PyVista finds this module by its entry point."""

from __future__ import annotations

from typing import Any

import pyvista

import isoweave

from ._mesh import Mesh
from ._report import Check, Comparison


def _surface(mesh: Mesh) -> Any:
    surface = mesh.to_pyvista()
    surface.field_data["isoweave digest"] = [mesh.digest]
    return surface


@pyvista.register_dataset_accessor("isoweave", pyvista.ImageData)
class ImageAccessor:
    """Surfaces of an image."""

    def __init__(self, dataset: Any) -> None:
        self._dataset = dataset

    def contour(self, level: Any = None, **options: Any) -> Any:
        """The simplified surface at a level as ``PolyData``; at several levels, or with ``lods``, a ``MultiBlock``.

        Options: those of :func:`isoweave.mesh`.
        """
        meshes: Any = isoweave.mesh(self._dataset, level, **options)
        if isinstance(meshes, Mesh):
            return _surface(meshes)
        blocks = pyvista.MultiBlock()
        for mesh, name in zip(meshes, options.get("lods", level)):
            blocks.append(_surface(mesh), str(name))
        return blocks

    def labels(self, labels: Any = "all", **options: Any) -> Any:
        """A surface for each label as a ``MultiBlock``. Options: those of :func:`isoweave.labels`."""
        blocks = pyvista.MultiBlock()
        for label, mesh in isoweave.labels(self._dataset, labels, **options).items():
            blocks.append(_surface(mesh), str(label))
        return blocks


@pyvista.register_dataset_accessor("isoweave", pyvista.PolyData)
class SurfaceAccessor:
    """Simplification and measures of a surface of triangles."""

    def __init__(self, dataset: Any) -> None:
        self._dataset = dataset

    def simplify(self, **options: Any) -> Any:
        """The simplified surface as ``PolyData``. Options: those of :func:`isoweave.simplify`."""
        return _surface(isoweave.simplify(self._dataset, **options))

    def check(self, **options: Any) -> Check:
        """As :func:`isoweave.check`."""
        return isoweave.check(self._dataset, **options)

    def compare(self, other: Any, **options: Any) -> Comparison:
        """Distances to another surface, as :func:`isoweave.compare`."""
        return isoweave.compare(self._dataset, other, **options)
