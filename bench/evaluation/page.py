"""The tables of docs/evaluation.md, from results."""
from evaluation import method_runs, published

MEGABYTE = 1e6


def table(head, rows):
    """A table in Markdown: the first column is text, the others are numbers."""
    return [f"| {' | '.join(head)} |", f"|---|{'---:|' * (len(head) - 1)}", *(f"| {' | '.join(row)} |" for row in rows)]


def megabytes(count):
    return f"{count / MEGABYTE:,.0f}"


def pairs(rows):
    """The paper's rows beside ours."""
    by_name = {row["name"]: row for row in rows}
    return [(row, by_name[row.name]) for row in published.ROWS]


def volumes(rows):
    of_model = {}
    for row, ours in pairs(rows):
        of_model.setdefault(row.model, []).append((row, ours))
    lines = []
    for model, of in of_model.items():
        dims, size = published.MODELS[model]
        sources = dict.fromkeys(ours["source"] for _, ours in of)
        lines.append((model, " x ".join(map(str, dims)), f"{size:.3f}", " x ".join(map(str, of[0][1]["dims"])),
                      "; ".join(sources)))
    return table(("model", "samples", "MB", "stand-in, the last axis swept", "source"), lines)


def crossed(rows):
    lines = [(row.name, f"{row.percent:.2f} %", f"{row.crossed:,}", f"{row.faces:,}", f"{ours['iso']:g}",
              f"{ours['crossed']:,}", f"{100 * (ours['crossed'] / row.crossed - 1):+.2f} %", f"{ours['faces']:,}")
             for row, ours in pairs(rows)]
    return table(("surface", "crossed cells, paper", "number", "faces", "stand-in: iso-value", "crossed cells",
                  "difference", "faces"), lines)


def left(rows):
    lines = []
    for row, ours in pairs(rows):
        memory = [f"{megabytes(ours['memory'][name])} MB" for name in ("12 layers", "automatic", "queue")]
        same = "the same" if len(set(ours["digests"].values())) == 1 else "DIFFERENT"
        lines.append((row.name, f"{row.extraction:.2f} s", f"{row.simplification:.2f} s", f"{row.left:,}",
                      f"{row.memory:.0f} MB", f"{100 * row.ratio:.1f} %", f"{ours['left']:,}", f"{ours['error']:.2g}",
                      *memory, f"{ours['queue per 12 layers']:.2f}", f"{len(ours['digests'])}: {same}"))
    return table(("surface", "paper: extraction", "simplification", "faces left", "memory", "part left",
                  "ours: faces left", "error, voxels", "12 layers", "automatic", "queue", "queue's time", "digests"),
                 lines)


def decimals(number, digits):
    return "–" if number is None else f"{number:.{digits}f}"


def extra_bias(of, method):
    """The bias along the sweep less that of the reference."""
    return f"{of[method]['bias'][2] - of['queue']['bias'][2]:+.3f}" if method in of else "–"


def methods_of(of):
    """The table of a surface at an error."""
    axes = of["axes"]
    reference = axes["z"]["queue"]
    lines = []
    for method, counts in axes["z"].items():
        distance, triangles = method_runs.at_equal(of["curve"], counts)
        extra = [extra_bias(axes[axis], method) for axis in axes]
        lines.append((f"`{method}`", f"{counts['triangles']:,}", f"{counts['rms']:.4f}", decimals(distance, 4),
                      "–" if triangles is None else f"{triangles:,.0f}", *extra,
                      f"{counts['comb']:.3f} ({counts['reference comb']:.3f})", f"{counts['angle']:.1f}°",
                      f"{counts['most_held'] / reference['triangles_extracted']:.3f}"))
    return table(("method", "triangles", "RMS", "isoweave's RMS at as many", "isoweave's triangles at that RMS",
                  *(f"bias along {axis}" for axis in axes), "comb (reference)", "mean smallest angle", "held"), lines)


def methods(surfaces):
    lines = []
    for surface in surfaces:
        size = " x ".join(map(str, surface["dims"]))
        for error, of in surface["errors"].items():
            raw = of["axes"]["z"]["queue"]["triangles_extracted"]
            head = f"{surface['name']}, {size} samples, {raw:,} triangles, error {error} voxel:"
            lines += [head, "", *methods_of(of), ""]
    return lines[:-1]


def ratios(counts, reference):
    return [f"{count / of:.2f}" if of else "–" for count, of in zip(counts, reference)]


def beside(surfaces):
    """The density beside frozen fronts, in terms of the reference's in the same places."""
    method = f"frozen:{method_runs.PERIOD}"
    lines = []
    for surface in surfaces:
        for error, of in surface["errors"].items():
            of = of["axes"]["z"]
            for name in ("isoweave:12", method):
                lines.append((f"{surface['name']}, {error} voxel, `{name}`",
                              *ratios(of[name]["beside"], of["queue"]["beside"])))
    bins = range(method_runs.PERIOD // 2)
    return table(("layers to the nearest front", *(f"{low}–{low + 1}" for low in bins)), lines)


def middle(surfaces):
    """The density below the front of a sweep that is half done, in terms of the complete mesh in the same places."""
    bounds = method_runs.DISTANCES
    lines = []
    for surface in surfaces:
        for error, of in surface["errors"].items():
            counts = of["middle"]
            for name in counts:
                if ":" in name:
                    of_name = ratios(counts[name], counts["queue"])
                    lines.append((f"{surface['name']}, {error} voxel, `{name}`", *of_name))
    head = ("layers below the front", *(f"{low}–{high}" for low, high in zip(bounds, bounds[1:])))
    return table(head, lines)


def triangles_of(name):
    def lines(pictures):
        return [", ".join(f"`{method}` {count:,}" for method, count in pictures[name].items()) + " triangles."]

    return lines


# The blocks of the page: the part of the results that each is made of, and how.
BLOCKS = {"volumes": ("tables", volumes), "crossed": ("tables", crossed), "left": ("tables", left),
          "methods": ("methods", methods), "beside": ("methods", beside), "middle": ("methods", middle),
          "regions": ("pictures", triangles_of("methods")), "halves": ("pictures", triangles_of("half"))}


def rewrite(page, results):
    """Writes the tables of a page between their marks."""
    text = page.read_text()
    for name, (part, lines_of) in BLOCKS.items():
        if part not in results:
            continue
        begin, end = f"<!-- begin {name} -->\n", f"<!-- end {name} -->"
        before, rest = text.split(begin)
        text = before + begin + "\n".join(lines_of(results[part])) + "\n" + rest[rest.index(end) :]
    page.write_text(text)
