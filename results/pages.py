"""Pages whose numbers are generated: their markers found, checked and rewritten (docs/file-formats.md).

    <!--= EXPRESSION -->1.3 %<!-- -->                        a number in prose, of a record (expressions.py), of an
                                                             experiment file, or quoted (settings.py)
    <!-- begin: KIND … --> … <!-- end -->                    lines that are generated

KIND is `overview`, `headline ID`, `claims ID`, `times ID[@CASE]`, `figure ID [FILE…]`, `options TOPIC`, `replicability`,
`cost-control`, or `table` followed by the rows of a table whose cells have {EXPRESSION} in the place of numbers.
"""

import json
import re
import tomllib
from dataclasses import dataclass
from pathlib import Path

import cost_control
import expressions
import replicability
import settings
from expressions import ExpressionError
from markdown_text import table
from prose import without_code
from runfile import RunFileError
from records import Record, read_records
from summary import claim_list, timing_table
from wording import all_told, clock_words, outcome_words

INLINE = re.compile(r"<!--= (?P<source>.*?) -->(?P<shown>.*?)<!-- -->")
BLOCK = re.compile(r"^(?P<pad> *)<!-- begin: (?P<source>.*?)\s*-->\n(?P<shown>.*?)^ *<!-- end -->",
                   re.DOTALL | re.MULTILINE)
PLACEHOLDER = re.compile(r"\{([^{}]*)\}")
MOST_HEADLINES = 4  # claims of an experiment below its figure; those that fall short are shown all


@dataclass
class Sources:
    """What the pages are made from: published records, by experiment, and the experiment files below the root."""
    root: Path
    records: dict[str, Record]


def read_sources(root):
    return Sources(Path(root), read_records(root))


class PageError(RunFileError):
    """A marker that cannot be understood; the message begins with page and line."""


@dataclass
class Marker:
    line: int
    start: int   # of what is shown, in the page
    source: str  # the expression, or kind and arguments of a block
    shown: str
    block: bool
    pad: str = ""

    def of_record(self):
        return self.block or not self.source.startswith(settings.KINDS)

    def name(self):
        return f"block '{self.source.splitlines()[0]}'" if self.block else f"number '{self.source}'"


# What blocks show


def figure_index(records):
    rows = []
    for record in records.values():
        rows.append([f"`{record.experiment_id}`", record.figure or "–", record.sizes,
                     record.claim_words(),
                     f"`{record.content_sha256[:12]}`", f"`{record.commit[:12]}`"])
    return table(["experiment", "figure", "vertices or triangles", "result", "content_sha256", "commit"], rows)


def times_lines(record, case):
    lines = timing_table(record.timing_rows(case))
    return [*lines[1:], "", f"Processor: {record.processor}."] if lines else []


def timed(words, claim, record):
    """The words; of a time with its interval and the processor that it was taken on."""
    clock = clock_words(claim)
    return f"{words}: {clock}, on {record.processor}" if clock else words


def measured(claims, record):
    """`0.0384 <= 0.04 (10 of 10 seeds)`, of the first claim that falls short, or the first; and what one and the
    same claim comes to in its cases."""
    shown = next((c for c in claims if not c.holds), claims[0])
    numbers = shown.detail.rpartition(": ")[2]
    seeds = re.match(r"\d+ of \d+ seeds?", shown.detail)
    verdict = outcome_words(claims)
    return [f"`{numbers}`" + (f" ({seeds[0]})" if seeds else ""),
            timed(verdict if all_told(claims) else f"**{verdict}**", shown, record)]


def headline(record):
    """Title, command and verdict, and a small table of claims: first of all those that fall short or are not told
    apart somewhere, then those whose null fails them, then the others."""
    by_text = {}
    for claim in record.claims:
        by_text.setdefault(claim.text, []).append(claim)
    short = [text for text, claims in by_text.items() if not all_told(claims)]
    rank = {text: (text not in short, claims[0].null_verdict != "discriminates") for text, claims in by_text.items()}
    chosen = sorted(by_text, key=rank.get)[:max(MOST_HEADLINES, len(short))]
    rows = [[text, *measured(claims, record)] for text, claims in by_text.items() if text in chosen]
    return ["", f"*{record.title}.* `{record.command}`: {record.claim_words()}.", "",
            *(table(["claim", "measured", "comes to"], rows) if rows else []), ""]


def caption(record):
    """Title, command and verdict, as they stand below a picture."""
    verdict = record.claim_words()
    for outcome in ("falls short", "not told apart"):
        missed = {}
        for claim in record.claims:
            if claim.outcome == outcome:
                missed.setdefault(claim.text, timed(claim.text, claim, record))
        verdict += f". {outcome.capitalize()}: {'; '.join(missed.values())}" if missed else ""
    return ["", f"*{record.title}.* `{record.command}`: {verdict}.", ""]


def flat_options(options, prefix=""):
    """`stepper.plasticity = false`, one text an option."""
    out = []
    for name, value in options.items():
        nested = isinstance(value, dict)
        out += flat_options(value, f"{prefix}{name}.") if nested else [f"`{prefix}{name} = {json.dumps(value)}`"]
    return out


def option_rows(sources, topic):
    """What the experiments set by hand instead of a method's defaults; null controls show nothing, and options*.toml
    turns every option, one at a time."""
    rows = []
    for path in sorted((sources.root / "experiments" / topic).glob("*.toml")):
        if path.stem.startswith("options"):
            continue
        spec = tomllib.loads(path.read_text(encoding="utf-8"))
        rows += [[f"`{path.stem}`", spec.get("figure") or "–", variant["name"],
                  ", ".join(flat_options(variant["options"]))]
                 for variant in spec.get("variant", []) if variant.get("options") and variant.get("role") != "null"]
    if not rows:
        raise ExpressionError(f"no experiment of topic '{topic}' sets options")
    return ["| experiment | figure | variant | options set by hand |", "|---|---|---|---|",
            *("| " + " | ".join(row) + " |" for row in rows)]


def filled_table(template, records):
    """The rows of a template, with values in the place of {EXPRESSION}."""
    rows = []
    for line in template:
        filled = PLACEHOLDER.sub(lambda m: expressions.evaluate(m[1], records), line)
        rows.append([cell.strip() for cell in filled.strip().strip("|").split("|")])
    if not rows or any(len(row) != len(rows[0]) for row in rows):
        raise ExpressionError("a table needs a head and rows of as many cells")
    return table(rows[0], rows[1:])


def times_of_place(place, records):
    term = expressions.parse_term([place])
    record = expressions.record_named(records, term.experiment)
    return times_lines(record, *expressions.cases_of(record, term))


def own_claims(record):
    """Of an experiment of the repository, whose texts are its own: they stand as they are written."""
    return claim_list(record, str)


def block_lines(source, sources):
    """The lines that a block should have. Raises ExpressionError."""
    first, *template = source.splitlines()
    kind, _, argument = first.partition(" ")
    if template and kind != "table":
        raise ExpressionError(f"a block of kind '{kind}' has one line")
    of_record = {"headline": headline, "claims": own_claims, "figure": caption}
    if kind == "figure":  # behind the identifier, the files of the run that the pictures are
        argument = argument.partition(" ")[0]
    if kind in of_record:
        return of_record[kind](expressions.record_named(sources.records, argument))
    match kind, bool(argument):
        case "table", False:
            return filled_table(template, sources.records)
        case "overview", False:
            return figure_index(sources.records)
        case "times", True:
            return times_of_place(argument, sources.records)
        case "options", True:
            return option_rows(sources, argument)
        case "replicability", False:
            return replicability.lines(sources.records, sources.root)
        case "cost-control", False:
            return cost_control.lines(sources.records)
    raise ExpressionError(f"unknown block '{first}' (there are overview, headline ID, claims ID, "
                          "times ID[@CASE], figure ID, options TOPIC, replicability, cost-control, table)")


# Pages


def line_of(text, position):
    return text.count("\n", 0, position) + 1


def matches(text):
    """The blocks of a page and the numbers between them, in their order."""
    blocks = list(BLOCK.finditer(text))
    numbers = [m for m in INLINE.finditer(text)
               if not any(b.start() <= m.start() < b.end() for b in blocks)]
    return sorted([*blocks, *numbers], key=lambda m: m.start())


def markers_of(page, text):
    """All markers of a page in their order. Raises PageError where one is not closed."""
    text = without_code(text)
    found = matches(text)
    starts = {m.start() for m in found}
    for opening in re.finditer(r"<!--=|^ *<!-- begin:", text, re.MULTILINE):
        if opening.start() not in starts:
            raise PageError(f"{page}:{line_of(text, opening.start())}: a marker that is not closed on its line, "
                            "or inside another")
    for first in re.finditer(r"^\s*<!--=", text, re.MULTILINE):  # Markdown would show the whole line as it is
        raise PageError(f"{page}:{line_of(text, first.end())}: a number may not begin a line")
    closings = [m.start() for m in re.finditer(r"<!-- end -->|<!-- -->", text)]
    for closing in closings:
        if not any(m.start() < closing < m.end() for m in found):
            raise PageError(f"{page}:{line_of(text, closing)}: a closing marker without an opening one")
    if len(closings) != len(found):
        raise PageError(f"{page}: {len(closings)} closing markers for {len(found)} openings")
    return [Marker(line_of(text, m.start()), m.start("shown"), m["source"], m["shown"], m.re is BLOCK,
                   m["pad"] if m.re is BLOCK else "") for m in found]


def number_of(marker, sources):
    """Of a record, of an experiment file, or, quoted, what stands there."""
    if marker.of_record():
        return expressions.evaluate(marker.source, sources.records)
    if marker.source.startswith(settings.QUOTED):
        settings.require_source(marker.source, sources.root)
        return marker.shown
    return settings.setting(marker.source, sources.root)


def content_of(page, marker, sources):
    """What should stand between the two comments of a marker. Raises PageError."""
    try:
        if not marker.block:
            return number_of(marker, sources)
        return "".join(f"{marker.pad}{line}\n" if line else "\n" for text in block_lines(marker.source, sources)
                       for line in text.split("\n"))
    except ExpressionError as error:
        raise PageError(f"{page}:{marker.line}: {marker.name()}: {error}") from error


def first_difference(shown, wanted):
    """The two lines where a block first differs."""
    pairs = zip(shown.splitlines() + [""], wanted.splitlines() + [""])
    return next(((a, b) for a, b in pairs if a != b), ("", "more or fewer lines"))


def differences(page, text, sources):
    """One line for every marker whose content differs from its source."""
    out = []
    for marker in markers_of(page, text):
        wanted = content_of(page, marker, sources)
        if wanted != marker.shown:
            shows, gives = first_difference(marker.shown, wanted)
            out.append(f"{page}:{marker.line}: {marker.name()} shows '{shows}', its source gives '{gives}'")
    return out


def rewritten(page, text, sources):
    """The page with the content of every marker made anew."""
    for marker in reversed(markers_of(page, text)):
        end = marker.start + len(marker.shown)
        text = text[:marker.start] + content_of(page, marker, sources) + text[end:]
    return text


def quoted(page, text):
    """(experiment, variant, quantity) of all markers of a page, those of its tables too."""
    out = []
    for marker in markers_of(page, text):
        try:
            for source in PLACEHOLDER.findall(marker.source) if marker.block else [marker.source]:
                if marker.of_record():
                    out += expressions.quoted(source)
        except ExpressionError as error:
            raise PageError(f"{page}:{marker.line}: {marker.name()}: {error}") from error
    return out


def pictures_of(text):
    """The relative targets of the pictures that a page shows."""
    return [target for target in re.findall(r"!\[[^]]*\]\(([^)]+)\)", text) if "://" not in target]
