"""How time and memory grow."""
import statistics

from reporting.results import suite
from reporting.tables import megabytes, number, table, times


def medians(rows, curve, kind, key, value=lambda row: row["seconds"]):
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
