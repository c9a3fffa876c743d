"""Writes docs/figures.md: thesis figure, experiment, files, numbers, and whether the thesis' claim holds.

    python3 results/figures.py RUN_FOLDER... --out docs/figures.md

Every number comes from the runs given; the order is theirs.
"""

import argparse
from pathlib import Path

import numpy as np

import runfile
from summary import claims, table, timing_table
from tables import failures

HEADER = """# Figures and numbers

Thesis figure, the experiment that makes it, its claims with the values measured, and whether they hold. A claim that falls short is a
finding, explained in the method's page ({pages}). Written by `results/figures.py` from the runs that the table names; a run's folder is
`results/runs/<experiment>/<time>-<hash>/` with `figure.png`, `metrics.svg`, `run.h5` and `frames/`. Make them again with `./reproduce.sh --all`.
"""


def sizes(run):
    """How large its scenes are; of simulations, whose meshes change, the largest frame of any variant."""
    vertices = sorted({int(case.facts["vertices"]) for case in run.cases if "vertices" in case.facts})
    if vertices:
        return ", ".join(f"{n:,}" for n in vertices)
    triangles = [np.nanmax(metric.values) for case in run.cases for variant in case.variants
                 for name, metric in variant.metrics.items() if name == "triangles"]
    return f"up to {int(max(triangles)):,} triangles" if triangles else ""


def header(runs):
    topics = dict.fromkeys(run.topic for run in runs)
    return HEADER.replace("{pages}", ", ".join(f"[{t}](methods/{t}.md#what-was-found)" for t in topics))


def overview(runs):
    rows = []
    for run in runs:
        held = sum(claim.holds for claim in run.claims)
        verdict = f"{held} of {len(run.claims)} claims hold" if run.claims else "no claims"
        rows.append([f"`{run.experiment_id}`", run.figure or "–", sizes(run), verdict,
                     f"`{run.content_sha256[:12]}`", f"`{run.provenance.get('git_commit', 'unknown')[:12]}`"])
    return table(["experiment", "figure", "vertices or triangles", "result", "content_sha256", "commit"], rows)


def section(run):
    lines = ["", f"## {run.experiment_id}" + (f" → Figure {run.figure}" if run.figure else ""), "", run.title + "."]
    lines += [f"\n**{line}**\n" for line in failures(run)]
    lines += [line.replace("## Claims", "**Claims**") if line.startswith("## ") else line for line in claims(run)]
    if run.studies:
        lines += ["", *table(["study", "value", "95 % interval"],
                             [[s.name, f"{s.value:.3g}", f"{s.low:.3g} … {s.high:.3g}"] for s in run.studies])]
    for case in run.cases[:1] if len(run.cases) > 4 else run.cases:
        lines += timing_table(case)
    return lines


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("runs", nargs="+")
    parser.add_argument("--out", type=Path, required=True)
    chosen = parser.parse_args(arguments)
    runs = [runfile.read_run(place) for place in chosen.runs]
    provenance = runs[0].provenance
    lines = [header(runs), f"Processor: {provenance.get('cpu', 'unknown')}.", ""]
    lines += overview(runs)
    for run in runs:
        lines += section(run)
    runfile.write_atomically(chosen.out, "\n".join(lines) + "\n")


if __name__ == "__main__":
    runfile.run_main(main)
