"""The part of the results that tables and plots are made from: medians, in one small file."""
import json
import statistics

DIGITS = 6
QUALITY = ("mean", "rms", "max", "nonmanifold_edges", "euler", "slivers")
SCALING_KEY = ("curve", "kind", "layers", "threads", "slab")


def rounded(value):
    return value if isinstance(value, int) else float(f"{value:.{DIGITS}g}")


def summarized_side(side):
    if "failure" in side or "seconds" not in side:
        return side
    kept = {name: side[name] for name in ("name", "threads", "triangles")}
    kept |= {"seconds": rounded(side["seconds"]), "added_bytes": side["peak_bytes"] - side["bytes_before"]}
    if "quality" in side:
        kept["quality"] = {name: rounded(side["quality"][name]) for name in QUALITY}
    return kept


def spread(ratios):
    """By how much of their median rounds are off it, typically. Nothing for one round, which tells nothing of it."""
    if len(ratios) < 2:
        return None
    median = statistics.median(ratios)
    return rounded(statistics.median(abs(ratio - median) for ratio in ratios) / median)


def summarized_row(row):
    kept = {name: row[name] for name in ("left", "threads")}
    if "ratio" in row:
        kept |= {"ratio": rounded(row["ratio"]), "rounds": len(row["ratios"]), "spread": spread(row["ratios"])}
    return kept | {side: summarized_side(row[side]) for side in ("ours", "peer")}


def summarized_scaling(rows):
    groups = {}
    for row in rows:
        groups.setdefault(tuple(row[name] for name in SCALING_KEY), []).append(row)
    return [
        dict(zip(SCALING_KEY, key)) | {
            "seconds": rounded(statistics.median(row["seconds"]["total"] for row in same)),
            "peak_bytes": round(statistics.median(row["peak_bytes"] for row in same)),
        }
        for key, same in groups.items()
    ]


def summarized(result):
    rows = result["rows"]
    kept = summarized_scaling(rows) if result["suite"] == "scaling" else [summarized_row(row) for row in rows]
    return result | {"rows": kept}


class SideTable:
    """Names and qualities once for all rows of a result, as most rows repeat them."""

    def __init__(self, names=(), qualities=()):
        self.names, self.qualities = list(names), [list(quality) for quality in qualities]

    @staticmethod
    def number(items, item):
        if item not in items:
            items.append(item)
        return items.index(item)

    def packed(self, side):
        if "added_bytes" not in side:
            return side
        quality = side.get("quality")
        place = self.number(self.qualities, [quality[name] for name in QUALITY]) if quality else None
        name = self.number(self.names, side["name"])
        return [name, side["threads"], side["triangles"], side["seconds"], side["added_bytes"], place]

    def unpacked(self, packed):
        if isinstance(packed, dict):
            return packed
        name, threads, triangles, seconds, added_bytes, place = packed
        side = {"name": self.names[name], "threads": threads, "triangles": triangles, "seconds": seconds,
                "added_bytes": added_bytes}
        return side if place is None else side | {"quality": dict(zip(QUALITY, self.qualities[place]))}


def lines(items):
    return "[\n" + ",\n".join(json.dumps(item, separators=(",", ":")) for item in items) + "\n]"


def packed_result(result):
    head = {name: value for name, value in result.items() if name != "rows"}
    if result["suite"] == "scaling":
        return json.dumps(head)[:-1] + f', "rows": {lines(result["rows"])}}}'
    table = SideTable()
    rows = [[row["left"], row["threads"], row.get("ratio"), row.get("rounds"), row.get("spread"),
             table.packed(row["ours"]), table.packed(row["peer"])] for row in result["rows"]]
    return (json.dumps(head)[:-1] + f', "names": {json.dumps(table.names)}, "qualities": {lines(table.qualities)}, '
            f'"rows": {lines(rows)}}}')


def place(result):
    """What a result is of. A later one of the same replaces it."""
    return result["suite"], result.get("input", {}).get("name"), result["machine"]["threads"]


def write_summary(results, path):
    """What the file has of other volumes, suites and numbers of processors stays."""
    kept = {place(result): result for result in (read_summary(path) if path.exists() else [])}
    kept |= {place(result): result for result in results}
    results = sorted(kept.values(), key=lambda result: [str(part) for part in place(result)])
    path.write_text("[\n" + ",\n".join(packed_result(result) for result in results) + "\n]\n")


def unpacked_result(packed):
    if packed["suite"] == "scaling":
        return packed
    table = SideTable(packed.pop("names"), packed.pop("qualities"))
    rows = []
    for left, threads, ratio, rounds, spread_of_rounds, ours, peer in packed["rows"]:
        row = {"left": left, "threads": threads}
        if ratio is not None:
            row |= {"ratio": ratio, "rounds": rounds, "spread": spread_of_rounds}
        rows.append(row | {"ours": table.unpacked(ours), "peer": table.unpacked(peer)})
    return packed | {"rows": rows}


def read_summary(path):
    return [unpacked_result(packed) for packed in json.loads(path.read_text())]
