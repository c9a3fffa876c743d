"""What the tables of summary and report say, before it becomes Markdown or HTML."""

import math
from dataclasses import dataclass

import numpy as np

from runfile import WHOLE_PROCESS
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
class Times:
    """Of one phase, over all frames and repetitions."""
    median: float
    low: float   # quartiles
    high: float
    p95: float


@dataclass
class TimingRow:
    variant: str
    phase: str  # "solve" of a pose method, "frame" of a process, WHOLE_PROCESS of another program
    times: Times
    count: int
    whole: float  # a run of all frames; NaN for a pose method
    prepare: float
    ratios: list
    memory: float  # bytes on top of what was there before the variant; NaN: not measured


def times_of(seconds):
    finite = seconds[np.isfinite(seconds)]
    if finite.size == 0:
        return Times(*[math.nan] * 4)
    low, middle, high, p95 = np.percentile(finite, [25, 50, 75, 95])
    return Times(float(middle), float(low), float(high), float(p95))


def is_process(variant):
    return "run" in variant.timing or WHOLE_PROCESS in variant.timing


def has_frame_times(variant):
    """Whether a process was timed frame by frame (before schema 2: as a whole)."""
    return "run" in variant.timing and len(variant.timing["run"]) == len(variant.parameter)


def whole_run(variant):
    """Median over the repetitions of all frames and what follows the last one; the time of a frame
    is NaN in no repetition."""
    if not is_process(variant):
        return math.nan
    parts = [variant.timing[p].sum(axis=0) for p in ("run", "finish", WHOLE_PROCESS) if p in variant.timing]
    return float(np.median(sum(parts)))


def timing_rows(case):
    """One row a variant: its whole cost ("solve" of a pose method, "run" of a process)."""
    rows = []
    for variant in case.variants:
        phase = next((p for p in ("solve", "run", WHOLE_PROCESS) if p in variant.timing), None)
        if phase is None:
            continue
        times = variant.timing[phase]
        prepare = variant.timing.get("prepare")
        rows.append(TimingRow(display_name(variant.name),
                              "frame" if has_frame_times(variant) else phase, times_of(times),
                              int(np.isfinite(times).sum()), whole_run(variant),
                              math.nan if prepare is None else times_of(prepare).median,
                              [r for r in case.ratios if r.variant == variant.name], variant.memory))
    return rows


def inner_phases(variant):
    """phase: seconds of what a method marked inside its solve or its frames."""
    whole = ("solve", "run", WHOLE_PROCESS, "load", "prepare", "finish")
    return {phase: seconds for phase, seconds in variant.timing.items()
            if phase.split(":")[0] not in whole}


def phase_rows(case):
    """(variant, phase, times) of the inner phases."""
    return [(display_name(v.name), phase, times_of(seconds)) for v in case.variants
            for phase, seconds in inner_phases(v).items()]


def failures(run):
    """One line for every variant that an error ended, or that was stopped."""
    lines = []
    for case in run.cases:
        for v in case.variants:
            if v.status != "done":
                of = f" of case {case.name}" if len(run.cases) > 1 else ""
                why = f": {v.error}" if v.error else ""
                count = len(v.parameter)
                how = f"{v.status} after {count} {'frame' if count == 1 else 'frames'}"
                if v.status == "failed" and count == 0:
                    how = "cannot run"
                lines.append(f"{display_name(v.name)}{of} {how}{why}")
    return lines


def event_counts(variant):
    """kind: how many."""
    if variant.events.size == 0:
        return {}
    kinds, counts = np.unique([e["kind"] for e in variant.events], return_counts=True)
    return {k.decode() if isinstance(k, bytes) else str(k): int(n) for k, n in zip(kinds, counts)}
