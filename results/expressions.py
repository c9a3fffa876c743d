"""The expressions of page markers (docs/file-formats.md), evaluated on published records.

    paper/bend hybrid isometry_rms.max                          a metric of a variant
    skinning/scaling@18k,threads=2 implicit time.median         … of a case
    paper/dense-adaptive-hybrid@median(*) dense dcone_count.last   … over the cases that match
    paper/bend hybrid ratio:dense                               median of the paired ratios of time; also
                                                                speedup:dense, ratio:dense.low, …
    paper/dense-adaptive-hybrid study "d-cones: hybrid" low     a study, or an end of its interval
    paper/bend claims | title | command | commit | processor | sizes     a text
    A / B                                                       a quotient, within one run
    … in UNIT, … to DIGITS                                      unit and significant digits (default 3)
"""

import fnmatch
import math
import re
import shlex
import statistics
from dataclasses import dataclass

from records import TIMES
from wording import number, unit_symbol

# Unit asked for: (unit of the record, its size in that unit).
SCALES = {
    "%": ("1", 0.01), "°": ("deg", 1), "N": ("N", 1), "MB": ("B", 1e6), "kB": ("B", 1e3), "rad": ("rad", 1),
    "s": ("s", 1), "ms": ("s", 1e-3), "µs": ("s", 1e-6),
    "m": ("m", 1), "cm": ("m", 1e-2), "mm": ("m", 1e-3), "µm": ("m", 1e-6),
    "cm³": ("m^3", 1e-6), "mm³": ("m^3", 1e-9), "J": ("J", 1), "mJ": ("J", 1e-3),
}
REDUCTIONS = {"median": statistics.median, "min": min, "max": max}
TEXTS = ("title", "command", "commit", "processor", "sizes")
DEFAULT_DIGITS = 3


class ExpressionError(Exception):
    """An expression that says nothing; the message names the part that is wrong."""


@dataclass
class Quantity:
    value: float
    unit: str
    counted: bool = False  # whole numbers are shown exactly


@dataclass
class Term:
    """One operand: the record's place (experiment, reduction over cases or none, case pattern) and
    the words that follow it."""
    experiment: str
    reduction: str
    case: str
    words: list[str]


@dataclass
class Expression:
    terms: list[Term]  # one, or dividend and divisor
    unit: str
    digits: int | None


def parse_term(tokens):
    if not tokens:
        raise ExpressionError("an operand is missing")
    place = re.fullmatch(r"(?P<id>[\w-]+/[\w-]+)(@((?P<fold>\w+)\((?P<glob>.+)\)|(?P<case>.+)))?", tokens[0])
    if not place:
        raise ExpressionError(f"'{tokens[0]}' is no experiment (topic/name, or topic/name@case)")
    if place["fold"] and place["fold"] not in REDUCTIONS:
        raise ExpressionError(f"unknown reduction '{place['fold']}' (there are {', '.join(REDUCTIONS)})")
    return Term(place["id"], place["fold"] or "", place["glob"] or place["case"] or "", tokens[1:])


def option(tokens, keyword):
    """Takes `keyword VALUE` off the end of the tokens."""
    if len(tokens) >= 2 and tokens[-2] == keyword:
        value = tokens[-1]
        del tokens[-2:]
        return value
    return ""


def operands(tokens):
    """The tokens between those that are a slash."""
    out = [[]]
    for token in tokens:
        if token == "/":
            out.append([])
        else:
            out[-1].append(token)
    return out


def parse(text):
    """The Expression of a marker. Raises ExpressionError where it cannot be understood."""
    try:
        tokens = shlex.split(text)
    except ValueError as error:
        raise ExpressionError(f"{text!r}: {error}") from error
    digits, unit = option(tokens, "to"), option(tokens, "in")
    if digits and not re.fullmatch("[1-9]", digits):
        raise ExpressionError(f"'to {digits}': significant digits are 1 to 9")
    if unit and unit not in SCALES:
        raise ExpressionError(f"unknown unit '{unit}' (there are {', '.join(SCALES)})")
    terms = [parse_term(operand) for operand in operands(tokens)]
    if len(terms) > 2:
        raise ExpressionError("a quotient has two operands")
    if len({term.experiment for term in terms}) > 1:
        raise ExpressionError(f"'{terms[0].experiment}' over '{terms[1].experiment}': only quantities "
                              "of one run are divided")
    return Expression(terms, unit, int(digits) if digits else None)


def listed(names):
    return ", ".join(f"'{name}'" for name in names) or "none"


def record_named(records, experiment):
    if experiment not in records:
        raise ExpressionError(f"experiment '{experiment}' has no published record "
                              f"(there are {listed(sorted(records))})")
    return records[experiment]


def cases_of(record, term):
    """The names of the cases that a term speaks of."""
    if not term.case:
        only = record.cases if len(record.cases) == 1 else [c for c in record.cases if c == "default"]
        if not only:
            raise ExpressionError(f"'{term.experiment}' has several cases, name one: "
                                  f"{listed(record.cases)}")
        return only
    found = ([c for c in record.cases if fnmatch.fnmatchcase(c, term.case)] if term.reduction
             else [c for c in (*record.cases, *record.values) if c == term.case][:1])
    if not found:
        raise ExpressionError(f"'{term.experiment}' has no case '{term.case}' (there are "
                              f"{listed(record.cases)})")
    return found


def known(table, name, what, where):
    if name not in table:
        raise ExpressionError(f"{where} has no {what} '{name}' (there are {listed(table)})")
    return table[name]


def time_of(record, case, variant, name):
    row = known(record.times.get(case, {}), variant, "times of variant", f"'{record.experiment_id}', case '{case}',")
    if name not in TIMES:
        raise ExpressionError(f"unknown time '{name}' (there are {listed(TIMES)})")
    return Quantity(row[name], "s")


def ratio_of(record, case, variant, name):
    """`ratio:OF` or `speedup:OF` (its inverse), or an end of its interval: `ratio:OF.low`."""
    kind, _, rest = name.partition(":")
    of, _, end = rest.partition(".")
    if end not in ("", "low", "high"):
        raise ExpressionError(f"'{name}': an interval has 'low' and 'high', no '{end}'")
    rows = [r for r in record.ratios.get(case, []) if (r["variant"], r["of"]) == (variant, of)]
    if not rows:
        raise ExpressionError(f"'{record.experiment_id}', case '{case}', has no ratio of times of "
                              f"'{variant}' over '{of}'")
    if kind == "ratio":
        return Quantity(rows[0][end or "median"], "1")
    opposite = {"": "median", "low": "high", "high": "low"}[end]
    return Quantity(1 / rows[0][opposite], "1")


def quantity_of(record, case, variant, name):
    """A quantity of a variant in one case."""
    if name.startswith("time."):
        return time_of(record, case, variant, name.removeprefix("time."))
    if name.startswith(("ratio:", "speedup:")):
        return ratio_of(record, case, variant, name)
    where = f"'{record.experiment_id}', case '{case}',"
    values = known(record.values.get(case, {}), variant, "values of variant", where)
    if name not in values:
        raise ExpressionError(f"{where} variant '{variant}', has no value '{name}' (there are {listed(values)}; "
                              "--publish of a run adds what pages quote)")
    value = values[name]
    return Quantity(value, record.units[name], counted=record.units[name] == "1")


def study_of(record, words):
    studies = {study.name: study for study in record.studies}
    study = known(studies, words[0], "study", f"'{record.experiment_id}'")
    end = words[1] if len(words) > 1 else "value"
    if len(words) > 2 or end not in ("value", "low", "high"):
        raise ExpressionError(f"after the name of a study: nothing, 'low' or 'high', not '{' '.join(words[1:])}'")
    return Quantity(getattr(study, end), "1")


def term_value(term, records):
    """The Quantity or the text of an operand."""
    record = record_named(records, term.experiment)
    match term.words:
        case ["claims"]:
            return record.claim_words()
        case [name] if name in TEXTS:
            return getattr(record, name)
        case ["study", *rest] if rest:
            return study_of(record, rest)
        case [variant, name]:
            found = [quantity_of(record, case, variant, name) for case in cases_of(record, term)]
        case _:
            raise ExpressionError(f"after '{term.experiment}': VARIANT QUANTITY, study NAME, claims or one of "
                                  f"{listed(TEXTS)}, not '{' '.join(term.words)}'")
    if any(q.value is None or math.isnan(q.value) for q in found):
        raise ExpressionError(f"'{term.experiment} {' '.join(term.words)}' has no value")
    value = REDUCTIONS[term.reduction or "median"]([q.value for q in found])
    return Quantity(value, found[0].unit, found[0].counted)


def quotient(top, bottom):
    if isinstance(top, str) or isinstance(bottom, str):
        raise ExpressionError("texts are not divided")
    if top.unit != bottom.unit:
        raise ExpressionError(f"a quotient of '{top.unit}' and '{bottom.unit}'")
    if bottom.value == 0:
        raise ExpressionError("a quotient with 0 below")
    return Quantity(top.value / bottom.value, "1")


def rendered(quantity, unit, digits):
    size, symbol = 1.0, "" if quantity.unit == "1" else unit_symbol(quantity.unit)
    if unit:
        base, size = SCALES[unit]
        symbol = unit
        if base != quantity.unit:
            raise ExpressionError(f"a quantity in '{quantity.unit}' has no '{unit}'")
    counts = quantity.counted and not unit and digits is None
    text = number(quantity.value / size, digits or DEFAULT_DIGITS, counts).replace("\u202f", ",")
    return text + (symbol if symbol == "°" else f" {symbol}" if symbol else "")


def evaluate(text, records):
    """What a page shows for the expression. Raises ExpressionError."""
    expression = parse(text)
    values = [term_value(term, records) for term in expression.terms]
    value = quotient(*values) if len(values) == 2 else values[0]
    if not isinstance(value, str):
        return rendered(value, expression.unit, expression.digits)
    if expression.unit or expression.digits:
        raise ExpressionError("a text has neither unit nor digits")
    return value


def quoted(text):
    """(experiment, variant, quantity) of every quantity of a variant that the expression names."""
    return [(term.experiment, *term.words) for term in parse(text).terms
            if len(term.words) == 2 and term.words[0] != "study"]
