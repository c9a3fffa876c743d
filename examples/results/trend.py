"""How did a number change from commit to commit? A summary value of the first case over the runs of an experiment.

Full runs, or with --quick the quick ones, below --root, GEOPRIOR_RUNS or results/runs, whichever is said first. A run
whose variant failed is left out. A + behind a commit: with changes that were not committed.

    python3 examples/results/trend.py skinning/knee volume_change.min implicit --plot trend.svg
"""

import argparse
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2] / "results"))
from geoprior_results import RunError, open_run, run_folders, runs_root  # noqa: E402


def trend(chosen):
    """(start, commit, metric) of the runs that have the value, oldest first."""
    rows = []
    for folder in run_folders(chosen.experiment, chosen.root):
        try:
            run = open_run(folder)
        except RunError as error:
            print(f"left out: {error}", file=sys.stderr)
            continue
        variant, said = run.cases[0].variant(chosen.variant), run.provenance
        if not variant or run.quick != chosen.quick:
            continue
        if variant.status != "done":
            print(f"left out: {folder}: {variant.name} is {variant.status}", file=sys.stderr)
        elif chosen.metric in variant.summary:
            commit = said.get("git_commit", "unknown")[:12] + "+" * (said.get("git_dirty") == "true")
            rows.append((said.get("start", ""), commit, variant.summary[chosen.metric]))
    if not rows:
        size = "quick" if chosen.quick else "full"
        raise RunError(f"{runs_root(chosen.root)}: no {size} run of '{chosen.experiment}' has it")
    return rows


def draw(rows, chosen):
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(layout="constrained")
    axes.plot([metric.values for _, _, metric in rows], "o-")
    axes.set_xticks(range(len(rows)), [f"{start[:10]}\n{commit}" for start, commit, _ in rows], rotation=90)
    axes.set(title=f"{chosen.experiment}, {chosen.variant}", ylabel=f"{chosen.metric} [{rows[0][2].unit}]")
    figure.savefig(chosen.plot)


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("experiment"), parser.add_argument("metric"), parser.add_argument("variant")
    parser.add_argument("--root"), parser.add_argument("--plot", metavar="FILE")
    parser.add_argument("--quick", action="store_true")
    chosen = parser.parse_args(arguments)
    try:
        rows = trend(chosen)
        if chosen.plot:
            draw(rows, chosen)
    except (RunError, OSError, ValueError) as error:  # of a plot: its folder, its ending
        parser.exit(2, f"{error}\n")
    print(*(f"{start:22} {commit:14} {m.values:14.6g} {m.unit}" for start, commit, m in rows), sep="\n")


if __name__ == "__main__":
    main(sys.argv[1:])
