"""Servers that fail, stall, throttle, cut off and change what they have."""
import os
import signal
import subprocess

import volumes
from case import ISOWEAVE, RemoteTest
from server import Fault


class Faults(RemoteTest):
    def test_faults_that_pass_cost_no_mesh(self):
        expected = self.digest(f"{self.served}/zarr2")
        for kind, more in (("status", {"status": 500}), ("status", {"status": 503}), ("status", {"status": 408}),
                           ("reset", {}), ("cut", {})):
            with self.subTest(kind, **more):
                self.server.faults, self.server.requests = [], []
                self.fail_at("/0.0.0", kind, 2, **more)
                self.fail_at(".zarray", kind, 1, **more)
                self.assertEqual(self.digest(f"{self.server.url}/zarr2"), expected)
                # Three times for the forecast, and by the sweep.
                self.assertEqual(len(self.server.asked("/0.0.0$")), 4)

    def test_faults_that_stay_are_one_line(self):
        for kind, more, says in (("status", {"status": 503}, "found status 503 after 3 tries"),
                                 ("reset", {}, "after 3 tries"), ("cut", {}, "after 3 tries"),
                                 ("status", {"status": 403}, "found status 403\n"),
                                 ("status", {"status": 501}, "found status 501\n")):
            with self.subTest(kind, **more):
                self.server.faults, self.server.requests = [], []
                self.fail_at("/1.0.0", kind, **more)
                self.expect_refused(f"{self.server.url}/zarr2",
                                    f"isoweave: {self.server.url}/zarr2/1.0.0: expected the object, found ", says)
                # curl asks again by itself where a connection that was used before breaks.
                if kind != "reset":
                    self.assertEqual(len(self.server.asked("/1.0.0$")), 3 if "tries" in says else 1)

    def test_nobody_listens(self):
        self.server.close()
        self.expect_refused(f"{self.server.url}/zarr2", f"{self.server.url}/zarr2/zarr.json: expected the object",
                            "after 3 tries")

    def test_a_server_that_stalls_is_asked_again(self):
        expected = self.digest(f"{self.served}/zarr2")
        self.environment["ISOWEAVE_REMOTE_TIMEOUT"] = "0.5"
        self.fail_at("/0.0.0", "stall", 1)
        self.assertEqual(self.digest(f"{self.server.url}/zarr2"), expected)
        self.fail_at("/1.0.0", "stall")
        self.expect_refused(f"{self.server.url}/zarr2", "/1.0.0: expected the object, found no byte for 0.5 seconds "
                                                        "after 3 tries")

    def test_ctrl_c_ends_a_stall(self):
        for ending in (".zarray", "/0.0.0"):
            with self.subTest(ending):
                self.server.stalled.clear()
                self.server.faults = [Fault(ending, "stall")]
                process = subprocess.Popen([ISOWEAVE, "mesh", f"{self.server.url}/zarr2", "--iso", "100", "-o", "c.ply",
                                            "--quiet"], cwd=self.folder, env=self.environment, stderr=subprocess.PIPE,
                                           text=True)
                self.assertTrue(self.server.stalled.wait(60))
                process.send_signal(signal.SIGINT)
                # A request may wait for 30 seconds, three times.
                _, err = process.communicate(timeout=20)
                self.assertEqual(process.returncode, 130, err)
                self.assertEqual(err.count("\n"), 1, err)
                self.assertEqual(os.listdir(self.folder), ["served"])

    def test_a_server_that_throttles_is_given_the_time_it_asks_for(self):
        expected = self.digest(f"{self.served}/zarr2")
        self.environment["ISOWEAVE_REMOTE_TRIES"] = "2"
        self.fail_at("/0.0.0", "throttle")
        self.assertEqual(self.digest(f"{self.server.url}/zarr2"), expected)
        self.assertEqual(len(self.server.asked("/0.0.0$")), 3)  # twice for the forecast

    def test_chunks_that_are_not_there_are_the_fill_value(self):
        os.remove(f"{self.served}/zarr2/1.1.1")
        expected = self.digest(f"{self.served}/zarr2")
        self.assertEqual(self.digest(f"{self.server.url}/zarr2"), expected)
        self.assertNotEqual(self.digest(f"{self.served}/n5"), expected)

    def test_bodies_and_ranges_that_are_wrong(self):
        self.fail_at("/1.0.0", "long")
        self.expect_refused(f"{self.server.url}/zarr2", "/zarr2/1.0.0: expected at most ", ", found more")
        self.fail_at("/c/0/0/0", "no_ranges")
        self.expect_refused(f"{self.server.url}/shards", "/c/0/0/0: expected a server that sends parts of objects "
                                                         "(status 206), found one that sends the whole (status 200)")
        for says in ("bytes 0-0/1", "bytes 5-1/9", "", "bytes */77", "bytes 18446744073709551616-1/2"):
            self.server.faults = []
            self.fail_at("/c/0/0/0", "wrong_range", says=says)
            self.expect_refused(f"{self.server.url}/shards", "/c/0/0/0: expected bytes ", f"as '{says}'")

    def test_an_object_that_changes_while_it_is_read(self):
        self.fail_at("/c/0/0/0", "etag")
        self.expect_refused(f"{self.server.url}/shards", "/c/0/0/0: expected an object that stays as it is while it is "
                                                         "read (", '"another-')

    def test_what_is_no_volume(self):
        self.expect_refused(f"{self.server.url}/nothing", f"{self.server.url}/nothing: expected the metadata of ",
                            "found none\n")
        volumes.put_json(f"{self.served}/broken/.zarray", [])
        volumes.put(f"{self.served}/page/zarr.json", b"<html>")
        self.expect_refused(f"{self.server.url}/page", "/page/zarr.json: expected JSON")
        self.expect_refused(f"{self.server.url}/broken", "/broken/.zarray: expected")
        raw = self.run_isoweave("info", f"{self.server.url}/a.raw", "--raw", "2x2x2:uint8")
        self.assertEqual(raw.returncode, 3)
        self.assertIn("expected a file, which --raw describes, found a URL", raw.stderr)
        self.expect_refused("http:///a", "expected a URL with a host")
        index = self.run_isoweave("index", f"{self.server.url}/zarr2")
        self.assertEqual(index.returncode, 3, index.stderr)
        self.assertIn("expected a volume in files", index.stderr)

    def test_wrong_settings(self):
        for name, value in (("TIMEOUT", "0"), ("TIMEOUT", "soon"), ("TRIES", "0"), ("REQUESTS", "1e9"), ("AHEAD", "-1")):
            self.environment[f"ISOWEAVE_REMOTE_{name}"] = value
            process = self.run_isoweave("info", f"{self.server.url}/zarr2")
            self.assertEqual(process.returncode, 2, process.stderr)
            self.assertIn(f"ISOWEAVE_REMOTE_{name}: expected ", process.stderr)
            del self.environment[f"ISOWEAVE_REMOTE_{name}"]
