#!/usr/bin/env bash
# Sets up what is missing, builds and tests.
#
#   ./test.sh               what a change can touch: core, metrics, spine and the topics that differ from the commit of the
#                           last --all that passed here (all of them where those rooms differ); of others one experiment
#   ./test.sh --all         release build with warnings as errors, every test, quick runs against their reference values
#   ./test.sh --sanitize    every test under the address, leak and undefined-behaviour sanitizers
#   ./test.sh --odr         links with -flto -Wodr: no name has two definitions
#   ./test.sh --long        --odr, --all, tests in another order, fuzzing, long motions, files of other
#                           programs, full runs against their reference values, kernels
#   ./test.sh --format      only: is every source file formatted?
set -euo pipefail
cd "$(dirname "$0")"

usage() { sed -n '2,12s/^# \{0,1\}//p' "$0"; }
mode=${1:-}
case "$mode" in
  "" | --all | --sanitize | --odr | --long | --format) ;;
  -h | --help) usage; exit 0 ;;
  *) printf 'test: unknown argument %s\n' "$mode" >&2; usage >&2; exit 2 ;;
esac

tested_commit=build/tested-commit
always="core metrics testbed topics fuzz"  # labels of tests that every change can touch
# ctest takes what lasts longer for something that hangs; nothing else depends on the clock.
hang_s=1200

say() { printf 'test: %s\n' "$*"; }

check_format() {
  git ls-files '*.h' '*.cpp' | xargs -r clang-format --dry-run -Werror
}

run_tests() { ctest --test-dir build/release --output-on-failure -j 2 --timeout "$hang_s" "$@"; }

check_quick() { build/release/geoprior check --quick --mutations --jobs 2 --threads 1 "$@"; }

# The tests of the last ctest, all of which passed.
count_tests() {
  awk '/^\[  PASSED  \] [0-9]+ test/ { count += $4 } /^Test Passed/ { ++entries }
      END { printf "%d tests in %d entries", count, entries }' build/release/Testing/Temporary/LastTest.log
}

# What the last ctest noticed: tests that cost more processor time than one should.
tell_costs() { sed -n 's/^\[  NOTICE  \] /test: /p' build/release/Testing/Temporary/LastTest.log; }

# The experiments of topics, one a line.
experiments_of() {
  local topic file
  for topic in "$@"; do
    for file in "experiments/$topic"/*.toml; do
      file=${file#experiments/} file=${file%.toml}
      [[ ${file##*/} == *.* ]] || printf '%s\n' "$file"
    done
  done
}

# The commit that is checked out, or nothing where files differ from it.
clean_commit() { [ -n "$(git status --porcelain)" ] || git rev-parse HEAD; }

# The reference values of a topic's experiments, one file a line: an experiment may say its own identifier.
references_of() {
  local name id
  for name in $(experiments_of "$1"); do
    id=$(sed -n 's/^id *= *"\(.*\)"$/\1/p' "experiments/$name.toml")
    id=results/reference/${id:-$name}.txt
    [ ! -f "$id" ] || printf '%s\n' "$id"
  done
}

# Of a topic's experiments the one whose quick run costs least, by its reference values.
cheapest_of() {
  local file
  file=$(awk '$1 == "set" { quick = $2 == "quick" }
      quick && $1 == "cost" && (least == "" || $2 < least) { least = $2; file = FILENAME }
      END { print file }' /dev/null $(references_of "$1"))
  file=${file#results/reference/}
  if [ -n "$file" ]; then printf '%s\n' "${file%.txt}"; else experiments_of "$1" | sed -n 1p; fi
}

# Every test and every quick run; remembers the commit that passed.
test_all() {
  local before after
  before=$(clean_commit)
  run_tests
  check_quick
  after=$(clean_commit)
  if [ -z "$after" ] || [ "$before" != "$after" ]; then
    say "$tested_commit is not written: files differ from the commit"
  elif ! grep -qx 'GEOPRIOR_TOPICS:STRING=' build/release/CMakeCache.txt; then
    say "$tested_commit is not written: not all topics are built"
  else
    printf '%s\n' "$after" >"$tested_commit"
  fi
}

# Tests named Long… do more when GEOPRIOR_LONG is set: more seeds, more frames, more kills.
test_at_length() {
  local tests
  run_tests
  # All tests of an executable in one process, in another order each time: none leans on another.
  for tests in $(find build/release -name 'test_*' -type f -executable); do
    "$tests" --gtest_shuffle --gtest_brief=1
  done
  GEOPRIOR_LONG=1 GEOPRIOR_FUZZ_SECONDS=600 GEOPRIOR_FUZZ_PROGRAM=100000 hang_s=36000 run_tests -L long
  /usr/bin/python3 tests/packages/foreign_files.py
  build/release/geoprior check --mutations
  build/release/benchmarks/geoprior_kernels
}

# What a change can touch: tests of what differs, and an experiment of each of the other topics.
test_changed() {
  local differing others experiments topic labels
  differing=$(sed -n 's/^differs //p' <<<"$1")
  others=$(sed -n 's/^same //p' <<<"$1")
  labels=$(printf '%s|' $always $differing)
  run_tests -L "^(${labels%|})\$"
  experiments=$(experiments_of $differing; for topic in $others; do cheapest_of "$topic"; done)
  check_quick $experiments
  say "left out, as nothing of them differs from $(<"$tested_commit"):" $others "(but for one experiment each),"
  say "and what --all does besides: mutated files through the program, the installed package"
}

scripts/setup.sh
check_format
[ "$mode" != --format ] || exit 0

if [ "$mode" = --sanitize ]; then
  scripts/build.sh sanitize
  # What these libraries keep to the end is no leak of ours: tests/leaks.supp names each.
  export ASAN_OPTIONS=detect_leaks=1 UBSAN_OPTIONS=print_stacktrace=1
  export LSAN_OPTIONS="suppressions=$PWD/tests/leaks.supp:print_suppressions=0"
  ctest --test-dir build/sanitize --output-on-failure -j 2 --timeout $((10 * hang_s))
  exit 0
fi

if [ "$mode" = --odr ] || [ "$mode" = --long ]; then
  scripts/build.sh odr
  [ "$mode" = --long ] || exit 0
fi

scripts/build.sh release
if [ "$mode" = --long ]; then
  test_at_length
elif [ "$mode" = --all ]; then
  test_all
else
  changed=$(scripts/changed_topics.sh)
  if grep -q '^same ' <<<"$changed"; then test_changed "$changed"; else test_all; fi
fi
tell_costs
say "$(count_tests) passed, 0 failed"
