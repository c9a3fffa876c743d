"""Pictures drawn from published records: each holds a digest of what it shows, so that a check sees when it is old."""

import argparse
from pathlib import Path

import records

REPOSITORY = Path(__file__).resolve().parents[1]


def marked(svg, digest):
    """The SVG with a comment that holds the digest."""
    return svg.replace("<svg ", f"<!-- data {digest} -->\n<svg ", 1)


def shows(path, digest):
    return path.is_file() and f"<!-- data {digest} -->" in path.read_text(encoding="utf-8")


def command(doc, write, arguments):
    """What a script of such pictures does: draws those that are old, by `write(root, published)`, and prints their paths."""
    parser = argparse.ArgumentParser(description=doc.splitlines()[0])
    parser.add_argument("--root", type=Path, default=REPOSITORY, help="the repository (default: this one)")
    options = parser.parse_args(arguments)
    for path in write(options.root, records.read_records(options.root)):
        print(path)
    return 0
