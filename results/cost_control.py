"""Table 4.1 of the thesis, beside what was measured here: a row a system, its a-priori knowledge, cost and control as the
thesis has them, and times, memory and growth by the published records. `results/figures.py` writes it into
docs/figures.md (a block of kind `cost-control`) and draws docs/images/table-4-1.svg.

    python3 results/cost_control.py [--root FOLDER]       draws the picture where the records have changed
"""

import hashlib
import json
import math
from dataclasses import dataclass
from pathlib import Path

import drawings
import runfile
from plots import METHOD_COLOR, STYLE, plt, to_svg
from records import present
from wording import interval, with_unit

PICTURE = "docs/images/table-4-1.svg"
REAL_TIME = 1 / 25  # s: what the thesis calls real time (1)
HEAD = ["thesis", "a priori", "cost, by the thesis", "control, by the thesis", "measured here", "preparation", "a frame",
        "whole run", "peak memory", "growth exponent", "what the user sets"]


@dataclass
class System:
    """What the thesis says of a system, and the run and the variant by which it is measured here."""
    section: str
    prior: str
    cost: str
    control: str
    experiment: str
    variant: str
    sets: list[str]  # names of options, keys of the scene, and of what they may be
    growth: tuple[str, str] = ("", "")  # experiment and study of kind `exponent`


# The control of every section, and the cost of 2.1, 2.2.2, 2.2.3, 3.2.3 and 3.3, are those of Table 4.1 with its signs;
# the cost of the others is what their own text says of it, without a sign.
SYSTEMS = [
    System("2.1", "developable surface", "+ 1–5 s", "+ sketch", "sketch/boot", "several-views",
           ["silhouette", "border", "seam", "fold", "silhouettes", "developability"],
           ("sketch/scaling", "growth of several views")),
    System("2.2.2", "constant distribution in space", "++ real time", "+ free-form deformation", "details/stretch",
           "self-replicating", ["deform", "pattern", "look", "stretch_threshold", "shrink_threshold"],
           ("details/scaling", "growth of self-replicating, 2 threads")),
    System("2.2.3", "relations between sub-elements", "− high", "± automatic synthesis", "assembly/marble-run", "exact",
           ["inputs", "rules", "boundary", "count"], ("assembly/scaling", "growth of two connections")),
    System("2.2.4", "hierarchical constraints", "interactive sculpting", "++ free-form deformation", "grammar/gallery",
           "grammar", ["gesture", "rules", "ascend", "keep_edits"], ("grammar/scaling", "growth of the time of a frame")),
    System("2.3", "relations of organs in space and time", "interactive query", "± query of the ontology",
           "embryo/urinary", "ontology", ["from_day", "to_day", "disease", "query"],
           ("embryo/queries", "growth of all queries with what follows from the ontology")),
    System("3.1", "articulation between rigid elements", "15 frames a second at least", "± blending operator",
           "skinning/knee", "implicit", ["union", "ricci", "gradient-controlled", "bulge-in-contact", "stop_angle_deg"],
           ("skinning/scaling", "growth of implicit, 1 thread")),
    System("3.2.1", "developable conical regions", "interactive, not yet real time", "± handles moved directly",
           "paper/bend-pinch", "hybrid", ["handles", "compression_threshold"]),
    System("3.2.2", "tears guided by the hands' positions", "interactive", "± handles moved directly",
           "paper/tear-hyperbola", "hybrid", ["handles", "toughness", "cuts"]),
    System("3.2.3", "basic types of sounds", "++ real time, 1–50 ms an event", "± data base of sounds",
           "paper/sound-animation", "sound", ["bank", "listener", "wall"]),
    System("3.3", "features of consistent high curvature", "+ interactive", "++ selection, and operations on it",
           "fluid/boats-on-ocean", "pasted", ["edits", "move", "turn_deg", "scale", "start", "speed"]),
]


def times_of(system, published):
    """Its row of times in the first case of the record, or nothing."""
    record = published.get(system.experiment)
    return record.times.get(record.cases[0], {}).get(system.variant, {}) if record else {}


def time(system, published, name):
    return present(times_of(system, published).get(name))


def growth(system, published):
    """`0.89 [0.70, 1.08]` of the time; of another quantity with its name. A dash where none is recorded."""
    experiment, name = system.growth
    studies = published[experiment].studies if experiment in published else []
    study = next((s for s in studies if s.name == name and s.kind == "exponent"), None)
    if study is None:
        return "–"
    of = "" if study.quantity.startswith("timing:") else f" ({study.quantity.partition(':')[2] or study.quantity})"
    return interval(study.value, study.low, study.high) + of


def measured(system, published):
    return [*(with_unit(time(system, published, name), "s") for name in ("prepare", "median", "whole")),
            with_unit(time(system, published, "memory"), "B"), growth(system, published)]


def lines(published):
    """The table as a page shows it."""
    rows = [[s.section, s.prior, s.cost, s.control,
              f"`{s.experiment}` `{s.variant}`" if s.experiment in published else "–", *measured(s, published),
              ", ".join(f"`{name}`" for name in s.sets)] for s in SYSTEMS]
    head, *body = ["| " + " | ".join(row) + " |" for row in [HEAD, *rows]]
    return [head, "|---" * 5 + "|---:" * 5 + "|---|", *body]


# The picture


def draw_texts(axes, published):
    """The thesis' columns, and memory and growth, of a row each."""
    places = (0, 0.05, 0.315, 0.535, 0.795)
    for x, words in zip(places, ("", "a priori", "cost, by the thesis", "control, by the thesis", "peak memory, growth")):
        axes.text(x, -1, words, fontweight="bold")
    for y, s in enumerate(SYSTEMS):
        *_, memory, exponent = measured(s, published)
        for x, words in zip(places, (s.section, s.prior, s.cost, s.control, f"{memory}, {exponent}")):
            axes.text(x, y, words, fontweight="bold" if x == 0 else "normal", va="center")
    axes.set(xlim=(0, 1), ylim=(len(SYSTEMS) - 0.4, -1.4))
    axes.axis("off")


def draw_times(axes, published):
    marks = {"prepare": ("|", "#0072B2", "preparation"), "median": ("o", METHOD_COLOR, "a frame"),
             "whole": ("s", "#009E73", "whole run")}
    for name, (marker, color, label) in marks.items():
        found = [(time(s, published, name), y) for y, s in enumerate(SYSTEMS)]
        found = [(t, y) for t, y in found if math.isfinite(t)]
        axes.plot([t for t, _ in found], [y for _, y in found], marker, color=color, label=label, linestyle="none",
                  markersize=9 if marker == "|" else 6, markeredgewidth=2 if marker == "|" else 1)
    axes.axvline(REAL_TIME, color="#999999", linewidth=1, linestyle="--")
    axes.text(REAL_TIME, len(SYSTEMS) - 0.5, " 25 a second", color="#666666", fontsize=8)
    axes.set(xscale="log", ylim=(len(SYSTEMS) - 0.4, -1.4), xlabel="time measured here (s)")
    axes.set_yticks(range(len(SYSTEMS)), [s.section for s in SYSTEMS])
    axes.legend(loc="upper left", ncols=3, fontsize=8, borderpad=0.1, columnspacing=1)


def digest(published):
    """Of everything that is drawn."""
    drawn = [[s.section, s.prior, s.cost, s.control, s.variant, times_of(s, published), growth(s, published)] for s in SYSTEMS]
    return hashlib.sha256(json.dumps(drawn, sort_keys=True).encode()).hexdigest()


def drawing(published):
    """SVG text, with a comment that holds the digest of what it shows."""
    with plt.rc_context(STYLE):
        figure, (left, right) = plt.subplots(1, 2, figsize=(14, 4.6), width_ratios=(2.6, 1))
        draw_texts(left, published)
        draw_times(right, published)
        figure.tight_layout(w_pad=0)
        return drawings.marked(to_svg(figure), digest(published))


def problems(root, published):
    """A line where the picture shows other numbers than the records have; none where there is nothing to show."""
    path = Path(root) / PICTURE
    if not any(times_of(system, published) for system in SYSTEMS) or drawings.shows(path, digest(published)):
        return []
    return [f"{PICTURE}: shows other numbers than the records have ('figures.py' draws it)"]


def write(root, published):
    """Draws what the records have changed; returns the paths."""
    if not problems(root, published):
        return []
    path = Path(root) / PICTURE
    path.parent.mkdir(parents=True, exist_ok=True)
    runfile.write_atomically(path, drawing(published))
    return [path]


def main(arguments):
    return drawings.command(__doc__, write, arguments)


if __name__ == "__main__":
    runfile.run_main(main)
