"""What is to be reached, and whether it is."""
import statistics
from dataclasses import dataclass
from typing import Callable

from reporting.results import (
    FINE, UNKNOWN, added_bytes, equal_rows, is_ours, lefts, machines, on_machine, rows_of, samples, suite,
    thread_counts, volume_name,
)
from reporting.tables import number, table

FLOOR = "every sample read once"
FLYING_EDGES = "VTK flying edges, TBB"
MESHOPTIMIZER, SLABS = "meshoptimizer", "meshoptimizer in slabs"
BEST_PEER = "CGAL Lindstrom-Turk"
SLOW_PEERS = ("VTK quadric decimation", "CGAL Garland-Heckbert", BEST_PEER, "OpenMesh")
FAST_JOB, QUADRIC_JOB = "VTK flying edges + meshoptimizer", "VTK flying edges + quadric decimation"
TO_NUMBER = "isoweave normal, to a number"
LARGE = 155e6  # samples from which on the goal for memory holds
MILLION = 1_000_000  # triangles from which on the goal for one thread holds


@dataclass(frozen=True)
class Case:
    """A measured value, what it is of, and by how much of itself it is uncertain; nothing where that is not known."""
    value: float
    name: str
    noise: float | None = None


@dataclass(frozen=True)
class Goal:
    """`bound`: the same for all machines, or by their number of processors; without one, a machine has no such goal.
    `cases`: makes the cases from the results of one machine. `middle`: their median counts, not the worst of them."""
    what: str
    against: str
    unit: str
    at_least: bool
    bound: float | dict[int, float]
    cases: Callable[[list], list[Case]]
    middle: bool = False

    def bound_on(self, processors):
        return self.bound.get(processors) if isinstance(self.bound, dict) else self.bound

    def is_met(self, value, processors):
        bound = self.bound_on(processors)
        return value >= bound if self.at_least else value <= bound

    def figure(self, cases):
        """What is held against the bound."""
        if not self.middle:
            return (min if self.at_least else max)(cases, key=lambda case: case.value)
        spreads = [case.noise for case in cases]
        noise = None if None in spreads else statistics.median(spreads)
        return Case(statistics.median(case.value for case in cases), "median", noise)

    def name(self):
        return f"{self.what}, beside {self.against}" if self.against else self.what

    def text(self):
        """The bound as people read it."""
        if isinstance(self.bound, dict):
            values = ", ".join(f"{bound:g}{self.unit} on {processors}" for processors, bound in self.bound.items())
        else:
            values = f"{self.bound:g}{self.unit}"
        return f"at {'least' if self.at_least else 'most'} {values}"


def most_threads(result):
    return thread_counts(result)[-1]


def ratio_case(result, row, told):
    """`told`: what tells the row from others of the goal: its peer, share left, or number of threads."""
    words = {"peer": row["peer"]["name"], "left": f"{row['left']:g} % left", "threads": f"{row['threads']} thr."}
    return Case(row["ratio"], ", ".join([volume_name(result), *(words[name] for name in told)]), row["spread"])


def ratios_to(name, peers, left=None, threads=None, least_triangles=0):
    """Of a suite; `threads`: all that the machine has, where no number is given."""
    def cases(results):
        return [
            ratio_case(result, row, ["peer", "left"] if len(peers) > 1 else ["left"])
            for result in suite(results, name)
            if result["full"]["triangles"] >= least_triangles
            for peer in peers
            for row in equal_rows(result, peer, threads or most_threads(result), left)
        ]
    return cases


def extraction_ratios(results):
    return [
        ratio_case(result, row, ["threads"])
        for result in suite(results, "extract")
        for row in rows_of(result, FLYING_EDGES)
    ]


def label_like_ratios(results):
    """Speed of extraction as a share of the speed of reading, where there is less than a triangle for 50 samples."""
    return [
        ratio_case(result, row, ["threads"])
        for result in suite(results, "extract")
        for row in rows_of(result, FLOOR)
        if row["ours"]["triangles"] < samples(result) / 50
    ]


def rms_ratios(results):
    return [
        Case(row["ours"]["quality"]["rms"] / row["peer"]["quality"]["rms"],
             f"{volume_name(result)}, {row['left']:g} % left")
        for result in suite(results, "simplify")
        for row in equal_rows(result, MESHOPTIMIZER, thread_counts(result)[0], [20, 5])
    ]


def nonmanifold_edges(results):
    return [
        Case(max(row["ours"]["quality"]["nonmanifold_edges"] for row in rows), volume_name(result))
        for result in suite(results, "simplify")
        if (rows := rows_of(result))
    ]


def memory_ratios(results):
    """The leanest peer's memory in terms of ours, with the most threads measured."""
    found = []
    for result in suite(results, "job"):
        for left in lefts(result):
            rows = equal_rows(result, None, most_threads(result), [left])
            rows = [row for row in rows if not is_ours(row["peer"]["name"])]
            if samples(result) >= LARGE and rows:
                leanest = min(added_bytes(row["peer"]) for row in rows)
                most = max(added_bytes(row["ours"]) for row in rows)
                found.append(Case(leanest / most, f"{volume_name(result)}, {left:g} % left"))
    return found


def noise_megabytes(results):
    return [
        Case(max(added_bytes(row["ours"]) for row in rows) / 1e6, f"noise-50M, {left:g} % left")
        for result in suite(results, "job")
        if volume_name(result) == "noise-50M"
        for left in lefts(result)
        if (rows := rows_of(result, None, most_threads(result), [left]))
    ]


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
                found.append(Case(fine[0] / min(peers), f"{volume_name(result)}, {left:g} % left"))
    return found


def times_of(variant):
    """Those of another way to run isoweave in terms of `normal` to an error, with any number of threads."""
    def cases(results):
        return [
            ratio_case(result, row, ["left", "threads"])
            for result in suite(results, "simplify")
            for row in rows_of(result, variant)
        ]
    return cases


GOALS = [
    Goal("extraction, same threads", "VTK flying edges (TBB)", "×", True, 2, extraction_ratios),
    Goal("extraction, label-like volumes", "reading every sample once", "×", True, 0.5, label_like_ratios),
    Goal("simplification, 1 thread, 20 % left, a million triangles or more", MESHOPTIMIZER, "×", True, 1,
         ratios_to("simplify", [MESHOPTIMIZER], [20], 1, MILLION)),
    Goal("simplification, all threads, 20 to 5 % left", MESHOPTIMIZER, "×", True, {2: 1.9, 4: 4},
         ratios_to("simplify", [MESHOPTIMIZER], [20, 10, 5])),
    Goal("simplification, all threads, 10 % left", SLABS, "×", True, {2: 1, 4: 1.25},
         ratios_to("simplify", [SLABS], [10])),
    Goal("simplification, all threads", "VTK quadric, CGAL, OpenMesh", "×", True, {4: 40},
         ratios_to("simplify", SLOW_PEERS)),
    Goal("RMS distance, 20 and 5 % left", MESHOPTIMIZER, " of theirs", False, 0.7, rms_ratios),
    Goal("non-manifold edges", "", "", False, 0, nonmanifold_edges),
    Goal("whole job, all threads", "flying edges + meshoptimizer", "×", True, {4: 3.5}, ratios_to("job", [FAST_JOB])),
    Goal("whole job, all threads", "flying edges + VTK quadric", "×", True, {4: 30}, ratios_to("job", [QUADRIC_JOB])),
    Goal("less memory, whole job, 155 M samples or more", "the leanest peer", "×", True, 5, memory_ratios),
    Goal("memory, whole job, noise-50M", "", " MB", False, 900, noise_megabytes),
    Goal("time to a number of triangles, worst", "the run to the error", "×", False, 1.3, times_of(TO_NUMBER)),
    Goal("time to a number of triangles, middle", "the run to the error", "×", False, 1.15, times_of(TO_NUMBER), True),
    Goal("RMS distance of `fine`, 50 to 5 % left", "the best peer", " of theirs", False, 1, fine_rms_ratios),
    Goal("time of `fine`, worst", "`normal`", "×", False, 2, times_of(FINE)),
    Goal("time of `fine`, middle", "`normal`", "×", False, 1.7, times_of(FINE), True),
]


def measured_text(goal, results, processors):
    """What one machine has given, and whether it is good enough."""
    cases = goal.cases(results) if goal.bound_on(processors) is not None else []
    if not cases:
        return UNKNOWN
    figure = goal.figure(cases)
    reached = sum(goal.is_met(case.value, processors) for case in cases)
    verdict = "**met**" if goal.is_met(figure.value, processors) else "missed"
    return f"{verdict}: {number(figure.value)} ({figure.name}; {reached} of {len(cases)} reach it)"


def goal_table(results):
    """The goals that a machine has of which there are results."""
    found = machines(results)
    lines = [
        [goal.what, goal.against or UNKNOWN, goal.text(),
         *(measured_text(goal, on_machine(results, at), at) for at in found)]
        for goal in GOALS
        if any(goal.bound_on(at) is not None for at in found)
    ]
    return table(["", "beside", "goal", *(f"{at} processors" for at in found)], lines)
