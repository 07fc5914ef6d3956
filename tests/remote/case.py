"""The ground of all tests of volumes by URL: a server that counts what is asked and fails on cue, and the program."""
import contextlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

import precomputed
import volumes
from server import Fault, Server

ISOWEAVE = os.path.abspath(sys.argv.pop(1))
SECRET = "verysecretword"
VARIABLES = ("AWS_", "GOOGLE_", "STORAGE_", "ISOWEAVE_", "http_proxy", "HTTP_PROXY", "all_proxy", "ALL_PROXY")
LAYOUTS = {"zarr2": volumes.put_zarr2, "zarr3": volumes.put_zarr3,
           "shards": lambda folder: volumes.put_zarr3(folder, shards=True), "n5": volumes.put_n5}
IDENTITY = {"preshift_bits": 1, "minishard_bits": 2, "shard_bits": 1, "hash": "identity", "data_encoding": "raw",
            "minishard_index_encoding": "raw"}
HASHED = {"preshift_bits": 0, "minishard_bits": 1, "shard_bits": 5, "hash": "murmurhash3_x86_128",
          "data_encoding": "gzip", "minishard_index_encoding": "gzip"}
PRECOMPUTED = {"raw": {}, "segmentation": {"encoding": "compressed_segmentation", "kind": "I"},
               "identity": {"sharding": IDENTITY}, "hashed": {"sharding": HASHED},
               "all": {"encoding": "compressed_segmentation", "kind": "Q", "sharding": HASHED}}
# Where the samples of other layouts lie.
PLACE = ("--spacing", "1", "--origin", "0,0,0", "--unit", "mm")


class RemoteTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.volumes = tempfile.mkdtemp()
        for name, put in LAYOUTS.items():
            put(f"{cls.volumes}/{name}")
        for name, options in PRECOMPUTED.items():
            precomputed.put_precomputed(f"{cls.volumes}/precomputed-{name}", **options)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.volumes)

    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        self.served = f"{self.folder}/served"
        shutil.copytree(self.volumes, self.served)
        self.server = Server(self.served)
        self.addCleanup(self.server.close)
        self.environment = {name: value for name, value in os.environ.items() if not name.startswith(VARIABLES)}
        self.environment.update(ISOWEAVE_REMOTE_TRIES="3", no_proxy="*")

    def fail_at(self, ending, kind, times=None, **more):
        self.server.faults.append(Fault(ending, kind, times, **more))

    def run_isoweave(self, *arguments):
        return subprocess.run([ISOWEAVE, *arguments], cwd=self.folder, env=self.environment, capture_output=True,
                              text=True, timeout=120)

    def mesh(self, volume, *more):
        """The process, and the digest of the mesh where there is one."""
        out = f"{self.folder}/mesh.ply"
        report = f"{self.folder}/report.json"
        for path in (out, report):
            with contextlib.suppress(FileNotFoundError):
                os.remove(path)
        process = self.run_isoweave("mesh", volume, "--iso", volumes.ISO, "--error", "0.3vox", "-o", out, "--report",
                                    report, *more)
        if process.returncode != 0:
            self.assertFalse(os.path.exists(out))
            return process, None
        with open(report, encoding="utf-8") as file:
            return process, json.load(file)["digest"]

    def sweep(self, volume):
        """Reads the volume once. In slabs a run with a report reads one as small as this twice, first for its forecast."""
        self.digest(volume, "--blocks", "64")

    def digest(self, volume, *more):
        process, digest = self.mesh(volume, *more)
        self.assertEqual(process.returncode, 0, process.stderr)
        return digest

    def expect_refused(self, volume, *says):
        process, _ = self.mesh(volume)
        self.assertEqual(process.returncode, 3, process.stderr)
        self.assertEqual(process.stderr.count("\n"), 1, process.stderr)
        for words in says:
            self.assertIn(words, process.stderr)
        return process.stderr
