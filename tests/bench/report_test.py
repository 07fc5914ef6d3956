#!/usr/bin/env python3
"""bench/report.py: the verdicts on goals, the small file of results, and whether the page is what the results make.

  tests/bench/report_test.py    from anywhere; needs nothing but Python
"""
import json
import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))

import report  # noqa: E402
from reporting.changes import change, change_lines, goal_line  # noqa: E402
from reporting.goals import FAST_JOB, Case, Goal, goal_table  # noqa: E402
from reporting.results import load  # noqa: E402
from reporting.summary import read_summary, write_summary  # noqa: E402
from reporting.tables import median_side  # noqa: E402

PAGE = ROOT / "docs/performance.md"
KEPT = ROOT / "docs/performance/results.json"
SPEED = Goal("speed", "a peer", "×", True, {2: 1.5}, lambda cases: cases)
SIZE = Goal("size", "", " MB", False, 100, lambda cases: cases)
MIDDLE = Goal("middle", "", "×", False, 2, lambda cases: cases, True)


def raw_result(name, ratios, processors=2):
    """As bench_peers leaves it: one share left, one peer, all threads."""
    def side(peer):
        quality = {"mean": 0.25, "rms": 0.5, "max": 1.0, "nonmanifold_edges": 0, "euler": 2, "slivers": 0.0}
        return {"name": peer, "threads": processors, "triangles": 200, "seconds": 1.5, "peak_bytes": 3000,
                "bytes_before": 1000, "quality": quality}
    row = {"left": 20.0, "threads": processors, "ours": side("isoweave normal"), "peer": side("meshoptimizer"),
           "ratio": sorted(ratios)[len(ratios) // 2], "ratios": ratios}
    return {"suite": "simplify", "machine": {"processor": "P", "threads": processors}, "absent": [],
            "input": {"name": name, "dims": [4, 5, 6], "type": "uint8"}, "full": {"triangles": 1000, "euler": 2},
            "rows": [row]}


def folder_of(*results):
    folder = tempfile.TemporaryDirectory()
    for number, result in enumerate(results):
        (pathlib.Path(folder.name) / f"{number}.json").write_text(json.dumps(result))
    return folder


class Verdicts(unittest.TestCase):
    def test_more_is_better_where_a_goal_is_a_least(self):
        self.assertEqual(change(SPEED, Case(1, "a"), Case(1.06, "a")), "better")
        self.assertEqual(change(SPEED, Case(1, "a"), Case(0.94, "a")), "worse")

    def test_less_is_better_where_a_goal_is_a_most(self):
        self.assertEqual(change(SIZE, Case(100, "a"), Case(94, "a")), "better")
        self.assertEqual(change(SIZE, Case(100, "a"), Case(106, "a")), "worse")

    def test_without_rounds_five_per_cent_are_noise(self):
        self.assertEqual(change(SPEED, Case(1, "a"), Case(1.04, "a")), "same")
        self.assertEqual(change(SPEED, Case(1, "a", 0.01), Case(1.04, "a")), "same")

    def test_the_rounds_tell_the_noise_where_both_have_some(self):
        self.assertEqual(change(SPEED, Case(1, "a", 0.01), Case(1.04, "a", 0.02)), "better")
        self.assertEqual(change(SPEED, Case(1, "a", 0.01), Case(1.10, "a", 0.2)), "same")

    def test_a_fault_where_there_was_none_is_worse(self):
        self.assertEqual(change(SIZE, Case(0, "a"), Case(1, "a")), "worse")
        self.assertEqual(change(SIZE, Case(0, "a"), Case(0, "a")), "same")


class Lines(unittest.TestCase):
    def test_figures_are_of_the_cases_that_both_have(self):
        before = [Case(1.2, "a"), Case(0.5, "gone"), Case(2, "b")]
        now = [Case(1.6, "a"), Case(1.8, "b"), Case(1.7, "new")]
        self.assertEqual(goal_line(SPEED, before, now, 2),
                         "speed, beside a peer, at least 1.5× on 2: before 1.20, now 1.60: better "
                         "(1 better, 1 worse of 2); met")

    def test_one_case_of_now_that_fails_misses_the_goal(self):
        line = goal_line(SPEED, [Case(1.6, "a")], [Case(1.6, "a"), Case(1.4, "new")], 2)
        self.assertTrue(line.endswith("before 1.60, now 1.60: same (0 better, 0 worse of 1); missed"), line)

    def test_the_middle_may_have_a_worse_case(self):
        cases = [Case(1, "a"), Case(1.5, "b"), Case(9, "c")]
        self.assertTrue(goal_line(MIDDLE, cases, cases, 2).endswith(
            "before 1.50, now 1.50: same (0 better, 0 worse of 3); met"))

    def test_what_one_side_has_not_is_said(self):
        self.assertEqual(goal_line(SIZE, [], [Case(101, "a")], 2),
                         "size, at most 100 MB: before not measured, now 101; missed")
        self.assertEqual(goal_line(SIZE, [Case(1, "a")], [], 2), "size: not measured now")

    def test_a_machine_without_such_a_goal_has_no_line(self):
        self.assertIsNone(goal_line(SPEED, [Case(1, "a")], [Case(1, "a")], 3))

    def test_results_are_beside_those_of_machines_with_as_many_processors(self):
        with folder_of(raw_result("a", [1.0])) as before, \
             folder_of(raw_result("a", [2.0]), raw_result("a", [4.0], 4)) as now:
            lines = "\n".join(change_lines(load(before), load(now)))
        self.assertIn("On 2 processors:\n", lines)
        self.assertIn("before 1.00, now 2.00: better (1 better, 0 worse of 1); met", lines)
        self.assertIn("4× on 4: before not measured, now 4.00; met", lines)

    def test_results_beside_themselves_are_the_same(self):
        kept = load(KEPT)
        lines = [line for line in change_lines(kept, kept) if not line.startswith("On ")]
        figures = goal_table(kept).count("**met**: ") + goal_table(kept).count("missed: ")
        self.assertGreater(figures, 0)
        self.assertEqual(len(lines), figures)
        for line in lines:
            self.assertRegex(line, r": same \(0 better, 0 worse of \d+\); (met|missed)$")


class Summary(unittest.TestCase):
    def test_rounds_become_a_median_and_their_spread(self):
        with folder_of(raw_result("a", [1.0, 2.0, 2.2, 2.6, 9.0])) as folder:
            row, = load(folder)[0]["rows"]
        self.assertEqual((row["ratio"], row["rounds"]), (2.2, 5))
        self.assertAlmostEqual(row["spread"], 0.4 / 2.2, 5)  # off by 1.2, 0.2, 0, 0.4 and 6.8: the median is 0.4

    def test_one_round_tells_no_spread(self):
        with folder_of(raw_result("a", [1.0])) as folder:
            self.assertIsNone(load(folder)[0]["rows"][0]["spread"])

    def test_what_is_kept_of_other_volumes_and_machines_stays(self):
        with folder_of(raw_result("a", [1.0]), raw_result("b", [2.0]), raw_result("a", [3.0], 4)) as first, \
             folder_of(raw_result("a", [5.0])) as second, tempfile.TemporaryDirectory() as out:
            file = pathlib.Path(out) / "kept.json"
            write_summary(load(first), file)
            write_summary(load(second), file)
            kept = {(each["input"]["name"], each["machine"]["threads"]): each["rows"][0]["ratio"]
                    for each in read_summary(file)}
        self.assertEqual(kept, {("a", 2): 5.0, ("b", 2): 2.0, ("a", 4): 3.0})

    def test_a_summary_gives_what_its_results_gave(self):
        with folder_of(raw_result("a", [1.0, 1.5, 2.0])) as folder, tempfile.TemporaryDirectory() as out:
            file = pathlib.Path(out) / "kept.json"
            write_summary(load(folder), file)
            self.assertEqual(load(file), load(folder))


class Page(unittest.TestCase):
    def test_its_tables_are_what_the_results_make(self):
        text = PAGE.read_text(encoding="utf-8")
        self.assertEqual(report.with_blocks(text, report.blocks(load(KEPT))), text)

    def test_the_figures_of_the_readme_are_in_the_results(self):
        result, = (each for each in load(KEPT) if each["suite"] == "job" and each["input"]["name"] == "smooth-200M")
        row, = (each for each in result["rows"] if each["threads"] == 2 and each["peer"]["name"] == FAST_JOB)
        lines = (ROOT / "README.md").read_text(encoding="utf-8").splitlines()
        for name, side in (("isoweave", median_side(result["rows"], 2)), (FAST_JOB, row["peer"])):
            quality = side["quality"]
            self.assertIn(f"| {name} | {side['seconds']:.1f} s | {side['added_bytes'] / 1e6:.0f} MB | "
                          f"{quality['rms']:.3f} voxel | {quality['nonmanifold_edges']:,} |", lines)

    def test_a_block_that_no_table_is_for_is_refused(self):
        with self.assertRaisesRegex(SystemExit, "<!-- begin nothing -->: expected one of"):
            report.with_blocks("<!-- begin nothing -->\n<!-- end nothing -->", {})

    def test_a_block_without_an_end_is_refused(self):
        with self.assertRaisesRegex(SystemExit, "expected an <!-- end NAME --> for each"):
            report.with_blocks("<!-- begin a -->\n<!-- begin b -->\n<!-- end b -->", {"a": "", "b": ""})


if __name__ == "__main__":
    unittest.main()
