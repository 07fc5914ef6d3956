#!/usr/bin/python3
"""Tables and plots from the results of bench/run; needs python3-matplotlib for plots.

  bench/report.py RESULTS OUT            OUT/report.md, with every table, and OUT/*.svg, *.png
  bench/report.py RESULTS --docs FILE    rewrites what lies in FILE between the lines <!-- begin NAME --> and
                                         <!-- end NAME -->; plots that it names go to the folder named as FILE without
                                         its ending
  bench/report.py RESULTS --summary FILE puts what all of these need of the results, medians, in one small file;
                                         what it has of other volumes, suites and numbers of processors stays
  bench/report.py RESULTS --changes FILE prints a line for each goal: its figure in FILE, such a summary, and in
                                         RESULTS, whether the change is more than noise, and whether the goal is met

RESULTS: the folder that bench/run leaves, or such a summary.
"""
import argparse
import pathlib
import re

from reporting.changes import change_lines
from reporting.goals import goal_table
from reporting.questions import (
    fullest, growth_tables, job_memory_table, job_time_table, peers_table, quality_table, simplification_time_table,
)
from reporting.results import failure, load, machines, on_machine, suite, thread_counts, volume_name
from reporting.scaling import scaling_tables
from reporting.summary import write_summary
from reporting.tables import extraction_tables, job_tables, number, simplification_tables, summary_table


def paragraphs(parts):
    return "\n\n".join(part for part in parts if part) or "Not measured."


def machine_text(results):
    found = sorted({result["machine"]["processor"] for result in results})
    rounds = [row["rounds"] for result in results for row in result.get("rows", []) if "rounds" in row]
    loads = [result["machine"]["load"] for result in results if "load" in result["machine"]]
    absent = sorted({name for result in results for name in result.get("absent", [])})
    text = f"{machines(results)[0]} processors: {'; '.join(found)}."
    if rounds:
        text += f" Rounds of a pair: {min(rounds)} to {max(rounds)}."
    if loads:
        text += f" Load when the suites began: {number(min(loads), 2)} to {number(max(loads), 2)}."
    return text + (f" Not in this build: {', '.join(absent)}." if absent else "")


def machine_texts(results):
    return paragraphs([*(machine_text(on_machine(results, at)) for at in machines(results)), failures(results)])


def failures(results):
    lines = {f"{volume_name(result)}, {row['left']:g} % left, {row['peer']['name']}: {failure(row)}"
             for result in results if "input" in result for row in result["rows"] if failure(row)}
    return "Failed:\n\n" + "\n".join(f"- {line}" for line in sorted(lines)) if lines else ""


def plots(results, folder, shown=None):
    """Markdown of the plots that are made. `shown`: the volumes with plots of their own, all where not given."""
    from reporting.plots import plot_error, plot_job_memory, plot_scaling, plot_speed  # needs matplotlib

    folder.mkdir(parents=True, exist_ok=True)
    pictured = [result for result in suite(results, "simplify") if shown is None or volume_name(result) in shown]
    made = [plot(result, folder) for result in fullest(pictured) for plot in (plot_speed, plot_error)]
    made += [plot_job_memory(results, folder), *(plot_scaling(result, folder) for result in suite(results, "scaling"))]
    return [f"![{name}]({name}.svg)" for name in made if name]


def summaries(results):
    counts = {count for result in suite(results, "simplify") for count in thread_counts(result)}
    return [summary_table(results, threads) for threads in sorted(counts, reverse=True)]


def blocks(results):
    """Every table of the page by its name."""
    parts = {
        "times": job_time_table(results),
        "memory": job_memory_table(results),
        "quality": quality_table(results),
        "growth": growth_tables(results),
        "goals": goal_table(results),
        "machine": machine_texts(results),
    }
    for at in machines(results):
        parts[f"simplification on {at}"] = simplification_time_table(on_machine(results, at))
        parts[f"peers on {at}"] = peers_table(on_machine(results, at))
    return parts


def every_table(results):
    return paragraphs([machine_text(results), *summaries(results), *extraction_tables(results),
                       *simplification_tables(results), *job_tables(results), *scaling_tables(results)])


def write_report(results, out):
    pictures = paragraphs(plots(results, out))
    parts = [f"## On {at} processors\n\n{every_table(on_machine(results, at))}" for at in machines(results)]
    text = "\n\n".join([f"## Goals\n\n{goal_table(results)}", *parts, pictures, failures(results)]).strip()
    (out / "report.md").write_text(f"# isoweave beside other libraries\n\n{text}\n")
    print(out / "report.md")


def with_blocks(text, parts):
    """The text with each of its blocks made anew."""
    def block(match):
        if match[2] not in parts:
            raise SystemExit(f"<!-- begin {match[2]} -->: expected one of {', '.join(sorted(parts))}")
        return f"{match[1]}\n{parts[match[2]]}\n\n{match[3]}"
    made, found = re.subn(r"(<!-- begin ([^>]*) -->\n).*?(<!-- end \2 -->)", block, text, flags=re.DOTALL)
    if found != text.count("<!-- begin "):
        raise SystemExit(f"expected an <!-- end NAME --> for each <!-- begin NAME -->, found {found}")
    return made


def rewrite_docs(results, path):
    text = with_blocks(path.read_text(), blocks(results))
    path.write_text(text)
    folder = path.with_suffix("")
    plots(results, folder, ["skull"])  # which everybody can get
    for picture in [*folder.glob("*.png"), *folder.glob("*.svg")]:
        if picture.name not in text:
            picture.unlink()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path, nargs="?")
    for name in ("--docs", "--summary", "--changes"):
        parser.add_argument(name, type=pathlib.Path, metavar="FILE")
    arguments = parser.parse_args()
    results = load(arguments.results)
    if not results:
        raise SystemExit(f"{arguments.results}: expected results as *.json, found none")
    if not any((arguments.out, arguments.docs, arguments.summary, arguments.changes)):
        parser.error("expected OUT, --docs FILE, --summary FILE or --changes FILE")
    if arguments.summary:
        write_summary(results, arguments.summary)
    if arguments.out:
        write_report(results, arguments.out)
    if arguments.docs:
        rewrite_docs(results, arguments.docs)
    if arguments.changes:
        print("\n".join(change_lines(load(arguments.changes), results)))


if __name__ == "__main__":
    main()
