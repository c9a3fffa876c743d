#!/usr/bin/env bash
# Sets up what is missing, builds the program and reproduces the thesis' figures.
#
#   ./reproduce.sh                  the main job: thesis Figure 3.2, as the README shows it (skinning/knee, one seed)
#   ./reproduce.sh --all            every experiment, with all seeds and variants
#   ./reproduce.sh --quick [--all]  the small versions
#   ./reproduce.sh ID…              these experiments
set -euo pipefail
cd "$(dirname "$0")"

usage() { sed -n '2,7s/^# \{0,1\}//p' "$0"; }
all=no
quick=()
ids=()
shown=()
for argument in "$@"; do
  case "$argument" in
    --all) all=yes ;;
    --quick) quick=(--quick) ;;
    -h | --help) usage; exit 0 ;;
    -*) printf 'reproduce: unknown argument %s\n' "$argument" >&2; usage >&2; exit 2 ;;
    *) ids+=("$argument") ;;
  esac
done

scripts/setup.sh
scripts/build.sh release geoprior
geoprior=build/release/geoprior

if [ "$all" = yes ]; then
  mapfile -t ids < <("$geoprior" list --json | /usr/bin/python3 -c 'import json, sys
for experiment in json.load(sys.stdin)["experiments"]: print(experiment["id"])')
elif [ "${#ids[@]}" -eq 0 ]; then
  # The picture's five methods; ten seeds, what is claimed over them, and three more methods are the study's:
  # ./reproduce.sh skinning/knee.
  ids=(skinning/knee)
  shown=(--set 'sweep=[]')
  for variant in linear-blend dual-quaternion delta-mush implicit implicit-smooth; do shown+=(--variant "$variant"); done
fi

worst=0
for id in "${ids[@]}"; do
  status=0
  "$geoprior" run "$id" "${quick[@]}" "${shown[@]}" || status=$?
  # 1: a claim fell short, which is a finding and no reason to stop; anything else is.
  [ "$status" -le 1 ] || exit "$status"
  [ "$status" -le "$worst" ] || worst=$status
done
# One run has said where its picture and its report are; several get an overview and a report of all.
if [ "${#ids[@]}" -gt 1 ]; then
  printf '\n'
  "$geoprior" report "${ids[@]}"
fi
exit "$worst"
