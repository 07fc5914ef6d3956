"""What the scripts of this folder share: running isoweave, reading its meshes, and saying what differs."""

import contextlib
import json
import subprocess
import sys

SKIP = 77

try:
    import numpy as np
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(SKIP)


class Refused(Exception):
    """What isoweave said when it did not do what it was asked for."""


class Oracle:
    """Runs isoweave and counts what is not as expected."""

    def __init__(self, program):
        self.program = program
        self.checks = 0
        self.failures = 0

    def run(self, *arguments):
        done = subprocess.run([self.program, *map(str, arguments)], capture_output=True, text=True)
        if done.returncode != 0:
            raise Refused(done.stderr.strip())
        return done.stdout

    @contextlib.contextmanager
    def file(self, path):
        """Checks of one file: one that is refused is a failure, but for formats that the build leaves out."""
        try:
            yield
        except Refused as error:
            if "a format of this build" in str(error):
                print(f"left out: {error}")
            else:
                self.expect(False, f"{path}: {error}")

    def info(self, path, *options):
        return json.loads(self.run("info", path, "--json", *options))["input"]

    def mesh(self, path, mesh, *options):
        """Meshes a volume, and returns what isoweave checks of the mesh."""
        self.run("mesh", path, "-o", mesh, "--quiet", *options)
        return self.check(mesh)

    def check(self, mesh):
        return json.loads(self.run("check", mesh, "--json"))

    def expect(self, right, what):
        self.checks += 1
        if not right:
            self.failures += 1
            print(f"FAILED: {what}")

    def expect_equal(self, found, expected, what):
        self.expect(found == expected, f"{what}: expected {expected}, found {found}")

    def expect_near(self, found, expected, tolerance, what):
        worst = float(np.max(np.abs(np.asarray(found, float) - np.asarray(expected, float))))
        self.expect(worst <= tolerance, f"{what}: off by {worst}, found {found}, expected {expected}")

    def finish(self):
        print(f"{self.checks} checks, {self.failures} failed")
        sys.exit(1 if self.failures else 0)


def affine_of(info):
    """The 4 x 4 matrix from samples to the world."""
    affine = np.eye(4)
    affine[:3, :3] = np.reshape(info["direction"], (3, 3)) * np.asarray(info["spacing"])
    affine[:3, 3] = info["origin"]
    return affine


def ras(affine):
    """An LPS matrix as RAS, or the other way round."""
    return np.diag([-1, -1, 1, 1]) @ affine


def ply_vertices(path, properties=3):
    """The vertices of a binary little-endian PLY file, of so many floats each: positions, and what follows them."""
    with open(path, "rb") as file:
        count = 0
        while (line := file.readline().strip()) != b"end_header":
            if line.startswith(b"element vertex"):
                count = int(line.split()[2])
        return np.frombuffer(file.read(4 * properties * count), "<f4").reshape(-1, properties).astype(float)


def ply_triangles(path, properties=3):
    """The corners of all triangles of such a file, which has its faces behind the vertices."""
    with open(path, "rb") as file:
        counts = {}
        while (line := file.readline().strip()) != b"end_header":
            if line.startswith(b"element"):
                counts[line.split()[1]] = int(line.split()[2])
        points = np.frombuffer(file.read(4 * properties * counts[b"vertex"]), "<f4").reshape(-1, properties)
        faces = np.frombuffer(file.read(), np.dtype([("count", "u1"), ("corners", "<u4", 3)]), counts[b"face"])
    return points[:, :3].astype(float)[faces["corners"]]
