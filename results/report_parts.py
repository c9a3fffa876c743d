"""The parts of a run's report, each from the run alone; an empty text where there is nothing."""

import json

import numpy as np

import plots
import runfile
import sound
import spectrogram
from report_html import (MOST_CASES, MOST_LONG_CHARACTERS, MOST_ROWS, MOST_SOUND_BYTES, MOST_SOUNDS, details,
                         escape, image_figure, left_out, player, png_figure, svg_figure, table)
from tables import event_counts, failures, metric_rows, phase_rows, timing_rows
from wording import beside, display_name, interval, labelled, number, outcome_words, unit_symbol, with_unit


def meta_line(run):
    bits = [f"Thesis Figure {escape(run.figure)}"] if run.figure else []
    bits.append(f"experiment <code>{escape(run.experiment_id)}</code>")
    if run.quick:
        bits.append('<span class="badge">quick version</span>')
    bits += [escape(run.provenance[k]) for k in ("start",) if k in run.provenance]
    commit = run.provenance.get("git_commit")
    if commit:
        bits.append(f"commit <code>{escape(commit[:12])}</code>")
    return f'<p class="meta">{" · ".join(bits)}</p>'


def page_cases(run):
    """The cases that the page speaks of."""
    return run.cases[:MOST_CASES]


def cases_left_out(run):
    return left_out(len(run.cases) - MOST_CASES, "cases")


def case_heading(run, case):
    return f"<h3>{escape(case.name)}</h3>" if len(run.cases) > 1 else ""


def claims(run):
    if not run.claims:
        return ""
    badges = {"holds": '<span class="badge good">✓ holds</span>',
              "falls short": '<span class="badge bad">✗ falls short</span>',
              "not told apart": '<span class="badge bad">≈ not told apart</span>'}
    soft = ' <span class="badge">soft</span>'
    items = []
    for claim in run.claims[:MOST_ROWS]:
        case = f' <span class="note">({escape(claim.case)})</span>' if claim.case and len(run.cases) > 1 else ""
        notes = "".join(f'<br><span class="note">{escape(words)}</span>' for words in beside(claim))
        items.append(f"<li><div>{badges[claim.outcome]}{soft if claim.soft else ''}</div><div>{escape(claim.text)}{case}<br>"
                     f"<code>{escape(claim.detail)}</code>{notes}</div></li>")
    return (f"<h2>Claims: {outcome_words(run.claims)}</h2>\n"
            f'<ul class="claims">{"".join(items)}</ul>'
            + left_out(len(run.claims) - MOST_ROWS, "claims"))


def picture(run):
    names = ", ".join(display_name(n) for n in plots.variants_shown(run))
    image = png_figure(run.folder / "figure.png", f"Rendered frames of {names}",
                       f"{escape(names)}: one camera, one light"
                       + (", one colour range." if run.view.get("color_by") else "."))
    return f"<h2>Picture</h2>\n{image}" if image else ""


def spectrogram_figures(run):
    """The pictures that the run has, with its frames; else one without them."""
    caption = ("Events and levels of the sound over time, one range of colours; spectra of 43 ms "
               "below 500 Hz, of 11 ms above 1 kHz.")
    there = [png_figure(path, "Spectrograms below frames", caption)
             for path in [run.folder / "spectrogram.png", *sorted(run.folder.glob("spectrogram-*.png"))]]
    if there[0]:
        return "\n".join(there)
    try:
        drawn = spectrogram.picture(run)
    except sound.NoSound as error:
        return f'<p class="note">No spectrogram: {escape(error)}.</p>'
    return image_figure(drawn, "Spectrograms", caption) if drawn else ""


def sound_details(content, name):
    """Length, rate and channels; nothing of a kind that is not read here."""
    try:
        wav = sound.read_wav(content, name)
    except sound.NoSound:
        return ""
    channels = {1: "mono", 2: "stereo"}.get(wav.samples.shape[1], f"{wav.samples.shape[1]} channels")
    return f", {number(wav.seconds(), counts=False)} s, {wav.rate / 1000:g} kHz, {channels}"


def sound_player(run, case, variant, name, sha256):
    content = runfile.read_artifact(run, name, sha256)
    label = escape(display_name(variant.name)) + (f", {escape(case.name)}" if len(run.cases) > 1 else "")
    if len(content) > MOST_SOUND_BYTES:
        return (f'<p class="note">{label}: {escape(name)} has more than '
                f"{MOST_SOUND_BYTES // 1_000_000} MB: it is in the run's folder.</p>")
    return player(content, f"{label}: <code>{escape(name)}</code>{sound_details(content, name)}.")


def sounds(run):
    found = [(case, v, *stored) for case in page_cases(run) for v in case.variants
             for stored in sound.sounds_of(v)]
    if not found:
        return ""
    players = [sound_player(run, *one) for one in found[:MOST_SOUNDS]]
    more = len(found) - MOST_SOUNDS
    note = f'<p class="note">{more} more sounds are in the run\'s folder.</p>' if more > 0 else ""
    return "\n".join(["<h2>Sound</h2>", spectrogram_figures(run), *players, note])


def not_drawn(run):
    """How many cases and variants the curves leave out, and whether they leave out points."""
    counts = {"further cases": len(run.cases) - len(plots.shown_cases(run)),
              "further variants": len(run.variant_names()) - plots.MOST_VARIANTS}
    texts = [f" {count} {what} are in run.h5." for what, count in counts.items() if count > 0]
    if any(v.parameter.size > plots.MOST_POINTS for c in plots.shown_cases(run) for v in c.variants):
        texts.append(f" Of longer curves at most {plots.MOST_POINTS} points are drawn.")
    return "".join(texts)


def curves(run):
    with plots.plt.rc_context(plots.STYLE):
        drawn = plots.curves_figure(run)
        if drawn is None:
            return ""
        svg = plots.to_svg(drawn)
    case = run.cases[0]
    names = ", ".join(display_name(m).lower() for m in plots.frame_metrics(run))
    caption = f"Metrics over {escape(case.parameter_name)}; one line a variant." + not_drawn(run)
    return "<h2>Metrics over the frames</h2>\n" + svg_figure(svg, f"Curves of {names}", caption)


def definitions(rows):
    return details("What is measured", table(
        [], [[f"<strong>{escape(r.label())}</strong>",
              escape(r.definition) + f' <span class="note">({escape(r.direction.replace("_", " "))})'
              "</span>"] for r in rows], ["text", "text wrap"]))


def marked(row):
    return [f"<b>{escape(c)}</b>" if best else escape(c) for c, best in zip(row.cells, row.best)]


def metrics(run):
    blocks, rows = [], []
    for case in page_cases(run):
        rows = metric_rows(case)
        if not rows:
            continue
        head = ["Metric"] + [escape(display_name(v.name)) for v in case.variants]
        blocks += [case_heading(run, case),
                   table(head, [[escape(r.label()), *marked(r)] for r in rows])]
    if not blocks:
        return ""
    note = '<p class="note">Worst value over the frames where a metric has a better side; the best ' \
        "variant of a line is <b>bold</b>.</p>"
    return "\n".join(["<h2>Metrics</h2>", note, *blocks, cases_left_out(run), definitions(rows)])


def ratio_text(row):
    return "<br>".join(f"{interval(r.median, r.low, r.high)} × {escape(display_name(r.of))}"
                       + (" (whole runs)" if r.paired == "run" else "") for r in row.ratios)


def time_cells(times):
    return [with_unit(times.median, "s"), with_unit(times.p95, "s"),
            f"{with_unit(times.low, 's')} … {with_unit(times.high, 's')}"]


def times_over_frames(run):
    with plots.plt.rc_context(plots.STYLE):
        drawn = plots.times_figure(run)
        if drawn is None:
            return ""
        svg = plots.to_svg(drawn)
    case = plots.timed_case(run)
    of = f" Case {escape(case.name)}." if len(run.cases) > 1 else ""
    return svg_figure(svg, "Times of frames by phase", "Time of each frame (median of the "
                      f"repetitions, logarithmic) over {escape(case.parameter_name)}: all variants, "
                      f"then each with the phases inside.{of}")


def timing(run):
    blocks = []
    for case in page_cases(run):
        rows = timing_rows(case)
        if not rows:
            continue
        with_whole = any(np.isfinite(r.whole) for r in rows)
        with_memory = any(np.isfinite(r.memory) for r in rows)
        head = ["Variant", "Phase", "Median", "p95", "Quartiles", "Samples",
                *(["Whole run"] if with_whole else []), "Prepare",
                *(["Peak memory"] if with_memory else []), "Ratio of times [95 % interval]"]
        body = [[escape(r.variant), escape(r.phase), *time_cells(r.times), str(r.count),
                 *([with_unit(r.whole, "s")] if with_whole else []), with_unit(r.prepare, "s"),
                 *([with_unit(r.memory, "B")] if with_memory else []),
                 ratio_text(r)] for r in rows]
        blocks += [case_heading(run, case), table(head, body, ["text", "text"])]
        inside = [[escape(v), escape(p), *time_cells(times)] for v, p, times in phase_rows(case)]
        if inside:
            blocks.append(details("Phases inside", table(
                ["Variant", "Phase", "Median", "p95", "Quartiles"], inside, ["text", "text"])))
    if not blocks:
        return ""
    cpu = run.provenance.get("cpu", "")
    threads = {c.threads for c in run.cases}
    note = f'<p class="note">{escape(cpu)}{", " if cpu else ""}threads: ' \
        f'{", ".join("all" if t == 0 else str(t) for t in sorted(threads))}. Methods interleaved, ' \
        "recording excluded; a ratio is the median of paired ratios. Peak memory is that of one run " \
        "on top of what was resident before it, recording and measuring included.</p>"
    return "\n".join(["<h2>Times</h2>", note, times_over_frames(run), *blocks, cases_left_out(run)])


def studies(run):
    if not run.studies:
        return ""
    with plots.plt.rc_context(plots.STYLE):
        drawn = plots.studies_figure(run)
        image = "" if drawn is None else svg_figure(
            plots.to_svg(drawn), "Plots of the studies",
            "Slopes: both axes logarithmic, the line has the fitted slope. Spreads: one dot a case, "
            "medians as bars, the range of the variant compared with in grey."
            + (f" Drawn are at most {plots.MOST_STUDIES} studies."
               if len(run.studies) > plots.MOST_STUDIES else ""))
    rows = [[escape(display_name(s.name)), escape(s.kind), f"<code>{escape(s.quantity)}</code>",
             interval(s.value, s.low, s.high)] for s in run.studies]
    head = ["Study", "Kind", "Quantity", "Value [95 % interval]"]
    return "\n".join(["<h2>Studies</h2>", image, table(head, rows, ["text", "text", "text"])])


def diagnostics(run):
    blocks = []
    for case in page_cases(run):
        rows = []
        for variant in case.variants:
            for name, diagnostic in variant.diagnostics.items():
                finite = diagnostic.values[np.isfinite(diagnostic.values)]
                label = labelled(display_name(name), unit_symbol(diagnostic.unit))
                if finite.size:
                    rows.append([escape(display_name(variant.name)),
                                 f'<span title="{escape(diagnostic.definition)}">{escape(label)}</span>',
                                 *(number(float(f(finite))) for f in (np.min, np.median, np.max))])
        if rows:
            blocks += [case_heading(run, case),
                       table(["Variant", "Diagnostic", "Least", "Median", "Greatest"], rows,
                             ["text", "text"])]
    return "\n".join(["<h2>Diagnostics</h2>", '<p class="note">What only the method itself can '
                      "know.</p>", *blocks]) if blocks else ""


def events(run):
    rows = [[escape(case.name), escape(display_name(v.name)), escape(kind), number(float(count))]
            for case in page_cases(run) for v in case.variants
            for kind, count in event_counts(v).items()]
    if not rows:
        return ""
    return "<h2>Events</h2>\n" + table(["Case", "Variant", "Kind", "Count"], rows, ["text"] * 3)


def warnings(run):
    found = [*failures(run), *dict.fromkeys(w for case in run.cases for w in case.warnings)]
    lines = "".join(f'<p class="warning">{escape(w)}</p>' for w in found[:MOST_ROWS])
    more = left_out(len(found) - MOST_ROWS, "warnings")
    return f"<h2>Warnings</h2>\n{lines}{more}" if lines else ""


def rerun(run):
    quick = " --quick" if run.quick else ""
    return ("<h2>Run it again</h2>\n"
            f"<pre>geoprior run {escape(run.experiment_id)}{quick}</pre>\n"
            f'<p class="note">Equal frames and metrics give the same <code>content_sha256</code>: '
            f"<code>{escape(run.content_sha256)}</code>. The run's folder: "
            f"<code>{escape(run.folder.name)}</code>.</p>")


def facts(run):
    rows = [[escape(case.name), *(f"{escape(display_name(k))} {number(v)}" for k, v in
                                  case.facts.items())] for case in run.cases if case.facts]
    width = max((len(r) for r in rows), default=0)
    rows = [r + [""] * (width - len(r)) for r in rows]
    return details("Scene facts", table([], rows)) if rows else ""


def options(run):
    seen, rows = set(), []
    for case in page_cases(run):
        for v in case.variants:
            text = json.dumps(v.options, indent=1, ensure_ascii=False)
            if (v.name, text) not in seen:
                seen.add((v.name, text))
                rows.append(f"<h3>{escape(display_name(v.name))} "
                            f'<span class="note">{escape(v.method)}, {escape(v.role)}</span></h3>'
                            f"<pre>{escape(text, MOST_LONG_CHARACTERS)}</pre>")
    more = left_out(len(rows) - MOST_ROWS, "variants")
    return details("Options of every variant", "\n".join([*rows[:MOST_ROWS], more])) if rows else ""


def provenance(run):
    inputs = table(["Input", "SHA-256"], [[escape(n), escape(s)] for n, s in run.inputs],
                   ["text", "text hash"]) if run.inputs else ""
    rows = [[escape(k.replace("_", " ")), escape(v)] for k, v in run.provenance.items()]
    rows.append(["specification hash", f"<code>{escape(run.spec_hash)}</code>"])
    return "\n".join(b for b in [
        "<h2>Provenance</h2>", inputs, facts(run), options(run),
        details("Program and machine", table([], rows, ["text", "text wrap"])),
        details("The experiment as it ran", f"<pre>{escape(run.experiment, MOST_LONG_CHARACTERS)}</pre>")] if b)


def comparison_table(name, runs):
    """One variant in several runs: a column a run."""
    by_run = [{r.label(): r.cells[[v.name for v in run.cases[0].variants].index(name)]
               for r in metric_rows(run.cases[0])} for run in runs]
    labels = dict.fromkeys(label for found in by_run for label in found)
    rows = [[escape(label), *(escape(found.get(label, "–")) for found in by_run)]
            for label in labels if sum(label in found for found in by_run) > 1]
    times = []
    for run in runs:
        found = [t.times.median for t in timing_rows(run.cases[0]) if t.variant == display_name(name)]
        times.append(with_unit(found[0], "s") if found else "–")
    rows.append(["Median time", *times])
    return table(["Metric", *(escape(run.experiment_id) for run in runs)], rows)
