#!/usr/bin/env python3
"""Reads STL, PLY and OBJ files as VTK writes them, and compares their triangles with those that VTK holds, bit for bit
where the format keeps them.

    tests/oracles/mesh_files.py build/release/isoweave

Exits with 77, which means skipped, where NumPy or VTK for Python is missing.
"""
import os
import subprocess
import sys
import tempfile

from meshes import canonical, of_poly_data, with_vtk
from oracle import Oracle

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkTriangleFilter
from vtkmodules.vtkFiltersSources import vtkCylinderSource, vtkPlaneSource, vtkSphereSource
from vtkmodules.vtkIOGeometry import vtkOBJWriter, vtkSTLWriter
from vtkmodules.vtkIOPLY import vtkPLYReader, vtkPLYWriter


def output_of(source):
    source.Update()
    return source.GetOutput()


def triangles_of(data):
    """Polygons as fans over their first corners."""
    points = vtk_to_numpy(data.GetPoints().GetData()).astype(np.float32)
    fans = []
    for n in range(data.GetNumberOfCells()):
        corners = [data.GetCell(n).GetPointId(i) for i in range(data.GetCell(n).GetNumberOfPoints())]
        fans += [[corners[0], b, c] for b, c in zip(corners[1:], corners[2:])]
    return canonical(points[np.array(fans)])


class MeshFiles:
    def __init__(self, program, folder):
        self.oracle, self.folder = Oracle(program), folder

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, writer, name, data, *setters):
        writer.SetInputData(data)
        writer.SetFileName(self.path(name))
        for setter in setters:
            getattr(writer, setter)()
        assert writer.Write() == 1, name

    def read(self, name):
        """What isoweave holds of a mesh: `compare` writes it with the distances to the mesh itself."""
        path, copy = self.path(name), self.path("copy.ply")
        done = subprocess.run(
            [self.oracle.program, "compare", path, path, "--samples", "1", "--distances", copy],
            capture_output=True, text=True, check=True,
        )
        return canonical(of_poly_data(with_vtk(vtkPLYReader(), copy))), done.stderr

    def same(self, name, data, told="", tolerance=0.0):
        found, said = self.read(name)
        expected = triangles_of(data)
        self.oracle.expect_equal(found.shape, expected.shape, f"{name}: triangles")
        if found.shape == expected.shape:
            worst = np.abs(found - expected).max()
            self.oracle.expect(worst <= tolerance, f"{name}: off by {worst}")
        self.oracle.expect(told in said and (told or not said), f"{name}: said '{said}', expected '{told}'")

    def stl(self, data):
        """STL in text has six digits or so."""
        self.write(vtkSTLWriter(), "a.stl", data, "SetFileTypeToASCII")
        self.same("a.stl", data, tolerance=1e-5)
        self.write(vtkSTLWriter(), "b.stl", data, "SetFileTypeToBinary")
        self.same("b.stl", data)

    def ply(self, data, told="", colours=None):
        for encoding in ("SetFileTypeToASCII", "SetFileTypeToBinary"):
            for order in ("SetDataByteOrderToLittleEndian", "SetDataByteOrderToBigEndian"):
                writer = vtkPLYWriter()
                if colours:
                    writer.SetArrayName(colours)
                self.write(writer, "a.ply", data, encoding, order)
                self.same("a.ply", data, told, 1e-5 if "ASCII" in encoding else 0.0)

    def obj(self, data, told):
        self.write(vtkOBJWriter(), "a.obj", data)
        self.same("a.obj", data, told, 1e-5)

    def run(self):
        sphere = vtkSphereSource()
        sphere.SetThetaResolution(17)
        sphere.SetPhiResolution(11)
        sphere.SetCenter(3.3, -20.7, 0.1)
        sphere = output_of(sphere)
        cylinder = vtkCylinderSource()
        cylinder.SetResolution(9)
        cylinder = output_of(cylinder)
        plane = vtkPlaneSource()
        plane.SetResolution(7, 5)
        plane = output_of(plane)
        self.stl(triangulated(sphere))
        self.stl(triangulated(plane))
        self.ply(sphere)
        self.ply(plane, "not kept: u, v")
        self.obj(sphere, "")
        self.obj(plane, "not kept: texture coordinates")
        self.obj(cylinder, "not kept: texture coordinates")
        colours = numpy_to_vtk((np.arange(3 * plane.GetNumberOfPoints()) % 251).astype(np.uint8).reshape(-1, 3), deep=1)
        colours.SetName("colour")
        plane.GetPointData().AddArray(colours)
        self.ply(plane, "red, green, blue", "colour")
        self.oracle.finish()


def triangulated(data):
    triangulate = vtkTriangleFilter()
    triangulate.SetInputData(data)
    return output_of(triangulate)


def main():
    with tempfile.TemporaryDirectory() as folder:
        MeshFiles(os.path.abspath(sys.argv[1]), folder).run()


if __name__ == "__main__":
    main()
