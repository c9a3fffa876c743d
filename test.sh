#!/usr/bin/env bash
# Sets up what is missing, builds and tests.
#
#   ./test.sh               release build with warnings as errors, unit tests, quick runs against their reference values
#   ./test.sh --sanitize    every test under the address, leak and undefined-behaviour sanitizers
#   ./test.sh --odr         links with -flto -Wodr: no name has two definitions
#   ./test.sh --long        --odr, fuzzing, long motions, full runs against their reference values, kernels
#   ./test.sh --format      only: is every source file formatted?
set -euo pipefail
cd "$(dirname "$0")"

usage() { sed -n '2,8s/^# \{0,1\}//p' "$0"; }
mode=${1:-}
case "$mode" in
  "" | --sanitize | --odr | --long | --format) ;;
  -h | --help) usage; exit 0 ;;
  *) printf 'test: unknown argument %s\n' "$mode" >&2; usage >&2; exit 2 ;;
esac

check_format() {
  git ls-files '*.h' '*.cpp' | xargs -r clang-format --dry-run -Werror
}

scripts/setup.sh
check_format
[ "$mode" != --format ] || exit 0

if [ "$mode" = --sanitize ]; then
  scripts/build.sh sanitize
  # What these libraries keep to the end is no leak of ours: tests/leaks.supp names each.
  export ASAN_OPTIONS=detect_leaks=1 UBSAN_OPTIONS=print_stacktrace=1
  export LSAN_OPTIONS="suppressions=$PWD/tests/leaks.supp:print_suppressions=0"
  ctest --test-dir build/sanitize --output-on-failure -j 2 --timeout 1200
  exit 0
fi

if [ "$mode" = --odr ] || [ "$mode" = --long ]; then
  scripts/build.sh odr
  [ "$mode" = --long ] || exit 0
fi

scripts/build.sh release
ctest --test-dir build/release --output-on-failure -j 2 --timeout 300
if [ "$mode" = --long ]; then
  # Tests named Long… do more when GEOPRIOR_LONG is set: more seeds, more frames, more kills.
  GEOPRIOR_LONG=1 GEOPRIOR_FUZZ_SECONDS=600 GEOPRIOR_FUZZ_PROGRAM=100000 ctest --test-dir build/release --output-on-failure -R '[Ff]uzz|Long' --timeout 3600
  build/release/geoprior check --mutations
  build/release/benchmarks/geoprior_kernels
else
  build/release/geoprior check --quick --mutations
fi
