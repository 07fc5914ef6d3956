"""isoweave beside the packages with which Python users make and simplify iso-surfaces: one scan, one count of triangles.

    pip install numpy scikit-image fast-simplification PyMCubes pymeshlab pyvista meshlib zmesh open3d isoweave.whl
    python bench/python/compare.py VOLUME.npy LEVEL SPACING_Z,Y,X TRIANGLES [ROUNDS]

Each contestant runs in a process of its own, in turn, who begins changes. Time is that from the array to the arrays of the
mesh, by the clock and of all processors together, which a busy machine disturbs less; memory is the peak of the process
above what its packages and the volume take. A line for each: times and memory in terms of isoweave's of the same round, as
medians of the rounds; triangles; RMS distance to the full surface, both ways; whether the mesh is manifold. Then the versions.
zmesh makes the surface of a mask, and no iso-surface. Open3D needs libusb-1.0-0 of Debian.
"""

import importlib.metadata
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np

PACKAGES = "scikit-image fast-simplification PyMCubes pymeshlab pyvista meshlib zmesh open3d".split()


def run_isoweave(volume, level, spacing, triangles, threads=0):
    import isoweave

    def work():
        mesh = isoweave.mesh(volume, level, triangles=triangles, spacing=spacing[::-1], closed=False, threads=threads)
        return mesh.vertices, mesh.faces

    return work


def run_skimage_fast(volume, level, spacing, triangles):
    import fast_simplification
    from skimage import measure

    def work():
        vertices, faces, _, _ = measure.marching_cubes(volume, level, spacing=spacing)
        vertices, faces = fast_simplification.simplify(vertices.astype(np.float32), faces, target_count=triangles)
        return vertices[:, ::-1], faces

    return work


def run_pyvista(volume, level, spacing, triangles):
    import pyvista

    def work():
        grid = pyvista.ImageData(dimensions=volume.shape[::-1], spacing=spacing[::-1])
        grid.point_data["values"] = volume.ravel()
        surface = grid.contour([level], method="flying_edges")
        surface = surface.decimate(1 - triangles / surface.n_cells)
        return surface.points, surface.regular_faces

    return work


def run_pymcubes_fast(volume, level, spacing, triangles):
    import fast_simplification
    import mcubes

    def work():
        vertices, faces = mcubes.marching_cubes(volume, level)
        vertices, faces = fast_simplification.simplify(
            (vertices * spacing).astype(np.float32), faces.astype(np.int32), target_count=triangles
        )
        return vertices[:, ::-1], faces

    return work


def run_skimage_pymeshlab(volume, level, spacing, triangles):
    import pymeshlab
    from skimage import measure

    def work():
        vertices, faces, _, _ = measure.marching_cubes(volume, level, spacing=spacing)
        meshes = pymeshlab.MeshSet()
        meshes.add_mesh(pymeshlab.Mesh(vertices[:, ::-1].astype(np.float64), faces))
        meshes.meshing_decimation_quadric_edge_collapse(targetfacenum=triangles)
        mesh = meshes.current_mesh()
        return mesh.vertex_matrix(), mesh.face_matrix()

    return work


def run_meshlib(volume, level, spacing, triangles):
    from meshlib import mrmeshnumpy, mrmeshpy

    def work():
        voxels = mrmeshnumpy.simpleVolumeFrom3Darray(np.ascontiguousarray(volume.transpose(2, 1, 0), dtype=np.float32))
        voxels.voxelSize = mrmeshpy.Vector3f(*spacing[::-1])
        settings = mrmeshpy.MarchingCubesParams()
        settings.iso = level
        mesh = mrmeshpy.marchingCubes(voxels, settings)
        mesh.packOptimally()
        decimate = mrmeshpy.DecimateSettings()
        decimate.maxError = 1e30
        decimate.maxDeletedFaces = mesh.topology.numValidFaces() - triangles
        decimate.packMesh = True
        mrmeshpy.decimateMesh(mesh, decimate)
        return mrmeshnumpy.getNumpyVerts(mesh), mrmeshnumpy.getNumpyFaces(mesh.topology)

    return work


def run_zmesh(volume, level, spacing, triangles):
    import zmesh

    def work():
        mesher = zmesh.Mesher(spacing[::-1])
        mesher.mesh(np.asfortranarray((volume >= level).astype(np.uint8).transpose(2, 1, 0)))
        full = mesher.get(1)
        mesh = mesher.simplify(full, reduction_factor=max(1, len(full.faces) // triangles), max_error=1e9)
        return mesh.vertices, mesh.faces

    return work


def run_open3d(volume, level, spacing, triangles):
    import open3d

    def work():
        samples = open3d.core.Tensor(volume.astype(np.float32))
        surface = open3d.t.geometry.TriangleMesh.create_isosurfaces(samples, [level]).to_legacy()
        mesh = surface.simplify_quadric_decimation(triangles)
        return np.asarray(mesh.vertices) * spacing[::-1], np.asarray(mesh.triangles)

    return work


RUNNERS = {
    "isoweave": run_isoweave,
    "isoweave, one thread": lambda *task: run_isoweave(*task, threads=1),
    "scikit-image + fast-simplification": run_skimage_fast,
    "PyMCubes + fast-simplification": run_pymcubes_fast,
    "scikit-image + pymeshlab": run_skimage_pymeshlab,
    "PyVista: flying edges, `decimate`": run_pyvista,
    "MeshLib": run_meshlib,
    "zmesh, of the mask": run_zmesh,
    "Open3D: `create_isosurfaces`, quadric decimation": run_open3d,
}


def resident(key):
    """What is resident of this process in bytes, now (VmRSS) or at its peak (VmHWM)."""
    for line in pathlib.Path("/proc/self/status").read_text().splitlines():
        if line.startswith(f"{key}:"):
            return int(line.split()[1]) * 1024
    raise OSError(f"/proc/self/status: expected {key}, found none")


def run_child(name, path, level, spacing, triangles, out):
    """One contestant, in this process."""
    volume = np.load(path)
    work = RUNNERS[name](volume, level, spacing, triangles)
    # The peak begins anew here: an import may take more than stays of it.
    pathlib.Path("/proc/self/clear_refs").write_text("5")
    before, start, used = resident("VmRSS"), time.perf_counter(), time.process_time()
    vertices, faces = work()
    seconds, processor = time.perf_counter() - start, time.process_time() - used
    bytes_more = resident("VmHWM") - before
    np.savez(out, vertices=np.asarray(vertices, dtype=np.float32), faces=np.asarray(faces, dtype=np.int64))
    print(json.dumps({"seconds": seconds, "processor": processor, "bytes": bytes_more}))


def measure(full, out):
    import isoweave

    arrays = np.load(out)
    mesh = arrays["vertices"], arrays["faces"]
    check = isoweave.check(mesh)
    return len(mesh[1]), isoweave.compare(mesh, full).rms, check.manifold and check.oriented


def run_rounds(rounds, full, *task):
    """Times and memory of every contestant by rounds, and what its mesh is like."""
    found = {name: {} for name in RUNNERS}
    facts = {}
    names = list(RUNNERS)
    with tempfile.TemporaryDirectory() as folder:
        out = str(pathlib.Path(folder) / "mesh.npz")
        for number in range(rounds):
            first = number % len(names)
            for name in names[first:] + names[:first]:
                command = [sys.executable, __file__, "--child", name, *task, out]
                done = subprocess.run(command, capture_output=True, text=True, check=False)
                if done.returncode != 0:
                    print(f"{name}: {done.stderr.strip().splitlines()[-1:]}", file=sys.stderr)
                    continue
                found[name][number] = json.loads(done.stdout.splitlines()[-1])
                if name not in facts:
                    facts[name] = measure(full, out)
    return found, facts


def print_table(found, facts):
    print("| | time | processor time | memory | triangles | RMS | manifold |\n|---|---|---|---|---|---|---|")
    ours = found["isoweave"]
    for name, (count, rms, manifold) in facts.items():
        ratios = [
            statistics.median(one[key] / ours[number][key] for number, one in found[name].items() if number in ours)
            for key in ("seconds", "processor", "bytes")
        ]
        cells = [name, *(f"{ratio:.2f}" for ratio in ratios), f"{count:,}", f"{rms:.4f}", "yes" if manifold else "no"]
        print(f"| {' | '.join(cells)} |")


def main():
    path, level, spacing, triangles = sys.argv[1], float(sys.argv[2]), sys.argv[3], sys.argv[4]
    rounds = int(sys.argv[5]) if len(sys.argv) > 5 else 3
    steps = tuple(float(step) for step in spacing.split(","))
    import isoweave

    full = isoweave.mesh(np.load(path), level, error=0, spacing=steps[::-1], closed=False)
    found, facts = run_rounds(rounds, full, path, str(level), spacing, triangles)
    print(f"full surface: {len(full.faces):,} triangles; rounds: {rounds}\n")
    print_table(found, facts)
    print("\n" + ", ".join(f"{package} {importlib.metadata.version(package)}" for package in PACKAGES))


if __name__ == "__main__":
    if sys.argv[1:2] == ["--child"]:
        name, path, level, spacing, triangles, out = sys.argv[2:]
        run_child(name, path, float(level), tuple(float(step) for step in spacing.split(",")), int(triangles), out)
    else:
        main()
