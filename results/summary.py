"""Writes summary.md of a run: claims, summary metrics, times, where the files lie.

    python3 results/summary.py RUN_FOLDER [--out FILE]
"""

import argparse
from pathlib import Path

import numpy as np

import runfile
from markdown_text import code, escaped, table
from tables import failures, metric_rows, timing_rows
from wording import beside, display_name, interval, outcome_words, with_unit


def claim_list(run, shown=escaped):
    """`shown` makes Markdown of the texts of claims: those of a run may be a stranger's."""
    lines = []
    for claim in run.claims:
        case = f" ({claim.case})" if claim.case and len(run.cases) > 1 else ""
        lines.append(f"- **{claim.outcome}**: {shown(claim.text + case)}  ")
        lines.append(f"  {code(claim.detail)}" + "".join(f"; {shown(words)}" for words in beside(claim)))
    return lines


def claims(run):
    """The list below a line of what they come to; nothing for a run without claims."""
    return ["", f"## Claims: {outcome_words(run.claims)}", "", *claim_list(run)] if run.claims else []


def metrics_table(case):
    rows = [[escaped(row.label()), *row.cells] for row in metric_rows(case)]
    if not rows:
        return []
    return ["", *table(["metric"] + [escaped(display_name(v.name)) for v in case.variants], rows)]


def timing_table(found):
    """The Markdown table of timing rows: times with their spread, ratios with their interval."""
    with_whole = any(np.isfinite(row.whole) for row in found)
    with_memory = any(np.isfinite(row.memory) for row in found)
    rows = []
    for row in found:
        t = row.times
        whole = [with_unit(row.whole, "s")] if with_whole else []
        memory = [with_unit(row.memory, "B")] if with_memory else []
        ratios = [f"{interval(r.median, r.low, r.high)} × {escaped(display_name(r.of))}"
                  + (" (whole runs)" if r.paired == "run" else "") for r in row.ratios]
        rows.append([escaped(row.variant), escaped(row.phase), with_unit(t.median, "s"), with_unit(t.p95, "s"),
                     f"{with_unit(t.low, 's')} … {with_unit(t.high, 's')}", *whole,
                     with_unit(row.prepare, "s"), *memory, "<br>".join(ratios)])
    if not rows:
        return []
    head = ["variant", "phase", "median", "p95", "quartiles", *(["whole run"] if with_whole else []),
            "prepare", *(["peak memory"] if with_memory else []), "ratio [95 % interval]"]
    return ["", *table(head, rows)]


def summary_text(run):
    figure = f" (thesis Figure {run.figure})" if run.figure else ""
    lines = [f"# {escaped(run.title + figure)}", "",
             f"Experiment {code(run.experiment_id)}{', quick version' if run.quick else ''}, "
             f"{escaped(run.provenance.get('start', 'start unknown'))}, "
             f"commit {escaped(run.provenance.get('git_commit', 'unknown'))}."]
    lines += [f"\n**{escaped(line)}**" for line in failures(run)]
    lines += claims(run)
    for case in run.cases:
        heading = f": {escaped(case.name)}" if len(run.cases) > 1 else ""
        lines += ["", f"## Metrics{heading}"] + metrics_table(case)
        times = timing_table(timing_rows(case))
        if times:
            lines += ["", f"## Times{heading}"] + times
        lines += [f"\nWarning: {escaped(warning)}" for warning in case.warnings]
    if run.studies:
        rows = [[*map(escaped, (s.name, s.kind, s.quantity)), interval(s.value, s.low, s.high)] for s in run.studies]
        lines += ["", "## Studies", "",
                  *table(["study", "kind", "quantity", "value [95 % interval]"], rows)]
    lines += ["", "## Files", "", "- `figure.png`, `metrics.svg`, `times.svg` (of processes), `spectrogram.png` (of sounds): what to look at "
              "first",
              "- `run.h5`: every number (docs/file-formats.md)",
              "- `frames/`: geometry of every frame; open the `.pvd` files with ParaView",
              "- `spec.toml`: the experiment as it ran", ""]
    return "\n".join(lines)


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("run", help="run folder or its run.h5")
    parser.add_argument("--out", help="default: summary.md in the run folder")
    runfile.add_force(parser)
    options = parser.parse_args(arguments)
    run = runfile.read_run(options.run, options.force)
    target = Path(options.out) if options.out else run.folder / "summary.md"
    runfile.write_atomically(target, summary_text(run))
    return 0


if __name__ == "__main__":
    runfile.run_main(main)
