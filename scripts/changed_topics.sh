#!/usr/bin/env bash
# Prints "differs <topic>" or "same <topic>" of each topic, beside the commit that was tested; on stderr why.
#
#   scripts/changed_topics.sh [<file that holds the commit>]        (build/tested-commit)
#
# What is compared is the working tree: committed, staged, unstaged and new files. A topic's files are those in its folders
# of models, baselines, solvers, experiments, tests and results/reference; it differs, too, where one does whose headers it
# includes or whose runs it reads. Any other file is one that all topics share, except documents, benchmarks and published
# records, which no topic reads. All topics differ where there is no such file or git does not know its commit.
set -euo pipefail
cd "$(dirname "$0")/.."
record=${1:-build/tested-commit}
rooms=(models baselines solvers experiments tests)
mapfile -t topics < <(sed -n 's/^geoprior_topic(\([a-z_]*\).*/\1/p' CMakeLists.txt)
declare -A differs=()

all_differ() {
  printf 'changed: all topics: %s\n' "$1" >&2
  printf 'differs %s\n' "${topics[@]}"
  exit 0
}

is_topic() {
  local topic
  for topic in "${topics[@]}"; do [ "$topic" != "$1" ] || return 0; done
  return 1
}

# The topic of a file, or nothing.
topic_of() {
  local name=$1
  case "$name" in
    models/*/* | baselines/*/* | solvers/*/* | experiments/*/* | tests/*/*) name=${name#*/} ;;
    results/reference/*/*) name=${name#results/reference/} ;;
    *) return 0 ;;
  esac
  name=${name%%/*}
  if is_topic "$name"; then printf '%s' "$name"; fi
}

# uses <topic> <other topic>
uses() {
  local room folders=()
  for room in "${rooms[@]}"; do [ ! -d "$room/$1" ] || folders+=("$room/$1"); done
  [ "${#folders[@]}" -gt 0 ] && grep -rqE "^#include \"[a-z]+/$2/|run:$2/" "${folders[@]}"
}

[ -s "$record" ] || all_differ "there is no $record"
commit=$(<"$record")
git cat-file -e "$commit^{commit}" >/dev/null 2>&1 || all_differ "git does not know the commit of $record"
changed=$(mktemp)
trap 'rm -f "$changed"' EXIT
git diff --name-only --no-renames -z "$commit" -- >"$changed"
git ls-files --others --exclude-standard -z >>"$changed"

while IFS= read -r -d '' name; do
  case "$name" in *.md | LICENSE | docs/* | benchmarks/* | results/published/*) continue ;; esac
  topic=$(topic_of "$name")
  [ -n "$topic" ] || all_differ "$name differs from ${commit:0:12}"
  [ -n "${differs[$topic]:-}" ] || printf 'changed: %s: %s differs from %s\n' "$topic" "$name" "${commit:0:12}" >&2
  differs[$topic]=yes
done <"$changed"

# What uses a topic that differs, until there is no more of it.
found=yes
while [ -n "$found" ]; do
  found=
  for topic in "${topics[@]}"; do
    [ -z "${differs[$topic]:-}" ] || continue
    for other in "${!differs[@]}"; do
      uses "$topic" "$other" || continue
      printf 'changed: %s: uses %s\n' "$topic" "$other" >&2
      differs[$topic]=yes found=yes
      break
    done
  done
done
for topic in "${topics[@]}"; do
  if [ -n "${differs[$topic]:-}" ]; then printf 'differs %s\n' "$topic"; else printf 'same %s\n' "$topic"; fi
done
