"""The pictures of docs/evaluation.md: one region by each method, and a sweep in the middle."""
import numpy as np

from evaluation import stand_ins
from evaluation.programs import write_volume

ISO, ERROR = 99.5, "1"
METHODS = ("isoweave:12", "tandem:0", "tandem:8", "frozen:12")
REGION = (0, 20, 0), (110, 130, 72)  # of the engine, by x, y and z
SWEPT = (0, 20, 0), (200, 220, 128)
STOP = 64  # layers after which the sweep is shown
LOOK = ("--shading", "flat", "--wireframe", "--quiet")


def write_region(programs, path, first, end):
    """A part of the engine, or a formula of its size where that is not there. Returns the iso-value."""
    engine = stand_ins.scan(stand_ins.ENGINE)
    if engine is not None:
        write_volume(path, programs.part(engine, first, end))
        return ISO
    size = "x".join(str(e - f) for f, e in zip(first, end))
    programs.run("isoweave", "generate", "smooth", "--size", size, "--type", "uint8", "-o", path, "--quiet")
    return 127.5


def draw(programs, folder, name, mesh, view, size):
    programs.run("isoweave", "render", mesh, "-o", folder / f"{name}.png", "--view", view, "--size", size, *LOOK)


def join(folder, names, path):
    """Pictures of one height beside one another, as one."""
    import matplotlib.image  # not needed for the rest

    matplotlib.image.imsave(path, np.hstack([matplotlib.image.imread(folder / f"{name}.png") for name in names]))


def draw_all(programs, folder):
    """Writes the pictures, and returns the triangles of each."""
    folder.mkdir(exist_ok=True)
    volume, counts = programs.folder / "region.nrrd", {}
    iso = write_region(programs, volume, *REGION)
    for method in METHODS:
        name = method.replace(":", "-")
        mesh, report = programs.by_method(volume, iso, ERROR, method)
        draw(programs, folder, name, mesh, "35,25", "420x400")
        counts[name] = report["triangles"]
    join(folder, ("isoweave-12", "tandem-0", "frozen-12"), folder / "methods.png")
    iso = write_region(programs, volume, *SWEPT)
    for method in ("isoweave:1", "tandem:0"):
        name = f"half-{method.replace(':', '-')}"
        mesh, report = programs.by_method(volume, iso, ERROR, method, STOP)
        draw(programs, folder, name, mesh, "35,25", "640x420")
        counts[name] = report["triangles"]
    return counts
