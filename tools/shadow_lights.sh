#!/usr/bin/env bash
# Measures docs/results/shadows.md on this machine: writes shadows_NAME.csv beside that page and its tables
# into it, between the marks of NAME (cpu or h200).
#   tools/shadow_lights.sh NAME [ARGUMENTS OF shadow_lights]        such as --device NVIDIA
# About five minutes on two cores. Needs a built tree (build/, or LIGHTGRID_BUILD) and python3. Nothing else
# should run.
set -euo pipefail
name=${1:?shadow_lights.sh NAME [ARGUMENTS]} && shift
root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
build=${LIGHTGRID_BUILD:-$root/build}
cd -- "$root"
if [[ -e $build/build.ninja ]]; then cmake --build "$build" --target shadow_lights >/dev/null; fi
[[ -x $build/tools/shadow_lights ]] || { echo "shadow_lights: none in $build/tools" >&2; exit 3; }
results=docs/results/shadows_$name.csv
"$build/tools/shadow_lights" "$@" >"$results.part"
mv -- "$results.part" "$results"
python3 tools/shadow_lights.py "$results" --page docs/results/shadows.md --mark "$name"
