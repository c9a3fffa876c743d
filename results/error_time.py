"""Draws distance against time of all studies that match it ("matched", docs/experiments.md) in the published records of
a topic: a panel an experiment, a line a family of rivals (uniform meshes, then adaptive ones), a marker each hybrid.

    python3 results/error_time.py [--root FOLDER]
"""

import hashlib
import json
import math
from pathlib import Path

from matplotlib.ticker import LogLocator, NullFormatter

import drawings
import runfile
from plots import COLORS, DASHES, METHOD_COLOR, STYLE, drawn_name, plt, to_svg
from wording import interval

PICTURES = {"paper": "docs/images/paper-error-time.svg"}  # topic: picture
COLUMNS = 4
NEIGHBOURS = ["o", "s", "^"]  # of families
METHODS = ["*", "P", "X"]


def matched_of(published, topic):
    """experiment: its studies of time at equal error, in the order of the file."""
    found = {}
    for name, record in published.items():
        studies = [s for s in record.studies
                   if (s.kind, s.match) == ("matched", "hausdorff_ratio") and s.quantity.startswith("timing:")]
        if name.startswith(f"{topic}/") and studies:
            found[name] = studies
    return found


def digest(studies):
    """Of everything that is drawn."""
    drawn = {name: [[s.members, list(s.x), list(s.y), s.value, s.low, s.high] for s in of]
             for name, of in studies.items()}
    return hashlib.sha256(json.dumps(drawn, sort_keys=True).encode()).hexdigest()


def families_of(study):
    """(names, errors, costs) of the variant itself, then of each family."""
    at = 0
    for names in study.members:
        yield names, study.x[at:at + len(names)], study.y[at:at + len(names)]
        at += len(names)


def draw_panel(axes, name, studies):
    (_, *families) = families_of(studies[0])
    for k, (names, errors, costs) in enumerate(families):
        label = drawn_name("uniform meshes" if k == 0 else "adaptive meshes") if len(families) == 2 else names[0]
        axes.loglog(costs * 1000, errors * 100, linestyle=DASHES[k % len(DASHES)], color=COLORS[k],
                    marker=NEIGHBOURS[k % len(NEIGHBOURS)], label=label)
    for k, study in enumerate(studies):
        names, errors, costs = next(families_of(study))
        axes.loglog(costs * 1000, errors * 100, METHODS[k % len(METHODS)], color=METHOD_COLOR if k == 0 else COLORS[4],
                    markersize=11 if k == 0 else 7, label=drawn_name(names[0]), zorder=4)
    first = studies[0]
    axes.set_title(f"{name.partition('/')[2]}: {interval(first.value, first.low, first.high)}", fontsize=8.5)
    axes.set_xlabel("mean time a frame (ms)")
    axes.set_ylabel("distance (% of the width)")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter(NullFormatter())


def drawing(studies):
    """SVG text, with a comment that holds the digest of what it shows."""
    with plt.rc_context(STYLE):
        rows = math.ceil(len(studies) / COLUMNS)
        figure, grid = plt.subplots(rows, COLUMNS, figsize=(3.3 * COLUMNS, 2.8 * rows + 0.5), squeeze=False)
        flat = [axes for line in grid for axes in line]
        for axes, (name, of) in zip(flat, studies.items()):
            draw_panel(axes, name, of)
        for axes in flat[len(studies):]:
            axes.set_visible(False)
        labels = {}
        for axes in flat[:len(studies)]:
            for handle, label in zip(*axes.get_legend_handles_labels()):
                labels.setdefault(label, handle)
        figure.legend(labels.values(), labels.keys(), loc="lower center", ncols=len(labels))
        figure.tight_layout(rect=(0, 0.4 / (2.8 * rows + 0.5), 1, 1))
        return drawings.marked(to_svg(figure), digest(studies))


def picture_of(root, topic):
    return Path(root) / PICTURES[topic]


def problem_of(root, published, topic):
    """A line where the picture shows other numbers than the records have; none where nothing was compared."""
    studies, path = matched_of(published, topic), picture_of(root, topic)
    if not studies or drawings.shows(path, digest(studies)):
        return ""
    return f"{PICTURES[topic]}: shows other numbers than the records have ('figures.py' draws it)"


def problems(root, published):
    return [line for line in (problem_of(root, published, topic) for topic in PICTURES) if line]


def write(root, published):
    """Draws what the records have changed; returns the paths."""
    written = []
    for topic in PICTURES:
        if problem_of(root, published, topic):
            path = picture_of(root, topic)
            path.parent.mkdir(parents=True, exist_ok=True)
            runfile.write_atomically(path, drawing(matched_of(published, topic)))
            written.append(path)
    return written


def main(arguments):
    return drawings.command(__doc__, write, arguments)


if __name__ == "__main__":
    runfile.run_main(main)
