"""The keyword arguments of the functions, for type checkers: what their overloads share."""

from __future__ import annotations

import os
from typing import Any, Callable, Literal, TypedDict

import numpy.typing as npt

from ._options import Extractor, Length, Quality
from ._run import ProgressLike
from ._volume import Roi, Triple, VolumeLike


class RunSettings(TypedDict, total=False):
    error: Length | None
    triangles: int | None
    ratio: float | None
    max_distance: Length | None
    quality: Quality
    specks: Literal["keep", "drop"]
    threads: int
    progress: ProgressLike


class StopSettings(RunSettings, total=False):
    largest: bool
    min_component: int
    compress: bool


class OpenSettings(TypedDict, total=False):
    spacing: Triple | float | None
    origin: Triple | None
    direction: npt.ArrayLike | None
    affine: npt.ArrayLike | None
    unit: str | None
    space: Literal[None, "lps", "ras", "index"]
    axes: str | None
    channel: int | None
    time: int | None
    scalars: str | None
    roi: Roi | None
    smooth: int
    closed: bool
    extractor: Extractor


class LabelSettings(RunSettings, OpenSettings, total=False):
    normals: Literal[None, "gradient"]


class MeshSettings(StopSettings, OpenSettings, total=False):
    inside: Literal["above", "below"]
    normals: Literal[None, "gradient", "quadric"]
    values: VolumeLike | None
    step: int
    memory: int | str | None
    device: Literal["auto", "cpu", "cuda"]
    checkpoint: str | os.PathLike[str] | None
    resume: bool
    every: float | str


class PlanSettings(TypedDict, total=False):
    client: Any
    folder: str | os.PathLike[str] | None
    blocks: int
    threads: int
    error: Length | None
    triangles: int | None
    ratio: float | None
    quality: Quality
    specks: Literal["keep", "drop"]
    inside: Literal["above", "below"]
    closed: bool
    smooth: int
    extractor: Literal["cubes", "trilinear", "tetrahedra"]
    normals: Literal[None, "gradient", "quadric"]
    space: Literal[None, "lps", "ras", "index"]
    spacing: Triple | float | None
    origin: Triple | None
    raw: str | None
    dataset: str | None
    series: str | None
    channel: int | None
    time: int | None
    external: bool
    roi: Roi | None
    step: int | None
    compress: bool
    progress: bool | Callable[[Any], Any] | None
