"""The tables of the page: one for each question that a user asks."""
from reporting.goals import BEST_PEER, FAST_JOB, FLOOR, MESHOPTIMIZER, QUADRIC_JOB, SLABS, most_threads
from reporting.results import (
    FINE, UNKNOWN, added_bytes, equal_rows, is_ours, names, rows_of, samples, suite, thread_counts, volume_name,
)
from reporting.scaling import layer_count, medians
from reporting.tables import counted, megabytes, median_side, number, range_text, table, times

SHARE = 10  # per cent of the triangles that are left: the middle one of those measured
SLABS_JOB = "VTK flying edges + meshoptimizer in slabs"
JOB_PEERS = (FAST_JOB, SLABS_JOB, QUADRIC_JOB)
JOB_HEADS = ["flying edges + meshoptimizer", "flying edges + meshoptimizer in slabs", "flying edges + VTK quadric"]
QUADRIC = "VTK quadric decimation"
QUALITY_PEERS = (MESHOPTIMIZER, QUADRIC, BEST_PEER)
IN_JOB = {FAST_JOB: MESHOPTIMIZER, QUADRIC_JOB: QUADRIC}  # what simplifies in a job of two libraries


def millions(value):
    return number(value / 1e6)


def rows_at_share(result, threads):
    return {row["peer"]["name"]: row for row in rows_of(result, None, threads, [SHARE])}


def measured(results, name):
    """The results of a suite that have the share."""
    return [result for result in suite(results, name) if rows_at_share(result, most_threads(result))]


def shared_cells(result):
    return [volume_name(result), millions(samples(result)), millions(result["full"]["triangles"])]


def timed_cell(row):
    return f"{number(row['peer']['seconds'])} s, {times(row['ratio'])}" if row else UNKNOWN


def job_time_table(results):
    lines = []
    for result in measured(results, "job"):
        threads = most_threads(result)
        rows = rows_at_share(result, threads)
        ours = median_side(list(rows.values()), threads)
        lines.append([*shared_cells(result), threads, f"{number(ours['seconds'])} s",
                      *(timed_cell(rows.get(peer)) for peer in JOB_PEERS)])
    return table(["volume", "M samples", "M triangles", "threads", "isoweave", *JOB_HEADS], lines)


def job_memory_table(results):
    lines = []
    for result in measured(results, "job"):
        rows = rows_at_share(result, most_threads(result))
        ours = median_side(list(rows.values()), most_threads(result))
        sides = [ours, *(rows[peer]["peer"] if peer in rows else None for peer in JOB_PEERS)]
        lines.append([*shared_cells(result), *(megabytes(added_bytes(side)) if side else UNKNOWN for side in sides)])
    return table(["MB", "M samples", "M triangles", "isoweave", *JOB_HEADS], lines)


def simplification_time_table(results):
    """Beside the fastest peers."""
    lines, heads = [], []
    for result in measured(results, "simplify"):
        cells, heads = [], []
        for threads in thread_counts(result):
            rows = rows_at_share(result, threads)
            ours = median_side(list(rows.values()), threads)
            cells += [f"{number(ours['seconds'])} s", *(times(rows[peer]["ratio"]) for peer in (MESHOPTIMIZER, SLABS))]
            heads += [f"isoweave, {threads} thr.", MESHOPTIMIZER, "in slabs"]
        lines.append([volume_name(result), millions(result["full"]["triangles"]), *cells])
    return table(["volume", "M triangles", *heads], lines)


def quality_sides(result):
    """The meshes of the contestants, by the names of what simplifies in them; ours first."""
    rows = rows_at_share(result, most_threads(result))
    found = {"isoweave": next(iter(rows.values()))["ours"]}
    return found | {IN_JOB.get(name, name): row["peer"] for name, row in rows.items()}


def fullest(results):
    """Of each volume the result with the most peers, of simplification where there is one."""
    found = {}
    for result in sorted(results, key=lambda each: (each["suite"] == "simplify", len(names(each["rows"])))):
        found[volume_name(result)] = result
    return sorted(found.values(), key=samples)


def quality_table(results):
    lines = []
    for result in fullest(measured(results, "job") + measured(results, "simplify")):
        sides = quality_sides(result)
        rms = [sides[name]["quality"]["rms"] if name in sides else None for name in ("isoweave", FINE, *QUALITY_PEERS)]
        edges = [sides[name]["quality"]["nonmanifold_edges"] if name in sides else None
                 for name in ("isoweave", *QUALITY_PEERS)]
        lines.append([volume_name(result), *map(number, rms), *map(counted, edges)])
    return table(["", "RMS: isoweave", "`fine`", *QUALITY_PEERS, "bad edges: isoweave", *QUALITY_PEERS], lines)


def peer_line(found, peer, share):
    """One contestant of a suite over all volumes, in terms of ours."""
    cells, last = [], []
    for pick in (0, -1):
        last = [row for result in found for row in equal_rows(result, peer, thread_counts(result)[pick], [share])]
        cells.append(range_text([row["ratio"] for row in last]))
    cells.append(range_text([added_bytes(row["peer"]) / added_bytes(row["ours"]) for row in last]))
    compared = [row for row in last if "quality" in row["peer"]]
    cells.append(range_text([row["peer"]["quality"]["rms"] / row["ours"]["quality"]["rms"] for row in compared]))
    cells.append(counted(max((row["peer"]["quality"]["nonmanifold_edges"] for row in compared), default=None)))
    return [peer, len(last), *cells]


def peers_table(results):
    lines = []
    for name, share in (("extract", 100), ("simplify", SHARE), ("job", SHARE)):
        found = suite(results, name)
        for peer in dict.fromkeys(peer for result in found for peer in names(result["rows"])):
            if peer != FLOOR and (name == "simplify" or not is_ours(peer)):
                lines.append(peer_line(found, peer, share))
    return table(["in terms of isoweave's", "volumes", "time, 1 thread", "time, all threads", "memory", "RMS",
                  "most bad edges"], lines)


def threads_table(rows):
    curves = {kind: medians(rows, "threads", kind, lambda row: row["threads"]) for kind in ("noise", "smooth")}
    lines = [[f"{kind}: times as fast", *(times(curve[0][1] / seconds) for _, seconds in curve)]
             for kind, curve in curves.items()]
    return table(["threads", *(str(count) for count, _ in curves["noise"])], lines)


def layers_table(rows):
    curves = {f"{kind}, s": (medians(rows, "layers", kind, layer_count), number) for kind in ("noise", "smooth")}
    for mode in ("open", "closed"):
        peaks = medians(rows, f"memory, {mode}", "smooth", layer_count, lambda row: row["peak_bytes"])
        curves[f"smooth, {mode}, MB"] = peaks, megabytes
    heads = sorted({at for curve, _ in curves.values() for at, _ in curve})
    lines = [[name, *(text(dict(curve).get(at)) if at in dict(curve) else UNKNOWN for at in heads)]
             for name, (curve, text) in curves.items()]
    return table(["layers", *map(str, heads)], lines)


def growth_tables(results):
    return "\n\n".join(part for result in suite(results, "scaling")
                       for part in (threads_table(result["rows"]), layers_table(result["rows"])))
