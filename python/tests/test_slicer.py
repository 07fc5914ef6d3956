"""The logic of the module for 3D Slicer. Slicer is no package that could be installed here: its scene, nodes and base
classes are stand-ins, with the calls that the logic makes of them. The window is not tested."""

from __future__ import annotations

import importlib.util
import pathlib
import sys
import types
from typing import Any

import numpy as np
import pytest

import isoweave

RAS = np.array([[-0.5, 0, 0, 3], [0, -0.75, 0, -2], [0, 0, 1.25, 10], [0, 0, 0, 1]])


class Node:
    def __init__(self, name: str) -> None:
        self.name = name
        self.calls: dict[str, Any] = {}

    def GetName(self) -> str:
        return self.name

    def __getattr__(self, name: str) -> Any:
        if not name.startswith(("SetAndObserve", "Create")):
            raise AttributeError(name)
        return lambda *arguments: self.calls.update({name: arguments})


class VolumeNode(Node):
    """A volume node: its image is at the origin with spacing 1, and a matrix says where it is."""

    def __init__(self, array: np.ndarray, kind: str) -> None:
        super().__init__("ct")
        from vtkmodules.util.numpy_support import numpy_to_vtk
        from vtkmodules.vtkCommonDataModel import vtkImageData

        self.kind, self.image = kind, vtkImageData()
        self.image.SetDimensions(array.shape[::-1])
        self.image.GetPointData().SetScalars(numpy_to_vtk(array.ravel(), deep=True))

    def IsA(self, kind: str) -> bool:
        return kind == self.kind

    def GetImageData(self) -> Any:
        return self.image

    def GetTransformNodeID(self) -> str:
        return "transform"

    def GetIJKToRASMatrix(self, matrix: Any) -> None:
        for (row, column), element in np.ndenumerate(RAS):
            matrix.SetElement(row, column, element)


class Scene:
    def AddNewNodeByClass(self, kind: str, name: str) -> Node:
        assert kind == "vtkMRMLModelNode"
        return Node(name)


@pytest.fixture
def logic(monkeypatch: pytest.MonkeyPatch) -> Any:
    pytest.importorskip("vtk")
    bases = types.ModuleType("slicer.ScriptedLoadableModule")
    for name in ("ScriptedLoadableModule", "ScriptedLoadableModuleLogic", "ScriptedLoadableModuleWidget"):
        setattr(bases, name, type(name, (), {}))
    slicer = types.ModuleType("slicer")
    slicer.mrmlScene = Scene()  # type: ignore[attr-defined]
    stand_ins = {"slicer": slicer, bases.__name__: bases, "qt": types.ModuleType("qt"), "ctk": types.ModuleType("ctk")}
    for name, module in stand_ins.items():
        monkeypatch.setitem(sys.modules, name, module)
    path = pathlib.Path(isoweave.__file__).parent / "slicer_module" / "IsoweaveSurface.py"
    spec = importlib.util.spec_from_file_location("IsoweaveSurface", path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.IsoweaveSurfaceLogic()


def polydata(model: Node) -> Any:
    return model.calls["SetAndObservePolyData"][0]


def test_a_volume_becomes_a_model(logic: Any, volume: np.ndarray) -> None:
    (model,) = logic.make_models(VolumeNode(volume, "vtkMRMLScalarVolumeNode"), 100, "0.3vox")
    wanted = isoweave.mesh(volume, 100, error="0.3vox", affine=RAS)
    assert model.name == "ct 100" and isoweave.check(polydata(model)).digest == wanted.digest
    inside = np.argwhere(volume >= 100)[:, ::-1] @ RAS[:3, :3].T + RAS[:3, 3]
    bounds = np.array(polydata(model).GetBounds()).reshape(3, 2)
    np.testing.assert_allclose(bounds, np.array([inside.min(axis=0), inside.max(axis=0)]).T, atol=1.25)
    assert isoweave.check(polydata(model)).volume > 0
    assert model.calls["SetAndObserveTransformNodeID"] == ("transform",) and "CreateDefaultDisplayNodes" in model.calls


def test_a_label_map_becomes_a_model_for_each_label(logic: Any) -> None:
    cells = np.zeros((20, 22, 24), np.uint8)
    cells[3:9, 4:18, 5:20], cells[11:17, 4:18, 5:20] = 3, 9
    models = logic.make_models(VolumeNode(cells, "vtkMRMLLabelMapVolumeNode"), 0, "0.2vox")
    wanted = isoweave.labels(cells, affine=RAS)
    assert [model.name for model in models] == ["ct label 3", "ct label 9"]
    assert [isoweave.check(polydata(model)).digest for model in models] == [mesh.digest for mesh in wanted.values()]
