#!/usr/bin/env bash
# Configures and builds one preset: scripts/build.sh [release|debug|sanitize|release-baseline] [target…]
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:-release}
shift || true
[ -f "build/$preset/build.ninja" ] || cmake --preset "$preset" >&2
if [ "$#" -gt 0 ]; then
  cmake --build "build/$preset" --target "$@" >&2
else
  cmake --build "build/$preset" >&2
fi
