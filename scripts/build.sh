#!/usr/bin/env bash
# Configures and builds one preset.
#
#   scripts/build.sh [release|debug|sanitize|odr|release-baseline] [target…]
#   scripts/build.sh --slowest [preset]      the ten files that took longest in the last build of each, and all of them
#   GEOPRIOR_TOPICS="paper;fluid" scripts/build.sh        only these topics (kept until it is said otherwise: "" for all)
set -euo pipefail
cd "$(dirname "$0")/.."

if [ "${1:-}" = --slowest ]; then
  log=build/${2:-release}/.ninja_log
  [ -f "$log" ] || { printf 'build: there is no %s yet\n' "$log" >&2; exit 2; }
  # Of each output its last entry: begin and end in ms. Sums are of the clock: more than the processor was given.
  awk -F '\t' 'NF >= 4 && $4 ~ /\.(o|gch)$/ { seconds[$4] = ($2 - $1) / 1000 }
    END { for (file in seconds) { sum += seconds[file]; printf "%8.1f s  %s\n", seconds[file], file }
          printf "%8.1f s  all of them\n", sum }' "$log" | sort -rn | head -n 11
  exit 0
fi

preset=${1:-release}
shift || true
# The key of ccache is made of the files that a source includes, as the compiler lists them: preprocessing each source for
# it takes half a second.
export CCACHE_DEPEND=1
configure=()
[ -z "${GEOPRIOR_TOPICS+set}" ] || configure=("-DGEOPRIOR_TOPICS=$GEOPRIOR_TOPICS")
if [ ! -f "build/$preset/build.ninja" ] || [ "${#configure[@]}" -gt 0 ]; then
  cmake --preset "$preset" "${configure[@]}" >&2
fi
if [ "$#" -gt 0 ]; then
  cmake --build "build/$preset" --target "$@" >&2
else
  cmake --build "build/$preset" >&2
fi
