"""What tables 2, 3 and 4 and figure 7 compare: the seven surfaces of the paper, on volumes that stand in."""
import statistics

from evaluation import published, stand_ins

# How a surface is made, by names that the page has. `queue` is complete extraction and one priority queue.
CONFIGURATIONS = {
    "12 layers, 1 thread": ("--slab", "12", "--threads", "1"),
    "12 layers": ("--slab", "12"),
    "automatic": (),
    "queue": ("--slab", "whole", "--schedule", "queue", "--threads", "1"),
}
OTHERS = (("--slab", "1"), ("--slab", "whole"), ("--schedule", "rounds"))  # whose digests are compared as well


def simplification(row):
    """The options that leave the paper's part of the triangles."""
    return ("--ratio", repr(row.ratio)) if row.left < row.faces else ("--error", "0")


def run_rounds(programs, volume, options, rounds):
    """By configuration: the reports of all rounds. Every other round runs backwards."""
    reports = {name: [] for name in CONFIGURATIONS}
    for number in range(rounds):
        for name in list(CONFIGURATIONS)[:: 1 if number % 2 == 0 else -1]:
            _, report = programs.mesh(volume.path, volume.iso, *CONFIGURATIONS[name], *options)
            reports[name].append(report)
    return reports


def ratio_of_times(reports, name, other):
    return statistics.median(a["seconds"]["total"] / b["seconds"]["total"]
                             for a, b in zip(reports[name], reports[other]))


def other_digests(programs, volume, options):
    return {programs.mesh(volume.path, volume.iso, *other, *options)[1]["digest"] for other in OTHERS}


def measure(programs, row, volume, rounds):
    """All of a row, and the report along the sweep."""
    options = simplification(row)
    reports = run_rounds(programs, volume, options, rounds)
    last = {name: of[-1] for name, of in reports.items()}
    one = last["12 layers, 1 thread"]
    digests = {report["digest"] for report in last.values()} | other_digests(programs, volume, options)
    found = {
        "name": row.name, "source": volume.source, "iso": volume.iso, "dims": one["input"]["dims"],
        "crossed": volume.crossed, "faces": one["triangles_extracted"], "left": one["triangles"],
        "error": one["error"], "digests": sorted(digests), "threads": last["12 layers"]["threads"],
        "memory": {name: report["memory"]["peak_bytes"] for name, report in last.items()},
        "simplification per extraction": statistics.median(
            report["seconds"]["simplify"] / report["seconds"]["extract"] for report in reports["12 layers, 1 thread"]),
        "queue per 12 layers": ratio_of_times(reports, "queue", "12 layers, 1 thread"),
        "1 thread per all": ratio_of_times(reports, "12 layers, 1 thread", "12 layers"),
        "12 layers per automatic": ratio_of_times(reports, "12 layers", "automatic"),
    }
    return found, last["12 layers"]


def measure_all(programs, rounds, see):
    """Measures the rows, and hands each to see(row, report of its sweep)."""
    for model in published.MODELS:
        fields = list(stand_ins.FIELDS[model](programs))
        for row in published.ROWS:
            if row.model == model:
                volume = stand_ins.stand_in(fields, row.crossed, programs.folder / "stand-in.nrrd")
                see(*measure(programs, row, volume, rounds))
