"""Meshes and reports beside those of the command line, and what can be done with them."""

from __future__ import annotations

import inspect
import json
import pathlib
from typing import Any, Callable

import numpy as np
import pytest
from conftest import ORIGIN, SPACING, run_cli

import isoweave
from isoweave._settings import LabelSettings, MeshSettings, StopSettings

Reporter = Callable[..., dict[str, Any]]


def signed_volume(vertices: np.ndarray, faces: np.ndarray) -> float:
    a, b, c = (vertices[faces[:, corner]].astype(float) for corner in range(3))
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)


@pytest.mark.parametrize(
    ("options", "arguments"),
    [
        ({"error": 0}, ["--error", "0"]),
        ({"error": 0.3}, ["--error", "0.3"]),
        ({"error": "0.4vox", "quality": "fine"}, ["--error", "0.4vox", "--quality", "fine"]),
        ({"triangles": 300}, ["--triangles", "300"]),
        ({"ratio": 0.2, "largest": True}, ["--ratio", "0.2", "--largest"]),
        ({"max_distance": "0.3vox"}, ["--max-distance", "0.3vox"]),
        ({"max_distance": 0.3, "error": float("inf")}, ["--max-distance", "0.3", "--error", "inf"]),
        ({"inside": "below", "closed": False}, ["--inside", "below", "--open"]),
        ({"smooth": 4}, ["--smooth=4"]),
        ({"min_component": 200}, ["--min-component", "200"]),
        ({"normals": "quadric"}, ["--normals", "quadric"]),
        ({"space": "index"}, ["--space", "index"]),
        ({"roi": np.s_[4:, 2:-3, :30]}, ["--roi", ":30,2:31,4:"]),
        ({"step": 2}, ["--step", "2"]),
        ({"specks": "drop", "error": "3vox"}, ["--specks", "drop", "--error", "3vox"]),
        ({"extractor": "trilinear"}, ["--extractor", "trilinear"]),
        ({"extractor": "tetrahedra", "largest": True}, ["--extractor", "tetrahedra", "--largest"]),
        ({"extractor": "dual", "normals": "gradient"}, ["--extractor", "dual", "--normals", "gradient"]),
    ],
)
def test_options_are_those_of_the_command_line(
    volume: np.ndarray, cli_report: Reporter, options: dict[str, Any], arguments: list[str]
) -> None:
    report = cli_report(volume, "--iso", 100, *arguments)
    mesh = isoweave.mesh(volume, 100, **options)
    assert mesh.digest == report["digest"]
    assert mesh.report["triangles"] == report["triangles"] == len(mesh.faces)
    for key in ("iso", "closed", "inside", "triangles_extracted", "collapses", "components", "euler", "error", "space", "extractor"):
        assert mesh.report[key] == report[key], key


def test_every_key_of_the_report_is_there(volume: np.ndarray, cli_report: Reporter) -> None:
    report = cli_report(volume, "--iso", 100)
    ours = isoweave.mesh(volume, 100).report
    assert set(report) - set(ours) <= {"forecast", "quality", "normals", "output"}
    assert set(report["input"]) == set(ours["input"])


def test_suggested_level(volume: np.ndarray, cli_report: Reporter) -> None:
    report = cli_report(volume, "--iso", "auto")
    mesh = isoweave.mesh(volume)
    assert (mesh.report.iso, mesh.digest) == (report["iso"], report["digest"])
    assert isoweave.open_volume(volume).suggest_level() == report["iso"]


def test_arrays(volume: np.ndarray) -> None:
    mesh = isoweave.mesh(volume, 100, normals="gradient", values=volume.astype(np.float32) * 2)
    vertices, faces = mesh
    assert vertices.dtype == np.float32 and faces.dtype == np.int32
    assert vertices.shape == (mesh.report.vertices, 3) and faces.shape == (mesh.report.triangles, 3)
    assert faces.min() == 0 and faces.max() == len(vertices) - 1
    assert mesh.normals is not None and mesh.values is not None
    np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1, atol=1e-5)
    outward = mesh.normals @ np.eye(3) * (vertices - np.array([16.2, 15.1, 14.7]))
    assert np.mean(outward[vertices[:, 0] < 26].sum(axis=1) > 0) > 0.95
    assert np.median(mesh.values) == pytest.approx(200, abs=5)
    assert signed_volume(vertices, faces) == pytest.approx((volume >= 100).sum(), rel=0.03)
    vertices[0] += 1  # they are the user's own
    del mesh
    assert np.isfinite(vertices).all()


def test_files_and_levels(volume: np.ndarray, cli_report: Reporter, folder: pathlib.Path) -> None:
    lods = cli_report(volume, "--iso", 100, "--lods", "0.05vox,0.3vox,1vox")
    meshes = isoweave.mesh(volume, 100, lods=["0.05vox", "0.3vox", "1vox"])
    assert [mesh.digest for mesh in meshes] == [level["digest"] for level in lods["levels"]] + [lods["digest"]]
    reports = isoweave.mesh(volume, 100, lods=["0.05vox", "0.3vox", "1vox"], out=folder / "m.ply")
    for n, (mesh, report) in enumerate(zip(meshes, reports)):
        path = folder / f"m_lod{n}.ply"
        assert report.digest == mesh.digest == isoweave.read_mesh(path).digest
        assert json.loads(run_cli("check", path, "--json").stdout)["digest"] == mesh.digest
    for name in ("a.stl", "a.obj", "a.off", "a.glb", "a.vtp", "a.3mf"):
        meshes[1].save(folder / name)
        assert isoweave.check(folder / name).digest == meshes[1].digest, name
    with pytest.raises(isoweave.CannotWrite):
        isoweave.mesh(volume, 100, out=folder / "none" / "m.ply")
    with pytest.raises(isoweave.CannotWrite):
        meshes[0].save(folder / "m.doc")


def test_several_levels(volume: np.ndarray, cli_report: Reporter, folder: pathlib.Path) -> None:
    levels = [60, 100.5, 170]
    by_cli = cli_report(volume, "--iso", "60,100.5,170", "--extractor", "dual", "--triangles", "400")
    meshes = isoweave.mesh(volume, levels, extractor="dual", triangles=400)
    assert [mesh.digest for mesh in meshes] == [each["digest"] for each in by_cli["isos"]]
    assert [mesh.digest for mesh in meshes] == [
        isoweave.mesh(volume, level, extractor="dual", triangles=400).digest for level in levels
    ]
    for mesh, entry in zip(meshes, by_cli["isos"]):
        assert set(entry) - set(mesh.report) == {"output", "name", "color", "opacity"}  # of a file and its parts
        assert mesh.report.iso == entry["iso"] and mesh.report.triangles == entry["triangles"] == len(mesh.faces)
    assert set(by_cli) - set(meshes[0].report) <= {"quality", "normals"}

    reports = isoweave.mesh(volume, np.array(levels), error=0, out=folder / "m.stl")
    assert sorted(path.name for path in folder.iterdir()) == ["m_iso100.5.stl", "m_iso170.stl", "m_iso60.stl"]
    for report in reports:
        path = folder / f"m_iso{report.iso:g}.stl"
        assert isoweave.check(path).digest == report.digest == isoweave.mesh(volume, report.iso, error=0).digest
    one, two = isoweave.mesh(volume, (60, 170), out=[None, folder / "two.ply"])
    assert isoweave.check(one).digest == isoweave.mesh(volume, 60).digest and two.iso == 170
    assert [each.digest for each in isoweave.mesh(volume, [100])] == [isoweave.mesh(volume, 100).digest]
    half = isoweave.mesh(volume, levels, ratio=0.5)
    assert [each.digest for each in half] == [isoweave.mesh(volume, level, ratio=0.5).digest for level in levels]


@pytest.mark.parametrize(
    ("levels", "options", "message"),
    [
        ([], {}, "value"),
        ([60, 60], {}, "60"),
        ([60, 100], {"lods": [0.1, 0.5]}, "lods"),
        ([60, 100], {"largest": True}, "largest"),
        ([60, 100], {"memory": "2G"}, "memory"),
        ([60, 100], {"values": np.zeros((30, 34, 38))}, "values"),
        ([60, 100], {"out": [None]}, "out"),
        ([60, np.nan], {}, "iso"),
    ],
)
def test_what_does_not_go_with_several_levels(
    volume: np.ndarray, levels: list[float], options: dict[str, Any], message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        isoweave.mesh(volume, levels, **options)


def test_types_are_those_of_the_signatures() -> None:
    """What type checkers know of the keyword arguments is what the functions take."""
    pairs = [(isoweave.mesh, MeshSettings), (isoweave.simplify, StopSettings), (isoweave.labels, LabelSettings)]
    for function, settings in pairs:
        taken = {p.name for p in inspect.signature(function).parameters.values() if p.kind is p.KEYWORD_ONLY}
        assert taken - {"lods", "out"} == set(settings.__annotations__), function


def test_far_from_the_origin(volume: np.ndarray, folder: pathlib.Path) -> None:
    far = {"spacing": 0.001, "origin": (5e5, 4e6, 0)}
    mesh = isoweave.mesh(volume, 100, **far)
    assert mesh.vertices.dtype == np.float64 and any(mesh.offset)
    assert isoweave.check(mesh).digest == mesh.digest
    assert isoweave.check(isoweave.Mesh(*mesh)).area == pytest.approx(isoweave.check(mesh).area, rel=1e-3)
    mesh.save(folder / "far.ply")
    assert isoweave.read_mesh(folder / "far.ply").digest == mesh.digest
    pieces = list(isoweave.iter_mesh(volume, 100, **far))
    assert np.concatenate([piece[0] for piece in pieces])[:, 1].min() > 3.9e6


def test_pieces_are_the_mesh(volume: np.ndarray) -> None:
    vertices, faces = zip(*isoweave.iter_mesh(volume, 100))
    assert isoweave.check((np.concatenate(vertices), np.concatenate(faces))).digest == isoweave.mesh(volume, 100).digest
    vertices, faces = zip(*isoweave.iter_mesh(volume, 100, extractor="dual"))
    dual = isoweave.mesh(volume, 100, extractor="dual")
    assert isoweave.check((np.concatenate(vertices), np.concatenate(faces))).digest == dual.digest


def test_sinks(volume: np.ndarray) -> None:
    class Kept:
        def __init__(self) -> None:
            self.parts: dict[str, list[Any]] = {"vertices": [], "faces": []}
            self.report: Any = None

        def vertices(self, xyz: np.ndarray) -> None:
            self.parts["vertices"].append(xyz)

        def faces(self, ijk: np.ndarray) -> None:
            self.parts["faces"].append(ijk)

        def finish(self, report: isoweave.Report) -> None:
            self.report = report

    sink = Kept()
    report = isoweave.mesh(volume, 100, out=sink)
    arrays = [np.concatenate(sink.parts[name]) for name in ("vertices", "faces")]
    assert isoweave.check(arrays).digest == report.digest == sink.report.digest
    with pytest.raises(TypeError, match="out"):
        isoweave.mesh(volume, 100, out=object())  # type: ignore[call-overload]


def test_labels(folder: pathlib.Path, cli_report: Reporter) -> None:
    cells = np.zeros((24, 26, 28), np.uint16)
    cells[3:12, 4:20, 5:20] = 7
    cells[12:20, 4:20, 5:20] = 300
    report = cli_report(cells, "--labels", "all", "--smooth")
    meshes = isoweave.labels(cells)
    assert {label: mesh.digest for label, mesh in meshes.items()} == {e["label"]: e["digest"] for e in report["labels"]}
    assert isoweave.open_volume(cells).find_labels() == {7: 9 * 16 * 15, 300: 8 * 16 * 15}
    tetrahedra = isoweave.labels(cells, [7], extractor="tetrahedra")[7]
    by_cli = cli_report(cells, "--labels", "7", "--smooth", "--extractor", "tetrahedra")
    assert tetrahedra.digest == by_cli["labels"][0]["digest"] != meshes[7].digest
    assert tetrahedra.report.extractor == by_cli["extractor"] == "tetrahedra"
    for options, stop in (
        ({"ratio": 0.2}, ["--ratio", "20%"]),
        ({"triangles": 200}, ["--triangles", "200"]),
        ({"max_distance": "0.3vox"}, ["--max-distance", "0.3vox"]),
    ):
        stopped = cli_report(cells, "--labels", "all", "--smooth", *stop)["labels"]
        assert [each.digest for each in isoweave.labels(cells, **options).values()] == [e["digest"] for e in stopped]
    files = isoweave.labels(cells, [300], out=folder / "seg.ply")
    assert isoweave.check(folder / "seg_label300.ply").digest == files[300].digest == meshes[300].digest
    assert isoweave.labels(cells, out=lambda label, mesh: len(mesh.faces)) == {k: len(m.faces) for k, m in meshes.items()}
    wide = cells.astype(np.uint64) * (2**64 // 512)
    assert sorted(isoweave.labels(wide)) == [7 * (2**64 // 512), 300 * (2**64 // 512)]
    with pytest.raises(isoweave.BadInput):
        isoweave.labels(np.zeros((4, 4, 4), np.uint8))
    with pytest.raises(isoweave.BadInput):
        isoweave.labels(cells + 0.5)


def test_simplify_and_compare(volume: np.ndarray, folder: pathlib.Path) -> None:
    full = isoweave.mesh(volume, 100, error=0)
    full.save(folder / "full.ply")
    done = run_cli("simplify", folder / "full.ply", "-o", folder / "small.ply", "--error", "0.3vox", "--quiet")
    assert done.returncode == 0, done.stderr
    small = isoweave.simplify(full, error="0.3vox")
    assert small.digest == isoweave.check(folder / "small.ply").digest == isoweave.simplify(tuple(full), error="0.3vox").digest
    half = isoweave.simplify(folder / "full.ply", ratio=0.5, out=folder / "half.stl")
    assert abs(half.triangles - len(full.faces) / 2) <= 2
    by_cli = json.loads(run_cli("compare", folder / "small.ply", folder / "full.ply", "--json").stdout)
    ours = isoweave.compare(small, full, per_vertex=True)
    assert (ours.mean, ours.rms, ours.max) == tuple(by_cli["both"][key] for key in ("mean", "rms", "max"))
    assert ours.distances.shape == (len(small.vertices),) and 0 < ours.distances.max() < 1
    with pytest.raises(ValueError, match="error"):
        isoweave.simplify(full)
    with pytest.raises(ValueError, match="faces"):
        isoweave.simplify((full.vertices, full.faces + 1), ratio=0.5)
    with pytest.raises(ValueError, match="faces"):
        isoweave.check((full.vertices, full.faces - 1))
    assert isoweave.simplify(full, ratio=0.3, largest=True).report.components_dropped == 1


def test_check_is_about_the_triangles() -> None:
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    faces = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    closed = isoweave.check((vertices, faces), self_intersections=True)
    assert closed and closed.volume == pytest.approx(1 / 6) and closed.self_intersections["pairs"] == 0
    opened = isoweave.check((vertices, faces[:3]))
    assert not opened and not opened.closed and opened.manifold
    turned = isoweave.check((vertices, np.concatenate([faces[:3], faces[3:, ::-1]])))
    assert not turned and not turned.oriented
    assert not isoweave.check((vertices, faces[:0]))


def test_forecast(volume: np.ndarray) -> None:
    forecast = isoweave.forecast(volume, 100)
    extracted = isoweave.mesh(volume, 100).report.triangles_extracted
    assert 0.5 * extracted < forecast.triangles_extracted < 2 * extracted
    assert forecast.peak_bytes > 0 and forecast.seconds >= 0
    extracted = isoweave.mesh(volume, 100, extractor="tetrahedra").report.triangles_extracted
    of_tetrahedra = isoweave.forecast(volume, 100, extractor="tetrahedra").triangles_extracted
    assert forecast.triangles_extracted < 0.5 * of_tetrahedra and 0.5 * extracted < of_tetrahedra < 2 * extracted
    with pytest.raises(ValueError, match="extractor"):
        isoweave.forecast(volume, 100, extractor="cube")  # type: ignore[arg-type]


def test_volumes(volume: np.ndarray) -> None:
    opened = isoweave.open_volume(volume, spacing=SPACING, origin=ORIGIN)
    assert (opened.shape, opened.spacing, opened.origin, opened.dtype) == (volume.shape, SPACING, ORIGIN, np.uint8)
    np.testing.assert_array_equal(opened[3:9:2], volume[3:9:2])
    np.testing.assert_array_equal(opened[-1], volume[-1])
    np.testing.assert_array_equal(np.asfortranarray(volume)[5], isoweave.open_volume(np.asfortranarray(volume))[5])
    part = opened.crop(np.s_[5:, :-2, 3:20])
    np.testing.assert_array_equal(part[2], volume[7, :-2, 3:20])
    assert part.origin == (3 + 3 * 0.5, -2.0, 10 + 5 * 1.25)
    counts, edges = opened.histogram()
    expected, expected_edges = np.histogram(volume, 256)
    np.testing.assert_array_equal(counts, expected)
    np.testing.assert_allclose(edges, expected_edges)
    blocks = volume[:, :, :].astype(float).reshape(15, 2, 17, 2, 19, 2).mean(axis=(1, 3, 5))
    np.testing.assert_allclose(opened.downsample(2)[:], blocks, rtol=1e-6)
    for key in (99, np.s_[0, 0], np.s_[::-1]):
        with pytest.raises(IndexError):
            opened[key]


def test_values_as_large_as_floats_go() -> None:
    z, y, x = np.ogrid[-1:1:12j, -1:1:12j, -1:1:12j]
    field = 0.8 - np.sqrt(x * x + y * y + z * z)
    wide = field / np.abs(field).max() * 1.7e308
    counts, edges = isoweave.open_volume(wide).histogram()
    assert counts.sum() == wide.size
    assert (edges[0], edges[-1]) == (wide.min(), wide.max())
    assert np.all(np.diff(edges / 2) > 0)
    high = (wide / 4 + 1.2e308).astype(np.float64)  # the sum of the least and the largest value overflows
    faces = isoweave.compat.marching_cubes(high)[1]
    assert len(faces) == len(isoweave.compat.marching_cubes(high / 1e300)[1]) > 100


def test_drop_in_for_scikit_image(volume: np.ndarray) -> None:
    measure = pytest.importorskip("skimage.measure")
    smooth = volume.astype(np.float32)
    # Not at a sample's very value, where the two take different sides.
    for direction in ("descent", "ascent"):
        options = {"spacing": (1.25, 0.75, 0.5), "gradient_direction": direction}
        verts, faces, normals, values = isoweave.compat.marching_cubes(smooth, 100.3, **options)
        theirs = measure.marching_cubes(smooth, 100.3, **options)
        assert abs(signed_volume(verts, faces)) > 1000
        assert signed_volume(verts, faces) == pytest.approx(signed_volume(theirs[0], theirs[1]), rel=2e-3)
        for ours, other in zip((verts, faces, normals, values), theirs):
            assert (ours.dtype.kind, ours.shape[1:]) == (other.dtype.kind, other.shape[1:])
        order = [np.lexsort(np.round(v, 3).T) for v in (verts, theirs[0])]
        np.testing.assert_allclose(verts[order[0]].min(axis=0), theirs[0][order[1]].min(axis=0), atol=2e-2)
        distance = isoweave.compare((verts, faces), (theirs[0], theirs[1]), samples=20000)
        assert distance.max < 0.35 and distance.rms < 0.02
        nearest = [np.argmin(np.linalg.norm(theirs[0] - vertex, axis=1)) for vertex in verts[::50]]
        assert np.mean(np.einsum("ij,ij->i", normals[::50], theirs[2][nearest])) > 0.8  # theirs are those of cubic voxels
    assert len(isoweave.compat.marching_cubes(smooth, 100.3, error="0.3vox")[1]) < len(faces) / 2


def test_conversions(volume: np.ndarray, folder: pathlib.Path) -> None:
    mesh = isoweave.mesh(volume, 100, normals="gradient", values=volume)
    napari_vertices, napari_faces, _ = mesh.to_napari()
    assert signed_volume(napari_vertices, napari_faces) == pytest.approx(signed_volume(*mesh))
    for name in ("pyvista", "vtk", "trimesh", "meshio"):
        pytest.importorskip(name)
        other = getattr(mesh, f"to_{name}")()
        assert isoweave.check(other).digest == mesh.digest, name
    import pyvista

    surface = mesh.to_pyvista()
    assert surface.is_all_triangles and surface.volume == pytest.approx(signed_volume(*mesh), rel=1e-4)
    assert isoweave.simplify(surface, ratio=0.5).report.triangles <= len(mesh.faces) // 2
    quads = pyvista.Plane().cast_to_unstructured_grid().extract_surface()
    with pytest.raises(ValueError, match="triangulate"):
        isoweave.check(quads)


def test_pyvista_accessor(volume: np.ndarray, wanted: str) -> None:
    pyvista = pytest.importorskip("pyvista", minversion="0.48")
    grid = pyvista.ImageData(dimensions=volume.shape[::-1], spacing=SPACING, origin=ORIGIN)
    grid.point_data["ct"] = volume.ravel()
    contour = grid.isoweave.contour(100, error="0.2vox")
    assert contour.field_data["isoweave digest"][0] == wanted
    check = contour.isoweave.check()
    assert check.digest == wanted and check
    fewer = contour.isoweave.simplify(ratio=0.5)
    assert fewer.n_cells <= contour.n_cells // 2 and contour.isoweave.compare(fewer).rms > 0
    mask = pyvista.ImageData(dimensions=volume.shape[::-1])
    mask.point_data["labels"] = (volume.ravel() >= 100).astype(np.uint8) * 5
    assert mask.isoweave.labels().keys() == ["5"]
    several = grid.isoweave.contour([100, 150])
    assert several.keys() == ["100", "150"] and several[0].field_data["isoweave digest"][0] == wanted
    assert grid.isoweave.contour(100, lods=["0.1vox", "0.2vox"])[1].field_data["isoweave digest"][0] == wanted
    dual = isoweave.mesh(volume, 100, spacing=SPACING, origin=ORIGIN, extractor="dual")
    assert grid.isoweave.contour(100, extractor="dual").field_data["isoweave digest"][0] == dual.digest != wanted


def test_html(volume: np.ndarray) -> None:
    mesh = isoweave.mesh(volume, 100)
    page = mesh._repr_html_()
    assert mesh.digest in page and page.startswith("<p>")
    if "<iframe" in page:
        assert "&lt;canvas" in page or "&lt;script" in page
