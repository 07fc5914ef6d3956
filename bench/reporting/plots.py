"""Pictures."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

from reporting.results import (
    FINE, NORMAL, added_bytes, is_ours, lefts, names, rows_of, suite, thread_counts, volume_name,
)
from reporting.scaling import layer_count, medians, slab_text

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
