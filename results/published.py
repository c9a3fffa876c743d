"""Writes one self-contained HTML page of all that the published records say, without a run.

    python3 results/published.py [--root FOLDER] [--out FILE]
"""

import argparse
import os
from pathlib import Path

import records
import report_parts as parts
import runfile
from report_html import MOST_ROWS, details, escape, left_out, page, table
from wording import all_told, display_name, interval, number, outcome_words, unit_symbol, with_unit

REPOSITORY = Path(__file__).resolve().parents[1]
MOST_OPEN_CASES = 4  # of an experiment; the times of further ones are folded


def verdict(record):
    if not record.claims:
        return "no claims"
    mood = "good" if all_told(record.claims) else "bad"
    return f'<span class="badge {mood}">{record.claim_words()}</span>'


def contents(published):
    rows = [[f'<a href="#{escape(r.experiment_id)}">{escape(r.experiment_id)}</a>', escape(r.title),
             escape(r.figure or "–"), verdict(r)] for r in published]
    return table(["Experiment", "What", "Figure", "Result"], rows, ["text", "text wrap", "text", "text"])


def size_words(record):
    """`14,128 vertices`, or the triangles as the record has them."""
    return f"{record.sizes} vertices" if record.sizes[:1].isdigit() else record.sizes


def meta_line(record):
    bits = [f"Thesis Figure {escape(record.figure)}"] if record.figure else []
    bits += [f"<code>{escape(record.command)}</code>", escape(size_words(record)), escape(record.processor),
             f"commit <code>{escape(record.commit[:12])}</code>",
             f"<code>content_sha256</code> <code>{escape(record.content_sha256)}</code>"]
    return f'<p class="meta">{" · ".join(bit for bit in bits if bit)}</p>'


def failures(record):
    return "".join(f'<p class="warning">{escape(line)}</p>' for line in record.failures)


def studies(record):
    rows = [[escape(s.name), escape(s.kind), f"<code>{escape(s.quantity)}</code>", interval(s.value, s.low, s.high)]
            for s in record.studies]
    head = ["Study", "Kind", "Quantity", "Value [95 % interval]"]
    return f"<h3>Studies</h3>\n{table(head, rows, ['text'] * 3)}" if rows else ""


def times_of_case(record, case):
    rows = record.timing_rows(case)
    body = [[escape(r.variant), escape(r.phase), *parts.time_cells(r.times), with_unit(r.whole, "s"),
             with_unit(r.prepare, "s"), with_unit(r.memory, "B"), parts.ratio_text(r)] for r in rows]
    head = ["Variant", "Phase", "Median", "p95", "Quartiles", "Whole run", "Prepare", "Peak memory", "Ratio [95 %]"]
    return table(head, body, ["text", "text"]) if body else ""


def times(record):
    """A table a case; where there are many, the first one and the others folded."""
    found = {case: times_of_case(record, case) for case in record.cases}
    blocks = [(f"<h4>{escape(case)}</h4>" if len(record.cases) > 1 else "") + made
              for case, made in found.items() if made]
    if not blocks:
        return ""
    if len(blocks) > MOST_OPEN_CASES:
        blocks = [blocks[0], details(f"Times of {len(blocks) - 1} further cases", "\n".join(blocks[1:]))]
    return "\n".join(["<h3>Times</h3>", *blocks])


def quoted_cell(record, value, quantity):
    unit = unit_symbol(record.units[quantity])
    return "–" if value is None else number(value, digits=4) + (f" {unit}" if unit else "")


def quoted_values(record):
    """What the pages quote of the run: a table a case, a line a quantity, a column a variant."""
    blocks = []
    for case, variants in record.values.items():
        quantities = list(dict.fromkeys(quantity for values in variants.values() for quantity in values))
        rows = [[f"<code>{escape(quantity)}</code>",
                 *(quoted_cell(record, values.get(quantity), quantity) for values in variants.values())]
                for quantity in quantities]
        head = ["Quantity", *(escape(display_name(variant)) for variant in variants)]
        blocks.append((f"<h4>{escape(case)}</h4>" if len(record.cases) > 1 else "") + table(head, rows))
    return details("Values that pages quote", "\n".join(blocks)) if blocks else ""


def claims(record):
    """As in the report of a run, one level of headings deeper."""
    return parts.claims(record).replace("<h2>", "<h3>").replace("</h2>", "</h3>")


def section(record):
    """Everything that a record says of its experiment."""
    heading = f"{escape(record.experiment_id)}: {escape(record.title)}"
    body = [f'<section class="run" id="{escape(record.experiment_id)}">', f"<h2>{heading}</h2>", meta_line(record),
            failures(record), claims(record), studies(record), times(record), quoted_values(record), "</section>"]
    return "\n".join(block for block in body if block)


def section_of_file(path, record):
    try:
        return section(record)
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        raise runfile.RunFileError(f"{path}: not a published record ({type(error).__name__}: {error})") from error


def build(root):
    """The page of all records below the repository `root`. Raises RunFileError with one line that names a file."""
    published = records.read_records(root)
    if not published:
        raise runfile.RunFileError(f"{records.published_folder(root)}: no published records")
    sections = [section_of_file(records.record_path(root, name), record) for name, record in published.items()]
    claims_of_all = [claim for record in published.values() for claim in record.claims]
    note = ('<p class="note">Full runs, as their records in <code>results/published</code> have them. A claim that '
            "falls short is a finding, explained on the method's page in <code>docs/methods</code>. Times compare "
            "within a run: the machines are shared.</p>")
    return page("geoprior: published numbers", "\n".join([
        f"<h1>Published numbers, {len(published)} experiments: {outcome_words(claims_of_all)}</h1>", note,
        contents(list(published.values())), left_out(len(published) - MOST_ROWS, "experiments"), *sections]))


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--root", type=Path, default=REPOSITORY, help="the repository (default: this one)")
    parser.add_argument("--out", help="default: results/runs/published.html")
    options = parser.parse_args(arguments)
    runs = Path(os.environ.get("GEOPRIOR_RUNS") or options.root / "results" / "runs")
    target = Path(options.out) if options.out else runs / "published.html"
    runfile.write_atomically(target, build(options.root))
    if not options.out:
        print(target)
    return 0


if __name__ == "__main__":
    runfile.run_main(main)
