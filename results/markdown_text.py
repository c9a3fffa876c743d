"""Texts and tables as Markdown (GitHub's)."""

import html
import re

from geoprior_results.texts import printable

# Inside of a word an underscore is none of Markdown's.
MARKS = re.compile(r"[\\`*\[\]|~$#!]|(?<![A-Za-z0-9])_|_(?![A-Za-z0-9])")


def one_line(text):
    return re.sub(r"[\n\t]", " ", printable(str(text)))


def escaped(text):
    """Text of a paragraph or a cell: nothing in it is markup, HTML or the end of a cell, and it is one line. As
    `escaped_markdown` of testbed/runner/comparison/pages.h."""
    return MARKS.sub(r"\\\g<0>", html.escape(one_line(text), quote=False))


def code(text):
    """The text as code, whatever backticks it has."""
    line = one_line(text)
    fence = "`" * (1 + max(map(len, re.findall("`+", line)), default=0))
    blank = " " if "`" in line else ""
    return f"{fence}{blank}{line}{blank}{fence}"


def table(head, rows):
    """Lines of a table whose cells are Markdown; the first column to the left, numbers to the right."""
    lines = ["| " + " | ".join(re.sub(r"(?<!\\)\|", r"\\|", str(cell)) for cell in row) + " |"
             for row in [head, *rows]]
    return [lines[0], "|---" + "|---:" * (len(head) - 1) + "|", *lines[1:]]
