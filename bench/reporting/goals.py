"""What is to be reached, and whether it is."""
from reporting.results import (
    FINE, UNKNOWN, added_bytes, equal_rows, is_ours, lefts, rows_of, samples, suite, thread_counts, volume_name,
)
from reporting.tables import number, table

FLOOR = "every sample read once"
FLYING_EDGES = "VTK flying edges, TBB"
MESHOPTIMIZER, SLABS = "meshoptimizer", "meshoptimizer in slabs"
BEST_PEER = "CGAL Lindstrom-Turk"
SLOW_PEERS = ("VTK quadric decimation", "CGAL Garland-Heckbert", BEST_PEER, "OpenMesh")
FAST_JOB, QUADRIC_JOB = "VTK flying edges + meshoptimizer", "VTK flying edges + quadric decimation"
LARGE = 155e6  # samples from which on the goal for memory holds
NEAR = 0.5  # share of the speed of reading that counts as near it


def worst(values, wanted):
    """The value nearest to failing, and how many reach it. `values`: (value, volume); `wanted`: (bound, direction)."""
    if not values:
        return "not measured", UNKNOWN
    bound, at_least = wanted
    value, volume = (min if at_least else max)(values)
    reached = sum(value >= bound if at_least else value <= bound for value, _ in values)
    text = f"{number(value)} (worst of {len(values)}: {volume})" if len(values) > 1 else f"{number(value)} ({volume})"
    return text, "yes" if reached == len(values) else f"{reached} of {len(values)}"


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
    """The leanest peer's memory in terms of ours, with the most threads measured."""
    found = []
    for result in suite(results, "job"):
        for left in lefts(result):
            rows = equal_rows(result, None, thread_counts(result)[-1], [left])
            rows = [row for row in rows if not is_ours(row["peer"]["name"])]
            if samples(result) >= LARGE and rows:
                leanest = min(added_bytes(row["peer"]) for row in rows)
                most = max(added_bytes(row["ours"]) for row in rows)
                found.append((leanest / most, f"{volume_name(result)}, {left:g} % left"))
    return found


def fine_rms_ratios(results):
    """RMS distance of `fine` in terms of the best peer's at the same count, where the best of them has run."""
    found = []
    for result in suite(results, "simplify"):
        for left in lefts(result):
            rows = equal_rows(result, None, thread_counts(result)[0], [left])
            peers = [row["peer"]["quality"]["rms"] for row in rows if not is_ours(row["peer"]["name"])]
            fine = [row["peer"]["quality"]["rms"] for row in rows if row["peer"]["name"] == FINE]
            best = any(row["peer"]["name"] == BEST_PEER for row in rows)
            if best and fine and left in (50, 20, 10, 5):
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
    lines = []
    for what, against, goal, values, wanted in goals(results):
        measured, reached = worst(values, wanted)
        lines.append([what, against, goal, measured, reached])
    return table(["", "against", "goal", "measured", "reached"], lines)
