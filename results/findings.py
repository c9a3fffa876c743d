"""Numbers in what pages say was found: each is written from its source, by a marker (docs/file-formats.md).

In the sections `What was found` and `Results` of all pages a digit stands in a marker or a generated block, in code
that is more than a number (a command, a name, an option), or in the number of a figure, a section or an equation, in a citation, or in a name
such as A4. Any other is bare: nothing notices when it is no longer true.
"""

import re

import citations
from pages import BLOCK, INLINE, PLACEHOLDER, line_of
from prose import blank, without_code

SECTION = re.compile(r"^(?P<level>#+) (?:What was found|Results)\b[^\n]*$", re.MULTILINE)
HEADING = re.compile(r"^(?P<level>#+) ", re.MULTILINE)
REFERENCE = (r"\b(?:[Ff]ig(?:ure|s?\.|ures)|[Tt]hesis|[Ss]ections?|[Ee]q(?:uation|s?\.|uations)|[Cc]hapter|[Tt]ables?)"
             r"[\s(]+\d[\d.]*(?:(?:,| and| to|–) \d[\d.]*)*")
NAMED = r"\b[A-Za-z_][\w^]*\d\w*"  # A4, L2, x0: names that have a digit
CODE = r"`(?!\W*\d[\d.,]*(?:e[+-]?\d+)?[ %]?[^\W\d]{0,4}`)[^`\n]*`"  # but for a number, with a unit perhaps
NO_NUMBERS = [re.compile(pattern, flags) for pattern, flags in (
    (r"<!--.*?-->", re.DOTALL), (CODE, 0), (r"\]\([^)\n]*\)", 0), (r"https?://\S+", 0), (REFERENCE, 0),
    (NAMED, 0))]
TEMPLATE = re.compile(r"^ *<!-- begin: table\n[^\n]*\n(?P<rows>.*?)-->", re.DOTALL | re.MULTILINE)  # below its head
FIRST_CELL = re.compile(r"^\|[^|\n]*", re.MULTILINE)
NUMBER = re.compile(r"\d+(?:[.,]\d+)*")
QUICK = re.compile(r"--quick|\bquick runs?\b")


def sections(text):
    """(start, end) of what was found, up to the next heading that is not below it."""
    for opening in SECTION.finditer(text):
        level = len(opening["level"])
        closing = next((h for h in HEADING.finditer(text, opening.end()) if len(h["level"]) <= level), None)
        yield opening.end(), closing.start() if closing else len(text)


def lines_of(page, text, pattern, prose):
    return [f"{page}:{line_of(text, m.start())}: {m[0]}" for start, end in sections(text)
            for m in pattern.finditer(prose, start, end)]


def with_templates(text):
    """The page with its generated blocks blank, but for what rows of a table's template say beside expressions: behind
    their first cell, which is a name."""
    prose = blank(text, BLOCK)
    for table in TEMPLATE.finditer(text):
        rows = blank(blank(table["rows"], PLACEHOLDER), FIRST_CELL)
        prose = prose[:table.start("rows")] + rows + prose[table.end("rows"):]
    return prose


def bare_numbers(page, text):
    """`page:line: number` of each."""
    prose = with_templates(without_code(text))
    for pattern in (INLINE, *NO_NUMBERS, citations.IN_TEXT):
        prose = blank(prose, pattern)
    return lines_of(page, text, NUMBER, prose)


def of_quick_runs(page, text):
    """Places that speak of quick runs: these are for tests, and no finding is theirs."""
    return lines_of(page, text, QUICK, without_code(text))


def problems(texts):
    """One line for each bare number, and each word about quick runs. `texts`: text by page."""
    return [f"{place}: {mistake}" for page, text in texts.items() for places, mistake in (
        (bare_numbers(page, text), "a bare number, written by nothing (docs/file-formats.md, Markers of pages)"),
        (of_quick_runs(page, text), "of a quick run, which is no finding")) for place in places]
