"""isoweave in ParaView: Tools > Manage Plugins > Load New, or PV_PLUGIN_PATH. The package must be importable in pvpython."""

from __future__ import annotations

from typing import Any

from paraview.util.vtkAlgorithm import VTKPythonAlgorithmBase, smdomain, smproperty, smproxy
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPolyData

import isoweave

_SCALARS = """
<StringVectorProperty name="Scalars" command="SetScalars" number_of_elements="5" element_types="0 0 0 0 2"
                      default_values="0">
  <ArrayListDomain name="array_list" attribute_type="Scalars" input_domain_name="inputs_array">
    <RequiredProperties><Property name="Input" function="Input"/></RequiredProperties>
  </ArrayListDomain>
</StringVectorProperty>
"""
_EXTRACTOR = """
<StringVectorProperty name="Extractor" command="SetExtractor" number_of_elements="1" default_values="cubes">
  <StringListDomain name="list">
    <String value="cubes"/><String value="trilinear"/><String value="tetrahedra"/><String value="dual"/>
  </StringListDomain>
</StringVectorProperty>
"""


@smproxy.filter(label="Isoweave Contour")
@smproperty.input(name="Input")
@smdomain.datatype(dataTypes=["vtkImageData"], composite_data_supported=False)
@smdomain.xml("""<InputArrayDomain name="inputs_array" attribute_type="point" number_of_components="1"/>""")
class IsoweaveContour(VTKPythonAlgorithmBase):
    """The simplified surface of an image at a level, bit for bit that of ``isoweave mesh``."""

    def __init__(self) -> None:
        super().__init__(nInputPorts=1, nOutputPorts=1, outputType="vtkPolyData")
        self._scalars: str | None = None
        self._level = 0.0
        self._error = "0.2vox"
        self._closed = True
        self._extractor: Any = "cubes"

    @smproperty.xml(_SCALARS)
    def SetScalars(self, _index: int, _port: int, _connection: int, _association: int, name: str) -> None:
        self._set("_scalars", name or None)

    @smproperty.doublevector(name="Level", default_values=0.0)
    def SetLevel(self, level: float) -> None:
        self._set("_level", level)

    @smproperty.stringvector(name="Error", default_values="0.2vox")
    def SetError(self, error: str) -> None:
        self._set("_error", error)

    @smproperty.intvector(name="Closed", default_values=1)
    @smdomain.xml("""<BooleanDomain name="bool"/>""")
    def SetClosed(self, closed: int) -> None:
        self._set("_closed", bool(closed))

    @smproperty.xml(_EXTRACTOR)
    def SetExtractor(self, extractor: str) -> None:
        self._set("_extractor", extractor)

    def FillInputPortInformation(self, _port: int, info: Any) -> int:
        info.Set(self.INPUT_REQUIRED_DATA_TYPE(), "vtkImageData")
        return 1

    def RequestData(self, _request: Any, inputs: Any, outputs: Any) -> int:
        image = vtkImageData.GetData(inputs[0], 0)
        surface = vtkPolyData.GetData(outputs, 0)
        mesh = isoweave.mesh(
            image, self._level, error=self._error, closed=self._closed, extractor=self._extractor, scalars=self._scalars,
            progress=self._tell,
        )
        surface.ShallowCopy(mesh.to_vtk())
        return 1

    def _tell(self, progress: isoweave.Progress) -> bool:
        """Moves ParaView's bar. Its button to abort stops the run."""
        self.UpdateProgress(progress.layer / progress.layers)
        return not self.GetAbortExecute()

    def _set(self, name: str, value: Any) -> None:
        if getattr(self, name) != value:
            setattr(self, name, value)
            self.Modified()
