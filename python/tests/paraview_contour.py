"""Run by pvpython: loads the plugin, applies its filter to an image, and writes the surface.

pvpython paraview_contour.py PLUGIN IMAGE LEVEL EXTRACTOR SURFACE
"""

import inspect
import os
import sys

# Debian's pvpython looks for VTK in the system's folder first, where that of other programs may be.
sys.path[:0] = os.environ["PYTHONPATH"].split(os.pathsep)

# ParaView 5.11 asks for a function that Python 3.11, beside which Debian 12 puts it, has no longer: it loads no plugin in
# Python without that.
if not hasattr(inspect, "getargspec"):
    inspect.getargspec = inspect.getfullargspec  # type: ignore[attr-defined]

from paraview import simple

plugin, image, level, extractor, surface = sys.argv[1:]
simple.LoadPlugin(plugin, ns=globals())
contour = globals()["IsoweaveContour"](Input=simple.OpenDataFile(image))
contour.Scalars = ["POINTS", "ct"]
contour.Level = float(level)
contour.Extractor = extractor
contour.UpdatePipeline()
simple.SaveData(surface, proxy=contour, DataMode="Appended")
