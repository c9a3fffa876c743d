"""Do two variants differ by more than chance? Paired over the seeds of one run.

Each case that differs by its seed alone gives a pair of summary values. Printed are their mean difference with its 95 %
bootstrap interval, and p of a sign-flip permutation test: the share of random signs of the differences whose mean is
as far from 0. All signs are tried for up to 16 pairs; n pairs cannot show less than p = 2^(1 - n).

    python3 examples/results/significance.py RUN overlap_excess.max implicit dual-quaternion
"""

import argparse
import itertools
import sys
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[2] / "results"))
from geoprior_results import RunError, open_run  # noqa: E402

LEAST_PAIRS, MOST_EXACT, DRAWS = 3, 16, 20_000


def pairs_of(run, metric, variants):
    """A row a case that differs by its seed alone, and in which both variants are done and have the value."""
    cases = [case for case in run.cases + run.claims_cases if set(case.swept) <= {"seed"}]
    found = [[v.summary[metric].values for v in map(case.variant, variants)
              if v and v.status == "done" and metric in v.summary] for case in cases]
    pairs = np.array([pair for pair in found if len(pair) == 2 and np.isfinite(pair).all()])
    if len(pairs) < LEAST_PAIRS:
        raise RunError(f"{run.folder}: {len(pairs)} cases that differ by their seed alone have '{metric}' of "
                       f"'{variants[0]}' and '{variants[1]}' (needed: {LEAST_PAIRS})")
    return pairs


def permutation_p(differences, random):
    n, exact = len(differences), len(differences) <= MOST_EXACT
    signs = np.array(list(itertools.product((1, -1), repeat=n))) if exact else random.choice((1, -1), (DRAWS, n))
    as_far = np.abs(signs @ differences) >= abs(differences.sum()) * (1 - 1e-12)
    return as_far.mean() if exact else (as_far.sum() + 1) / (DRAWS + 1)


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    [parser.add_argument(name) for name in ("run", "metric", "first", "second")]
    chosen = parser.parse_args(arguments)
    try:
        pairs = pairs_of(open_run(chosen.run), chosen.metric, (chosen.first, chosen.second))
    except RunError as error:
        parser.exit(2, f"{error}\n")
    random, differences = np.random.default_rng(1), pairs[:, 0] - pairs[:, 1]
    means = random.choice(differences, (DRAWS, len(differences))).mean(axis=1)
    low, high = np.percentile(means, [2.5, 97.5])
    print(f"{chosen.metric}, {len(pairs)} seeds\n{chosen.first:24} {pairs[:, 0].mean():12.5g}\n{chosen.second:24} "
          f"{pairs[:, 1].mean():12.5g}\n{'difference [95 %]':24} {differences.mean():12.5g} [{low:.5g}, {high:.5g}]\n"
          f"{'p':24} {permutation_p(differences, random):12.5g}")


if __name__ == "__main__":
    main(sys.argv[1:])
