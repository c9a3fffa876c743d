"""Numbers in what pages say was found: each is written from its source, by a marker (docs/file-formats.md).

In the sections `What was found` and `Results` of all pages a digit stands in a marker or a generated block, in code
(a command, a name, an option), or in the number of a figure, a section or an equation, in a citation, or in a name
such as A4. Any other is bare: nothing notices when it is no longer true.
"""

import re

import citations
from pages import BLOCK, INLINE, PLACEHOLDER, line_of, without_code

SECTION = re.compile(r"^(?P<level>#+) (?:What was found|Results)\b[^\n]*$", re.MULTILINE)
HEADING = re.compile(r"^(?P<level>#+) ", re.MULTILINE)
REFERENCE = (r"\b(?:[Ff]ig(?:ure|s?\.|ures)|[Tt]hesis|[Ss]ections?|[Ee]q(?:uation|s?\.|uations)|[Cc]hapter|[Tt]ables?)"
             r"[\s(]+\d[\d.]*(?:(?:,| and| to|–) \d[\d.]*)*")
NAMED = r"\b[A-Za-z_][\w^]*\d\w*"  # A4, L2, x0: names that have a digit
NO_NUMBERS = [re.compile(pattern, flags) for pattern, flags in (
    (r"<!--.*?-->", re.DOTALL), (r"`[^`\n]*`", 0), (r"\]\([^)\n]*\)", 0), (r"https?://\S+", 0), (REFERENCE, 0),
    (NAMED, 0))]
NUMBER = re.compile(r"\d+(?:[.,]\d+)*")
QUICK = re.compile(r"--quick|\bquick runs?\b")


def blank(text, pattern):
    """The text with what matches blank, every other character where it was."""
    return pattern.sub(lambda m: re.sub(r"[^\n]", " ", m[0]), text)


def sections(text):
    """(start, end) of what was found, up to the next heading that is not below it."""
    for opening in SECTION.finditer(text):
        level = len(opening["level"])
        closing = next((h for h in HEADING.finditer(text, opening.end()) if len(h["level"]) <= level), None)
        yield opening.end(), closing.start() if closing else len(text)


def lines_of(page, text, pattern, prose):
    return [f"{page}:{line_of(text, m.start())}: {m[0]}" for start, end in sections(text)
            for m in pattern.finditer(prose, start, end)]


def without_tables(text):
    """The page with its generated blocks blank, but for what rows of a table's template say beside expressions:
    behind the first cell that is no name."""
    def shown(match):
        if not match["source"].startswith("table\n"):
            return re.sub(r"[^\n]", " ", match[0])
        start = match.start("source") - match.start()
        lines = PLACEHOLDER.sub(lambda m: " " * len(m[0]), match["source"]).split("\n")
        for i, line in enumerate(lines):
            bar = line.find("|", 1) if i > 1 else len(line)
            lines[i] = " " * bar + line[bar:]
        rest = re.sub(r"[^\n]", " ", match[0])
        kept = "\n".join(lines)
        return rest[:start] + kept + rest[start + len(kept):]
    return BLOCK.sub(shown, text)


def bare_numbers(page, text):
    """`page:line: number` of each."""
    prose = without_tables(without_code(text))
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
