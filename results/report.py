"""Writes one self-contained HTML page for a run or several: no network, no scripts, no other files.

    python3 results/report.py RUN_FOLDER... [--out FILE]
"""

import argparse
import os
from pathlib import Path

import report_parts as parts
import runfile
from report_html import MOST_RUNS, escape, left_out, page
from wording import all_told, display_name, outcome_words


def run_section(run, anchor, level_one):
    """Everything that is said of one run, in the order in which a reader asks."""
    heading = "h1" if level_one else "h2"
    body = [f'<section class="run" id="{anchor}">',
            f"<{heading}>{escape(run.title)}</{heading}>", parts.meta_line(run)]
    body += [parts.claims(run), parts.picture(run), parts.sounds(run), parts.curves(run), parts.metrics(run),
             parts.timing(run), parts.studies(run), parts.diagnostics(run), parts.events(run),
             parts.warnings(run), parts.rerun(run), parts.provenance(run), "</section>"]
    return "\n".join(b for b in body if b)


def contents(runs):
    rows = []
    for i, run in enumerate(runs):
        mood = "good" if all_told(run.claims) else "bad"
        verdict = f'<span class="badge {mood}">{outcome_words(run.claims)}</span>' if run.claims else ""
        figure = f", Figure {escape(run.figure)}" if run.figure else ""
        rows.append(f'<li><a href="#run-{i}">{escape(run.title)}</a>{figure} {verdict}</li>')
    return f"<nav><h2>Contents</h2><ol>{''.join(rows)}</ol></nav>"


def comparison(runs):
    """Variants that several runs share, side by side: their summary metrics and times. Only single
    cases are compared: what a sweep changes is told by its own section."""
    singles = [r for r in runs if len(r.cases) == 1]
    shared = [n for n in dict.fromkeys(n for r in singles for n in r.variant_names())
              if sum(n in r.variant_names() for r in singles) > 1]
    if not shared:
        return ""
    blocks = ["<h2>Shared variants</h2>"]
    for name in shared:
        having = [r for r in singles if name in r.variant_names()]
        blocks.append(f"<h3>{escape(display_name(name))}</h3>")
        blocks.append(parts.comparison_table(name, having))
    return "\n".join(blocks)


def build(runs, more=0):
    """The page; `more` runs were asked for than it can hold."""
    if len(runs) == 1:
        return page(runs[0].title, run_section(runs[0], "run-0", True))
    body = ["<h1>Report of " + str(len(runs)) + " runs</h1>", contents(runs),
            left_out(more, "runs were asked for; their numbers are"), comparison(runs)]
    body += [run_section(run, f"run-{i}", False) for i, run in enumerate(runs)]
    return page("geoprior report", "\n".join(b for b in body if b))


def target_of(runs, output):
    if output:
        return Path(output)
    if len(runs) == 1:
        return runs[0].folder / "report.html"
    runs_root = Path(__file__).resolve().parent / "runs"
    return Path(os.environ.get("GEOPRIOR_RUNS") or runs_root) / "report.html"


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("runs", nargs="+", metavar="run", help="run folder or its run.h5")
    parser.add_argument("--out", help="default: report.html in the run folder;"
                        " results/runs/report.html for several runs")
    runfile.add_force(parser)
    options = parser.parse_args(arguments)
    runs = [runfile.read_run(place, options.force) for place in options.runs[:MOST_RUNS]]
    target = target_of(runs, options.out)
    runfile.write_atomically(target, build(runs, len(options.runs) - len(runs)))
    if not options.out:
        print(target)
    return 0


if __name__ == "__main__":
    runfile.run_main(main)
