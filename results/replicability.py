"""The table of docs/replicability.md: of each figure of the thesis the command, what it writes, and what it took here, by
the published records. `results/figures.py` writes and checks it as a block of kind `replicability`."""

import re
import tomllib
from pathlib import Path

import claimed
from records import present
from wording import with_unit

HEAD = ["figure", "command", "writes, below its folder", "runs it needs, made first", "methods", "processor", "peak memory"]
PICTURES = re.compile(r"<!-- begin: figure (\S+)((?: \S+)*?) *-->")


def figure_key(figure):
    """`3.11 left` before `3.11 right`, 2.7 before 2.13."""
    number, _, side = figure.partition(" ")
    return [int(part) for part in number.split(".")], side


def written(root, experiment):
    """The files of the run that the gallery shows."""
    gallery = Path(root) / "docs" / "gallery.md"
    text = gallery.read_text(encoding="utf-8") if gallery.is_file() else ""
    named = {match[1]: match[2].split() for match in PICTURES.finditer(text)}
    return named.get(experiment) or ["figure.png"]


def runs_needed(value):
    """Experiments whose runs the values of an experiment file name, as in `run:fluid/boat-wake/flip`."""
    if isinstance(value, str):
        named = re.match(r"run:([^/]+/[^/]+)", value)
        return {named[1]} if named else set()
    inner = value.values() if isinstance(value, dict) else value if isinstance(value, list) else []
    return set().union(*map(runs_needed, inner))


def seconds_of_methods(record):
    """Preparation and one pass over all frames, of all variants and cases; NaN where a pass was not timed, as of methods
    whose frames are timed one by one and in any order."""
    rows = [row for case in record.times.values() for row in case.values()]
    return sum(present(row["prepare"]) + present(row["whole"]) for row in rows) if rows else float("nan")


def peak_memory(record):
    """The most that a variant needed (bytes)."""
    recorded = [row.get("memory") for case in record.times.values() for row in case.values()]
    return max((m for m in map(present, recorded) if m == m), default=float("nan"))


def row_of(record, root):
    spec = tomllib.loads(claimed.file_of(root, record.experiment_id).read_text(encoding="utf-8"))
    return [record.figure, f"`{record.command}`", ", ".join(f"`{name}`" for name in written(root, record.experiment_id)),
            ", ".join(f"`{name}`" for name in sorted(runs_needed(spec))) or "none",
            with_unit(seconds_of_methods(record), "s"), with_unit(record.processor_s, "s"),
            with_unit(peak_memory(record), "B")]


def lines(records, root):
    """The table of all records that are of a figure, in the order of the thesis."""
    shown = sorted((r for r in records.values() if r.figure), key=lambda r: (figure_key(r.figure), r.experiment_id))
    rows = [HEAD, *(row_of(record, root) for record in shown)]
    head, *body = ["| " + " | ".join(row) + " |" for row in rows]
    return [head, "|---" * 4 + "|---:" * 3 + "|", *body]
