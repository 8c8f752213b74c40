#!/bin/bash
# Follows docs/details/adding.md to the letter, each example on the checkout as it is: applies its diff, builds and runs
# what stands below it. Works on copies of the checkout and of its build, which stand at the same paths in a mount
# namespace of their own, so that only what an edit touches is built.
#     recipes.sh SOURCE SOURCE/build
# Status 77: not possible here; says why.
set -eu
source=$1 build=$2
if [ -z "${IN_COPY:-}" ]; then
  [ "$build" = "$source/build" ] || { echo "the build is not in build/"; exit 77; }
  unshare -Urm true 2>/dev/null || { echo "unshare -Urm is not allowed"; exit 77; }
  copy=$(mktemp -d)
  trap 'rm -rf "$copy"' EXIT
  mkdir "$copy/source"
  (cd "$source" && git ls-files -z --cached --others --exclude-standard | tar --null --ignore-failed-read -cT - | tar -xC "$copy/source")
  cp -a "$build" "$copy/source/build"
  IN_COPY=$copy unshare -Urm bash "$0" "$source" "$build"
  exit
fi

mount --bind "$IN_COPY/source" "$source"
cd "$source"
page=docs/details/adding.md

# block KIND N: the page's n-th block of a kind of code.
block() { awk -v kind="$1" -v n="$2" '/^```/ {inside = 0} inside {print} $0 == "```" kind && ++at == n {inside = 1}' $page; }

TIMEFORMAT='in %R s (%U s of processor time)'
export OUT=$IN_COPY/out
mkdir "$OUT"
# The first last: to undo what it touched takes a third of the library to build, and to undo the others takes little.
for example in 3 2 1; do
  block diff $example > "$IN_COPY/diff"
  block bash $((2 * example - 1)) > "$IN_COPY/build.sh"
  block bash $((2 * example)) > "$IN_COPY/run.sh"
  echo "example $example: $(grep -c '^+++ ' "$IN_COPY/diff") files"
  git apply "$IN_COPY/diff"
  time bash -eu "$IN_COPY/build.sh"
  time bash -eu "$IN_COPY/run.sh"
  git apply -R "$IN_COPY/diff"
done
