"""Reads run.h5 (docs/file-formats.md) into plain Python objects. Needs h5py and numpy only."""

import hashlib
import json
import math
import os
import signal
import sys
import tomllib
import traceback
from dataclasses import dataclass, field
from pathlib import Path
from urllib.parse import unquote

import h5py
import numpy as np

from wording import printable

SCHEMA_VERSION = 4  # and what came before it
SOFT_BELOW = 0.7  # as kSoftBelow of testbed/runner/journal/run_record.h
JOURNAL_TAIL = 4096  # more than its last line has


class RunFileError(Exception):
    """A run that cannot be read; the message names the file and what is wrong with it."""


@dataclass
class Metric:
    """A quantity with its meaning; `values` has one entry a frame, or is one number."""
    values: np.ndarray | float
    unit: str
    definition: str
    direction: str


@dataclass
class Diagnostic:
    """What only the method knows, one value a frame."""
    values: np.ndarray
    unit: str
    definition: str


@dataclass
class Variant:
    name: str
    method: str
    role: str
    reference: str
    options: dict
    status: str  # done, stopped or failed
    error: str   # of a failed variant
    parameter: np.ndarray
    metrics: dict[str, Metric]
    summary: dict[str, Metric]
    diagnostics: dict[str, Diagnostic]
    timing: dict[str, np.ndarray]  # phase: frames x repetitions, seconds
    memory: float  # peak of the process while it ran, less what was resident before (bytes)
    events: np.ndarray
    frames: list[tuple[int, str, str]]  # index, name, sha256
    artifacts: list[tuple[str, str]]


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
    scene: dict
    warnings: list[str]
    swept: dict[str, object]
    facts: dict[str, float]
    variants: list[Variant]
    ratios: list[Ratio]
    nulls: list[Variant]  # variants that are there to fail claims: not shown

    def variant(self, name):
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
    x: np.ndarray
    y: np.ndarray
    y_of: np.ndarray  # of "within-spread": the values of the variant compared with
    members: list = field(default_factory=list)  # of published "matched": names that x and y are of, by family
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
    def outcome(self):
        """holds, falls short, or not told apart: its null passes too, or has no value, or the interval of its time has
        equality in it."""
        if not self.holds and not (self.null_verdict == "undecided" and not self.null):
            return "falls short"
        return "holds" if self.null_verdict in ("discriminates", "exempt", "") else "not told apart"

    @property
    def soft(self):
        """What does a good part less than the method would pass, too."""
        return self.least < SOFT_BELOW


@dataclass
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
    view: dict = field(default_factory=dict)  # [figure_view] of the experiment
    force: bool = False  # read whether or not its files are what was recorded

    def variant_names(self):
        """Names of all variants, in the order of the experiment: what fixes their colours."""
        return list(dict.fromkeys(v.name for case in self.cases for v in case.variants))


ROOT_TEXTS = ("experiment_id", "title", "figure", "topic", "experiment", "spec_hash",
              "content_sha256")
LATER_ROOT_TEXTS = ("frames_sha256", "metrics_sha256")


def text(value):
    return printable(value.decode("utf-8", "surrogateescape") if isinstance(value, bytes)
                     else str(value))


def read_json(value):
    value = text(value)
    try:
        return json.loads(value) if value else {}
    except json.JSONDecodeError:
        return {"text": value}


def decoded(name):
    return printable(unquote(name))


def by_index(group):
    """Members of a group in the order of their `index` attribute, with their decoded names."""
    members = [(decoded(name), group[name]) for name in group]
    return sorted(members, key=lambda m: (int(m[1].attrs.get("index", 0)), m[0]))


def read_metrics(group):
    out = {}
    for name in group:
        data = group[name]
        values = data[()]
        out[decoded(name)] = Metric(float(values) if np.ndim(values) == 0 else values,
                                    text(data.attrs["unit"]), text(data.attrs["definition"]),
                                    text(data.attrs["direction"]))
    return out


def read_diagnostic(data):
    # Runs written before the topics had tables of diagnostics say neither unit nor meaning.
    return Diagnostic(data[()], text(data.attrs.get("unit", "")),
                      text(data.attrs.get("definition", "")))


def read_variant(name, group):
    attrs = group.attrs
    return Variant(
        name=name, method=text(attrs["method"]), role=text(attrs["role"]),
        reference=text(attrs.get("reference", "")), options=read_json(attrs["options"]),
        status=text(attrs["status"]), error=text(attrs.get("error", "")), parameter=group["parameter"][()],
        metrics=read_metrics(group["metrics"]), summary=read_metrics(group["summary"]),
        diagnostics={decoded(n): read_diagnostic(d) for n, d in group["diagnostics"].items()},
        timing={decoded(n): np.atleast_2d(group["timing"][n][()]) for n in group["timing"]},
        memory=float(attrs.get("memory_peak", np.nan)) - float(attrs.get("memory_start", np.nan)),
        events=group["events"][()],
        frames=[(int(f["frame"]), text(f["name"]), text(f["sha256"])) for f in group["frames"][()]],
        artifacts=[(text(a["name"]), text(a["sha256"])) for a in group["artifacts"][()]])


def read_case(name, group):
    attrs = group.attrs
    variants = [read_variant(n, g) for n, g in by_index(group["variants"])]
    return Case(
        name=name, parameter_name=text(attrs["parameter_name"]),
        parameter_unit=text(attrs["parameter_unit"]), seed=int(attrs["seed"]),
        threads=int(attrs["threads"]), scene=read_json(attrs["scene"]),
        warnings=[text(w) for w in np.atleast_1d(attrs["warnings"])],
        swept={decoded(k): read_json(v) for k, v in group["swept"].attrs.items()},
        facts={decoded(k): float(v) for k, v in group["facts"].attrs.items()},
        variants=[v for v in variants if v.role != "null"],
        nulls=[v for v in variants if v.role == "null"],
        ratios=[Ratio(text(r["variant"]), text(r["of"]), float(r["median_ratio"]),
                      float(r["low"]), float(r["high"]),
                      text(r["paired"]) if "paired" in r.dtype.names else "frame")
                for r in group["ratios"][()]])


def read_claim(row):
    later = ("null", "null_verdict", "null_detail", "passed_too", "variant", "nearest", "excepted", "input", "graded")
    texts = {name: text(row[name]) for name in later if name in row.dtype.names}
    least = {"least": float(row["least_grade"])} if "least_grade" in row.dtype.names else {}
    return Claim(text(row["text"]), text(row["case"]), text(row["detail"]), float(row["left"]),
                 float(row["right"]), bool(row["holds"]), **texts, **least)


def read_root(folder, file, claims_cases=False):
    attrs = file.attrs
    known = {*ROOT_TEXTS, *LATER_ROOT_TEXTS, "schema_version", "quick"}
    run = Run(
        folder=folder, quick=bool(attrs["quick"]),
        **{name: text(attrs[name]) for name in ROOT_TEXTS},
        **{name: text(attrs.get(name, "")) for name in LATER_ROOT_TEXTS},
        provenance={decoded(k): text(v) for k, v in sorted(attrs.items()) if k not in known},
        inputs=[(text(i["name"]), text(i["sha256"])) for i in file["inputs"][()]],
        cases=[read_case(n, g) for n, g in by_index(file["cases"])
               if not g.attrs.get("claims_only", 0)],
        claims_cases=[read_case(n, g) for n, g in by_index(file["cases"])
                      if claims_cases and g.attrs.get("claims_only", 0)],
        studies=[Study(n, text(g.attrs["kind"]), text(g.attrs["quantity"]),
                       float(g.attrs["value"]), float(g.attrs["low"]), float(g.attrs["high"]),
                       g["x"][()], g["y"][()], g["y_of"][()] if "y_of" in g else np.array([]))
                 for n, g in by_index(file["study"])],
        claims=[read_claim(c) for c in file["claims"][()]], schema_version=int(attrs["schema_version"]))
    try:
        run.view = tomllib.loads(run.experiment).get("figure_view", {})
    except tomllib.TOMLDecodeError:
        run.view = {}
    return run


def recorded_result(folder):
    """SHA-256 of the run.h5 that finished the run, by the last line of its journal; else None."""
    journal = folder / "journal.jsonl"
    if journal.is_symlink() or not journal.is_file():
        return None
    with open(journal, "rb") as file:
        file.seek(max(0, journal.stat().st_size - JOURNAL_TAIL))
        tail = file.read()
    try:
        line = json.loads(tail.rstrip(b"\n").rsplit(b"\n", 1)[-1])
        return line["sha256"] if line["kind"] == "result" else None
    except (ValueError, KeyError, TypeError):
        return None


def require_recorded(path):
    """HDF5 crashes on many a damaged file: nothing is read but what the run wrote."""
    if path.is_symlink():
        raise RunFileError(f"{path}: is a symbolic link: below a run none is followed")
    recorded = recorded_result(path.parent)
    if recorded is None:
        raise RunFileError(f"{path}: its checksum is not in the journal beside it (allowed: the "
                           "folder of a finished run as it was written, or --force)")
    with open(path, "rb") as file:
        if hashlib.file_digest(file, "sha256").hexdigest() != recorded:
            raise RunFileError(f"{path}: is damaged or another file: its SHA-256 is not the "
                               "recorded one (allowed: the file as the run wrote it, or --force)")


def path_below(folder, name):
    """The path of a recorded file, which leads through no link and does not leave the folder."""
    path = folder
    for part in Path(name).parts:
        path = path / part
        if Path(name).is_absolute() or part == "..":
            raise RunFileError(f"{folder}: a file of it leaves it: '{printable(name)}'")
        if path.is_symlink():
            raise RunFileError(f"{path}: is a symbolic link: below a run none is followed")
    return path


def read_artifact(run, name, sha256):
    """The bytes of a recorded file, which are what was recorded unless the run is read with force.
    Raises RunFileError naming the file."""
    path = path_below(run.folder, name)
    require_regular_file(path)
    try:
        content = path.read_bytes()
    except OSError as error:
        raise RunFileError(f"{path}: cannot be read ({error.strerror})") from error
    if not run.force and hashlib.sha256(content).hexdigest() != sha256:
        raise RunFileError(f"{path}: is damaged or another file: its SHA-256 is not the recorded one "
                           "(allowed: the file as the run wrote it, or --force)")
    return content


def require_own(group):
    """No link to another place, no values in other files."""
    for name in group:
        if not isinstance(group.get(name, getlink=True), h5py.HardLink):
            raise ValueError(f"{name} is a link to another place")
        item = group[name]
        if isinstance(item, h5py.Group):
            require_own(item)
        elif item.external or item.is_virtual:
            raise ValueError(f"{name} has its values in another file")


def read_run(place, force=False, claims_cases=False):
    """Reads a run folder (or its run.h5); with `force` whether or not it is what was recorded, with `claims_cases` also
    the cases that are there for claims only.
    Raises RunFileError with one clear line."""
    path = Path(place)
    path = path / "run.h5" if path.is_dir() else path
    if not path.is_file():
        raise RunFileError(f"{path}: no such file (a finished run has a run.h5; an interrupted one "
                           "goes on with --resume)")
    if not force:
        require_recorded(path)
    try:
        with h5py.File(path, "r") as file:
            require_own(file)
            version = int(file.attrs.get("schema_version", -1))
            if not 1 <= version <= SCHEMA_VERSION:
                raise RunFileError(f"{path}: schema version {version} "
                                   f"(this program reads up to {SCHEMA_VERSION})")
            run = read_root(path.parent, file, claims_cases)
            run.force = force
            return run
    except RunFileError:
        raise
    except (OSError, KeyError, ValueError, TypeError, AttributeError, RuntimeError) as error:
        reason = " ".join(str(error).split()) or type(error).__name__
        raise RunFileError(f"{path}: damaged or not a run file ({reason})") from error


def write_atomically(path, content):
    """Writes text or bytes as temporary + rename; what stands at either name is not written through."""
    path = Path(path)
    require_regular_file(path)  # a pipe or a device would be replaced by a file
    temporary = path.with_name(path.name + ".geoprior-tmp")
    try:
        temporary.unlink(missing_ok=True)
        with temporary.open("xb") as file:
            file.write(content if isinstance(content, bytes) else content.encode("utf-8", errors="backslashreplace"))
        temporary.replace(path)
    except OSError as error:
        raise RunFileError(f"{path}: cannot be written ({error.strerror or error})") from error
    finally:  # also when a signal ends the script
        temporary.unlink(missing_ok=True)


def require_regular_file(path):
    """Refuses pipes and devices, which may never end. A file that is not there is no concern of it."""
    if os.path.lexists(path) and not Path(path).is_file():
        raise RunFileError(f"{path}: is no file (allowed: a file, or a link to one)")


def defect_line(error):
    """One line of what broke a script that should have refused its input: on which files, where."""
    place = traceback.extract_tb(error.__traceback__)[-1]
    reason = " ".join(str(error).split())
    files = ", ".join(a for a in sys.argv[1:] if not a.startswith("-"))
    return (f"{files}: cannot be shown ({type(error).__name__}{': ' if reason else ''}{reason}, at "
            f"{Path(place.filename).name}:{place.lineno}; GEOPRIOR_DEBUG=1 shows the whole trace)")


def add_force(parser):
    parser.add_argument("--force", action="store_true",
                        help="read a run whose checksum is missing or wrong")


def run_main(main):
    """Runs a script's main: one line on stderr and exit code 2 for whatever breaks it, and no file
    left half-written by a signal."""
    signal.signal(signal.SIGTERM, lambda number, frame: sys.exit(128 + number))
    sys.stdout.reconfigure(errors="backslashreplace")
    try:
        sys.exit(main(sys.argv[1:]))
    except RunFileError as error:
        print(printable(str(error)), file=sys.stderr)
    except KeyboardInterrupt:
        sys.exit(128 + signal.SIGINT)
    except Exception as error:
        if os.environ.get("GEOPRIOR_DEBUG"):
            raise
        print(printable(defect_line(error)), file=sys.stderr)
    sys.exit(2)
