#!/usr/bin/env python3
"""Reads meshes with levels of detail back by cloud-volume, as programs around neuroglancer do, and compares each level
with the PLY file of the same run. Fragments must fit together without a gap, hold every triangle once, and lie where the
manifest says. The same for a folder of many objects.

    tests/oracles/neuroglancer.py build/release/isoweave

Exits with 77, which means skipped, where cloud-volume (`pip install cloud-volume`) is missing.
"""
import json
import os
import sys
import tempfile

from oracle import SKIP, Oracle, ply_triangles

try:
    import numpy as np
    from cloudvolume import CloudVolume
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(SKIP)

VOLUME = "generate:gyroid:112x96x80:uint8"
LEVELS = "0,0.2vox,1vox"
SEGMENT = 2**63 + 9
STEPS = 65535
MIDDLE = 32768


def open_mesh(folder, name):
    """The source of meshes of a segmentation that has them in a folder of this name."""
    scale = {"key": "1_1_1", "resolution": [1, 1, 1], "size": [1, 1, 1], "chunk_sizes": [[1, 1, 1]], "encoding": "raw"}
    info = {"type": "segmentation", "data_type": "uint64", "num_channels": 1, "mesh": name, "scales": [scale]}
    with open(os.path.join(folder, "info"), "w") as out:
        json.dump(info, out)
    return CloudVolume(f"file://{folder}", progress=False).mesh


def in_steps(mesh, manifest, level):
    """The triangles of a fragment in steps of the level, from the corner of the octree."""
    side = manifest.chunk_shape.astype(float) * 2**level
    corners = (np.asarray(mesh.vertices, float) * 1e-6 - manifest.grid_origin) / side * STEPS
    return np.round(corners).astype(np.int64)[mesh.faces]


def volume_and_area(triangles):
    t = np.asarray(triangles, float)
    normals = np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0])
    return np.einsum("ij,ij->", t[:, 0], normals) / 6, np.linalg.norm(normals, axis=1).sum() / 2


def open_edges(triangles):
    """How many edges are not gone through as often one way as the other."""
    ends = np.concatenate([triangles[:, [a, (a + 1) % 3]] for a in range(3)])
    _, points = np.unique(ends.reshape(-1, 3), axis=0, return_inverse=True)
    points = points.reshape(-1, 2)
    up = points[:, 0] < points[:, 1]
    _, edges = np.unique(np.sort(points, axis=1), axis=0, return_inverse=True)
    return int(np.count_nonzero(np.bincount(edges.ravel(), np.where(up, 1, -1))))


def check_level(oracle, source, level, expected):
    manifest = source.get_manifest(SEGMENT)
    meshes = source.get(SEGMENT, lod=level, concat=False)[SEGMENT]
    nodes = manifest.fragment_positions[level][manifest.fragment_offsets[level] > 0]
    oracle.expect_equal(len(meshes), len(nodes), f"fragments of level {level}")
    found = []
    for node, mesh in zip(nodes, meshes):
        triangles = in_steps(mesh, manifest, level)
        inside = triangles - node.astype(np.int64) * STEPS
        oracle.expect(inside.min() >= 0 and inside.max() <= STEPS, f"level {level}: a fragment is not in its node")
        crosses = (inside.min(axis=1) < MIDDLE) & (inside.max(axis=1) > MIDDLE)
        oracle.expect(level == 0 or not crosses.any(), f"level {level}: triangles cross the middle of a node")
        found.append(triangles)
    found = np.concatenate(found)
    step = float(manifest.chunk_shape[0]) * 2**level / STEPS
    exact = (expected.astype(float) - manifest.grid_origin) / step
    oracle.expect_equal(open_edges(found), 0, f"open edges of level {level}")
    for name, a, b in zip(("volume", "area"), volume_and_area(found), volume_and_area(exact)):
        oracle.expect_near(a / b, 1, 1e-4, f"{name} of level {level}")
    places = set(map(tuple, found.reshape(-1, 3)))
    sure = exact[(np.abs(exact % 1 - 0.5) > 0.01).all(axis=(1, 2))]
    missing = sum(tuple(place) not in places for place in np.round(sure).astype(np.int64).reshape(-1, 3))
    oracle.expect_equal(missing, 0, f"vertices that level {level} lacks")
    print(f"level {level}: {len(nodes)} fragments, {len(expected)} triangles in {len(found)}")
    return len(nodes)


def label_map(cubes):
    """Boxes that lie apart, each with a number of its own, of up to 64 bits."""
    samples = np.zeros((5 * cubes,) * 3, np.uint64)
    numbers = np.arange(1, cubes**3 + 1, dtype=np.uint64) ** np.uint64(5) * np.uint64(1_000_003)
    for n, (k, j, i) in enumerate(np.ndindex(cubes, cubes, cubes)):
        samples[5 * k:5 * k + 1 + n % 4, 5 * j:5 * j + 3, 5 * i:5 * i + 2] = numbers[n]
    return samples, numbers


def check_objects(oracle, folder):
    """Objects of a folder with many are where the hash of their numbers says."""
    samples, numbers = label_map(11)
    np.save(f"{folder}/labels.npy", samples)
    chosen = numbers[::97]
    run = ["mesh", f"{folder}/labels.npy", "--unit", "mm", "--normals", "none", "--quiet"]
    oracle.run(*run, "--labels", "all", "--one-file", "--compress", "-o", f"{folder}/all.precomputed")
    oracle.run(*run, "--labels", ",".join(map(str, chosen)), "-o", f"{folder}/one.ply")
    source = open_mesh(folder, "all.precomputed")
    with open(f"{folder}/all.precomputed/info") as info:
        oracle.expect(json.load(info)["sharding"]["minishard_bits"] > 0, "objects are dealt out")
    missing = [int(n) for n, there in zip(numbers, source.exists(list(map(int, numbers)))) if there is None]
    oracle.expect_equal(missing, [], "objects that are not found")
    for number in map(int, chosen):
        manifest = source.get_manifest(number)
        found = np.concatenate([in_steps(mesh, manifest, 0) for mesh in source.get(number, concat=False)[number]])
        expected = ply_triangles(f"{folder}/one_label{number}.ply").astype(float)
        exact = (expected - manifest.grid_origin) / float(manifest.chunk_shape[0]) * STEPS
        oracle.expect_equal(open_edges(found), 0, f"open edges of {number}")
        oracle.expect_near(volume_and_area(found)[0] / volume_and_area(exact)[0], 1, 1e-4, f"volume of {number}")
    print(f"{len(numbers)} objects")


def main():
    oracle = Oracle(os.path.abspath(sys.argv[1]))
    with tempfile.TemporaryDirectory() as folder:
        run = ["mesh", VOLUME, "--iso", "127.5", "--lods", LEVELS, "--normals", "none", "--quiet"]
        oracle.run(*run, "-o", f"{folder}/a.ply")
        packed = [*run, "--one-file", "--compress", "--segment", SEGMENT]
        oracle.run(*packed, "-o", f"{folder}/a.precomputed", "--blocks", "40")
        source = open_mesh(folder, "a.precomputed")
        fragments = [check_level(oracle, source, n, ply_triangles(f"{folder}/a_lod{n}.ply")) for n in range(3)]
        oracle.expect(min(fragments[:2]) > 1, "levels are cut")
        check_objects(oracle, folder)
    oracle.finish()


main()
