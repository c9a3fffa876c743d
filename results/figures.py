"""Keeps the numbers of the pages equal to the published records (docs/file-formats.md).

    python3 results/figures.py                        writes what stands between the markers of all pages
    python3 results/figures.py --check                exit code 1 where a page differs from its source, a citation
                                                      from docs/references.bib, or a finding is written by nothing
    python3 results/figures.py --publish RUN_FOLDER…  first makes the records of these runs anew, and their pictures
    python3 results/figures.py --prune                first takes out of all records what their files no longer claim

Pages are README.md and docs/**/*.md. A record holds what the pages quote of its run: a new quantity on a page
needs `--publish` of a run of that experiment. A claim whose sentence is no longer in the experiment file is left out.
"""

import argparse
import json
import sys
from pathlib import Path

import citations
import claimed
import cost_control
import error_time
import findings
import pages
import pictures
import records
import runfile

REPOSITORY = Path(__file__).resolve().parents[1]


def page_files(root):
    return sorted([*root.glob("README.md"), *root.glob("docs/**/*.md")])


def page_texts(root):
    """name of the page: its text."""
    return {str(path.relative_to(root)): path.read_text(encoding="utf-8") for path in page_files(root)}


def publish(root, run_folders):
    """Makes the records of the runs anew, with what the pages quote of them, and the pictures that pages show."""
    texts = page_texts(root)
    wanted = [quote for page, text in texts.items() for quote in pages.quoted(page, text)]
    for folder in run_folders:
        run = runfile.read_run(folder, claims_cases=True)
        quotes = {(variant, quantity) for experiment, variant, quantity in wanted if experiment == run.experiment_id}
        print(records.write_record(root, claimed.standing(records.record_of(run, quotes), root)))
        for path in pictures.publish(run, texts, root):
            print(path)


def prune(root):
    """Takes the claims that were struck from experiment files out of their records; other records stay as they are."""
    for experiment in records.read_records(root):
        data = json.loads(records.record_path(root, experiment).read_text(encoding="utf-8"))
        standing = claimed.standing(data, root)
        if standing != data:
            print(records.write_record(root, standing))


def unshown(texts, published):
    """One line for every record that no page names: the overview names all of them."""
    blocks = [marker.source for page, text in texts.items() for marker in pages.markers_of(page, text) if marker.block]
    shown = {source.partition(" ")[2] for source in blocks if source != "overview"}
    return [] if "overview" in blocks else [f"{name}: published, but no page has an overview or a block of it"
                                            for name in published if name not in shown]


def check(root):
    texts, sources = page_texts(root), pages.read_sources(root)
    found = [line for page, text in texts.items() for line in pages.differences(page, text, sources)]
    found += unshown(texts, sources.records) + pictures.problems(texts, sources.records, root)
    found += error_time.problems(root, sources.records) + cost_control.problems(root, sources.records)
    found += citations.problems(root) + findings.problems(texts)
    print(*found, sep="\n", end="\n" if found else "", file=sys.stderr)
    return 1 if found else 0


def rewrite(root):
    sources = pages.read_sources(root)
    for page, text in page_texts(root).items():
        made = pages.rewritten(page, text, sources)
        if made != text:
            runfile.write_atomically(root / page, made)
            print(page)
    for path in [*error_time.write(root, sources.records), *cost_control.write(root, sources.records)]:
        print(path)
    return 0


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="only say what differs")
    parser.add_argument("--publish", nargs="+", default=[], metavar="RUN_FOLDER", help="runs to make records of")
    parser.add_argument("--prune", action="store_true", help="take struck claims out of the records")
    parser.add_argument("--root", type=Path, default=REPOSITORY, help="the repository (default: this one)")
    chosen = parser.parse_args(arguments)
    if chosen.publish:
        publish(chosen.root, chosen.publish)
    if chosen.prune:
        prune(chosen.root)
    return check(chosen.root) if chosen.check else rewrite(chosen.root)


if __name__ == "__main__":
    runfile.run_main(main)
