"""What must be so on any machine, on small volumes: `bench/paper quick`."""
import numpy as np

from evaluation import method_runs, stand_ins
from evaluation.programs import read_samples, write_volume
from measures import in_order, read_triangles

SIZE = 48
ISO = 127.5
STOP = 20  # slices after which sweeps are stopped
LEAST_BIAS = 0.05
LEAST_COMB = 0.1


class Unexpected(Exception):
    pass


def expect(what, expected, found):
    if found != expected:
        raise Unexpected(f"{what}: expected {expected}, found {found}")


def check_digests(programs, volume, error, reference):
    """Every way to run the program gives the mesh of complete extraction and one queue."""
    error = ("--error", f"{error}vox")
    for options in (("--slab", "1"), ("--slab", "12"), ("--slab", "whole"), ("--schedule", "queue"),
                    ("--schedule", "rounds"), ("--threads", "1")):
        report = programs.mesh(volume, ISO, *options, *error)[1]
        expect(f"digest of {' '.join(options + error)}", reference["digest"], report["digest"])


def check_methods(programs, volume, error):
    """Isoweave has no bias and the comb of the reference; tandem without a lag and frozen fronts have theirs."""
    methods = ("queue", "isoweave:1", "isoweave:12", method_runs.ENDLESS, "tandem:0", "frozen:4")
    found = method_runs.measure_methods(programs, volume, ISO, error, methods)
    reference = found["queue"]
    for method in methods[:4]:
        for measure in ("digest", "bias", "comb", "angle", "beside"):
            expect(f"{measure} of {method} at {error} voxel", reference[measure], found[method][measure])
    for method in methods:
        expect(f"triangles held by {method} in the end", 0, found[method]["held"])
    bias = found["tandem:0"]["bias"][2] - reference["bias"][2]
    if bias > -LEAST_BIAS:
        raise Unexpected(f"bias of tandem:0 at {error} voxel: expected below {-LEAST_BIAS}, found {bias}")
    comb = found["frozen:4"]["comb"] - reference["comb"]
    if comb < LEAST_COMB and error == "1":
        raise Unexpected(f"comb of frozen:4 at {error} voxel: expected above {LEAST_COMB}, found {comb}")
    check_digests(programs, volume, error, reference)


def check_preview(programs, volume):
    """Slabs and threads do not change a preview, and triangles have gone for the reasons that it tells."""
    whole = programs.mesh(volume, ISO, "--preview=3vox", "--slab", "whole", "--threads", "1")[1]
    for options in (("--slab", "1"), ("--slab", "12"), ("--threads", "2")):
        expect(f"digest of a preview with {' '.join(options)}", whole["digest"],
               programs.mesh(volume, ISO, "--preview=3vox", *options)[1]["digest"])
    gone = whole["preview"]["triangles_collapsed"] + whole["preview"]["triangles_repeated"]
    expect("triangles of a preview and those gone", whole["triangles_extracted"], whole["triangles"] + gone)


def vertices_on(triangles, slice_number):
    return np.unique(triangles[triangles[:, :, 2] == slice_number], axis=0)


def check_fronts(programs, volume):
    """A sweep that stops leaves the vertices on its front where they were extracted, and frozen ones stay there."""
    full = vertices_on(read_triangles(programs.mesh(volume, ISO, "--error", "0")[0]), STOP)
    sweeps = [(method, STOP) for method in ("isoweave:1", "isoweave:7", "tandem:0", "tandem:4", "frozen:10")]
    for method, *stop in (*sweeps, (f"frozen:{STOP}",)):
        found = vertices_on(programs.triangles(volume, ISO, "1", method, *stop), STOP)
        if not np.array_equal(full, found):
            raise Unexpected(f"vertices on the front of {method}: expected the {len(full)} of the full surface, "
                             f"found {len(found)}, others")


def rows_of(triangles):
    """Triangles as a set."""
    return {row.tobytes() for row in in_order(triangles)}


def check_held(programs, volume):
    """The triangles that a sweep still changes once it has stopped are among those that it holds."""
    for method in ("isoweave:1", "tandem:0", "tandem:16"):
        path, counts = programs.by_method(volume, ISO, "1", method, STOP)
        stopped = rows_of(read_triangles(path))
        changed = len(stopped - rows_of(programs.triangles(volume, ISO, "1", method)))
        if not 0 < changed <= counts["held"] <= counts["most_held"]:
            raise Unexpected(f"held by {method}: expected {changed} to {counts['most_held']}, found {counts['held']}")


def check_stand_in(programs):
    """A stand-in crosses as many cells as it should, and as many as it says."""
    field = stand_ins.Field(programs.formula("smooth", (SIZE, SIZE, SIZE)), "formula", 0.5, 1)
    volume = stand_ins.stand_in([field], 6000, programs.folder / "stand-in.nrrd")
    report = programs.mesh(volume.path, volume.iso, "--error", "0")[1]
    expect("crossed cells of a stand-in", volume.crossed, report["cells_crossed"])
    expect("whether they are within half a percent", True, abs(volume.crossed - 6000) <= 30)


def check_all(programs):
    smooth, volume = programs.folder / "smooth.nrrd", programs.folder / "volume.nrrd"
    programs.run("isoweave", "generate", "smooth", "--size", SIZE, "--type", "uint8", "-o", smooth, "--quiet")
    samples = np.array(read_samples(smooth))
    for axis in method_runs.AXES:
        write_volume(volume, method_runs.turned(samples, axis))
        for error in method_runs.ERRORS:
            check_methods(programs, volume, error)
        check_fronts(programs, volume)
        check_held(programs, volume)
        check_preview(programs, volume)
    check_stand_in(programs)
