"""What the tables of summary and report say, before it becomes Markdown or HTML."""

import math
from dataclasses import dataclass

import numpy as np

from wording import display_name, number, scale_for

REDUCTIONS = ("max", "min", "median", "last")


@dataclass
class MetricRow:
    """One line of a metric table: a text a variant, and which of them are best."""
    name: str
    symbol: str
    definition: str
    direction: str
    cells: list[str]
    best: list[bool]

    def label(self):
        return f"{self.name} [{self.symbol}]" if self.symbol else self.name


def base_names(case):
    """Metrics that have summary values: (name, over frames or one value of the sequence)."""
    names = {}
    for variant in case.variants:
        for name in variant.summary:
            base, _, reduction = name.rpartition(".")
            framed = reduction in REDUCTIONS and base in variant.metrics
            names.setdefault(base if framed else name, framed)
    return names


def worst(direction):
    """The reduction over frames that says the worst of a metric; None: its whole range."""
    return {"lower_is_better": "max", "higher_is_better": "min"}.get(direction)


def values_of(variant, name, framed):
    """The numbers of one cell: one value, or (least, greatest) over the frames."""
    if not framed:
        metric = variant.summary.get(name)
        return [] if metric is None else [metric.values]
    metric = variant.metrics.get(name)
    finite = metric.values[np.isfinite(metric.values)] if metric is not None else np.array([])
    if finite.size == 0:
        return []
    reduction = worst(metric.direction)
    if reduction:
        return [float(finite.max() if reduction == "max" else finite.min())]
    return [float(finite.min()), float(finite.max())]


def cell_text(values, size, symbol):
    if not values:
        return "–"
    texts = list(dict.fromkeys(number(v / size, counts=not symbol) for v in values))
    return " … ".join(texts)


def best_of(rows_values, direction):
    """Which variants have the best value; none when all are alike or better has no meaning."""
    pick = {"lower_is_better": min, "higher_is_better": max}.get(direction)
    present = [v[0] for v in rows_values if v]
    if pick is None or len(present) < 2 or min(present) == max(present):
        return [False] * len(rows_values)
    target = pick(present)
    return [bool(v) and v[0] == target for v in rows_values]


def metric_rows(case):
    """The metric table of a case: of metrics over frames the worst value (the range where a metric
    has no worst side), of metrics of the sequence their value."""
    rows = []
    for name, framed in base_names(case).items():
        found = [(v.metrics if framed else v.summary).get(name) for v in case.variants]
        example = next(m for m in found if m is not None)
        values = [values_of(v, name, framed) for v in case.variants]
        size, symbol = scale_for([x for v in values for x in v], example.unit)
        reduction = (worst(example.direction) or "range") if framed else ""
        label = display_name(name) + (f", {reduction}" if reduction else "")
        rows.append(MetricRow(label, symbol, example.definition, example.direction,
                              [cell_text(v, size, symbol) for v in values],
                              best_of(values, example.direction)))
    return rows


@dataclass
class TimingRow:
    variant: str
    phase: str
    median: float
    low: float   # quartiles
    high: float
    count: int
    prepare: float
    ratios: list


def quartiles(times):
    """Median and quartiles over the finite times of all frames and repetitions."""
    finite = times[np.isfinite(times)]
    if finite.size == 0:
        return math.nan, math.nan, math.nan
    low, middle, high = np.percentile(finite, [25, 50, 75])
    return float(middle), float(low), float(high)


def timing_rows(case):
    """One row a variant: its whole cost ("solve" of a pose method, "run" of a process)."""
    rows = []
    for variant in case.variants:
        phase = next((p for p in ("solve", "run") if p in variant.timing), None)
        if phase is None:
            continue
        times = variant.timing[phase]
        prepare = variant.timing.get("prepare")
        rows.append(TimingRow(display_name(variant.name), phase, *quartiles(times),
                              int(np.isfinite(times).sum()),
                              math.nan if prepare is None else quartiles(prepare)[0],
                              [r for r in case.ratios if r.variant == variant.name]))
    return rows


def phase_rows(case):
    """(variant, phase, median, low, high) of what a method marked inside its solve."""
    whole = ("solve", "run", "prepare", "load")
    return [(display_name(v.name), phase, *quartiles(times)) for v in case.variants
            for phase, times in v.timing.items() if phase not in whole]


def event_counts(variant):
    """kind: how many."""
    if variant.events.size == 0:
        return {}
    kinds, counts = np.unique([e["kind"] for e in variant.events], return_counts=True)
    return {k.decode() if isinstance(k, bytes) else str(k): int(n) for k, n in zip(kinds, counts)}
