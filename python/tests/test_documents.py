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


EXAMPLES = ["", "._meshing", "._labels", "._surfaces", "._report", "._volume", ".compat"]


@pytest.mark.parametrize("name", [f"isoweave{module}" for module in EXAMPLES])
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


def test_notebook(folder: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every cell runs, and the meshes that are last in a cell show themselves."""
    for name in ("IPYTHONDIR", "JUPYTER_CONFIG_DIR", "JUPYTER_DATA_DIR", "JUPYTER_RUNTIME_DIR"):
        monkeypatch.setenv(name, str(folder / name))
    nbformat = pytest.importorskip("nbformat")
    client = pytest.importorskip("nbclient")
    notebook = nbformat.read(ROOT / "docs" / "notebook.ipynb", as_version=4)
    assert not any(cell.get("outputs") for cell in notebook.cells)  # what is committed is the text
    client.NotebookClient(notebook, timeout=60, resources={"metadata": {"path": str(folder)}}).execute()
    shown = [output["data"] for cell in notebook.cells for output in cell.get("outputs", []) if "data" in output]
    assert sum("Mesh(" in data.get("text/html", "") for data in shown) == 2
    assert sum("image/png" in data for data in shown) == 2
