#!/bin/bash
# Follows the worked examples of docs/details/adding.md to the letter, each on the checkout as it is: applies the diff,
# builds what the page says, runs what the page says. Works on copies of the checkout and of its build, which stand at
# the same paths in a mount namespace of their own, so that only what an edit touches is built.
#     recipes.sh SOURCE BUILD
# Status 77: namespaces are not allowed here.
set -eu
source=$1 build=$2
if [ "${IN_COPY:-}" = "" ]; then
  unshare -Urm true 2>/dev/null || { echo "unshare -Urm is not allowed here"; exit 77; }
  copy=$(mktemp -d)
  trap 'rm -rf "$copy"' EXIT
  mkdir "$copy/source" "$copy/build"
  (cd "$source" && git ls-files -z | tar --null -cT - | tar -xC "$copy/source")
  cp -a "$build/." "$copy/build"
  IN_COPY=$copy unshare -Urm bash "$0" "$source" "$build"
  exit
fi

# The build may stand inside the source.
mkdir -p "$IN_COPY/source/$(realpath --relative-base="$source" "$build" | sed 's#^/.*##')"
mount --bind "$IN_COPY/source" "$source"
mount --bind "$IN_COPY/build" "$build"
cd "$source"
page=docs/details/adding.md

# block KIND N: the page's n-th block of a kind of code.
block() { awk -v kind="$1" -v n="$2" '/^```/ {inside = 0} inside {print} $0 == "```" kind && ++at == n {inside = 1}' $page; }

TIMEFORMAT='built in %R s (%U s of processor time)'
for example in 1 2; do
  cp -a $page "$IN_COPY/page"
  block diff $example > "$IN_COPY/diff"
  git apply "$IN_COPY/diff"
  echo "example $example: $(grep -c '^+++ ' "$IN_COPY/diff") files"
  block bash $example > "$IN_COPY/commands"
  time bash -eu "$IN_COPY/commands" build
  bash -eu "$IN_COPY/commands" run
  git apply -R "$IN_COPY/diff"
done
