#!/usr/bin/python3
"""Every link from a page of the project to a file or a heading of it leads there.

  tests/readme/links_test.py
"""
import collections
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGES = [page for folder in (".", "docs", "bench") for page in (ROOT / folder).glob("*.md")]
CODE = re.compile(r"^```.*?^```$", re.DOTALL | re.MULTILINE)
LINK = re.compile(r"\]\(([^)\s]+)\)")
HEADING = re.compile(r"^#+ (.*)$", re.MULTILINE)
ELSEWHERE = re.compile(r"[a-z]+:")


def text_of(page):
    return CODE.sub("", page.read_text(encoding="utf-8"))


def anchor(heading):
    """The name that GitHub gives a heading: its words, without links and marks, joined by hyphens."""
    words = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).strip().lower()
    return re.sub(r"[^\w\- ]", "", words).replace(" ", "-")


def anchors(text):
    """Those of all headings; one that comes again has a number behind it."""
    found, seen = [], collections.Counter()
    for name in map(anchor, HEADING.findall(text)):
        found.append(f"{name}-{seen[name]}" if seen[name] else name)
        seen[name] += 1
    return found


def fault(page, link):
    """What is wrong with a link, or nothing."""
    path, _, name = link.partition("#")
    target = (page.parent / path).resolve() if path else page
    if not target.exists():
        return "expected a file of the project, found none"
    if name and target.suffix == ".md" and name not in anchors(text_of(target)):
        return f"expected a heading of {target.name}, found none of that name"
    return None


def faults(pages):
    for page in pages:
        for link in LINK.findall(text_of(page)):
            wrong = None if ELSEWHERE.match(link) else fault(page, link)
            if wrong:
                yield f"{page.relative_to(ROOT)}: {link}: {wrong}"


class Links(unittest.TestCase):
    def test_every_link_leads_to_a_file_or_heading(self):
        self.assertGreater(len(PAGES), 15)
        self.assertEqual(list(faults(PAGES)), [])

    def test_anchors_are_words_joined_by_hyphens(self):
        self.assertEqual(anchors("# A `code`, and more\n## B\n## B\n### [A link](x.md)'s\n"),
                         ["a-code-and-more", "b", "b-1", "a-links"])


if __name__ == "__main__":
    unittest.main()
