"""Reads run.h5 (docs/file-formats.md) into the objects of model.py."""

import json
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import h5py
import numpy as np

from .folder import Place, RunError, require_recorded, run_folders, runs_root
from .model import (SCHEMA_VERSION, Case, Claim, Diagnostic, Floats, Metric, Ratio, Run, Study, Table, Values,
                    Variant)
from .texts import decoded, printable

ROOT_TEXTS = ("experiment_id", "title", "figure", "topic", "experiment", "spec_hash",
              "content_sha256")
LATER_ROOT_TEXTS = ("frames_sha256", "metrics_sha256")


def words(value: Any) -> str:
    """A text for a reader of its own: TOML, JSON."""
    return decoded(value.decode("utf-8", "surrogateescape") if isinstance(value, bytes) else str(value))


def text(value: Any) -> str:
    return printable(words(value))


def read_json(value: Any) -> Any:
    try:
        return json.loads(words(value)) if value else {}
    except json.JSONDecodeError:
        return {"text": text(value)}


def name_of(member: str) -> str:
    """The name that a member of the file, or an attribute, stands for."""
    return printable(unquote(member))


def by_index(group: Any) -> list[tuple[str, Any]]:
    """Members of a group in the order of their `index` attribute, with the names they stand for."""
    members = [(name_of(name), group[name]) for name in group]
    return sorted(members, key=lambda m: (int(m[1].attrs.get("index", 0)), m[0]))


def read_metric(data: Any, values: Values) -> Metric[Values]:
    return Metric(values, text(data.attrs["unit"]), text(data.attrs["definition"]), text(data.attrs["direction"]))


def read_diagnostic(data: Any) -> Diagnostic:
    # Runs written before the topics had tables of diagnostics say neither unit nor meaning.
    return Diagnostic(data[()], text(data.attrs.get("unit", "")),
                      text(data.attrs.get("definition", "")))


def read_tables(group: Mapping[str, Any]) -> dict[str, Table]:
    return {name_of(name): Table([text(column) for column in np.atleast_1d(data.attrs["columns"])], data[()])
            for name, data in group.items()}


def read_variant(name: str, group: Any, parameter_name: str) -> Variant:
    attrs = group.attrs
    return Variant(
        name=name, method=text(attrs["method"]), role=text(attrs["role"]),
        reference=text(attrs.get("reference", "")), options=read_json(attrs["options"]),
        status=text(attrs["status"]), error=text(attrs.get("error", "")), parameter=group["parameter"][()],
        metrics={name_of(n): read_metric(d, np.asarray(d[()])) for n, d in group["metrics"].items()},
        summary={name_of(n): read_metric(d, float(d[()])) for n, d in group["summary"].items()},
        diagnostics={name_of(n): read_diagnostic(d) for n, d in group["diagnostics"].items()},
        timing={name_of(n): np.atleast_2d(group["timing"][n][()]) for n in group["timing"]},
        memory=float(attrs.get("memory_peak", np.nan)) - float(attrs.get("memory_start", np.nan)),
        events=group["events"][()],
        frames=[(int(f["frame"]), text(f["name"]), text(f["sha256"])) for f in group["frames"][()]],
        artifacts=[(text(a["name"]), text(a["sha256"])) for a in group["artifacts"][()]],
        tables=read_tables(group["tables"] if "tables" in group else {}), parameter_name=parameter_name)


def read_case(name: str, group: Any) -> Case:
    attrs = group.attrs
    parameter_name = text(attrs["parameter_name"])
    variants = [read_variant(n, g, parameter_name) for n, g in by_index(group["variants"])]
    return Case(
        name=name, parameter_name=parameter_name,
        parameter_unit=text(attrs["parameter_unit"]), seed=int(attrs["seed"]),
        threads=int(attrs["threads"]), scene=read_json(attrs["scene"]),
        warnings=[text(w) for w in np.atleast_1d(attrs["warnings"])],
        swept={name_of(k): read_json(v) for k, v in group["swept"].attrs.items()},
        facts={name_of(k): float(v) for k, v in group["facts"].attrs.items()},
        variants=[v for v in variants if v.role != "null"],
        nulls=[v for v in variants if v.role == "null"],
        ratios=[Ratio(text(r["variant"]), text(r["of"]), float(r["median_ratio"]),
                      float(r["low"]), float(r["high"]),
                      text(r["paired"]) if "paired" in r.dtype.names else "frame")
                for r in group["ratios"][()]])


def read_claim(row: Any) -> Claim:
    later = ("null", "null_verdict", "null_detail", "passed_too", "variant", "nearest", "excepted", "input", "graded")
    beside: dict[str, Any] = {name: text(row[name]) for name in later if name in row.dtype.names}
    if "least_grade" in row.dtype.names:
        beside["least"] = float(row["least_grade"])
    return Claim(text(row["text"]), text(row["case"]), text(row["detail"]), float(row["left"]),
                 float(row["right"]), bool(row["holds"]), **beside)


def read_study(name: str, group: Any) -> Study:
    y_of: Floats = group["y_of"][()] if "y_of" in group else np.array([])
    return Study(name, text(group.attrs["kind"]), text(group.attrs["quantity"]), float(group.attrs["value"]),
                 float(group.attrs["low"]), float(group.attrs["high"]), group["x"][()], group["y"][()], y_of)


def read_root(folder: Path, file: Any, claims_cases: bool) -> Run:
    attrs = file.attrs
    known = {*ROOT_TEXTS, *LATER_ROOT_TEXTS, "schema_version", "quick"}
    texts: dict[str, Any] = {name: text(attrs[name]) for name in ROOT_TEXTS}
    texts |= {name: text(attrs.get(name, "")) for name in LATER_ROOT_TEXTS}
    run = Run(
        folder=folder, quick=bool(attrs["quick"]),
        **texts,
        provenance={name_of(k): text(v) for k, v in sorted(attrs.items()) if k not in known},
        inputs=[(text(i["name"]), text(i["sha256"])) for i in file["inputs"][()]],
        cases=[read_case(n, g) for n, g in by_index(file["cases"])
               if not g.attrs.get("claims_only", 0)],
        claims_cases=[read_case(n, g) for n, g in by_index(file["cases"])
                      if claims_cases and g.attrs.get("claims_only", 0)],
        studies=[read_study(n, g) for n, g in by_index(file["study"])],
        claims=[read_claim(c) for c in file["claims"][()]], schema_version=int(attrs["schema_version"]))
    try:
        run.view = tomllib.loads(words(attrs["experiment"])).get("figure_view", {})
    except tomllib.TOMLDecodeError:
        run.view = {}
    return run


def require_own(group: Any) -> None:
    """No link to another place, no values in other files."""
    for name in group:
        if not isinstance(group.get(name, getlink=True), h5py.HardLink):
            raise ValueError(f"{name} is a link to another place")
        item = group[name]
        if isinstance(item, h5py.Group):
            require_own(item)
        elif item.external or item.is_virtual:
            raise ValueError(f"{name} has its values in another file")


def open_run(place: Place, force: bool = False, claims_cases: bool = True) -> Run:
    """Reads a run folder (or its run.h5), whole: no file stays open. With `force` whether or not it is what was
    recorded; without `claims_cases` only the cases that are shown, not those that are there for claims.
    Raises RunError with one clear line."""
    return read_run(place, force, claims_cases, forced_by="force=True")


def read_run(place: Place, force: bool, claims_cases: bool, forced_by: str) -> Run:
    """As `open_run`, for callers that have another word for `force`."""
    path = Path(place)
    path = path / "run.h5" if path.is_dir() else path
    if not path.is_file():
        raise RunError(f"{path}: no such file (a finished run has a run.h5; an interrupted one "
                       "goes on with geoprior run --resume)")
    if not force:
        require_recorded(path, forced_by)
    try:
        with h5py.File(path, "r") as file:
            require_own(file)
            version = int(file.attrs.get("schema_version", -1))
            if not 1 <= version <= SCHEMA_VERSION:
                raise RunError(f"{path}: schema version {version} "
                               f"(this program reads up to {SCHEMA_VERSION})")
            run = read_root(path.parent, file, claims_cases)
            run.force = force
            return run
    except RunError:
        raise
    except (OSError, KeyError, ValueError, TypeError, AttributeError, RuntimeError) as error:
        reason = " ".join(str(error).split()) or type(error).__name__
        raise RunError(f"{path}: damaged or not a run file ({reason})") from error


def open_runs(experiment_id: str, root: Place | None = None) -> Iterator[Run]:
    """The finished runs of an experiment below `root` (as in `run_folders`), oldest first, each read when it is asked
    for. Raises RunError as `open_run` does."""
    return (open_run(folder) for folder in run_folders(experiment_id, root))


def newest_run(experiment_id: str, root: Place | None = None) -> Run:
    """The finished run of an experiment that began last, a quick one too (`Run.quick`), below `root` as in
    `run_folders`. Raises RunError where there is none."""
    folders = run_folders(experiment_id, root)
    if not folders:
        raise RunError(f"{runs_root(root)}: has no finished run of '{experiment_id}' (geoprior run {experiment_id} "
                       "makes one)")
    return open_run(folders[-1])
