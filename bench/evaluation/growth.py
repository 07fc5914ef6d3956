"""How time and memory grow: with layers, with the cross-section, with threads, with the error, with blocks; and what
follows for a volume that is larger than any that was run.

The volume is a formula, of which every part looks like any other, so that nothing but the size grows. Time is that of
processors, all threads together, with that of the formula.
"""
import statistics

import numpy as np

KIND, ISO, ERROR = "smooth", 200, "0.5vox"
LAYERS = [(512, 512, layers) for layers in (256, 512, 1024, 2048, 4096)]
SECTIONS = [(side, side, 256) for side in (256, 512, 1024, 2048)]
LARGEST = (2048, 2048, 2400)
MIDDLE = (512, 512, 512)
THREADS = (1, 2)
ERRORS = (0.1, 0.2, 0.5, 1, 2)                # in voxels
BLOCKS = (64, 128, 256)
MANY = 200_000_000                            # samples of volumes that are run once
ROUNDS = 3
SIDE = 10_000                                 # of the volume that is predicted
RANKS = (64, 512, 4096)


def samples_of(row):
    return float(np.prod(row["dims"]))


def slice_of(row):
    return float(row["dims"][0] * row["dims"][1])


def run(programs, dims, *options):
    """One run: the processor seconds, those by the clock, and the report."""
    volume = f"generate:{KIND}:{'x'.join(map(str, dims))}:uint8"
    seconds, _, report = programs.processor_seconds(volume, ISO, *options)
    return seconds, report["seconds"]["total"], report


def measure(programs, dims, *options, rounds=None):
    """The medians of a few runs."""
    rounds = rounds or (1 if np.prod(dims) > MANY else ROUNDS)
    runs = [run(programs, dims, *options) for _ in range(rounds)]
    report = runs[-1][2]
    return {"dims": dims, "rounds": rounds, "seconds": statistics.median(of[0] for of in runs),
            "clock": statistics.median(of[1] for of in runs),
            "bytes": statistics.median(of[2]["memory"]["peak_bytes"] for of in runs),
            "faces": report["triangles_extracted"], "left": report["triangles"], "digest": report["digest"],
            "held": max(record["undecided_triangles"] for record in report["sweep"]),
            "blocks": report.get("blocks", [])}


def against_threads(programs):
    """Runs with several numbers of threads, in turns."""
    runs = {threads: [] for threads in THREADS}
    for _ in range(ROUNDS):
        for threads in THREADS:
            runs[threads].append(run(programs, MIDDLE, "--error", ERROR, "--threads", threads))
    median = lambda ratios: statistics.median(ratios)
    return [{"threads": threads, "rounds": ROUNDS, "bytes": median(of[2]["memory"]["peak_bytes"] for of in runs[threads]),
             "digest": runs[threads][-1][2]["digest"],
             "seconds per one": median(of[0] / one[0] for of, one in zip(runs[threads], runs[THREADS[0]])),
             "clock per one": median(of[1] / one[1] for of, one in zip(runs[threads], runs[THREADS[0]]))}
            for threads in THREADS]


def measure_all(programs, see):
    one = ("--threads", "1")
    found = {}
    series = {"layers": [(dims, ("--error", ERROR)) for dims in LAYERS],
              "sections": [(dims, ("--error", ERROR)) for dims in SECTIONS],
              "errors": [(MIDDLE, ("--error", f"{error}vox")) for error in ERRORS],
              "blocks": [(MIDDLE, ("--error", ERROR, *options))
                         for options in ((), *(("--blocks", size) for size in BLOCKS))],
              "largest": [(LARGEST, ("--error", ERROR))]}
    found["threads"] = against_threads(programs)
    for name, runs in series.items():
        found[name] = []
        for dims, options in runs:
            found[name].append(measure(programs, dims, *options, *one) | {"options": " ".join(map(str, options))})
            see(found[name][-1])
    return found


def fit(x, y):
    """The slope of a straight line through logarithms, and its value at x = 1."""
    slope, begin = np.polyfit(np.log(x), np.log(y), 1)
    return float(slope), float(np.exp(begin))


def line(x, y):
    """A straight line by least squares of relative differences: slope and value at 0."""
    slope, begin = np.polyfit(x, y, 1, w=1 / np.asarray(y, float))
    return float(slope), float(begin)


def swept(found):
    """The runs that differ in size alone."""
    return found["layers"] + found["sections"] + found["largest"]


def of_time(found):
    """The fits of seconds: to layers, to cross-sections, and to all samples."""
    fits = {name: fit([samples_of(row) for row in rows], [row["seconds"] for row in rows])
            for name, rows in (("layers", found["layers"]), ("sections", found["sections"]), ("all", swept(found)))}
    return fits


def of_memory(found):
    """The slopes of memory to layers and to the samples of a slice, and bytes per sample of a slice with those that
    every run takes."""
    rows = found["sections"] + found["largest"]
    return {"layers": fit([row["dims"][2] for row in found["layers"]], [row["bytes"] for row in found["layers"]])[0],
            "sections": fit([slice_of(row) for row in rows], [row["bytes"] for row in rows])[0],
            "line": line([slice_of(row) for row in rows], [row["bytes"] for row in rows])}


def handed_on(row):
    """The triangles that stages after the first one take in, per triangle of the first one."""
    first, *others = (stage["triangles"] for stage in row["blocks"])
    return [count / first for count in others]


def efficiency(handed):
    """The model: a triangle that is handed on is one triangle more of work and one more to move."""
    return 1 / (1 + 2 * handed)


def handed_in_all(row):
    """What blocks of that size hand on in all in a volume without end: along an axis, n blocks have n - 1 planes
    between them here, and one each there."""
    blocks = row["dims"][0] / row["blocks"][0]["size"]
    return sum(handed_on(row)) * blocks / (blocks - 1)


def of_blocks(found):
    """The fit of what is handed on in all to the sides of blocks."""
    rows = [row for row in found["blocks"] if row["blocks"]]
    return fit([row["blocks"][0]["size"] for row in rows], [handed_in_all(row) for row in rows])


def prediction(found):
    """For SIDE^3 samples: seconds and bytes in one thread, and by the number of ranks the side of their blocks, what
    they hand on, their efficiency, seconds and bytes. From the largest blocks on, what is handed on falls as the area
    of their sides does, per volume: no faster than it was measured to."""
    slope, one = of_time(found)["all"]
    seconds = one * float(SIDE) ** (3 * slope)
    per_sample, always = of_memory(found)["line"]
    largest = found["blocks"][-1]
    ranks = []
    for count in RANKS:
        side = SIDE / count ** (1 / 3)
        handed = handed_in_all(largest) * largest["blocks"][0]["size"] / side
        ranks.append({"ranks": count, "side": side, "handed": handed, "efficiency": efficiency(handed),
                      "seconds": seconds / count / efficiency(handed), "bytes": always + per_sample * side**2})
    return {"seconds": seconds, "bytes": always + per_sample * SIDE**2, "ranks": ranks}


def draw(found, path):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    plt.rcParams["svg.hashsalt"] = "isoweave"
    figure, (time, memory) = plt.subplots(1, 2, figsize=(9, 3.6))
    slope, one = of_time(found)["all"]
    per_sample, always = of_memory(found)["line"]
    for name, label in (("layers", "more layers"), ("sections", "larger cross-section"), ("largest", "the largest")):
        rows = found[name]
        time.loglog([samples_of(row) for row in rows], [row["seconds"] for row in rows], "o", label=label)
        memory.loglog([slice_of(row) for row in rows], [row["bytes"] / 1e6 for row in rows], "o", label=label)
    sizes = np.geomspace(1e7, float(SIDE) ** 3, 50)
    time.loglog(sizes, one * sizes**slope, "-", color="0.6", zorder=0, label=f"slope {slope:.3f}")
    slices = np.geomspace(6e4, float(SIDE) ** 2, 50)
    memory.loglog(slices, (always + per_sample * slices) / 1e6, "-", color="0.6", zorder=0,
                  label=f"{always / 1e6:.0f} MB + {per_sample:.1f} bytes per sample")
    time.set_xlabel("samples")
    time.set_ylabel("processor seconds")
    memory.set_xlabel("samples of a slice")
    memory.set_ylabel("peak memory, MB")
    for axes in (time, memory):
        axes.legend()
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})
