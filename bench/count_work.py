#!/usr/bin/env python3
"""Counts and times for bench/work.

  bench/count_work.py BUILD MESH FOLDER    FOLDER: for files that are needed meanwhile
"""
import json
import os
import re
import statistics
import subprocess
import sys
import time

ERROR = "0.2235"  # mm: leaves 20 % of the triangles
CACHES = ["--D1=49152,12,64", "--LL=2097152,16,64"]
EVENTS = ["Ir", "DLmr", "DLmw", "Bcm"]
REPETITIONS = 5

QUADRICS = r"Zone::settle_vertices"
KEYS = r"Zone::settle_edges"
DECISIONS = r"LocalMinima::Worker::serve_all"

# Steps of a run: the functions that they are, with all that these call, and those of them that are steps of their own.
STEPS = [
    ("pieces of the mesh", [r"MeshSurface::MeshSurface", r"MeshSurface::make", r"mean_triangle_area"], []),
    ("half-edges, first quadrics of closed fans", [r"Zone::append"], [QUADRICS]),
    ("other first quadrics", [QUADRICS], []),
    ("first keys", [KEYS], []),
    ("first turns", [r"Executor::for_blocks<Executor::for_each<LocalMinima::run"], [KEYS, DECISIONS]),
    ("decisions", [DECISIONS], []),
    ("final triangles out, zone closed up", [r"FinalOutput::take"], []),
]


def output_of(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def functions(profile):
    """(name, events) of every function with all that it calls."""
    text = output_of("callgrind_annotate", "--inclusive=yes", "--threshold=100", "--show=" + ",".join(EVENTS), profile)
    count = r"([\d,]+|\.) *(?:\( *[\d.]+%\))? +"
    line = re.compile(r"^ *" + count * len(EVENTS) + r" *\S*?:(.*?)(?: \[.*\])?$")
    for match in filter(None, map(line.match, text.splitlines())):
        events = [0 if n == "." else int(n.replace(",", "")) for n in match.groups()[:-1]]
        yield match.groups()[-1].replace("isoweave::", ""), events


def events_of(profile, names):
    """Sum over the first function that each of the names begins."""
    sums = [0] * len(EVENTS)
    for name in names:
        found = next((events for function, events in profile if re.match(name, function)), None)
        if found is None:
            sys.exit(f"{name}: expected a function of that name in the profile, found none")
        sums = [a + b for a, b in zip(sums, found)]
    return sums


def row(label, events, collapses):
    instructions, reads, writes, branches = (n / collapses for n in events)
    return f"| {label} | {instructions:,.0f} | {reads + writes:.1f} | {branches:.1f} |"


def count(build, mesh, folder):
    profile = os.path.join(folder, "profile")
    printed = output_of("valgrind", "--quiet", "--tool=callgrind", "--branch-sim=yes", "--cache-sim=yes", *CACHES,
                        "--callgrind-out-file=" + profile, os.path.join(build, "bench_work"), mesh, ERROR)
    collapses = {name: int(number) for name, number in (line.split() for line in printed.splitlines())}
    profile = list(functions(profile))
    ours = events_of(profile, [r"simplify_mesh\(TriangleMesh const&, MeshSink&"])
    theirs = events_of(profile, [r"meshopt_simplify"])
    print("| per collapse | instructions | lines from beyond 2 MiB | mispredicted branches |\n|---|---|---|---|")
    print(row("**isoweave**", ours, collapses["isoweave"]))
    rest = ours
    for label, names, others in STEPS:
        events = [a - b for a, b in zip(events_of(profile, names), events_of(profile, others))]
        rest = [a - b for a, b in zip(rest, events)]
        print(row(label, events, collapses["isoweave"]))
    print(row("the rest", rest, collapses["isoweave"]))
    print(row("**meshoptimizer**", theirs, collapses["meshoptimizer"]))


def decide(build, mesh, folder):
    """How often an edge is looked at until it collapses, by quality."""
    print("\n| decisions per collapse | `fast` | `normal` | `fine` |\n|---|---|---|---|")
    shares = []
    for quality in ("fast", "normal", "fine"):
        report = os.path.join(folder, "report.json")
        output_of(os.path.join(build, "isoweave"), "simplify", mesh, "-o", os.path.join(folder, "m.ply"), "--error",
                  ERROR, "--quality", quality, "--quiet", "--report", report)
        with open(report, encoding="utf-8") as file:
            counts = json.load(file)
        shares.append(sum(counts[key] for key in ("collapses", "postponed", "rekeyed")) / counts["collapses"])
    print("| | " + " | ".join(f"{share:.2f}" for share in shares) + " |")


def seconds(build, mesh, folder, copies, threads):
    """By the clock, of one of the runs that begin together."""
    begin = time.monotonic()
    runs = [subprocess.Popen([os.path.join(build, "isoweave"), "simplify", mesh, "-o", f"{folder}/{n}.ply", "--error",
                              ERROR, "--threads", str(threads), "--quiet"]) for n in range(copies)]
    ends = []
    for run in runs:
        if run.wait() != 0:
            sys.exit("isoweave failed")
        ends.append(time.monotonic())
    return statistics.mean(ends) - begin


def clock(build, mesh, folder):
    most = os.cpu_count()
    rounds = [[seconds(build, mesh, folder, 1, 1), seconds(build, mesh, folder, most, 1),
               seconds(build, mesh, folder, 1, most)] for _ in range(REPETITIONS)]
    beside = statistics.median(most * alone / together for alone, together, _ in rounds)
    threads = statistics.median(alone / threaded for alone, _, threaded in rounds)
    print(f"\n| times the work of one thread | |\n|---|---|\n| {most} runs of one thread side by side | {beside:.2f} |")
    print(f"| one run of {most} threads | {threads:.2f} |")


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    count(*sys.argv[1:])
    decide(*sys.argv[1:])
    clock(*sys.argv[1:])


if __name__ == "__main__":
    main()
