#!/usr/bin/env bash
# What the tests of the last ctest cost, in seconds of processor time: by label (a topic's tests, core, …), the ten suites
# and the ten tests that cost most. Entries that are no GoogleTest executable (Python, CMake) count by the clock.
#
#   scripts/test_costs.sh [preset]        release; reads what ctest left in build/<preset>/Testing
set -euo pipefail
cd "$(dirname "$0")/.."
log=build/${1:-release}/Testing/Temporary/LastTest.log
[ -f "$log" ] || { printf 'test_costs: there is no %s: run ctest first\n' "$log" >&2; exit 2; }

costs=$(awk '
  / Testing: / { entry = $3; cost = "" }
  /^\[   COST   \] all of it: / { cost = $(NF - 1); next }
  /^\[   COST   \] / { seconds = $(NF - 1); sub(/^\[   COST   \] /, ""); sub(/: [0-9.]+ s$/, ""); print "test", seconds, $0 }
  /^Test time = / {
    if (cost == "") cost = $4
    label = entry; sub(/\..*/, "", label)
    labels[label] += cost; all += cost
    print "suite", cost, entry
  }
  END { for (label in labels) print "label", labels[label], label; print "label", all, "all of them" }' "$log")

# show <title> <kind> <number of lines>
show() {
  printf '%s\n' "$1"
  awk -v kind="$2" '$1 == kind { printf "%8.1f s  %s\n", $2, substr($0, index($0, $3)) }' <<<"$costs" | sort -rn | sed -n "1,$3p"
}
show "by label" label 100
show "suites" suite 10
show "tests" test 10
