"""What type checkers make of calls. Nothing here runs: mypy reads it."""

from __future__ import annotations

import pathlib
from typing import Any, Mapping

import numpy.typing as npt
import zarr
from typing_extensions import assert_type

import isoweave
import isoweave.distributed
from isoweave import Mesh, Report


def calls(volume: npt.NDArray[Any], path: pathlib.Path, sink: isoweave.Sink) -> None:
    assert_type(isoweave.mesh(volume), Mesh)
    assert_type(isoweave.mesh(volume, 100, error="0.2vox", extractor="dual", roi=[(0, 5)] * 3), Mesh)
    assert_type(isoweave.mesh(volume, 100, out="a.ply"), Report)
    assert_type(isoweave.mesh(volume, 100, out=sink), Report)
    assert_type(isoweave.mesh(volume, 100, lods=["0.1vox", 0.5]), "list[Mesh]")
    assert_type(isoweave.mesh(volume, 100, lods=["0.1vox", 0.5], out=path), "list[Report]")
    assert_type(isoweave.mesh(volume, [10, 20.5]), "list[Mesh]")
    assert_type(isoweave.mesh(volume, volume, out=path), "list[Report]")
    assert_type(isoweave.mesh(volume, [10, 20.5], out=[None, path]), "list[Any]")
    assert_type(isoweave.simplify(path, ratio=0.5), Mesh)
    assert_type(isoweave.simplify(path, lods=[1, 2], out="a.ply"), "list[Report]")
    assert_type(isoweave.labels(volume), "Mapping[int, Mesh]")
    assert_type(isoweave.labels(volume, [1], out="a.ply"), "Mapping[int, Report]")
    assert_type(isoweave.labels(volume, out=lambda label, mesh: str(label)), "Mapping[int, str]")
    isoweave.mesh(volume, 100, extractor="cube")  # type: ignore[call-overload]
    isoweave.mesh(volume, 100, eror=1)  # type: ignore[call-overload]
    assert_type(isoweave.distributed.mesh(path, 100, out="a.ply", blocks=128, error="0.2vox"), Report)
    assert_type(isoweave.distributed.mesh(path, 100, out=path, lods=["0.1vox", 0.5]), "list[Report]")
    assert_type(isoweave.distributed.mesh(zarr.open_array(path), 100, out=path, progress=print), Report)
    isoweave.distributed.mesh(volume, 100, out=path)  # type: ignore[call-overload]
    isoweave.distributed.mesh(path, 100, out=path, extractor="dual")  # type: ignore[call-overload]
