"""The results of bench/run: rows of one contestant beside ours, from a folder of files or from their summary."""
import json
import pathlib

from reporting.summary import read_summary, summarized

NORMAL, FINE = "isoweave normal", "isoweave fine"
TOLERANCE = 0.05  # by which counts may differ that count as equal
UNKNOWN = "–"


def load(source):
    path = pathlib.Path(source)
    if path.is_dir():
        results = [summarized(json.loads(file.read_text())) for file in sorted(path.glob("*.json"))]
    else:
        results = read_summary(path)
    results = [result for result in results if result["rows"]]
    return sorted(results, key=lambda result: samples(result) if "input" in result else 0)


def suite(results, name):
    return [result for result in results if result["suite"] == name]


def machines(results):
    """How many processors the machines have that the results are of."""
    return sorted({result["machine"]["threads"] for result in results})


def on_machine(results, processors):
    return [result for result in results if result["machine"]["threads"] == processors]


def samples(result):
    x, y, z = result["input"]["dims"]
    return x * y * z


def volume_name(result):
    return result["input"]["name"]


def is_ours(name):
    return name.startswith("isoweave")


def failure(row):
    return row["ours"].get("failure") or row["peer"].get("failure")


def rows_of(result, peer=None, threads=None, left=None):
    """Rows that have a ratio, of one peer, number of threads and share left, where given."""
    return [
        row
        for row in result["rows"]
        if "ratio" in row
        and (peer is None or row["peer"]["name"] == peer)
        and (threads is None or row["threads"] == threads)
        and (left is None or row["left"] in left)
    ]


def is_at_count(side, count):
    return abs(side["triangles"] / count - 1) <= TOLERANCE


def equal_rows(*arguments):
    """The rows in which the peer came to the count that it was asked for: those that show who is faster."""
    return [row for row in rows_of(*arguments) if is_at_count(row["peer"], row["ours"]["triangles"])]


def lefts(result):
    return sorted({row["left"] for row in result["rows"]}, reverse=True)


def thread_counts(result):
    return sorted({row["threads"] for row in result["rows"] if row["threads"] > 0})


def names(rows):
    """Peers in the order in which they ran."""
    return list(dict.fromkeys(row["peer"]["name"] for row in rows))


def added_bytes(side):
    """What the run adds to its input in the contestant's own structures."""
    return side["added_bytes"]
