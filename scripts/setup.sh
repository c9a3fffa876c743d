#!/usr/bin/env bash
# Installs what geoprior needs on Debian 12 and converts the data it reads out of installed packages.
#
#   scripts/setup.sh            install what is missing, convert what is missing
#   scripts/setup.sh --check    only say what is missing; exit 1 when something is
#
# Idempotent: what is there is left alone, and nothing is fetched when nothing is missing.
# Works as root, and through sudo for anybody else.
set -euo pipefail
cd "$(dirname "$0")/.."

packages=(
  # compiler and build
  ca-certificates git cmake ninja-build ccache g++ clang-format pkg-config
  # libraries
  libeigen3-dev libtbb-dev libcgal-dev libvtk9-dev libhdf5-dev libssl-dev
  libsuitesparse-dev libopenblas-dev libpugixml-dev libfftw3-dev liblemon-dev libnauty2-dev libceres-dev libspectra-dev
  liblua5.4-dev libserd-dev libraptor2-dev
  libopenimageio-dev openimageio-tools python3-imath libsndfile1-dev
  libtomlplusplus-dev libcli11-dev nlohmann-json3-dev
  libgtest-dev libgmock-dev libbenchmark-dev
  # plots, report and the checks that a run needs nothing of ours
  python3 python3-numpy python3-scipy python3-h5py python3-matplotlib python3-pil python3-ezdxf
  # engines that queries and rules of an ontology are held against
  python3-rdflib gringo clasp
  # pictures without a display
  xvfb libgl1-mesa-dri fonts-dejavu-core
  # models that nobody here made, and the converter that reads them
  assimp-utils assimp-testmodels libcgal-demo xtrkcad-common
)

say() { printf 'setup: %s\n' "$*" >&2; }

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$status" = installed ] || missing+=("$package")
done

if [ "${1:-}" = --check ]; then
  if [ "${#missing[@]}" -gt 0 ]; then
    say "missing packages: ${missing[*]}"
    exit 1
  fi
  say "all ${#packages[@]} packages are installed"
  exit 0
elif [ "$#" -gt 0 ]; then
  say "unknown argument '$1' (allowed: --check)"
  exit 2
fi

if [ "${#missing[@]}" -gt 0 ]; then
  if ! command -v apt-get >/dev/null; then
    say "needs a Debian 12 system; install the equivalents of: ${missing[*]}"
    exit 2
  fi
  as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { say "run as root, or install sudo; missing: ${missing[*]}"; exit 2; }
    as_root=(sudo)
  fi
  say "installing ${#missing[@]} of ${#packages[@]} Debian packages: ${missing[*]}"
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >&2
else
  say "all ${#packages[@]} packages are installed"
fi

scripts/convert_data.sh
