"""What a run is made of, as run.h5 has it (docs/file-formats.md)."""

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from .folder import path_below

if TYPE_CHECKING:
    import pandas

SCHEMA_VERSION = 4  # and what came before it
WHOLE_PROCESS = "process"  # the phase of a program from outside: one time, of all frames
SOFT_BELOW = 0.7  # as kSoftBelow of testbed/runner/journal/run_record.h

Floats = NDArray[np.float64]
Values = TypeVar("Values", Floats, float)


def import_pandas() -> Any:
    try:
        import pandas
    except ImportError as error:
        raise ImportError("tables of a run as a DataFrame need pandas (pip install pandas, or apt-get install "
                          "python3-pandas); .metrics, .summary and .timing have the same numbers as numpy") from error
    return pandas


@dataclass
class Metric(Generic[Values]):
    """A quantity with its meaning; `values` has one entry a frame, or is one number."""
    values: Values
    unit: str
    definition: str
    direction: str  # lower_is_better, higher_is_better, closer_to_target or none


@dataclass
class Diagnostic:
    """What only the method knows, one value a frame."""
    values: Floats
    unit: str
    definition: str


@dataclass
class Table:
    """The frames' tables of one name, one below the other: the first column is the frame's index."""
    columns: list[str]
    values: Floats  # rows x columns


@dataclass
class Variant:
    name: str
    method: str
    role: str
    reference: str
    options: dict[str, Any]
    status: str  # done, stopped or failed
    error: str   # of a failed variant
    parameter: Floats
    metrics: dict[str, Metric[Floats]]
    summary: dict[str, Metric[float]]
    diagnostics: dict[str, Diagnostic]
    timing: dict[str, Floats]  # phase: frames x repetitions, seconds
    memory: float  # peak of the process while it ran, less what was resident before (bytes)
    events: NDArray[np.void]  # records with named fields
    frames: list[tuple[int, str, str]]  # index, name, sha256
    artifacts: list[tuple[str, str]]
    tables: dict[str, Table] = field(default_factory=dict)
    parameter_name: str = ""

    @property
    def frame_files(self) -> list[str]:
        """Names of the files of its frames, for `Run.file`."""
        return [name for _, name, _ in self.frames]

    def seconds_a_frame(self) -> float:
        """Median over frames and repetitions: of a solve, or of a process' frame; of a program from outside, which
        has one time, its share of a frame. NaN where it was not timed."""
        if WHOLE_PROCESS in self.timing:
            return float(np.nanmedian(self.timing[WHOLE_PROCESS])) / max(len(self.parameter), 1)
        seconds = next((self.timing[phase] for phase in ("solve", "run") if phase in self.timing), np.empty(0))
        return float(np.nanmedian(seconds)) if np.isfinite(seconds).any() else math.nan

    def to_frame(self) -> "pandas.DataFrame":
        """A pandas DataFrame with a row a frame: metrics, and diagnostics as `diagnostic:<name>`; `attrs["units"]` has
        their units. Raises ImportError without pandas."""
        columns: dict[str, Metric[Floats] | Diagnostic] = {
            **self.metrics, **{f"diagnostic:{name}": d for name, d in self.diagnostics.items()}}
        pandas = import_pandas()
        made = pandas.DataFrame({name: column.values for name, column in columns.items()},
                                index=pandas.Index(self.parameter, name=self.parameter_name or "parameter"))
        made.attrs["units"] = {name: column.unit for name, column in columns.items()}
        return made


@dataclass
class Ratio:
    variant: str
    of: str
    median: float
    low: float
    high: float
    paired: str  # by frame, or by whole run


@dataclass
class Case:
    name: str
    parameter_name: str
    parameter_unit: str
    seed: int
    threads: int
    scene: dict[str, Any]
    warnings: list[str]
    swept: dict[str, Any]
    facts: dict[str, float]
    variants: list[Variant]
    ratios: list[Ratio]
    nulls: list[Variant]  # variants that are there to fail claims: not shown

    def variant(self, name: str) -> Variant | None:
        """The variant of that name, or None."""
        return next((v for v in self.variants if v.name == name), None)


@dataclass
class Study:
    name: str
    kind: str
    quantity: str
    value: float
    low: float
    high: float
    x: Floats
    y: Floats
    y_of: Floats  # of "within-spread": the values of the variant compared with
    members: list[Any] = field(default_factory=list)  # of published "matched": names that x and y are of, by family
    match: str = ""  # of published "matched": the error


@dataclass
class Claim:
    text: str
    case: str
    detail: str
    left: float
    right: float
    holds: bool
    null: str = ""  # variant that must fail the claim; empty: none is named
    null_verdict: str = ""  # discriminates, void, undecided, exempt, unasked; empty before schema 3
    null_detail: str = ""
    passed_too: str = ""  # further variants that the claim holds for
    variant: str = ""  # that speaks, of several that the claim is about; empty before schema 4, as all below
    nearest: str = ""  # of all other variants the one that fails by least
    excepted: str = ""  # why it need not hold in this case; empty: it must
    input: str = ""  # variant that does nothing, from which it is graded
    graded: str = "no"  # by frames or by values
    least: float = math.nan  # smallest s of input + s (output - input) from which on it holds

    @property
    def outcome(self) -> str:
        """holds, falls short, or not told apart: its null passes too, or has no value, or the interval of its time has
        equality in it."""
        if not self.holds and not (self.null_verdict == "undecided" and not self.null):
            return "falls short"
        return "holds" if self.null_verdict in ("discriminates", "exempt", "") else "not told apart"

    @property
    def soft(self) -> bool:
        """What does a good part less than the method would pass, too."""
        return self.least < SOFT_BELOW


@dataclass(repr=False)
class Run:
    folder: Path
    experiment_id: str
    title: str
    figure: str
    topic: str
    quick: bool
    experiment: str  # resolved TOML text
    spec_hash: str
    content_sha256: str
    provenance: dict[str, str]
    inputs: list[tuple[str, str]]
    cases: list[Case]
    studies: list[Study]
    claims: list[Claim]
    claims_cases: list[Case] = field(default_factory=list)  # there for claims, and for numbers that pages quote
    frames_sha256: str = ""  # of frames, events and artifacts only; empty in older runs
    metrics_sha256: str = ""  # of metrics and summaries only; empty in older runs
    schema_version: int = SCHEMA_VERSION
    view: dict[str, Any] = field(default_factory=dict)  # [figure_view] of the experiment
    force: bool = False  # read whether or not its files are what was recorded

    def __repr__(self) -> str:
        return f"<run of {self.experiment_id}: {len(self.cases)} cases of {', '.join(self.variant_names())}>"

    def variant_names(self) -> list[str]:
        """Names of all variants, in the order of the experiment: what fixes their colours."""
        return list(dict.fromkeys(v.name for case in self.cases for v in case.variants))

    def case(self, name: str) -> Case | None:
        """The case of that name, or None."""
        return next((c for c in self.cases + self.claims_cases if c.name == name), None)

    def file(self, name: str) -> Path:
        """The path of a file that the run names: a frame, an artifact. Raises RunError where it would leave the run."""
        return path_below(self.folder, name)

    def table(self) -> "pandas.DataFrame":
        """A pandas DataFrame with a row a case and variant: what was swept, the median time of a frame (s), memory (B)
        and all summary values; `attrs["units"]` has their units. Raises ImportError without pandas."""
        pairs = [(case, variant) for case in self.cases + self.claims_cases for variant in case.variants]
        rows = [{"case": case.name, "variant": variant.name, "method": variant.method, "seed": case.seed, **case.swept,
                 "seconds_a_frame": variant.seconds_a_frame(), "memory": variant.memory,
                 **{name: metric.values for name, metric in variant.summary.items()}} for case, variant in pairs]
        made: "pandas.DataFrame" = import_pandas().DataFrame(rows)
        made.attrs["units"] = {"seconds_a_frame": "s", "memory": "B", **{
            name: metric.unit for _, variant in pairs for name, metric in variant.summary.items()}}
        return made
