#!/usr/bin/env python3
"""Compares `isoweave check --self-intersections` with all pairs of triangles in rational numbers, on small meshes: points
of a lattice, where most pairs touch or lie in one plane; points within rounding of one plane; exponents of all sizes; and
what `isoweave mesh` makes of noise.

    tests/oracles/intersections.py build/release/isoweave

What two triangles have in common is convex, and every corner of it lies on a side of one of them and in the other. So
all sides are cut with the other triangle, and the ends are compared with what the triangles share.

Exits with 77, which means skipped, where NumPy is missing.
"""
import itertools
import json
import os
import random
import sys
import tempfile
from fractions import Fraction

from oracle import Oracle

import numpy as np


def minus(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def normal_of(t):
    return cross(minus(t[1], t[0]), minus(t[2], t[0]))


def clipped(start, way, low, high, triangle, normal):
    """The part [low, high] of the points start + s way of the triangle's plane that is inside its three sides."""
    for n in range(3):
        side = minus(triangle[(n + 1) % 3], triangle[n])
        height = dot(normal, cross(side, minus(start, triangle[n])))
        rise = dot(normal, cross(side, way))
        if rise == 0:
            if height < 0:
                return None
            continue
        zero = -height / rise
        low, high = (max(low, zero), high) if rise > 0 else (low, min(high, zero))
    return (low, high) if low <= high else None


def common_ends(a, b, triangle):
    """The ends of what the segment from a to b has in common with a triangle."""
    normal = normal_of(triangle)
    way = minus(b, a)
    height, rise = dot(normal, minus(a, triangle[0])), dot(normal, way)
    if rise == 0:
        part = clipped(a, way, Fraction(0), Fraction(1), triangle, normal) if height == 0 else None
    else:
        s = -height / rise
        part = clipped(a, way, s, s, triangle, normal) if 0 <= s <= 1 else None
    return [tuple(a[n] + s * way[n] for n in range(3)) for s in part] if part else []


def meet_beyond(points, s, t):
    shared = [points[v] for v in set(s) & set(t)]
    if len(shared) == 3:
        return True
    a, b = [points[v] for v in s], [points[v] for v in t]

    def is_shared(p):
        if len(shared) == 2:
            return cross(minus(shared[1], shared[0]), minus(p, shared[0])) == (0, 0, 0)
        return p in shared

    return any(
        not is_shared(end)
        for sides, other in ((a, b), (b, a))
        for n in range(3)
        for end in common_ends(sides[n], sides[(n + 1) % 3], other)
    )


def expected(vertices, triangles):
    points = [tuple(Fraction(float(x)) for x in v) for v in vertices]
    sound = [n for n, t in enumerate(triangles) if normal_of([points[v] for v in t]) != (0, 0, 0)]
    corners = vertices[triangles]
    low, high = corners.min(axis=1), corners.max(axis=1)
    pairs = []
    for i in sound:
        near = np.all((low <= high[i]) & (low[i] <= high), axis=1)
        pairs += [(i, j) for j in sound if j > i and near[j] and meet_beyond(points, triangles[i], triangles[j])]
    kinds = [0, 0, 0, 0]
    for i, j in pairs:
        kinds[len(set(triangles[i]) & set(triangles[j]))] += 1
    return {
        "pairs": len(pairs),
        "apart": kinds[0],
        "at_vertex": kinds[1],
        "at_edge": kinds[2] + kinds[3],
        "triangles": len(set(itertools.chain(*pairs))),
        "without_area": len(triangles) - len(sound),
        "first": [list(pair) for pair in pairs[:10]],
    }


def write_obj(path, vertices, triangles):
    with open(path, "w") as file:
        for v in vertices:
            file.write("v " + " ".join(repr(float(x)) for x in v) + "\n")
        for t in triangles:
            file.write("f " + " ".join(str(v + 1) for v in t) + "\n")


def read_obj(path):
    lines = [line.split() for line in open(path)]
    vertices = np.array([line[1:4] for line in lines if line and line[0] == "v"], dtype=np.float32)
    triangles = [[int(word.split("/")[0]) - 1 for word in line[1:]] for line in lines if line and line[0] == "f"]
    return vertices, np.array(triangles)


def lattice(chance):
    return [[chance.randrange(3) for _ in range(3)] for _ in range(24)]


def near_a_plane(chance):
    """Sums in float32, so most are off the plane by rounding, and some are not."""
    number = lambda: np.float32(chance.uniform(-1, 1))
    origin, u, v = (np.array([number() for _ in range(3)]) for _ in range(3))
    return [origin + np.float32(chance.randrange(-4, 5)) * u + number() * v for _ in range(24)]


def all_exponents(chance):
    values = [0, 1, -1, 1e-45, -1e-30, 1e-3, 3, 7e12, -1e30, 3.4e38]
    return [[chance.choice(values) for _ in range(3)] for _ in range(24)]


def check(oracle, path, vertices, triangles, what):
    found = json.loads(oracle.run("check", path, "--self-intersections", "--json"))["self_intersections"]
    wanted = expected(vertices, triangles)
    oracle.expect_equal(found, wanted, what)
    return wanted["pairs"]


def main():
    oracle = Oracle(os.path.abspath(sys.argv[1]))
    chance = random.Random(7)
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "a.obj")
        for make in (lattice, near_a_plane, all_exponents):
            pairs = 0
            for n in range(3):
                vertices = np.array(make(chance), dtype=np.float32)
                triangles = np.array([chance.sample(range(24), 3) for _ in range(36)])
                write_obj(path, vertices, triangles)
                pairs += check(oracle, path, vertices, triangles, f"{make.__name__} {n}")
            oracle.expect(pairs > 100, f"{make.__name__}: {pairs} pairs in all")
        oracle.run("mesh", "generate:noise:14x14x14", "--iso", "0.5", "--error", "2vox", "--quiet", "-o", path)
        vertices, triangles = read_obj(path)
        oracle.expect(check(oracle, path, vertices, triangles, "noise") > 0, "noise: no pairs")
    oracle.finish()


if __name__ == "__main__":
    main()
