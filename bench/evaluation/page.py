"""The tables of docs/evaluation.md, from results."""
from evaluation import growth, method_runs, published

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


def clusters(surfaces):
    """Previews, each beside isoweave at as many triangles."""
    lines = []
    for surface in surfaces:
        size = " x ".join(map(str, surface["dims"]))
        lines += [f"{surface['name']}, {size} samples, {surface['triangles']:,} triangles, {surface['components']:,} "
                  f"parts, Euler number {surface['euler']:,}:", ""]
        rows = []
        for of in surface["cells"]:
            for name, time in (("preview", f"{of['seconds per isoweave']:.2f}"), ("isoweave", "1")):
                shape = of[name]
                told = f"{of['plane_rms']:.4f}" if name == "preview" else "–"
                rows.append((f"`--preview={of['cell']}vox`" if name == "preview" else "isoweave, as many",
                             f"{shape['triangles']:,}", time, megabytes(shape["bytes"]), f"{shape['rms']:.4f}",
                             f"{shape['max']:.2f}", told, f"{shape['edges']:,}", f"{shape['components']:,}",
                             f"{shape['euler']:,}"))
        lines += [*table(("", "triangles", "time", "MB", "RMS", "largest distance", "`plane_rms`",
                          "non-manifold edges", "parts", "Euler number"), rows), ""]
    return lines[:-1]


def sizes(found):
    lines = []
    for name, rows in (("more layers", found["layers"]), ("larger cross-section", found["sections"]),
                       ("the largest", found["largest"])):
        for row in rows:
            lines.append((name, " x ".join(map(str, row["dims"])), f"{growth.samples_of(row) / 1e6:,.0f}",
                          str(row["rounds"]), f"{row['faces']:,}", f"{row['left']:,}", f"{row['seconds']:,.1f}",
                          f"{1e9 * row['seconds'] / growth.samples_of(row):.1f}", megabytes(row["bytes"]),
                          f"{row['held']:,}"))
    return table(("", "samples", "million", "rounds", "triangles extracted", "left", "processor seconds",
                  "ns per sample", "peak MB", "most undecided"), lines)


def slopes(found):
    time, memory = growth.of_time(found), growth.of_memory(found)
    errors = found["errors"]
    lengths = [float(row["options"].split()[1].removesuffix("vox")) for row in errors]
    per_sample, always = memory["line"]
    exponents = [("processor seconds", "samples, by layers", time["layers"][0]),
                 ("processor seconds", "samples, by cross-section", time["sections"][0]),
                 ("processor seconds", "samples, all runs", time["all"][0]),
                 ("peak memory", "layers", memory["layers"]),
                 ("peak memory", "samples of a slice", memory["sections"]),
                 ("triangles left", "error", growth.fit(lengths, [row["left"] for row in errors])[0]),
                 ("processor seconds", "error", growth.fit(lengths, [row["seconds"] for row in errors])[0]),
                 ("peak memory", "error", growth.fit(lengths, [row["bytes"] for row in errors])[0]),
                 ("triangles handed on by blocks", "side of the blocks", growth.of_blocks(found)[0])]
    lines = [(of, to, f"{slope:.3f}") for of, to, slope in exponents]
    return [*table(("what grows", "with", "exponent"), lines), "",
            f"Peak memory is {always / 1e6:.0f} MB and {per_sample:.1f} bytes for each sample of a slice."]


def errors(found):
    lines = [(row["options"].split()[1].replace("vox", " voxel"), f"{row['left']:,}", f"{row['seconds']:.2f}",
              megabytes(row["bytes"]), f"{row['held']:,}") for row in found["errors"]]
    return table(("error", "triangles left", "processor seconds", "peak MB", "most undecided"), lines)


def threads(found):
    lines = [(str(row["threads"]), f"{row['seconds per one']:.2f}", f"{row['clock per one']:.2f}",
              megabytes(row["bytes"])) for row in found["threads"]]
    same = "the same" if len({row["digest"] for row in found["threads"]}) == 1 else "DIFFERENT"
    return [*table(("threads", "processor seconds, per one thread's", "by the clock", "peak MB"), lines), "",
            f"The digests are {same}."]


def blocks(found):
    slabs = found["blocks"][0]
    lines = []
    for row in found["blocks"][1:]:
        handed = growth.handed_on(row)
        in_all = growth.handed_in_all(row)
        lines.append((str(row["blocks"][0]["size"]), ", ".join(f"{100 * part:.2g}" for part in handed) + " %",
                      f"{row['seconds'] / slabs['seconds']:.2f}", f"{100 * in_all:.0f} %",
                      f"{100 * growth.efficiency(in_all):.0f} %",
                      "the same" if row["digest"] == slabs["digest"] else "DIFFERENT"))
    return table(("cells along a block", "handed on to stages 1, 2, ...", "processor seconds, per those of slabs",
                  "in all, volume without end", "efficiency by the model", "digest"), lines)


def duration(seconds):
    for size, unit in ((86400, "days"), (3600, "hours"), (60, "minutes")):
        if seconds >= 2 * size:
            return f"{seconds / size:.1f} {unit}"
    return f"{seconds:.0f} s"


def prediction(found):
    told = growth.prediction(found)
    rows = [("one thread, slabs", f"{growth.SIDE:,}", "–", "–", duration(told["seconds"]),
             f"{told['bytes'] / 1e9:.1f} GB")]
    for of in told["ranks"]:
        rows.append((f"{of['ranks']:,} ranks of one thread", f"{of['side']:,.0f}", f"{100 * of['handed']:.1f} %",
                     f"{100 * of['efficiency']:.0f} %", duration(of["seconds"]), f"{of['bytes'] / 1e9:.2f} GB"))
    return table(("", "cells along a block", "handed on", "efficiency", "time", "memory of a rank"), rows)


def triangles_of(name):
    def lines(pictures):
        return [", ".join(f"`{method}` {count:,}" for method, count in pictures[name].items()) + " triangles."]

    return lines


# The blocks of the page: the part of the results that each is made of, and how.
BLOCKS = {"volumes": ("tables", volumes), "crossed": ("tables", crossed), "left": ("tables", left),
          "methods": ("methods", methods), "beside": ("methods", beside), "middle": ("methods", middle),
          "clusters": ("clusters", clusters), "sizes": ("growth", sizes), "slopes": ("growth", slopes),
          "errors": ("growth", errors), "threads": ("growth", threads), "blocks": ("growth", blocks),
          "prediction": ("growth", prediction),
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
