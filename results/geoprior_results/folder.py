"""The folder of a run: what is read of it is what was recorded, and lies in it (docs/file-formats.md)."""

import hashlib
import json
import os
import re
from pathlib import Path

from .texts import printable

JOURNAL_TAIL = 4096  # more than its last line has
RUN_NAME = re.compile(r"\d{8}T\d{6}Z-[0-9a-f]{8}(-\d+)?")  # two of one second: a number behind
EXPERIMENT = re.compile(r"[\w=,+-][\w=,+.-]*/[\w=,+-][\w=,+.-]*", re.ASCII)

Place = str | os.PathLike[str]


class RunError(Exception):
    """A run that cannot be read; the message names the file and what is wrong with it."""


def require_regular_file(path: Path) -> None:
    """Refuses pipes and devices, which may never end. A file that is not there is no concern of it."""
    if os.path.lexists(path) and not Path(path).is_file():
        raise RunError(f"{path}: is no file (allowed: a file, or a link to one)")


def recorded_result(folder: Path) -> str | None:
    """SHA-256 of the run.h5 that finished the run, by the last line of its journal; else None."""
    journal = folder / "journal.jsonl"
    if journal.is_symlink() or not journal.is_file():
        return None
    with open(journal, "rb") as file:
        file.seek(max(0, journal.stat().st_size - JOURNAL_TAIL))
        tail = file.read()
    try:
        line = json.loads(tail.rstrip(b"\n").rsplit(b"\n", 1)[-1])
        return str(line["sha256"]) if line["kind"] == "result" else None
    except (ValueError, KeyError, TypeError):
        return None


def require_recorded(path: Path, forced_by: str) -> None:
    """HDF5 crashes on many a damaged file: nothing is read but what the run wrote. `forced_by` is what reads it all the
    same, as who asked for it would say it."""
    if path.is_symlink():
        raise RunError(f"{path}: is a symbolic link: below a run none is followed")
    recorded = recorded_result(path.parent)
    if recorded is None:
        raise RunError(f"{path}: its checksum is not in the journal beside it (allowed: the "
                       f"folder of a finished run as it was written, or {forced_by})")
    with open(path, "rb") as file:
        if hashlib.file_digest(file, "sha256").hexdigest() != recorded:
            raise RunError(f"{path}: is damaged or another file: its SHA-256 is not the "
                           f"recorded one (allowed: the file as the run wrote it, or {forced_by})")


def path_below(folder: Path, name: str) -> Path:
    """The path of a recorded file, which leads through no link and does not leave the folder."""
    path = folder
    for part in Path(name).parts:
        path = path / part
        if Path(name).is_absolute() or part == "..":
            raise RunError(f"{folder}: a file of it leaves it: '{printable(name)}'")
        if path.is_symlink():
            raise RunError(f"{path}: is a symbolic link: below a run none is followed")
    return path


def runs_root(root: Place | None = None) -> Path:
    """The folder that holds `<topic>/<name>/`: `root`, or GEOPRIOR_RUNS where it is set, else results/runs of the
    working folder, which is that of a clone."""
    return Path(root or os.environ.get("GEOPRIOR_RUNS") or "results/runs")


def run_folders(experiment_id: str, root: Place | None = None) -> list[Path]:
    """Folders of the finished runs of an experiment below `runs_root(root)`, oldest first; quick runs are among
    them."""
    if not EXPERIMENT.fullmatch(experiment_id):
        raise RunError(f"{experiment_id!r}: is no identifier of an experiment (allowed: two names, topic/name)")
    folder = runs_root(root) / experiment_id
    if not folder.is_dir():
        return []
    return sorted(run for run in folder.iterdir() if RUN_NAME.fullmatch(run.name) and (run / "run.h5").is_file())
