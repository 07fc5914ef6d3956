"""What a run would take."""

from __future__ import annotations

import ctypes
from typing import Any, Literal

from ._options import Extractor, Length, Quality, mesh_struct, simplify_struct, usual_error
from ._report import Forecast
from ._run import Runner
from ._volume import Roi, VolumeLike, level_of, volume_for


def forecast(
    volume: VolumeLike,
    level: float | None = None,
    *,
    error: Length | None = None,
    triangles: int | None = None,
    max_distance: Length | None = None,
    quality: Quality = "normal",
    inside: Literal["above", "below"] = "above",
    closed: bool = True,
    smooth: int = 0,
    extractor: Extractor = "cubes",
    roi: Roi | None = None,
    step: int = 1,
    threads: int = 0,
    memory: int | str | None = None,
    **opening: Any,
) -> Forecast:
    """What :func:`mesh` would take, from a part of the volume: triangles, bytes and seconds, before the run.

    Args: as :func:`mesh`; what is left goes to :func:`open_volume`.
    """
    opened = volume_for(volume, roi, step, **opening)
    simplify_options = simplify_struct(
        error=usual_error(error, [triangles, max_distance]), lods=(), max_distance=max_distance, triangles=triangles,
        ratio=None, quality=quality, specks="keep",
    )
    options = mesh_struct(
        simplify_options, iso=level_of(opened, level), inside=inside, closed=closed, smooth=smooth, extractor=extractor
    )
    runner = Runner(threads, "auto", memory, None)
    return Forecast(
        opened._finish(
            lambda: runner.call("iw_forecast", opened._handle.pointer, ctypes.byref(options), runner.pointer())
        )
    )
