"""isoweave in 3D Slicer, a scripted module: Edit > Application Settings > Modules, this file's folder as an additional path.

Slicer's Python must find the package: ``slicer.util.pip_install`` takes the wheel.
"""

from __future__ import annotations

from typing import Any

import ctk
import qt
import slicer
import vtk
from slicer.ScriptedLoadableModule import (
    ScriptedLoadableModule,
    ScriptedLoadableModuleLogic,
    ScriptedLoadableModuleWidget,
)


class IsoweaveSurface(ScriptedLoadableModule):
    """What Slicer shows of the module."""

    def __init__(self, parent: Any) -> None:
        ScriptedLoadableModule.__init__(self, parent)
        parent.title = "Isoweave Surface"
        parent.categories = ["Surface Models"]
        parent.helpText = "The simplified surface of a volume at a level, or of every label of a label map."
        parent.acknowledgementText = "isoweave, BSD-3-Clause"


class IsoweaveSurfaceWidget(ScriptedLoadableModuleWidget):
    """A volume, a level, an error, and a button."""

    def setup(self) -> None:
        ScriptedLoadableModuleWidget.setup(self)
        form = qt.QFormLayout()
        self.layout.addLayout(form)
        self.volume = slicer.qMRMLNodeComboBox()
        self.volume.nodeTypes = ["vtkMRMLScalarVolumeNode"]  # label maps are derived from it
        self.volume.addEnabled = self.volume.removeEnabled = False
        self.volume.setMRMLScene(slicer.mrmlScene)
        self.level = ctk.ctkSliderWidget()
        self.error = qt.QLineEdit("0.2vox")
        self.button = qt.QPushButton("Make models")
        for name, widget in (("Volume", self.volume), ("Level", self.level), ("Error", self.error)):
            form.addRow(name, widget)
        form.addRow(self.button)
        self.layout.addStretch(1)
        self.volume.connect("currentNodeChanged(vtkMRMLNode*)", self.fit_level)
        self.button.connect("clicked()", self.run)
        self.fit_level(self.volume.currentNode())

    def fit_level(self, node: Any) -> None:
        """The slider goes over the values of the volume. Label maps have no level."""
        image: Any = None if node is None else node.GetImageData()
        self.button.enabled = image is not None
        self.level.enabled = image is not None and not node.IsA("vtkMRMLLabelMapVolumeNode")
        if self.level.enabled:
            self.level.minimum, self.level.maximum = image.GetScalarRange()
            self.level.value = (self.level.minimum + self.level.maximum) / 2

    def run(self) -> None:
        with slicer.util.tryWithErrorDisplay("No surface was made.", waitCursor=True):
            IsoweaveSurfaceLogic().make_models(self.volume.currentNode(), self.level.value, self.error.text)


class IsoweaveSurfaceLogic(ScriptedLoadableModuleLogic):
    """The work, without windows."""

    def make_models(self, volume: Any, level: float, error: str) -> list[Any]:
        """Adds model nodes where the volume node is: one at the level, or for a label map one for each label."""
        import isoweave

        matrix = vtk.vtkMatrix4x4()
        volume.GetIJKToRASMatrix(matrix)
        affine = [[matrix.GetElement(row, column) for column in range(4)] for row in range(4)]
        options: dict[str, Any] = {"error": error, "affine": affine, "unit": "mm"}
        if volume.IsA("vtkMRMLLabelMapVolumeNode"):
            meshes = isoweave.labels(volume.GetImageData(), **options)
            return [self._model(volume, f"label {label}", mesh) for label, mesh in meshes.items()]
        return [self._model(volume, f"{level:g}", isoweave.mesh(volume.GetImageData(), level, **options))]

    def _model(self, volume: Any, name: str, mesh: Any) -> Any:
        model = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLModelNode", f"{volume.GetName()} {name}")
        model.SetAndObservePolyData(mesh.to_vtk())
        model.SetAndObserveTransformNodeID(volume.GetTransformNodeID())
        model.CreateDefaultDisplayNodes()
        return model
