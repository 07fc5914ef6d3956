"""Tandem, frozen fronts, a queue and isoweave on one surface, and what tells them apart."""
import numpy as np

from evaluation import published, stand_ins
from evaluation.programs import read_samples, write_volume
from measures import angles, below_front, beside_fronts, biases, comb, in_order, read_triangles

METHODS = ("queue", "isoweave:1", "isoweave:12", *(f"tandem:{lag}" for lag in (0, 1, 2, 4, 8, 16, 32)),
           *(f"frozen:{layers}" for layers in (4, 12, 48)))
ENDLESS = "tandem:1000000000000"  # nothing is decided before all is extracted
ERRORS = ("0.2", "1")             # in voxels
PERIOD = 12                       # layers between fronts, for the comb and the density beside them
# The methods that are run with another axis as well.
ON_ALL_AXES = ("queue", "isoweave:12", "tandem:0", "tandem:2", "tandem:8", "tandem:32", "frozen:12")
AXES = {"z": (0, 1, 2), "x": (2, 0, 1), "y": (1, 2, 0)}  # the swept axis comes first
# Isoweave's distance at other numbers of triangles is interpolated between these parts of the error.
PARTS = (0.1, 0.2, 0.35, 0.5, 0.7, 0.85, 1, 1.15, 1.4, 1.7)
DISTANCES = (0, 1, 2, 4, 8, 16, 32, 64)  # layers below the front


def turned(samples, axis):
    """The volume with an axis in the place of z."""
    return np.ascontiguousarray(samples.transpose(AXES[axis]))


def shapes(triangles, period):
    """The measures of triangles in order: equal meshes have equal ones, bit for bit."""
    return {"bias": biases(triangles), "comb": comb(triangles, period), "angle": angles(triangles)[1],
            "beside": beside_fronts(triangles, PERIOD)}


def period_of(method):
    """The layers between the fronts of a method that has fronts, or PERIOD."""
    kind, _, layers = method.partition(":")
    return int(layers) if kind == "frozen" else PERIOD


def measure_methods(programs, volume, iso, error, methods=METHODS, full=None):
    """By method: counts, shapes and, where the full surface is given, the RMS distance to that. The first method is the
    reference. Its comb is taken with the period of each method, as "reference comb"."""
    found = {}
    reference = None
    for method in methods:
        path, counts = programs.by_method(volume, iso, error, method)
        triangles = in_order(read_triangles(path))
        reference = triangles if reference is None else reference
        found[method] = counts | shapes(triangles, period_of(method))
        found[method]["reference comb"] = comb(reference, period_of(method))
        if full is not None:
            found[method]["rms"] = programs.distance(path, full)
    return found


def curve(programs, volume, iso, error, full):
    """Triangles and distance of isoweave at errors around one, ascending in triangles."""
    errors = [f"{part * float(error):g}vox" for part in PARTS]
    _, report = programs.mesh(volume, iso, "--lods", ",".join(errors), name="level.ply")
    meshes = [programs.folder / f"level_lod{number}.ply" for number in range(len(errors))]
    counts = [level["triangles"] for level in report["levels"]] + [report["triangles"]]
    return sorted(zip(counts, (programs.distance(mesh, full) for mesh in meshes)))


def at_equal(points, counts):
    """Isoweave's distance at the method's number of triangles, and its triangles at the method's distance; None
    outside the curve."""
    triangles, distances = np.log(np.array(points)).T
    number, distance = np.log(counts["triangles"]), np.log(counts["rms"])

    def between(value, known, wanted):
        return float(np.exp(np.interp(value, known, wanted))) if known.min() <= value <= known.max() else None

    return between(number, triangles, distances), between(distance, distances[::-1], triangles[::-1])


def fronts_in_the_middle(programs, volume, iso, error, layers):
    """Triangles by their distance below the front when half of the volume is swept, by method, and of the reference's
    complete mesh in the same place."""
    front = layers // 2
    count = lambda method, *until: below_front(programs.triangles(volume, iso, error, method, *until), front, DISTANCES)
    methods = ("isoweave:1", "tandem:0", "tandem:8", "tandem:32")
    return {"queue": count("queue"), **{method: count(method, front) for method in methods}}


def surfaces(programs):
    """Name, samples and iso-value of the surfaces that methods are compared on."""
    row = published.ROWS[2]
    fields = stand_ins.FIELDS[row.model](programs)
    volume = stand_ins.stand_in(fields, row.crossed, programs.folder / "scan.nrrd")
    yield f"stand-in of {row.name}", np.array(read_samples(volume.path)), volume.iso
    programs.run("isoweave", "generate", "smooth", "--size", "96", "--type", "uint8", "-o",
                 programs.folder / "smooth.nrrd", "--quiet")
    yield "`generate:smooth:96x96x96:uint8`", np.array(read_samples(programs.folder / "smooth.nrrd")), 127.5


def measure_surface(programs, name, samples, iso):
    """All of a surface: at two errors, swept along three axes."""
    found = {"name": name, "iso": iso, "dims": samples.shape[::-1], "errors": {}}
    volume = programs.folder / "turned.nrrd"
    for error in ERRORS:
        of = found["errors"][error] = {"axes": {}}
        for axis in AXES:
            write_volume(volume, turned(samples, axis))
            full = programs.mesh(volume, iso, "--error", "0", name="full.ply")[0] if axis == "z" else None
            methods = METHODS if axis == "z" else ON_ALL_AXES
            of["axes"][axis] = measure_methods(programs, volume, iso, error, methods, full)
            if axis != "z":
                continue
            of["curve"] = curve(programs, volume, iso, error, full)
            of["middle"] = fronts_in_the_middle(programs, volume, iso, error, len(samples))
    return found
