#!/usr/bin/python3
"""The functions that bench/work looks for in its profile are there.

  tests/bench/work_test.py
"""
import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from count_work import STEPS  # noqa: E402

SOURCES = [path.read_text(encoding="utf-8") for path in sorted((ROOT / "src").rglob("*.[ch]pp"))]


def is_there(owner, function):
    """Whether a source that names the class, where there is one, has a function of that name."""
    return any(re.search(rf"\b{function}\(", text) for text in SOURCES
               if not owner or re.search(rf"\b(class|struct) (\w+::)*{owner}\b", text))


class Steps(unittest.TestCase):
    def test_their_functions_are_in_the_sources(self):
        names = {name for _, functions, parts in STEPS for text in functions + parts for name in text.split("<")}
        self.assertGreater(len(names), 8)
        for name in sorted(names):
            owner, function = ([""] + name.split("::"))[-2:]
            with self.subTest(name):
                self.assertTrue(is_there(owner, function))


if __name__ == "__main__":
    unittest.main()
