#!/usr/bin/env bash
# Puts the models of Debian's assimp-testmodels and libcgal-demo that the experiments use into data/ (ignored by
# git). Idempotent: what is there and newer than its source is left alone. Needs no network.
set -euo pipefail
cd "$(dirname "$0")/.."

models="$(dpkg -L assimp-testmodels 2>/dev/null | grep -m1 '/Collada/human\.zae$' || true)"
models="${models%/Collada/human.zae}"
if [[ -z "$models" || ! -d "$models" ]]; then
  echo "convert_data: the package assimp-testmodels is not installed" >&2
  exit 2
fi
if ! command -v assimp >/dev/null; then
  echo "convert_data: the program assimp (package assimp-utils) is not installed" >&2
  exit 2
fi

# convert <source below the models> <target in data/> [<distance of seams that are closed>]
convert() {
  local source="$models/$1" target="data/$2" temporary log
  if [[ -s "$target" && ! "$source" -nt "$target" ]]; then
    echo "convert_data: $target is there"
    return
  fi
  if [[ ! -r "$source" ]]; then
    echo "convert_data: $source is missing" >&2
    exit 2
  fi
  mkdir -p data
  temporary="$(mktemp "data/.converting.XXXXXX")"
  trap 'rm -f "$temporary"' EXIT
  if ! log="$(assimp export "$source" "$temporary" -fglb2 2>&1)" || [[ ! -s "$temporary" ]]; then
    echo "$log" >&2
    echo "convert_data: assimp could not convert $source" >&2
    exit 2
  fi
  if [[ -n "${3:-}" ]] && ! /usr/bin/python3 scripts/close_seams.py "$temporary" "$temporary" "$3"; then
    echo "convert_data: $source could not be closed" >&2
    exit 2
  fi
  chmod 644 "$temporary"
  mv "$temporary" "$target"
  trap - EXIT
  echo "convert_data: $source -> $target"
}

convert Collada/human.zae human.glb
convert FBX/animation_with_skeleton.fbx animation_with_skeleton.glb
convert X/BCN_Epileptic.X bcn_epileptic.glb 1e-4

# unpack <member of libcgal-demo's data.tar.gz> <target in data/>
archive="$(dpkg -L libcgal-dev libcgal-demo 2>/dev/null | grep -m1 '/data\.tar\.gz$' || true)"
unpack() {
  local member="$1" target="data/$2" temporary
  if [[ -s "$target" && ! "$archive" -nt "$target" ]]; then
    echo "convert_data: $target is there"
    return
  fi
  if [[ ! -r "$archive" ]]; then
    echo "convert_data: the package libcgal-demo is not installed" >&2
    exit 2
  fi
  mkdir -p data
  temporary="$(mktemp "data/.converting.XXXXXX")"
  trap 'rm -f "$temporary"' EXIT
  if ! tar -xzOf "$archive" "$member" >"$temporary" || [[ ! -s "$temporary" ]]; then
    echo "convert_data: no $member in $archive" >&2
    exit 2
  fi
  chmod 644 "$temporary"
  mv "$temporary" "$target"
  trap - EXIT
  echo "convert_data: $member of libcgal-demo -> $target"
}

unpack data/meshes/bunny00.off bunny.off
unpack data/meshes/diplodocus.off diplodocus.off
unpack data/meshes/bear.off bear.off
unpack data/meshes/dino.off dinosaur.off
