"""The programs of a build, and the files that they write and read."""
import json
import pathlib
import resource
import subprocess
import sys

import numpy as np

from measures import read_triangles


def write_volume(path, samples):
    """Writes samples of 8 bits, by [z, y, x], as a raw NRRD file with spacing 1."""
    sizes = " ".join(map(str, samples.shape[::-1]))
    with path.open("wb") as file:
        file.write(f"NRRD0004\ntype: uint8\ndimension: 3\nsizes: {sizes}\nspacings: 1 1 1\nencoding: raw\n\n".encode())
        np.ascontiguousarray(samples, np.uint8).tofile(file)


def read_samples(path):
    """The samples of a raw NRRD file of a program of ours, by [z, y, x]."""
    with path.open("rb") as file:
        lines = iter(lambda: file.readline().decode().rstrip("\n"), "")
        fields = dict(line.split(": ") for line in lines if ": " in line)
        begin = file.tell()
    kind = {"double": np.float64, "float": np.float32, "uint8": np.uint8}[fields["type"]]
    sizes = [int(size) for size in fields["sizes"].split()]
    return np.memmap(path, kind, "r", begin, tuple(sizes[::-1]))


class Programs:
    """The programs, and a folder for what they write."""

    def __init__(self, build, folder):
        self.build, self.folder = pathlib.Path(build), pathlib.Path(folder)

    def run(self, name, *words):
        # A shell starts the program: the system counts the memory of whoever starts a program as the program's own.
        command = ["sh", "-c", '"$@"; exit $?', "sh", self.build / name, *map(str, words)]
        done = subprocess.run(command, stdout=subprocess.PIPE, text=True)
        if done.returncode != 0:
            sys.exit(f"{name} {' '.join(map(str, words))}: expected exit code 0, found {done.returncode}")
        return done.stdout

    def mesh(self, volume, iso, *options, name="mesh.ply"):
        """The file and the report of an open surface."""
        out, report = self.folder / name, self.folder / "report.json"
        self.run("isoweave", "mesh", volume, "--iso", iso, "--open", *options, "-o", out, "--report", report, "--quiet")
        return out, json.loads(report.read_text())

    def by_method(self, volume, iso, error, method, *layers, name="method.ply"):
        """The file and the counts of a surface by a method of bench_baselines; the error is in voxels."""
        out = self.folder / name
        return out, json.loads(self.run("bench_baselines", volume, iso, error, method, out, *layers))

    def processor_seconds(self, *words):
        """What `mesh` takes of processors, all threads together. Others that use the machine hardly change it."""
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        result = self.mesh(*words)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, *result

    def triangles(self, volume, iso, error, method, *layers):
        return read_triangles(self.by_method(volume, iso, error, method, *layers)[0])

    def distance(self, mesh, to):
        """The RMS distance of points of a mesh to another one."""
        return json.loads(self.run("isoweave", "compare", mesh, to, "--json"))["a_to_b"]["rms"]

    def part(self, volume, first, end):
        """Samples first to end, the last not included, by [z, y, x]."""
        text = lambda numbers: ",".join(map(str, numbers))
        out = self.folder / "part.nrrd"
        self.run("bench_refine", volume, 1, text(first), text(end), out)
        return read_samples(out)

    def formula(self, kind, dims):
        """Samples of a formula, by [z, y, x]."""
        out = self.folder / "formula.nrrd"
        self.run("isoweave", "generate", kind, "--size", "x".join(map(str, dims)), "-o", out, "--quiet")
        return read_samples(out)
