"""isoweave on PyVista's datasets: ``grid.isoweave.contour(300)``. PyVista finds this module by its entry point."""

from __future__ import annotations

from typing import Any

import pyvista

from . import _api
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

    def contour(self, level: float | None = None, **options: Any) -> Any:
        """The simplified surface at a level as ``PolyData``. Options: those of :func:`isoweave.mesh`."""
        return _surface(_api.mesh(self._dataset, level, **options))

    def labels(self, labels: Any = "all", **options: Any) -> Any:
        """A surface for each label as a ``MultiBlock``. Options: those of :func:`isoweave.labels`."""
        blocks = pyvista.MultiBlock()
        for label, mesh in _api.labels(self._dataset, labels, **options).items():
            blocks.append(_surface(mesh), str(label))
        return blocks


@pyvista.register_dataset_accessor("isoweave", pyvista.PolyData)
class SurfaceAccessor:
    """Simplification and measures of a surface of triangles."""

    def __init__(self, dataset: Any) -> None:
        self._dataset = dataset

    def simplify(self, **options: Any) -> Any:
        """The simplified surface as ``PolyData``. Options: those of :func:`isoweave.simplify`."""
        return _surface(_api.simplify(self._dataset, **options))

    def check(self, **options: Any) -> Check:
        """As :func:`isoweave.check`."""
        return _api.check(self._dataset, **options)

    def compare(self, other: Any, **options: Any) -> Comparison:
        """Distances to another surface, as :func:`isoweave.compare`."""
        return _api.compare(self._dataset, other, **options)
