"""Reads what geoprior recorded: the folder of a run, as numpy and, where it is installed, pandas.

    from geoprior_results import open_run
    run = open_run("results/runs/skinning/knee/20260101T000000Z-0123abcd")
    for case in run.cases:
        for variant in case.variants:
            print(case.name, variant.name, variant.summary["volume_change.min"].values, variant.seconds_a_frame())

A run that is missing, cut off or changed raises RunError, which names the file. Needs h5py and numpy, nothing of
geoprior. What the numbers mean: docs/file-formats.md.
"""

from .folder import RunError, run_folders, runs_root
from .model import Case, Claim, Diagnostic, Metric, Ratio, Run, Study, Table, Variant
from .reading import newest_run, open_run, open_runs

__all__ = ["Case", "Claim", "Diagnostic", "Metric", "Ratio", "Run", "RunError", "Study", "Table", "Variant",
           "newest_run", "open_run", "open_runs", "run_folders", "runs_root"]
