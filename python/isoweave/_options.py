"""Options of runs as structs of the C interface."""

from __future__ import annotations

import ctypes
from typing import Any, Literal, Sequence, Union

from . import _library as c
from ._volume import Volume

Length = Union[float, int, str]
Quality = Literal["fast", "normal", "fine"]
Extractor = Literal["cubes", "trilinear", "tetrahedra", "dual"]

_QUALITIES = {"normal": 0, "fast": 1, "fine": 2}
_NORMALS = {None: 0, "none": 0, "gradient": 1, "quadric": 2}
_EXTRACTORS = {"cubes": 0, "trilinear": 1, "tetrahedra": 2, "dual": 3}
_SPACES = {None: 0, "lps": 1, "ras": 2, "index": 3}
_SIDES = {"above": 0, "below": 1}
_SPECKS = {"keep": 0, "drop": 1}


def chosen(name: str, value: Any, choices: dict[Any, int]) -> int:
    if value not in choices:
        raise ValueError(f"{name}: expected one of {', '.join(repr(choice) for choice in choices)}, found {value!r}")
    return choices[value]


def length(value: Length | None) -> bytes | None:
    """A length as text: "0.2vox" and "50um" as they are, a number in the volume's unit."""
    if value is None:
        return None
    return c.encoded(value if isinstance(value, str) else repr(float(value)))


def usual_error(error: Length | None, stops: Sequence[Any]) -> Length | None:
    """The error where none is named: 0.2 voxels, unless something else says where to stop."""
    return "0.2vox" if error is None and not any(stops) else error


def simplify_struct(
    *,
    error: Length | None,
    lods: Sequence[Length],
    max_distance: Length | None,
    triangles: int | None,
    ratio: float | None,
    quality: str,
    specks: str,
    largest: bool = False,
    min_component: int = 0,
) -> c.SimplifyOptions:
    levels = b",".join(length(level) or b"" for level in lods)
    for name, number in (("triangles", triangles), ("ratio", ratio)):
        if number is not None and not number > 0:
            raise ValueError(f"{name}: expected a number above 0, found {number}")
    if min_component < 0:
        raise ValueError(f"min_component: expected a number of triangles, found {min_component}")
    return c.SimplifyOptions(
        error=length(error),
        levels=levels or None,
        max_distance=length(max_distance),
        triangles=triangles or 0,
        ratio=ratio or 0.0,
        quality=chosen("quality", quality, _QUALITIES),
        drop_specks=chosen("specks", specks, _SPECKS),
        largest=int(largest),
        min_component=min_component,
    )


def mesh_struct(
    simplify: c.SimplifyOptions,
    *,
    iso: float,
    inside: str = "above",
    closed: bool = True,
    smooth: int = 0,
    extractor: str = "cubes",
    normals: str | None = None,
    space: str | None = None,
    values: Volume | None = None,
) -> c.MeshOptions:
    return c.MeshOptions(
        iso=iso,
        simplify=ctypes.pointer(simplify),
        inside_below=chosen("inside", inside, _SIDES),
        open=int(not closed),
        smooth=smooth,
        normals=chosen("normals", normals, _NORMALS),
        space=chosen("space", space, _SPACES),
        values=None if values is None else values._handle.pointer,
        extractor=chosen("extractor", extractor, _EXTRACTORS),
    )
