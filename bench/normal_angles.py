#!/usr/bin/python3
"""Degrees between the normals of a full surface and those of a simplified one: root of the mean square.

    normal_angles.py FULL.vtp SIMPLIFIED.vtp

At 30,000 vertices of the full surface, chosen by a fixed random sequence: the normal there, and the one that the
simplified mesh interpolates at the point that is closest.
"""
import sys

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import reference
from vtkmodules.vtkCommonDataModel import vtkGenericCell, vtkStaticCellLocator
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

POINTS = 30000


def read(path):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(path)
    reader.Update()
    mesh = reader.GetOutput()
    points = vtk_to_numpy(mesh.GetPoints().GetData()).astype(float)
    return mesh, points, vtk_to_numpy(mesh.GetPointData().GetNormals()).astype(float)


def weights(corners, point):
    """Barycentric coordinates, or nothing for a triangle without area."""
    first, second, to = corners[1] - corners[0], corners[2] - corners[0], point - corners[0]
    aa, ab, bb = first @ first, first @ second, second @ second
    pa, pb, area = to @ first, to @ second, aa * bb - ab * ab
    if not area > 0:
        return None
    u, v = (bb * pa - ab * pb) / area, (aa * pb - ab * pa) / area
    return np.array([1 - u - v, u, v])


def main():
    _, full_points, full_normals = read(sys.argv[1])
    mesh, points, normals = read(sys.argv[2])
    triangles = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    locator = vtkStaticCellLocator()
    locator.SetDataSet(mesh)
    locator.BuildLocator()
    cell, number, part, squared = vtkGenericCell(), reference(0), reference(0), reference(0.0)
    angles = []
    for v in np.random.RandomState(1).choice(len(full_points), min(POINTS, len(full_points)), replace=False):
        closest = [0.0, 0.0, 0.0]
        locator.FindClosestPoint(full_points[v], closest, cell, number, part, squared)
        corners = triangles[int(number)]
        at = weights(points[corners], np.array(closest))
        normal = None if at is None else at @ normals[corners]
        lengths = 0 if normal is None else np.linalg.norm(normal) * np.linalg.norm(full_normals[v])
        if lengths > 0:
            angles.append(np.degrees(np.arccos(np.clip(normal @ full_normals[v] / lengths, -1, 1))))
    print(f"{np.sqrt(np.mean(np.square(angles))):.1f}°")


main()
