#!/usr/bin/python3
"""Tables and plots from the results of bench/run; needs python3-matplotlib.

  bench/report.py RESULTS OUT            OUT/report.md and OUT/*.svg, *.png
  bench/report.py RESULTS --docs FILE    rewrites what lies in FILE between the lines <!-- begin NAME --> and
                                         <!-- end NAME -->; plots go to the folder named as FILE without its ending
  bench/report.py RESULTS --docs FILE --block NAME
                                         rewrites only that part, with the ratios of simplification and the jobs
  bench/report.py RESULTS --summary FILE the part of the results that all of these need, medians, in one small file

RESULTS: the folder that bench/run leaves, or such a summary.
"""
import argparse
import pathlib
import re

from reporting.results import failure, load, suite, thread_counts, volume_name
from reporting.tables import extraction_tables, job_tables, number, simplification_tables, summary_table
from reporting.goals import goal_table
from reporting.scaling import scaling_tables
from reporting.summary import write_summary


def paragraphs(parts):
    return "\n\n".join(part for part in parts if part) or "Not measured."


def image(folder, name, text):
    return f"![{text}]({folder}{name}.svg)"


def machine_text(results):
    found = {(result["machine"]["processor"], result["machine"]["threads"]) for result in results}
    rounds = [row["rounds"] for result in results for row in result.get("rows", []) if "rounds" in row]
    loads = [result["machine"]["load"] for result in results if "load" in result["machine"]]
    absent = sorted({name for result in results for name in result.get("absent", [])})
    text = "; ".join(f"{processor}, {threads} threads" for processor, threads in sorted(found))
    text += f". Rounds of a pair: {min(rounds)} to {max(rounds)}." if rounds else "."
    if loads:
        text += f" Load when the suites began: {number(min(loads), 2)} to {number(max(loads), 2)}."
    return text + (f" Not in this build: {', '.join(absent)}." if absent else "")


def missing_text(results):
    absent = [name for name in ("extract", "simplify", "job", "scaling") if not suite(results, name)]
    return f"No results of: {', '.join(absent)}." if absent else ""


def failures(results):
    lines = {f"{volume_name(result)}, {row['left']:g} % left, {row['peer']['name']}: {failure(row)}"
             for result in results if "input" in result for row in result["rows"] if failure(row)}
    return "Failed:\n\n" + "\n".join(f"- {line}" for line in sorted(lines)) if lines else ""


def plots(results, folder):
    """Names of the files and what they show, by block."""
    from reporting.plots import plot_error, plot_job_memory, plot_scaling, plot_speed  # needs matplotlib

    folder.mkdir(parents=True, exist_ok=True)
    made = {
        "simplification": [
            (plot(result, folder), f"{what}, {volume_name(result)}")
            for result in suite(results, "simplify")
            for plot, what in ((plot_speed, "Speed ratios"), (plot_error, "Error against triangles left"))
        ],
        "job": [(plot_job_memory(results, folder), "Memory of the whole job")],
        "scaling": [(plot_scaling(result, folder), "Scaling") for result in suite(results, "scaling")],
    }
    return {block: [(name, text) for name, text in found if name] for block, found in made.items()}


def with_few_simplified(results):
    """What people read through: the simplification of the skull, which everybody can get, and of the largest surface."""
    found = suite(results, "simplify")
    shown = [result for result in found if volume_name(result) == "skull"] or found[:1]
    largest = max(found, key=lambda result: result["full"]["triangles"], default=None)
    return [result for result in results if result not in found or result in shown or result == largest]


def summaries(results):
    counts = {count for result in suite(results, "simplify") for count in thread_counts(result)}
    return [summary_table(results, threads) for threads in sorted(counts, reverse=True)]


def blocks(results, folder, link, detailed):
    """Every part of the report by its name. `detailed`: the results that are shown one by one."""
    made = plots(detailed, folder)
    images = {block: [image(link, name, text) for name, text in found] for block, found in made.items()}
    parts = {
        "machine": [machine_text(results), missing_text(results), failures(results)],
        "goals": [goal_table(results)],
        "extraction": list(extraction_tables(results)),
        "simplification": summaries(results) + images["simplification"] + list(simplification_tables(detailed)),
        "job": images["job"] + list(job_tables(results)),
        "scaling": images["scaling"] + list(scaling_tables(results)),
    }
    return {name: paragraphs(found) for name, found in parts.items()}


def write_report(results, out):
    parts = blocks(results, out, "", results)
    text = "\n\n".join(f"## {name.capitalize()}\n\n{part}" for name, part in parts.items())
    (out / "report.md").write_text(f"# isoweave beside other libraries\n\n{text}\n")
    print(out / "report.md")


def replace_blocks(path, parts):
    text = path.read_text()
    for name, part in parts.items():
        pattern = re.compile(f"(<!-- begin {name} -->\n).*?(<!-- end {name} -->)", re.DOTALL)
        text, found = pattern.subn(lambda match: f"{match[1]}\n{part}\n\n{match[2]}", text)
        if not found:
            raise SystemExit(f"{path}: expected <!-- begin {name} --> and <!-- end {name} -->")
    path.write_text(text)


def rewrite_docs(results, path):
    parts = blocks(results, path.with_suffix(""), f"{path.stem}/", with_few_simplified(results))
    for png in path.with_suffix("").glob("*.png"):
        png.unlink()
    replace_blocks(path, parts)


def rewrite_block(results, path, name):
    replace_blocks(path, {name: paragraphs([machine_text(results), *summaries(results), *job_tables(results)])})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path, nargs="?")
    parser.add_argument("--docs", type=pathlib.Path)
    parser.add_argument("--block")
    parser.add_argument("--summary", type=pathlib.Path)
    arguments = parser.parse_args()
    results = load(arguments.results)
    if not results:
        raise SystemExit(f"{arguments.results}: expected results as *.json, found none")
    if arguments.out is None and arguments.docs is None and arguments.summary is None:
        parser.error("expected OUT, --docs FILE or --summary FILE")
    if arguments.summary:
        write_summary(results, arguments.summary)
    if arguments.out:
        write_report(results, arguments.out)
    if arguments.block and not arguments.docs:
        parser.error("--block: expected --docs FILE")
    if arguments.block:
        rewrite_block(results, arguments.docs, arguments.block)
    elif arguments.docs:
        rewrite_docs(results, arguments.docs)


if __name__ == "__main__":
    main()
