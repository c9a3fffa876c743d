"""Published records: results/published/<topic>/<experiment>.json, the one source of every number that
the pages show (docs/file-formats.md). Made from a run by `record_of`, read by `read_record`."""

import json
import math
import re
import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import tables
from runfile import Claim, Ratio, RunFileError, Study, write_atomically
from wording import display_name, outcome_words

SCHEMA_VERSION = 1
SINCE_EVERY_CASE = 4  # schema of run.h5
TIMES = ("median", "low", "high", "p95", "whole", "prepare")
LEVELS = {"claims": 1, "studies": 1, "times": 2, "ratios": 2, "units": 1, "values": 3}  # broken into lines
REDUCTIONS = {"max": np.nanmax, "min": np.nanmin, "median": np.nanmedian, "mean": np.nanmean,
              "last": lambda values: values[-1]}


def rounded(value, digits):
    """The number as a record keeps it: None where there is none, a text where it is infinite, which JSON cannot say."""
    if math.isinf(value):
        return str(value)
    return float(f"{value:.{digits}g}") if math.isfinite(value) else None


def present(value):
    if value is None:
        return math.nan
    return float(value) if value in ("inf", "-inf") else value


# From a run


def sizes(run):
    """How large its scenes are; of simulations, whose meshes change, the largest frame of any variant."""
    vertices = sorted({int(case.facts["vertices"]) for case in run.cases if "vertices" in case.facts})
    if vertices:
        return ", ".join(f"{n:,}" for n in vertices)
    triangles = [np.nanmax(metric.values) for case in run.cases for variant in case.variants
                 for name, metric in variant.metrics.items() if name == "triangles"]
    return f"up to {int(max(triangles)):,} triangles" if triangles else ""


def times_of_case(case):
    """variant: phase and seconds of its timing row."""
    names = {display_name(v.name): v.name for v in case.variants}
    out = {}
    for row in tables.timing_rows(case):
        seconds = {"median": row.times.median, "low": row.times.low, "high": row.times.high,
                   "p95": row.times.p95, "whole": row.whole, "prepare": row.prepare,
                   "memory": row.memory}
        out[names[row.variant]] = {"phase": row.phase,
                                   **{name: rounded(s, 4) for name, s in seconds.items()}}
    return out


def series_of(variant, name):
    """The values over the frames that `metric` or `diagnostic:name` stands for, or None."""
    kind, _, rest = name.partition(":")
    return variant.diagnostics.get(rest) if kind == "diagnostic" else variant.metrics.get(name)


def statistic_of_time(variant, quantity):
    """(seconds, "s") of `timing:step.p99` or `timing:run.mean`, over all frames and repetitions; None
    without that phase."""
    phase, _, reduction = quantity.removeprefix("timing:").rpartition(".")
    if phase not in variant.timing:
        return None
    if reduction == "mean":
        return float(np.nanmean(variant.timing[phase])), "s"
    percent = reduction.removeprefix("p")
    return (float(np.nanpercentile(variant.timing[phase], int(percent))), "s") if percent.isdigit() else None


def measured(variant, quantity):
    """(value, unit) of `metric.max`, `metric@90` (at that parameter), `diagnostic:name.last`, `timing:step.p99`,
    or a metric of the whole sequence; None when the variant has no such quantity."""
    if quantity.startswith("timing:"):
        return statistic_of_time(variant, quantity)
    if quantity in variant.summary:
        return variant.summary[quantity].values, variant.summary[quantity].unit
    name, at, parameter = quantity.partition("@")
    base, _, reduction = name.rpartition(".")
    series = series_of(variant, name if at else base)
    if series is None or not (at or reduction in REDUCTIONS):
        return None
    if not at:
        return float(REDUCTIONS[reduction](series.values)), series.unit
    frames = np.flatnonzero(np.isclose(variant.parameter, float(parameter), rtol=1e-9))
    return (float(series.values[frames[0]]), series.unit) if frames.size else None


def quoted_values(run, quoted):
    """(values, units) of the quantities that pages quote: `quoted` has (variant, quantity) pairs."""
    values, units = {}, {}
    for case in run.cases + run.claims_cases:
        for variant_name, quantity in sorted(quoted):
            variant = case.variant(variant_name)
            found = measured(variant, quantity) if variant else None
            if found is None:
                continue
            values.setdefault(case.name, {}).setdefault(variant_name, {})[quantity] = rounded(found[0], 6)
            units[quantity] = found[1]
    return values, dict(sorted(units.items()))


def published_claim(claim):
    """Verdict, numbers, and what its null says of it: those of a row of run.h5 that have a value."""
    beside = {"left": rounded(claim.left, 6), "right": rounded(claim.right, 6), "null": claim.null,
              "null_verdict": claim.null_verdict, "null_detail": claim.null_detail,
              "passed_too": claim.passed_too, "variant": claim.variant, "nearest": claim.nearest,
              "excepted": claim.excepted}
    if math.isfinite(claim.least):
        beside |= {"input": claim.input, "graded": claim.graded, "least": claim.least}
    return {"holds": claim.holds, "case": claim.case, "text": claim.text, "detail": claim.detail,
            **{name: value for name, value in beside.items() if value not in ("", None)}}


def published_study(study, run):
    """Value and interval; of a comparison at equal error also what was compared, errors and costs."""
    made = {"kind": study.kind, "quantity": study.quantity,
            **{key: rounded(getattr(study, key), 4) for key in ("value", "low", "high")}}
    if study.kind == "matched":
        spec = next(s for s in tomllib.loads(run.experiment)["study"] if s["name"] == study.name)
        made["members"] = [[spec["variant"]], *(family["variants"] for family in spec["families"])]
        made["match"] = spec["match"]
        made |= {key: [rounded(value, 4) for value in getattr(study, key)] for key in ("x", "y")}
    return made


def processor_time(run):
    """Seconds of the processor that the whole run took, where it recorded them."""
    seconds = run.provenance.get("processor_s")
    return {"processor_s": rounded(float(seconds), 4)} if seconds else {}


def record_of(run, quoted):
    """What the run publishes, as the JSON object that its file holds."""
    if run.quick:
        raise RunFileError(f"{run.folder}: a quick run is not published")
    if run.schema_version < SINCE_EVERY_CASE:
        raise RunFileError(f"{run.folder}: its claims were decided in cases that were listed by hand "
                           f"(schema {run.schema_version}; published from {SINCE_EVERY_CASE} on): run it anew")
    values, units = quoted_values(run, quoted)
    return {
        "schema_version": SCHEMA_VERSION, "experiment": run.experiment_id, "title": run.title,
        "figure": run.figure, "command": f"geoprior run {run.experiment_id}", "source": "run.h5",
        "commit": run.provenance.get("git_commit", "unknown"), "content_sha256": run.content_sha256,
        "processor": run.provenance.get("cpu", "unknown"), **processor_time(run), "sizes": sizes(run),
        "failures": tables.failures(run), "cases": [case.name for case in run.cases],
        "claims": [published_claim(c) for c in run.claims],
        "studies": {s.name: published_study(s, run) for s in run.studies},
        "times": {case.name: times_of_case(case) for case in run.cases},
        "ratios": {case.name: [{"variant": r.variant, "of": r.of, "median": rounded(r.median, 4),
                                "low": rounded(r.low, 4), "high": rounded(r.high, 4),
                                "paired": r.paired} for r in case.ratios] for case in run.cases},
        "units": units, "values": values}


# Files


def json_lines(item, levels, indent):
    """JSON whose outer `levels` have a line for each member; what is deeper stands on one line."""
    if levels == 0 or not item:
        return json.dumps(item, ensure_ascii=False)
    pad = " " * (indent + 2)
    inner = [(f"{json.dumps(key, ensure_ascii=False)}: ", value) for key, value in item.items()] \
        if isinstance(item, dict) else [("", value) for value in item]
    lines = [pad + name + json_lines(value, levels - 1, indent + 2) for name, value in inner]
    opening, closing = "{}" if isinstance(item, dict) else "[]"
    return f"{opening}\n" + ",\n".join(lines) + f"\n{' ' * indent}{closing}"


def json_text(data):
    """The record with one value, one claim or one row of times a line, so that a change reads as one."""
    lines = [f'  "{key}": ' + json_lines(value, LEVELS.get(key, 0), 2) for key, value in data.items()]
    return "{\n" + ",\n".join(lines) + "\n}"


def write_record(root, data):
    """Writes the record below `root`, the repository; returns its path."""
    path = record_path(root, data["experiment"])
    path.parent.mkdir(parents=True, exist_ok=True)
    write_atomically(path, json_text(data) + "\n")
    return path


def published_folder(root):
    return Path(root) / "results" / "published"


def record_path(root, experiment):
    if not re.fullmatch(r"[\w=,+-][\w=,+.-]*/[\w=,+-][\w=,+.-]*", experiment, re.ASCII):
        raise RunFileError(f"{experiment!r} is no identifier of an experiment (allowed: two names, topic/name)")
    return published_folder(root) / f"{experiment}.json"


@dataclass
class Record:
    """One published run; the attributes that runs have too are named like theirs."""
    experiment_id: str
    title: str
    figure: str
    command: str
    commit: str
    content_sha256: str
    processor: str
    sizes: str
    failures: list[str]
    cases: list[str]
    claims: list[Claim]
    studies: list[Study]
    times: dict
    ratios: dict
    units: dict[str, str]
    values: dict
    processor_s: float = math.nan  # of the whole run, claims' cases too

    def claim_words(self):
        """What its claims come to."""
        return outcome_words(self.claims)

    def timing_rows(self, case):
        """The rows of the timing table of a case, as `tables.timing_rows` gives them of a run."""
        ratios = [Ratio(**{k: present(v) for k, v in r.items()}) for r in self.ratios.get(case, [])]
        rows = []
        for variant, row in self.times.get(case, {}).items():
            seconds = {name: present(row[name]) for name in TIMES}
            rows.append(tables.TimingRow(
                display_name(variant), row["phase"],
                tables.Times(seconds["median"], seconds["low"], seconds["high"], seconds["p95"]), 0,
                seconds["whole"], seconds["prepare"], [r for r in ratios if r.variant == variant],
                present(row.get("memory"))))
        return rows


def read_record(path):
    """Reads a published record. Raises RunFileError with one line that names the file."""
    try:
        data = json.loads(Path(path).read_text(encoding="utf-8"))
        if data["schema_version"] != SCHEMA_VERSION:
            raise RunFileError(f"{path}: schema version {data['schema_version']} "
                               f"(this program reads {SCHEMA_VERSION})")
        same = {key: data[key] for key in ("title", "figure", "command", "commit", "content_sha256",
                                           "processor", "sizes", "failures", "cases", "times",
                                           "ratios", "units", "values")}
        return Record(
            experiment_id=data["experiment"], **same, processor_s=present(data.get("processor_s")),
            claims=[Claim(**c | {side: present(c.get(side, math.nan)) for side in ("left", "right")})
                    for c in data["claims"]],
            studies=[Study(name, s["kind"], s["quantity"], *(present(s[k]) for k in ("value", "low", "high")),
                           *(np.array([present(v) for v in s.get(k, [])], float) for k in ("x", "y")), np.array([]),
                           s.get("members", []), s.get("match", ""))
                     for name, s in data["studies"].items()])
    except OSError as error:
        raise RunFileError(f"{path}: {error.strerror}") from error
    except (AttributeError, KeyError, TypeError, ValueError, RecursionError) as error:
        raise RunFileError(f"{path}: not a published record ({type(error).__name__}: {error})") from error


def read_records(root):
    """experiment id: record, of all that are published. Raises RunFileError as `read_record` does, and for a
    record that lies at another experiment's place."""
    found = {}
    for path in sorted(published_folder(root).glob("*/*.json")):
        record = read_record(path)
        if record_path(root, record.experiment_id) != path:
            raise RunFileError(f"{path}: is the record of '{record.experiment_id}' (allowed: that of "
                               f"'{path.parent.name}/{path.stem}')")
        found[record.experiment_id] = record
    return found
