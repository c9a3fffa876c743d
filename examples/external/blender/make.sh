#!/usr/bin/env bash
# Makes the frames of blender-knee.toml and blender-dam.toml anew, with the `blender` and the `geoprior` of the PATH:
# a minute. Written for Blender 3.4.1, Debian 12: apt-get install --no-install-recommends blender
set -euo pipefail
cd "$(dirname "$0")"

work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT

# made <experiment> <variant> <frames> <script> <arguments as TOML>: the variant starts Blender instead of reading files
made() {
  local options="variant.$2.options"
  local blender='"blender", "-b", "--factory-startup", "--python-exit-code", "1", "-P"'
  geoprior run "../$1" --variant "$2" --allow-commands --no-pictures --out "$work/$2" \
    --set "$options.command=[$blender, \"blender/$4\", \"--\", $5]" --set "$options.frames=\"$3\"" \
    >"$work/log" 2>&1 || { cat "$work/log" >&2 && exit 1; }
}

for skin in linear dual-quaternion corrective-smooth; do
  made blender-knee.toml "blender-$skin" out/frame_%04d.ply skin.py "\"$skin\", \"$PWD/knee/$skin\""
done
made blender-dam.toml blender out dam.py "\"$PWD/dam\""
