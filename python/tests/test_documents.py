"""The examples of docs/python.md and of the docstrings."""

from __future__ import annotations

import doctest
import importlib
import os
import pathlib
import re

import pytest

import isoweave

ROOT = pathlib.Path(__file__).resolve().parents[2]


@pytest.mark.parametrize("name", ["isoweave", "isoweave._meshing", "isoweave._labels", "isoweave._surfaces", "isoweave._report", "isoweave._volume", "isoweave.compat"])
def test_docstrings(name: str) -> None:
    done = doctest.testmod(importlib.import_module(name), extraglobs={"isoweave": isoweave})
    assert done.attempted > 0 and done.failed == 0


def test_page(folder: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("pyvista", minversion="0.48")
    monkeypatch.chdir(folder)
    text = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    assert len(blocks) >= 6
    names: dict[str, object] = {}
    for block in blocks:
        exec(compile(block, "docs/python.md", "exec"), names)  # noqa: S102
    assert {"ball.glb", "ball.ply"} <= set(os.listdir(folder))
