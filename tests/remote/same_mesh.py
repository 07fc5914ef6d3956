"""Volumes by URL have the mesh of their folders, and ask for what they need."""
import json
import os

import precomputed
import volumes
from case import LAYOUTS, PLACE, PRECOMPUTED, RemoteTest
from server import Server


class SameMesh(RemoteTest):
    def test_every_layout_has_the_mesh_of_its_folder(self):
        expected = self.digest(f"{self.served}/zarr2")
        for name in LAYOUTS:
            with self.subTest(name):
                self.assertEqual(self.digest(f"{self.served}/{name}"), expected)
                self.assertEqual(self.digest(f"{self.server.url}/{name}"), expected)
                self.assertEqual(self.digest(f"{self.server.url}/{name}/", "--slab", "3", "--threads", "1"), expected)

    def test_precomputed_volumes_have_the_mesh_of_other_layouts(self):
        expected = self.digest(f"{self.served}/zarr2", *PLACE)
        precomputed.put_precomputed(f"{self.served}/precomputed-files", packed=True)
        self.assertEqual(self.digest(f"{self.served}/precomputed-files", *PLACE), expected)
        self.assertEqual(self.digest(f"{self.server.url}/precomputed-files", *PLACE), expected)
        for name in PRECOMPUTED:
            with self.subTest(name):
                self.assertEqual(self.digest(f"{self.served}/precomputed-{name}", *PLACE), expected)
                self.assertEqual(self.digest(f"{self.server.url}/precomputed-{name}", *PLACE), expected)
        self.fail_at("", "packed")
        self.assertEqual(self.digest(f"{self.server.url}/precomputed-raw", *PLACE), expected)

    def test_precomputed_volumes_lie_where_neuroglancer_shows_them(self):
        info = json.loads(self.run_isoweave("info", f"{self.server.url}/precomputed-raw", "--json").stdout)["input"]
        self.assertEqual((info["format"], info["unit"], info["spacing"]), ("precomputed", "nm", [8, 8, 40]))
        self.assertEqual(info["origin"], [(o + 0.5) * r for o, r in zip(precomputed.OFFSET, (8, 8, 40))])
        self.assertEqual(self.digest(f"{self.server.url}/precomputed-raw"), self.digest(f"{self.served}/precomputed-raw"))

    def test_labels_of_64_bits(self):
        options = {"encoding": "compressed_segmentation", "kind": "Q", "value": volumes.label}
        precomputed.put_precomputed(f"{self.served}/labels", **options)
        precomputed.put_precomputed(f"{self.served}/plain", kind="Q", value=volumes.label)
        found = {}
        for volume in (f"{self.served}/labels", f"{self.server.url}/labels", f"{self.server.url}/plain"):
            run = self.run_isoweave("mesh", volume, "--labels", "7,4294967301", "-o", "l.ply", "--report", "l.json")
            self.assertEqual(run.returncode, 0, run.stderr)
            with open(f"{self.folder}/l.json", encoding="utf-8") as file:
                found[volume] = [surface["digest"] for surface in json.load(file)["labels"]]
        self.assertEqual(len(set(map(tuple, found.values()))), 1, found)
        self.assertEqual(len(set(next(iter(found.values())))), 2)

    def test_precomputed_volumes_that_are_wrong(self):
        with open(f"{self.served}/precomputed-all/info", encoding="utf-8") as file:
            good = json.load(file)
        def expect(says, **changes):
            info = json.loads(json.dumps(good))
            for key, value in changes.items():
                (info if key in info else info["scales"][0])[key] = value
            volumes.put_json(f"{self.served}/precomputed-all/info", info)
            self.expect_refused(f"{self.server.url}/precomputed-all", "/precomputed-all/info: expected ", says)
        expect("a list of scales", scales=[])
        expect("encoding raw or compressed_segmentation, found 'jpeg'", encoding="jpeg")
        expect("data_type uint32 or uint64", data_type="uint8")
        expect("a path inside the folder", key="../elsewhere")
        expect("chunk_sizes", chunk_sizes=[[8, 0, 8]])
        expect("hash identity or", sharding={**good["scales"][0]["sharding"], "hash": "sum"})
        expect("minishard_bits", sharding={**good["scales"][0]["sharding"], "minishard_bits": 60})
        expect("three numbers as 'resolution'", resolution=[1, 2])
        expect("blocks of at most 4096", compressed_segmentation_block_size=[64, 65, 1])

    def test_each_chunk_is_asked_for_once(self):
        for name, chunks in (("zarr2", r"/\d\.\d\.\d$"), ("zarr3", r"/c/"), ("n5", r"/\d/\d/\d$"),
                             ("precomputed-raw", "/8_8_40/")):
            with self.subTest(name):
                self.sweep(f"{self.server.url}/{name}")
                asked = self.server.asked(f"^/{name}{chunks}")
                self.assertEqual(len(asked), len(set(asked)))
                self.assertEqual(len(asked), len(list(volumes.grid())))

    def test_a_run_in_slabs_that_tells_no_forecast_asks_for_each_chunk_once(self):
        run = self.run_isoweave("mesh", f"{self.server.url}/zarr2", "--iso", volumes.ISO, "-o", "mesh.ply")
        self.assertEqual(run.returncode, 0, run.stderr)
        asked = self.server.asked(r"^/zarr2/\d\.\d\.\d$")
        self.assertEqual(sorted(asked), sorted(set(asked)))
        self.assertEqual(len(asked), len(list(volumes.grid())))

    def test_a_shard_is_read_in_parts_and_its_index_once(self):
        self.sweep(f"{self.server.url}/shards")
        parts = [(r.path, r.range) for r in self.server.requests if r.method == "GET" and "/c/" in r.path]
        self.assertTrue(all(wanted for _, wanted in parts))
        self.assertEqual(len(parts), len(set(parts)))
        shards = {path for path, _ in parts}
        self.assertEqual(len(parts), len(list(volumes.grid())) + len(shards))
        self.assertEqual(sorted(self.server.asked("/c/", "HEAD")), sorted(shards))

    def test_several_requests_are_open_at_a_time_and_no_more(self):
        self.server.pause = 0.03
        self.environment["ISOWEAVE_REMOTE_REQUESTS"] = "3"
        self.sweep(f"{self.server.url}/zarr2")
        self.assertEqual(max(r.open for r in self.server.requests), 3)

    def test_the_next_row_of_chunks_is_asked_for_with_this_one(self):
        volumes.put_zarr2(f"{self.served}/rows", (32, 32, 4))
        self.server.pause = 0.05
        self.sweep(f"{self.server.url}/rows")
        chunks = [r for r in self.server.requests if r.path.endswith(".0.0")]
        self.assertEqual(len(chunks), 5)
        self.assertGreater(max(r.open for r in chunks), 1)

    def test_without_room_ahead_chunks_come_one_by_one(self):
        self.server.pause = 0.01
        expected = self.digest(f"{self.served}/zarr2")
        self.environment["ISOWEAVE_REMOTE_AHEAD"] = "0"
        self.assertEqual(self.digest(f"{self.server.url}/zarr2"), expected)
        self.assertEqual(max(r.open for r in self.server.requests), 1)

    def test_chunks_come_in_the_order_of_the_sweep(self):
        self.environment["ISOWEAVE_REMOTE_REQUESTS"] = "1"
        self.sweep(f"{self.server.url}/zarr2")
        asked = self.server.asked(r"/\d\.\d\.\d$")
        self.assertEqual(asked, sorted(asked))

    def test_blocks_ask_for_the_chunks_that_they_touch(self):
        expected = self.digest(f"{self.served}/zarr2")
        self.assertEqual(self.digest(f"{self.server.url}/zarr2", "--blocks", "8"), expected)
        # A block of 8 cells and the samples around it: 3 chunks along each axis, of which there are 4, 3 and 3.
        blocks = len(list(volumes.grid((27, 23, 21), (8, 8, 8))))
        self.assertLessEqual(len(self.server.asked(r"/\d\.\d\.\d$")), 27 * blocks)
        self.assertLess(len(self.server.asked(r"/\d\.\d\.\d$")), 36 * blocks)

    def test_a_part_of_the_volume_asks_for_its_chunks_alone(self):
        roi = ("--roi", "8:16,8:16,:")
        expected = self.digest(f"{self.served}/zarr2", *roi)
        self.assertEqual(self.digest(f"{self.server.url}/zarr2", *roi), expected)
        self.assertEqual(set(self.server.asked(r"/\d\.\d\.\d$")), {f"/zarr2/{z}.1.1" for z in range(3)})

    def test_levels_of_an_image_are_found_from_the_group_and_from_the_level(self):
        axes = [{"name": name, "type": "space", "unit": "micrometer"} for name in "zyx"]
        scale = {"type": "scale", "scale": [2.0, 1.0, 1.0]}
        volumes.put_json(f"{self.served}/image/.zgroup", {"zarr_format": 2})
        volumes.put_json(f"{self.served}/image/.zattrs", {"multiscales": [
            {"version": "0.4", "axes": axes, "datasets": [{"path": "0", "coordinateTransformations": [scale]}]}]})
        os.rename(f"{self.served}/zarr2", f"{self.served}/image/0")
        expected = self.digest(f"{self.served}/image")
        for path in ("image", "image/0"):
            self.assertEqual(self.digest(f"{self.server.url}/{path}"), expected)
        group = f"{self.served}/image/.zattrs"
        os.remove(group)
        self.expect_refused(f"{self.server.url}/image", "expected an array or an image, or --dataset", "found a group")
        self.assertNotEqual(self.digest(f"{self.server.url}/image", "--dataset", "0"), expected)

    def test_tasks_read_by_url(self):
        expected = self.digest(f"{self.served}/zarr2")
        plan = self.run_isoweave("plan", f"{self.server.url}/zarr2", "--iso", volumes.ISO, "--error", "0.3vox",
                                 "--blocks", "16", "-o", "tasks")
        self.assertEqual(plan.returncode, 0, plan.stderr)
        self.assertEqual(self.run_isoweave("work", "tasks").returncode, 0)
        collected = self.run_isoweave("collect", "tasks", "-o", "c.ply", "--report", "c.json")
        self.assertEqual(collected.returncode, 0, collected.stderr)
        with open(f"{self.folder}/c.json", encoding="utf-8") as file:
            self.assertEqual(json.load(file)["digest"], expected)

    def test_tasks_notice_that_the_volume_has_changed(self):
        volume = f"{self.server.url}/zarr2"
        self.run_isoweave("plan", volume, "--iso", volumes.ISO, "--blocks", "16", "-o", "tasks")
        self.assertEqual(self.run_isoweave("work", "tasks", "--task", "0").returncode, 0)
        os.utime(f"{self.served}/zarr2/.zarray", (1, 1))
        work = self.run_isoweave("work", "tasks")
        self.assertEqual(work.returncode, 3, work.stderr)
        self.assertIn("version", work.stderr)

    def test_a_server_that_packs_is_understood(self):
        expected = self.digest(f"{self.served}/zarr2")
        self.fail_at("", "packed")
        self.assertEqual(self.digest(f"{self.server.url}/zarr2"), expected)

    def test_redirects_are_followed(self):
        expected = self.digest(f"{self.served}/zarr2")
        elsewhere = Server(self.served)
        self.addCleanup(elsewhere.close)
        for ending in (".zarray", "/0.0.0"):
            self.fail_at(ending, "status", status=302, headers={"Location": f"{elsewhere.url}/zarr2/{ending.strip('/')}"})
        self.assertEqual(self.digest(f"{self.server.url}/zarr2"), expected)
        self.assertIn("/zarr2/0.0.0", elsewhere.asked())
        self.fail_at("/1.0.0", "status", status=302, headers={"Location": f"{self.server.url}/zarr2/1.0.0"})
        self.expect_refused(f"{self.server.url}/zarr2", "/zarr2/1.0.0: expected the object, found ")

    def test_the_mesh_is_named_after_the_volume(self):
        named = self.run_isoweave("mesh", f"{self.server.url}/zarr2?x=y/z.w", "--iso", volumes.ISO, "--quiet")
        self.assertEqual(named.returncode, 0, named.stderr)
        self.assertTrue(os.path.isfile(f"{self.folder}/zarr2.ply"))

    def test_info_says_which_version_was_read(self):
        info = self.run_isoweave("info", f"{self.server.url}/zarr2", "--json")
        self.assertEqual(info.returncode, 0, info.stderr)
        self.assertRegex(json.loads(info.stdout)["input"]["part"], r'version \d+ bytes, "[0-9a-f]+-[0-9a-f]+"')
