#!/usr/bin/python3
"""Files that VTK's own writers make, in every way they have, are read as VTK holds them.

    tests/oracles/vtk_files.py build/release/isoweave build/release/tests/oracles/isoweave_dump_volume

Meshes: the digest is that of an STL file of the same triangles, which NumPy writes. Volumes: the same samples, one by
one, and the same place. Exits with 77, which means skipped, where NumPy or VTK for Python is missing.
"""

import itertools
import os
import subprocess
import sys
import tempfile

from oracle import SKIP, Oracle, affine_of, np

try:
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(SKIP)

# Meshes.


def surface(kind):
    """Points, cells and data of several kinds, in doubles that are not floats."""
    source = vtk.vtkSphereSource() if kind != "quads" else vtk.vtkCubeSource()
    if kind != "quads":
        source.SetThetaResolution(9)
        source.SetPhiResolution(7)
    source.SetCenter(0.1, 20.7, -3.3)
    last = source
    if kind in ("strips", "mixed"):
        last = vtk.vtkStripper()
        last.SetInputConnection(source.GetOutputPort())
    last.Update()
    mesh = vtk.vtkPolyData()
    mesh.DeepCopy(last.GetOutput())
    if kind == "doubles":
        points = vtk.vtkPoints()
        points.SetDataTypeToDouble()
        points.SetData(numpy_to_vtk(vtk_to_numpy(mesh.GetPoints().GetData()).astype(float) / 3, deep=True))
        mesh.SetPoints(points)
    if kind == "mixed":
        verts, lines = vtk.vtkCellArray(), vtk.vtkCellArray()
        verts.InsertNextCell(1, [0])
        lines.InsertNextCell(3, [0, 1, 2])
        mesh.SetVerts(verts)
        mesh.SetLines(lines)
        names = vtk.vtkStringArray()
        names.SetName("names")
        for text in ("a b\nc", "", "x" * 100, "y" * 20000):  # lengths of which VTK writes in 1, 2 and 4 bytes
            names.InsertNextValue(text)
        mesh.GetFieldData().AddArray(names)
    values = numpy_to_vtk(np.arange(mesh.GetNumberOfPoints()) * 0.25, deep=True)
    values.SetName("my values")
    mesh.GetPointData().SetScalars(values)
    return mesh


def corners_of(mesh):
    """The fans of all polygons, and the triangles of all strips, as VTK numbers their corners."""
    points = vtk_to_numpy(mesh.GetPoints().GetData()).astype(np.float32)
    triangles, ids = [], vtk.vtkIdList()
    cells = mesh.GetPolys()
    cells.InitTraversal()
    while cells.GetNextCell(ids):
        c = [ids.GetId(n) for n in range(ids.GetNumberOfIds())]
        triangles += [[c[0], c[n], c[n + 1]] for n in range(1, len(c) - 1)]
    cells = mesh.GetStrips()
    cells.InitTraversal()
    while cells.GetNextCell(ids):
        c = [ids.GetId(n) for n in range(ids.GetNumberOfIds())]
        triangles += [[c[n], c[n + 1 + n % 2], c[n + 2 - n % 2]] for n in range(len(c) - 2)]
    return points[np.array(triangles)]


def write_stl(corners, path):
    record = np.zeros(len(corners), [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])
    record["corners"] = corners
    with open(path, "wb") as file:
        file.write(bytes(80) + np.uint32(len(corners)).tobytes() + record.tobytes())


def write_vtp(mesh, path, mode, compressor="None", bits=64, big=False, pieces=1):
    write_xml(vtk.vtkXMLPolyDataWriter(), mesh, path, mode, compressor, bits, big, pieces)


def write_xml(writer, mesh, path, mode, compressor, bits, big, pieces=1):
    writer.SetInputData(mesh)
    writer.SetFileName(path)
    if mode == "Raw":
        writer.SetDataModeToAppended()
        writer.EncodeAppendedDataOff()
    else:
        getattr(writer, f"SetDataModeTo{mode}")()
    getattr(writer, f"SetCompressorTypeTo{compressor}")()
    writer.SetBlockSize(1024)
    writer.SetHeaderType(writer.UInt64 if bits == 64 else writer.UInt32)
    writer.SetIdTypeToInt64() if bits == 64 else writer.SetIdTypeToInt32()
    writer.SetByteOrderToBigEndian() if big else writer.SetByteOrderToLittleEndian()
    writer.SetNumberOfPieces(pieces)
    assert writer.Write() == 1


def write_legacy(mesh, path, binary, version):
    writer = vtk.vtkPolyDataWriter() if isinstance(mesh, vtk.vtkPolyData) else vtk.vtkUnstructuredGridWriter()
    writer.SetInputData(mesh)
    writer.SetFileName(path)
    writer.SetFileVersion(version)
    writer.SetFileTypeToBinary() if binary else writer.SetFileTypeToASCII()
    assert writer.Write() == 1


class Meshes:
    def __init__(self, oracle, folder):
        self.oracle, self.folder = oracle, folder
        self.digests = {}  # of STL files, by the corners in them

    def expect(self, mesh, path, times=1):
        with self.oracle.file(path):
            right = self.digest_of(np.tile(corners_of(mesh), (times, 1, 1)))
            self.oracle.expect_equal(self.digest(path), right, f"{path}: digest")

    def digest_of(self, corners):
        key = corners.tobytes()
        if key not in self.digests:
            stl = os.path.join(self.folder, "right.stl")
            write_stl(corners, stl)
            self.digests[key] = self.digest(stl)
        return self.digests[key]

    def digest(self, path):
        return self.oracle.check(path)["digest"]

    def vtp(self, kind):
        mesh = surface(kind)
        path = os.path.join(self.folder, f"{kind}.vtp")
        for mode, compressor, bits, big in itertools.product(
                ("Ascii", "Binary", "Appended", "Raw"), ("None", "ZLib", "LZ4", "LZMA"), (32, 64), (False, True)):
            if mode == "Ascii" and (compressor != "None" or big):
                continue
            write_vtp(mesh, path, mode, compressor, bits, big)
            self.expect(mesh, path)
        # The writer cannot cut polygons that have no source: each piece is the whole again, as VTK reads it, too.
        write_vtp(mesh, path, "Appended", "ZLib", pieces=2)
        self.expect(mesh, path, times=2)

    def legacy(self, kind):
        mesh = surface(kind)
        path = os.path.join(self.folder, f"{kind}.vtk")
        for binary, version in itertools.product((False, True), (42, 51)):
            # In text VTK writes six digits, which these coordinates have.
            if kind != "quads" and not binary:
                continue
            write_legacy(mesh, path, binary, version)
            self.expect(mesh, path)

    def grid(self):
        mesh = surface("quads")
        grid = vtk.vtkUnstructuredGrid()
        grid.SetPoints(mesh.GetPoints())
        grid.SetCells(vtk.VTK_QUAD, mesh.GetPolys())
        path = os.path.join(self.folder, "grid.vtk")
        for binary, version in itertools.product((False, True), (42, 51)):
            write_legacy(grid, path, binary, version)
            self.expect(mesh, path)

    def xml_grid(self):
        mesh = surface("quads")
        grid = vtk.vtkUnstructuredGrid()
        grid.SetPoints(mesh.GetPoints())
        grid.SetCells(vtk.VTK_QUAD, mesh.GetPolys())
        path = os.path.join(self.folder, "grid.vtu")
        for mode, compressor, bits, big in itertools.product(
                ("Ascii", "Binary", "Appended", "Raw"), ("None", "ZLib", "LZ4", "LZMA"), (32, 64), (False, True)):
            if mode == "Ascii" and (compressor != "None" or big):
                continue
            write_xml(vtk.vtkXMLUnstructuredGridWriter(), grid, path, mode, compressor, bits, big)
            self.expect(mesh, path)

    def parts(self, kind):
        """A file that names one for each piece: the source is cut by VTK's own filter."""
        whole = surface(kind)
        cut = vtk.vtkAppendPolyData()
        for shift in (0, 5, 9):
            moved = vtk.vtkTransformPolyDataFilter()
            transform = vtk.vtkTransform()
            transform.Translate(shift, 0, 0)
            moved.SetTransform(transform)
            moved.SetInputData(whole)
            cut.AddInputConnection(moved.GetOutputPort())
        cut.Update()
        for mode in ("Ascii", "Binary", "Appended"):
            writer = vtk.vtkXMLPPolyDataWriter()
            writer.SetInputConnection(cut.GetOutputPort())
            writer.SetNumberOfPieces(2)
            writer.SetStartPiece(0)
            writer.SetEndPiece(1)
            getattr(writer, f"SetDataModeTo{mode}")()
            path = os.path.join(self.folder, "parts.pvtp")
            writer.SetFileName(path)
            assert writer.Write() == 1
            reader = vtk.vtkXMLPPolyDataReader()
            reader.SetFileName(path)
            reader.Update()
            assert open(path).read().count("<Piece Source") >= 1
            self.expect(reader.GetOutput(), path)

    def gltf(self, inline):
        """A scene in metres: an actor that is turned, doubled and moved, as one of the nodes."""
        source = vtk.vtkSphereSource()
        mapper = vtk.vtkPolyDataMapper()
        mapper.SetInputConnection(source.GetOutputPort())
        actor = vtk.vtkActor()
        actor.SetMapper(mapper)
        actor.SetPosition(1, 2, 3)
        actor.SetScale(2, 2, 2)
        actor.RotateZ(30)
        mapper.Update()
        renderer, window = vtk.vtkRenderer(), vtk.vtkRenderWindow()
        renderer.AddActor(actor)
        window.SetOffScreenRendering(1)
        window.AddRenderer(renderer)
        exporter = vtk.vtkGLTFExporter()
        exporter.SetRenderWindow(window)
        exporter.SetInlineData(inline)
        path = os.path.join(self.folder, f"scene{inline}.gltf")
        exporter.SetFileName(path)
        exporter.Write()
        properties = vtk.vtkMassProperties()
        properties.SetInputData(source.GetOutput())
        with self.oracle.file(path):
            found = self.oracle.check(path)
            self.oracle.expect_equal(found["triangles"], source.GetOutput().GetNumberOfPolys(), f"{path}: triangles")
            self.oracle.expect_near(found["volume"], 8 * properties.GetVolume(), 1e-5, f"{path}: volume")
            self.oracle.expect_near(found["area"], 4 * properties.GetSurfaceArea(), 1e-5, f"{path}: area")


# Volumes.

DIMS, SPACING, ORIGIN = (7, 6, 5), (0.5, 1.25, 2), (-3, 4, 10.5)
TYPES = {"int8": np.int8, "uint8": np.uint8, "int16": np.int16, "uint16": np.uint16, "int32": np.int32,
         "uint32": np.uint32, "float32": np.float32, "float64": np.float64}


def samples(kind, shape):
    """Different ones everywhere, over the whole range of small types."""
    count = int(np.prod(shape))
    if kind == "bit":
        return (np.arange(count) * 7 % 5 < 2).astype(np.uint8).reshape(shape)
    if np.issubdtype(TYPES[kind], np.floating):
        return (np.sin(np.arange(count)) * 1000).astype(TYPES[kind]).reshape(shape)
    info = np.iinfo(TYPES[kind])
    return np.linspace(info.min, info.max, count).astype(TYPES[kind]).reshape(shape)


def vtk_array(values, kind, name):
    if kind == "bit":
        array = vtk.vtkBitArray()
        for value in values.ravel():
            array.InsertNextValue(int(value))
    else:
        array = numpy_to_vtk(values.ravel(), deep=True)
        if kind == "int8":
            array = vtk.vtkSignedCharArray()
            for value in values.ravel():
                array.InsertNextValue(int(value))
    array.SetName(name)
    return array


def image(kind, cells=False, grid=False, active=True, extent=(0, 0, 0)):
    """An image, or a rectilinear grid as even, and its samples [k, j, i]."""
    if grid:
        data = vtk.vtkRectilinearGrid()
        data.SetDimensions(DIMS)
        for axis, name in enumerate("XYZ"):
            places = ORIGIN[axis] + SPACING[axis] * np.arange(DIMS[axis])
            getattr(data, f"Set{name}Coordinates")(numpy_to_vtk(places, deep=True))
    else:
        data = vtk.vtkImageData()
        data.SetExtent(*(n for first, size in zip(extent, DIMS) for n in (first, first + size - 1)))
        data.SetSpacing(SPACING)
        data.SetOrigin(ORIGIN)
    shape = tuple(n - (1 if cells else 0) for n in DIMS[::-1])
    values = samples(kind, shape)
    attributes = data.GetCellData() if cells else data.GetPointData()
    other = numpy_to_vtk(np.zeros((values.size, 3), np.float32), deep=True)
    other.SetName("vectors")
    attributes.AddArray(other)
    array = vtk_array(values, kind, "the samples")
    attributes.SetScalars(array) if active else attributes.AddArray(array)
    return data, values


class Volumes:
    def __init__(self, oracle, dump, folder):
        self.oracle, self.dump, self.folder = oracle, dump, folder

    def expect(self, path, values, first):
        """`first`: where the first sample lies."""
        done = subprocess.run([self.dump, path], capture_output=True)
        if done.returncode != 0:
            message = done.stderr.decode().strip()
            return self.oracle.expect("a format of this build" in message, message)
        line, found = done.stdout.split(b"\n", 1)
        kind = "uint8" if values.dtype == bool else values.dtype.name
        self.oracle.expect_equal(line.decode(), f"{' '.join(map(str, values.shape[::-1]))} {kind}", f"{path}: header")
        self.oracle.expect(found == values.tobytes(), f"{path}: other samples")
        with self.oracle.file(path):
            affine = np.diag([*SPACING, 1.0])
            affine[:3, 3] = first
            self.oracle.expect_near(affine_of(self.oracle.info(path)), affine, 1e-9, f"{path}: place")

    def vti(self, kind, cells):
        extent = (2, -1, 0)
        data, values = image(kind, cells, extent=extent)
        half = 0.5 if cells else 0
        first = np.array(ORIGIN) + np.array(SPACING) * (np.array(extent) + half)
        path = os.path.join(self.folder, f"{kind}{cells}.vti")
        for mode, compressor, bits in itertools.product(
                ("Ascii", "Binary", "Appended"), ("None", "ZLib", "LZ4", "LZMA"), (32, 64)):
            writer = vtk.vtkXMLImageDataWriter()
            writer.SetInputData(data)
            writer.SetFileName(path)
            getattr(writer, f"SetDataModeTo{mode}")()
            getattr(writer, f"SetCompressorTypeTo{compressor}")()
            writer.SetBlockSize(64)
            writer.SetHeaderType(writer.UInt64 if bits == 64 else writer.UInt32)
            assert writer.Write() == 1
            self.expect(path, values, first)

    def vtr(self, kind, cells):
        data, values = image(kind, cells, grid=True)
        first = np.array(ORIGIN) + np.array(SPACING) * (0.5 if cells else 0)
        path = os.path.join(self.folder, f"{kind}{cells}.vtr")
        for mode, compressor, bits, big in itertools.product(
                ("Ascii", "Binary", "Appended", "Raw"), ("None", "ZLib", "LZ4", "LZMA"), (32, 64), (False, True)):
            if mode == "Ascii" and (compressor != "None" or big):
                continue
            write_xml(vtk.vtkXMLRectilinearGridWriter(), data, path, mode, compressor, bits, big)
            self.expect(path, values, first)

    def uneven_slices(self):
        """Of slices at 0, 1, 3, 4 and 5 six are made, one of them between two."""
        data, values = image("float32", grid=True)
        places = np.array([0, 1, 3, 4, 5]) * SPACING[2] + ORIGIN[2]
        data.SetZCoordinates(numpy_to_vtk(places, deep=True))
        made = np.insert(values, 2, (values[1].astype(float) + values[2]) / 2, axis=0)
        for writer, name in ((vtk.vtkXMLRectilinearGridWriter(), "u.vtr"), (vtk.vtkRectilinearGridWriter(), "u.vtk")):
            path = os.path.join(self.folder, name)
            writer.SetInputData(data)
            writer.SetFileName(path)
            if name == "u.vtk":
                writer.SetFileTypeToBinary()
            assert writer.Write() == 1
            self.expect(path, made, np.array(ORIGIN))

    def pieces(self):
        """In one file and in several; a source that can be cut is needed for that."""
        source = vtk.vtkRTAnalyticSource()
        source.SetWholeExtent(-2, 4, 0, 5, 1, 5)
        passing = vtk.vtkImageChangeInformation()
        passing.SetInputConnection(source.GetOutputPort())
        passing.SetOutputSpacing(SPACING)
        passing.SetOutputOrigin(ORIGIN)
        passing.Update()
        whole = passing.GetOutput()
        values = vtk_to_numpy(whole.GetPointData().GetScalars()).reshape(whole.GetDimensions()[::-1])
        first = np.array(ORIGIN) + np.array(SPACING) * [-2, 0, 1]
        for mode, name in itertools.product(("Ascii", "Binary", "Appended"), ("p.vti", "p.pvti")):
            writer = vtk.vtkXMLImageDataWriter() if name == "p.vti" else vtk.vtkXMLPImageDataWriter()
            writer.SetInputConnection(passing.GetOutputPort())
            writer.SetNumberOfPieces(6)
            if name == "p.pvti":
                writer.SetStartPiece(0)
                writer.SetEndPiece(5)
            getattr(writer, f"SetDataModeTo{mode}")()
            path = os.path.join(self.folder, name)
            writer.SetFileName(path)
            assert writer.Write() == 1
            assert open(path).read(100000).count("<Piece") == 6 or mode == "Appended"
            self.expect(path, values, first)

    def legacy(self, kind, cells, grid, active):
        data, values = image(kind, cells, grid, active)
        first = np.array(ORIGIN) + np.array(SPACING) * (0.5 if cells else 0)
        path = os.path.join(self.folder, f"{kind}{cells}{grid}.vtk")
        for binary, version in itertools.product((False, True), (42, 51)):
            # In text VTK writes fewer digits than these have.
            if kind in ("float32", "float64") and not binary:
                continue
            writer = vtk.vtkRectilinearGridWriter() if grid else vtk.vtkStructuredPointsWriter()
            writer.SetInputData(data)
            writer.SetFileName(path)
            writer.SetFileVersion(version)
            writer.SetFileTypeToBinary() if binary else writer.SetFileTypeToASCII()
            assert writer.Write() == 1
            self.expect(path, values, first)


def main(program, dump):
    oracle = Oracle(program)
    with tempfile.TemporaryDirectory() as folder:
        meshes = Meshes(oracle, folder)
        for kind in ("sphere", "quads", "strips", "doubles", "mixed"):
            meshes.vtp(kind)
            meshes.legacy(kind)
        meshes.grid()
        for inline in (True, False):
            meshes.gltf(inline)
        meshes.xml_grid()
        for kind in ("sphere", "strips"):
            meshes.parts(kind)
        volumes = Volumes(oracle, dump, folder)
        for kind in (*TYPES, "bit"):
            for cells in (False, True):
                volumes.vti(kind, cells)
                volumes.legacy(kind, cells, grid=False, active=True)
        for kind, cells, grid in (("int16", False, True), ("float32", True, True), ("uint8", False, True)):
            volumes.legacy(kind, cells, grid, active=True)
        volumes.legacy("uint8", False, grid=False, active=False)
        volumes.legacy("uint16", True, grid=False, active=False)
        for kind in ("int16", "float64", "uint8"):
            for cells in (False, True):
                volumes.vtr(kind, cells)
        volumes.uneven_slices()
        volumes.pieces()
    oracle.finish()


main(*sys.argv[1:])
