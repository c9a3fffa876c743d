"""Draws spectrogram.png of a run whose variants have a sound (an artifact that is a WAV file): frames,
events and the levels of the sound over one time axis, a block a variant.

    python3 results/spectrogram.py RUN_FOLDER [--out FILE]

`geoprior run` and `geoprior render` add the frames (--frames, --times).
"""

import argparse
import io
import math
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

import plots  # noqa: E402
import runfile  # noqa: E402
import sound  # noqa: E402

MOST_BLOCKS = 6
MOST_KINDS = 8
TICKS_HZ = [50, 100, 200, 500, 1000, 2000, 5000, 10000, 20000]
RANGE_DB = 80
DPI = 200

# Inches.
WIDTH, LEFT, RIGHT, TOP, BOTTOM = 9.5, 0.75, 1.0, 0.12, 0.5
TITLE, LANE, SPECTRUM, TIMES, GAP, LEGEND = 0.26, 0.14, 2.1, 0.2, 0.22, 0.4
HIGHEST_FRAME = 1.6

MOST_COLUMNS, ROWS = round((WIDTH - LEFT - RIGHT) * DPI), round(SPECTRUM * DPI)  # a pixel each


def sounding(case):
    """Variants that have a sound."""
    return [v for v in case.variants if sound.sounds_of(v)]


def chosen_case(run, name):
    """The case of that name, or the first that is shown and has a sound; None without one."""
    cases = [c for c in run.cases if c.name == name] if name else plots.shown_cases(run)
    return next((c for c in cases if sounding(c)), None)


def read_sound(run, variant):
    name, sha256 = sound.sounds_of(variant)[0]
    return sound.read_wav(runfile.read_artifact(run, name, sha256), name)


def kinds_of(variants):
    """The most frequent kinds of events, by name: where two pictures have the same kinds, these have the same colours."""
    counts = {}
    for variant in variants:
        for event in variant.events:
            kind = runfile.text(event["kind"])
            counts[kind] = counts.get(kind, 0) + 1
    return sorted(sorted(counts, key=lambda k: (-counts[k], k))[:MOST_KINDS])


class Block:
    """One variant: its sound and its row of frames."""

    def __init__(self, run, variant, frames):
        self.variant = variant
        self.sound = read_sound(run, variant)
        self.times, self.edges, self.levels = sound.spectrogram(self.sound, ROWS, MOST_COLUMNS)
        self.frames = frames  # pictures side by side, or None

    def shape(self):
        """Height over width of its pictures."""
        return self.frames[0].shape[0] / self.frames[0].shape[1] if self.frames else 0


def cut_frames(picture, rows, columns):
    """rows x columns pictures of one size."""
    height, width = picture.shape[0] // rows, picture.shape[1] // columns
    return [[picture[r * height:(r + 1) * height, c * width:(c + 1) * width] for c in range(columns)]
            for r in range(rows)]


def draw_frames(axes, block, times, width):
    """Each picture above its time; `width` in seconds."""
    for time, picture in zip(times, block.frames):
        axes.imshow(picture, extent=(time - width / 2, time + width / 2, 0, 1), aspect="auto",
                    interpolation="antialiased")
    axes.set_ylim(0, 1)
    axes.set_xticks(times, [f"{t:.3g} s" for t in times])
    axes.tick_params(axis="x", length=4, labelsize=7, pad=1)
    axes.set_yticks([])
    axes.grid(False)
    for side in axes.spines.values():
        side.set_visible(False)


def tick_width(count):
    """Points; thinner in a lane of many events, which come in bursts, down to one pixel."""
    return min(max(0.15 * 72 * (WIDTH - LEFT - RIGHT) / max(count, 1), 72 / DPI), 0.9)


def draw_events(axes, variant, kinds):
    """A lane a kind, a tick an event."""
    for lane, kind in enumerate(kinds):
        times = [e["time_s"] for e in variant.events if runfile.text(e["kind"]) == kind]
        axes.vlines(times, len(kinds) - lane - 0.92, len(kinds) - lane - 0.08,
                    color=plots.COLORS[lane], linewidth=tick_width(len(times)))
    axes.set_ylim(0, len(kinds))
    axes.set_yticks([])
    axes.grid(False)
    axes.tick_params(axis="x", length=0, labelbottom=False)
    axes.spines["bottom"].set_visible(False)
    axes.spines["left"].set_visible(False)


def frequency_label(hertz):
    return f"{hertz / 1000:g} k" if hertz >= 1000 else f"{hertz:g}"


def draw_levels(axes, block, low, high):
    """An axis of log2 of the frequency: matplotlib draws no images on its own logarithmic axes."""
    times, (bottom, top) = block.times, np.log2(block.edges[[0, -1]])
    step = times[1] - times[0] if len(times) > 1 else block.sound.seconds()
    image = axes.imshow(np.maximum(block.levels, low), origin="lower", aspect="auto", cmap="magma",
                        vmin=low, vmax=high, interpolation="antialiased",
                        extent=(times[0], times[-1] + step, bottom, top))
    axes.set_facecolor(plt.get_cmap("magma")(0.0))
    axes.set_ylim(bottom, top)
    shown = [f for f in TICKS_HZ if bottom - 1e-9 <= np.log2(f) <= top + 1e-9]
    axes.set_yticks(np.log2(shown), [frequency_label(f) for f in shown])
    axes.set_ylabel("frequency [Hz]")
    axes.grid(False)
    return image


class Page:
    """Axes from top to bottom, all as wide as the time axis."""

    def __init__(self, time, blocks, kinds):
        self.time = time
        lanes = LANE * len(kinds) + 0.05 if kinds else 0
        self.height = TOP + (LEGEND if kinds else 0) + BOTTOM + sum(
            TITLE + (self.frame_height(b) + TIMES if b.frames else 0) + lanes + SPECTRUM + GAP
            for b in blocks) - GAP
        self.figure = plt.figure(figsize=(WIDTH, self.height))
        self.at = self.height - TOP

    def frame_height(self, block):
        return self.time.picture * self.time.inches * block.shape()

    def add(self, height):
        self.at -= height
        axes = self.figure.add_axes([LEFT / WIDTH, self.at / self.height,
                                     (WIDTH - LEFT - RIGHT) / WIDTH, height / self.height])
        axes.set_xlim(self.time.first, self.time.last)
        return axes

    def skip(self, height):
        self.at -= height

    def text(self, words):
        """One line at the left, in bold."""
        self.at -= TITLE
        self.figure.text(LEFT / WIDTH, (self.at + 0.08) / self.height, words, fontsize=9.5,
                         fontweight="bold", va="bottom")


def add_colour_bar(page, image, first, last):
    """Beside the axes from the first to the last."""
    top, bottom = first.get_position().y1, last.get_position().y0
    axes = page.figure.add_axes([(WIDTH - RIGHT + 0.12) / WIDTH, bottom, 0.14 / WIDTH, top - bottom])
    page.figure.colorbar(image, cax=axes, extend="min")
    axes.set_ylabel("level [dB re full-scale sine]")
    axes.grid(False)


def add_event_legend(page, kinds):
    handles = [plt.Line2D([], [], color=plots.COLORS[i], linewidth=0, marker="|", markersize=9,
                          markeredgewidth=1.6) for i in range(len(kinds))]
    page.figure.legend(handles, [plots.drawn_name(k) for k in kinds], loc="upper left", ncol=len(kinds),
                       bbox_to_anchor=(LEFT / WIDTH, page.at / page.height), borderaxespad=0,
                       title="events", title_fontsize=8, fontsize=8, handlelength=1, columnspacing=1.4,
                       alignment="left", handletextpad=0.3, borderpad=0)
    page.skip(LEGEND)


class TimeAxis:
    """Seconds from left to right: all of the sounds and frames, and the outer pictures whole."""

    def __init__(self, case, blocks, times):
        ends = [b.sound.seconds() for b in blocks]
        if case.parameter_unit == "s":
            ends += [x for b in blocks if b.variant.parameter.size for x in b.variant.parameter[[0, -1]]]
        self.first, self.last = min([0.0, *ends]), max(ends)
        inches = WIDTH - LEFT - RIGHT
        slot = min([*np.diff(times), (self.last - self.first) / 6])
        tallest = max(b.shape() for b in blocks)
        self.picture = min(slot, HIGHEST_FRAME / tallest * (self.last - self.first) / inches) if tallest else 0
        if len(times):
            self.first = min(self.first, times[0] - self.picture / 2)
            self.last = max(self.last, times[-1] + self.picture / 2)
        self.inches = inches / (self.last - self.first)  # a second


def draw_block(page, block, kinds, times, levels):
    """Returns the axes of the levels and their image; `levels` is the range of the colours."""
    page.text(plots.drawn_name(block.variant.name))
    if block.frames:
        draw_frames(page.add(page.frame_height(block)), block, times, page.time.picture)
        page.skip(TIMES)
    if kinds:
        draw_events(page.add(LANE * len(kinds)), block.variant, kinds)
        page.skip(0.05)
    axes = page.add(SPECTRUM)
    return axes, draw_levels(axes, block, *levels)


def colour_range(blocks):
    """One for all variants: the loudest, and RANGE_DB below."""
    loudest = max(b.levels.max() for b in blocks)
    high = 10 * math.ceil(loudest / 10) if loudest > -200 else 0  # silence everywhere
    return high - RANGE_DB, high


def draw(run, case, variants, rows=None, times=()):
    """The figure; `rows` are the frames of each variant at `times` (s)."""
    variants = variants[:MOST_BLOCKS]
    blocks = [Block(run, v, row) for v, row in zip(variants, rows or [None] * len(variants))]
    kinds, levels = kinds_of(variants), colour_range(blocks)
    page = Page(TimeAxis(case, blocks, times), blocks, kinds)
    if kinds:
        add_event_legend(page, kinds)
    drawn = []
    for block in blocks:
        drawn.append(draw_block(page, block, kinds, times, levels))
        page.skip(GAP)
    for axes, _ in drawn[:-1]:
        axes.tick_params(axis="x", labelbottom=False)
    axes, image = drawn[-1]
    axes.set_xlabel("time [s]")
    add_colour_bar(page, image, drawn[0][0], axes)
    return page.figure


def to_png(figure):
    out = io.BytesIO()
    figure.savefig(out, format="png", dpi=DPI, metadata={"Software": None})
    plt.close(figure)
    return out.getvalue()


def picture(run):
    """PNG of the run's first sounds without frames; None when it has none."""
    case = chosen_case(run, "")
    if case is None:
        return None
    names = plots.variants_shown(run)
    variants = [v for v in sounding(case) if v.name in names]
    if not variants:
        return None
    with plt.rc_context(plots.STYLE):
        return to_png(draw(run, case, variants))


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("run", help="run folder or its run.h5")
    parser.add_argument("--out", help="PNG file; default: spectrogram.png in the run folder")
    parser.add_argument("--case", default="", help="default: the first that is shown and has a sound")
    parser.add_argument("--variant", action="append", default=[], help="default: all that have a sound")
    parser.add_argument("--frames", help="PNG of the frames: a row a variant, a column a time")
    parser.add_argument("--times", default="", help="of the columns, in seconds: 0.5,1.5")
    runfile.add_force(parser)
    options = parser.parse_args(arguments)
    run = runfile.read_run(options.run, options.force)
    case = chosen_case(run, options.case)
    variants = [v for v in sounding(case) if not options.variant or v.name in options.variant] if case else []
    if not variants:
        raise runfile.RunFileError(f"{options.run}: no sound: no variant has an artifact that is a WAV file")
    times = [float(t) for t in options.times.split(",")] if options.frames else []
    rows = cut_frames(plt.imread(options.frames), len(variants), len(times)) if options.frames else None
    with plt.rc_context(plots.STYLE):
        drawn = to_png(draw(run, case, variants, rows, times))
    target = Path(options.out) if options.out else run.folder / "spectrogram.png"
    runfile.write_atomically(target, drawn)
    return 0


if __name__ == "__main__":
    runfile.run_main(main)
