"""Names, units and numbers as a reader wants them: shared by plots, summary and report."""

import math

UNIT_SYMBOLS = {"deg": "°", "1": "", "m^2": "m²", "m^3": "m³"}

# SI units with the powers of ten of their named steps; the exponent is that of the length's prefix.
PREFIXES = {
    "m": [(1, "m"), (1e-3, "mm"), (1e-6, "µm"), (1e-9, "nm")],
    "m^2": [(1, "m²"), (1e-4, "cm²"), (1e-6, "mm²")],
    "m^3": [(1, "m³"), (1e-3, "dm³"), (1e-6, "cm³"), (1e-9, "mm³")],
    "s": [(1, "s"), (1e-3, "ms"), (1e-6, "µs"), (1e-9, "ns")],
    "J": [(1, "J"), (1e-3, "mJ"), (1e-6, "µJ")],
    "B": [(1e9, "GB"), (1e6, "MB"), (1e3, "kB"), (1, "B")],
}


# Words of names that are written otherwise than with small letters, or than the name can be.
WORDS = {
    "dcone": "d-cone", "rms": "RMS", "p05": "(5 %)", "p95": "(95 %)", "hausdorff": "Hausdorff",
    "gauss": "Gauss", "dirichlet": "Dirichlet",
}


def null_words(claim):
    """What a claim's null says of it, or the clock; empty for runs that knew no nulls."""
    if claim.null_verdict == "undecided" and not claim.null:
        return f"undecided on this machine: {claim.null_detail}"
    return {
        "discriminates": f"discriminates: not so with the null {claim.null}: {claim.null_detail}",
        "void": f"not told apart: its null {claim.null} passes too, or as good as: {claim.null_detail}",
        "undecided": f"not told apart: its null {claim.null} has no value: {claim.null_detail}",
        "exempt": f"needs no null: a time; {claim.null_detail}" if claim.null_detail else
                  "needs no null: a time, or an oracle",
        "unasked": "names no null: nothing says that it can fail",
    }.get(claim.null_verdict, "")


def clock_words(claim):
    """The margin of a time with its interval; empty for other claims, and for times of runs that kept none."""
    return claim.null_detail if not claim.null and claim.null_verdict in ("exempt", "undecided") else ""


def slack(claim):
    """Value over limit; empty for a limit of 0."""
    if not claim.right or not math.isfinite(claim.left) or not math.isfinite(claim.right):
        return ""
    return f"value over limit {claim.left / claim.right:.3g}"


def grade_words(claim):
    """How much of its method a claim needs; empty where it is not graded."""
    if math.isnan(claim.least):
        return ""
    needs = (f"the input {claim.input} passes" if claim.least == 0 else
             f"holds from s = {claim.least:.2g} on of {claim.input} + s ({claim.variant or 'its variant'} − {claim.input})")
    return f"{'soft: ' if claim.soft else ''}{needs}, graded by {claim.graded}"


def beside(claim):
    """All that stands beside a decided claim: why it need not hold, slack, null, grade, which other variants pass
    it, and which fails by least."""
    excepted = f"excepted: {claim.excepted}" if claim.excepted else ""
    nearest = f"{claim.nearest} fails by least" if claim.nearest and claim.nearest != claim.null else ""
    too = f"holds for {claim.passed_too} too" if claim.passed_too else ""
    return [words for words in (excepted, slack(claim), null_words(claim), grade_words(claim), nearest, too) if words]


OUTCOMES = ("holds", "falls short", "not told apart")


def outcome_words(claims):
    """`holds in 7, falls short in 1, not told apart in 2; 1 soft` of decided claims; their outcome of a single one."""
    soft = sum(c.soft for c in claims)
    if len(claims) == 1:
        return claims[0].outcome + (", excepted" if claims[0].excepted else "") + (", soft" if soft else "")
    parts = []
    for outcome in OUTCOMES:
        of = [c for c in claims if c.outcome == outcome]
        excepted = sum(bool(c.excepted) for c in of) if outcome != "holds" else 0
        if of:
            parts.append(f"{outcome} in {len(of)}" + (f" ({excepted} excepted)" if excepted else ""))
    return (", ".join(parts) or "no claims") + (f"; {soft} soft" if soft else "")


def all_told(claims):
    """Whether each of them holds, and its null fails."""
    return all(c.outcome == "holds" for c in claims)


def display_name(name):
    """`dual-quaternion` as `Dual quaternion`, `dcone_count` as `d-cone count`."""
    words = name.replace("_", " ").replace("-", " ").split(" ")
    first = WORDS.get(words[0], words[0][:1].upper() + words[0][1:])
    return " ".join([first, *(WORDS.get(word, word) for word in words[1:])])


def unit_symbol(unit):
    return UNIT_SYMBOLS.get(unit, unit)


def scale_for(values, unit):
    """Factor and unit in which the largest of the values is easy to read."""
    steps = PREFIXES.get(unit)
    finite = [abs(v) for v in values if math.isfinite(v) and v != 0]
    if not steps or not finite:
        return 1.0, unit_symbol(unit)
    largest = max(finite)
    for size, symbol in steps:
        if largest >= size:
            return size, symbol
    size, symbol = steps[-1]
    return size, symbol


def labelled(name, symbol):
    return f"{name} [{symbol}]" if symbol else name


def number(value, digits=3, counts=True):
    """Three significant digits, no needless exponent; a dash where there is no value. A whole number
    is taken for a count and shown exactly, unless the quantity is measured."""
    if value is None or math.isnan(value):
        return "–"
    if math.isinf(value):
        return "∞" if value > 0 else "−∞"
    if value == 0:
        return "0"
    magnitude = math.floor(math.log10(abs(float(f"{value:.{digits - 1}e}"))))
    if -4 < magnitude < digits + 3:
        if counts and float(value).is_integer():
            text = f"{int(value):,}".replace(",", "\u202f")
        else:
            text = f"{value:.{max(0, digits - 1 - magnitude)}f}"
        return text.replace("-", "−")
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    superscript = str(int(exponent)).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
    return f"{mantissa.replace('-', '−')}·10{superscript}"


def with_unit(value, unit):
    """A value in the unit's easiest step: `0.0031 s` as `3.10 ms`."""
    if not math.isfinite(value):
        return number(value)
    size, symbol = scale_for([value], unit)
    text = number(value / size, counts=symbol == "°")
    return text + (symbol if symbol == "°" else f" {symbol}" if symbol else "")


def interval(median, low, high):
    if not (math.isfinite(low) and math.isfinite(high)):
        return number(median, counts=False)
    return "{} [{}, {}]".format(*(number(v, counts=False) for v in (median, low, high)))
