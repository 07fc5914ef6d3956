"""Tables in Markdown."""
import statistics

from reporting.results import (
    UNKNOWN, added_bytes, failure, is_at_count, lefts, names, rows_of, samples, suite, thread_counts,
)


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
