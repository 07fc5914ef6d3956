"""What tables 2, 3 and 4 and figure 7 compare: the seven surfaces of the paper, on volumes that stand in."""
import statistics

from evaluation import published, stand_ins

# How a surface is made. `queue` is complete extraction and one priority queue.
CONFIGURATIONS = {
    "12 layers": ("--slab", "12", "--threads", "1"),
    "queue": ("--slab", "whole", "--schedule", "queue", "--threads", "1"),
    "automatic": (),
}
# Others whose digests are compared, where the surface has no more faces than FEW. Their rounds are more, too.
OTHERS = (("--slab", "1"), ("--slab", "whole"), ("--schedule", "rounds"))
FEW = 2_500_000
ROUNDS = 3


def simplification(programs, row, volume):
    """The options that leave the paper's part of the triangles, or a few more: the error with which a run ends that
    stops at their number. The paper had an error, too, and does not tell it."""
    if row.left == row.faces:
        return "--error", "0"
    return "--error", repr(programs.mesh(volume.path, volume.iso, "--ratio", repr(row.ratio))[1]["error"])


def run_round(programs, volume, options):
    """By configuration: the processor seconds and the report."""
    found = {}
    for name, others in CONFIGURATIONS.items():
        seconds, _, report = programs.processor_seconds(volume.path, volume.iso, *others, *options)
        found[name] = seconds, report
    return found


def measure(programs, row, volume):
    """All of a row, and the report along its sweep."""
    options = simplification(programs, row, volume)
    few = row.faces <= FEW
    rounds = [run_round(programs, volume, options) for _ in range(ROUNDS if few else 1)]
    reports = {name: report for name, (_, report) in rounds[-1].items()}
    for others in OTHERS if few else ():
        reports[" ".join(others)] = programs.mesh(volume.path, volume.iso, *others, *options)[1]
    one = reports["12 layers"]
    found = {
        "name": row.name, "source": volume.source, "iso": volume.iso, "dims": one["input"]["dims"],
        "crossed": volume.crossed, "faces": one["triangles_extracted"], "left": one["triangles"],
        "error": one["error"], "digests": {name: report["digest"] for name, report in reports.items()},
        "memory": {name: reports[name]["memory"]["peak_bytes"] for name in CONFIGURATIONS},
        "rounds": len(rounds), "threads": reports["automatic"]["threads"],
        "queue per 12 layers": statistics.median(of["queue"][0] / of["12 layers"][0] for of in rounds),
    }
    return found, one


def measure_all(programs, see):
    """Measures the rows, and hands each to see(row, report of its sweep)."""
    for model in published.MODELS:
        fields = list(stand_ins.FIELDS[model](programs))
        for row in published.ROWS:
            if row.model == model:
                volume = stand_ins.stand_in(fields, row.crossed, programs.folder / "stand-in.nrrd")
                see(*measure(programs, row, volume))
