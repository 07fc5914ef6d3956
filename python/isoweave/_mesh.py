"""Triangle meshes in memory."""

from __future__ import annotations

import ctypes
import html
import os
import pathlib
import tempfile
from typing import Any, Iterator, Union

import numpy as np
import numpy.typing as npt

from . import _library as c
from ._report import Report

Floats = npt.NDArray[np.floating[Any]]
Faces = npt.NDArray[np.integer[Any]]
MeshLike = Union["Mesh", "tuple[Any, Any]", str, "os.PathLike[str]", Any]


class _Memory:
    """Memory of a mesh of the C interface, as numpy's interface for arrays has it. Arrays of it keep the mesh."""

    def __init__(self, handle: c.Handle, address: int, shape: tuple[int, ...], type_name: str) -> None:
        self._handle = handle
        self.__array_interface__ = {"version": 3, "data": (address, False), "shape": shape, "typestr": type_name}


def _view(handle: c.Handle, address: int | None, shape: tuple[int, ...], type_name: str) -> npt.NDArray[Any]:
    if not address:
        return np.empty(shape, np.dtype(type_name))
    return np.asarray(_Memory(handle, address, shape, type_name))


class Mesh:
    """A triangle mesh: ``vertices, faces = mesh``.

    Attributes:
        vertices: (n, 3) coordinates (x, y, z): float32. They are float64 where the mesh lies so far from the origin that
            32 bits would lose its shape; ``offset`` is not 0 then.
        faces: (m, 3) indices of vertices, counter-clockwise seen from outside: int32, or int64 from 2^31 vertices on.
        normals: (n, 3) unit normals, float32, or None.
        values: (n,) numbers at the vertices, float32, or None.
        report: of the run that made the mesh; empty for other meshes.
        unit: of the coordinates, "" where it is not said.
        space: meaning of the axes: "LPS", "RAS", "index" or "".
        offset: what coordinates were relative to when they were rounded to 32 bits; (0, 0, 0) mostly.

    The arrays own their memory, or share it with nothing but this mesh.
    """

    def __init__(
        self,
        vertices: npt.ArrayLike,
        faces: npt.ArrayLike,
        *,
        normals: npt.ArrayLike | None = None,
        values: npt.ArrayLike | None = None,
        unit: str = "",
        space: str = "",
        report: Report | None = None,
        offset: tuple[float, float, float] | None = None,
    ) -> None:
        self.vertices: Floats = _points("vertices", vertices)
        self.faces: Faces = _corners(faces)
        self.normals: Floats | None = None if normals is None else _points("normals", normals)
        self.values: Floats | None = None if values is None else np.asarray(values, dtype=np.float32)
        self.unit = unit
        self.space = space
        self.report = Report({}) if report is None else report
        self.offset = _offset_for(self.vertices, self.faces) if offset is None else offset

    def __iter__(self) -> Iterator[Any]:
        yield self.vertices
        yield self.faces

    def __repr__(self) -> str:
        return f"Mesh({len(self.vertices)} vertices, {len(self.faces)} triangles, digest {self.digest})"

    @property
    def digest(self) -> str:
        """16 hexadecimal digits that depend on the triangles alone, as the command line prints them."""
        return str(self.report["digest"] if "digest" in self.report else self._check(False)["digest"])

    def save(self, path: str | os.PathLike[str], *, compress: bool = False) -> None:
        """Writes a mesh file in the format of the name's ending: complete, or not at all.

        Raises:
            CannotWrite: for another ending, and where the file cannot be written.
        """
        handle = self._handle()
        c.call("iw_write_mesh", handle.pointer, os.fsencode(path), int(compress))

    def to_pyvista(self) -> Any:
        """A ``pyvista.PolyData`` of the same arrays, with ``Normals`` and ``value`` where the mesh has them."""
        import pyvista

        surface = pyvista.PolyData.from_regular_faces(self.vertices, self.faces, deep=False)
        if self.normals is not None:
            surface.point_data.active_normals = self.normals
        if self.values is not None:
            surface.point_data["value"] = self.values
        return surface

    def to_vtk(self) -> Any:
        """A ``vtkPolyData`` of the same arrays."""
        from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
        from vtkmodules.vtkCommonCore import vtkPoints
        from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

        surface, points, cells = vtkPolyData(), vtkPoints(), vtkCellArray()
        points.SetData(numpy_to_vtk(np.ascontiguousarray(self.vertices), deep=True))
        surface.SetPoints(points)
        offsets = np.arange(0, 3 * len(self.faces) + 1, 3, dtype=np.int64)
        cells.SetData(
            numpy_to_vtkIdTypeArray(offsets, deep=True),
            numpy_to_vtkIdTypeArray(np.ascontiguousarray(self.faces, dtype=np.int64).ravel(), deep=True),
        )
        surface.SetPolys(cells)
        for name, array in (("Normals", self.normals), ("value", self.values)):
            if array is not None:
                data = numpy_to_vtk(np.ascontiguousarray(array), deep=True)
                data.SetName(name)
                surface.GetPointData().AddArray(data)
        if self.normals is not None:
            surface.GetPointData().SetActiveNormals("Normals")
        return surface

    def to_trimesh(self) -> Any:
        """A ``trimesh.Trimesh`` with the very vertices and faces."""
        import trimesh

        return trimesh.Trimesh(self.vertices, self.faces, vertex_normals=self.normals, process=False)

    def to_meshio(self) -> Any:
        """A ``meshio.Mesh``."""
        import meshio

        values = {} if self.values is None else {"value": self.values}
        return meshio.Mesh(self.vertices, [("triangle", self.faces)], point_data=values)

    def to_open3d(self) -> Any:
        """An ``open3d.geometry.TriangleMesh``."""
        import open3d

        mesh = open3d.geometry.TriangleMesh(
            open3d.utility.Vector3dVector(self.vertices.astype(np.float64)),
            open3d.utility.Vector3iVector(self.faces.astype(np.int32)),
        )
        if self.normals is not None:
            mesh.vertex_normals = open3d.utility.Vector3dVector(self.normals.astype(np.float64))
        return mesh

    def to_napari(self) -> tuple[Any, ...]:
        """The data of a surface layer of napari, whose axes are (z, y, x)."""
        data = (self.vertices[:, ::-1], self.faces[:, ::-1])
        return data if self.values is None else (*data, self.values)

    def _repr_html_(self) -> str:
        """The page of ``isoweave view`` in a notebook, or a line where this build has no page."""
        from .__main__ import run_program

        line = f"<p>{html.escape(repr(self))}</p>"
        with tempfile.TemporaryDirectory() as folder:
            mesh, page = pathlib.Path(folder) / "mesh.ply", pathlib.Path(folder) / "mesh.html"
            if not len(self.faces):
                return line
            self.save(mesh)
            if run_program(["view", str(mesh), "-o", str(page), "--quiet"]).returncode != 0:
                return line
            text = html.escape(page.read_text(encoding="utf-8"), quote=True)
        return f'{line}<iframe srcdoc="{text}" width="100%" height="520" style="border:0"></iframe>'

    def _check(self, self_intersections: bool, threads: int = 0) -> dict[str, Any]:
        handle = self._handle()
        facts: dict[str, Any] = c.call("iw_check_mesh", handle.pointer, int(self_intersections), threads)
        return facts

    def _handle(self) -> c.Handle:
        """The mesh for the C interface: a copy."""
        offset = np.array(self.offset)
        points = np.ascontiguousarray(self.vertices - offset if offset.any() else self.vertices, dtype=np.float32)
        faces = self.faces
        if len(faces) and (faces.min() < 0 or faces.max() >= len(points)):
            raise ValueError(f"faces: expected indices below {len(points)}, found {faces.min()} to {faces.max()}")
        corners = np.ascontiguousarray(faces, dtype=np.uint32)
        arrays = c.MeshArrays(
            vertices=len(points),
            triangles=len(corners),
            points=points.ctypes.data,
            corners=corners.ctypes.data,
            offset=tuple(offset),
            unit=c.encoded(self.unit),
            space=c.encoded(self.space),
        )
        extra = [
            _attribute("normals", self.normals, (len(points), 3)),
            _attribute("values", self.values, (len(points),)),
        ]
        arrays.normals, arrays.values = (None if array is None else array.ctypes.data for array in extra)
        return c.made("iw_mesh_from_arrays", "iw_free_mesh", ctypes.byref(arrays))[0]


def _attribute(name: str, array: Floats | None, shape: tuple[int, ...]) -> npt.NDArray[np.float32] | None:
    if array is None:
        return None
    if array.shape != shape:
        raise ValueError(f"{name}: expected shape {shape}, found {array.shape}")
    return np.ascontiguousarray(array, dtype=np.float32)


def _points(name: str, points: npt.ArrayLike) -> Floats:
    array = np.asarray(points)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"{name}: expected shape (n, 3), found {array.shape}")
    if array.dtype.kind not in "fiu":
        raise ValueError(f"{name}: expected numbers, found {array.dtype}")
    if array.dtype.name not in ("float32", "float64"):
        array = array.astype(np.float64)
    return array


def _corners(faces: npt.ArrayLike) -> Faces:
    array = np.asarray(faces)
    if array.size == 0:
        return np.empty((0, 3), np.int32)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"faces: expected triangles, of shape (m, 3), found {array.shape}")
    if array.dtype.kind not in "iu":
        raise ValueError(f"faces: expected whole numbers, found {array.dtype}")
    return array


def _offset_for(vertices: Floats, faces: Faces) -> tuple[float, float, float]:
    """An offset where coordinates of 64 bits, rounded to 32, would move by more than a thousandth of the root of twice
    the mean area of a triangle, as for mesh files."""
    if vertices.dtype != np.float64 or not len(vertices) or not len(faces) or not np.all(np.isfinite(vertices)):
        return 0.0, 0.0, 0.0
    if faces.min() < 0 or faces.max() >= len(vertices):
        return 0.0, 0.0, 0.0
    moved = np.abs(vertices - vertices.astype(np.float32)).max()
    a, b, d = (vertices[faces[:, corner]] for corner in range(3))
    area = 0.5 * np.linalg.norm(np.cross(b - a, d - a), axis=1).mean()
    if moved <= 1e-3 * np.sqrt(2 * area):
        return 0.0, 0.0, 0.0
    x, y, z = np.round(0.5 * (vertices.min(axis=0) + vertices.max(axis=0)))
    return float(x), float(y), float(z)


def mesh_of_handle(handle: c.Handle, report: Report) -> Mesh:
    """A mesh of the C interface as numpy arrays of its memory."""
    arrays = c.MeshArrays()
    c.call("iw_get_mesh_arrays", handle.pointer, ctypes.byref(arrays))
    n, m = arrays.vertices, arrays.triangles
    x, y, z = arrays.offset
    vertices: Floats = _view(handle, arrays.points, (n, 3), "<f4")
    if x or y or z:
        vertices = vertices + np.array([x, y, z])
    corners = _view(handle, arrays.corners, (m, 3), "<i4" if n < 2**31 else "<u4")
    return Mesh(
        vertices,
        corners if n < 2**31 else corners.astype(np.int64),
        normals=_view(handle, arrays.normals, (n, 3), "<f4") if arrays.normals else None,
        values=_view(handle, arrays.values, (n,), "<f4") if arrays.values else None,
        unit=arrays.unit.decode(),
        space=arrays.space.decode(),
        report=report,
        offset=(x, y, z),
    )


def read_mesh(path: str | os.PathLike[str], *, external: bool = True) -> Mesh:
    """Reads a mesh file of any format of isoweave.

    Raises:
        BadInput: where the file cannot be found or understood.
    """
    handle, report = c.made("iw_read_mesh", "iw_free_mesh", os.fsencode(path), 0 if external else 1)
    mesh = mesh_of_handle(handle, Report({}))
    mesh.report = Report({"notes": report["notes"]})
    return mesh


def _triangles_of_vtk(surface: Any) -> tuple[Any, Any]:
    from vtkmodules.util.numpy_support import vtk_to_numpy

    cells = surface.GetPolys()
    corners = vtk_to_numpy(cells.GetConnectivityArray())
    if surface.GetPoints() is None or len(corners) != 3 * cells.GetNumberOfCells() or cells.GetMaxCellSize() != 3:
        raise ValueError("mesh: expected triangles only, found other cells; .triangulate() makes them")
    return vtk_to_numpy(surface.GetPoints().GetData()), corners.reshape(-1, 3)


def _triangles_of_meshio(mesh: Any) -> tuple[Any, Any]:
    blocks = [block.data for block in mesh.cells if block.type == "triangle"]
    if not blocks:
        raise ValueError("mesh: expected triangles, found none")
    return mesh.points, np.concatenate(blocks)


def mesh_of(mesh: Any) -> Mesh:
    """Anything that is a triangle mesh: (vertices, faces), a path, or a mesh of PyVista, VTK, trimesh, meshio, Open3D."""
    if isinstance(mesh, Mesh):
        return mesh
    if isinstance(mesh, (str, os.PathLike)):
        return read_mesh(mesh)
    if hasattr(mesh, "IsA") and mesh.IsA("vtkPolyData"):
        return Mesh(*_triangles_of_vtk(mesh))
    if hasattr(mesh, "triangles") and hasattr(mesh, "vertices") and hasattr(mesh, "has_triangles"):  # Open3D
        return Mesh(np.asarray(mesh.vertices), np.asarray(mesh.triangles))
    if hasattr(mesh, "vertices") and hasattr(mesh, "faces"):  # trimesh
        return Mesh(np.asarray(mesh.vertices), np.asarray(mesh.faces))
    if hasattr(mesh, "points") and hasattr(mesh, "cells"):
        return Mesh(*_triangles_of_meshio(mesh))
    try:
        vertices, faces = mesh
    except (TypeError, ValueError):
        raise TypeError(f"mesh: expected (vertices, faces), a mesh or a path, found {type(mesh).__name__}") from None
    return Mesh(vertices, faces)
