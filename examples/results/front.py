"""Which variants are worth their time? The front of cost and quality in one case of a run.

A variant is dominated when another takes no longer and is no worse, and is better in one of the two. Time is the
median of a frame; better is what the metric's direction says, for `closer_to_target` the distance from --target.
A variant that failed is left out: what it has is of the frames before its fault.

    python3 examples/results/front.py RUN volume_change.min --target 0 --plot front.svg
"""

import argparse
import math
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2] / "results"))
from geoprior_results import RunError, open_run  # noqa: E402


def points_of(run, case, name, target):
    """(variant, seconds, value, how bad that is), the fastest first."""
    variants = case.variants if case else []
    for v in variants:
        if v.status != "done":
            print(f"left out: {v.name} is {v.status}", file=sys.stderr)
    found = [(v.name, v.seconds_a_frame(), v.summary[name]) for v in variants
             if v.status == "done" and name in v.summary]
    found = [(n, t, m.values, m.direction) for n, t, m in found if math.isfinite(t) and math.isfinite(m.values)]
    if not found:
        raise RunError(f"{run.folder}: no variant of the case has a time and '{name}'")
    sign = {"lower_is_better": 1, "higher_is_better": -1}.get(found[0][3])
    if target is None and sign is None:
        raise RunError(f"{run.folder}: '{name}' has direction {found[0][3]}: say with --target what is best")
    return sorted([(n, t, x, sign * x if target is None else abs(x - target)) for n, t, x, _ in found],
                  key=lambda point: point[1])


def draw(points, front, name, file):
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(layout="constrained")
    for n, t, v, _ in points:
        axes.plot(t, v, "o" if n in front else "x")
        axes.annotate(n, (t, v), textcoords="offset points", xytext=(6, 4))
    axes.set(xscale="log", xlabel="time of a frame [s]", ylabel=name)
    figure.savefig(file)


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("run"), parser.add_argument("metric"), parser.add_argument("--case")
    parser.add_argument("--target", type=float), parser.add_argument("--plot", metavar="FILE")
    chosen = parser.parse_args(arguments)
    try:
        run = open_run(chosen.run)
        points = points_of(run, run.case(chosen.case or run.cases[0].name), chosen.metric, chosen.target)
        by = {n: [m for m, t2, _, b2 in points if t2 <= t and b2 <= b and (t2 < t or b2 < b)] for n, t, _, b in points}
        if chosen.plot:
            draw(points, {n for n in by if not by[n]}, chosen.metric, chosen.plot)
    except (RunError, OSError, ValueError) as error:  # of a plot: its folder, its ending
        parser.exit(2, f"{error}\n")
    for n, t, v, _ in points:
        print(f"{n:24} {t:11.4g} s {v:12.5g}  {'dominated by ' + by[n][0] if by[n] else 'front'}")


if __name__ == "__main__":
    main(sys.argv[1:])
