"""Run beside a display: makes surfaces with the widget in napari's viewer, and prints what can be checked as JSON.

python napari_surface.py VOLUME.npy LABELS.npy
"""

import json
import sys
import time

import napari
import numpy as np
from qtpy.QtWidgets import QApplication

import isoweave

volume, cells = (np.load(path) for path in sys.argv[1:])
viewer = napari.Viewer(show=False)


def press_and_wait(*buttons):
    """Presses buttons, and waits until no run goes on. Returns the number of layers that were added."""
    layers = len(viewer.layers)
    for button in buttons:
        widget[button].native.click()
    until = time.monotonic() + 60
    while not widget["run"].enabled and time.monotonic() < until:
        QApplication.processEvents()
        time.sleep(0.01)
    return len(viewer.layers) - layers


def added():
    """The surface layer that a press of the button adds."""
    assert press_and_wait("run") == 1
    return viewer.layers[-1]


def digest(surface):
    """Of the mesh in the layer, whose vertices are index * spacing in the order z, y, x."""
    vertices, faces = surface.data[:2]
    return isoweave.check((vertices[:, ::-1], faces[:, ::-1])).digest


def values_at(image, surface):
    """The image at the vertices of a surface, by way of the world: from the eight samples around each."""
    world = np.array([surface.data_to_world(vertex) for vertex in surface.data[0]])
    at = np.array([image.world_to_data(place) for place in world])
    low = np.clip(np.floor(at).astype(int), 0, np.array(image.data.shape) - 2)
    part = at - low
    total = np.zeros(len(at))
    for corner in np.ndindex(2, 2, 2):
        weight = np.prod(np.where(corner, part, 1 - part), axis=1)
        total += weight * image.data[tuple((low + corner).T)]
    return total


image = viewer.add_image(
    volume, name="ct", scale=(1.25, 0.75, 0.5), translate=(10, -2, 3), rotate=[[1, 0, 0], [0, 0.8, -0.6], [0, 0.6, 0.8]],
    units=("um", "um", "um"),
)
_, widget = viewer.window.add_plugin_dock_widget("isoweave", "Simplified surface")
found = {"slider": [widget["level"].min, widget["level"].max, widget["level"].value]}
widget["level"].value = 100
widget["error"].value = "0"
full = added()
found["full"] = {"name": full.name, "digest": digest(full), "unit": str(full.units[0])}
found["farthest"] = float(np.abs(values_at(image, full) - 100).max())
widget["error"].value = "0.3um"
widget["extractor"].value = "dual"
found["dual"] = digest(added())

found["stopped"] = press_and_wait("run", "stop")

times = viewer.add_image(np.stack([np.zeros_like(volume), volume]), name="time", translate=(0, 7, 0, 0))
viewer.dims.set_current_step(0, 1)
widget["error"].value = "0.3"
widget["layer"].value = times
widget["level"].value = 100
moved = added()
found["time"] = {"digest": digest(moved), "place": moved.data_to_world([0, 0, 0])}

labels = viewer.add_labels(cells, name="cells", scale=(2, 1, 1))
widget["layer"].value = labels
surfaces = added()
found["labels"] = {
    "name": surfaces.name,
    "components": isoweave.check((surfaces.data[0], surfaces.data[1][:, ::-1])).components,
    "colors": len(np.unique(surfaces.vertex_colors, axis=0)),
    "low": surfaces.data[0].min(axis=0).tolist(),
    "high": surfaces.data[0].max(axis=0).tolist(),
}
print("FOUND", json.dumps(found, default=float))
viewer.close()
