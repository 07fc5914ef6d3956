#!/usr/bin/env python3
"""Writes one mesh in every format and reads it back with other people's readers: VTK, zipfile and an XML parser,
Draco's decoder, and a few lines of NumPy where a format has no reader on Debian. All must have the same triangles,
bit for bit where the format is lossless, within the error told where it rounds.

    tests/oracles/meshes.py build/release/isoweave [--without-draco]

Exits with 77, which means skipped, where NumPy or VTK for Python is missing.
"""
import json
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import xml.etree.ElementTree
import zipfile

try:
    import numpy as np
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonDataModel import vtkPolyData
    from vtkmodules.vtkIOGeometry import vtkGLTFReader, vtkOBJReader, vtkSTLReader
    from vtkmodules.vtkIOPLY import vtkPLYReader
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
except ImportError as error:
    print("skipped:", error)
    sys.exit(77)


def canonical(corners):
    """Triangles as rows of nine numbers, each begun at its smallest corner, sorted."""
    t = np.asarray(corners).reshape(-1, 3, 3) + 0.0  # -0 counts as 0
    best = t
    for turn in (1, 2):
        other = np.roll(t, turn, axis=1)
        a, b = best[:, 0], other[:, 0]
        less = (b[:, 0] < a[:, 0]) | (
            (b[:, 0] == a[:, 0]) & ((b[:, 1] < a[:, 1]) | ((b[:, 1] == a[:, 1]) & (b[:, 2] < a[:, 2])))
        )
        best = np.where(less[:, None, None], other, best)
    rows = best.reshape(-1, 9)
    return rows[np.lexsort(rows.T[::-1])]


def of_poly_data(data):
    points = vtk_to_numpy(data.GetPoints().GetData())
    cells = vtk_to_numpy(data.GetPolys().GetConnectivityArray())
    assert len(cells) == 3 * data.GetNumberOfPolys(), "not triangles"
    return points[cells].reshape(-1, 3, 3)


def with_vtk(reader, path):
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def of_glb(path):
    """The triangles of each mesh of a GLB, where its nodes put them."""
    reader = vtkGLTFReader()
    reader.SetApplyDeformationsToGeometry(True)
    blocks = with_vtk(reader, path).NewIterator()
    found = []
    while not blocks.IsDoneWithTraversal():
        found.append(of_poly_data(vtkPolyData.SafeDownCast(blocks.GetCurrentDataObject())))
        blocks.GoToNextItem()
    return found


def read_wide_ply(path):
    """PLY of doubles x y z and of triangles, and nothing else."""
    header, data = open(path, "rb").read().split(b"end_header\n", 1)
    assert b"property double x\nproperty double y\nproperty double z\nelement face" in header
    vertices, faces = (int(n) for n in re.findall(rb"element (?:vertex|face) (\d+)", header))
    points = np.frombuffer(data, "<f8", 3 * vertices).reshape(-1, 3)
    cells = np.frombuffer(data[24 * vertices :], [("corners", "u1"), ("cell", "<u4", 3)])
    assert len(cells) == faces and (cells["corners"] == 3).all()
    return points[cells["cell"]]


def read_off(path, kind=np.float32):
    lines = [line.split("#")[0].split() for line in open(path)]
    words = [word for line in lines for word in line]
    stride = 6 if words[0] == "NOFF" else 3
    vertices, faces = int(words[1]), int(words[2])
    numbers = np.array(words[4:], dtype=object)
    points = numbers[: vertices * stride].reshape(-1, stride)[:, :3].astype(kind)
    cells = numbers[vertices * stride :].reshape(faces, 4).astype(np.int64)
    assert (cells[:, 0] == 3).all()
    return points[cells[:, 1:]]


def read_3mf(path, kind=np.float32):
    with zipfile.ZipFile(path) as archive:
        assert archive.testzip() is None
        relations = xml.etree.ElementTree.fromstring(archive.read("_rels/.rels"))
        model = xml.etree.ElementTree.fromstring(archive.read(relations[0].get("Target").lstrip("/")))
    space = {"m": "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"}
    points = [[v.get(axis) for axis in "xyz"] for v in model.iterfind(".//m:vertex", space)]
    cells = [[t.get(v) for v in ("v1", "v2", "v3")] for t in model.iterfind(".//m:triangle", space)]
    return np.array(points).astype(kind)[np.array(cells).astype(np.int64)], model


def read_glb(path, mesh=0):
    data = open(path, "rb").read()
    magic, version, length, json_length, _ = struct.unpack_from("<4sIIII", data)
    assert magic == b"glTF" and version == 2 and length == len(data)
    scene = json.loads(data[20 : 20 + json_length])
    begin = 28 + json_length

    def accessor(number, kind):
        view = scene["bufferViews"][scene["accessors"][number]["bufferView"]]
        at = begin + view["byteOffset"]
        return np.frombuffer(data[at : at + view["byteLength"]], kind)

    primitive = scene["meshes"][mesh]["primitives"][0]
    points = accessor(primitive["attributes"]["POSITION"], "<f4").reshape(-1, 3)
    return points[accessor(primitive["indices"], "<u4").reshape(-1, 3)], scene


def placed(corners, node):
    """Corners where the node of a GLB puts them."""
    x, y, z, w = node["rotation"]
    turn = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    return (np.asarray(corners, float) * node.get("scale", [1, 1, 1])) @ turn.T


def read_legacy_precomputed(folder, segment):
    assert json.load(open(f"{folder}/info"))["@type"] == "neuroglancer_legacy_mesh"
    (name,) = json.load(open(f"{folder}/{segment}:0"))["fragments"]
    data = open(f"{folder}/{name}", "rb").read()
    (count,) = struct.unpack_from("<I", data)
    points = np.frombuffer(data, "<f4", 3 * count, 4).reshape(-1, 3)
    return points[np.frombuffer(data, "<u4", -1, 4 + 12 * count).reshape(-1, 3)]


def read_packed_precomputed(folder, segment, scratch):
    """What Draco's own decoder gives of an object of one fragment, in steps, and where the manifest places it."""
    info = json.load(open(f"{folder}/info"))
    shard = open(f"{folder}/0.shard", "rb").read()
    begin, end = struct.unpack_from("<QQ", shard)
    key, start, size = struct.unpack_from("<QQQ", shard, 16 + begin)
    assert key == segment and end - begin == 24
    index = shard[16 + start : 16 + start + size]
    shape, origin = np.frombuffer(index, "<f4", 6).reshape(2, 3).astype(float)
    assert struct.unpack_from("<I", index, 24) == (1,) and struct.unpack_from("<I", index, 44) == (1,)
    (packed,) = struct.unpack_from("<I", index, 60)
    fragment, decoded = os.path.join(scratch, "fragment.drc"), os.path.join(scratch, "decoded.obj")
    with open(fragment, "wb") as out:
        out.write(shard[16 + start - packed : 16 + start])
    subprocess.run(["draco_decoder", "-i", fragment, "-o", decoded], check=True, stdout=subprocess.DEVNULL)
    steps, cells = [], []
    for line in open(decoded):
        words = line.split()
        if words and words[0] == "v":
            steps.append(words[1:4])
        if words and words[0] == "f":
            cells.append([int(word.split("/")[0]) - 1 for word in words[1:4]])
    assert info["vertex_quantization_bits"] == 16
    return np.array(steps, float)[np.array(cells)], shape, origin, np.array(info["transform"]).reshape(3, 4)


class Checks:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder
        header = (
            "NRRD0005\ntype: uint8\ndimension: 3\nsizes: 40 36 32\nspace: left-posterior-superior\n"
            "space directions: (0.5,0,0) (0,0.48,0.14) (0,-0.21,0.72)\nspace origin: (-30,12.5,7)\n"
            'space units: "mm" "mm" "mm"\nencoding: raw\n\n'
        )
        k, j, i = np.mgrid[0:32, 0:36, 0:40] * 0.31
        gyroid = np.sin(i) * np.cos(j) + np.sin(j) * np.cos(k) + np.sin(k) * np.cos(i)
        with open(self.path("volume.nrrd"), "wb") as out:
            out.write(header.encode() + np.uint8(127.5 + 60 * gyroid).tobytes())
        self.reference = None

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, *options):
        result = subprocess.run(
            [self.program, "mesh", self.path("volume.nrrd"), "-o", self.path(name), "--iso", "127.5", "--error",
             "0.1vox", "--normals", "gradient", "--report", self.path("report.json"), *options],
            check=True, stderr=subprocess.PIPE, text=True,
        )
        self.report = json.load(open(self.path("report.json")))
        return result.stderr

    def same(self, name, corners):
        rows = canonical(np.asarray(corners, np.float32))
        if self.reference is None:
            self.reference = rows
        assert len(rows) == self.report["triangles"], f"{name}: {len(rows)} triangles"
        assert (rows.view(np.uint32) == self.reference.view(np.uint32)).all(), f"{name}: other coordinates"
        print(f"{name:28} {len(rows)} triangles, equal bit for bit")

    def lossless(self):
        for name, reader in (("a.ply", vtkPLYReader()), ("a.stl", vtkSTLReader()), ("a.obj", vtkOBJReader())):
            self.write(name)
            self.same(f"{name} by VTK", of_poly_data(with_vtk(reader, self.path(name))))
        self.write("a.vtp")
        data = with_vtk(vtkXMLPolyDataReader(), self.path("a.vtp"))
        self.same("a.vtp by VTK", of_poly_data(data))
        fields = data.GetFieldData()
        assert [fields.GetAbstractArray(n).GetValue(0) for n in ("SPACE", "UNIT")] == ["LPS", "mm"]
        normals = vtk_to_numpy(data.GetPointData().GetNormals())
        assert np.allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-5)
        self.write("v.vtp", "--color-by", self.path("volume.nrrd"))
        data = with_vtk(vtkXMLPolyDataReader(), self.path("v.vtp"))
        self.same("v.vtp by VTK", of_poly_data(data))
        values = vtk_to_numpy(data.GetPointData().GetScalars())
        assert data.GetPointData().GetScalars().GetName() == "value"
        assert abs(values.mean() - 127.5) < 3, f"the volume's own values on its surface: {values.mean()}"
        self.write("v.ply", "--color-by", self.path("volume.nrrd"))
        self.same("v.ply by VTK", of_poly_data(with_vtk(vtkPLYReader(), self.path("v.ply"))))
        self.write("a.off")
        self.same("a.off by NumPy", read_off(self.path("a.off")))
        self.write("a.3mf")
        corners, model = read_3mf(self.path("a.3mf"))
        assert model.get("unit") == "millimeter"
        self.same("a.3mf by zipfile", corners)

    def glb(self):
        self.write("a.glb")
        corners, scene = read_glb(self.path("a.glb"))
        self.same("a.glb by NumPy", corners)
        in_place = placed(corners, scene["nodes"][0])
        found = of_glb(self.path("a.glb"))
        far = np.abs(np.concatenate(found) - in_place).max()
        assert far < 1e-7, f"a.glb by VTK: {far} from where the node puts it"
        print(f"{'a.glb by VTK':28} {len(in_place)} triangles, within {far:.2g} m")

    def levels(self):
        """All levels in one file: each node the mesh of its own file, the finest names the others."""
        for name, more in (("l.glb", ["--one-file"]), ("l.ply", [])):
            subprocess.run(
                [self.program, "mesh", self.path("volume.nrrd"), "-o", self.path(name), "--iso", "127.5", "--quiet",
                 "--lods", "0.1vox,0.5vox,2vox", *more],
                check=True,
            )
        _, scene = read_glb(self.path("l.glb"))
        assert scene["extensionsUsed"] == ["MSFT_lod"]
        (finest,) = [node for node in scene["nodes"] if "MSFT_lod" in node.get("extensions", {})]
        coarser = finest["extensions"]["MSFT_lod"]["ids"]
        for level, node in enumerate([finest] + [scene["nodes"][n] for n in coarser]):
            corners, _ = read_glb(self.path("l.glb"), node["mesh"])
            alone = of_poly_data(with_vtk(vtkPLYReader(), self.path(f"l_lod{level}.ply")))
            found, expected = (canonical(np.asarray(c, np.float32)) for c in (corners, alone))
            assert (found.view(np.uint32) == expected.view(np.uint32)).all(), f"l.glb: level {level} is another mesh"
            print(f"{f'l.glb, level {level}':28} {len(found)} triangles, equal bit for bit")
        assert level == 2

    def parts(self):
        """All iso-values in one file: each part the mesh of its own file, under its name, for trimesh and VTK."""
        isos = ("90", "127.5", "180")
        for name, more in (("p.glb", ["--one-file"]), ("p.vtp", ["--one-file"]), ("p.ply", [])):
            subprocess.run(
                [self.program, "mesh", self.path("volume.nrrd"), "-o", self.path(name), "--iso", ",".join(isos),
                 "--quiet", *more],
                check=True,
            )
        own = [of_poly_data(with_vtk(vtkPLYReader(), self.path(f"p_iso{iso}.ply"))) for iso in isos]
        data = with_vtk(vtkXMLPolyDataReader(), self.path("p.vtp"))
        names = data.GetFieldData().GetAbstractArray("PartNames")
        assert [names.GetValue(n) for n in range(names.GetNumberOfValues())] == [f"iso {iso}" for iso in isos]
        part = vtk_to_numpy(data.GetCellData().GetArray("part"))
        assert data.GetCellData().GetScalars().GetName() == "part"
        colors = vtk_to_numpy(data.GetCellData().GetArray("color"))
        assert colors.dtype == np.uint8 and len(np.unique(colors, axis=0)) == len(isos)
        corners = of_poly_data(data)
        for n, iso in enumerate(isos):
            self.equal(f"p.vtp, iso {iso}, by VTK", corners[part == n], own[n])
            assert len(np.unique(colors[part == n], axis=0)) == 1
        blocks = of_glb(self.path("p.glb"))
        root = read_glb(self.path("p.glb"))[1]["nodes"][0]
        assert len(blocks) == len(isos)
        for iso, corners, alone in zip(isos, blocks, own):
            far = np.abs(canonical(corners) - canonical(placed(alone, root).astype(np.float32))).max()
            assert far < 1e-7, f"p.glb, iso {iso}, by VTK: {far} from where the node puts it"
            print(f"{f'p.glb, iso {iso}, by VTK':28} {len(corners)} triangles, within {far:.2g} m")
        try:
            import trimesh
        except ImportError as error:
            return print("p.glb by trimesh             skipped:", error)
        scene = trimesh.load(self.path("p.glb"), process=False)
        assert set(scene.geometry) == {f"iso {iso}" for iso in isos}, set(scene.geometry)
        for n, iso in enumerate(isos):
            mesh = scene.geometry[f"iso {iso}"]
            self.equal(f"p.glb, iso {iso}, by trimesh", mesh.vertices[mesh.faces], own[n])
            assert mesh.visual.material.name == f"iso {iso}"
            assert (mesh.visual.material.alphaMode == "BLEND") == (n < 2), "the innermost is opaque"

    def equal(self, name, found, expected):
        a, b = (canonical(np.asarray(corners, np.float32)) for corners in (found, expected))
        assert a.shape == b.shape and (a.view(np.uint32) == b.view(np.uint32)).all(), f"{name}: another mesh"
        print(f"{name:28} {len(a)} triangles, equal bit for bit")

    def precomputed(self):
        corners = self.reference.reshape(-1, 3, 3).astype(float)
        self.write("a.precomputed", "--segment", "9")
        found = read_legacy_precomputed(self.path("a.precomputed"), 9)
        expected = canonical((corners * 1e6).astype(np.float32))
        assert (canonical(found) == expected).all(), "a.precomputed: other coordinates"
        print(f"{'a.precomputed by NumPy':28} {len(found)} triangles, equal in nanometres")
        if shutil.which("draco_decoder") is None or "--without-draco" in sys.argv:
            return print("b.precomputed                skipped: no draco_decoder, or a build without Draco")
        said = self.write("b.precomputed", "--segment", "9", "--compress")
        error = float(re.search(r"by at most (\S+) mm", said).group(1))
        steps, shape, origin, transform = read_packed_precomputed(self.path("b.precomputed"), 9, self.folder)
        assert np.allclose(transform, np.eye(3, 4) * 1e6)
        exact = (corners - origin) / shape * 65535
        far = np.linalg.norm(origin + np.round(exact) * shape / 65535 - corners, axis=2).max()
        assert far <= error * 1.01, f"b.precomputed: {far} mm, {error} were told"
        # Boxes have 32 bits in the file: a coordinate near the middle between two steps may go either way.
        sure = (np.abs(exact % 1 - 0.5) > 0.01).all(axis=(1, 2))
        missing = set(map(tuple, canonical(np.round(exact[sure])))) - set(map(tuple, canonical(steps)))
        assert not missing and sure.mean() > 0.7 and len(steps) == len(exact), "b.precomputed: others"
        print(f"{'b.precomputed by Draco':28} {len(steps)} triangles, within {far:.3g} of {error:.3g} mm")


    def far(self):
        """A volume far from the origin gives the mesh of the same volume at the origin, moved by the offset in 64 bits."""
        offset = np.array([500000.1, 4649776.7, 120.3])
        samples = open(self.path("volume.nrrd"), "rb").read().split(b"\n\n", 1)[1]

        def write(name, place):
            header = (
                "NRRD0004\ntype: uint8\ndimension: 3\nspace dimension: 3\nsizes: 40 36 32\nencoding: raw\n"
                "space directions: (0.01,0,0) (0,0.01,0) (0,0,0.02)\nspace origin: (%s,%s,%s)\n\n" % tuple(place)
            )
            with open(self.path("far.nrrd"), "wb") as out:
                out.write(header.encode() + samples)
            command = [self.program, "mesh", self.path("far.nrrd"), "-o", self.path(name), "--iso", "127.5", "--quiet"]
            subprocess.run(command + (["--compress"] if name == "far.precomputed" else []), check=True)

        def same(name, corners, expected):
            assert np.asarray(corners).dtype == np.float64
            assert (canonical(corners) == canonical(expected)).all(), f"{name}: other coordinates"
            print(f"{name:28} {len(corners)} triangles, equal in 64 bits")

        write("near.ply", (0, 0, 0))
        near = np.asarray(of_poly_data(with_vtk(vtkPLYReader(), self.path("near.ply"))), float)
        assert len(near) > 1000
        write("far.vtp", offset)
        same("far.vtp by VTK", of_poly_data(with_vtk(vtkXMLPolyDataReader(), self.path("far.vtp"))), near + offset)
        write("far.ply", offset)
        same("far.ply by NumPy", read_wide_ply(self.path("far.ply")), near + offset)
        write("far.off", offset)
        same("far.off by NumPy", read_off(self.path("far.off"), np.float64), near + offset)
        write("far.3mf", offset)
        same("far.3mf by zipfile", read_3mf(self.path("far.3mf"), np.float64)[0], near + offset)
        write("far.glb", offset)
        corners, scene = read_glb(self.path("far.glb"))
        assert scene["nodes"][0]["children"] == [1]
        same("far.glb by NumPy", corners + np.array(scene["nodes"][1]["translation"]), near + offset)
        if shutil.which("draco_decoder") is None or "--without-draco" in sys.argv:
            return
        write("far.precomputed", offset)
        _, _, origin, transform = read_packed_precomputed(self.path("far.precomputed"), 1, self.folder)
        assert np.allclose(transform[:, 3], offset * 1e6, rtol=1e-14) and (np.abs(origin) < 1).all()


def main():
    with tempfile.TemporaryDirectory() as folder:
        checks = Checks(os.path.abspath(sys.argv[1]), folder)
        checks.lossless()
        checks.glb()
        checks.levels()
        checks.parts()
        checks.precomputed()
        checks.far()


if __name__ == "__main__":
    main()
