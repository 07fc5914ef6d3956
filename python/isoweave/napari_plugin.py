"""isoweave in napari: Plugins > isoweave > Simplified surface. napari finds the widget by the manifest, napari.yaml."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, get_args

import numpy as np
import numpy.typing as npt
from magicgui.widgets import ComboBox, Container, FloatSlider, LineEdit, ProgressBar, PushButton
from napari.layers import Image, Labels
from napari.qt.threading import create_worker
from superqt.utils import ensure_main_thread

import isoweave

from ._options import Extractor

_UNITS = {"meter": "m", "millimeter": "mm", "micrometer": "um", "nanometer": "nm"}


@dataclass(frozen=True)
class _Task:
    """What is asked for, read from the widgets in the main thread."""

    layer: Any
    array: Any
    level: float
    options: dict[str, Any]
    affine: npt.NDArray[Any]
    """The place in the world of vertices that are index * spacing."""


@dataclass(frozen=True)
class _Surface:
    data: tuple[Any, ...]
    colors: Any = None


def _place_of(layer: Any, lead: tuple[int, ...]) -> tuple[tuple[float, ...], npt.NDArray[Any]]:
    """Spacing (x, y, z) of the last three axes, and what places them in the world: scale, rotation, shear and the rest."""
    places = np.array([layer.data_to_world([*lead, *index])[-3:] for index in np.vstack([np.zeros(3), np.eye(3)])])
    columns = (places[1:] - places[0]).T
    # Without the last digits, which a rotation changes and with them the mesh.
    spacing = np.array([float(f"{length:.12g}") for length in np.linalg.norm(columns, axis=0)])
    affine = np.eye(4)
    affine[:3, :3], affine[:3, 3] = columns / spacing, places[0]
    return tuple(map(float, spacing[::-1])), affine


def _unit_of(layer: Any) -> str | None:
    """The unit of the last three axes, where they have one that is a length."""
    units = {str(unit) for unit in layer.units[-3:]}
    return _UNITS.get(units.pop()) if len(units) == 1 else None


def _surface_of_labels(task: _Task, progress: Any) -> _Surface | None:
    """All labels in one layer, in the colours that they have."""
    meshes = isoweave.labels(task.array, progress=progress, **task.options)
    kept = {label: mesh.to_napari() for label, mesh in meshes.items() if len(mesh.faces)}
    if not kept:
        return None
    first = np.cumsum([0] + [len(vertices) for vertices, _ in kept.values()])
    faces = [faces + start for (_, faces), start in zip(kept.values(), first)]
    colors = [np.tile(task.layer.get_color(label), (len(kept[label][0]), 1)) for label in kept]
    return _Surface((np.concatenate([data[0] for data in kept.values()]), np.concatenate(faces)), np.concatenate(colors))


class SurfaceWidget(Container):
    """Adds the simplified surface of an image layer at a level, or those of a labels layer, as a surface layer."""

    def __init__(self, napari_viewer: Any) -> None:
        self._viewer = napari_viewer
        self._stopped = False
        self._layer = ComboBox(name="layer", choices=self._layers, nullable=False)
        self._level = FloatSlider(name="level", min=0, max=1)
        self._error = LineEdit(name="error", value="0.2vox")
        self._extractor = ComboBox(name="extractor", choices=get_args(Extractor))
        self._run = PushButton(name="run", text="Make surface")
        self._stop = PushButton(name="stop", text="Stop", enabled=False)
        self._bar = ProgressBar(name="progress", visible=False)
        super().__init__(
            widgets=[self._layer, self._level, self._error, self._extractor, self._run, self._stop, self._bar]
        )
        for event in (napari_viewer.layers.events.inserted, napari_viewer.layers.events.removed):
            event.connect(self._layer.reset_choices)
        self._layer.changed.connect(self._fit_level)
        self._run.changed.connect(self._start)
        self._stop.changed.connect(self._ask_to_stop)
        self._fit_level()

    def _layers(self, _widget: Any = None) -> list[Any]:
        """Image and labels layers with three axes at least."""
        layers = [layer for layer in self._viewer.layers if isinstance(layer, (Image, Labels))]
        return [layer for layer in layers if layer.ndim >= 3 and not getattr(layer, "rgb", False)]

    def _fit_level(self) -> None:
        """The slider goes over the values that the layer may have, and begins in the middle of those that it shows."""
        layer = self._layer.value
        self._level.enabled = isinstance(layer, Image)
        self._run.enabled = layer is not None
        if not isinstance(layer, Image):
            return
        low, high = layer.contrast_limits_range
        self._level.min, self._level.max = min(low, self._level.value), max(high, self._level.value)
        self._level.value = sum(0.5 * limit for limit in layer.contrast_limits)
        self._level.min, self._level.max = low, high

    def _task(self) -> _Task:
        layer = self._layer.value
        array = layer.data[0] if layer.multiscale else layer.data
        lead = tuple(self._viewer.dims.current_step[: array.ndim - 3])
        spacing, affine = _place_of(layer, lead)
        options = {"error": self._error.value, "extractor": self._extractor.value, "spacing": spacing, "unit": _unit_of(layer)}
        return _Task(layer, array[lead] if lead else array, self._level.value, options, affine)

    def _start(self) -> None:
        task = self._task()
        self._stopped = False
        self._show_running(True)
        worker = create_worker(self._surface, task)
        worker.returned.connect(lambda surface: self._add(task, surface))
        worker.finished.connect(lambda: self._show_running(False))
        worker.start()

    def _surface(self, task: _Task) -> _Surface | None:
        """The work of the other thread. An error comes out of it as a notification of napari."""
        try:
            if isinstance(task.layer, Labels):
                return _surface_of_labels(task, self._tell)
            return _Surface(isoweave.mesh(task.array, task.level, progress=self._tell, **task.options).to_napari())
        except isoweave.Stopped:
            return None

    def _tell(self, progress: isoweave.Progress) -> bool:
        self._show_progress(100 * progress.layer // progress.layers)
        return not self._stopped

    @ensure_main_thread
    def _show_progress(self, percent: int) -> None:
        self._bar.value = percent

    def _show_running(self, running: bool) -> None:
        self._run.enabled, self._stop.enabled, self._bar.visible, self._bar.value = not running, running, running, 0

    def _ask_to_stop(self) -> None:
        self._stopped = True

    def _add(self, task: _Task, surface: _Surface | None) -> None:
        if surface is None:
            return
        name = f"{task.layer.name} surfaces" if surface.colors is not None else f"{task.layer.name} at {task.level:g}"
        self._viewer.add_surface(
            surface.data, name=name, affine=task.affine, vertex_colors=surface.colors, units=task.layer.units[-3:]
        )
