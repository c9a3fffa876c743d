"""Draws metrics.svg of a run: one panel a metric over the parameter, one line a variant; times.svg of
processes: the time of each frame by phase; studies.svg: slopes in log-log plots, spreads as dots.

    python3 results/plots.py RUN_FOLDER [--out FILE]
"""

import argparse
import io
import math
import warnings
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

import runfile  # noqa: E402
from tables import has_frame_times, inner_phases  # noqa: E402
from wording import display_name, interval, labelled, scale_for, unit_symbol  # noqa: E402

# Okabe and Ito (2008): told apart with any colour vision; line styles and markers for black and white.
COLORS = ["#0072B2", "#E69F00", "#009E73", "#D55E00", "#CC79A7", "#56B4E9", "#999999", "#000000"]
DASHES = ["-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (1, 1))]
MARKERS = ["o", "s", "^", "D", "v", "P", "X", "*"]
METHOD_COLOR = "#D55E00"
MOST_CASES = 6
MOST_METRICS = 12
MOST_VARIANTS = 24
MOST_STUDIES = 24
MOST_POINTS = 5000
MOST_CHARACTERS = 80

STYLE = {
    "font.family": "DejaVu Sans", "font.size": 9, "axes.titlesize": 9.5, "axes.titleweight": "bold",
    "axes.titlelocation": "left", "axes.spines.top": False, "axes.spines.right": False,
    "axes.linewidth": 0.7, "axes.grid": True, "grid.color": "#e6e6e6", "grid.linewidth": 0.6,
    "axes.axisbelow": True, "lines.linewidth": 1.6, "lines.markersize": 4, "legend.frameon": False,
    "svg.fonttype": "path", "svg.hashsalt": "geoprior", "figure.facecolor": "white",
    "axes.formatter.use_mathtext": True, "axes.formatter.limits": (-3, 4),
}


# A character that the font lacks is drawn as an empty box, which needs no further words.
warnings.filterwarnings("ignore", message="Glyph .* missing from current font")


def plain(text):
    """The text as matplotlib shall set it: as it stands on one line, no mathematics between dollars,
    and not longer than a panel."""
    text = " ".join(text.split())
    if len(text) > MOST_CHARACTERS:
        text = text[:MOST_CHARACTERS - 1] + "…"
    return text.replace("$", r"\$")


def drawn_name(name):
    return plain(display_name(name))


def styles(run):
    """Colour, dash and marker of every variant: by its place in the experiment, the same in every
    panel. The thesis' methods are drawn in one warm colour first, above the baselines."""
    roles = {v.name: v.role for case in run.cases for v in case.variants}
    out = {}
    cool = [c for c in COLORS if c != METHOD_COLOR]
    names = run.variant_names()
    methods = [n for n in names if roles[n] == "method"]
    methods_before = 0
    for i, name in enumerate(names):
        color = METHOD_COLOR if methods[:1] == [name] else cool[(i - methods_before) % len(cool)]
        methods_before += roles[name] == "method"
        out[name] = {"color": color, "linestyle": DASHES[(i // len(COLORS) + i) % len(DASHES)],
                     "marker": MARKERS[i % len(MARKERS)],
                     "zorder": 4 if roles[name] == "method" else 3}
        if methods[:1] == [name]:
            out[name].update(linestyle="-", linewidth=2.2)
    return out


def frame_metrics(run):
    """Metrics that are drawn: those of figure_view.metrics, else all that vary over the frames."""
    found = {}
    for case in run.cases:
        for variant in case.variants:
            for name, metric in variant.metrics.items():
                values = metric.values[np.isfinite(metric.values)]
                varies = values.size > 1 and np.ptp(values) > 0
                found[name] = found.get(name, False) or varies
    wanted = [m for m in run.view.get("metrics", []) if m in found]
    chosen = wanted or [m for m, varies in found.items() if varies]
    return chosen[:MOST_METRICS]


def shown_cases(run):
    wanted = run.view.get("cases", [])
    cases = [c for c in run.cases if not wanted or c.name in wanted]
    return cases[:MOST_CASES]


def noise_floor(case, name, unit):
    """Largest value that is no signal, where the run measured one: a metric `<x>_noise_floor` speaks
    for the metrics `<x>…` of its unit."""
    floors = [0.0]
    for variant in case.variants:
        for other, metric in variant.metrics.items():
            prefix = other.removesuffix("_noise_floor")
            if prefix != other and name != other and name.startswith(prefix) \
                    and metric.unit == unit:
                floors += [v for v in metric.values if math.isfinite(v)]
    return max(floors)


def needs_log(curves):
    """Positive curves whose peaks lie more than three decades apart cannot share a linear axis."""
    values = np.concatenate(curves) if curves else np.array([])
    values = values[np.isfinite(values)]
    if values.size == 0 or (values < 0).any():
        return False
    peaks = [np.nanmax(c) for c in curves if np.isfinite(c).any() and np.nanmax(c) > 0]
    return len(peaks) > 1 and max(peaks) > 1000 * min(peaks)


def set_log_axis(axes, curves):
    positive = np.concatenate([c[np.isfinite(c) & (c > 0)] for c in curves])
    smallest = positive.min()
    if all((c[np.isfinite(c)] > 0).all() for c in curves):
        axes.set_yscale("log")
    else:  # zeros stay on the axis, in a linear part below the smallest value
        axes.set_yscale("symlog", linthresh=max(smallest, positive.max() * 1e-9), linscale=0.5)


def mark_every(count):
    return max(1, math.ceil(count / 12))


def thinned(count):
    """Every so many points that at most MOST_POINTS are drawn."""
    return slice(None, None, max(1, math.ceil(count / MOST_POINTS)))


def draw_metric(axes, case, name, names, look):
    curves = [(v, v.metrics[name]) for v in case.variants if name in v.metrics and v.name in names]
    curves = [(v, m) for v, m in curves if np.isfinite(m.values).any()]
    if not curves:
        axes.text(0.5, 0.5, "no values", ha="center", va="center", transform=axes.transAxes,
                  color="#888888")
        axes.set_title(drawn_name(name))
        return
    unit = curves[0][1].unit
    size, symbol = scale_for(np.concatenate([m.values for _, m in curves]), unit)
    scaled = [m.values / size for _, m in curves]
    for (variant, _), values in zip(curves, scaled):
        style = dict(look[variant.name])
        if values.size == 1:
            style["linestyle"] = "none"
        few = thinned(values.size)
        axes.plot(variant.parameter[few], values[few], label=drawn_name(variant.name),
                  markevery=mark_every(values[few].size), markeredgewidth=0, **style)
    if not any(values[np.isfinite(values)].any() for values in scaled):
        # Nothing to scale an axis by: the zero, and room above it.
        axes.set_ylim(-0.1, 1)
        axes.set_yticks([0])
    elif needs_log(scaled):
        set_log_axis(axes, scaled)
    else:
        low, high = axes.get_ylim()
        if low < 0 < high:
            axes.axhline(0, color="#444444", linewidth=0.7, zorder=2)
        elif 0 <= low < 0.5 * high:
            axes.set_ylim(bottom=0)
    floor = noise_floor(case, name, unit) / size
    if floor > 0:
        axes.axhspan(0, floor, color="#d9d9d9", zorder=1, linewidth=0)
        axes.annotate("noise floor", (1, floor), xycoords=("axes fraction", "data"), ha="right",
                      va="bottom", fontsize=7, color="#777777")
    axes.set_title(labelled(drawn_name(name), plain(symbol)))


def parameter_label(case):
    return labelled(drawn_name(case.parameter_name), plain(unit_symbol(case.parameter_unit)))


def variants_shown(run):
    wanted = run.view.get("variants", [])
    return [n for n in run.variant_names() if not wanted or n in wanted][:MOST_VARIANTS]


def add_legend(figure, all_axes, names, height):
    """The variants in the order of the experiment, whichever panels they are in."""
    found = {}
    for axes in all_axes:
        for handle, label in zip(*axes.get_legend_handles_labels()):
            found.setdefault(label, handle)
    labels = [drawn_name(n) for n in names]
    handles = {label: found[label] for label in labels if label in found}
    if len(handles) > 0:
        figure.legend(handles.values(), handles.keys(), loc="upper left", fontsize=9,
                      ncol=min(6, len(handles)), bbox_to_anchor=(0.01, 1 - 0.04 / height),
                      handlelength=2.8, columnspacing=1.8, borderaxespad=0)


def curves_figure(run):
    """All metric curves of a run: one case as a grid of panels, a sweep as a row a metric and a
    column a case. None when nothing varies."""
    metrics, cases = frame_metrics(run), shown_cases(run)
    if not metrics or not cases:
        return None
    many = len(cases) > 1
    columns = len(cases) if many else min(3, len(metrics))
    rows = len(metrics) if many else math.ceil(len(metrics) / columns)
    look, names = styles(run), variants_shown(run)
    legend_rows = math.ceil(len(names) / 6)
    width = 3.55 * columns if columns < 4 else 2.6 * columns
    height = 2.35 * rows + 0.25 * legend_rows + 0.3
    figure, grid = plt.subplots(rows, columns, figsize=(width, height), squeeze=False,
                                sharey="row" if many else False)
    flat = [a for line in grid for a in line]
    panels = [(c, m) for m in metrics for c in cases]
    for axes, (case, metric) in zip(flat, panels):
        draw_metric(axes, case, metric, names, look)
        if many:
            axes.set_title(f"{axes.get_title(loc='left')}\n{plain(case.name)}", fontsize=8)
    for i, axes in enumerate(flat):
        if i >= len(panels):
            axes.set_visible(False)
        elif i + columns >= len(panels):
            axes.set_xlabel(parameter_label(panels[i][0]))
    figure.tight_layout(rect=(0, 0, 1, 1 - (0.25 * legend_rows + 0.1) / height), h_pad=1.4)
    add_legend(figure, flat, names, height)
    return figure


def timed_case(run):
    """The first case shown that has times of frames; None without one."""
    return next((c for c in shown_cases(run)
                 if any(has_frame_times(v) and v.parameter.size > 1 for v in c.variants)), None)


def frame_times(seconds):
    """Milliseconds of each frame: the median of its repetitions, NaN where the phase was not. Without
    the first frame where it is the state at the start, which costs next to nothing."""
    out = np.full(len(seconds), np.nan)
    for i, row in enumerate(seconds):
        finite = row[np.isfinite(row)]
        if finite.size:
            out[i] = 1e3 * np.median(finite)
    if np.isfinite(out[1:]).any() and out[0] < 0.01 * np.nanmedian(out[1:]):
        out[0] = np.nan
    return out


def largest_phases(variant):
    """The phases that cost most, at most as many as have colours."""
    phases = {p: frame_times(s) for p, s in inner_phases(variant).items()}
    cost = {p: np.nansum(ms) for p, ms in phases.items()}
    chosen = sorted(phases, key=lambda p: (-cost[p], p))[:len(COLORS) - 1]
    return {p: phases[p] for p in chosen if cost[p] > 0}


def draw_phases(axes, variant, look, order):
    """A phase has the same colour in every panel: its place in `order`."""
    whole = frame_times(variant.timing["run"])
    few = thinned(whole.size)
    axes.plot(variant.parameter[few], whole[few], color="#222222", linewidth=1.6, label="whole frame")
    for phase, ms in largest_phases(variant).items():
        i = order.index(phase)
        # Dots show a phase that some frames enter alone.
        dots = {"marker": ".", "markersize": 3} if np.isnan(ms[1:]).any() else {}
        axes.plot(variant.parameter[few], ms[few], color=COLORS[i % (len(COLORS) - 1)], linewidth=1.0,
                  linestyle="-" if i < len(COLORS) - 1 else ":", label=drawn_name(phase), **dots)
    axes.set_title(drawn_name(variant.name), color=look[variant.name]["color"])
    axes.legend(loc="best", fontsize=6.5, handlelength=2.2, labelspacing=0.25)


def draw_whole_frames(axes, variants, look):
    for variant in variants:
        style = {k: v for k, v in look[variant.name].items() if k in ("color", "zorder")}
        few = thinned(variant.parameter.size)
        axes.plot(variant.parameter[few], frame_times(variant.timing["run"])[few],
                  label=drawn_name(variant.name), **style)
    axes.set_title("Whole frames")
    axes.legend(loc="best", fontsize=7, handlelength=2.6)


def times_figure(run):
    """Milliseconds a frame over the parameter: all variants, then each with its phases. None when no
    process was timed by frames."""
    case = timed_case(run)
    if case is None:
        return None
    names, look = variants_shown(run), styles(run)
    timed = [v for v in case.variants
             if v.name in names and has_frame_times(v) and v.parameter.size > 1]
    if not timed:
        return None
    with_phases = [v for v in timed if largest_phases(v)]
    count = 1 + len(with_phases)
    columns = 2 if count in (2, 4) else min(3, count)
    rows = math.ceil(count / columns)
    figure, grid = plt.subplots(rows, columns, figsize=(3.9 * columns, 2.7 * rows), squeeze=False,
                                sharey=True)
    flat = [a for line in grid for a in line]
    draw_whole_frames(flat[0], timed, look)
    order = list(dict.fromkeys(p for v in with_phases for p in largest_phases(v)))
    for axes, variant in zip(flat[1:], with_phases):
        draw_phases(axes, variant, look, order)
    times = [frame_times(v.timing["run"]) for v in timed]
    inner = [ms for v in with_phases for ms in largest_phases(v).values()]
    values = np.concatenate([*times, *inner])
    positive = values[np.isfinite(values) & (values > 0)]
    for i, axes in enumerate(flat):
        axes.set_visible(i < count)
        axes.set_yscale("log")
        if positive.size:
            top = positive.max()
            axes.set_ylim(max(np.percentile(positive, 1) / 2, top * 1e-5), 2 * top)
        if i + columns >= count:
            axes.set_xlabel(parameter_label(case))
        if i % columns == 0:
            axes.set_ylabel("ms a frame")
    figure.tight_layout()
    return figure


def studies_with_points(run):
    return [s for s in run.studies if s.x.size > 1
            and (s.kind in ("exponent", "order") or s.y_of.size > 1)][:MOST_STUDIES]


def draw_spreads(axes, study):
    """One dot a case for both variants, the yardstick's range behind them."""
    low, high = np.min(study.y_of), np.max(study.y_of)
    axes.axhspan(low, high, color="#e4e4e4", zorder=1, linewidth=0)
    for place, values, color in [(0, study.y, METHOD_COLOR), (1, study.y_of, COLORS[0])]:
        axes.plot(np.full(values.size, place), values, "o", color=color, zorder=3, alpha=0.7,
                  markeredgewidth=0)
        axes.hlines(np.median(values), place - 0.28, place + 0.28, color=color, linewidth=2.2,
                    zorder=4)
    axes.set_xlim(-0.6, 1.6)
    axes.set_xticks([0, 1], ["variant", "yardstick"])
    axes.set_title(drawn_name(study.name))
    axes.set_xlabel(f"distance over half range {interval(study.value, study.low, study.high)}")
    axes.set_ylabel(drawn_name(study.quantity.removeprefix("timing:")))


def draw_study(axes, study):
    if study.y_of.size > 1:
        draw_spreads(axes, study)
        return
    good = (study.x > 0) & (study.y > 0) & np.isfinite(study.x) & np.isfinite(study.y)
    x, y = study.x[good], study.y[good]
    is_time = study.quantity.startswith("timing:")
    size, symbol = scale_for(y, "s") if is_time else (1.0, "")
    axes.loglog(x, y / size, "o", color=COLORS[0], zorder=3)
    if x.size > 1 and math.isfinite(study.value):
        line = np.exp(np.mean(np.log(y / size)) + study.value * (np.log(x) - np.mean(np.log(x))))
        axes.loglog(x, line, "-", color=METHOD_COLOR, linewidth=1.4,
                    label=f"slope {interval(study.value, study.low, study.high)}")
        axes.legend(loc="best", fontsize=8)
    name = study.quantity.removeprefix("timing:")
    axes.set_title(drawn_name(study.name))
    axes.set_ylabel(labelled(f"{drawn_name(name)} time" if is_time else drawn_name(name),
                             symbol))
    axes.grid(True, which="both")


def studies_figure(run):
    studies = studies_with_points(run)
    if not studies:
        return None
    columns = min(3, len(studies))
    rows = math.ceil(len(studies) / columns)
    figure, grid = plt.subplots(rows, columns, figsize=(3.55 * columns, 2.9 * rows), squeeze=False)
    flat = [a for line in grid for a in line]
    for axes, study in zip(flat, studies):
        draw_study(axes, study)
    for axes in flat[len(studies):]:
        axes.set_visible(False)
    figure.tight_layout()
    return figure


def to_svg(figure):
    """Deterministic SVG text: no date, fixed ids, text as paths."""
    out = io.BytesIO()
    figure.savefig(out, format="svg", metadata={"Date": None, "Creator": "geoprior"})
    plt.close(figure)
    return out.getvalue().decode("utf-8")


def figures(run):
    """name: SVG text of every figure that the run has data for: metrics, times, studies."""
    with plt.rc_context(STYLE):
        drawn = [("metrics", curves_figure(run)), ("times", times_figure(run)),
                 ("studies", studies_figure(run))]
        return {name: to_svg(figure) for name, figure in drawn if figure is not None}


def empty_figure():
    with plt.rc_context(STYLE):
        figure = plt.figure(figsize=(4, 1))
        figure.text(0.5, 0.5, "No metric of this run varies over its frames.", ha="center")
        return to_svg(figure)


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("run", help="run folder or its run.h5")
    parser.add_argument("--out", help="SVG file; default: metrics.svg in the run folder")
    runfile.add_force(parser)
    options = parser.parse_args(arguments)
    run = runfile.read_run(options.run, options.force)
    drawn = figures(run)
    target = Path(options.out) if options.out else run.folder / "metrics.svg"
    runfile.write_atomically(target, drawn.get("metrics") or empty_figure())
    for name in ("times", "studies"):
        if name in drawn:
            runfile.write_atomically(target.with_name(f"{name}.svg"), drawn[name])
    return 0


if __name__ == "__main__":
    runfile.run_main(main)
