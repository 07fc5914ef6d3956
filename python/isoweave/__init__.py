"""Large volumes to simplified triangle surfaces, exactly, in bounded memory.

Arrays are ``(z, y, x)``, as those of scikit-image, napari, dask and zarr. Everything physical (spacing, origin,
direction, vertices) is ``(x, y, z)``, as in ITK, VTK and mesh files.

>>> import numpy as np
>>> z, y, x = np.ogrid[-16:16, -16:16, -16:16]
>>> vertices, faces = mesh(12.0 - np.sqrt(x * x + y * y + z * z), 0, error="0.2vox")
>>> vertices.dtype.name, faces.dtype.name
('float32', 'int32')
"""

from . import compat
from ._forecast import forecast
from ._labels import labels
from ._library import BadInput, CannotWrite, DeviceError, IsoweaveError, OverMemory, Stopped
from ._library import version as __version__
from ._mesh import Mesh, MeshLike, read_mesh
from ._meshing import mesh
from ._outputs import Sink
from ._pieces import iter_mesh
from ._report import Check, Comparison, Forecast, Report
from ._run import Progress
from ._surfaces import check, compare, simplify
from ._volume import Volume, VolumeLike, open_volume

__all__ = [
    "BadInput",
    "CannotWrite",
    "Check",
    "Comparison",
    "DeviceError",
    "Forecast",
    "IsoweaveError",
    "Mesh",
    "MeshLike",
    "OverMemory",
    "Progress",
    "Report",
    "Sink",
    "Stopped",
    "Volume",
    "VolumeLike",
    "__version__",
    "check",
    "compare",
    "compat",
    "forecast",
    "iter_mesh",
    "labels",
    "mesh",
    "open_volume",
    "read_mesh",
    "simplify",
]
