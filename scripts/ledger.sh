#!/usr/bin/env bash
# Prints the ledger of the quick runs: a hash of each frame file, artifact, and column of metrics, diagnostics and
# events that they leave. Two programs that compute the same print the same text, byte by byte.
#
#   scripts/ledger.sh [program] > ledger.txt        all processors
#   taskset -c 0 scripts/ledger.sh > ledger.txt     one thread
#
# The runs go to a folder of their own, which is deleted at the end (LEDGER_RUNS names one to keep).
set -euo pipefail
cd "$(dirname "$0")/.."
program=${1:-build/release/geoprior}

if [ -n "${LEDGER_RUNS:-}" ]; then
  runs=$LEDGER_RUNS
  mkdir -p "$runs"
else
  runs=$(mktemp -d)
  trap 'rm -rf "$runs"' EXIT
fi

# 1: a check or a claim fell short, which the ledger does not judge.
status=0
GEOPRIOR_RUNS=$runs "$program" check --quick >&2 || status=$?
[ "$status" -le 1 ] || exit "$status"

/usr/bin/python3 - "$runs" <<'PYTHON'
import hashlib
import sys
from pathlib import Path

import h5py

runs = Path(sys.argv[1])


def digest(data):
    return hashlib.sha256(data).hexdigest()[:24]


def show(data, *name):
    print(digest(data), *name)


for file in sorted(runs.glob("**/run.h5")):
    folder = file.parent
    with h5py.File(file) as run:
        name = run.attrs["experiment_id"]
        for path in sorted(p for kind in ("frames", "artifacts") for p in folder.glob(kind + "/**/*")):
            if path.is_file():
                show(path.read_bytes(), name, path.relative_to(folder))
        for case, group in sorted(run["cases"].items()):
            for variant, data in sorted(group["variants"].items()):
                show(data["parameter"][:].tobytes(), name, case, variant, "parameter")
                show(data["events"][:].tobytes(), name, case, variant, "events")
                for kind in ("metrics", "summary", "diagnostics"):
                    for column, values in sorted(data[kind].items()):
                        show(values[()].tobytes(), name, case, variant, kind, column)
PYTHON
