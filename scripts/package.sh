#!/usr/bin/env bash
# Makes the Debian packages geoprior, libgeoprior-dev and geoprior-doc in build/<preset>/packages.
#
#   scripts/package.sh [preset]          build what they need and make them (default preset: release)
#   scripts/package.sh --try [preset]    and try them (scripts/try_package.sh)
#
# release-baseline makes packages for any x86-64 processor, release for x86-64-v3.
set -euo pipefail
cd "$(dirname "$0")/.."

try=no
preset=release
for argument in "$@"; do
  case "$argument" in
    --try) try=yes ;;
    -h | --help) sed -n '2,7s/^# \{0,1\}//p' "$0"; exit 0 ;;
    -*) printf 'package: unknown argument %s\n' "$argument" >&2; exit 2 ;;
    *) preset=$argument ;;
  esac
done
say() { printf 'package: %s\n' "$*" >&2; }

[ -s data/human.glb ] || { say "data/ has no models: run scripts/setup.sh"; exit 2; }
scripts/build.sh "$preset" geoprior
packages=$PWD/build/$preset/packages
rm -rf "$packages"
(cd "build/$preset" && cpack -B "$packages" >&2)
rm -rf "$packages/_CPack_Packages"
ls -l "$packages"/*.deb >&2
[ "$try" = no ] || scripts/try_package.sh "$packages"
