#!/usr/bin/python3
"""Tables and plots from the results of bench/run; needs python3-matplotlib.

  bench/report.py RESULTS OUT            OUT/report.md and OUT/*.svg, *.png
  bench/report.py RESULTS --docs FILE    rewrites what lies in FILE between the lines <!-- begin NAME --> and
                                         <!-- end NAME -->; plots go to the folder named as FILE without its ending
"""
import argparse
import json
import pathlib
import re
import statistics

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

NORMAL, FINE = "isoweave normal", "isoweave fine"
FLOOR = "every sample read once"
FLYING_EDGES = "VTK flying edges, TBB"
MESHOPTIMIZER, SLABS = "meshoptimizer", "meshoptimizer in slabs"
SLOW_PEERS = ("VTK quadric decimation", "CGAL Garland-Heckbert", "CGAL Lindstrom-Turk", "OpenMesh")
FAST_JOB, QUADRIC_JOB = "VTK flying edges + meshoptimizer", "VTK flying edges + quadric decimation"
LARGE = 155e6  # samples from which on the goal for memory holds
NEAR = 0.5  # share of the speed of reading that counts as near it
TOLERANCE = 0.05  # by which counts may differ that count as equal
UNKNOWN = "–"


# ---- results

def load(folder):
    results = [json.loads(path.read_text()) for path in sorted(pathlib.Path(folder).glob("*.json"))]
    results = [result for result in results if result["rows"]]
    return sorted(results, key=lambda result: samples(result) if "input" in result else 0)


def suite(results, name):
    return [result for result in results if result["suite"] == name]


def samples(result):
    x, y, z = result["input"]["dims"]
    return x * y * z


def volume_name(result):
    return result["input"]["name"]


def is_ours(name):
    return name.startswith("isoweave")


def failure(row):
    return row["ours"].get("failure") or row["peer"].get("failure")


def rows_of(result, peer=None, threads=None, left=None):
    """Rows that have a ratio, of one peer, number of threads and share left, where given."""
    return [
        row
        for row in result["rows"]
        if "ratio" in row
        and (peer is None or row["peer"]["name"] == peer)
        and (threads is None or row["threads"] == threads)
        and (left is None or row["left"] in left)
    ]


def is_at_count(side, count):
    return abs(side["triangles"] / count - 1) <= TOLERANCE


def equal_rows(*arguments):
    """The rows in which the peer came to the count that it was asked for: those that show who is faster."""
    return [row for row in rows_of(*arguments) if is_at_count(row["peer"], row["ours"]["triangles"])]


def lefts(result):
    return sorted({row["left"] for row in result["rows"]}, reverse=True)


def thread_counts(result):
    return sorted({row["threads"] for row in result["rows"] if row["threads"] > 0})


def names(rows):
    """Peers in the order in which they ran."""
    return list(dict.fromkeys(row["peer"]["name"] for row in rows))


def added_bytes(side):
    """What the run adds to its input in the contestant's own structures."""
    return side["peak_bytes"] - side["bytes_before"]


# ---- tables

def number(value, digits=3):
    """With so many significant digits, and without an exponent."""
    if value is None:
        return UNKNOWN
    if value == 0 or abs(value) >= 10 ** (digits - 1):
        return f"{value:.0f}"
    return f"{value:#.{digits}g}"


def times(ratio):
    return UNKNOWN if ratio is None else f"{number(ratio)}×"


def counted(value):
    return UNKNOWN if value is None else f"{value:,}"


def megabytes(value):
    return number(value / 1e6)


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|---" * len(header) + "|"]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows])


def median_side(rows, threads):
    """Ours, over all peers that it ran beside."""
    sides = [row["ours"] for row in rows if row["threads"] == threads and "seconds" in row["ours"]]
    if not sides:
        return None
    return sides[0] | {"seconds": statistics.median(side["seconds"] for side in sides)}


def contestant_sides(rows, threads):
    """Name, ratio and runs of each contestant with each number of threads; ours first."""
    ours = {count: median_side(rows, count) for count in threads}
    found = [(rows[0]["ours"]["name"], {count: 1.0 for count in threads}, ours, None)]
    for name in names(rows):
        own = [row for row in rows if row["peer"]["name"] == name]
        ratios = {row["threads"]: row.get("ratio") for row in own}
        sides = {row["threads"]: row["peer"] for row in own if "seconds" in row["peer"]}
        found.append((name, ratios, sides, next((failure(row) for row in own if failure(row)), None)))
    return found


def seconds_cell(side, threads):
    """A serial contestant has one time; it stands where it ran."""
    if side is None or side["threads"] != threads:
        return UNKNOWN
    return number(side["seconds"])


def triangles_cell(side, count):
    text = counted(side["triangles"])
    if side["triangles"] == 0:
        return UNKNOWN
    return text if is_at_count(side, count) else f"**not at the count:** {text}"


def timing_cells(ratios, sides, threads, count):
    last = sides.get(threads[-1]) or next(iter(sides.values()), None)
    cells = [times(ratios.get(at)) for at in threads]
    cells += [seconds_cell(sides.get(at), at) for at in threads]
    return cells + [str(last["threads"]), megabytes(added_bytes(last)), triangles_cell(last, count)], last


def quality_cells(side):
    quality = side.get("quality")
    if quality is None:
        return [UNKNOWN] * 6
    return [
        number(quality["mean"]), number(quality["rms"]), number(quality["max"]),
        counted(quality["nonmanifold_edges"]), counted(quality["euler"]), f"{100 * quality['slivers']:.1f}",
    ]


def contestants_table(rows, threads, full):
    """One contestant per row. `full`: the counts of the full surface, or nothing where quality was not measured."""
    heads = [f"ratio, {count} thr." for count in threads] + [f"s, {count} thr." for count in threads]
    header = ["", *heads, "threads", "MB", "triangles"]
    if full:
        header += ["mean", "RMS", "max", "non-manifold edges", f"Euler number (full: {full['euler']:,})", "< 5°, %"]
    lines, count = [], None
    for name, ratios, sides, problem in contestant_sides(rows, threads):
        sides = {count: side for count, side in sides.items() if side}
        if not sides:
            lines.append([name, f"failed: {problem}"] + [""] * (len(header) - 2))
            continue
        count = count or next(iter(sides.values()))["triangles"]
        cells, side = timing_cells(ratios, sides, threads, count)
        lines.append([name, *cells, *(quality_cells(side) if full else [])])
    return table(header, lines)


def describe(result):
    info = result["input"]
    size = "×".join(str(side) for side in info["dims"])
    text = f"{info['name']}, {size} {info['type']}, {samples(result) / 1e6:.0f} M samples"
    if "full" in result:
        text += f", {result['full']['triangles']:,} triangles"
    return text


def extraction_tables(results):
    for result in suite(results, "extract"):
        yield f"**{describe(result)}**\n\n{contestants_table(result['rows'], thread_counts(result), None)}"


def tables_at_each_share(result):
    for left in lefts(result):
        rows = [row for row in result["rows"] if row["left"] == left]
        head = f"**{describe(result)}, {left:g} % left**"
        yield f"{head}\n\n{contestants_table(rows, thread_counts(result), result['full'])}"


def simplification_tables(results):
    for result in suite(results, "simplify"):
        yield from tables_at_each_share(result)


def job_tables(results):
    for result in suite(results, "job"):
        yield from tables_at_each_share(result)


def range_text(values):
    """The median, and the ends where there is more than one."""
    if not values:
        return UNKNOWN
    if len(values) == 1:
        return times(values[0])
    return f"{times(statistics.median(values))} ({number(min(values))} to {number(max(values))})"


def summary_table(results, threads):
    """Ratios of every peer at every share left, over the volumes."""
    found = suite(results, "simplify")
    shares = sorted({left for result in found for left in lefts(result)}, reverse=True)
    peers = list(dict.fromkeys(name for result in found for name in names(result["rows"])))
    lines = []
    for peer in peers:
        rows = [[row for result in found for row in rows_of(result, peer, threads, [left])] for left in shares]
        lines.append([peer, *(range_text([row["ratio"] for row in same]) for same in rows)])
    volumes = f"{len(found)} volume{'s' if len(found) != 1 else ''}"
    head = f"{threads} thread{'s' if threads > 1 else ''}, {volumes}"
    return table([head, *(f"{left:g} % left" for left in shares)], lines)


# ---- goals

def worst(values, wanted):
    """The value nearest to failing and the volumes' range. `values`: (value, volume); `wanted`: (bound, direction)."""
    if not values:
        return "not measured", None
    bound, at_least = wanted
    value, volume = (min if at_least else max)(values)
    text = f"{number(value)} (worst of {len(values)}: {volume})" if len(values) > 1 else f"{number(value)} ({volume})"
    return text, value >= bound if at_least else value <= bound


def ratios_to(results, name, peers, threads, left=None):
    return [
        (row["ratio"], f"{volume_name(result)}, {row['peer']['name']}, {row['left']:g} % left")
        for result in suite(results, name)
        for peer in peers
        for row in equal_rows(result, peer, threads, left)
    ]


def extraction_ratios(results):
    return [
        (row["ratio"], f"{volume_name(result)}, {row['threads']} threads")
        for result in suite(results, "extract")
        for row in rows_of(result, FLYING_EDGES)
    ]


def label_like_ratios(results):
    """Speed of extraction as a share of the speed of reading, where there is less than a triangle for 50 samples."""
    return [
        (row["ratio"], f"{volume_name(result)}, {row['threads']} threads")
        for result in suite(results, "extract")
        for row in rows_of(result, FLOOR)
        if row["ours"]["triangles"] < samples(result) / 50
    ]


def rms_ratios(results, peer, left):
    return [
        (row["ours"]["quality"]["rms"] / row["peer"]["quality"]["rms"],
         f"{volume_name(result)}, {row['left']:g} % left")
        for result in suite(results, "simplify")
        for row in equal_rows(result, peer, None, left)
        if row["threads"] == thread_counts(result)[0]
    ]


def nonmanifold_edges(results, left):
    return [
        (row["ours"]["quality"]["nonmanifold_edges"], volume_name(result))
        for result in suite(results, "simplify")
        for row in rows_of(result, None, None, left)
    ]


def memory_ratios(results):
    """The leanest peer's memory in terms of ours."""
    found = []
    for result in suite(results, "job"):
        for left in lefts(result):
            rows = [row for row in equal_rows(result, None, 4, [left]) if not is_ours(row["peer"]["name"])]
            if samples(result) >= LARGE and rows:
                leanest = min(added_bytes(row["peer"]) for row in rows)
                most = max(added_bytes(row["ours"]) for row in rows)
                found.append((leanest / most, f"{volume_name(result)}, {left:g} % left"))
    return found


def fine_rms_ratios(results):
    """RMS distance of `fine` in terms of the best peer's at the same count."""
    found = []
    for result in suite(results, "simplify"):
        for left in lefts(result):
            rows = equal_rows(result, None, thread_counts(result)[0], [left])
            peers = [row["peer"]["quality"]["rms"] for row in rows if not is_ours(row["peer"]["name"])]
            fine = [row["peer"]["quality"]["rms"] for row in rows if row["peer"]["name"] == FINE]
            if peers and fine and left in (50, 20, 10, 5):
                found.append((fine[0] / min(peers), f"{volume_name(result)}, {left:g} % left"))
    return found


def fine_times(results):
    return [
        (row["ratio"], f"{volume_name(result)}, {row['left']:g} % left, {row['threads']} threads")
        for result in suite(results, "simplify")
        for row in rows_of(result, FINE)
    ]


def at_least(bound):
    return bound, True


def at_most(bound):
    return bound, False


def goals(results):
    """What is compared, against what, the goal, the measured values, and their bound."""
    return [
        ("extraction, same threads", "VTK flying edges (TBB)", "2×", extraction_ratios(results), at_least(2)),
        ("extraction, label-like volumes", "every sample read once", f"{NEAR:g} of its speed",
         label_like_ratios(results), at_least(NEAR)),
        ("simplification, 1 thread, 20 % left", "meshoptimizer", "1×",
         ratios_to(results, "simplify", [MESHOPTIMIZER], 1, [20]), at_least(1)),
        ("its RMS distance", "meshoptimizer", "at most 0.7 of theirs",
         rms_ratios(results, MESHOPTIMIZER, [20]), at_most(0.7)),
        ("simplification, 4 threads, 20 to 5 % left", "meshoptimizer", "4×",
         ratios_to(results, "simplify", [MESHOPTIMIZER], 4, [20, 10, 5]), at_least(4)),
        ("simplification, 4 threads, 10 % left", "meshoptimizer in 16 slabs", "1.25×",
         ratios_to(results, "simplify", [SLABS], 4, [10]), at_least(1.25)),
        ("its non-manifold edges", "", "none", nonmanifold_edges(results, [10]), at_most(0)),
        ("simplification, 4 threads", "VTK quadric, CGAL, OpenMesh", "40×",
         ratios_to(results, "simplify", SLOW_PEERS, 4), at_least(40)),
        ("whole job, 4 threads", "flying edges + meshoptimizer", "3.5×",
         ratios_to(results, "job", [FAST_JOB], 4), at_least(3.5)),
        ("whole job, 4 threads", "flying edges + VTK quadric", "30×",
         ratios_to(results, "job", [QUADRIC_JOB], 4), at_least(30)),
        ("memory of the whole job, 155 M samples or more", "the leanest of them", "5× less",
         memory_ratios(results), at_least(5)),
        ("RMS distance of `fine`, 50, 20, 10, 5 % left", "the best of all peers", "at most 1.0 of theirs",
         fine_rms_ratios(results), at_most(1)),
        ("time of `fine`", "`normal`", "at most 2×", fine_times(results), at_most(2)),
    ]


def goal_table(results):
    verdicts = {True: "yes", False: "no", None: UNKNOWN}
    lines = []
    for what, against, goal, values, wanted in goals(results):
        measured, reached = worst(values, wanted)
        lines.append([what, against, goal, measured, verdicts[reached]])
    return table(["", "against", "goal", "measured", "reached"], lines)


# ---- scaling

def medians(rows, curve, kind, key, value=lambda row: row["seconds"]["total"]):
    """(key, median over the repetitions) of one curve, in the order in which it was measured."""
    groups = {}
    for row in rows:
        if row["curve"] == curve and row["kind"] == kind:
            groups.setdefault(key(row), []).append(value(row))
    return [(at, statistics.median(values)) for at, values in groups.items()]


def slopes(points):
    return [1000 * (b[1] - a[1]) / (b[0] - a[0]) for a, b in zip(points, points[1:])]


def layer_count(row):
    return row["layers"]


def slab_text(row):
    return str(row["slab"] or "auto")


def scaling_tables(results):
    for result in suite(results, "scaling"):
        rows = result["rows"]
        for kind in ("noise", "smooth"):
            threads = medians(rows, "threads", kind, lambda row: row["threads"])
            yield table(["threads, " + kind, *(str(count) for count, _ in threads)],
                        [["seconds", *(number(seconds) for _, seconds in threads)],
                         ["times as fast", *(times(threads[0][1] / seconds) for _, seconds in threads)]])
            layers = medians(rows, "layers", kind, layer_count)
            yield table(["layers, " + kind, *(str(count) for count, _ in layers)],
                        [["seconds", *(number(seconds) for _, seconds in layers)],
                         ["ms per layer more", "", *(number(slope) for slope in slopes(layers))]])
            slabs = medians(rows, "slab", kind, slab_text)
            peaks = dict(medians(rows, "slab", kind, slab_text, lambda row: row["peak_bytes"]))
            yield table(["layers per slab, " + kind, *(slab for slab, _ in slabs)],
                        [["seconds", *(number(seconds) for _, seconds in slabs)],
                         ["peak memory, MB", *(megabytes(peaks[slab]) for slab, _ in slabs)]])
        yield memory_table(rows)


def memory_table(rows):
    curves = {mode: medians(rows, f"memory, {mode}", "smooth", layer_count, lambda row: row["peak_bytes"])
              for mode in ("open", "closed")}
    lines = [[f"peak memory {mode}, MB", *(megabytes(peak) for _, peak in curve)] for mode, curve in curves.items()]
    return table(["layers, smooth", *(str(count) for count, _ in curves["open"])], lines)


# ---- plots

SHADES = ["#9ecae1", "#6baed6", "#3182bd", "#08519c", "#08306b"]
OURS = "#d95f02"
OTHERS = ["#1b6ca8", "#7b3294", "#4d9221", "#8c510a", "#878787", "#c51b7d", "#35978f", "#bf812d", "#542788", "#b2182b"]
plt.rcParams.update({
    "font.size": 9, "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "grid.color": "#e6e6e6",
    "axes.axisbelow": True, "figure.facecolor": "white", "savefig.facecolor": "white", "legend.frameon": False,
    "svg.hashsalt": "isoweave", "svg.fonttype": "none", "font.family": "DejaVu Sans",
})


def save(figure, folder, name):
    figure.tight_layout()
    figure.savefig(folder / f"{name}.svg", metadata={"Date": None})
    figure.savefig(folder / f"{name}.png", dpi=150)
    plt.close(figure)
    return name


def plain_logs(axis):
    """Ticks of a logarithmic axis as people write them."""
    axis.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(matplotlib.ticker.NullFormatter())


def plot_speed(result, folder):
    """A point for each peer and share left, one panel for each number of threads."""
    counts, shares = thread_counts(result), lefts(result)
    peers = [name for name in names(result["rows"]) if rows_of(result, name)]
    if not peers:
        return None
    size = (4.6 * len(counts) + 1, 0.32 * len(peers) + 1.4)
    figure, panels = plt.subplots(1, len(counts), figsize=size, sharey=True, squeeze=False)
    for panel, count in zip(panels[0], counts):
        for left, shade in zip(shares, SHADES[-len(shares):]):
            points = [(row["ratio"], peers.index(row["peer"]["name"])) for row in rows_of(result, None, count, [left])]
            panel.scatter(*zip(*points), color=shade, s=36, label=f"{left:g} % left")
        panel.axvline(1, color="black", linewidth=1)
        panel.set_xscale("log")
        plain_logs(panel.xaxis)
        panel.set_xlabel(f"time / isoweave's, {count} thread{'s' if count > 1 else ''}")
    panels[0][0].set_yticks(range(len(peers)), peers)
    panels[0][0].invert_yaxis()
    panels[0][-1].legend(loc="center left", bbox_to_anchor=(1, 0.5))
    figure.suptitle(f"{result['suite']}, {volume_name(result)}")
    return save(figure, folder, f"speed-{result['suite']}-{volume_name(result)}")


def error_curves(result):
    """Name and (share left, RMS distance) of every contestant; ours first."""
    curves = {NORMAL: {}}
    for row in rows_of(result, None, thread_counts(result)[0]):
        for side in (row["ours"], row["peer"]):
            if "quality" in side:
                share = 100 * side["triangles"] / result["full"]["triangles"]
                curves.setdefault(side["name"], {})[share] = side["quality"]["rms"]
    return [(name, sorted(points.items())) for name, points in curves.items() if points]


def error_styles(curves):
    """Ours in one colour and with marks of their own, each peer in a colour."""
    colours = iter(OTHERS)
    for name, _ in curves:
        if is_ours(name):
            yield {"color": OURS, "marker": {NORMAL: "o", FINE: "^"}.get(name, "s"), "linewidth": 2.2, "zorder": 3}
        else:
            yield {"color": next(colours, "#878787"), "marker": "o", "linewidth": 1.2, "zorder": 2}


def plot_error(result, folder):
    curves, shares = error_curves(result), lefts(result)
    if not curves:
        return None
    figure, panel = plt.subplots(figsize=(8, 4.4))
    for (name, points), style in zip(curves, error_styles(curves)):
        panel.plot(*zip(*points), markersize=5, label=name, **style)
    panel.set_xscale("log")
    panel.set_yscale("log")
    panel.yaxis.set_major_locator(matplotlib.ticker.LogLocator(subs=(1, 2, 5)))
    plain_logs(panel.yaxis)
    panel.set_xlim(min(shares) / 1.3, max(shares) * 1.3)
    panel.set_xticks(shares, [f"{left:g} %" for left in shares])
    panel.xaxis.set_minor_locator(matplotlib.ticker.NullLocator())
    panel.set_xlabel(f"triangles left of {result['full']['triangles']:,}")
    panel.set_ylabel("RMS distance, voxels")
    panel.set_title(volume_name(result))
    panel.legend(loc="center left", bbox_to_anchor=(1, 0.5))
    return save(figure, folder, f"error-{volume_name(result)}")


def job_memory(result):
    """Megabytes of each contestant with the most threads at the first share left."""
    rows = rows_of(result, None, thread_counts(result)[-1], lefts(result)[:1])
    sides = [(row["peer"]["name"], row["peer"]) for row in rows if not is_ours(row["peer"]["name"])]
    if rows:
        sides.insert(0, (rows[0]["ours"]["name"], rows[0]["ours"]))
    return [(name, added_bytes(side) / 1e6) for name, side in sides]


def plot_job_memory(results, folder):
    """A panel of bars for each volume."""
    groups = [(volume_name(result), job_memory(result)) for result in suite(results, "job")]
    groups = [(volume, sides) for volume, sides in groups if sides]
    if not groups:
        return None
    heights = [len(sides) for _, sides in groups]
    figure, panels = plt.subplots(len(groups), 1, figsize=(8, 0.3 * sum(heights) + 0.7 * len(groups) + 0.3),
                                  gridspec_kw={"height_ratios": heights}, squeeze=False)
    for panel, (volume, sides) in zip(panels[:, 0], groups):
        draw_memory(panel, sides)
        panel.set_title(volume, loc="left")
    panels[-1][0].set_xlabel("memory of the whole job, MB")
    return save(figure, folder, "memory")


def draw_memory(panel, sides):
    for at, (name, size) in enumerate(sides):
        panel.barh(at, size, color=OURS if is_ours(name) else "#9ecae1")
        panel.text(size, at, f" {size:.0f}", va="center")
    panel.set_yticks(range(len(sides)), [name for name, _ in sides])
    panel.invert_yaxis()
    panel.grid(axis="y", visible=False)


def plot_scaling(result, folder):
    rows = result["rows"]
    figure, panels = plt.subplots(2, 2, figsize=(9, 6))
    for kind, colour in (("noise", OTHERS[0]), ("smooth", OTHERS[2])):
        draw_speedup(panels[0][0], medians(rows, "threads", kind, lambda row: row["threads"]), kind, colour)
        panels[0][1].plot(*zip(*medians(rows, "layers", kind, layer_count)), "o-", color=colour, label=kind)
        panels[1][0].plot(*zip(*medians(rows, "slab", kind, slab_text)), "o-", color=colour, label=kind)
    for mode, style in (("open", "o-"), ("closed", "o--")):
        points = medians(rows, f"memory, {mode}", "smooth", layer_count, lambda row: row["peak_bytes"] / 1e6)
        panels[1][1].plot(*zip(*points), style, color=OTHERS[2], label=f"smooth, {mode}")
    labels = [("threads", "times as fast as one thread"), ("layers of the same texture", "seconds"),
              ("layers per slab", "seconds"), ("layers of the same texture", "peak memory, MB")]
    for panel, (x_label, y_label) in zip(panels.flat, labels):
        panel.set(xlabel=x_label, ylabel=y_label)
        panel.set_ylim(bottom=0)
        panel.legend()
    for panel in (panels[0][1], panels[1][1]):
        panel.set_xlim(left=0)
        panel.legend(loc="upper left")
    return save(figure, folder, "scaling")


def draw_speedup(panel, points, kind, colour):
    counts = [count for count, _ in points]
    panel.plot(counts, [points[0][1] / seconds for _, seconds in points], "o-", color=colour, label=kind)
    panel.plot(counts, counts, color="#bbbbbb", linewidth=1, zorder=1)  # as many times as threads
    panel.set_xticks(counts)


# ---- the report

def image(folder, name, text):
    return f"![{text}]({folder}{name}.svg)"


def machine_text(results):
    found = {(result["machine"]["processor"], result["machine"]["threads"]) for result in results}
    repetitions = sorted({result["repetitions"] for result in results})
    loads = [result["machine"]["load"] for result in results if "load" in result["machine"]]
    absent = sorted({name for result in results for name in result.get("absent", [])})
    text = "; ".join(f"{processor}, {threads} threads" for processor, threads in sorted(found))
    text += f". Repetitions: {', '.join(str(count) for count in repetitions)}."
    if loads:
        text += f" Load when the suites began: {number(min(loads), 2)} to {number(max(loads), 2)}."
    return text + (f" Not in this build: {', '.join(absent)}." if absent else "")


def missing_text(results):
    absent = [name for name in ("extract", "simplify", "job", "scaling") if not suite(results, name)]
    return f"No results of: {', '.join(absent)}." if absent else ""


def failures(results):
    lines = {f"{volume_name(result)}, {row['left']:g} % left, {row['peer']['name']}: {failure(row)}"
             for result in results if "input" in result for row in result["rows"] if failure(row)}
    return "Failed:\n\n" + "\n".join(f"- {line}" for line in sorted(lines)) if lines else ""


def plots(results, folder):
    """Names of the files and what they show, by block."""
    folder.mkdir(parents=True, exist_ok=True)
    made = {
        "simplification": [
            (plot(result, folder), f"{what}, {volume_name(result)}")
            for result in suite(results, "simplify")
            for plot, what in ((plot_speed, "Speed ratios"), (plot_error, "Error against triangles left"))
        ],
        "job": [(plot_job_memory(results, folder), "Memory of the whole job")],
        "scaling": [(plot_scaling(result, folder), "Scaling") for result in suite(results, "scaling")],
    }
    return {block: [(name, text) for name, text in found if name] for block, found in made.items()}


def with_one_simplified(results):
    """Without the simplification of all volumes but the smallest: what people read through."""
    return [result for result in results if result not in suite(results, "simplify")[1:]]


def blocks(results, folder, link, detailed):
    """Every part of the report by its name. `detailed`: the results that are shown one by one."""
    made = plots(detailed, folder)
    images = {block: [image(link, name, text) for name, text in found] for block, found in made.items()}
    summaries = [summary_table(results, threads) for threads in (4, 1)] if suite(results, "simplify") else []
    parts = {
        "machine": [machine_text(results), missing_text(results), failures(results)],
        "goals": [goal_table(results)],
        "extraction": list(extraction_tables(results)),
        "simplification": summaries + images["simplification"] + list(simplification_tables(detailed)),
        "job": images["job"] + list(job_tables(results)),
        "scaling": images["scaling"] + list(scaling_tables(results)),
    }
    return {name: "\n\n".join(part for part in found if part) or "Not measured." for name, found in parts.items()}


def write_report(results, out):
    parts = blocks(results, out, "", results)
    text = "\n\n".join(f"## {name.capitalize()}\n\n{part}" for name, part in parts.items())
    (out / "report.md").write_text(f"# isoweave beside other libraries\n\n{text}\n")
    print(out / "report.md")


def rewrite_docs(results, path):
    parts = blocks(results, path.with_suffix(""), f"{path.stem}/", with_one_simplified(results))
    for png in path.with_suffix("").glob("*.png"):
        png.unlink()
    text = path.read_text()
    for name, part in parts.items():
        pattern = re.compile(f"(<!-- begin {name} -->\n).*?(<!-- end {name} -->)", re.DOTALL)
        text, found = pattern.subn(lambda match: f"{match[1]}\n{part}\n\n{match[2]}", text)
        if not found:
            raise SystemExit(f"{path}: expected <!-- begin {name} --> and <!-- end {name} -->")
    path.write_text(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path, nargs="?")
    parser.add_argument("--docs", type=pathlib.Path)
    arguments = parser.parse_args()
    results = load(arguments.results)
    if not results:
        raise SystemExit(f"{arguments.results}: expected results as *.json, found none")
    if arguments.out is None and arguments.docs is None:
        parser.error("expected OUT or --docs FILE")
    if arguments.out:
        write_report(results, arguments.out)
    if arguments.docs:
        rewrite_docs(results, arguments.docs)


if __name__ == "__main__":
    main()
